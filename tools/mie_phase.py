#!/usr/bin/env python3
"""Computes optical properties of dust by Mie theory: a phase function for atmosphere.phase_table (CSV of angle and
wavelength), and the extinction and the single scattering albedo at the given wavelengths.

The particles are spheres whose sizes have the distribution of Hansen and Travis, "Light scattering in planetary
atmospheres" (1974), equation 2.56, with an effective radius and variance. Scattering by one sphere follows Bohren and
Huffman, "Absorption and Scattering of Light by Small Particles" (1983), chapter 4. The material is a host with
inclusions of another, mixed after Maxwell Garnett (Bohren and Huffman, section 8.5).

`tools/mie_phase.py mars -o scenes/air/mars_dust.csv` writes the dust of Mars. Needs nothing but Python."""

import argparse
import cmath
import math
import sys

# Hematite at 390 to 750 nm, which colours the dust.
HEMATITE = {390: 2.387 + 1.097j, 440: 2.766 + 0.936j, 480: 2.876 + 0.707j, 520: 2.881 + 0.532j, 550: 2.927 + 0.460j,
            580: 2.956 + 0.286j, 620: 2.830 + 0.134j, 680: 2.703 + 0.083j, 750: 2.621 + 0.061j}
# The dust of Mars as in Ehlers, Chakrabarty and Moosmueller, "Blue moons and Martian sunsets" (2014): an effective
# radius of 1.6 um and a variance of 0.2 (Tomasko et al. 1999 found 1.6 um and 0.2 to 0.5 from Mars Pathfinder), and 3 %
# of hematite in a transparent host with the refractive index 1.5.
MATERIALS = {"mars": {"radius_um": 1.6, "variance": 0.2, "host": 1.5, "inclusions": HEMATITE, "fraction": 0.03}}


def angles_deg():
    """The angles of the table: dense ahead, where the function falls fastest."""
    out = [0.0]
    while out[-1] < 180.0:
        at = out[-1]
        step = 0.25 if at < 6 else 0.5 if at < 15 else 1.0 if at < 30 else 2.0 if at < 60 else 4.0
        out.append(min(180.0, at + step))
    return out


def mixed(host, inclusion, fraction):
    """Returns the refractive index of a host with inclusions."""
    a, b = host * host, inclusion * inclusion
    part = fraction * (b - a) / (b + 2.0 * a)
    return cmath.sqrt(a * (1.0 + 3.0 * part / (1.0 - part)))


def sphere(x, m, cosines):
    """Returns the efficiencies of extinction and scattering of a sphere of size x, and |S1|^2 + |S2|^2 by angle."""
    terms = int(x + 4.05 * x ** (1.0 / 3.0) + 2.0)
    size = abs(m * x)
    start = int(max(terms, size) + 16)
    mx = m * x
    slope = [0j] * (start + 1)  # the logarithmic derivative of psi_n
    for n in range(start, 0, -1):
        slope[n - 1] = n / mx - 1.0 / (slope[n] + n / mx)
    psi0, psi1 = math.cos(x), math.sin(x)
    chi0, chi1 = -math.sin(x), math.cos(x)
    extinction = scattering = 0.0
    s1 = [0j] * len(cosines)
    s2 = [0j] * len(cosines)
    before = [0.0] * len(cosines)
    now = [1.0] * len(cosines)
    for n in range(1, terms + 1):
        psi = (2 * n - 1) / x * psi1 - psi0
        chi = (2 * n - 1) / x * chi1 - chi0
        xi, xi1 = complex(psi, -chi), complex(psi1, -chi1)
        da, db = slope[n] / m + n / x, m * slope[n] + n / x
        a = (da * psi - psi1) / (da * xi - xi1)
        b = (db * psi - psi1) / (db * xi - xi1)
        extinction += (2 * n + 1) * (a + b).real
        scattering += (2 * n + 1) * (abs(a) ** 2 + abs(b) ** 2)
        factor = (2 * n + 1) / (n * (n + 1))
        fa, fb = factor * a, factor * b
        for i, mu in enumerate(cosines):
            pi = now[i]
            tau = n * mu * pi - (n + 1) * before[i]
            s1[i] += fa * pi + fb * tau
            s2[i] += fa * tau + fb * pi
            now[i], before[i] = ((2 * n + 1) * mu * pi - (n + 1) * before[i]) / n, pi
        psi0, psi1, chi0, chi1 = psi1, psi, chi1, chi
    return (2.0 / x ** 2 * extinction, 2.0 / x ** 2 * scattering,
            [abs(p) ** 2 + abs(q) ** 2 for p, q in zip(s1, s2)])


