"""Measures the numbers of docs/epipolar.md and makes its plots and pictures, with `tyndall bench`, `render` and `compare`.

    tools/epipolar_study.py TYNDALL [SECTION]...

Writes docs/generated/epipolar.md, docs/images/epipolar_*.svg and docs/images/epipolar_*.png. Needs Pillow and matplotlib.
The sections are sweeps, pixels, tree, presets and pictures. Without a section, all of them run. The results of each section
are stored in out/epipolar_study.json, so that a later run can measure the others alone.

Times are medians of three runs of three frames each. Runs that are compared with each other alternate. Costs are in copy
baselines of the same run, because the speed of shared machines varies.
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
RESULTS = ROOT / "out/epipolar_study.json"
SIZE = "1280x720"
PARALLEL_RENDERS = 2
TURNS = 3
FIXED_EXPOSURE = ["--set", "tonemap.auto_exposure=false"]  # because the pictures are compared
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
        """Returns the cost of each point (settings, size). Runs alternate, because the speed of a machine changes with time."""
        keys = [self.arguments(None, without_defaults(settings), size) for settings, size in points]
        runs = {k: [] for k in keys}
        for _ in range(TURNS):
            for k in runs:
                runs[k].append(json.loads(self.run("bench", *k, "--frames", str(frames), "--json")))
        return [cost(runs[k]) for k in keys]

    def render(self, jobs):
        """Renders the jobs (scene, settings, kind) that are new and returns the files of all jobs."""
        keys = [(self.arguments(scene, without_defaults(settings), SIZE), kind) for scene, settings, kind in jobs]
        fresh = [k for k in dict.fromkeys(keys) if k not in self.rendered]
        for k in fresh:
            self.rendered[k] = str(self.scratch / f"{len(self.rendered)}.{k[1]}")
        with ThreadPoolExecutor(PARALLEL_RENDERS) as pool:
            list(pool.map(lambda k: self.run("render", *k[0], "-o", self.rendered[k]), fresh))
        return [self.rendered[k] for k in keys]

    def errors(self, points):
        """Returns the errors of points (scene, settings, kinds) against brute force: PSNR for PNG, mean relative error for EXR [%]."""
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

    def baselines(name):
        return median(lambda run: next(p["median_ms"] for p in run["passes"] if p["name"] == name) / run["floor_ms"])

    first = runs[0]
    effect = first["memory_bytes"]["effect_resources"]
    return {"baselines": median(lambda run: run["effect_ms"] / run["floor_ms"]), "ms": median(lambda run: run["effect_ms"]),
            "passes": {p["name"]: baselines(p["name"]) for p in first["passes"] if p["in_effect"]},
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


def plot(results):
    plt.rcParams.update({"svg.hashsalt": "tyndall", "font.size": 8})
    if "sweeps" in results:
        figure, axes = plt.subplots(2, 2, figsize=(9, 6))
        for axis, name in zip(axes.flat, SWEEPS):
            rows = [r for r in results["sweeps"]["rows"] if r["sweep"] == name]
            labels = [short(r["settings"]) for r in rows]
            axis.plot(labels, [r["psnr"] for r in rows], "o-", color="tab:blue")
            axis.set_ylabel("PSNR against brute force [dB]", color="tab:blue")
            axis.set_ylim(44, 62)
            axis.set_title(name)
            axis.tick_params(axis="x", rotation=20 if len(rows) > 5 else 0)
            other = axis.twinx()
            other.plot(labels, [r["cost"]["baselines"] for r in rows], "s--", color="tab:red")
            other.set_ylabel("cost [copy baselines]", color="tab:red")
            other.set_ylim(bottom=0)
        save_plot(figure, "sweeps")
    if "pixels" in results:
        figure, axis = plt.subplots(figsize=(7, 3.5))
        sizes = list(results["pixels"])
        base = [0.0] * len(sizes)
        rows = {"slices and samples": [], "min_max_tree + march_samples": [], "unwarp + unwarp_pixels": []}
        for size in sizes:
            for label, value in zip(rows, grouped(results["pixels"][size])):
                rows[label].append(value)
        for label, values in rows.items():
            axis.bar(sizes, values, bottom=base, label=label, width=0.5)
            base = [a + b for a, b in zip(base, values)]
        axis.set_ylabel("ms")
        axis.legend()
        save_plot(figure, "pixels")


def grouped(c):
    """Returns the milliseconds of the passes over samples, of those that read shadow maps, and of those over pixels."""
    ms = {k: v * c["ms"] / c["baselines"] for k, v in c["passes"].items()}
    shadow = ms.get("min_max_tree", 0.0) + ms["march_samples"]
    picture = ms["unwarp"] + ms["unwarp_pixels"]
    return sum(ms.values()) - shadow - picture, shadow, picture


def table(head, rows, text_columns=1):
    lines = ["| " + " | ".join(head) + " |",
             "|" + "|".join("---" if i < text_columns else "--:" for i in range(len(head))) + "|"]
    lines += ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def epipolar_mib(c):
    """Returns the memory of the effect without the scattering tables."""
    return sum(v for k, v in c["resources"].items() if not is_table(k)) / 2**20


def is_table(name):
    return any(part in name for part in ("single_rayleigh", "single_mie", "high_orders", "sun_transmittance", "sky_irradiance"))


def page(results):
    text = ""
    if "sweeps" in results:
        s = results["sweeps"]
        text += (f"`make epipolar-study` made these tables on {s['epipolar']['device']}, with the default scene at {SIZE}. Costs are in "
                 "copy baselines of the same run.\n\n")
        for name in SWEEPS:
            rows = [(short(r["settings"]), f"{r['psnr']:.1f}", f"{r['mre']:.2f}", f"{r['cost']['baselines']:.1f}",
                     r["cost"]["counters"]["samples_marched"], f"{epipolar_mib(r['cost']):.1f}")
                    for r in s["rows"] if r["sweep"] == name]
            text += table([name, "PSNR [dB]", "mean relative error [%]", "cost [copy baselines]", "samples marched",
                           "memory without tables [MiB]"], rows)
        a, b = s["epipolar"], s["brute_force"]
        text += "## Epipolar sampling and brute force\n\n"
        rows = [(n, f"{c['baselines']:.1f}", f"{c['ms']:.0f}", *(c["counters"][k] for k in a["counters"]))
                for n, c in (("epipolar", a), ("brute force", b))]
        rows.append(("brute force / epipolar", f"{b['baselines'] / a['baselines']:.1f}", f"{b['ms'] / a['ms']:.1f}",
                     *(f"{b['counters'][k] / a['counters'][k]:.1f}" if a["counters"][k] and b["counters"][k] else ""
                       for k in a["counters"])))
        text += table(["technique", "cost [copy baselines]", "ms", *(k.replace("_", " ") for k in a["counters"])], rows)
        text += table(["pass", "cost [copy baselines]", "of the effect [%]"],
                      [(f"`{k}`", f"{v:.2f}", f"{100 * v / a['baselines']:.0f}") for k, v in a["passes"].items()])
    if "pixels" in results:
        text += "## Cost against pixels\n\n"
        rows = [(size, *(f"{v:.1f}" for v in grouped(c)), f"{c['baselines']:.1f}") for size, c in results["pixels"].items()]
        text += table(["picture", "slices and samples [ms]", "tree and marching [ms]", "unwarping [ms]",
                       "effect [copy baselines of that size]"], rows)
    if "tree" in results:
        text += "## The tree\n\n"
        rows = []
        for r in results["tree"]:
            w, o = r["with"]["passes"], r["without"]["passes"]
            both = w["min_max_tree"] + w["march_samples"]
            rows.append((f"{r['resolution']}²", f"{w['min_max_tree']:.2f}", f"{w['march_samples']:.2f}",
                         f"{o['march_samples']:.2f}", f"{o['march_samples'] / both:.1f}",
                         f"{r['without']['baselines'] / r['with']['baselines']:.1f}",
                         r["with"]["counters"]["shadow_map_fetches"], r["without"]["counters"]["shadow_map_fetches"],
                         "yes" if r["equal"] else "no"))
        text += table(["shadow maps", "building the tree [copy baselines]", "marching with it", "marching without it",
                       "speed-up, building included", "speed-up of the whole effect", "map reads with it", "map reads without it",
                       "same picture"], rows)
    if "presets" in results:
        text += "## Presets\n\n"
        rows = [(f"`{n}`", *(f"{p['errors'][v]['psnr']:.1f}" for v in VIEWS),
                 f"{p['cost']['baselines']:.1f}", f"{epipolar_mib(p['cost']):.1f}") for n, p in results["presets"].items()]
        text += table(["preset", *(f"PSNR, {v} [dB]" for v in VIEWS), "cost [copy baselines]", "memory without tables [MiB]"], rows)
    if "pictures" in results:
        text += "## Pictures\n\n"
        text += table(["view", "PSNR [dB]"], [(k, f"{v:.1f}") for k, v in results["pictures"].items()])
    return text.rstrip("\n") + "\n"


def main():
    sections = {"sweeps": sweeps, "pixels": pixels, "tree": tree, "presets": presets, "pictures": pictures}
    if len(sys.argv) < 2 or any(name not in sections for name in sys.argv[2:]):
        sys.exit(__doc__.strip())
    results = json.loads(RESULTS.read_text(encoding="utf-8")) if sys.argv[2:] and RESULTS.exists() else {}
    RESULTS.parent.mkdir(exist_ok=True)
    IMAGES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        study = Study(str(pathlib.Path(sys.argv[1]).resolve()), scratch)
        for name in sys.argv[2:] or sections:
            start = time.monotonic()
            results[name] = sections[name](study)
            RESULTS.write_text(json.dumps(results), encoding="utf-8")
            print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
    plot(results)
    (ROOT / "docs/generated/epipolar.md").write_text(page(results), encoding="utf-8")


if __name__ == "__main__":
    main()
