"""The classes of the results that the functions of this package return."""
import numpy as np


class AerialPerspective:
    """The in-scattering and the transmittance of the atmosphere between two points.

    inscattering: radiance that the atmosphere adds, shape (..., C).
    transmittance: fraction of the light from the far point that arrives, shape (..., C).
    """

    def __init__(self, inscattering, transmittance):
        self.inscattering = inscattering
        self.transmittance = transmittance

    def apply(self, radiance):
        """Returns radiance of an object at the far point as it is seen from the near point.

        With colours, this is exact for objects of the colour of sunlight above the atmosphere, and an approximation for others.
        """
        return np.asanyarray(radiance) * self.transmittance + self.inscattering

    def __repr__(self):
        return f"AerialPerspective(shape={self.inscattering.shape})"


class Estimate:
    """A result of the path tracer: `value` and its `standard_error`, both of shape (..., C)."""

    def __init__(self, value, standard_error):
        self.value = value
        self.standard_error = standard_error

    def __repr__(self):
        return f"Estimate(value={self.value!r}, standard_error={self.standard_error!r})"


class SunPosition:
    """The position of the sun in the sky: `elevation` and `azimuth` [deg], azimuth clockwise from north; `distance_au`."""

    def __init__(self, elevation, azimuth, distance_au):
        self.elevation = elevation
        self.azimuth = azimuth
        self.distance_au = distance_au

    @property
    def zenith(self):
        """The zenith angle of the sun [deg]."""
        return 90.0 - self.elevation

    def __repr__(self):
        return f"SunPosition(elevation={self.elevation!r}, azimuth={self.azimuth!r}, distance_au={self.distance_au!r})"


class MoonPosition:
    """The position of the moon in the sky, and its light.

    elevation, azimuth: in degrees, azimuth clockwise from north. distance_km: from the centre of the Earth.
    angular_radius: in degrees. phase_angle: between the directions from the moon to the sun and to the Earth, in degrees;
    0 is a full moon. illuminance: of moonlight above the atmosphere, on a surface that faces it [lux].
    """

    def __init__(self, elevation, azimuth, distance_km, angular_radius, phase_angle, illuminance):
        self.elevation = elevation
        self.azimuth = azimuth
        self.distance_km = distance_km
        self.angular_radius = angular_radius
        self.phase_angle = phase_angle
        self.illuminance = illuminance

    @property
    def zenith(self):
        """The zenith angle of the moon [deg]."""
        return 90.0 - self.elevation

    @property
    def illuminated_fraction(self):
        """The fraction of the disc that the sun lights, from 0 (new moon) to 1 (full moon)."""
        return 0.5 * (1.0 + np.cos(np.radians(self.phase_angle)))

    def __repr__(self):
        return (f"MoonPosition(elevation={self.elevation!r}, azimuth={self.azimuth!r}, "
                f"illuminated_fraction={self.illuminated_fraction:.3f}, illuminance={self.illuminance:.4g})")


class Tables:
    """The scattering tables as arrays with the coordinates of their entries. docs/tables.md explains how they are made.

    Values, in the channels C:
    single_rayleigh, single_mie: light scattered once by air and by aerosol, without the phase function: radiance / sun's
        irradiance, divided by the phase function [1/sr] of the angle between view and sun; (altitudes, views, suns, angles, C).
    high_orders: radiance / sun's irradiance of light scattered more than once [1/sr], same shape.
    sun_transmittance: fraction of the sunlight that reaches a point, (light altitudes, light suns, C).
    sky_irradiance: irradiance of a horizontal surface / sun's irradiance, same shape.

    Coordinates of the scattering tables:
    altitude: of the eye above sea level [m], (altitudes,).
    view_zenith: zenith angle of the ray [deg], (altitudes, views): the axis depends on the horizon, and so on the altitude.
    ends_on_ground: whether the ray ends on the ground, same shape.
    mean_distance: density-weighted mean distance along the ray [m], same shape.
    sun_zenith: zenith angle of the sun [deg], (suns,), at the point at mean_distance on the ray.
    view_sun: angle between view and sun [deg], (angles,). Where no geometry has the three angles, entries continue the table
        for interpolation.

    Coordinates of the look-up tables of light:
    light_altitude: [m], (light altitudes,).
    light_sun_zenith: zenith angle of the sun at the point [deg], (light altitudes, light suns).
    """

    def __init__(self, parts, channels):
        first = parts[0]

        def degrees(name):
            return np.degrees(np.arccos(np.clip(first[name], -1.0, 1.0)))

        for name in ("single_rayleigh", "single_mie", "high_orders"):
            # (altitudes, views, angles, suns, 3) in memory
            setattr(self, name, np.swapaxes(np.concatenate([part[name] for part in parts], axis=-1)[..., :channels], 2, 3))
        for name in ("sun_transmittance", "sky_irradiance"):
            setattr(self, name, np.swapaxes(np.concatenate([part[name][0, 0] for part in parts], axis=-1)[..., :channels], 0, 1))
        self.altitude = first["altitude"]
        self.view_zenith = degrees("cos_view_zenith")
        self.ends_on_ground = first["ends_on_ground"] != 0.0
        self.mean_distance = first["mean_distance"]
        self.sun_zenith = degrees("cos_sun_zenith")
        self.view_sun = degrees("cos_view_sun")
        self.light_altitude = first["light_altitude"]
        self.light_sun_zenith = degrees("light_cos_sun_zenith")

    def __repr__(self):
        return f"Tables(shape={self.single_rayleigh.shape})"
