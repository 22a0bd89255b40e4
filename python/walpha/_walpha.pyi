"""What the Python modules of walpha ask of the library. Not for users: see the modules."""

from typing import Literal, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import NDArray

from ._arrays import Cloud
from ._typing import Classes, Floats, Indices, Listener, Samples

__version__: str

_Rows: TypeAlias = NDArray[np.uint32]
# How many threads, and what receives progress.
_Task: TypeAlias = tuple[int | None, Listener | None]
# Rows of one dimension, and their classes.
_Listed: TypeAlias = tuple[_Rows | None, Classes | None]
# Engine, balls, exterior, hidden.
_Settings: TypeAlias = list[tuple[str, str]]
_State: TypeAlias = tuple[str, str, str]
# Polygons of a ring and holes, edges, vertices, area, perimeter, axes.
Outline: TypeAlias = tuple[list[tuple[_Rows, list[_Rows]]], _Rows, _Rows, float, float, list[int]]

_Number: TypeAlias = tuple[float, float]
_Column: TypeAlias = tuple[Floats, Floats]
# Volume, area, cells, balls at it, the α that fills it.
Hollow: TypeAlias = tuple[_Number, _Number, int, _Rows, float]
# Totals, Euler characteristic, share of the box, volumes, areas, contacts.
UnionParts: TypeAlias = tuple[list[_Number], int, _Number | None, _Column, _Column, _Rows, _Column]

@final
class Union:
    def parts(self) -> UnionParts: ...
    def voids(self) -> list[Hollow]: ...
    def pockets(self) -> list[tuple[Hollow, list[list[list[int]]], float]]: ...
    def gradients(self, weights: Floats | None) -> list[_Column]: ...
    def surface(self, tolerance: float) -> tuple[Floats, _Rows, _Rows]: ...

@final
class Shape:
    facts: str
    points: Floats
    weights: Floats
    values: Floats | None
    cells: _Rows
    facets: _Rows
    edges: _Rows
    vertices: _Rows
    alpha: float
    voxels: int | None
    isovalue: float | None
    engine: Literal["cgal", "native", "both"]
    exterior: bool
    measures: tuple[float, float, float, float]
    dimension: int
    kept: tuple[int, int] | None
    betti: tuple[int, int, int, int | None]
    periodic: list[float] | None
    copies: _Rows
    shifts: NDArray[np.int32]
    hidden: _Rows | None
    duplicates: _Rows
    def state(self) -> _State: ...
    def unwrapped(self) -> Shape: ...
    def keep(self, largest: str | None, min_volume: float | None) -> Shape: ...
    def classes(self) -> list[Classes]: ...
    def components(self) -> str: ...
    def component_numbers(self) -> Indices: ...
    def voids(self) -> str | None: ...
    def boundary(self, solid: bool) -> tuple[Floats, _Rows, _Rows, tuple[int, int, int, int, float, int]]: ...
    def union(self) -> Union: ...
    def outline(self) -> Outline: ...
    def at(self, places: Floats, values: Floats | None) -> Floats: ...
    def interpolate(
        self,
        sizes: list[int],
        low: list[float],
        high: list[float],
        values: Floats | None,
        task: _Task,
    ) -> Samples: ...
    def save(self, path: str, solid: bool, allow_empty: bool) -> str | None: ...
    def picture(self, view: str, colour: str, size: tuple[int, int]) -> bytes: ...
    def page(self, title: str, facts: list[tuple[str, str]]) -> str: ...

@final
class Filtration:
    points: Floats
    weights: Floats
    periodic: list[float] | None
    copies: _Rows
    shifts: NDArray[np.int32]
    def __init__(
        self, points: Floats, weights: Floats | None, periodic: list[float] | None, task: _Task
    ) -> None: ...
    def simplices(self, task: _Task) -> Simplices: ...
    def whole(self) -> Shape: ...
    def shape(self, alpha: float, exterior: bool, task: _Task) -> Shape: ...
    def ladder(self, alphas: Floats, task: _Task) -> str: ...
    def curve(self, task: _Task) -> tuple[Floats, list[NDArray[np.uint64]]]: ...
    def derivatives(self, vertices: NDArray[np.uint32], corners: int, task: _Task) -> Floats: ...
    def suggestions(self, task: _Task) -> str: ...
    def optimal_alpha(self, components: int, task: _Task) -> float: ...

@final
class Simplices:
    vertices: _Rows
    edges: _Rows
    facets: _Rows
    cells: _Rows
    intervals: Floats
    ranks: _Rows
    gabriel: NDArray[np.bool_]
    gabriel_simplices: _Rows
    cech_values: Floats
    order: _Rows
    component_pairs: _Rows
    loop_pairs: _Rows
    void_pairs: _Rows
    def lasting(self, dimension: int) -> _Rows: ...
    def loop_cycles(self, edges: _Rows) -> list[tuple[_Rows, Floats, _Rows, NDArray[np.int32]] | None]: ...
    def void_cycles(self, cells: _Rows) -> list[tuple[_Rows, _Rows, Floats] | None]: ...

