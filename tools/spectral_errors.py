#!/usr/bin/env python3
"""Prints the errors of the tables with scattering.color = spectral against the path tracer with 40 wavelengths, with so many
paths that the noise of the path tracer does not hide them.

    PYTHONPATH=build/release/python tools/spectral_errors.py [--rays N] [--noise PERCENT] [--seed N] [--set KEY=VALUE]...

The rays start at sea level and point 2 to 90 degrees above the horizon, at random azimuths. For every group of suns, N of
them are traced until the standard error of the luminance is below --noise. The Python package for these scripts is that of the
build (docs/python.md)."""
import argparse
import sys

import numpy as np

import tyndall

GROUPS = [(60, 14), (10, 4), (2, 0), (-2, -6)]  # elevations of the sun [deg]
FIRST = 20000                                   # paths of the first estimate, which determines their number
MOST = 4000000


def chromaticity(xyz):
    """Returns u' and v' (CIE 1976)."""
    x, y, z = xyz
    return np.array([4.0 * x, 9.0 * y]) / (x + 15.0 * y + 3.0 * z)


def reference(air, noise, *ray):
    first = air.trace(*ray, samples=FIRST)
    relative = first.standard_error[1] / first.value[1]
    samples = int(min(FIRST * max(relative / noise, 1.0) ** 2, MOST))
    return air.trace(*ray, samples=samples) if samples > FIRST else first


def parse_settings(assignments):
    settings = {}
    for assignment in assignments:
        key, sign, value = assignment.partition("=")
        if not sign:
            sys.exit(f"spectral_errors: error: --set {assignment}: expected KEY=VALUE")
        settings[key] = value
    return settings


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=int, default=10)
    parser.add_argument("--noise", type=float, default=0.25)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    if options.rays < 1 or not options.noise > 0.0:
        parser.error("--rays, --noise: expected at least 1 and more than 0")
    air = tyndall.Atmosphere(parse_settings(options.set), color="xyz")
    random = np.random.default_rng(options.seed)
    print("| sun | luminance, mean | 95 % | worst | Δu′v′, mean | 95 % | noise |\n|---|--:|--:|--:|--:|--:|--:|")
    for high, low in GROUPS:
        errors, shifts, noises = [], [], []
        for _ in range(options.rays):
            ray = random.uniform(0.0, 88.0), 90.0 - random.uniform(low, high), random.uniform(0.0, 180.0)
            traced = reference(air, options.noise / 100.0, *ray)
            found = air.radiance(*ray)
            errors.append(100.0 * abs(found[1] / traced.value[1] - 1.0))
            shifts.append(np.hypot(*(chromaticity(found) - chromaticity(traced.value))))
            noises.append(100.0 * traced.standard_error[1] / traced.value[1])
        suns = f"{high}° to {low}°".replace("-", "−")
        print(f"| {suns} | {np.mean(errors):.2f} | {np.percentile(errors, 95):.2f} | {max(errors):.2f} | "
              f"{np.mean(shifts):.4f} | {np.percentile(shifts, 95):.4f} | {np.mean(noises):.2f} |", flush=True)


if __name__ == "__main__":
    main()
