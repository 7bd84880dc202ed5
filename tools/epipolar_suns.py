#!/usr/bin/env python3
"""Compares epipolar sampling with brute force under many suns, each picture at its own exposure.

    tools/epipolar_suns.py TYNDALL [--suns 4,-7] [--size WxH] [--aerosol X] [--views NAME;...] [--psnr-min X]
                           [--reference DIR] [--pictures DIR] [--set KEY=VALUE]...

Renders every view under every sun with both techniques, in one process and one sequence per technique. Prints a table of
the PSNR and the largest error of the tone-mapped pictures. --pictures stores the pictures and their differences times 16.
--reference stores the pictures of brute force and reuses those that are present. The exit status is 2 if a picture is
below --psnr-min. Needs only Python.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

SUNS = [90, 60, 30, 15, 8, 4, 2, 1, 0, -1, -2, -3, -4, -5, -6, -7, -8, -9, -10, -12, -14, -16, -18]
SUN_AZIMUTH = 5.4
PLACES = {"valley": (-13000.0, 1350.0, 14000.0), "8 km": (0.0, 8000.0, 0.0)}
# Yaw of the view relative to the azimuth of the sun. `beside` leaves the sun outside the picture, `opposite` behind the camera.
DIRECTIONS = {"towards": 0.0, "beside": 60.0, "opposite": 180.0}
VIEWS = [f"{place}, {direction}" for place in PLACES for direction in DIRECTIONS]


def pitch_towards(sun):
    """Returns the pitch at which the picture shows the sun and, if both fit, the horizon."""
    return max(8.0, min(sun - 10.0, 60.0))


def scene(frames):
    lines = ["[tonemap]", "auto_exposure = true", "light_adaptation = false"]
    for i, (sun, view) in enumerate(frames):
        place, direction = view.split(", ")
        pitch = pitch_towards(sun) if direction == "towards" else 8.0
        lines += ["[[path]]", f"time_s = {float(i)}", f"position_m = {list(PLACES[place])}",
                  f"yaw_deg = {SUN_AZIMUTH + DIRECTIONS[direction]}", f"pitch_deg = {pitch}",
                  f"sun_elevation_deg = {float(sun)}", f"sun_azimuth_deg = {SUN_AZIMUTH}"]
    return "\n".join(lines) + "\n"


def run(*arguments, allowed=(0,)):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    if done.returncode not in allowed:
        sys.exit(f"{' '.join(str(a) for a in arguments)}: {done.stderr.strip()}")
    return done.stdout


def render(tyndall, folder, frames, options, *settings):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "suns.toml"
    path.write_text(scene(frames))
    values = list(options.set) + list(settings)
    if options.aerosol != 1.0:
        values.append(f"atmosphere.aerosol_density={options.aerosol}")
    sets = [a for value in values for a in ("--set", value)]
    run(tyndall, "render", path, "--size", options.size, "--frames", len(frames), "--time-step", 1, *sets,
        "-o", folder / "%04d.png")


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
    sys.exit(0 if results[worst]["psnr_db"] >= options.psnr_min else 2)


if __name__ == "__main__":
    main()
