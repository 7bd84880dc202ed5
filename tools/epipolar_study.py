"""The numbers, plots and pictures of docs/epipolar.md: runs `tyndall bench`, `render` and `compare`, and writes
docs/generated/epipolar.md, docs/images/epipolar_*.svg and docs/images/epipolar_*.png.

    tools/epipolar_study.py TYNDALL [SECTION]...

Needs Pillow and matplotlib. Sections: sweeps, pixels, tree, presets, pictures; without, all of them. What a section
has measured is kept in out/epipolar_study.json, so that the others need not run again.
Times are medians of three runs of three frames each, in turns with those that they are compared with, and are given in floor
passes of the same run, because machines are shared and differ.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs/images"
KEPT = ROOT / "out/epipolar_study.json"
SIZE = "1280x720"
PARALLEL_RENDERS = 2
TURNS = 3
FIXED_EXPOSURE = ["--set", "tonemap.auto_exposure=false"]  # the pictures are compared
BRUTE_FORCE = {"scattering.technique": "brute-force"}
SWEEPS = {
    "slices × samples": [{"epipolar.slices": a, "epipolar.samples": b}
                         for a, b in [(256, 128), (512, 128), (512, 256), (512, 512), (1024, 512), (2048, 1024)]],
    "initial step": [{"epipolar.initial_step": n} for n in (4, 8, 16, 64)],
    "threshold": [{"epipolar.refinement_threshold": x} for x in (0.01, 0.03, 0.1)],
    "shadow resolution": [{"shadows.resolution": n} for n in (512, 1024, 2048)],
}
DEFAULTS = {"epipolar.slices": 512, "epipolar.samples": 256, "epipolar.initial_step": 16,
            "epipolar.refinement_threshold": 0.03, "shadows.resolution": 1024}
SIZES = ["640x360", "1280x720", "1920x1080"]
PRESETS = ["high_quality", "balanced", "high_performance"]
VIEWS = {"default": (None, {}),
         "demo": ("scenes/demo.toml", {"camera.samples": 1}),
         "noon": ("scenes/noon.toml", {"camera.samples": 1})}
PICTURES = {
    "default": (None, {}),
    "ahead": ("scenes/demo.toml", {"camera.samples": 1, "camera.yaw_deg": 312, "camera.pitch_deg": -2}),
    "limb": (None, {"camera.position_m": "0,400000,0", "camera.pitch_deg": -18}),
    "behind": (None, {"camera.yaw_deg": 185.4}),
}


def without_defaults(settings):
    return {k: v for k, v in settings.items() if DEFAULTS.get(k) != v}


class Study:
    def __init__(self, tyndall, scratch):
        self.tyndall = tyndall
        self.scratch = pathlib.Path(scratch)
        self.rendered = {}

    def run(self, *arguments):
        done = subprocess.run([self.tyndall, *arguments], cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"tyndall {' '.join(arguments)}: {done.stderr.strip()}")
        return done.stdout

    @staticmethod
    def arguments(scene, settings, size):
        out = ([scene] if scene else []) + FIXED_EXPOSURE
        for key, value in sorted(settings.items()):
            out += ["--set", f"{key}={value}"]
        return tuple(out + ["--size", size])

    def costs(self, points, frames=3):
        """points: (settings, size). What each costs, run in turns, because a machine's speed changes with time."""
        keys = [self.arguments(None, without_defaults(settings), size) for settings, size in points]
        runs = {k: [] for k in keys}
        for _ in range(TURNS):
            for k in runs:
                runs[k].append(json.loads(self.run("bench", *k, "--frames", str(frames), "--json")))
        return [cost(runs[k]) for k in keys]

    def render(self, jobs):
        """jobs: (scene, settings, kind). Renders those that are new and returns the files of all."""
        keys = [(self.arguments(scene, without_defaults(settings), SIZE), kind) for scene, settings, kind in jobs]
        fresh = [k for k in dict.fromkeys(keys) if k not in self.rendered]
        for k in fresh:
            self.rendered[k] = str(self.scratch / f"{len(self.rendered)}.{k[1]}")
        with ThreadPoolExecutor(PARALLEL_RENDERS) as pool:
            list(pool.map(lambda k: self.run("render", *k[0], "-o", self.rendered[k]), fresh))
        return [self.rendered[k] for k in keys]

    def errors(self, points):
        """points: (scene, settings, kinds). PSNR of PNG, mean relative error of EXR [%], against brute force."""
        jobs = []
        for scene, settings, kinds in points:
            truth = {k: v for k, v in settings.items() if not k.startswith("epipolar.")} | BRUTE_FORCE
            for kind in kinds:
                jobs += [(scene, settings, kind), (scene, truth, kind)]
        files = iter(self.render(jobs))
        out = []
        for _, _, kinds in points:
            row = {}
            for kind in kinds:
                a, b = next(files), next(files)
                result = json.loads(self.run("compare", a, b, "--json"))
                if kind == "png":
                    row["psnr"] = result["psnr_db"]
                else:
                    row["mre"] = 100 * result["mean_relative_error"]
            out.append(row)
        return out


