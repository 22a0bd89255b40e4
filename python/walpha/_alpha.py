"""α as it is given."""

from __future__ import annotations

import math
import sys
import warnings
from typing import Any, cast

import numpy as np

from ._typing import Rule

_GIVE = 'give a squared length, "auto" or "auto:connected"'


def rule(alpha: Any, alpha_radius: Any) -> float | Rule | None:
    """A squared length, or the rule that finds one; None where neither is given."""
    if alpha_radius is not None:
        if alpha not in (None, "auto"):
            raise ValueError("alpha is the square of alpha_radius: give one of them")
        radius = _number("alpha_radius", alpha_radius, "give a length")
        if not radius >= 0:
            raise ValueError(f"alpha_radius={radius} is not a radius: give a number from 0 up")
        if not (radius in (0, math.inf) or sys.float_info.min <= radius * radius < math.inf):
            raise ValueError(f"alpha_radius={radius}: a double does not hold its square; rescale the points")
        return radius * radius
    if isinstance(alpha, str):
        if alpha not in ("auto", "auto:connected"):
            raise ValueError(f"alpha={alpha!r} is not a rule: {_GIVE}")
        return cast(Rule, alpha)
    return None if alpha is None else _number("alpha", alpha, _GIVE)


def squared(alpha: Any, alpha_radius: Any, otherwise: str) -> float:
    """A squared length; `otherwise` says what to do without."""
    found = rule(alpha, alpha_radius)
    if found is None or isinstance(found, str):
        given = "" if found is None else f"={found!r}"
        raise ValueError(
            f"alpha{given} must be a squared length here: give it as alpha or its root as alpha_radius{otherwise}"
        )
    return found


# The first α that a rule found for a shape, and whether it was said that another one differs.
_first: float | None = None
_told = False


def compared(found: float, stacklevel: int) -> None:
    """Says once that shapes for each of which a rule found another α do not compare."""
    global _first, _told
    if _first is None:
        _first = found
    elif found != _first and not _told:
        _told = True
        warnings.warn(
            f"alpha was found for each shape by itself, {_first:g} for one and {found:g} for another: their volumes "
            "and areas do not compare; to compare objects, give one number for all of them",
            stacklevel=stacklevel,
        )


def _number(name: str, given: Any, advice: str) -> float:
    if np.ndim(given):
        raise ValueError(
            f"{name} is one number, not an array of shape {np.shape(given)}: {advice}; weights have the name weights="
        )
    try:
        number = float(given)
    except (TypeError, ValueError):
        raise ValueError(f"{name}={given!r} is not a number: {advice}") from None
    if math.isnan(number):
        raise ValueError(f"{name} is NaN: {advice}")
    return number
