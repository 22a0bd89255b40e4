"""Frames and structured arrays: columns by their names."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from . import _walpha


def names(given: Any) -> list[Any] | None:
    """The names of the columns of a table; None of what is not a table."""
    dtype = getattr(given, "dtype", None)
    if isinstance(dtype, np.dtype) and dtype.names:
        return list(dtype.names)
    if isinstance(given, dict):
        return list(given)
    # pyarrow has the columns themselves under the name that pandas and polars have for their names.
    for attribute in ("column_names", "columns"):
        found = getattr(given, attribute, None)
        if found is not None and hasattr(given, "__getitem__"):
            return list(found)
    return None


def columns(name: str, given: Any, wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """What a table has under x, y, z and the other names that are wanted, by the rule for the columns of files; None of what
    is not a table. A warning names what is skipped."""
    labels = names(given)
    if labels is None:
        return None
    try:
        meanings = _walpha.columns([str(label) for label in labels])
    except ValueError as error:
        raise ValueError(
            f"{name}: {error}; of a table whose columns have other names give the numbers, in the order x, y, z: "
            "frame[[...]].to_numpy()"
        ) from None
    found: dict[str, Any] = {}
    skipped = []
    for label, meaning in zip(labels, meanings, strict=True):
        if meaning is not None and meaning in ("x", "y", "z", *wanted):
            found[meaning] = given[label]
        else:
            skipped.append(str(label))
    if skipped:
        listed = ", ".join(map(repr, skipped))
        warnings.warn(f"{name}: skipped, as the columns that are read are {', '.join(found)}: {listed}", stacklevel=4)
    return found