@final
class Triangulation:
    points: Floats
    weights: Floats
    simplices: Indices
    neighbors: Indices
    convex_hull: Indices
    hidden: Indices
    duplicates: Indices
    def __init__(self, points: Floats, weights: Floats | None, task: _Task) -> None: ...
    def find(self, places: Floats, task: _Task) -> Indices: ...
    def power_diagram(self, task: _Task) -> PowerDiagram: ...

@final
class PowerDiagram:
    vertices: Floats
    same_sphere: Indices
    volumes: Floats
    facets: _Rows
    areas: Floats

def periodic_power_diagram(
    points: Floats, weights: Floats | None, periodic: list[float], walls: list[list[float]] | None, task: _Task
) -> tuple[tuple[Floats, Indices, Indices, Floats], Floats, Floats | None]: ...
def pores(
    points: Floats, radii: Floats, periodic: list[float], probe: float | None, task: _Task
) -> tuple[list[tuple[float, list[float]]], tuple[list[int], int, tuple[float, float]] | None]: ...

@final
class Complex:
    points: Floats
    weights: Floats
    alpha: float
    cells: _Rows
    facets: _Rows
    edges: _Rows
    vertices: _Rows
    hidden: _Rows | None
    duplicates: _Rows | None
    periodic: list[float] | None
    lowest: int
    def __init__(
        self,
        points: Floats,
        weights: Floats | None,
        alpha: float,
        cells: _Listed,
        facets: _Listed,
        edges: _Listed,
        vertices: _Listed,
        hidden: _Rows | None,
        duplicates: _Rows | None,
        periodic: list[float] | None,
        task: _Task,
    ) -> None: ...
    @staticmethod
    def of(shape: Shape) -> Complex: ...
    def classes(self) -> list[Classes]: ...
    def with_lowest(self, lowest: int) -> Complex: ...
    def check(
        self, most: int, ties_too: bool, task: _Task
    ) -> tuple[str, bool, int, int, list[tuple[str, str]], str]: ...

def alpha_shape(
    points: Floats,
    weights: Floats | None,
    values: Floats | None,
    settings: _Settings,
    task: _Task,
) -> Shape: ...
def alpha_shapes(clouds: list[Cloud], settings: _Settings, task: _Task) -> list[Shape]: ...
def filtrations(clouds: list[Cloud], periodic: list[float] | None, task: _Task) -> list[Filtration]: ...
def diagrams(
    clouds: list[Cloud], dimensions: list[int], periodic: list[float] | None, task: _Task
) -> list[list[Floats]]: ...
def restored(
    points: Floats, weights: Floats, values: Floats | None, state: _State
) -> Shape: ...
def compare(a: Complex, b: Complex, task: _Task) -> tuple[bool, str, str]: ...
def read(input: str, options: str, task: _Task) -> tuple[Samples, bool, str]: ...
def columns(names: list[str]) -> list[str | None]: ...
def read_points(
    path: str, reading: dict[str, object]
) -> tuple[Floats, Floats | None, Floats | None, list[int] | None, float | None, list[str]]: ...
class _Molecule(TypedDict):
    positions: Floats
    radii: Floats | None
    elements: list[str]
    names: list[str]
    residues: list[str]
    numbers: list[int | None]
    chains: list[str]
    cell: tuple[list[list[float]], list[bool]] | None
    coordinates: str
    summary: str

def read_molecule(path: str, choice: dict[str, object]) -> _Molecule: ...
def point_columns(path: str, reading: dict[str, object]) -> list[str]: ...
def point_column(path: str, name: str, reading: dict[str, object]) -> Floats: ...
def write_points(
    path: str,
    points: Floats,
    weights: Floats | None,
    values: Floats | None,
    columns: list[tuple[str, Floats]],
    like: str | None,
    alpha: float | None,
    value_error: float,
) -> None: ...
def haar(
    samples: Samples, masked: bool, settings: _Settings, task: _Task
) -> tuple[Samples, str]: ...
def difference(samples: Samples, masked: bool) -> Floats: ...
def select(
    samples: Samples,
    masked: bool,
    smoothed: Samples,
    frame: str | None,
    settings: _Settings,
) -> tuple[Floats, Floats, Floats]: ...
def weigh(differences: Floats, weighting: str, alpha: float) -> Floats: ...
def pipeline(
    samples: Samples,
    is_gray: bool,
    frame: str | None,
    settings: _Settings,
    task: _Task,
) -> Shape: ...
def label_shape(
    samples: Samples,
    frame: str | None,
    labels: list[int] | None,
    task: _Task,
) -> Shape: ...
def persistence_svg(components: Floats, loops: Floats, voids: Floats) -> str: ...
def sweep() -> None: ...
def write_whole(path: str, content: bytes) -> None: ...
def command(arguments: list[str]) -> int: ...
