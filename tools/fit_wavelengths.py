#!/usr/bin/env python3
"""Chooses the four wavelengths of scattering.color = spectral, and fits the matrices that turn light at them into colour.

Evaluates radiances of many rays at 40 wavelengths with `tyndall probe`, in several atmospheres. Tries every set of four
of these wavelengths: fits one constant 4x3 matrix to the CIE XYZ values of the sum over all 40, on the atmospheres of the
fit, and measures the errors on the others. Writes shaders/shared/wavelengths.h and prints the tables of docs/spectral.md.
`--bins FILE` only writes the weights of the 40 wavelengths (src/reference/bins.inl). Needs no package beyond Python.
"""
import argparse
import csv
import glob
import itertools
import math
import os
import shutil
import subprocess
import sys
import tomllib

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from spectral_data import (CIE_1931, OZONE_CROSS_SECTION, REFLECTANCES, SOLAR_IRRADIANCE)  # noqa: E402

WAVELENGTHS = [385 + 10 * i for i in range(40)]  # centres of bins of 10 nm
LUMINOUS_EFFICACY = 683.0  # lm/W
# Linear Rec. 709 from CIE XYZ (IEC 61966-2-1; white D65).
REC709 = ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))
DOBSON = 2.6867e20  # molecules per m^2

# Weights of the squared errors of X, Y and Z relative to their sum. Errors of luminance count more than those of
# chromaticity.
IMPORTANCE = (1.0, 6.0, 1.0)
POWER_WEIGHT = 20.0  # of a power of the wavelength in the fit; a ray has 1

RAYLEIGH_550 = 1.2406e-6 / 0.55**4  # 1/m


def rayleigh(nm):
    return RAYLEIGH_550 * (550.0 / nm) ** 4


def angstrom(tau, exponent, albedo, scale_m=1200.0):
    """Returns the aerosol's scattering and extinction coefficients [1/m] as functions of the wavelength [nm]."""
    extinction = lambda nm: tau / scale_m * (550.0 / nm) ** exponent
    omega = albedo if callable(albedo) else lambda nm: albedo
    return (lambda nm: omega(nm) * extinction(nm)), extinction


def mars_albedo(nm):
    """Returns the single-scattering albedo of Martian dust (Ockert-Bell et al. 1997, rounded)."""
    table = ((300, 0.60), (440, 0.72), (500, 0.78), (550, 0.83), (600, 0.90), (670, 0.94), (800, 0.95))
    for (a, x), (b, y) in zip(table, table[1:]):
        if nm <= b:
            return x + (y - x) * (nm - a) / (b - a)
    return table[-1][1]


# name: part of the fit, factor on Rayleigh scattering, ozone [DU], aerosol, asymmetry, ground albedo, and optionally the
# scale height of the aerosol [m]
ATMOSPHERES = {
    "clean": (True, 1.0, 300.0, angstrom(0.065, 0.8, 0.92), 0.76, 0.1),
    "hazy": (True, 1.0, 300.0, angstrom(0.33, 1.3, 0.92), 0.76, 0.1),
    "urban": (False, 1.0, 340.0, angstrom(0.6, 1.4, 0.82), 0.70, 0.15),
    "maritime": (False, 1.0, 280.0, angstrom(0.1, 0.1, 0.997), 0.77, 0.06),
    "no ozone": (False, 1.0, 0.0, angstrom(0.1, 1.0, 0.92), 0.76, 0.1),
    "strong ozone": (False, 1.0, 600.0, angstrom(0.1, 1.0, 0.92), 0.76, 0.1),
    "optical depth 1": (False, 1.0, 300.0, angstrom(1.0, 0.2, 0.93), 0.72, 0.2),
    "Mars dust": (False, 0.01, 0.0, angstrom(0.5, 0.0, mars_albedo, 11000.0), 0.65, 0.2),
}


