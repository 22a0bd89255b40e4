"""Settings as the library takes them: text by their names."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any

import numpy as np

# Settings that are whole numbers, which may be given as floats.
_COUNTS = ("count", "coefficients")


def written(**given: Any) -> list[tuple[str, str]]:
    """The settings that were given: None and False are left out."""
    plain = {name: bool(value) if isinstance(value, np.bool_) else value for name, value in given.items()}
    return [(name, _text(name, value)) for name, value in plain.items() if value is not None and value is not False]


def _text(name: str, value: Any) -> str:
    if value is True:
        return "true"
    if isinstance(value, str):
        return value
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        number = float(value)
        return str(int(number)) if name in _COUNTS and number.is_integer() else repr(number)
    return ",".join(_text(name, item) for item in value)


def window(gray: tuple[float, float] | None) -> str | None:
    """The values that become gray 0 and 255."""
    if gray is None:
        return None
    low, high = map(float, gray)
    return f"{low!r}..{high!r}"


def surface(value: float | str, closed: bool) -> str:
    """The isosurface at a value, or its outer part."""
    return _text("surface", value) + (":closed" if closed else "")


def replacement(nan: float | None, masked: bool) -> float | str | None:
    """What replaces samples that are NaN; NaN itself masks them."""
    if nan is None:
        return "mask" if masked else None
    return "mask" if math.isnan(nan) else nan


def one_of(**options: Any) -> dict[str, Any]:
    """The one that was given, if any."""
    given = {name: value for name, value in options.items() if value is not None}
    if len(given) > 1:
        raise ValueError(f"{' and '.join(given)} contradict each other: give one")
    return given
