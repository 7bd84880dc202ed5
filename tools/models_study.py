"""Measures and renders all models on one scene: pictures, cost and error. `make models-study` runs it.

    models_study.py TYNDALL [pictures] [times] [errors] [--validation FILE.json]

Writes docs/images/models_*.png and docs/generated/models.md. Without an argument, all three parts run. Otherwise only the
named parts run, and the page retains its other columns. `times` takes a minute or two and needs an idle machine. The
errors come from `tyndall validate --json`, which runs unless its output is given."""
import json
import math
import pathlib
import statistics
import subprocess
import sys

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes" / "models.toml"
PAGE = ROOT / "docs" / "generated" / "models.md"
REGIONS = ("ground", "air", "space")
SIZE = "480x270"
COST_SIZE = "640x360"
COST_FRAMES = 3
NOT_OF_A_MODEL = ("shadow_maps", "tonemap", "measure_luminance", "adapt_exposure")  # passes that do not depend on the model
# The cost of a model is the difference between a frame with and without it. Small shadow maps and grey ground reduce the
# cost of the rest, and so the noise of that difference.
COST = ["terrain.shading=plain", "shadows.resolution=512", "shadows.cascades=2"]

# One row per model: name of its picture, title, settings, and the row of `validate` with its errors.
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
    ("oneil_column_vertex", "`oneil` with `oneil.spacing` = `column`, `vertex`",
     ["scattering.model=oneil", "oneil.spacing=column"], "oneil, points by column"),
    ("oneil_column_pixel", "`oneil` with `oneil.spacing` = `column`, `pixel`",
     ["scattering.model=oneil", "oneil.spacing=column", "scattering.evaluate=pixel"], "oneil, points by column"),
    ("oneil_table_vertex", "`oneil-table`, `vertex`", ["scattering.model=oneil-table"], "oneil-table"),
    ("oneil_table_pixel", "`oneil-table`, `pixel`",
     ["scattering.model=oneil-table", "scattering.evaluate=pixel"], "oneil-table"),
    ("medium_homogeneous", "`scattering.medium` = `homogeneous`", ["scattering.medium=homogeneous"], "homogeneous medium"),
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


def mean_error(validation, row, atmosphere, region):
    for model in validation["models"]:
        if model["name"] != row:
            continue
        for group in model["groups"]:
            if group["atmosphere"] == atmosphere and group["sun"] == "up" and group["region"] == region:
                return f"{100 * group['mean']:.1f}"
    return ""


def render_pictures(tyndall):
    """Renders all pictures and returns the PSNR between vertex and pixel evaluation, by title."""
    images = ROOT / "docs" / "images"
    seen = {}
    for name, _, settings, _ in MODELS:
        path = images / f"models_{name}.png"
        run(tyndall, "render", str(SCENE), "--size", SIZE, "-o", str(path), *sets(settings))
        seen[name] = pixels(path)
    out = {}
    for name, title, _, _ in MODELS:
        twin = "brute_force" if name == "atmosphere" else name.replace("_vertex", "_pixel")
        out[title] = f"{difference_db(seen[name], seen[twin]):.1f}" if twin != name and twin in seen else ""
    return out


def measure_times(tyndall):
    """Returns milliseconds by title, and the paragraph that describes the measurement."""
    def frame(settings):
        times, effect, device = passes(tyndall, settings)
        return sum(ms for name, ms in times.items() if name not in NOT_OF_A_MODEL), effect, device

    bare = [frame(["scattering.enabled=false"])[0]]
    taken = {}
    for count, (_, title, settings, _) in enumerate(MODELS):
        whole, effect, device = frame(settings)
        if count % 3 == 2:
            bare.append(frame(["scattering.enabled=false"])[0])
        # A model that is drawn with the ground costs the difference between its frame and one without the atmosphere.
        taken[title] = (effect, True) if effect > 0 else (whole - statistics.mean(bare), False)
    spread = statistics.pstdev(bare)
    cells = {title: f"{ms:.0f}" if exact else f"{ms:.0f} ± {spread:.0f}" for title, (ms, exact) in taken.items()}
    words = (f"The cost is the time in milliseconds that a model adds to a frame of {COST_SIZE} on {device}, as the median of {COST_FRAMES} frames, all in\n"
             "one run. For `atmosphere` and its medium it is the sum of the passes of the effect. The other models are drawn with the ground.\n"
             f"Their cost is therefore the difference to a frame without the atmosphere ({statistics.mean(bare):.0f} ms), with the standard deviation of\nthe latter.")
    return cells, words


def read_page():
    """Returns the rows of the page by title, and its paragraph about the times."""
    if not PAGE.exists():
        return {}, ""
    text = PAGE.read_text()
    rows = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("| `") else []
        if len(cells) == 3 + 2 * len(REGIONS):
            rows[cells[0]] = cells
    words = text[text.index("The cost is"):text.index("\n\nThe column")] if "The cost is" in text and "\n\nThe column" in text else ""
    return rows, words


def main():
    tyndall = sys.argv[1]
    parts = [a for a in sys.argv[2:] if a in ("pictures", "times", "errors")] or ["pictures", "times", "errors"]
    rows, words = read_page()
    titles = [title for _, title, _, _ in MODELS]
    rows = {title: rows.get(title, [title] + [""] * (2 + 2 * len(REGIONS))) for title in titles}
    if "times" in parts:  # first, before the machine is warm
        cells, words = measure_times(tyndall)
        for title in titles:
            rows[title][1] = cells[title]
    if "pictures" in parts:
        for title, near in render_pictures(tyndall).items():
            rows[title][2] = near
    if "errors" in parts:
        if "--validation" in sys.argv:
            validation = json.loads(pathlib.Path(sys.argv[sys.argv.index("--validation") + 1]).read_text())
        else:
            validation = json.loads(run(tyndall, "validate", "--json"))
        for _, title, _, row in MODELS:
            rows[title][3:] = [mean_error(validation, row, atmosphere, region)
                               for atmosphere in ("as given", "without ozone") for region in REGIONS]
    lines = ["# All models on one scene", "", "`make models-study` makes this page from `scenes/models.toml`.", "", words,
             f"\nThe column *per pixel* is the PSNR in dB against the same model evaluated at every pixel, at {SIZE}.",
             "\nThe other columns are mean errors against the path tracer with the sun up, in % of the largest channel of the ray, for eyes near",
             "the ground, inside the atmosphere and in space. The reference has the given medium, or the same medium without ozone, because only",
             "`atmosphere` has ozone. It has all orders of scattering for `atmosphere`, and order 1 for the other models.", "",
             "| model | cost, ms | per pixel, dB | ground | atmosphere | space | ground, no ozone | atmosphere, no ozone | space, no ozone |",
             "|---" + "|--:" * (2 + 2 * len(REGIONS)) + "|"]
    lines += ["| " + " | ".join(rows[title]) + " |" for title in titles]
    PAGE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