def presets():
    """Returns the aerosol presets of scenes/air, none of which is part of the fit."""
    out = {}
    for path in sorted(glob.glob(os.path.join(ROOT, "scenes/air/*.toml"))):
        with open(path, "rb") as file:
            scene = tomllib.load(file)
        air = scene["atmosphere"]
        if "planet" in scene or "aerosol_optical_depth" not in air or not isinstance(air.get("single_scattering_albedo"), float):
            continue  # another planet
        aerosol = angstrom(air["aerosol_optical_depth"], air["angstrom_exponent"], air["single_scattering_albedo"],
                           air["mie_scale_height_m"])
        name = os.path.basename(path)[:-5].replace("_", " ") + " (preset)"
        out[name] = (False, 1.0, air["ozone_du"], aerosol, air["mie_g"], 0.15, air["mie_scale_height_m"])
    return out


ATMOSPHERES.update(presets())
SUN_ELEVATIONS = (90, 60, 30, 14, 10, 7, 4, 2, 1, 0, -2, -4, -6)
GROUPS = (("14° and above", 14, 90), ("10° to 4°", 4, 10), ("2° to 0°", 0, 2), ("−2° to −6°", -6, -2))


def rays():
    """Returns the queries: altitude, view zenith angle or "sky", sun zenith angle, azimuth."""
    out = []
    for elevation in SUN_ELEVATIONS:
        sun = 90 - elevation
        for altitude in (0, 2000, 10000, 30000):
            out.append((altitude, "sky", sun, 0))
            for view in (0, 30, 60, 75, 85, 88, 89.5, 92, 100, 130, 180):
                out += [(altitude, view, sun, azimuth) for azimuth in (0, 60, 180)]
        for view in (180, 150, 120, 112, 110.2, 109.9, 109.6, 109.3):
            out += [(400000, view, sun, azimuth) for azimuth in (0, 60, 180)]
    return out


def evaluate(tyndall, name, work):
    """Returns for every query its radiance and transmittance at WAVELENGTHS, from the cache or by running `probe`."""
    path = os.path.join(work, name.replace(" ", "_") + ".csv")
    queries = rays()
    if not os.path.exists(path):
        _, molecules, ozone_du, (scattering, extinction), g, albedo, *scale_m = ATMOSPHERES[name]
        query_path = os.path.join(work, "queries.csv")
        with open(query_path, "w") as file:
            file.write("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n")
            file.writelines("%s,%s,%s,%s\n" % q for q in queries)
        columns = [[None] * 80 for _ in queries]
        for first in range(0, 40, 3):
            part = [min(first + k, 39) for k in range(3)]
            nm = [WAVELENGTHS[i] for i in part]
            peak = ozone_du * DOBSON / 15000.0
            vec = lambda values: ",".join("%.9g" % v for v in values)
            settings = {
                "atmosphere.custom_coefficients": "true",
                "atmosphere.wavelengths_nm": vec(nm),
                "atmosphere.rayleigh_scattering": vec(molecules * rayleigh(x) for x in nm),
                "atmosphere.mie_scattering": vec(scattering(x) for x in nm),
                "atmosphere.mie_absorption": vec(extinction(x) - scattering(x) for x in nm),
                "atmosphere.ozone_absorption": vec(peak * OZONE_CROSS_SECTION[i] for i in part),
                "atmosphere.mie_g": g,
                "planet.ground_albedo": albedo,
                "tables.cache": "off",
                "tables.size": "24,96,48,12",
            }
            if scale_m:
                settings["atmosphere.mie_scale_height_m"] = scale_m[0]
            if name == "Mars dust":
                settings.update({"planet.radius_m": 3389500, "atmosphere.height_m": 110000,
                                 "atmosphere.rayleigh_scale_height_m": 11000, "atmosphere.mie_scale_height_m": 11000})
            command = [tyndall, "probe", "--queries", query_path]
            for key, value in settings.items():
                command += ["--set", "%s=%s" % (key, value)]
            result = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            for row, line in zip(columns, csv.DictReader(result.splitlines())):
                for k, channel in enumerate("rgb"):
                    row[part[k]] = float(line["L_" + channel])
                    row[40 + part[k]] = float(line["T_" + channel])
        with open(path + ".part", "w") as file:
            file.writelines(",".join("%.9g" % v for v in row) + "\n" for row in columns)
        os.rename(path + ".part", path)
    with open(path) as file:
        values = [[float(v) for v in line.split(",")] for line in file]
    return [(q, row[:40], row[40:]) for q, row in zip(queries, values)]


