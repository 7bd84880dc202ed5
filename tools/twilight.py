#!/usr/bin/env python3
"""Prints the illuminance of the sun and the clear sky on a horizontal surface, by elevation of the sun, next to the
published curve of twilight.

The curve is that of Seidelmann (ed.), "Explanatory Supplement to the Astronomical Almanac" (1992), section 9.3, after
Janiczek and DeYoung (1987): the decimal logarithm of the illuminance in lux is a polynomial of the elevation over 90
degrees. Elevations are those of the sun without refraction.

The curve is measured, so it contains the light of the night sky: 0.00064 lux at -18 degrees, where twilight has ended. Both
columns therefore include a uniform sky of NIGHT_CD_PER_M2. Below the horizon, the illuminance by the tables is the sum over
rays of their radiance, because the table of the sky's irradiance has half precision, which is too coarse below -8 degrees.
Few of the path tracer's paths contribute most of the light there, so it follows more of them.

usage: tools/twilight.py TYNDALL [--samples N]"""

import argparse
import csv
import io
import math
import os
import re
import subprocess
import sys
import tempfile

# Lower end of the elevations, and the coefficients.
SEIDELMANN = [(20.0, (3.74, 3.97, -4.07, 1.47)), (5.0, (3.05, 13.28, -45.98, 64.33)),
              (-0.8, (2.88, 22.26, -207.64, 1034.30)), (-5.0, (2.88, 21.81, -258.11, -858.36)),
              (-12.0, (2.70, 12.17, -431.69, -1899.83)), (-18.0, (13.84, 262.72, 1447.42, 2797.93))]
ELEVATIONS = [90, 60, 40, 30, 20, 15, 10, 7, 5, 3, 2, 1, 0, -1, -2, -3, -4, -5, -6, -7, -8, -9, -10, -11, -12]
# Airglow, starlight and zodiacal light: 21.9 magnitudes per square arc second (Leinert et al. 1998), as in docs/scenes.md.
NIGHT_CD_PER_M2 = 1.7e-4
DEEP = -6.5         # elevations below have this many times as many paths:
DEEP_FACTOR = 20
ZENITHS, AZIMUTHS = 24, 24  # rays of the sum over the sky, in a half circle of azimuths
# Clear air: the average continental aerosol of scenes/air over ground with a mean albedo. The real atmosphere is thinner
# between 30 and 80 km than an exponential one of 8 km, which would be up to twice as bright in twilight: 7.0 km fits its
# density there, and the pressure preserves the column.
AIR = ["atmosphere.aerosol_optical_depth=0.151", "atmosphere.angstrom_exponent=1.42",
       "atmosphere.single_scattering_albedo=0.925", "atmosphere.mie_scale_height_m=2013",
       "atmosphere.mie_phase=henyey-greenstein", "atmosphere.mie_g=0.703", "atmosphere.ozone_du=300",
       "atmosphere.pressure_hpa=1013.25", "atmosphere.rayleigh_scale_height_m=7000", "atmosphere.height_m=120000",
       "planet.ground_albedo=0.15",
       "scattering.color=spectral"]


def seidelmann(elevation):
    for low, coefficients in SEIDELMANN:
        if elevation >= low:
            x = elevation / 90.0
            return 10.0 ** sum(c * x ** i for i, c in enumerate(coefficients))
    raise ValueError(elevation)


def constants():
    """Returns the illuminance of the sun above the atmosphere [lux], and its colour, from the shaders' constants."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../shaders/shared/wavelengths.h")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    luminous = float(re.search(r"kSunLuminous\s*=\s*([0-9.e+-]+)", text).group(1))
    color = re.search(r"kSunColor\s*=\s*vec3\(([^)]*)\)", text).group(1)
    return 683.0 * luminous, [float(value) for value in color.split(",")]


def probe(tyndall, model, rows, options):
    """Returns the rows of `tyndall probe` for queries, which are rows of text."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "queries.csv")
        with open(path, "w", encoding="utf-8") as file:
            file.write("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n")
            file.writelines(row + "\n" for row in rows)
        command = [tyndall, "probe", "--queries", path, "--model", model] + options
        for setting in AIR:
            command += ["--set", setting]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stderr.strip())
    return list(csv.DictReader(io.StringIO(run.stdout)))


def sky_queries(elevations):
    return [f"0,sky,{90 - e},0" for e in elevations]


def sky_by_rays(tyndall, elevations):
    """Returns the illuminance of the sky [lux] by elevation: the sum over rays of the tables' radiance."""
    rows, weights = [], []
    for e in elevations:
        for i in range(ZENITHS):
            # The cosine of the zenith angle is the square of the variable, because twilight is brightest at the horizon.
            u = (i + 0.5) / ZENITHS
            for j in range(AZIMUTHS):
                rows.append(f"0,{math.degrees(math.acos(u * u))},{90 - e},{180.0 * (j + 0.5) / AZIMUTHS}")
                weights.append(u * u * 2.0 * u / ZENITHS * 2.0 * math.pi / AZIMUTHS)
    out = {e: 0.0 for e in elevations}
    for k, row in enumerate(probe(tyndall, "precomputed", rows, [])):
        out[elevations[k // (ZENITHS * AZIMUTHS)]] += weights[k] * float(row["Y"])
    return out


def trace(tyndall, elevations, samples):
    """Returns the rows of the path tracer by elevation."""
    out = {}
    for part, factor in (([e for e in elevations if e >= DEEP], 1), ([e for e in elevations if e < DEEP], DEEP_FACTOR)):
        rows = probe(tyndall, "reference", sky_queries(part), ["--samples", str(factor * samples)])
        out.update(zip(part, rows))
    return out


def direct(row, elevation, sun_lux, sun_color):
    """Returns the illuminance of the sun on a horizontal surface [lux]."""
    luminance = sum(weight * part * float(row[f"T_{name}"])
                    for weight, part, name in zip((0.2126, 0.7152, 0.0722), sun_color, "rgb"))
    return sun_lux * luminance * max(math.sin(math.radians(elevation)), 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tyndall", help="the program")
    parser.add_argument("--samples", type=int, default=30000, help="paths of the path tracer per elevation [30000]")
    options = parser.parse_args()
    sun_lux, sun_color = constants()
    tables = dict(zip(ELEVATIONS, probe(options.tyndall, "precomputed", sky_queries(ELEVATIONS), [])))
    by_rays = sky_by_rays(options.tyndall, [e for e in ELEVATIONS if e < 0])
    paths = trace(options.tyndall, ELEVATIONS, options.samples)
    night = math.pi * NIGHT_CD_PER_M2
    print("| sun | illuminance by the tables, lux | by the path tracer | published | tables / published | "
          "path tracer / published | noise of the path tracer | sky by `sky_irradiance`, lux |")
    print("|---|---|---|---|---|---|---|---|")
    for elevation in ELEVATIONS:
        table, path = tables[elevation], paths[elevation]
        others = direct(table, elevation, sun_lux, sun_color) + night
        by_tables = by_rays.get(elevation, float(table["Y"])) + others
        traced = float(path["Y"]) + others
        published = seidelmann(elevation)
        noise = float(path["stderr_g"]) / float(path["L_g"])
        print(f"| {elevation}° | {by_tables:.3g} | {traced:.3g} | {published:.3g} | {by_tables / published:.2f} | "
              f"{traced / published:.2f} | {100.0 * noise:.1f} % | {float(table['Y']):.3g} |")


if __name__ == "__main__":
    main()
