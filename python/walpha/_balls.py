from __future__ import annotations

import functools
import math
import operator
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _arrays, _walpha
from ._repr import in_a_line
from ._typing import Arrays, Floats, Indices

if TYPE_CHECKING:
    from ._shape import AlphaShape


class Bounded(NamedTuple):
    """A number with a bound on its error.

    Attributes
    ----------
    value : float
        A double near the true number.
    bound : float
        How far the true number, that of the doubles given, may be from it.
    """

    value: float
    bound: float


@in_a_line
class BoundedArray(NamedTuple):
    """Numbers with bounds on their errors.

    Attributes
    ----------
    values : ndarray of float64, (n,)
    bounds : ndarray of float64, (n,)
        How far each true number may be from its value.
    """

    values: Floats
    bounds: Floats


@in_a_line
class Contacts(NamedTuple):
    """The contacts of balls: the disc of two that meet, as far as it is in the power cells of both.

    Attributes
    ----------
    pairs : ndarray of int64, (k, 2)
        Input indices of the two balls.
    areas : BoundedArray, (k,)
        In squared units of the points.
    """

    pairs: Indices
    areas: BoundedArray


@in_a_line
class Cavity(NamedTuple):
    """A void or a pocket of a union of balls.

    Attributes
    ----------
    volume, area : Bounded
        What the balls leave of its cells, and the area of the balls in them.
    cells : int
        Exterior cells that it consists of.
    lining : ndarray of int64, (k,)
        The balls that border it, ascending.
    filling_alpha : float
        The α that fills it.
    mouths : list of list of tuple
        Of a pocket: the facets through which it is open, grouped into mouths. Empty for a void.
    closing_alpha : float
        Of a pocket: the α from which on it is a void. NaN for a void.
    """

    volume: Bounded
    area: Bounded
    cells: int
    lining: Indices
    filling_alpha: float
    mouths: list[list[tuple[int, int, int]]]
    closing_alpha: float

    @classmethod
    def _of(
        cls, parts: _walpha.Hollow, mouths: list[list[list[int]]] | None = None, closing: float = math.nan
    ) -> Cavity:
        volume, area, cells, lining, filling = parts
        facets = [[(a, b, c) for a, b, c in mouth] for mouth in mouths or []]
        return cls(Bounded(*volume), Bounded(*area), cells, _arrays.int64(lining), filling, facets, closing)


@in_a_line
class Gradients(NamedTuple):
    """The derivatives of the volume and the area of a union of balls.

    Attributes
    ----------
    volume_by_centers, area_by_centers : ndarray of float64, (n, 3)
    volume_by_radii, area_by_radii : ndarray of float64, (n,)
    """

    volume_by_centers: Floats
    volume_by_radii: Floats
    area_by_centers: Floats
    area_by_radii: Floats


@in_a_line
class BallSurface(NamedTuple):
    """The boundary of a union of balls as a closed mesh of triangles.

    Attributes
    ----------
    vertices : ndarray of float64, (k, 3)
        Each on the spheres of the balls that it belongs to.
    triangles : ndarray of int64, (t, 3)
        Counter-clockwise seen from outside.
    balls : ndarray of int64, (t,)
        The ball of each triangle.
    """

    vertices: Floats
    triangles: Indices
    balls: Indices