def bin_weights():
    """Returns for every wavelength the weights of X, Y and Z for light relative to the sun's irradiance [W/m^2]."""
    out = []
    for i, nm in enumerate(WAVELENGTHS):
        cmf = [CIE_1931[nm + d] for d in (-5, 0, 5)]
        mean = [(a + 4.0 * b + c) / 6.0 for a, b, c in zip(*cmf)]  # Simpson's rule over the bin
        out.append([10.0 * SOLAR_IRRADIANCE[i] * m for m in mean])
    return out


def solve(matrix, right):
    """Solves a small symmetric positive system with several right sides, by Gaussian elimination with pivoting."""
    n = len(matrix)
    a = [list(row) + list(r) for row, r in zip(matrix, right)]
    for c in range(n):
        pivot = max(range(c, n), key=lambda r: abs(a[r][c]))
        if abs(a[pivot][c]) < 1e-300:
            return None
        a[c], a[pivot] = a[pivot], a[c]
        for r in range(c + 1, n):
            f = a[r][c] / a[c][c]
            for k in range(c, len(a[c])):
                a[r][k] -= f * a[c][k]
    out = [[0.0] * len(right[0]) for _ in range(n)]
    for c in reversed(range(n)):
        for k in range(len(right[0])):
            s = a[c][n + k] - sum(a[c][j] * out[j][k] for j in range(c + 1, n))
            out[c][k] = s / a[c][c]
    return out


def xyz_of(light, weights):
    return [sum(l * w[k] for l, w in zip(light, weights)) for k in range(3)]


def estimate(light, indices, matrix):
    return [sum(light[i] * m[k] for i, m in zip(indices, matrix)) for k in range(3)]


def uv(xyz):
    d = max(xyz[0] + 15.0 * xyz[1] + 3.0 * xyz[2], 1e-300)
    return 4.0 * xyz[0] / d, 9.0 * xyz[1] / d


def error(truth, guess):
    a, b = uv(truth), uv(guess)
    return abs(guess[1] / truth[1] - 1.0), math.hypot(a[0] - b[0], a[1] - b[1])


def statistics(pairs):
    """Returns mean and 95th percentile of both errors."""
    out = []
    for k in range(2):
        values = sorted(p[k] for p in pairs)
        out += [sum(values) / len(values), values[min(len(values) - 1, int(0.95 * len(values)))]]
    return out


def spectra_of(data):
    """Returns (sun elevation, spectrum) of all light that reaches the eye, and of the direct sun separately."""
    light, sun = [], []
    for (_, view, sun_zenith, _), radiance, transmittance in data:
        if max(radiance) > 1e-9:
            light.append((90 - sun_zenith, radiance))
        if view == "sky" and max(transmittance) > 1e-6:
            sun.append((90 - sun_zenith, transmittance))
    return light, sun


def fit(rows, weights):
    """Returns the best sets of four wavelengths with their matrices, by the sum of squared relative errors."""
    n = len(WAVELENGTHS)
    gram = [[0.0] * n for _ in range(n)]
    cross = [[0.0] * 3 for _ in range(n)]
    total = [0.0] * 3
    for light, extra in rows:
        xyz = xyz_of(light, weights)
        w = extra / sum(xyz) ** 2
        total = [t + w * v * v for t, v in zip(total, xyz)]
        for i in range(n):
            wi = w * light[i]
            for j in range(i, n):
                gram[i][j] += wi * light[j]
            for k in range(3):
                cross[i][k] += wi * xyz[k]
    for i in range(n):
        for j in range(i):
            gram[i][j] = gram[j][i]
    found = []
    for indices in itertools.combinations(range(n), 4):
        matrix = solve([[gram[i][j] for j in indices] for i in indices], [cross[i] for i in indices])
        if matrix is None:
            continue
        residual = [total[k] - sum(matrix[a][k] * cross[i][k] for a, i in enumerate(indices)) for k in range(3)]
        cost = sum(weight * r for weight, r in zip(IMPORTANCE, residual))
        found.append((cost, indices, matrix))
    found.sort(key=lambda f: f[0])
    return found