def cost(runs):
    def median(number):
        return statistics.median(number(run) for run in runs)

    def floors(name):
        return median(lambda run: next(p["median_ms"] for p in run["passes"] if p["name"] == name) / run["floor_ms"])

    first = runs[0]
    effect = first["memory_bytes"]["effect_resources"]
    return {"floors": median(lambda run: run["effect_ms"] / run["floor_ms"]), "ms": median(lambda run: run["effect_ms"]),
            "passes": {p["name"]: floors(p["name"]) for p in first["passes"] if p["in_effect"]},
            "counters": first["counters"], "mib": sum(v for k, v in effect.items()) / 2**20,
            "resources": effect, "device": first["device"]}


def sweeps(study):
    points = [(name, p) for name, rows in SWEEPS.items() for p in rows]
    errors = study.errors([(None, p, ("png", "exr")) for _, p in points])
    costs = study.costs([(p, SIZE) for _, p in points])
    out = {"rows": [{"sweep": name, "settings": p, **e, "cost": c} for (name, p), e, c in zip(points, errors, costs)]}
    out["brute_force"], out["epipolar"] = study.costs([(BRUTE_FORCE, SIZE), ({}, SIZE)])
    return out


def pixels(study):
    return dict(zip(SIZES, study.costs([({}, size) for size in SIZES])))


def tree(study):
    rows = []
    for resolution in (1024, 2048):
        settings = {"shadows.resolution": resolution}
        off = settings | {"epipolar.min_max_tree": "false"}
        a, b = study.render([(None, settings, "png"), (None, off, "png")])
        equal = json.loads(study.run("compare", a, b, "--json"))["max_abs"] == 0.0
        with_tree, without = study.costs([(settings, SIZE), (off, SIZE)])
        rows.append({"resolution": resolution, "equal": equal, "with": with_tree, "without": without})
    return rows


def preset_settings(name):
    text = (ROOT / "scenes/presets" / f"{name}.toml").read_text(encoding="utf-8")
    return {f"{group}.{key}": value for group, keys in tomllib.loads(text).items() for key, value in keys.items()}


def presets(study):
    points = []
    for name in PRESETS:
        chosen = {k: v for k, v in preset_settings(name).items() if k not in ("shadows.cascades", "shadows.first_marched")}
        points += [(scene, more | chosen, ("png",)) for scene, more in VIEWS.values()]
    errors = iter(study.errors(points))
    costs = study.costs([(preset_settings(name), SIZE) for name in PRESETS])
    return {name: {"errors": {view: next(errors) for view in VIEWS}, "cost": c} for name, c in zip(PRESETS, costs)}


