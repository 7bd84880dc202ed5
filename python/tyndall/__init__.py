"""Answers questions about the light of the sky: radiance, irradiance, transmittance, aerial perspective.

    >>> import tyndall
    >>> air = tyndall.Atmosphere()
    >>> air.radiance(zenith=60, sun_zenith=40, azimuth=[0, 90, 180]).shape
    (3, 3)

Conventions. Angles are in degrees, lengths and altitudes in metres, wavelengths in nanometres. Zenith angles are measured
from the local vertical. An azimuth is the angle between a direction and the sun around the vertical: 0 looks towards the
sun. Arguments are numbers or arrays that broadcast against each other as in NumPy; a result has their common shape and, as
its last axis, the channels C: red, green and blue, which are the wavelengths of the parameter atmosphere.wavelengths_nm,
unless an Atmosphere is made for colours or for other wavelengths. Radiance and irradiance are relative to the sun's
irradiance above the atmosphere, so radiance has the unit 1/sr and irradiance has none; colours have units of their own.

Errors. ValueError for an argument or parameter that is out of range, OSError for a file, MemoryError, and tyndall.Error
if there is no usable Vulkan device. Nothing is printed. Calls release the interpreter lock, and all objects may be used
from several threads.
"""
import numpy as np

from . import _checks, _core
from ._core import Error
from ._results import AerialPerspective, Estimate, MoonPosition, SunPosition, Tables

__version__ = _core.version
__all__ = ["Atmosphere", "AerialPerspective", "Error", "Estimate", "MoonPosition", "SunPosition", "Tables", "allow_outside",
           "moon_position", "parameters", "refraction", "render", "rgb_from_xyz", "sun_position", "visible_spectrum",
           "xyz_from_rgb"]

COLORS = ("channels", "rgb", "xyz")
# Illuminance of the sun above the atmosphere at a distance of 1 au [lux], from the spectrum of ASTM G173-03.
SUN_ILLUMINANCE = _core.sun_illuminance
_LUMEN_PER_WATT = 683.0