def null_vector(m):
    """Returns the unit vector that the 3x4 matrix m maps to 0."""
    minor = lambda c: [[row[j] for j in range(4) if j != c] for row in m]
    det = lambda a: (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
                     + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]))
    v = [(-1) ** c * det(minor(c)) for c in range(4)]
    norm = math.sqrt(sum(x * x for x in v))
    return [x / norm for x in v]


def color_rows(indices, matrix, weights):
    """Returns the 3x4 matrix from light at the wavelengths to linear Rec. 709, in which the sun has the luminance 1."""
    sun_y = sum(w[1] for w in weights)
    return [[sum(REC709[r][k] * matrix[a][k] for k in range(3)) / sun_y for a in range(4)] for r in range(3)]


def lift_of(color, spectra):
    """Returns the 4x3 right inverse of the 3x4 matrix `color` that makes flat spectra of the sun's colour, and otherwise
    comes closest to the `spectra` (light at the four wavelengths)."""
    n = null_vector(color)
    gram = [[sum(color[i][k] * color[j][k] for k in range(4)) for j in range(3)] for i in range(3)]
    inverse = solve(gram, [[1.0 if i == j else 0.0 for j in range(3)] for i in range(3)])
    base = [[sum(color[i][a] * inverse[i][k] for i in range(3)) for k in range(3)] for a in range(4)]
    # spectrum = base rgb + n (t . rgb). n . spectrum = t . rgb, because n is at right angles to the rows of base.
    rows = [([sum(color[r][a] for a in range(4)) for r in range(3)], sum(n), 1.0e6)]
    for s in spectra:
        rgb = [sum(color[r][a] * s[a] for a in range(4)) for r in range(3)]
        rows.append((rgb, sum(n[a] * s[a] for a in range(4)), 1.0 / sum(x * x for x in s)))
    normal = [[sum(w * rgb[i] * rgb[j] for rgb, _, w in rows) for j in range(3)] for i in range(3)]
    right = [[sum(w * rgb[i] * value for rgb, value, w in rows)] for i in range(3)]
    t = [x[0] for x in solve(normal, right)]
    return [[base[a][k] + n[a] * t[k] for k in range(3)] for a in range(4)], n


def smooth_spectra():
    """Returns smooth reflectances that resemble no patch of the colour test card in particular: logistic edges up and down, and
    broad bands, at all wavelengths."""
    out = []
    for centre in range(440, 661, 20):
        for width in (25.0, 50.0):
            for low, high in ((0.1, 0.6), (0.6, 0.1)):
                out.append([low + (high - low) / (1.0 + math.exp(-(nm - centre) / width)) for nm in WAVELENGTHS])
        out.append([0.1 + 0.5 * math.exp(-0.5 * ((nm - centre) / 45.0) ** 2) for nm in WAVELENGTHS])
    return out


