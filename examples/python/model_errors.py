#!/usr/bin/env python3
"""Draws the errors of three wavelengths, of single scattering and of O'Neil's model.

The truth is the path tracer with 40 wavelengths and all orders of scattering. For each model the figure shows the error of the
luminance and of the chromaticity, as a distance in the diagram u'v' of the CIE (1976): 0.004 is visible side by side. Points
are means over seven directions of the sky. The grey area is the standard error of the path tracer.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

ZENITH = np.array([10.0, 45.0, 45.0, 75.0, 75.0, 86.0, 86.0])
AZIMUTH = np.array([90.0, 0.0, 120.0, 30.0, 180.0, 60.0, 150.0])


def chromaticity(xyz):
    return np.stack([4.0 * xyz[..., 0], 9.0 * xyz[..., 1]], axis=-1) / (xyz @ [1.0, 15.0, 3.0])[..., None]


found = options(__doc__)
elevation = np.linspace(70.0, 0.5, max(4, min(found.points // 12, 16)))
rays = {"zenith": ZENITH, "sun_zenith": 90.0 - elevation[:, None], "azimuth": AZIMUTH}
parameters = {"planet.ground_albedo": 0.0, **found.parameters}

truth = tyndall.Atmosphere(parameters, model="single", color="xyz").trace(**rays, samples=20 * found.points, orders=10)
# Three wavelengths as renderers use them: as red, green and blue of Rec. 709, for a white sun with the luminance of the sun.
_, weights = tyndall.visible_spectrum()
illuminance = weights[:, 1].sum() / 683.0


def three(model):
    light = tyndall.Atmosphere(parameters, model=model).radiance(**rays)
    return tyndall.xyz_from_rgb(light * illuminance)


# The white of Rec. 709 is that of the sun for renderers, so colours are compared relative to that of sunlight.
sun = weights.sum(axis=0)
white = tyndall.xyz_from_rgb(np.ones(3)) * illuminance
models = [("four wavelengths, all orders", tyndall.Atmosphere(parameters, color="xyz").radiance(**rays), "tab:green"),
          ("three wavelengths, all orders", three("precomputed") * sun / white, "tab:blue"),
          ("three wavelengths, single scattering", three("single") * sun / white, "tab:orange"),
          ("three wavelengths, O'Neil", three("oneil") * sun / white, "tab:red")]

figure, (level, colour) = plt.subplots(1, 2, figsize=(9.5, 4.2))
for name, xyz, line in models:
    error = np.abs(xyz[..., 1] / truth.value[..., 1] - 1.0).mean(axis=1)
    distance = np.linalg.norm(chromaticity(xyz) - chromaticity(truth.value), axis=-1).mean(axis=1)
    level.semilogy(elevation, 100.0 * error, "o-", color=line, markersize=3, label=name)
    colour.semilogy(elevation, distance, "o-", color=line, markersize=3, label=name)
noise = 100.0 * (truth.standard_error[..., 1] / truth.value[..., 1]).mean(axis=1)
level.fill_between(elevation, 1e-9, noise, color="0.85", label="noise of the path tracer")
level.set(xlabel="elevation of the sun [deg]", ylabel="error of luminance [%]", ylim=(0.1, 2000.0), title="luminance")
colour.set(xlabel="elevation of the sun [deg]", ylabel="error of chromaticity u'v'", ylim=(1e-4, 0.3), title="chromaticity")
colour.axhline(0.004, color="k", linewidth=0.5)
for axes in (level, colour):
    axes.invert_xaxis()
    axes.grid(alpha=0.3)
level.legend(fontsize=7, loc="upper left")
save(figure, found.output)
