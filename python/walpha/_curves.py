"""What is measured of many shapes at once."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ._parts import Betti, TorusBetti, Void, betti
from ._pictures import Chart, steps_chart
from ._repr import in_a_line
from ._typing import Floats, Indices


@in_a_line
class BettiCurve(NamedTuple):
    """The topology at every critical value of α.

    Attributes
    ----------
    alpha : ndarray of float64, (m,)
        A double just above each critical value, ascending; row k holds from ``alpha[k]`` on to the
        next. Squared lengths.
    b0, b1, b2 : ndarray of int64, (m,)
        Components, tunnels, voids.
    solid_components : ndarray of int64, (m,)
        Components of the cells, joined through facets; of points that span no volume triangles joined
        through edges, or edges through vertices.
    """

    alpha: Floats
    b0: Indices
    b1: Indices
    b2: Indices
    solid_components: Indices

    def plot(self) -> Chart:
        """Components, tunnels and voids over the radius of the ball, which a notebook shows.

        Returns
        -------
        Chart
            Both axes are logarithmic; the lowest line is 0. What there is at radius 0 is left out.

        Examples
        --------
        >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> walpha.filtration(cube).betti_curve().plot()
        <walpha.Chart of the Betti numbers at 4 values of α>
        """
        return _plotted(self)

    def _repr_html_(self) -> str:
        return self.plot().svg


@in_a_line
class TorusBettiCurve(NamedTuple):
    """The topology of a torus's shapes at every critical value of α.

    Attributes
    ----------
    alpha, b0, b1, b2, solid_components : ndarray, (m,)
        As in :class:`BettiCurve`.
    b3 : ndarray of int64, (m,)
        1 from where on the shape is the whole torus: the last row.
    """

    alpha: Floats
    b0: Indices
    b1: Indices
    b2: Indices
    solid_components: Indices
    b3: Indices

    def plot(self) -> Chart:
        """As :meth:`BettiCurve.plot`.

        Returns
        -------
        Chart
            Of b0, b1 and b2.
        """
        return _plotted(self)

    def _repr_html_(self) -> str:
        return self.plot().svg


def _plotted(curve: BettiCurve | TorusBettiCurve) -> Chart:
    radii = np.sqrt(np.maximum(curve.alpha, 0))
    curves = [("components", radii, curve.b0), ("tunnels", radii, curve.b1), ("voids", radii, curve.b2)]
    what = f"the Betti numbers at {len(radii)} values of α"
    return steps_chart("Components, tunnels and voids", "ball radius √α", curves, what)


class Level(NamedTuple):
    """One α of a ladder, in numbers.

    Attributes
    ----------
    alpha : float
        A squared length.
    cells : int
        Cells of the shape.
    facets, edges, vertices : dict
        How many there are, by the name of their class.
    betti : Betti
        Of a torus TorusBetti.
    solid_components : int
        Components of the cells, joined through facets.
    volume, area, regular_area, singular_area : float
        As those of :class:`AlphaShape`.
    coverage : float
        The share of the volume of the convex hull that the cells fill; 0 of points that span no volume.
    voids : list of Void
        Largest first.
    """

    alpha: float
    cells: int
    facets: dict[str, int]
    edges: dict[str, int]
    vertices: dict[str, int]
    betti: Betti | TorusBetti
    solid_components: int
    volume: float
    area: float
    regular_area: float
    singular_area: float
    coverage: float
    voids: list[Void]

    @classmethod
    def _of(cls, facts: dict[str, Any]) -> Level:
        """From the fields of the library."""
        changed = {
            "alpha": float(facts["alpha"]),
            "betti": betti(facts["betti"]),
            "voids": [Void._of(void) for void in facts["voids"]],
        }
        return cls(**{name: changed.get(name, facts[name]) for name in cls._fields})


class Suggestions(NamedTuple):
    """Values of α to try, squared lengths.

    Attributes
    ----------
    all_points : float
        Every vertex is one of a cell (MATLAB's ``criticalAlpha(shp, 'all-points')``).
    one_region : float
        That, and the cells are one solid component (CGAL's ``find_optimal_alpha(1)``).
    no_void : float
        Like ``one_region``, and there are no voids.
    plateau : tuple of float
        From where to where the Betti numbers stay the same longest, as a ratio of the squared radii
        of the largest balls.
    """

    all_points: float
    one_region: float
    no_void: float
    plateau: tuple[float, float]
