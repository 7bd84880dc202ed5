#!/usr/bin/env python3
"""Measures the errors of narrow phase functions against the path tracer, and prints docs/generated/phase.md.

usage: tools/phase_limits.py TYNDALL [--samples N]

Three sets of rays from sea level: all directions, rays near the sun, and the sky's irradiance. The atmosphere is the
default one with an aerosol of each phase function and an optical depth of 0.15, and that of Mars at sunset. Needs only
Python."""

import argparse
import csv
import io
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARS = ROOT / "scenes/air/mars.toml"
PHASES = [("cornette-shanks, g = 0.76 (default)", ["atmosphere.mie_phase=cornette-shanks"])] + [
    (f"draine, {d} µm", ["atmosphere.mie_phase=draine", f"atmosphere.droplet_diameter_um={d}"]) for d in (3, 20)]
AEROSOL = ["atmosphere.aerosol_optical_depth=0.15"]
RINGS, SPOKES = 60, 40  # rays of the sum over the sky
SUNS = [75.0, 45.0, 20.0, 6.0]
NEAR = [1.0, 2.0, 4.0, 8.0, 16.0]  # angles from the sun [deg]


def probe(tyndall, rows, model, settings, *options, scene=None):
    """Returns the answers of `tyndall probe` as lists of three numbers, and their standard errors in the same units."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "queries.csv"
        path.write_text("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n" + "\n".join(rows) + "\n")
        command = [tyndall, "probe", *([str(scene)] if scene else []), "--queries", str(path), "--model", model]
        command += options
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    answers = list(csv.DictReader(io.StringIO(done.stdout)))
    names = ("X", "Y", "Z") if "Y" in answers[0] else ("L_r", "L_g", "L_b")
    values = [[float(a[n]) for n in names] for a in answers]
    if "stderr_g" not in answers[0]:
        return values, None
    # Luminance has no column of errors. Its relative error is that of green.
    relative_errors = [float(a["stderr_g"]) / float(a["L_g"]) for a in answers]
    errors = [[float(a[f"stderr_{c}"]) for c in "rgb"] for a in answers]
    if names[1] == "Y":
        errors = [[e * y for y in v] for e, v in zip(relative_errors, values)]
    return values, errors


def even_rays(count):
    """Returns rays above the horizon, evenly spread over directions and suns (additive recurrence)."""
    g = 1.2207440846057596  # of three dimensions
    rows = []
    for i in range(count):
        u = [(0.5 + (i + 1) / g ** k) % 1.0 for k in (1, 2, 3)]
        rows.append(f"0,{math.degrees(math.acos(0.98 * u[0] + 0.02)):.4f},{5.0 + 80.0 * u[1]:.4f},{180.0 * u[2]:.4f}")
    return rows


def near_rays(suns):
    """Returns rays at small angles above the sun, and beside it at the sun's elevation."""
    rows = []
    for sun in suns:
        for angle in NEAR:
            rows.append(f"0,{90.0 - min(sun + angle, 89.9)},{90.0 - sun},0")
            half = math.sin(math.radians(angle) / 2.0) / math.cos(math.radians(sun))
            rows.append(f"0,{90.0 - sun},{90.0 - sun},{math.degrees(2.0 * math.asin(min(half, 1.0)))}")
    return rows


def relative(found, truth, errors):
    """Returns the signed errors of all channels and the noise, relative to the largest channel [%]."""
    out, noise = [], []
    for a, b, e in zip(found, truth, errors):
        largest = max(b)
        out += [100.0 * (x - y) / largest for x, y in zip(a, b)]
        noise += [100.0 * x / largest for x in e]
    return out, sum(noise) / len(noise)


def summary(errors):
    sizes = sorted(abs(e) for e in errors)
    at_95 = sizes[min(math.ceil(0.95 * len(sizes)) - 1, len(sizes) - 1)]
    return f"{sum(sizes) / len(sizes):.2f} | {at_95:.2f} | {sizes[-1]:.2f}"