class Atmosphere:
    """The atmosphere of a planet under a sun.

    parameters: a dictionary of parameters by name, such as {"atmosphere.aerosol_density": 4, "planet.ground_albedo": 0.3}.
        tyndall.parameters() lists all of them.
    scene: the name of a scene file (TOML) that is read first.
    model: "precomputed" looks up tables that hold all orders of scattering. Making them takes seconds; they are stored, so
        that the next program with the same parameters does not wait. "single" integrates single scattering over black
        ground and needs no tables. "oneil", "oneil-table", "homogeneous" and "homogeneous-medium" are the models of
        `tyndall probe` with these names, computed on the CPU: fast approximations with single scattering over black ground.
    device: the number or a part of the name of a Vulkan device; by default the fastest. Without a GPU, Mesa's CPU device
        is used.
    color: what the last axis C of results is. "channels": light at the three wavelengths of atmosphere.wavelengths_nm,
        relative to the sun's irradiance there. "rgb" and "xyz": the colour of the whole visible spectrum in the light of the
        sun at a distance of 1 au, from light at four wavelengths (scattering.color = spectral). "xyz" is CIE XYZ of the
        2 degree observer of 1931: radiance in cd/m^2 and irradiance in lux in Y. "rgb" is linear Rec. 709 in this unit / 683,
        without clipping. By default "channels", or "rgb" if the parameters set scattering.color = spectral.
    wavelengths: instead of color, wavelengths [nm], shape (C,): results are spectra, relative to the sun's irradiance at
        each wavelength. They are computed in groups of three, so each group of three costs what an Atmosphere costs. The
        coefficients between the channels are those of docs/air.md.

    Raises ValueError for an unknown parameter or a value that is out of range.
    """

    def __init__(self, parameters=None, *, scene="", model="precomputed", device="", color=None, wavelengths=None):
        if color is not None and color not in COLORS:
            raise ValueError(f"color: unknown value {color!r}; expected one of {', '.join(COLORS)}")
        groups = [[]]
        if wavelengths is not None:
            if color is not None:
                raise ValueError("color, wavelengths: both are given; expected one of them")
            wavelengths = np.atleast_1d(_checks.numbers("wavelengths", wavelengths))
            if wavelengths.ndim != 1 or not wavelengths.size:
                raise ValueError(f"wavelengths: invalid shape {wavelengths.shape}; expected (C,) with at least one")
            if np.any(wavelengths < 100.0) or np.any(wavelengths > 4000.0):
                raise ValueError("wavelengths: out of range; expected 100 to 4000 nm")
            groups = [list(group) + [group[-1]] * (3 - len(group))
                      for group in np.split(wavelengths, range(3, wavelengths.size, 3))]
        spectral, assignments = color in ("rgb", "xyz"), _checks.assignments(parameters)
        self._models = [_core.Model(str(scene), assignments, str(device), str(model), spectral, group) for group in groups]
        self._model = self._models[0]
        if self._model.channels == 4 and wavelengths is not None:
            raise ValueError("scattering.color: 'spectral' is set, and wavelengths are given; expected rgb")
        if self._model.channels == 4 and color == "channels":
            raise ValueError("scattering.color: 'spectral' is set, and color is 'channels'; expected rgb or xyz")
        self.model = str(model)
        self.color = "spectrum" if wavelengths is not None else color or ("rgb" if self._model.channels == 4 else "channels")
        self._wavelengths = wavelengths

    def __repr__(self):
        return f"Atmosphere(model={self.model!r}, color={self.color!r}, device={self.device!r})"

    @property
    def device(self):
        """The name of the Vulkan device."""
        return self._model.device

    @property
    def wavelengths(self):
        """The wavelengths of the channels [nm]; for colours, the four from which they follow."""
        return np.array(self._model.wavelengths_nm) if self._wavelengths is None else self._wavelengths.copy()

    @property
    def parameters(self):
        """All parameters with their values as text. With wavelengths, those of the first three."""
        return self._model.parameters

    @property
    def notes(self):
        """Remarks, for example that tables could not be stored, or that an atmosphere is too thick for them."""
        return list(dict.fromkeys(note for model in self._models for note in model.notes))

    def _rows(self, altitude, zenith, sun_zenith, azimuth):
        _checks.within("zenith", zenith, 0.0, 180.0)
        _checks.within("sun_zenith", sun_zenith, 0.0, 180.0)
        lowest = self._model.lowest_altitude_m
        if not np.all(altitude >= lowest):
            raise ValueError(f"altitude: out of range; expected at least {lowest:g} m")
        # Multiply as `tyndall probe` does, so that the results are the same.
        return np.stack([altitude, zenith * (np.pi / 180.0), sun_zenith * (np.pi / 180.0), azimuth * (np.pi / 180.0)], axis=1)

    def _join(self, parts):
        """Returns the channels of all groups, without those that only fill the last group."""
        return parts[0] if self._wavelengths is None else np.concatenate(parts, axis=1)[:, :self._wavelengths.size]

    def _shown(self, light, shape, ratio=False):
        """Returns light in the channels, shape (N, channels), as the result of a call."""
        if self._model.channels == 4:
            light = _core.colors(light, self.color == "xyz", ratio)
        return light.reshape(shape + light.shape[1:])

    def _answer(self, altitude, zenith, sun_zenith, azimuth, sky=False, ground=True):
        """Returns the common shape of the arguments, and light and transmittance, both of shape (N, channels)."""
        shape, flat = _checks.broadcast(altitude=altitude, zenith=zenith, sun_zenith=sun_zenith, azimuth=azimuth)
        rows = self._rows(*flat)
        light, transmittance = zip(*[model.answer(rows, sky, bool(ground)) for model in self._models])
        return shape, self._join(light), self._join(transmittance)

    def radiance(self, zenith, sun_zenith, azimuth=0.0, altitude=0.0, ground=True):
        """Returns the radiance of the sky in directions [1/sr], shape (..., C). The sun's disc is left out.

        zenith: angle of the direction of view from the vertical, 0 to 180 deg. Beyond the horizon it meets the ground.
        sun_zenith: zenith angle of the sun, 0 to 180 deg; more than 90 in twilight.
        azimuth: angle between view and sun around the vertical [deg].
        altitude: of the eye above sea level, from -11000 m to space.
        ground: whether light from the ground at the end of a ray is included (planet.ground_albedo). With other models than
            "precomputed" the ground is always black.
        """
        shape, light, _ = self._answer(altitude, zenith, sun_zenith, azimuth, ground=ground)
        return self._shown(light, shape)

    def transmittance(self, zenith, altitude=0.0):
        """Returns the transmittance from the eye to the ground or out of the atmosphere, shape (..., C).

        For colours, it is the colour of attenuated sunlight divided by that of sunlight, component by component.
        """
        shape, _, transmittance = self._answer(altitude, zenith, 0.0, 0.0)
        return self._shown(transmittance, shape, ratio=True)

    def sky_irradiance(self, sun_zenith, altitude=0.0):
        """Returns the diffuse irradiance of a horizontal surface that faces up, relative to the sun's, shape (..., C)."""
        shape, light, _ = self._answer(altitude, 0.0, sun_zenith, 0.0, sky=True)
        return self._shown(light, shape)

    def sun_irradiance(self, sun_zenith, altitude=0.0):
        """Returns the direct irradiance of a surface that faces the sun, relative to that above the atmosphere.

        It is the transmittance towards the middle of the disc, and 0 if the planet hides that. Shape (..., C).
        """
        shape, _, transmittance = self._answer(altitude, 0.0, sun_zenith, 0.0, sky=True)
        return self._shown(transmittance, shape)

    def aerial_perspective(self, start, end, sun_elevation, sun_azimuth):
        """Returns the in-scattering and the transmittance between points, without shadows, as an AerialPerspective.

        start, end: positions [m], shape (..., 3): x east, y up from sea level, z south. The planet's centre is at
            (0, -planet.radius_m, 0), so the ground curves away.
        sun_elevation, sun_azimuth: of the sun at the origin [deg], azimuth clockwise from north.

        Results are NaN where the ground is between the points: where the line between them passes more than 1 mm below sea
        level, and below both points. (The ground is at sea level, or as low as the lower point if that is below sea level.)

        In-scattering over short paths is a difference of two larger numbers, as in the renderer: over 100 m of clear air it
        is precise to about 1 %. Only the models "precomputed" and "single" have this method; others raise ValueError.
        """
        radius = self._model.planet_radius_m
        a, b, sun = self._points(start, end, sun_elevation, sun_azimuth)
        length = np.linalg.norm(b - a, axis=-1)
        direction = (b - a) / np.where(length > 0.0, length, 1.0)[..., None]
        direction = np.where(length[..., None] > 0.0, direction, [0.0, 1.0, 0.0])
        light, altitudes = [], []
        for point in (a, b):
            # Altitude without the cancellation of |point - centre| - radius.
            rise = np.sum(point * point, axis=-1) + 2.0 * radius * point[..., 1]
            from_centre = point + [0.0, radius, 0.0]
            altitude = rise / (np.linalg.norm(from_centre, axis=-1) + radius)
            altitudes.append(altitude)
            up = from_centre / np.linalg.norm(from_centre, axis=-1, keepdims=True)
            mu = np.clip(np.sum(up * direction, axis=-1), -1.0, 1.0)
            mu_sun = np.clip(np.sum(up * sun, axis=-1), -1.0, 1.0)
            nu = np.clip(np.sum(direction * sun, axis=-1), -1.0, 1.0)
            across = np.sqrt(np.maximum((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun), 0.0))
            cosine = np.where(across > 1e-12, (nu - mu * mu_sun) / np.where(across > 1e-12, across, 1.0), 1.0)
            angles = [np.degrees(np.arccos(np.clip(x, -1.0, 1.0))) for x in (mu, mu_sun, cosine)]
            if len(light) == 0:
                rays = np.stack([altitude.ravel(), mu.ravel(), length.ravel()], axis=1)
                transmittance = self._join([model.transmittance(rays) for model in self._models])
                below = _checks.lowest_altitude(altitude, mu, length, radius)
            light.append(self._answer(altitude, *angles, ground=False)[1])
        apart = (length > 0.0).reshape(-1, 1)
        inscattering = np.where(apart, np.maximum(light[0] - transmittance * light[1], 0.0), 0.0)
        blocked = below < np.minimum(np.minimum(*altitudes), 0.0) - 1e-3
        out = [self._shown(inscattering, length.shape), self._shown(transmittance, length.shape, ratio=True)]
        for array in out:
            array[blocked] = np.nan
        return AerialPerspective(*out)

    def _points(self, start, end, sun_elevation, sun_azimuth):
        """Returns points and the direction of the sun as arrays of one shape (..., 3)."""
        a, b = _checks.numbers("start", start), _checks.numbers("end", end)
        for name, point in (("start", a), ("end", b)):
            if point.shape[-1:] != (3,):
                raise ValueError(f"{name}: invalid shape {point.shape}; expected (..., 3)")
        elevation = _checks.numbers("sun_elevation", sun_elevation)
        azimuth = np.radians(_checks.numbers("sun_azimuth", sun_azimuth))
        _checks.within("sun_elevation", elevation, -90.0, 90.0)
        level = np.cos(np.radians(elevation))
        try:
            sun = np.broadcast_arrays(level * np.sin(azimuth), np.sin(np.radians(elevation)), -level * np.cos(azimuth))
            return np.broadcast_arrays(a, b, np.stack(sun, axis=-1))
        except ValueError:
            raise ValueError(f"shapes do not fit together: start {a.shape}, end {b.shape}, sun_elevation {elevation.shape}, "
                             f"sun_azimuth {azimuth.shape}; expected shapes that broadcast") from None

    def sky_map(self, sun_elevation, sun_azimuth=0.0, width=512, height=256, altitude=0.0):
        """Returns the radiance of all directions as an environment map, shape (height, width, C) [1/sr].

        Latitude and longitude: the zenith is at the top, north at the left edge, and azimuth runs clockwise to the right.
        Values are those at the centres of the pixels. The sun's elevation and azimuth and the altitude are numbers.
        """
        for name, value in (("sun_elevation", sun_elevation), ("sun_azimuth", sun_azimuth), ("altitude", altitude)):
            if np.ndim(value) != 0:
                raise ValueError(f"{name}: invalid shape {np.shape(value)}; expected a number")
        _checks.within("sun_elevation", _checks.numbers("sun_elevation", sun_elevation), -90.0, 90.0)
        sun_azimuth = _checks.numbers("sun_azimuth", sun_azimuth)
        width, height = _checks.count("width", width, 1, 65536), _checks.count("height", height, 1, 65536)
        zenith = (np.arange(height) + 0.5) * (180.0 / height)
        azimuth = (np.arange(width) + 0.5) * (360.0 / width)
        return self.radiance(zenith[:, None], 90.0 - sun_elevation, azimuth[None, :] - sun_azimuth, altitude)

    def tables(self):
        """Returns the scattering tables as Tables: arrays with the coordinates of their axes.

        Only the model "precomputed" has tables, and they hold channels or spectra, not colours. Raises ValueError otherwise.
        """
        return Tables([model.tables() for model in self._models], self.wavelengths.size)

    def trace(self, zenith, sun_zenith, azimuth=0.0, altitude=0.0, *, samples=100000, orders=8, seed=1):
        """Returns the radiance by the path tracer, as an Estimate with standard errors. Arguments as for radiance().

        samples: paths for each direction; the error decreases with their square root.
        orders: orders of scattering, 1 to 256. The cost is about 1 s for 10^6 paths of 8 orders on one core and three
            channels, and docs/python.md has that of colours and spectra: 40 wavelengths follow the same paths.

        The path tracer shares no code with the tables. The ground at the end of a ray is visible. Ctrl-C ends it.
        """
        return self._trace(altitude, zenith, sun_zenith, azimuth, False, samples, orders, seed)

    def trace_sky_irradiance(self, sun_zenith, altitude=0.0, *, samples=100000, orders=8, seed=1):
        """Returns what sky_irradiance() does, by the path tracer, as an Estimate. Options as for trace()."""
        return self._trace(altitude, 0.0, sun_zenith, 0.0, True, samples, orders, seed)

    def _trace(self, altitude, zenith, sun_zenith, azimuth, sky, samples, orders, seed):
        shape, flat = _checks.broadcast(altitude=altitude, zenith=zenith, sun_zenith=sun_zenith, azimuth=azimuth)
        rows = self._rows(*flat)
        samples, orders = _checks.count("samples", samples, 1, 1 << 48), _checks.count("orders", orders, 1, 256)
        seed = _checks.count("seed", seed, 0, (1 << 64) - 1)
        groups = [[]] if self._wavelengths is None else np.split(self._wavelengths, range(40, self._wavelengths.size, 40))
        light, _, error = zip(*[self._model.trace(rows, sky, samples, orders, seed, self.color == "xyz", list(group))
                                for group in groups])
        return Estimate(*[np.concatenate(x, axis=1).reshape(shape + (-1,) if rows.size else shape + (x[0].shape[1],))
                          for x in (light, error)])


