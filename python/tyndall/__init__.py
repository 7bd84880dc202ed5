"""Answers questions about the light of the sky: radiance, irradiance, transmittance, aerial perspective.

    >>> import tyndall
    >>> air = tyndall.Atmosphere()
    >>> air.radiance(zenith=60, sun_zenith=40, azimuth=[0, 90, 180]).shape
    (3, 3)

Conventions. Angles are in degrees, lengths and altitudes in metres. Zenith angles are measured from the local vertical.
An azimuth is the angle between a direction and the sun around the vertical: 0 looks towards the sun. Arguments are numbers
or arrays that broadcast against each other as in NumPy; a result has their common shape and, as its last axis, the three
channels red, green and blue, which are the wavelengths of the parameter atmosphere.wavelengths_nm. Radiance and irradiance
are relative to the sun's irradiance above the atmosphere, so radiance has the unit 1/sr and irradiance has none.

Errors. ValueError for an argument or parameter that is out of range, OSError for a file, MemoryError, and tyndall.Error
if there is no usable Vulkan device. Nothing is printed. Calls release the interpreter lock, and all objects may be used
from several threads.
"""
import numpy as np

from . import _core
from ._core import Error

__version__ = _core.version
__all__ = ["Atmosphere", "AerialPerspective", "Error", "Estimate", "SunPosition", "parameters", "render", "sun_position"]

MODELS = ("precomputed", "single")


class AerialPerspective:
    """what the atmosphere does to light between two points.

    inscattering: radiance that the atmosphere adds [1/sr], shape (..., 3).
    transmittance: fraction of the light from the far point that arrives, shape (..., 3).
    """

    def __init__(self, inscattering, transmittance):
        self.inscattering = inscattering
        self.transmittance = transmittance

    def apply(self, radiance):
        """Returns radiance of an object at the far point [1/sr] as it is seen from the near point."""
        return np.asarray(radiance) * self.transmittance + self.inscattering

    def __repr__(self):
        return f"AerialPerspective(shape={self.inscattering.shape})"


class Estimate:
    """A result of the path tracer: `value` and its `standard_error`, both of shape (..., 3)."""

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