def pictures(study):
    out = {}
    width, height = 426, 240
    for name, (scene, more) in PICTURES.items():
        a, b = study.render([(scene, more, "png"), (scene, more | BRUTE_FORCE, "png")])
        difference = str(study.scratch / "difference.png")
        out[name] = json.loads(study.run("compare", a, b, "--json", "--diff", difference))["psnr_db"]
        strip = Image.new("RGB", (3 * width + 8, height), "white")
        for i, path in enumerate((a, b, difference)):
            strip.paste(Image.open(path).convert("RGB").resize((width, height), Image.BOX), (i * (width + 4), 0))
        strip.save(IMAGES / f"epipolar_{name}.png", optimize=True)
    marked = study.render([(None, {"epipolar.show_sampling": "true"}, "png")])[0]
    Image.open(marked).convert("RGB").crop((560, 0, 1280, 400)).save(IMAGES / "epipolar_sampling.png", optimize=True)
    return out


def short(settings):
    return " × ".join(str(v) for v in settings.values())


def save_plot(figure, name):
    figure.tight_layout()
    figure.savefig(IMAGES / f"epipolar_{name}.svg", metadata={"Date": None})
    plt.close(figure)


def plot(kept):
    plt.rcParams.update({"svg.hashsalt": "tyndall", "font.size": 8})
    if "sweeps" in kept:
        figure, axes = plt.subplots(2, 2, figsize=(9, 6))
        for axis, name in zip(axes.flat, SWEEPS):
            rows = [r for r in kept["sweeps"]["rows"] if r["sweep"] == name]
            labels = [short(r["settings"]) for r in rows]
            axis.plot(labels, [r["psnr"] for r in rows], "o-", color="tab:blue")
            axis.set_ylabel("PSNR against brute force [dB]", color="tab:blue")
            axis.set_ylim(44, 62)
            axis.set_title(name)
            axis.tick_params(axis="x", rotation=20 if len(rows) > 5 else 0)
            other = axis.twinx()
            other.plot(labels, [r["cost"]["floors"] for r in rows], "s--", color="tab:red")
            other.set_ylabel("cost [floor passes]", color="tab:red")
            other.set_ylim(bottom=0)
        save_plot(figure, "sweeps")
    if "pixels" in kept:
        figure, axis = plt.subplots(figsize=(7, 3.5))
        sizes = list(kept["pixels"])
        base = [0.0] * len(sizes)
        rows = {"slices and samples": [], "shadow_tree + march_samples": [], "unwarp + unwarp_pixels": []}
        for size in sizes:
            for label, value in zip(rows, grouped(kept["pixels"][size])):
                rows[label].append(value)
        for label, values in rows.items():
            axis.bar(sizes, values, bottom=base, label=label, width=0.5)
            base = [a + b for a, b in zip(base, values)]
        axis.set_ylabel("ms")
        axis.legend()
        save_plot(figure, "pixels")


def grouped(c):
    """Milliseconds: of the passes over samples, of those through shadow maps, of those over pixels."""
    ms = {k: v * c["ms"] / c["floors"] for k, v in c["passes"].items()}
    shadow = ms.get("shadow_tree", 0.0) + ms["march_samples"]
    picture = ms["unwarp"] + ms["unwarp_pixels"]
    return sum(ms.values()) - shadow - picture, shadow, picture


def table(head, rows, text_columns=1):
    lines = ["| " + " | ".join(head) + " |",
             "|" + "|".join("---" if i < text_columns else "--:" for i in range(len(head))) + "|"]
    lines += ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def epipolar_mib(c):
    """All of the effect's memory but the scattering tables."""
    return sum(v for k, v in c["resources"].items() if not is_table(k)) / 2**20


def is_table(name):
    return any(part in name for part in ("single_rayleigh", "single_mie", "high_orders", "sun_transmittance", "sky_irradiance"))


