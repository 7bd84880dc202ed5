#!/usr/bin/env python3
"""Compares epipolar sampling with brute force under many suns, each picture at its own exposure.

    tools/epipolar_suns.py TYNDALL [--suns 4,-7] [--size WxH] [--aerosol X] [--views NAME;...] [--psnr-min X]
                           [--reference DIR] [--pictures DIR] [--subpixel] [--set KEY=VALUE]...

Renders every view under every sun with both techniques, in one process and one sequence per technique. Prints a table of
the PSNR and the largest error of the tone-mapped pictures. --pictures stores the pictures and their differences times 16.
--reference stores the pictures of brute force and reuses those that are present. The exit status is 2 if a picture is
below --psnr-min. Needs only Python.

--subpixel measures how much of the difference brute force has within one pixel. It renders eight more pictures by brute
force, for views that are turned by a third of a pixel to every side. A second table lists for each view the pixels where
the techniques differ by more than 2 of 255, and those of them where the value of epipolar sampling is also more than 2
outside the range of the nine values of brute force. With --pictures, NNNN_outside.png shows this excess times 16.
Needs python3-pil and python3-numpy.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

SUNS = [90, 60, 30, 15, 8, 4, 2, 1, 0, -1, -2, -3, -4, -5, -6, -7, -8, -9, -10, -12, -14, -16, -18]
SUN_AZIMUTH = 5.4
VIEW_HEIGHT_DEG = 45.0  # camera.fov_deg
TOLERANCE = 2           # of 255
PLACES = {"valley": (-13000.0, 1350.0, 14000.0), "8 km": (0.0, 8000.0, 0.0)}
# Yaw of the view relative to the azimuth of the sun. `beside` leaves the sun outside the picture, `across` nearly at a right
# angle to the view, and `opposite` behind the camera.
DIRECTIONS = {"towards": 0.0, "beside": 60.0, "across": 87.0, "opposite": 180.0}
VIEWS = [f"{place}, {direction}" for place in PLACES for direction in DIRECTIONS]


def pitch_towards(sun):
    """Returns the pitch at which the picture shows the sun and, if both fit, the horizon."""
    return max(8.0, min(sun - 10.0, 60.0))


def scene(frames, yaw_shift=0.0, pitch_shift=0.0):
    lines = ["[tonemap]", "auto_exposure = true", "light_adaptation = false"]
    for i, (sun, view) in enumerate(frames + frames[-1:]):  # a path has at least two key frames
        place, direction = view.split(", ")
        pitch = pitch_towards(sun) if direction == "towards" else 8.0
        lines += ["[[path]]", f"time_s = {float(i)}", f"position_m = {list(PLACES[place])}",
                  f"yaw_deg = {SUN_AZIMUTH + DIRECTIONS[direction] + yaw_shift}", f"pitch_deg = {pitch + pitch_shift}",
                  f"sun_elevation_deg = {float(sun)}", f"sun_azimuth_deg = {SUN_AZIMUTH}"]
    return "\n".join(lines) + "\n"


def run(*arguments, allowed=(0,)):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    if done.returncode not in allowed:
        sys.exit(f"{' '.join(str(a) for a in arguments)}: {done.stderr.strip()}")
    return done.stdout


def render(tyndall, folder, frames, options, *settings, shift=(0.0, 0.0)):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "suns.toml"
    path.write_text(scene(frames, *shift))
    values = list(options.set) + list(settings)
    if options.aerosol != 1.0:
        values.append(f"atmosphere.aerosol_density={options.aerosol}")
    sets = [a for value in values for a in ("--set", value)]
    run(tyndall, "render", path, "--size", options.size, "--frames", len(frames), "--time-step", 1, *sets,
        "-o", folder / "%04d.png")


def subpixel_shifts(options):
    """Returns eight turns of the view in degrees, by a third of a pixel each."""
    third = VIEW_HEIGHT_DEG / int(options.size.split("x")[1]) / 3.0
    return [(third * x, third * y) for y in (-1, 0, 1) for x in (-1, 0, 1) if (x, y) != (0, 0)]


def measure_subpixel(options, pictures, reference, frames, names):
    """Prints, for every picture, how many pixels differ, and how many are outside the range within the pixel."""
    import numpy
    from PIL import Image

    def load(path):
        return numpy.asarray(Image.open(path).convert("RGB")).astype(int)

    shifts = subpixel_shifts(options)
    folders = [reference / f"shift_{i}" for i in range(len(shifts))]
    for folder, shift in zip(folders, shifts):
        if not all((folder / name).exists() for name in names):
            render(options.tyndall, folder, frames, options, "scattering.technique=brute-force", shift=shift)
    print("\n| sun | view | differ by more than 2 | outside the range by more than 2 | "
          "mean change of brute force by a third of a pixel | mean difference |")
    print("|--:|---|--:|--:|--:|--:|")
    for name, (sun, view) in zip(names, frames):
        epipolar, brute = load(pictures / name), load(reference / name)
        values = numpy.stack([brute] + [load(folder / name) for folder in folders])
        outside = numpy.maximum(numpy.maximum(values.min(0) - epipolar, epipolar - values.max(0)), 0)
        differ = numpy.abs(epipolar - brute)
        visible = differ.max(2) > TOLERANCE
        changes = numpy.abs(values[1:] - brute).max(3)
        beyond = visible & (outside.max(2) > TOLERANCE)
        means = [changes[:, visible].mean(), differ.max(2)[visible].mean()] if visible.any() else [0.0, 0.0]
        print(f"| {sun:g}° | {view} | {visible.sum()} | {beyond.sum()} | {means[0]:.1f} | {means[1]:.1f} |", flush=True)
        if options.pictures:
            Image.fromarray(numpy.clip(16 * outside, 0, 255).astype(numpy.uint8)).save(
                pictures / name.replace(".png", "_outside.png"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tyndall")
    parser.add_argument("--suns", default=",".join(str(s) for s in SUNS))
    parser.add_argument("--views", default=";".join(VIEWS), help="separated by semicolons; all: " + "; ".join(VIEWS))
    parser.add_argument("--size", default="480x270")
    parser.add_argument("--aerosol", type=float, default=1.0)
    parser.add_argument("--psnr-min", type=float, default=0.0)
    parser.add_argument("--reference", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("--subpixel", action="store_true", help="measure what brute force has within one pixel")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    suns = [float(s) for s in options.suns.split(",")]
    views = options.views.split(";")
    frames = [(sun, view) for view in views for sun in suns]  # sun by sun in one view, because moving the terrain takes time
    with tempfile.TemporaryDirectory() as scratch:
        pictures = options.pictures or pathlib.Path(scratch) / "pictures"
        reference = options.reference or pathlib.Path(scratch) / "reference"
        names = [f"{i:04d}.png" for i in range(len(frames))]
        if not all((reference / name).exists() for name in names):
            render(options.tyndall, reference, frames, options, "scattering.technique=brute-force")
        render(options.tyndall, pictures, frames, options)
        results = []
        for name in names:
            diff = ["--diff", pictures / name.replace(".png", "_diff.png")] if options.pictures else []
            results.append(json.loads(run(options.tyndall, "compare", pictures / name, reference / name, *diff, "--json")))
        print("| sun | " + " | ".join(views) + " |")
        print("|--:|" + "--:|" * len(views))
        by_frame = dict(zip(frames, results))
        for sun in suns:
            cells = [by_frame[sun, view] for view in views]
            print(f"| {sun:g} | " + " | ".join(f"{c['psnr_db']:.1f} ({c['max_abs']:.2f})" for c in cells) + " |")
        worst = min(range(len(frames)), key=lambda i: results[i]["psnr_db"])
        print(f"\nWorst: {results[worst]['psnr_db']:.2f} dB, sun at {frames[worst][0]:g} degrees, {frames[worst][1]}.")
        if options.subpixel:
            measure_subpixel(options, pictures, reference, frames, names)
    sys.exit(0 if results[worst]["psnr_db"] >= options.psnr_min else 2)


if __name__ == "__main__":
    main()