def _text(value):
    """Returns the value of a parameter as the text that scene files and --set take."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if np.ndim(value) == 0:
        return repr(value.item() if isinstance(value, np.generic) else value)
    return ",".join(_text(part) for part in value)


def _assignments(parameters):
    return [(str(key), _text(value)) for key, value in (parameters or {}).items()]


def _broadcast(*arguments):
    """Returns the common shape of the arguments, and the arguments as flat arrays of float64."""
    arrays = np.broadcast_arrays(*[np.asarray(argument, dtype=np.float64) for argument in arguments])
    return arrays[0].shape, [array.ravel() for array in arrays]


class Atmosphere:
    """The atmosphere of a planet under a sun.

    parameters: a dictionary of parameters by name, such as {"atmosphere.aerosol_density": 4, "planet.ground_albedo": 0.3}.
        tyndall.parameters() lists all of them.
    scene: the name of a scene file (TOML) that is read first.
    model: "precomputed" looks up tables that hold all orders of scattering. Making them takes seconds; they are stored, so
        that the next program with the same parameters does not wait. "single" integrates single scattering over black
        ground and needs no tables.
    device: the number or a part of the name of a Vulkan device; by default the fastest. Without a GPU, Mesa's CPU device
        is used.

    Raises ValueError for an unknown parameter or a value that is out of range.
    """

    def __init__(self, parameters=None, *, scene="", model="precomputed", device=""):
        if model not in MODELS:
            raise ValueError(f"model: unknown model {model!r}; expected one of {', '.join(MODELS)}")
        self._model = _core.Model(str(scene), _assignments(parameters), str(device), model == "precomputed")
        self.model = model

    def __repr__(self):
        return f"Atmosphere(model={self.model!r}, device={self.device!r})"

    @property
    def device(self):
        """The name of the Vulkan device."""
        return self._model.device

    @property
    def parameters(self):
        """All parameters with their values as text."""
        return self._model.parameters

    @property
    def notes(self):
        """Remarks, for example that tables could not be stored."""
        return self._model.notes

    def _rows(self, altitude, zenith, sun_zenith, azimuth):
        for name, angle in (("zenith", zenith), ("sun_zenith", sun_zenith)):
            if angle.size and not (np.all(angle >= 0.0) and np.all(angle <= 180.0)):
                raise ValueError(f"{name}: out of range; expected 0 to 180 degrees")
        lowest = self._model.lowest_altitude_m
        if altitude.size and not np.all(altitude >= lowest):
            raise ValueError(f"altitude: out of range; expected at least {lowest:g} m")
        # The same product as `tyndall probe`, so that the results are the same.
        return np.stack([altitude, zenith * (np.pi / 180.0), sun_zenith * (np.pi / 180.0), azimuth * (np.pi / 180.0)], axis=1)

    def _answer(self, altitude, zenith, sun_zenith, azimuth, sky=False, ground=True):
        shape, flat = _broadcast(altitude, zenith, sun_zenith, azimuth)
        light, transmittance = self._model.answer(self._rows(*flat), sky, ground)
        return light.reshape(shape + (3,)), transmittance.reshape(shape + (3,))

    def radiance(self, zenith, sun_zenith, azimuth=0.0, altitude=0.0, ground=True):
        """Returns the radiance of the sky in directions [1/sr], shape (..., 3). The sun's disc is left out.

        zenith: angle of the direction of view from the vertical, 0 to 180 deg. Beyond the horizon it meets the ground.
        sun_zenith: zenith angle of the sun, 0 to 180 deg; more than 90 in twilight.
        azimuth: angle between view and sun around the vertical [deg].
        altitude: of the eye above sea level, from -11000 m to space.
        ground: whether light from the ground at the end of a ray is included (planet.ground_albedo). With model="single"
            the ground is always black.
        """
        return self._answer(altitude, zenith, sun_zenith, azimuth, ground=ground)[0]

    def transmittance(self, zenith, altitude=0.0):
        """Returns the transmittance from the eye to the ground or out of the atmosphere, shape (..., 3)."""
        return self._answer(altitude, zenith, 0.0, 0.0)[1]

    def sky_irradiance(self, sun_zenith, altitude=0.0):
        """Returns the diffuse irradiance of a horizontal surface that faces up, relative to the sun's, shape (..., 3)."""
        return self._answer(altitude, 0.0, sun_zenith, 0.0, sky=True)[0]

    def sun_irradiance(self, sun_zenith, altitude=0.0):
        """Returns the direct irradiance of a surface that faces the sun, relative to that above the atmosphere.

        It is the transmittance towards the middle of the disc, and 0 if the planet hides that. Shape (..., 3).
        """
        return self._answer(altitude, 0.0, sun_zenith, 0.0, sky=True)[1]

    def aerial_perspective(self, start, end, sun_elevation, sun_azimuth):
        """Returns the in-scattering and the transmittance between points, without shadows, as an AerialPerspective.

        start, end: positions [m], shape (..., 3): x east, y up from sea level, z south. The planet's centre is at
            (0, -planet.radius_m, 0), so the ground curves away.
        sun_elevation, sun_azimuth: of the sun at the origin [deg], azimuth clockwise from north.

        In-scattering over short paths is a difference of two larger numbers, as in the renderer: over 100 m of clear air it
        is precise to about 1 %.
        """
        radius = self._model.planet_radius_m
        a, b = np.broadcast_arrays(np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64))
        if a.shape[-1:] != (3,):
            raise ValueError(f"start, end: invalid shape {a.shape}; expected (..., 3)")
        elevation, azimuth = np.radians(sun_elevation), np.radians(sun_azimuth)
        level = np.cos(elevation)
        sun = np.stack(np.broadcast_arrays(level * np.sin(azimuth), np.sin(elevation), -level * np.cos(azimuth)), axis=-1)
        a, b, sun = np.broadcast_arrays(a, b, sun)
        length = np.linalg.norm(b - a, axis=-1)
        direction = (b - a) / np.where(length > 0.0, length, 1.0)[..., None]
        direction = np.where(length[..., None] > 0.0, direction, [0.0, 1.0, 0.0])
        light = []
        for point in (a, b):
            # Altitude without the cancellation of |point - centre| - radius.
            rise = np.sum(point * point, axis=-1) + 2.0 * radius * point[..., 1]
            from_centre = point + [0.0, radius, 0.0]
            altitude = rise / (np.linalg.norm(from_centre, axis=-1) + radius)
            up = from_centre / np.linalg.norm(from_centre, axis=-1, keepdims=True)
            mu = np.clip(np.sum(up * direction, axis=-1), -1.0, 1.0)
            mu_sun = np.clip(np.sum(up * sun, axis=-1), -1.0, 1.0)
            nu = np.clip(np.sum(direction * sun, axis=-1), -1.0, 1.0)
            across = np.sqrt(np.maximum((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun), 0.0))
            cosine = np.where(across > 1e-12, (nu - mu * mu_sun) / np.where(across > 1e-12, across, 1.0), 1.0)
            angles = [np.degrees(np.arccos(np.clip(x, -1.0, 1.0))) for x in (mu, mu_sun, cosine)]
            light.append(self.radiance(*angles, altitude=altitude, ground=False))
            if len(light) == 1:
                rays = np.stack([altitude.ravel(), mu.ravel(), length.ravel()], axis=1)
                transmittance = self._model.transmittance(rays).reshape(length.shape + (3,))
        inscattering = np.where(length[..., None] > 0.0, np.maximum(light[0] - transmittance * light[1], 0.0), 0.0)
        return AerialPerspective(inscattering, transmittance)

    def sky_map(self, sun_elevation, sun_azimuth=0.0, width=512, height=256, altitude=0.0):
        """Returns the radiance of all directions as an environment map, shape (height, width, 3) [1/sr].

        Latitude and longitude: the zenith is at the top, north at the left edge, and azimuth runs clockwise to the right.
        Values are those at the centres of the pixels.
        """
        zenith = (np.arange(height) + 0.5) * (180.0 / height)
        azimuth = (np.arange(width) + 0.5) * (360.0 / width)
        return self.radiance(zenith[:, None], 90.0 - sun_elevation, azimuth[None, :] - sun_azimuth, altitude)

    def trace(self, zenith, sun_zenith, azimuth=0.0, altitude=0.0, *, samples=100000, orders=8, seed=1):
        """Returns the radiance by the path tracer, as an Estimate with standard errors. Arguments as for radiance().

        samples: paths for each direction; the error decreases with their square root.
        orders: orders of scattering, 1 to 256. The cost is about 1 s for 10^6 paths of 8 orders on one core.

        The path tracer shares no code with the tables. Ctrl-C ends it.
        """
        shape, flat = _broadcast(altitude, zenith, sun_zenith, azimuth)
        light, _, error = self._model.trace(self._rows(*flat), False, samples, orders, seed)
        return Estimate(light.reshape(shape + (3,)), error.reshape(shape + (3,)))