def render(scene="", parameters=None, *, size=(1280, 720), display=False, device=""):
    """Renders a picture of the demo scene and returns it as an array of float32, shape (height, width, 3).

    scene: the name of a scene file; by default the default scene. parameters: as for Atmosphere.
    size: width and height in pixels. display: tone-mapped values from 0 to 1, linear, instead of radiance.
    """
    if np.shape(size) != (2,):
        raise ValueError(f"size: invalid value {size!r}; expected width and height")
    width, height = (_checks.count("size", side, 1, 65536) for side in size)
    return _core.render(str(scene), _checks.assignments(parameters), width, height, str(device), bool(display))


def sun_position(latitude, longitude, time, altitude=0.0):
    """Returns where the sun is, as a SunPosition, after Reda and Andreas (2003), within 0.005 deg without refraction.

    latitude, longitude: in degrees, north and east positive. time: ISO 8601 with an offset from UTC, such as
    "2003-10-17T12:30:30-07:00", or an aware datetime; 1900 to 2100. altitude: of the place above sea level [m].
    """
    found = _core.sun_position(*_checks.place(latitude, longitude), _checks.time(time), _checks.number("altitude", altitude))
    return SunPosition(found["elevation"], found["azimuth"], found["distance_au"])


def moon_position(latitude, longitude, time):
    """Returns where the moon is and how bright, as a MoonPosition. The position follows Meeus (1998), chapter 47, within
    0.02 deg, with parallax and without refraction, and the illuminance Krisciunas and Schaefer (1991). Arguments as for
    sun_position(). For the sky under the moon, pass its zenith angle as that of the sun, and multiply colours by
    illuminance / SUN_ILLUMINANCE.
    """
    return MoonPosition(**_core.moon_position(*_checks.place(latitude, longitude), _checks.time(time)))