class Balls:
    """The union of the balls of a shape, measured; made by :attr:`AlphaShape.balls`.

    A point of weight ω is a ball of squared radius α + ω. The shape is the dual complex of their union, and exact; each
    number here has a bound on its error.

    References
    ----------
    H. Edelsbrunner, The union of balls and its dual shape, Discrete & Computational Geometry 13 (1995),
    doi:10.1007/BF02574053.

    Examples
    --------
    >>> radii = np.array([1.0, 1.0])
    >>> balls = walpha.alpha_shape([[0, 0, 0], [1, 0, 0]], alpha=0, weights=radii**2).balls
    >>> round(balls.volume.value, 10) == round(2.25 * np.pi, 10)
    True
    >>> balls.contacts.pairs
    array([[0, 1]])
    """

    def __init__(self) -> None:
        raise TypeError("Balls are made by AlphaShape.balls")

    #: The shape whose balls they are.
    _owner: AlphaShape
    _union: _walpha.Union
    _parts: _walpha.UnionParts

    @classmethod
    def _of(cls, owner: AlphaShape) -> Balls:
        made = cls.__new__(cls)
        made._owner, made._union = owner, owner._shape.union()
        made._parts = made._union.parts()
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return operator.attrgetter("balls"), (self._owner,)

    @property
    def volume(self) -> Bounded:
        """Bounded: the volume of the union, in cubed units of the points; of a torus, in one box."""
        return Bounded(*self._parts[0][0])

    @property
    def area(self) -> Bounded:
        """Bounded: the area of its boundary, that of voids included."""
        return Bounded(*self._parts[0][1])

    @property
    def mean_curvature(self) -> Bounded:
        """Bounded: the integrated mean curvature of the boundary: 4πr of one ball; arcs where balls meet are negative."""
        return Bounded(*self._parts[0][2])

    @property
    def gaussian_curvature(self) -> Bounded:
        """Bounded: the integrated Gaussian curvature of the boundary: 4π times :attr:`euler_characteristic`."""
        return Bounded(*self._parts[0][3])

    @property
    def euler_characteristic(self) -> int:
        """int: that of the union, exact."""
        return self._parts[1]

    @property
    def box_fraction(self) -> Bounded | None:
        """Bounded or None: the share of the periodic box that is filled."""
        share = self._parts[2]
        return None if share is None else Bounded(*share)

    @functools.cached_property
    def volumes(self) -> BoundedArray:
        """BoundedArray, (n,): for each point the volume of the union in its power cell; 0 for hidden points."""
        return BoundedArray(*map(_arrays.frozen, self._parts[3]))

    @functools.cached_property
    def areas(self) -> BoundedArray:
        """BoundedArray, (n,): for each point the area of the boundary on its sphere."""
        return BoundedArray(*map(_arrays.frozen, self._parts[4]))

    @functools.cached_property
    def contacts(self) -> Contacts:
        """Contacts: the pairs of balls that meet, and how much."""
        return Contacts(_arrays.kept(self._parts[5]), BoundedArray(*map(_arrays.frozen, self._parts[6])))

    @functools.cached_property
    def voids(self) -> list[Cavity]:
        """list of Cavity: the voids of the union, largest first.

        Raises
        ------
        ValueError
            The shape does not list its exterior: make it with ``exterior=True``.
        """
        return [Cavity._of(parts) for parts in self._union.voids()]

    @functools.cached_property
    def pockets(self) -> list[Cavity]:
        """list of Cavity: the pockets of the union, largest first, voids among them.

        Raises
        ------
        ValueError
            The shape does not list its exterior, or is one of a torus, which has no outside.

        References
        ----------
        H. Edelsbrunner, M. Facello and J. Liang, On the definition and the construction of pockets in macromolecules,
        Discrete Applied Mathematics 88 (1998), doi:10.1016/S0166-218X(98)00067-5.
        """
        return [Cavity._of(*parts) for parts in self._union.pockets()]

    def gradients(self, weights: Arrays | None = None) -> Gradients:
        """The derivatives of volume and area by centres and radii.

        Parameters
        ----------
        weights : array_like, (n,), optional
            Then those of the sums of the parts of the balls, each with its weight.

        Returns
        -------
        Gradients

        Examples
        --------
        >>> ball = walpha.alpha_shape([[0, 0, 0]], alpha=4).balls
        >>> ball.gradients().area_by_radii / np.pi
        array([16.])
        """
        given = _arrays.optional("weights", weights)
        if given is not None:
            _arrays.finite("weights", given)
        parts = [_arrays.frozen(values) for values, _ in self._union.gradients(given)]
        volume_by_centers, volume_by_radii, area_by_centers, area_by_radii = parts
        return Gradients(
            volume_by_centers.reshape(-1, 3), volume_by_radii, area_by_centers.reshape(-1, 3), area_by_radii
        )

    def surface(self, tolerance: float = 0.01) -> BallSurface:
        """The boundary of the union as a closed mesh; its area and volume tend to those of the union.

        Parameters
        ----------
        tolerance : float, optional
            How far a triangle may be from the sphere of its ball, as a part of the radius, from 10⁻⁶ to 0.5. A sphere has
            about 2.4/tolerance vertices.

        Returns
        -------
        BallSurface

        Raises
        ------
        ValueError
            The tolerance is out of range, the shape is one of a torus, or some patch is too small for its coordinates.

        Examples
        --------
        >>> vertices, triangles, balls = walpha.alpha_shape([[0, 0, 0]], alpha=1).balls.surface(0.1)
        >>> len(vertices), len(triangles)
        (42, 80)
        >>> bool(np.allclose(np.linalg.norm(vertices, axis=1), 1))
        True
        """
        vertices, triangles, balls = self._union.surface(tolerance)
        return BallSurface(_arrays.frozen(vertices), _arrays.int64(triangles), _arrays.int64(balls))

    def __repr__(self) -> str:
        return f"<walpha.Balls: volume {self.volume.value:g}, area {self.area.value:g}, {len(self.contacts.pairs)} contacts>"
