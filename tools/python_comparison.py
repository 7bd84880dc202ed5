#!/usr/bin/env python3
"""Compares Tyndall with data that others measured or computed, and writes the page docs/generated/comparison.md to stdout.

`make python-comparison` calls it. The data are a few numbers of each publication; docs/python.md discusses the result.
"""
import numpy as np

import tyndall

# ASTM G173-03 (2012), "Standard Tables for Reference Solar Spectral Irradiances": wavelength [nm], irradiance above the
# atmosphere, hemispherical on a surface tilted by 37 deg, direct and circumsolar at normal incidence [W m^-2 nm^-1]. At
# wavelengths where water vapour and oxygen absorb little.
G173 = np.array([
    (400, 1.6885, 1.1141, 0.83989), (420, 1.599, 1.1232, 0.88467), (450, 2.069, 1.5595, 1.2881), (480, 2.068, 1.6181, 1.3825),
    (500, 1.916, 1.5451, 1.3391), (520, 1.86, 1.5236, 1.3349), (550, 1.863, 1.5399, 1.3648), (580, 1.834, 1.502, 1.3455),
    (610, 1.724, 1.4686, 1.3237), (670, 1.534, 1.4196, 1.2853), (710, 1.404, 1.3175, 1.1954), (780, 1.193, 1.1636, 1.0687)])
SUN_ZENITH, TILT, CIRCUMSOLAR = 48.19, 37.0, 2.9  # deg; air mass 1.5
# The standard's atmosphere: aerosol optical depth 0.084 at 500 nm, 0.344 atm cm of ozone. The standard does not contain
# the exponent of rural aerosol and the albedos of aerosol and light soil. They are rounded, and were chosen before.
EXPONENT = 1.2
G173_AIR = {"atmosphere.aerosol_optical_depth": 0.084 * (550.0 / 500.0) ** -EXPONENT, "atmosphere.angstrom_exponent": EXPONENT,
            "atmosphere.single_scattering_albedo": (0.93, 0.93, 0.93), "atmosphere.ozone_du": 344,
            "atmosphere.pressure_hpa": 1013.25, "planet.ground_albedo": 0.2}

# Natraj, Li and Yung (2009), "Rayleigh Scattering in Planetary Atmospheres: Corrected Tables through Accurate Computation of X
# and Y Functions", which correct Coulson, Dave and Sekera (1960): light that leaves a plane layer of optical depth 0.5 upwards,
# the Stokes parameter I for an incident flux of pi at cosine 0.2 of the zenith angle.
OPTICAL_DEPTH, COS_SUN = 0.5, 0.2
COS_VIEW = np.array([0.02, 0.4, 1.0, 0.02, 0.4, 1.0])
AZIMUTH = np.array([0.0, 0.0, 0.0, 60.0, 60.0, 60.0])
NATRAJ = {0.0: (0.44129802, 0.16889020, 0.05300496, 0.30091208, 0.12752450, 0.05300496),
          0.8: (0.47382125, 0.23059806, 0.13280858, 0.33343531, 0.18923236, 0.13280858)}


def directions(polar, azimuths):
    """Returns unit vectors and solid angles of a grid around the axis z. `polar`: nodes and weights of the cosine."""
    phi = (np.arange(azimuths) + 0.5) * (2.0 * np.pi / azimuths)
    cosine, weight = polar
    sine = np.sqrt(1.0 - cosine * cosine)
    grid = np.stack(np.broadcast_arrays(sine[:, None] * np.cos(phi), sine[:, None] * np.sin(phi), cosine[:, None]), axis=-1)
    return grid.reshape(-1, 3), np.repeat(weight * (2.0 * np.pi / azimuths), azimuths)


def nodes(low, high, count):
    x, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * x, 0.5 * (high - low) * weight


def turned(vectors, zenith):
    """Turns the axis z to a zenith angle towards the sun, whose azimuth is that of x."""
    c, s = np.cos(np.radians(zenith)), np.sin(np.radians(zenith))
    return vectors @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])


def light_from(air, vectors):
    zenith = np.degrees(np.arccos(np.clip(vectors[:, 2], -1.0, 1.0)))
    return air.radiance(zenith, SUN_ZENITH, np.degrees(np.arctan2(vectors[:, 1], vectors[:, 0])))


