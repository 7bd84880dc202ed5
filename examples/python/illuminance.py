#!/usr/bin/env python3
"""The illuminance through a clear day at a place, against a published model of the clear sky.

The model is that of the Illuminating Engineering Society of North America (IES RP-21-84; IES Lighting Handbook, 9th edition,
2000, chapter 8), a fit to measurements: direct sunlight at normal incidence is E0 exp(-0.21 m) with the optical air mass
m = 1 / sin(elevation), and the light of the clear sky on level ground is 0.8 + 15.5 sin(elevation)^0.5 klx.
"""
import matplotlib.pyplot as plt
import numpy as np

import tyndall
from figure import options, save

LATITUDE, LONGITUDE, DAY = 46.62, 8.04, "2026-06-21"  # of the sun; the ground is at sea level
ILLUMINANCE = 127.5  # of the sun above the atmosphere, IES [klx]

found = options(__doc__)
hours = np.linspace(3.0, 21.5, found.points)
times = [f"{DAY}T{int(h):02d}:{int(60 * h) % 60:02d}:{int(3600 * h) % 60:02d}+02:00" for h in hours]
sun = [tyndall.sun_position(LATITUDE, LONGITUDE, time) for time in times]
elevation = np.array([position.elevation for position in sun])
distance = np.array([position.distance_au for position in sun])

# A clear day: turbidity of continental air, ozone of mid-latitudes, meadows.
air = tyndall.Atmosphere({"atmosphere.aerosol_optical_depth": 0.1, "atmosphere.angstrom_exponent": 1.3,
                          "atmosphere.ozone_du": 330, "atmosphere.pressure_hpa": 1013, "planet.ground_albedo": 0.2,
                          **found.parameters}, color="xyz")
level = np.maximum(np.sin(np.radians(elevation)), 0.0)
direct = air.sun_irradiance(90.0 - elevation)[:, 1] * level / distance**2 / 1e3
sky = air.sky_irradiance(90.0 - elevation)[:, 1] / distance**2 / 1e3

up = level > 0.02
ies_direct = np.where(up, ILLUMINANCE * np.exp(-0.21 / np.maximum(level, 0.02)) * level / distance**2, np.nan)
ies_sky = np.where(up, 0.8 + 15.5 * np.sqrt(level), np.nan)

figure, (linear, logarithmic) = plt.subplots(1, 2, figsize=(9, 4))
for axes in (linear, logarithmic):
    for mine, model, colour, name in ((direct + sky, ies_direct + ies_sky, "k", "sun and sky"),
                                      (direct, ies_direct, "tab:orange", "sun"), (sky, ies_sky, "tab:blue", "sky")):
        axes.plot(hours, mine, color=colour, label=f"{name}, tyndall")
        axes.plot(hours, model, "--", color=colour, label=f"{name}, IES clear sky")
    axes.set(xlabel="time of day, UTC+2 [h]", ylabel="illuminance of level ground [klx]")
    axes.grid(alpha=0.3)
logarithmic.set(yscale="log", ylim=(1e-4, 300.0), title="with twilight")
linear.set(title=f"{DAY}, {LATITUDE:.0f}° N", ylim=(-3.0, 175.0))
linear.legend(fontsize=7, loc="upper left", ncol=2)
save(figure, found.output)