def print_rays(tyndall, samples):
    print("## Radiance\n\nThe model is `precomputed`. All errors are in per cent, as in [accuracy.md](accuracy.md).\n")
    print("| phase function | rays | mean | 95 % | worst | noise |\n|---|---|--:|--:|--:|--:|")
    for title, rows in (("all directions", even_rays(60)), ("1° to 16° from the sun", near_rays([45.0, 6.0]))):
        for name, phase in PHASES:
            truth, errors = probe(tyndall, rows, "reference", phase + AEROSOL, "--samples", str(samples))
            found, _ = probe(tyndall, rows, "precomputed", phase + AEROSOL)
            off, noise = relative(found, truth, errors)
            print(f"| {name} | {title} | {summary(off)} | {noise:.2f} |", flush=True)


def summed_irradiance(tyndall, sun, settings):
    """Returns the irradiance by order 1 in the green channel: a sum over rays in polar coordinates about the sun."""
    zenith = math.radians(90.0 - sun)
    rows, weights = [], []
    for i in range(RINGS):
        u = (i + 0.5) / RINGS
        angle = math.pi * u ** 3  # dense near the sun
        ring = math.sin(angle) * 3.0 * math.pi * u * u / RINGS * 2.0 * math.pi / SPOKES
        for k in range(SPOKES):
            spoke = math.pi * (k + 0.5) / SPOKES
            up = math.cos(angle) * math.cos(zenith) + math.sin(angle) * math.sin(zenith) * math.cos(spoke)
            if up <= 0.0:
                continue
            along = math.cos(angle) * math.sin(zenith) - math.sin(angle) * math.cos(zenith) * math.cos(spoke)
            azimuth = math.degrees(math.atan2(math.sin(angle) * math.sin(spoke), along))
            rows.append(f"0,{math.degrees(math.acos(up)):.9f},{90.0 - sun},{azimuth:.9f}")
            weights.append(ring * up)
    found, _ = probe(tyndall, rows, "single", settings)
    return sum(w * radiance[1] for w, radiance in zip(weights, found))


def print_irradiance(tyndall):
    print("\n## Irradiance of the sky\n\nThe errors of order 1 in the green channel, in per cent, by the elevation of the "
          "sun. The reference is a sum over rays of\nthe model `single`, in polar coordinates about the sun, which has no "
          "noise.\n")
    print("| phase function | model | " + " | ".join(f"{s:g}°" for s in SUNS) + " |")
    print("|---|---|" + "--:|" * len(SUNS))
    rows = [f"0,sky,{90.0 - sun},0" for sun in SUNS]
    for name, phase in PHASES:
        truth = [summed_irradiance(tyndall, sun, phase + AEROSOL) for sun in SUNS]
        for model, settings in (("single", []), ("precomputed", ["tables.orders=1"])):
            found, _ = probe(tyndall, rows, model, phase + AEROSOL + settings)
            cells = [f"{100.0 * (a[1] / b - 1.0):+.2f}" for a, b in zip(found, truth)]
            print(f"| {name} | {model} | " + " | ".join(cells) + " |", flush=True)


def print_mars(tyndall, samples):
    print("\n## Mars at sunset\n\nRays above the sun in the atmosphere of `scenes/air/mars.toml`, with the sun at 4°. "
          "The errors of luminance, in per cent, by\nthe angle from the sun.\n")
    print("| model | " + " | ".join(f"{a:g}°" for a in NEAR) + " | noise |\n|---|" + "--:|" * (len(NEAR) + 1))
    rows = [f"0,{86.0 - a},86,0" for a in NEAR]
    truth, errors = probe(tyndall, rows, "reference", [], "--orders", "16", "--samples", str(10 * samples), scene=MARS)
    noise = max(100.0 * e[1] / b[1] for e, b in zip(errors, truth))
    for name, settings in (("precomputed", []), ("precomputed, order 1 integrated", ["scattering.single=integration"])):
        found, _ = probe(tyndall, rows, "precomputed", settings, scene=MARS)
        cells = [f"{100.0 * (a[1] / b[1] - 1.0):+.1f}" for a, b in zip(found, truth)]
        print(f"| {name} | " + " | ".join(cells) + f" | {noise:.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tyndall", help="the program")
    parser.add_argument("--samples", type=int, default=6000, help="paths of the path tracer per ray [6000]")
    options = parser.parse_args()
    print("# Errors of narrow phase functions\n\nGenerated by `make phase-limits`. The aerosol has an optical depth of "
          "0.15. `noise` is the standard\nerror of the path tracer.\n")
    print_rays(options.tyndall, options.samples)
    print_irradiance(options.tyndall)
    print_mars(options.tyndall, options.samples)


if __name__ == "__main__":
    main()