def solar_spectrum():
    """Returns direct normal irradiance with the light around the sun, and irradiance of the tilted surface."""
    air = tyndall.Atmosphere(G173_AIR, wavelengths=G173[:, 0])
    sun = turned(np.array([[0.0, 0.0, 1.0]]), SUN_ZENITH)[0]
    normal = turned(np.array([[0.0, 0.0, 1.0]]), TILT)[0]
    # First the light from around the sun, then that from all other directions in front of the tilted surface.
    near, solid_angle = directions(nodes(np.cos(np.radians(CIRCUMSOLAR)), 1.0, 6), 12)
    near = turned(near, SUN_ZENITH)
    around = light_from(air, near) * (near @ sun * solid_angle)[:, None]
    hemisphere, solid_angle = directions(nodes(0.0, 1.0, 96), 192)
    hemisphere_cosine = hemisphere[:, 2]
    hemisphere = turned(hemisphere, TILT)
    apart = hemisphere @ sun < np.cos(np.radians(CIRCUMSOLAR))
    diffuse = (light_from(air, hemisphere) * (hemisphere_cosine * solid_angle * apart)[:, None]).sum(axis=0)
    direct = air.sun_irradiance(SUN_ZENITH) + around.sum(axis=0)
    return direct, diffuse + direct * (sun @ normal)


def rayleigh_layer(albedo):
    """Returns I and its standard error, by the path tracer, in an atmosphere that is thin compared with the planet's radius."""
    scale, top = 100.0, 1000.0
    coefficient = OPTICAL_DEPTH / (scale * -np.expm1(-top / scale))
    air = tyndall.Atmosphere({
        "planet.radius_m": 1e8, "planet.ground_albedo": albedo, "atmosphere.height_m": top,
        "atmosphere.rayleigh_scale_height_m": scale, "atmosphere.custom_coefficients": True,
        "atmosphere.rayleigh_scattering": (coefficient,) * 3, "atmosphere.mie_scattering": (0, 0, 0),
        "atmosphere.mie_absorption": (0, 0, 0), "atmosphere.ozone_absorption": (0, 0, 0)}, model="single")
    found = air.trace(180.0 - np.degrees(np.arccos(COS_VIEW)), np.degrees(np.arccos(COS_SUN)), AZIMUTH, top, samples=50000,
                      orders=60)
    return np.pi * found.value[:, 0], np.pi * found.standard_error[:, 0]


def main():
    print("<!-- Written by `make python-comparison`. -->\n")
    print("# Comparison with published data\n")
    print("## Solar spectrum through the atmosphere (ASTM G173-03)\n")
    direct, global_ = solar_spectrum()
    given_direct, given_global = G173[:, 3] / G173[:, 1], G173[:, 2] / G173[:, 1]
    cosine = np.cos(np.radians(SUN_ZENITH - TILT))
    diffuse, given_diffuse = global_ - direct * cosine, given_global - given_direct * cosine
    print("Relative to the irradiance above the atmosphere; deviation of Tyndall from the standard.\n")
    print("| wavelength [nm] | direct, G173 | Tyndall | deviation | tilted surface, G173 | Tyndall | deviation "
          "| its diffuse part, G173 | Tyndall | deviation |")
    print("|--:|" + "--:|--:|--:|" * 3)
    for i, nm in enumerate(G173[:, 0]):
        cells = [f"{a[i]:.4f} | {b[i]:.4f} | {100.0 * (b[i] / a[i] - 1.0):+.1f} %"
                 for a, b in ((given_direct, direct), (given_global, global_), (given_diffuse, diffuse))]
        print(f"| {nm:.0f} | " + " | ".join(cells) + " |")
    means = [100.0 * np.abs(b / a - 1.0).mean() for a, b in ((given_direct, direct), (given_global, global_), (given_diffuse, diffuse))]
    print("| mean of the absolute values | | | {:.1f} % | | | {:.1f} % | | | {:.1f} % |\n".format(*means))
    print("## Rayleigh atmosphere (Natraj, Li and Yung 2009)\n")
    print("Stokes parameter I of light that leaves a layer of optical depth 0.5 upwards; cosine 0.2 of the sun's zenith angle.\n")
    print("| albedo of the ground | cosine of the zenith angle | azimuth | table | path tracer | standard error | deviation |")
    print("|--:|--:|--:|--:|--:|--:|--:|")
    for albedo, table in NATRAJ.items():
        value, error = rayleigh_layer(albedo)
        for row in zip(COS_VIEW, AZIMUTH, table, value, error):
            print(f"| {albedo:g} | {row[0]:g} | {row[1]:.0f}° | {row[2]:.5f} | {row[3]:.5f} | {row[4]:.5f} "
                  f"| {100.0 * (row[3] / row[2] - 1.0):+.1f} % |")


if __name__ == "__main__":
    main()