def patches():
    """Returns the 24 measured reflectances at all wavelengths."""
    out = {}
    for name, values in REFLECTANCES.items():
        nodes = [380 + 20 * i for i in range(21)]
        spectrum = []
        for nm in WAVELENGTHS:
            i = min((nm - 380) // 20, 19)
            part = (nm - nodes[i]) / 20.0
            spectrum.append(values[i] + (values[i + 1] - values[i]) * part)
        out[name] = spectrum
    return out


def lift_errors(indices, matrix, lift, color, weights, sun_rows):
    """Returns the errors of the 24 reflectances in sunlight seen through the atmosphere, composed from their colours."""
    pairs = []
    sun_y = sum(w[1] for w in weights)
    to_xyz = solve(REC709, [[1.0 if i == j else 0.0 for j in range(3)] for i in range(3)])
    for _, transmittance in sun_rows:
        four = [transmittance[i] for i in indices]
        for reflectance in patches().values():
            rgb = [sum(REC709[r][k] * v for k, v in enumerate(xyz_of(reflectance, weights))) / sun_y for r in range(3)]
            lifted = [four[a] * sum(lift[a][k] * rgb[k] for k in range(3)) for a in range(4)]
            out = [sum(color[r][a] * lifted[a] for a in range(4)) for r in range(3)]
            guess = [sun_y * sum(to_xyz[k][r] * out[r] for r in range(3)) for k in range(3)]
            truth = xyz_of([r * t for r, t in zip(reflectance, transmittance)], weights)
            pairs.append(error(truth, guess))
    return pairs


def write_text(path, lines):
    """Writes a source file, formatted like all others if clang-format is installed."""
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")
    if shutil.which("clang-format"):
        subprocess.run(["clang-format", "-i", path], check=True)


def percent(s):
    return "%.2f / %.2f %%, %.4f / %.4f" % (100 * s[0], 100 * s[1], s[2], s[3])


def report(title, indices, matrix, sets):
    print("\n%s: %s nm" % (title, ", ".join(str(WAVELENGTHS[i]) for i in indices)))
    print("| atmosphere | " + " | ".join(g[0] for g in GROUPS) + " | direct sun |\n|---" * 1 + "|---" * 5 + "|")
    weights = bin_weights()
    for name, (light, sun) in sets.items():
        cells = []
        for _, low, high in GROUPS:
            pairs = [error(xyz_of(l, weights), estimate(l, indices, matrix)) for e, l in light if low <= e <= high]
            cells.append(percent(statistics(pairs)))
        pairs = [error(xyz_of(l, weights), estimate(l, indices, matrix)) for _, l in sun]
        cells.append(percent(statistics(pairs)))
        print("| %s%s | %s |" % (name, " (fit)" if ATMOSPHERES[name][0] else "", " | ".join(cells)))


def write_header(path, indices, matrix, color, lift, lost, weights):
    order = sorted(range(4), key=lambda a: -WAVELENGTHS[indices[a]])
    vec4 = lambda values: "vec4(" + ", ".join("%.9g" % values[a] if "." in "%.9g" % values[a] or "e" in "%.9g" % values[a]
                                              else "%.9g.0" % values[a] for a in order) + ")"
    inverse = solve([[color[r][a] for a in range(4)] for r in range(3)] + [lost],
                    [[1.0 if i == j else 0.0 for j in range(4)] for i in range(4)])
    spectrum_of_lost = [inverse[a][3] for a in range(4)]
    # The texels of the tables of sunlight and sky light: light = lift color + lost_spectrum (alpha), with alpha = (lost - lost lift color).
    residual = [lost[a] - sum(sum(lost[b] * lift[b][k] for b in range(4)) * color[k][a] for k in range(3)) for a in range(4)]
    sun = [sum(color[r]) for r in range(3)]
    names = ("Red", "Green", "Blue")
    lines = ["// The four wavelengths of scattering.color = spectral, and the matrices between light at them and linear Rec. 709.",
             "// Written by `tools/fit_wavelengths.py --header shaders/shared/wavelengths.h`; docs/spectral.md explains the fit.",
             "#ifndef TYNDALL_SHARED_WAVELENGTHS", "#define TYNDALL_SHARED_WAVELENGTHS", "",
             "const vec4 kWavelengths_nm = %s;" % vec4([float(WAVELENGTHS[i]) for i in indices]),
             "// The illuminance of the sun above the atmosphere, on a surface that faces it, over 683 lm/W [W/m^2].",
             "const float kSunLuminous = %.9g;" % sum(w[1] for w in weights),
             "// The rows of the matrix from light relative to the sun's to Rec. 709, relative to the sun's luminance."]
    lines += ["const vec4 kColor%s = %s;" % (names[r], vec4(color[r])) for r in range(3)]
    lines += ["// The columns of the matrix from Rec. 709 to a smooth spectrum."]
    lines += ["const vec4 kLift%s = %s;" % (names[k], vec4([lift[a][k] for a in range(4)])) for k in range(3)]
    lines += ["// The component of light that its colour lacks is dot(kLostInColor, light) times the spectrum kOfLost.",
              "const vec4 kLostInColor = %s;" % vec4(residual), "const vec4 kOfLost = %s;" % vec4(spectrum_of_lost),
              "// The colour of the sun above the atmosphere.",
              "const vec3 kSunColor = vec3(%.9g, %.9g, %.9g);" % tuple(sun), "", "#endif"]
    write_text(path, lines)


def write_bins(path, weights):
    lines = ["// The wavelengths at which the path tracer evaluates light for scattering.color = spectral: bins of 10 nm, and their",
             "// weights in X, Y and Z for light relative to the sun's irradiance above the atmosphere [W/m^2].",
             "// Written by `tools/fit_wavelengths.py --bins src/reference/bins.inl` from the tables of tools/spectral_data.py."]
    lines += ["{%d, {%.9g, %.9g, %.9g}}," % (nm, *w) for nm, w in zip(WAVELENGTHS, weights)]
    write_text(path, lines)


def write_reflectances(path):
    lines = ["// Reflectances at the wavelengths of src/reference/bins.inl: Ohta, \"The Basis of Color Reproduction Engineering\"",
             "// (1997). Written by `tools/fit_wavelengths.py --reflectances tests/unit/reflectances.inl`."]
    lines += ['{"%s", {%s}},' % (name, ", ".join("%.4g" % v for v in values)) for name, values in patches().items()]
    write_text(path, lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tyndall", default="build/release/bin/tyndall", help="the executable")
    parser.add_argument("--work", default="out/wavelengths", help="folder for the radiances, which stay there")
    parser.add_argument("--header", help="write the constants to this file")
    parser.add_argument("--bins", help="write the weights of the 40 wavelengths to this file, and stop")
    parser.add_argument("--reflectances", help="write the reflectances of the test to this file, and stop")
    parser.add_argument("--only", help="evaluate this atmosphere, and stop")
    options = parser.parse_args()
    weights = bin_weights()
    if options.bins:
        write_bins(options.bins, weights)
        return
    if options.reflectances:
        write_reflectances(options.reflectances)
        return
    os.makedirs(options.work, exist_ok=True)
    if options.only:
        evaluate(options.tyndall, options.only, options.work)
        return
    sets = {name: spectra_of(evaluate(options.tyndall, name, options.work)) for name in ATMOSPHERES}
    rows = [([1.0] * 40, 1.0e6)]  # the sun above the atmosphere is exact
    for name, (light, sun) in sets.items():
        if ATMOSPHERES[name][0]:
            rows += [(l, 1.0) for _, l in light] + [(l, 4.0) for _, l in sun]
    # Powers of the wavelength, so that the matrix suits dust of any colour.
    rows += [([(nm / 550.0) ** (0.5 * k) for nm in WAVELENGTHS], POWER_WEIGHT) for k in range(-12, 13)]
    found = fit(rows, weights)
    for rank, (cost, indices, _) in enumerate(found[:8]):
        print("%d. %s nm: root mean square %.5f" % (rank + 1, ", ".join(str(WAVELENGTHS[i]) for i in indices),
                                                    math.sqrt(max(cost, 0.0) / len(rows))))
    _, indices, matrix = found[0]
    report("best four", indices, matrix, sets)
    color = color_rows(indices, matrix, weights)
    lift, lost = lift_of(color, [[s[i] for i in indices] for s in smooth_spectra()])
    for name, (_, sun) in sets.items():
        s = statistics(lift_errors(indices, matrix, lift, color, weights, sun))
        print("24 reflectances in sunlight through %s: %s" % (name, percent(s)))
    clear = statistics(lift_errors(indices, matrix, lift, color, weights, [(90, [1.0] * 40)]))
    print("24 reflectances without an atmosphere: %s" % percent(clear))
    if options.header:
        write_header(options.header, indices, matrix, color, lift, lost, weights)


if __name__ == "__main__":
    main()
