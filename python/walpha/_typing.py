"""Types of what is given and of what comes back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray


class DLPack(Protocol):
    """An array of another library, in the memory of the CPU."""

    def __dlpack__(self, *args: Any, **kwargs: Any) -> Any: ...

    def __dlpack_device__(self) -> tuple[Any, Any]: ...


#: What numpy makes an array of (lists, tensors of PyTorch, frames of pandas and polars), and what has DLPack.
Arrays: TypeAlias = ArrayLike | DLPack

Floats: TypeAlias = NDArray[np.float64]
Samples: TypeAlias = NDArray[np.float32]
Indices: TypeAlias = NDArray[np.int64]
Classes: TypeAlias = NDArray[np.uint8]

#: x, y, z.
Place: TypeAlias = tuple[float, float, float]

Rule: TypeAlias = Literal["auto", "auto:connected"]
Engine: TypeAlias = Literal["auto", "cgal", "native", "both"]
Balls: TypeAlias = Literal["power", "radius"]

Listener: TypeAlias = Callable[[str, int, int], object]
#: ``progress(stage, done, total)``, or True for a line on standard error.
Progress: TypeAlias = Listener | bool | None
