#!/usr/bin/env python3
"""The distribution of light over the sky against the CIE standard clear sky.

The standard (ISO 15469:2004, CIE S 011/E:2003) gives the luminance of a sky relative to its zenith as a gradation by the
zenith angle times an indicatrix by the angle to the sun. Type 12 is the clear sky with low turbidity. It is a fit to
measurements in average clear weather; the green channel stands for luminance here.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

A, B, C, D, E = -1.0, -0.32, 10.0, -3.0, 0.45  # type 12


def gradation(zenith):
    return 1.0 + A * np.exp(B / np.maximum(np.cos(zenith), 1e-3))


def indicatrix(angle):
    return 1.0 + C * (np.exp(D * angle) - np.exp(D * np.pi / 2)) + E * np.cos(angle) ** 2


def standard(zenith, sun_zenith, azimuth):
    """Returns the luminance relative to that of the zenith. Angles in radians."""
    cosine = np.cos(zenith) * np.cos(sun_zenith) + np.sin(zenith) * np.sin(sun_zenith) * np.cos(azimuth)
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    return indicatrix(angle) * gradation(zenith) / (indicatrix(sun_zenith) * gradation(0.0))


found = options(__doc__)
sun_zenith = 50.0
zenith = np.linspace(-88.0, 88.0, found.points)  # negative: away from the sun
azimuth = np.where(zenith < 0.0, 180.0, 0.0)
figure, axes = plt.subplots(figsize=(6, 4))
for density, line in ((1.0, "tab:blue"), (3.0, "tab:orange")):
    air = tyndall.Atmosphere({"planet.ground_albedo": 0.2, **found.parameters, "atmosphere.aerosol_density": density})
    sky = air.radiance(np.abs(zenith), sun_zenith, azimuth)[:, 1]
    axes.semilogy(zenith, sky / air.radiance(0, sun_zenith)[1], color=line, label=f"tyndall, aerosol x {density:g}")
axes.semilogy(zenith, standard(np.radians(np.abs(zenith)), np.radians(sun_zenith), np.radians(azimuth)), "k--", label="CIE type 12")
axes.set(xlabel="zenith angle in the plane of the sun [deg]", ylabel="luminance / that of the zenith", title="sun 40 deg high")
axes.grid(alpha=0.3)
axes.legend(fontsize=8)
save(figure, found.output)
