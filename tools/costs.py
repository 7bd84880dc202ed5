#!/usr/bin/env python3
"""Prints the page docs/generated/costs.md: the milliseconds of the effect's passes by resolution, on this device.

usage: tools/costs.py TYNDALL [--scene SCENE] [--frames N] [--device DEVICE]"""

import argparse
import json
import subprocess
import sys

SIZES = ["1280x720", "1920x1080", "2560x1440", "3840x2160"]
# The passes of each group; the names are those of docs/generated/passes.md.
GROUPS = [("slices, samples, refinement", ["slice_end_points", "slice_directions", "slice_samples", "refine_samples"]),
          ("min/max trees", ["min_max_tree"]),
          ("marching", ["march_samples"]),
          ("interpolation between samples", ["interpolate_samples"]),
          ("back to pixels, corrections", ["unwarp", "unwarp_pixels", "correct_pixels"])]


def bench(options, size):
    command = [options.tyndall, "bench", options.scene, "--json", "--size", size, "--frames", str(options.frames),
               "--set", "camera.samples=1"]
    if options.device:
        command += ["--device", options.device]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"costs: error: bench at {size} failed with status {done.returncode}")
    return json.loads(done.stdout)


def row(name, values):
    print(f"| {name} | " + " | ".join(values) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tyndall")
    parser.add_argument("--scene", default="scenes/demo.toml")
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--device", default="")
    options = parser.parse_args()
    reports = [bench(options, size) for size in SIZES]
    known = {name for _, names in GROUPS for name in names}
    times = []
    for report in reports:
        passes = {}
        for one in report["passes"]:
            if one["in_effect"] and one["name"] != "effect":
                passes[one["name"]] = passes.get(one["name"], 0.0) + one["median_ms"]
        unknown = set(passes) - known
        if unknown:
            sys.exit(f"costs: error: passes without a group: {', '.join(sorted(unknown))}")
        times.append(passes)
    print("# Cost by resolution\n")
    print(f"`make costs` made this page on {reports[0]['device']}, from the median of {options.frames} frames of "
          f"`{options.scene}`\nwith one sample per pixel. Times are in milliseconds. The copy baseline is a pass that "
          "only reads depth and colour and\nwrites colour, measured in the same run: the least that any effect can "
          "cost. Compare ratios between machines, not times.\n")
    row("", [size.replace("x", " × ") for size in SIZES])
    print("|---|" + "--:|" * len(SIZES))
    for group, names in GROUPS:
        row(group, [f"{sum(passes.get(name, 0.0) for name in names):.1f}" for passes in times])
    row("effect", [f"{report['effect_ms']:.1f}" for report in reports])
    row("copy baseline", [f"{report['floor_ms']:.1f}" for report in reports])
    row("effect / copy baseline", [f"{report['effect_ms'] / report['floor_ms']:.1f}" for report in reports])


if __name__ == "__main__":
    main()
