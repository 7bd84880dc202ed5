#!/usr/bin/env python3
"""Draws how aerosol reduces visibility.

The contrast of a black object against the sky behind it falls with distance. In a homogeneous atmosphere it is
exp(-extinction * distance) (Koschmieder 1924). The visibility is the distance at which 2 % remain, 3.912 / extinction.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

found = options(__doc__)
distance = np.linspace(500.0, 150e3, found.points)
figure, axes = plt.subplots(figsize=(6, 4))
for density, line in ((1.0, "tab:blue"), (4.0, "tab:orange"), (12.0, "tab:red")):
    air = tyndall.Atmosphere({**found.parameters, "atmosphere.aerosol_density": density})
    # A straight path that is level at its middle, 50 m above the sea.
    half = distance / 2.0
    eye, target, sky = (np.stack([x, 50.0 + 0.0 * x, 0.0 * x], axis=-1) for x in (-half, half, half + 2e6))
    path = air.aerial_perspective(eye, target, 40.0, 0.0)
    contrast = 1.0 - path.inscattering[:, 1] / air.aerial_perspective(eye, sky, 40.0, 0.0).inscattering[:, 1]
    axes.semilogy(distance / 1e3, contrast, color=line, label=f"contrast, aerosol x {density:g}")
    extinction = -np.log(path.transmittance[0, 1]) / distance[0]
    axes.semilogy(distance / 1e3, np.exp(-extinction * distance), ":", color=line,
                  label=f"Koschmieder, visibility {3.912 / extinction / 1e3:.0f} km")
axes.axhline(0.02, color="k", linewidth=0.5)
axes.set(xlabel="distance [km]", ylabel="contrast of a black object", ylim=(5e-3, 1.0), title="green channel, 50 m above the sea")
axes.grid(alpha=0.3)
axes.legend(fontsize=7)
save(figure, found.output)