def refraction(elevation):
    """Returns by how much the atmosphere raises an object [deg] whose elevation [deg] without an atmosphere is given.

    After Saemundsson (1986), at 1010 hPa and 10 degrees Celsius. Add it to the elevation of the sun or the moon.
    """
    return _core.refraction(_checks.numbers("elevation", elevation))


def allow_outside():
    """Allows scenes and models to name files outside of their folders, from now on in this process.

    This is the same as --allow-outside of the program. Call it only if you trust the scene files; SECURITY.md says why.
    """
    _core.allow_outside()


def visible_spectrum():
    """Returns 40 wavelengths [nm], shape (40,), and weights, shape (40, 3), that turn a spectrum into a colour.

    spectrum @ weights is CIE XYZ [cd/m^2, or lux] of light relative to the sun's irradiance at these wavelengths. The weights
    are the products of the solar spectrum of ASTM G173-03, the colour-matching functions of the 2 degree observer (CIE
    15:2004), the width of 10 nm and 683 lm/W.
    """
    return _core.visible_spectrum()


def xyz_from_rgb(rgb):
    """Returns CIE XYZ [cd/m^2 or lux] of colours in the unit of color="rgb", shape (..., 3)."""
    matrix = np.array([_core.xyz_of_color(list(row)) for row in np.eye(3)])
    return _LUMEN_PER_WATT * (_checks.colors("rgb", rgb) @ matrix)


def rgb_from_xyz(xyz):
    """Returns the inverse of xyz_from_rgb(): linear Rec. 709 of CIE XYZ, shape (..., 3). Components may be negative."""
    matrix = np.array([_core.xyz_of_color(list(row)) for row in np.eye(3)])
    return _checks.colors("xyz", xyz) @ np.linalg.inv(matrix) / _LUMEN_PER_WATT


def parameters():
    """Returns a list of all parameters: dictionaries with name, default, allowed, unit and meaning."""
    return _core.describe_parameters()
