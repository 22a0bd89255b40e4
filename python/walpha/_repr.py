"""Named tuples of arrays, shown in one line."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

_Class = TypeVar("_Class", bound=type[tuple[Any, ...]])

#: An array of more elements is shown by its type and shape.
_SHOWN = 6


def in_a_line(named: _Class) -> _Class:
    """A class of named tuples whose repr shows long arrays by type and shape."""
    named.__repr__ = _line  # type: ignore[method-assign]
    return named


def _line(of: Any) -> str:
    fields = ", ".join(f"{name}={_short(value)}" for name, value in zip(of._fields, of, strict=True))
    return f"{type(of).__name__}({fields})"


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > _SHOWN:
        return f"<{value.dtype} {'×'.join(map(str, value.shape))}>"
    return " ".join(repr(value).split())
