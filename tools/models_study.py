"""Every model on one scene: pictures, cost, and error. `make models-study` runs it.

    models_study.py TYNDALL [--validation FILE.json] [--keep-pictures]

writes docs/images/models_*.png and docs/generated/models.md. Models that this build does not draw are left out. The errors
against the path tracer are those of `tyndall validate --json`, which is run unless its output is given."""
import json
import math
import pathlib
import subprocess
import sys

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes" / "models.toml"
SIZE = "480x270"
COST_SIZE = "320x180"
COST_FRAMES = 5
QUIET = 0.05  # costs are differences: they are left out where the bare ground, measured before and after, differs by more
# What air costs is what frames cost above the bare ground's: shadows are small and the ground is grey, so that
# the rest does not drown it.
COST = ["terrain.shading=plain", "shadows.resolution=512", "shadows.cascades=2"]

# Name of the picture, title, settings, rows of validate that stand for it.
MODELS = [
    ("atmosphere", "`atmosphere`, epipolar", [], "precomputed, order 1 integrated"),
    ("brute_force", "`atmosphere`, every pixel", ["scattering.technique=brute-force"], "precomputed, order 1 integrated"),
    ("homogeneous_vertex", "`homogeneous`, `vertex`", ["scattering.model=homogeneous"], "homogeneous"),
    ("homogeneous_pixel", "`homogeneous`, `pixel`",
     ["scattering.model=homogeneous", "scattering.evaluate=pixel"], "homogeneous"),
    ("homogeneous_falloff", "`homogeneous` with `homogeneous.falloff`, `vertex`",
     ["scattering.model=homogeneous", "homogeneous.falloff=true"], "homogeneous, falling off"),
    ("oneil_vertex", "`oneil`, `vertex`", ["scattering.model=oneil"], "oneil"),
    ("oneil_pixel", "`oneil`, `pixel`", ["scattering.model=oneil", "scattering.evaluate=pixel"], "oneil"),
    ("oneil_table_vertex", "`oneil-table`, `vertex`", ["scattering.model=oneil-table"], "oneil-table"),
    ("oneil_table_pixel", "`oneil-table`, `pixel`",
     ["scattering.model=oneil-table", "scattering.evaluate=pixel"], "oneil-table"),
    ("medium_homogeneous", "`scattering.medium` = `homogeneous`", ["scattering.medium=homogeneous"], None),
]


def run(tyndall, *arguments):
    done = subprocess.run([tyndall, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def sets(settings):
    return [part for setting in settings for part in ("--set", setting)]


def passes(tyndall, settings):
    out = json.loads(run(tyndall, "bench", str(SCENE), "--json", "--size", COST_SIZE, "--frames", str(COST_FRAMES),
                         *sets(["camera.samples=1", *COST, *settings])))
    return {p["name"]: p["median_ms"] for p in out["passes"]}, out["effect_ms"], out["device"]


def pixels(path):
    image = Image.open(path).convert("RGB")
    return image.tobytes()


def difference_db(a, b):
    squares = sum((x - y) ** 2 for x, y in zip(a, b)) / len(a)
    return math.inf if squares == 0 else 10 * math.log10(255 * 255 / squares)


def mean_error(validation, row, region):
    for model in validation["models"]:
        if model["name"] != row:
            continue
        for group in model["groups"]:
            if group["atmosphere"] == "as given" and group["sun"] == "up" and group["region"] == region:
                return group["mean"]
    return None


def main():
    tyndall = sys.argv[1]
    images = ROOT / "docs" / "images"
    drawn = []
    for name, title, settings, row in MODELS:
        path = images / f"models_{name}.png"
        try:
            if "--keep-pictures" not in sys.argv or not path.exists():
                run(tyndall, "render", str(SCENE), "--size", SIZE, "-o", str(path), *sets(settings))
        except RuntimeError as error:
            print(f"{name}: left out: {error}", file=sys.stderr)
            path.unlink(missing_ok=True)
            continue
        drawn.append((name, title, settings, row, pixels(path)))
    by_name = {entry[0]: entry[4] for entry in drawn}

    bare = passes(tyndall, ["scattering.enabled=false"])[0]["terrain"]
    lines = ["# Every model on one scene", "",
             "Made by `make models-study`. The scene is `scenes/models.toml`.", ""]
    measured = [passes(tyndall, settings) for _, _, settings, _, _ in drawn]
    bare_again = passes(tyndall, ["scattering.enabled=false"])[0]["terrain"]
    quiet = abs(bare_again - bare) <= QUIET * bare
    if "--validation" in sys.argv:
        validation = json.loads(pathlib.Path(sys.argv[sys.argv.index("--validation") + 1]).read_text())
    else:
        validation = json.loads(run(tyndall, "validate", "--json"))
    rows = []
    device = measured[0][2]
    for (name, title, settings, row, picture), (times, effect, _) in zip(drawn, measured):
        air = effect if effect > 0 else times["terrain"] + times["sky"] - bare
        twin = by_name.get(name.replace("_vertex", "_pixel")) if name.endswith("_vertex") else None
        if name == "atmosphere":
            twin = by_name.get("brute_force")
        near = f"{difference_db(picture, twin):.1f}" if twin else ""
        errors = [mean_error(validation, row, region) if row else None for region in ("ground", "air", "space")]
        rows.append((title, f"{air:.1f}" if quiet else "", near, [f"{100 * e:.1f}" if e is not None else "" for e in errors]))
    lines += [f"Cost: milliseconds that the air adds to a frame of {COST_SIZE} on {device}, median of {COST_FRAMES}, over the",
              f"bare ground's {bare:.0f} ms before and {bare_again:.0f} ms after, in one run; empty where those differ too much to tell. Per pixel: decibels between the picture and that of the same model for",
              f"every pixel, at {SIZE}. Error: mean against the path tracer, per cent of the ray's brightest channel, sun up, medium as given,",
              "for eyes on the ground, in the air and in space; all orders for `atmosphere`, the first for the others.", "",
              "| model | cost, ms | per pixel, dB | error, ground | air | space |", "|---|--:|--:|--:|--:|--:|"]
    for title, air, near, errors in rows:
        lines.append(f"| {title} | {air} | {near} | {errors[0]} | {errors[1]} | {errors[2]} |")
    (ROOT / "docs" / "generated" / "models.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
