#!/usr/bin/env python3
"""How much of the sky's light has been scattered more than once, and how exact the tables are.

Single scattering alone is what many simple models compute. The path tracer is the reference; its bars are three standard
errors.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

found = options(__doc__)
elevation = np.linspace(90.0, 2.0, found.points)
figure, axes = plt.subplots(figsize=(6, 4))
zenith, azimuth = 45.0, 120.0
every = tyndall.Atmosphere(found.parameters)
single = tyndall.Atmosphere(found.parameters, model="single")
all_orders = every.radiance(zenith, 90.0 - elevation, azimuth)
one_order = single.radiance(zenith, 90.0 - elevation, azimuth)
some = np.linspace(85.0, 5.0, 6)
traced = every.trace(zenith, 90.0 - some, azimuth, samples=100 * found.points, orders=10)
for channel, line in enumerate(("tab:red", "tab:green", "tab:blue")):
    axes.plot(elevation, one_order[:, channel] / all_orders[:, channel], color=line, label=f"single / all orders, {'RGB'[channel]}")
    reference = every.radiance(zenith, 90.0 - some, azimuth)[:, channel]
    axes.errorbar(some, traced.value[:, channel] / reference, 3.0 * traced.standard_error[:, channel] / reference,
                  fmt="o", markersize=3, color=line, label=f"path tracer / tables, {'RGB'[channel]}")
axes.set(xlabel="elevation of the sun [deg]", ylabel="ratio", ylim=(0.0, 1.2), title="45 deg from the zenith, 120 deg from the sun")
axes.grid(alpha=0.3)
axes.legend(fontsize=7)
save(figure, found.output)
