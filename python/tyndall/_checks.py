"""Checks and conversions of arguments. Errors name the argument and what is expected."""
import operator

import numpy as np


def text(value):
    """Returns the value of a parameter as the text that scene files and --set take."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if np.ndim(value) == 0:
        return repr(value.item() if isinstance(value, np.generic) else value)
    return ",".join(text(part) for part in value)


def assignments(parameters):
    if parameters is not None and not hasattr(parameters, "items"):
        raise ValueError(f"parameters: invalid type {type(parameters).__name__!r}; expected a dictionary of names and values")
    return [(str(key), text(value)) for key, value in (parameters or {}).items()]


def numbers(name, value):
    """Returns an argument as an array of float64."""
    try:
        if np.iscomplexobj(value):
            raise TypeError
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: invalid value {str(value)[:60]!r}; expected numbers") from None
    if np.ma.is_masked(value):
        raise ValueError(f"{name}: a value is masked; expected numbers")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name}: a value is not finite; expected numbers")
    return array


def number(name, value):
    """Returns an argument as a float."""
    array = numbers(name, value)
    if array.ndim != 0:
        raise ValueError(f"{name}: invalid shape {array.shape}; expected a number")
    return float(array)


def place(latitude, longitude):
    return number("latitude", latitude), number("longitude", longitude)


def time(value):
    """Returns a time as text of ISO 8601."""
    if hasattr(value, "isoformat"):
        if getattr(value, "utcoffset", lambda: None)() is None:
            raise ValueError("time: the datetime has no time zone; expected an aware datetime")
        return value.isoformat()
    return str(value)


def count(name, value, low, high):
    """Returns an argument as an integer within a range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ValueError(f"{name}: invalid value {str(value)[:60]!r}; expected a whole number from {low} to {high}") from None
    if not low <= number <= high:
        raise ValueError(f"{name}: {number} is out of range; expected {low} to {high}")
    return number


def within(name, array, low, high):
    if not (np.all(array >= low) and np.all(array <= high)):
        raise ValueError(f"{name}: out of range; expected {low:g} to {high:g} degrees")


def broadcast(**arguments):
    """Returns the common shape of the arguments, and the arguments as flat arrays of float64."""
    arrays = [numbers(name, value) for name, value in arguments.items()]
    try:
        arrays = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(arguments, arrays))
        raise ValueError(f"shapes do not fit together: {shapes}; expected shapes that broadcast") from None
    return arrays[0].shape, [array.ravel() for array in arrays]


def lowest_altitude(altitude, mu, length, radius):
    """Returns the lowest altitude [m] of lines that start at `altitude` with the cosine `mu` of the zenith angle."""
    along = np.clip(-(radius + altitude) * mu, 0.0, length)
    # |(r, along)| - R without cancellation: its square is r^2 + along^2 + 2 r along mu.
    excess = altitude * (2.0 * radius + altitude) + along * (along + 2.0 * (radius + altitude) * mu)
    return excess / (np.sqrt(np.maximum(radius * radius + excess, 0.0)) + radius)


def colors(name, value):
    array = numbers(name, value)
    if array.shape[-1:] != (3,):
        raise ValueError(f"{name}: invalid shape {array.shape}; expected (..., 3)")
    return array
