#!/usr/bin/env python3
"""The limb of the Earth from orbit, by the altitude of the tangent point.

Up to some 10 km the limb is as bright as a thick layer can be. Above, it follows the density of air: radiance falls by a
factor e with each scale height of 8 km. Blue reaches higher than red because air scatters it more.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

found = options(__doc__)
air = tyndall.Atmosphere(found.parameters)
radius = float(air.parameters["planet.radius_m"])
eye = 400e3
tangent = np.linspace(0.0, 78e3, found.points)
zenith = 180.0 - np.degrees(np.arcsin((radius + tangent) / (radius + eye)))
figure, axes = plt.subplots(figsize=(5, 5))
for sun_zenith, style in ((60.0, "-"), (95.0, "--")):
    limb = air.radiance(zenith, sun_zenith, 90.0, altitude=eye)
    for channel, line in enumerate(("tab:red", "tab:green", "tab:blue")):
        axes.semilogx(limb[:, channel], tangent / 1e3, style, color=line,
                      label=f"{'RGB'[channel]}, sun at {90 - sun_zenith:+.0f} deg")
axes.set(xlabel="radiance / sun's irradiance [1/sr]", ylabel="tangent altitude [km]", title="the limb from 400 km", xlim=(1e-7, 1.0))
axes.grid(alpha=0.3)
axes.legend(fontsize=7)
save(figure, found.output)
