"""Compares the froxel volume with epipolar sampling and brute force, with `tyndall bench`, `render` and `compare`.

    tools/froxel_study.py TYNDALL [SCENE...]

Writes docs/generated/froxels.md and the pictures out/froxels_*.png. Times are medians of three frames, of brute force of one frame.
The PSNR is that of tone-mapped pictures at fixed exposure. With names of scenes, the tables of the others stay.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/generated/froxels.md"
SIZE = "1280x720"
SCENES = {"demo": ("scenes/demo.toml", []), "noon": ("scenes/noon.toml", []),
          "hall": ("scenes/hall.toml", ["froxels.near_m=10", "froxels.far_m=100"])}
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


def benches(tyndall, scene, extra):
    """Returns the reports of all techniques."""
    out = {}
    for name, settings in TECHNIQUES.items():
        frames = "1" if name == "brute force" else "3"
        out[name] = json.loads(run(tyndall, "bench", scene, *options(settings + extra, SIZE), "--frames", frames, "--json"))
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


def section(tyndall, name):
    """Returns the lines of a scene, and the device."""
    scene, extra = SCENES[name]
    set_by = f" with `{' '.join(extra)}`" if extra else ""
    lines = [f"Scene `{scene}`{set_by}:", ""]
    with tempfile.TemporaryDirectory() as scratch:
        reports = benches(tyndall, scene, extra)
        device = reports["epipolar sampling"]["device"]
        lines += ["| technique | PSNR [dB] | volume [ms] | whole effect [ms] | relative to epipolar sampling |",
                  "|---|--:|--:|--:|--:|"]
        for technique, settings in TECHNIQUES.items():
            effect = reports[technique]["effect_ms"]
            relative = effect / reports["epipolar sampling"]["effect_ms"]
            passes = reports[technique]["passes"]
            marched = sum(p["median_ms"] for p in passes if p["name"] == "froxels")
            part = f"{marched:.0f}" if "froxels" in technique else "–"
            quality = "–"
            if technique != "brute force":
                save = ROOT / f"out/froxels_{name}.png" if settings == volume(*VOLUMES[1]) else None
                quality = psnr(tyndall, scratch, scene, settings + extra, SIZE, save)
            lines.append(f"| {technique} | {quality} | {part} | {effect:.0f} | {relative:.1f} |")
        own = psnr(tyndall, scratch, scene, volume(*VOLUMES[1]) + extra, "160x90")
        lines += ["", f"At the resolution of the volume, 160 × 90 pixels: {own} dB.", ""]
    return lines, device


def main():
    tyndall = str(pathlib.Path(sys.argv[1]).resolve())
    (ROOT / "out").mkdir(exist_ok=True)
    chosen = sys.argv[2:] or list(SCENES)
    known = {}
    for text in PAGE.read_text(encoding="utf-8").split("Scene `")[1:] if PAGE.exists() else []:
        known[text.partition("`")[0]] = ("Scene `" + text).rstrip().split("\n") + [""]
    lines = []
    device = "other devices"
    for name, (scene, _) in SCENES.items():
        if name in chosen:
            made, device = section(tyndall, name)
            known[scene] = made
        lines += known.get(scene, [])
    head = [f"`make froxel-study` made these tables on {device}, at {SIZE}. Where a machine is shared, times are uncertain by a factor",
            "of two.", ""]
    PAGE.write_text("\n".join(head + lines).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
