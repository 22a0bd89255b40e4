# pyright: reportAttributeAccessIssue=false
# Where PyTorch is not installed, none of its names are known.
"""Values of simplices, persistence and balls as differentiable functions of points and weights, for PyTorch.

The value of a simplex is the squared radius of the smallest orthogonal sphere of a Gabriel simplex, its own or the one it comes
with, and has its derivatives (:meth:`walpha.Filtration.derivatives`). All is computed in double precision, on the CPU, whatever
the tensors are, and given back as they are; gradients need float64 tensors to be as precise.

Functions are continuous, and differentiable but where the choice of the simplex changes: where points coincide, where a point
lies on the smallest sphere of a simplex, as cospherical points do, or where two simplices that may give a value have equal ones.
There the gradient is that of one choice, the same on any number of threads. What a diagram has no rows for, as intervals that
last no time, has no gradient. Second derivatives are not there.

Examples
--------
>>> import torch, walpha.torch
>>> points = torch.tensor([[0., 0.], [2., 0.], [2., 2.], [0., 2.1]], dtype=torch.float64, requires_grad=True)
>>> [loops] = walpha.torch.persistence(points, [1])
>>> loops[:, 1].sum().backward()            # the death of the loop: the last triangle
>>> bool(points.grad.abs().sum() > 0)
True
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from ._alpha_shape import alpha_shape
from ._filtration import Filtration, filtration
from ._simplices import Simplices
from ._typing import Arrays, Floats, Indices

try:
    import torch
except ImportError as error:
    raise ImportError(f"walpha.torch needs PyTorch ({error}): pip install torch") from error

__all__ = ["BallParts", "balls", "persistence", "values"]


class BallParts(NamedTuple):
    """The parts of a union of balls; made by :func:`balls`.

    Attributes
    ----------
    volumes : torch.Tensor, (n,)
        For each ball the volume of the union in its power cell; their sum is that of the union.
    areas : torch.Tensor, (n,)
        For each ball the area of the boundary on its sphere.
    """

    volumes: torch.Tensor
    areas: torch.Tensor


def values(
    points: torch.Tensor,
    weights: torch.Tensor | None = None,
    *,
    periodic: Arrays | None = None,
    threads: int | None = None,
) -> tuple[Simplices, torch.Tensor]:
    """Every simplex of a filtration, and its value.

    Parameters
    ----------
    points : torch.Tensor, (n, 3) or (n, 2)
        As in :func:`walpha.filtration`.
    weights : torch.Tensor, (n,), optional
        ω, squared lengths.
    periodic : array_like, (3,) or (3, 3), or float, optional
        As in :func:`walpha.filtration`. There are no derivatives by the box.
    threads : int, optional
        As in :func:`walpha.alpha_shape`.

    Returns
    -------
    Simplices, torch.Tensor (m,)
        The tensor has :attr:`walpha.Simplices.values`, by the numbers of simplices, and gradients by points and weights.

    Examples
    --------
    >>> import torch, walpha.torch
    >>> points = torch.tensor([[0., 0., 0.], [2., 0., 0.]], dtype=torch.float64, requires_grad=True)
    >>> simplices, values = walpha.torch.values(points)
    >>> values[-1].backward()
    >>> simplices.edges, points.grad[:, 0]
    (array([[0, 1]]), tensor([-1.,  1.], dtype=torch.float64))
    """
    made = _filtration(points, weights, periodic, threads)
    simplices = made.simplices(threads=threads)
    return simplices, _Values.apply(points, weights, made, np.arange(len(simplices)))


def persistence(
    points: torch.Tensor,
    dimensions: Sequence[Literal[0, 1, 2]] = (0, 1, 2),
    *,
    weights: torch.Tensor | None = None,
    periodic: Arrays | None = None,
    threads: int | None = None,
) -> list[torch.Tensor]:
    """Persistence diagrams of points.

    Parameters
    ----------
    points : torch.Tensor, (n, 3) or (n, 2)
        As in :func:`walpha.filtration`.
    dimensions : sequence of int
        Of 0 (components), 1 (loops) and 2 (voids).
    weights : torch.Tensor, (n,), optional
        ω, squared lengths.
    periodic, threads
        As in :func:`values`.

    Returns
    -------
    list of torch.Tensor, each (k, 2)
        For each dimension births and deaths, squared lengths, in the rows of :meth:`walpha.Simplices.persistence`. A death that is
        inf is a constant.

    Raises
    ------
    ValueError
        Another dimension; what :func:`walpha.filtration` raises.

    Examples
    --------
    >>> import torch, walpha.torch
    >>> walpha.torch.persistence(torch.tensor([[0., 0.], [2., 0.], [2., 2.], [0., 2.]]), [1])
    [tensor([[1., 2.]])]
    """
    made = _filtration(points, weights, periodic, threads)
    simplices = made.simplices(threads=threads)
    diagrams = []
    for dimension in dimensions:
        pairs, lasting = simplices._lasting_some_time(dimension)
        numbers = np.concatenate([pairs.ravel(), lasting])
        found = _Values.apply(points, weights, made, numbers)
        ended, begun = found[: pairs.size].reshape(-1, 2), found[pairs.size :]
        never = torch.stack([begun, torch.full_like(begun, torch.inf)], dim=1)
        diagrams.append(torch.cat([ended, never]))
    return diagrams


def balls(
    centers: torch.Tensor,
    radii: torch.Tensor,
    *,
    periodic: Arrays | None = None,
    threads: int | None = None,
) -> BallParts:
    """Volumes and areas of a union of balls, by ball.

    Parameters
    ----------
    centers : torch.Tensor, (n, 3)
    radii : torch.Tensor, (n,)
        Lengths, not squared ones.
    periodic, threads
        As in :func:`values`.

    Returns
    -------
    BallParts
        With gradients by centres and radii.

    Raises
    ------
    ValueError
        Negative radii; what :func:`walpha.alpha_shape` raises.

    Examples
    --------
    >>> import torch, walpha.torch
    >>> radii = torch.tensor([2.], dtype=torch.float64, requires_grad=True)
    >>> walpha.torch.balls(torch.zeros(1, 3), radii).volumes.sum().backward()
    >>> bool(torch.isclose(radii.grad[0], 16 * torch.acos(torch.zeros(()).double()) * 2))      # 4πr²
    True
    """
    if bool((radii < 0).any()):
        raise ValueError(f"radii: {float(radii.min())} is negative: give lengths from 0 up")
    return BallParts(*_Balls.apply(centers, radii, periodic, threads))


class _Values(torch.autograd.Function):  # type: ignore[misc]
    """Values of simplices by their numbers."""

    @staticmethod
    def forward(ctx: Any, points: torch.Tensor, weights: torch.Tensor | None, of: Filtration, numbers: Indices) -> torch.Tensor:
        ctx.filtration, ctx.numbers = of, numbers
        ctx.save_for_backward(points, *(() if weights is None else (weights,)))
        return points.new_tensor(of.simplices().values[numbers])

    @staticmethod
    @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
    def backward(ctx: Any, given: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        points, *weights = ctx.saved_tensors
        by_points, by_weights = _chain(ctx.filtration, ctx.numbers, _doubles(given))
        of_points = points.new_tensor(by_points[:, : points.shape[1]]) if ctx.needs_input_grad[0] else None
        of_weights = weights[0].new_tensor(by_weights) if ctx.needs_input_grad[1] else None
        return of_points, of_weights, None, None


def _chain(of: Filtration, numbers: Indices, given: Floats) -> tuple[Floats, Floats]:
    """Derivatives of the sum of values, each with its factor, by positions and weights of all points."""
    simplices = of.simplices()
    own = len(of.points) - len(of.copies)
    # Of which point each row of points is a copy, if it is.
    points = np.concatenate([np.arange(own), of.copies])
    by_points, by_weights = np.zeros((own, 3)), np.zeros(own)
    factors = np.bincount(simplices.gabriel_simplices[numbers], given, len(simplices))
    first = 0
    for table in simplices._tables():
        here = factors[first : first + len(table)]
        first += len(table)
        chosen = np.flatnonzero(here)
        positions, weights = of.derivatives(table[chosen])
        np.add.at(by_points, points[table[chosen]], here[chosen, None, None] * positions)
        np.add.at(by_weights, points[table[chosen]], here[chosen, None] * weights)
    return by_points, by_weights


class _Balls(torch.autograd.Function):  # type: ignore[misc]
    """Volumes and areas of balls."""

    @staticmethod
    def forward(
        ctx: Any, centers: torch.Tensor, radii: torch.Tensor, periodic: Arrays | None, threads: int | None
    ) -> tuple[torch.Tensor, torch.Tensor]:
        squares = _doubles(radii) ** 2
        union = alpha_shape(_doubles(centers), 0.0, weights=squares, periodic=periodic, threads=threads).balls
        ctx.union = union
        ctx.save_for_backward(centers, radii)
        ctx.set_materialize_grads(False)
        return centers.new_tensor(union.volumes.values), centers.new_tensor(union.areas.values)

    @staticmethod
    @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
    def backward(
        ctx: Any, by_volumes: torch.Tensor | None, by_areas: torch.Tensor | None
    ) -> tuple[torch.Tensor | None, ...]:
        centers, radii = ctx.saved_tensors
        of_centers, of_radii = torch.zeros_like(centers), torch.zeros_like(radii)
        if by_volumes is not None:
            found = ctx.union.gradients(_doubles(by_volumes))
            of_centers += centers.new_tensor(found.volume_by_centers)
            of_radii += radii.new_tensor(found.volume_by_radii)
        if by_areas is not None:
            found = ctx.union.gradients(_doubles(by_areas))
            of_centers += centers.new_tensor(found.area_by_centers)
            of_radii += radii.new_tensor(found.area_by_radii)
        return of_centers, of_radii, None, None


def _filtration(points: torch.Tensor, weights: torch.Tensor | None, periodic: Arrays | None, threads: int | None) -> Filtration:
    of_points = None if weights is None else _doubles(weights)
    return filtration(_doubles(points), weights=of_points, periodic=periodic, threads=threads)


def _doubles(tensor: torch.Tensor) -> Floats:
    made: Floats = tensor.detach().to("cpu", torch.float64).numpy()
    return made