def radii(radius, variance, count):
    """Returns radii and their numbers; n(r) = r^((1 - 3 b) / b) exp(-r / (a b))."""
    low, high = 0.03 * radius, 4.5 * radius
    out = []
    for i in range(count):
        r = low * (high / low) ** ((i + 0.5) / count)
        power = (1.0 - 3.0 * variance) / variance
        log = power * math.log(r / radius) - r / (radius * variance)
        out.append((r, math.exp(log) * r))  # the width of a step in log r is proportional to r
    return out


def optics(material, nm, count, angles):
    """Returns the cross-sections of extinction and scattering (relative) and the phase function by angle [1/sr]."""
    m = mixed(material["host"], material["inclusions"][nm], material["fraction"])
    cosines = [math.cos(math.radians(a)) for a in angles]
    extinction = scattering = 0.0
    light = [0.0] * len(angles)
    wave_number = 2.0 * math.pi / (nm * 1e-3)
    for r, number in radii(material["radius_um"], material["variance"], count):
        q_ext, q_sca, intensity = sphere(wave_number * r, m, cosines)
        extinction += number * q_ext * r * r
        scattering += number * q_sca * r * r
        for i, value in enumerate(intensity):
            light[i] += number * value
    # The differential cross-section is (|S1|^2 + |S2|^2) / (2 k^2), that of scattering pi r^2 Q.
    scale = 1.0 / (2.0 * wave_number ** 2 * math.pi * scattering)
    return extinction, scattering, [scale * value for value in light]


def mean_cosine(angles, values):
    total = weighted = 0.0
    for i in range(len(angles) - 1):
        for part in (0.25, 0.75):
            a = math.radians(angles[i] + part * (angles[i + 1] - angles[i]))
            value = values[i] + part * (values[i + 1] - values[i])
            solid = math.pi * math.sin(a) * math.radians(angles[i + 1] - angles[i])
            total += solid * value
            weighted += solid * value * math.cos(a)
    return total, weighted / total


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("material", choices=sorted(MATERIALS))
    parser.add_argument("-o", "--output", help="CSV file of the phase function")
    parser.add_argument("--sizes", type=int, default=120, help="number of sizes [120]")
    options = parser.parse_args()
    material = MATERIALS[options.material]
    angles = angles_deg()
    columns = {}
    reference = None
    print("| wavelength, nm | extinction, relative to 550 nm | single scattering albedo | asymmetry |")
    print("|---|---|---|---|")
    wavelengths = sorted(material["inclusions"])
    reference = optics(material, 550, options.sizes, [0.0, 180.0])[0]
    for nm in wavelengths:
        extinction, scattering, values = optics(material, nm, options.sizes, angles)
        columns[nm] = values
        total, g = mean_cosine(angles, values)
        print(f"| {nm} | {extinction / reference:.3f} | {scattering / extinction:.3f} | {g:.3f} |")
        if abs(total - 1.0) > 0.02:
            sys.exit(f"the integral of the phase function at {nm} nm is {total:.4f}; expected 1")
    if options.output:
        with open(options.output, "w", encoding="utf-8") as file:
            file.write("angle_deg," + ",".join(str(nm) for nm in wavelengths) + "\n")
            for i, angle in enumerate(angles):
                file.write(f"{angle:g}," + ",".join(f"{columns[nm][i]:.5g}" for nm in wavelengths) + "\n")


if __name__ == "__main__":
    main()
