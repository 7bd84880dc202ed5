#!/usr/bin/env python3
"""The colour of the zenith through twilight.

With the sun some degrees below the horizon, its light reaches the zenith only through the ozone layer, which absorbs
orange: the zenith turns blue although the light that arrives has lost its blue (Hulburt 1953). Without ozone it would be
yellowish.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

found = options(__doc__)
elevation = np.linspace(10.0, -10.0, found.points)
figure, (level, colour) = plt.subplots(1, 2, figsize=(9, 4))
for name, more, style in (("with ozone", {}, "-"), ("without ozone", {"atmosphere.ozone_absorption": (0, 0, 0)}, "--")):
    zenith = tyndall.Atmosphere({**found.parameters, **more}).radiance(0, 90.0 - elevation)
    for channel, line in enumerate(("tab:red", "tab:green", "tab:blue")):
        level.semilogy(elevation, zenith[:, channel], style, color=line, label=f"{'RGB'[channel]}, {name}")
    colour.plot(elevation, zenith[:, 2] / zenith[:, 0], "k" + style, label=name)
level.set(xlabel="elevation of the sun [deg]", ylabel="radiance / sun's irradiance [1/sr]", title="radiance of the zenith")
colour.set(xlabel="elevation of the sun [deg]", ylabel="blue / red", title="colour of the zenith")
for axes in (level, colour):
    axes.invert_xaxis()
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
save(figure, found.output)
