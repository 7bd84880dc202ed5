"""Compares the froxel volume with epipolar sampling and brute force, with `tyndall bench`, `render` and `compare`.

    tools/froxel_study.py TYNDALL

Writes docs/generated/froxels.md and the pictures out/froxels_*.png. Times are medians of three frames, of brute force of one frame.
The PSNR is that of tone-mapped pictures at fixed exposure.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/generated/froxels.md"
SIZE = "1280x720"
SCENES = {"demo": "scenes/demo.toml", "noon": "scenes/noon.toml", "hall": "scenes/hall.toml"}
COMMON = ["camera.samples=1", "tonemap.auto_exposure=false"]
VOLUMES = [(80, 45, 32), (160, 90, 64), (320, 180, 128)]


def volume(columns, rows, slices):
    return ["scattering.technique=froxels", f"froxels.columns={columns}", f"froxels.rows={rows}",
            f"froxels.slices={slices}"]


TECHNIQUES = {"brute force": ["scattering.technique=brute-force"], "epipolar sampling": ["scattering.technique=epipolar"]}
TECHNIQUES |= {f"froxels {c} × {r} × {s}": volume(c, r, s) for c, r, s in VOLUMES}


def run(tyndall, *arguments):
    done = subprocess.run([tyndall, *arguments], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"tyndall {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def options(settings, size):
    out = ["--size", size]
    for setting in COMMON + settings:
        out += ["--set", setting]
    return out


def benches(tyndall, scene):
    """Returns the reports of all techniques."""
    out = {}
    for name, settings in TECHNIQUES.items():
        frames = "1" if name == "brute force" else "3"
        out[name] = json.loads(run(tyndall, "bench", scene, *options(settings, SIZE), "--frames", frames, "--json"))
    return out


def psnr(tyndall, scratch, scene, settings, size, save=None):
    """Compares a technique with brute force at the same size."""
    reference = pathlib.Path(scratch) / f"{pathlib.Path(scene).stem}_{size}.png"
    paths = [str(save or f"{scratch}/picture.png"), str(reference)]
    run(tyndall, "render", scene, *options(settings, size), "-o", paths[0])
    if not reference.exists():
        run(tyndall, "render", scene, *options(TECHNIQUES["brute force"], size), "-o", paths[1])
    done = subprocess.run([tyndall, "compare", *paths, "--json"], cwd=ROOT, capture_output=True, text=True)
    value = json.loads(done.stdout)["psnr_db"]
    return f"{value:.1f}" if value is not None else "equal"


def main():
    tyndall = str(pathlib.Path(sys.argv[1]).resolve())
    (ROOT / "out").mkdir(exist_ok=True)
    lines = []
    with tempfile.TemporaryDirectory() as scratch:
        for name, scene in SCENES.items():
            reports = benches(tyndall, scene)
            device = reports["epipolar sampling"]["device"]
            lines += [f"Scene `{scene}`:", "",
                      "| technique | PSNR [dB] | volume or samples [ms] | whole effect [ms] | copy baselines |",
                      "|---|--:|--:|--:|--:|"]
            for technique, settings in TECHNIQUES.items():
                effect = reports[technique]["effect_ms"]
                baselines = effect / reports[technique]["floor_ms"]
                passes = reports[technique]["passes"]
                marched = sum(p["median_ms"] for p in passes if p["name"] in ("froxels", "march_per_pixel"))
                part = f"{marched:.0f}" if "froxels" in technique else "–"
                quality = "–"
                if technique != "brute force":
                    save = ROOT / f"out/froxels_{name}.png" if settings == volume(*VOLUMES[1]) else None
                    quality = psnr(tyndall, scratch, scene, settings, SIZE, save)
                lines.append(f"| {technique} | {quality} | {part} | {effect:.0f} | {baselines:.1f} |")
            own = psnr(tyndall, scratch, scene, volume(*VOLUMES[1]), "160x90")
            lines += ["", f"At the resolution of the volume, 160 × 90 pixels: {own} dB.", ""]
    head = [f"`make froxel-study` made these tables on {device}, at {SIZE}. A copy baseline is the time of a pass that only",
            "reads colour and depth and writes colour, in the same run.", ""]
    PAGE.write_text("\n".join(head + lines).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
