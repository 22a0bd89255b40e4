"""What the Python modules of walpha ask of the library. Not for users: see the modules."""

from collections.abc import Callable
from typing import final

import numpy as np
from numpy.typing import NDArray

__version__: str

_Floats = NDArray[np.float64]
_Indices = NDArray[np.uint32]
_Progress = Callable[[str, int, int], object] | None
_Listed = tuple[_Indices | None, NDArray[np.uint8] | None]

@final
class Shape:
    facts: str
    points: _Floats
    weights: _Floats
    values: _Floats | None
    cells: _Indices
    facets: _Indices
    edges: _Indices
    vertices: _Indices
    alpha: float
    exterior: bool
    measures: tuple[float, float, float]
    betti: tuple[int, int, int, int | None] | None
    periodic: list[float] | None
    copies: _Indices
    def unwrapped(self) -> Shape: ...
    hidden: _Indices | None
    duplicates: _Indices
    def classes(self) -> list[NDArray[np.uint8]]: ...
    def components(self) -> str: ...
    def component_numbers(self) -> NDArray[np.int64]: ...
    def voids(self) -> str | None: ...
    def boundary(self, solid: bool) -> tuple[_Floats, _Indices, _Indices, tuple[int, int, int]]: ...
    def outline(
        self,
    ) -> tuple[
        list[tuple[_Indices, list[_Indices]]], _Indices, _Indices, float, float, tuple[int, int]
    ]: ...
    def at(self, places: _Floats, values: _Floats | None) -> _Floats: ...
    def interpolate(
        self,
        sizes: list[int],
        low: list[float],
        high: list[float],
        values: _Floats | None,
        progress: _Progress,
    ) -> NDArray[np.float32]: ...
    def save(self, path: str, solid: bool) -> None: ...

@final
class Filtration:
    periodic: list[float] | None
    def __init__(
        self,
        points: _Floats,
        weights: _Floats | None,
        periodic: list[float] | None,
        progress: _Progress,
    ) -> None: ...
    def simplices(self, progress: _Progress) -> Simplices: ...
    def whole(self) -> Shape: ...
    def shape(self, alpha: float, exterior: bool, progress: _Progress) -> Shape: ...
    def ladder(self, alphas: _Floats, progress: _Progress) -> str: ...
    def curve(self, progress: _Progress) -> tuple[_Floats, list[NDArray[np.uint64]]]: ...
    def suggestions(self, progress: _Progress) -> str: ...
    def optimal_alpha(self, components: int, progress: _Progress) -> float: ...

@final
class Simplices:
    vertices: _Indices
    edges: _Indices
    facets: _Indices
    cells: _Indices
    intervals: _Floats
    ranks: _Indices
    gabriel: NDArray[np.bool_]
    order: _Indices
    component_pairs: _Indices
    void_pairs: _Indices
    lasting: tuple[list[int], list[int], list[int]]

@final
class Complex:
    def __init__(
        self,
        points: _Floats,
        weights: _Floats | None,
        alpha: float,
        cells: _Listed,
        facets: _Listed,
        edges: _Listed,
        vertices: _Listed,
        hidden: _Indices | None,
        duplicates: _Indices | None,
    ) -> None: ...
    @staticmethod
    def of(shape: Shape) -> Complex: ...
    def check(self, most: int, progress: _Progress) -> tuple[int, list[tuple[str, str]], str]: ...

def alpha_shape(
    points: _Floats,
    weights: _Floats | None,
    values: _Floats | None,
    alpha: float | str | None,
    engine: str,
    balls: str,
    exterior: bool,
    periodic: list[float] | None,
    progress: _Progress,
) -> Shape: ...
def compare(a: Complex, b: Complex) -> tuple[bool, str, str]: ...
def read(input: str, progress: _Progress) -> tuple[NDArray[np.float32], bool, str]: ...
def read_points(path: str, level: int | None) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64] | None,
    NDArray[np.float64] | None,
    list[int] | None,
    float | None,
    str,
]: ...
def write_points(
    path: str,
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    values: NDArray[np.float64] | None,
    alpha: float | str | None,
    value_error: float,
) -> None: ...
def haar(
    samples: NDArray[np.float32],
    tolerance: tuple[str, float],
    decomposition: str,
    progress: _Progress,
) -> tuple[NDArray[np.float32], str]: ...
def difference(samples: NDArray[np.float32]) -> _Floats: ...
def select(
    samples: NDArray[np.float32],
    smoothed: NDArray[np.float32],
    frame: str | None,
    rule: tuple[str, float],
    gray_min: float | None,
) -> tuple[_Floats, _Floats, _Floats]: ...
def weigh(differences: _Floats, weighting: str, alpha: float) -> _Floats: ...
def pipeline(
    samples: NDArray[np.float32],
    is_gray: bool,
    gray: tuple[float, float] | None,
    frame: str | None,
    haar: tuple[tuple[str, float], str],
    rule: tuple[str, float],
    gray_min: float | None,
    adaptive: tuple[int, float, float | None, bool] | None,
    weighting: str,
    alpha: float | str | None,
    engine: str,
    balls: str,
    exterior: bool,
    refit: str | None,
    progress: _Progress,
) -> Shape: ...
def sweep() -> None: ...