def render(scene="", parameters=None, *, size=(1280, 720), display=False, device=""):
    """Renders a picture of the demo scene and returns it as an array of float32, shape (height, width, 3).

    scene: the name of a scene file; by default the default scene. parameters: as for Atmosphere.
    size: width and height in pixels. display: tone-mapped values from 0 to 1, linear, instead of radiance.
    """
    width, height = size
    return _core.render(str(scene), _assignments(parameters), int(width), int(height), str(device), bool(display))


def sun_position(latitude, longitude, time, altitude=0.0):
    """Returns where the sun is, as a SunPosition, after Reda and Andreas (2003), within 0.001 deg without refraction.

    latitude, longitude: in degrees, north and east positive. time: ISO 8601 with an offset from UTC, such as
    "2003-10-17T12:30:30-07:00", or an aware datetime; 1900 to 2100. altitude: of the place above sea level [m].
    """
    if hasattr(time, "isoformat"):
        if time.utcoffset() is None:
            raise ValueError("time: the datetime has no time zone; expected an aware datetime")
        time = time.isoformat()
    found = _core.sun_position(float(latitude), float(longitude), str(time), float(altitude))
    return SunPosition(found["elevation"], found["azimuth"], found["distance_au"])


def parameters():
    """Returns a list of all parameters: dictionaries with name, default, allowed, unit and meaning."""
    return _core.describe_parameters()
