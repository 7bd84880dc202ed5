#!/usr/bin/env python3
"""Prints the page docs/generated/costs.md: what each technique and feature of the effect costs on this device.

    tools/costs.py FOLDER [--rounds N] [--frames N] [--builds N]

FOLDER contains the programs tyndall and library_costs. All cases are measured in every round, and medians over the rounds are printed,
so that a disturbance of the machine affects all cases alike.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = "scenes/demo.toml"
SIZE = "1280x720"
RGB = ["scattering.color=rgb"]
# Title, settings, size. The scene itself sets single=integration and color=spectral.
CASES = [
    ("epipolar sampling", RGB, SIZE),
    ("`scattering.color=spectral`", [], SIZE),
    ("`scattering.single=table`", RGB + ["scattering.single=table"], SIZE),
    ("`scattering.multiple=occluded`", RGB + ["scattering.multiple=occluded"], SIZE),
    ("`scattering.light_shafts=false`", RGB + ["scattering.light_shafts=false"], SIZE),
    ("`epipolar.min_max_tree=false`", RGB + ["epipolar.min_max_tree=false"], SIZE),
    ("`scattering.downscale=2`", RGB + ["scattering.downscale=2"], SIZE),
    ("`scattering.downscale=4`", RGB + ["scattering.downscale=4"], SIZE),
    ("`froxels.enabled=true`, a volume for transparent surfaces beside the picture", RGB + ["froxels.enabled=true"], SIZE),
    ("`scattering.technique=froxels`", RGB + ["scattering.technique=froxels"], SIZE),
    ("`scattering.technique=brute-force`", RGB + ["scattering.technique=brute-force"], SIZE),
    ("epipolar sampling, 1920 × 1080", RGB, "1920x1080"),
    ("epipolar sampling, 2560 × 1440", RGB, "2560x1440"),
    ("epipolar sampling, 3840 × 2160", RGB, "3840x2160"),
]
SLOW = "technique="  # cases with this in a setting are measured with one frame a round


def run(command, **environment):
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                          env=os.environ | environment)
    if done.returncode != 0:
        sys.exit(f"costs: error: {' '.join(map(str, command))}: status {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def bench(folder, settings, size, frames):
    """Returns the milliseconds of the effect and of the copy baseline, and the device."""
    slow = any(SLOW in setting for setting in settings)
    command = [folder / "tyndall", "bench", SCENE, "--json", "--size", size, "--frames", str(1 if slow else frames)]
    for setting in ["camera.samples=1", *settings]:
        command += ["--set", setting]
    report = run(command)
    return report["effect_ms"], report["floor_ms"], report["device"]


def build(folder, color):
    """Returns the milliseconds of building the default tables. An empty cache makes sure that they are built."""
    with tempfile.TemporaryDirectory() as cache:
        report = run([folder / "tyndall", "tables", "--json", "--set", f"scattering.color={color}"], XDG_CACHE_HOME=cache)
    return sum(stage["ms"] for stage in report["stages"])


def milliseconds(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|---|" + "--:|" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--builds", type=int, default=2)
    options = parser.parse_args()
    times = {title: [] for title, _, _ in CASES}
    builds = {"rgb": [], "spectral": []}
    for number in range(options.rounds):
        for title, settings, size in CASES:
            times[title].append(bench(options.folder, settings, size, options.frames))
        if number < options.builds:
            for color, found in builds.items():
                found.append(build(options.folder, color))
    library = run([options.folder / "library_costs", str(options.frames)])
    effect = {title: statistics.median(one[0] for one in found) for title, found in times.items()}
    floor = statistics.median(one[1] for title, _, size in CASES for one in times[title] if size == SIZE)
    usual = effect[CASES[0][0]]
    print(f"""# Costs

`make costs` made this page on {times[CASES[0][0]][0][2]}, with medians over `--rounds {options.rounds}`. Times are in milliseconds on the
device. The copy baseline is a pass that only reads colour and depth and writes colour at the same size, the least that any effect can
cost. Compare ratios between machines, not times. No GPU has been measured.

## Techniques and features

`{SCENE}` at {SIZE.replace("x", " × ")} with `scattering.color=rgb`, `camera.samples=1` and four shadow maps of 1024², unless stated
otherwise. The copy baseline at this size takes {milliseconds(floor)} ms.
""")
    rows = []
    for title, _, size in CASES:
        copies = statistics.median(one[0] / one[1] for one in times[title])
        relative = f"{effect[title] / usual:.2f}"
        rows.append([title, milliseconds(effect[title]), f"{copies:.1f}", relative])
    table(["", "effect, ms", "copy baselines", "relative to the first row"], rows)
    print("## Tables\n\nThe build of the default tables, once per atmosphere.\n")
    rgb, spectral = (statistics.median(builds[color]) for color in ("rgb", "spectral"))
    table(["`scattering.color`", "ms", "relative"],
          [["rgb", milliseconds(rgb), "1.00"], ["spectral", milliseconds(spectral), f"{spectral / rgb:.2f}"]])
    print("""## Clouds

A level view of the bare planet at 1280 × 720 without shadow maps, with `scattering.single=integration`. The map of clouds has 512²
texels and covers 50 km.
""")
    table(["frame", "ms", "relative"], [["without clouds", milliseconds(library["no_clouds"]), "1.00"],
                                        ["with clouds", milliseconds(library["clouds"]),
                                         f"{library['clouds'] / library['no_clouds']:.2f}"]])
    print("## Sky probe\n\nA complete update, which may be distributed over frames ([sky_probe.md](../sky_probe.md)).\n")
    names = {"sky_probe_0": "coefficients", **{f"sky_probe_{n}": f"with a cube map of {n}²" for n in (32, 64, 128)}}
    rows = [[title, milliseconds(library[name])] for name, title in names.items()]
    print("\n".join(["| update | ms |", "|---|--:|"] + [f"| {title} | {ms} |" for title, ms in rows]))


if __name__ == "__main__":
    main()