def page(kept):
    text = ""
    if "sweeps" in kept:
        s = kept["sweeps"]
        text += (f"Made by `make epipolar-study` on {s['epipolar']['device']}, {SIZE}, default scene. Costs are in floor passes of the "
                 "same run.\n\n")
        for name in SWEEPS:
            rows = [(short(r["settings"]), f"{r['psnr']:.1f}", f"{r['mre']:.2f}", f"{r['cost']['floors']:.1f}",
                     r["cost"]["counters"]["samples_marched"], f"{epipolar_mib(r['cost']):.1f}")
                    for r in s["rows"] if r["sweep"] == name]
            text += table([name, "PSNR [dB]", "mean relative error [%]", "cost [floors]", "samples marched",
                           "memory but tables [MiB]"], rows)
        a, b = s["epipolar"], s["brute_force"]
        text += "## Epipolar sampling and brute force\n\n"
        rows = [(n, f"{c['floors']:.1f}", f"{c['ms']:.0f}", *(c["counters"][k] for k in a["counters"]))
                for n, c in (("epipolar", a), ("brute force", b))]
        rows.append(("brute force / epipolar", f"{b['floors'] / a['floors']:.1f}", f"{b['ms'] / a['ms']:.1f}",
                     *(f"{b['counters'][k] / a['counters'][k]:.1f}" if a["counters"][k] and b["counters"][k] else ""
                       for k in a["counters"])))
        text += table(["technique", "cost [floors]", "ms", *(k.replace("_", " ") for k in a["counters"])], rows)
        text += table(["pass", "cost [floors]", "part [%]"],
                      [(f"`{k}`", f"{v:.2f}", f"{100 * v / a['floors']:.0f}") for k, v in a["passes"].items()])
    if "pixels" in kept:
        text += "## Cost against pixels\n\n"
        rows = [(size, *(f"{v:.1f}" for v in grouped(c)), f"{c['floors']:.1f}") for size, c in kept["pixels"].items()]
        text += table(["picture", "slices and samples [ms]", "tree and marching [ms]", "unwarping [ms]",
                       "all [floors of that size]"], rows)
    if "tree" in kept:
        text += "## The tree\n\n"
        rows = []
        for r in kept["tree"]:
            w, o = r["with"]["passes"], r["without"]["passes"]
            both = w["shadow_tree"] + w["march_samples"]
            rows.append((f"{r['resolution']}²", f"{w['shadow_tree']:.2f}", f"{w['march_samples']:.2f}",
                         f"{o['march_samples']:.2f}", f"{o['march_samples'] / both:.1f}",
                         f"{r['without']['floors'] / r['with']['floors']:.1f}",
                         r["with"]["counters"]["shadow_map_fetches"], r["without"]["counters"]["shadow_map_fetches"],
                         "yes" if r["equal"] else "no"))
        text += table(["maps", "building [floors]", "marching with [floors]", "without [floors]",
                       "gain, building included", "gain of the whole effect", "map reads with", "without",
                       "same picture"], rows)
    if "presets" in kept:
        text += "## Presets\n\n"
        rows = [(f"`{n}`", *(f"{p['errors'][v]['psnr']:.1f}" for v in VIEWS),
                 f"{p['cost']['floors']:.1f}", f"{epipolar_mib(p['cost']):.1f}") for n, p in kept["presets"].items()]
        text += table(["preset", *(f"PSNR, {v} [dB]" for v in VIEWS), "cost [floors]", "memory but tables [MiB]"], rows)
    if "pictures" in kept:
        text += "## Pictures\n\n"
        text += table(["view", "PSNR [dB]"], [(k, f"{v:.1f}") for k, v in kept["pictures"].items()])
    return text.rstrip("\n") + "\n"


def main():
    sections = {"sweeps": sweeps, "pixels": pixels, "tree": tree, "presets": presets, "pictures": pictures}
    if len(sys.argv) < 2 or any(name not in sections for name in sys.argv[2:]):
        sys.exit(__doc__.strip())
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if sys.argv[2:] and KEPT.exists() else {}
    KEPT.parent.mkdir(exist_ok=True)
    IMAGES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        study = Study(str(pathlib.Path(sys.argv[1]).resolve()), scratch)
        for name in sys.argv[2:] or sections:
            start = time.monotonic()
            kept[name] = sections[name](study)
            KEPT.write_text(json.dumps(kept), encoding="utf-8")
            print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
    plot(kept)
    (ROOT / "docs/generated/epipolar.md").write_text(page(kept), encoding="utf-8")


if __name__ == "__main__":
    main()
