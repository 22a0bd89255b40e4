"""Moves points until their loops last: a persistence diagram that gradients of PyTorch pass through.

    pip install torch
    python optimise_persistence.py
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import torch

import walpha


def persistence(points: torch.Tensor, dimension: Literal[0, 1, 2]) -> torch.Tensor:
    """Births and deaths as rows, without what never ends, with gradients by the points.

    A value is the squared radius of a Gabriel simplex, so it has this simplex's derivatives. To first order the value is itself
    plus these times how far the points have moved, which is not at all.
    """
    filtration = walpha.filtration(points.detach())
    simplices = filtration.simplices()
    pairs = (simplices.component_pairs, simplices.loop_pairs, simplices.void_pairs)[dimension]
    pairs = pairs[simplices.ranks[pairs[:, 0]] != simplices.ranks[pairs[:, 1]]]
    numbers = pairs.ravel()
    values = torch.tensor(simplices.values[numbers], dtype=points.dtype)
    gabriel = simplices.gabriel_simplices[numbers]
    moved = points - points.detach()
    tables = (simplices.vertices[:, None], simplices.edges, simplices.facets, simplices.cells)
    first = 0
    for table in tables:
        here = np.flatnonzero((first <= gabriel) & (gabriel < first + len(table)))
        rows = table[gabriel[here] - first]
        derivatives = torch.tensor(filtration.derivatives(rows)[0], dtype=points.dtype)[..., : points.shape[1]]
        change = (derivatives * moved[torch.tensor(rows)]).sum(dim=(1, 2))
        values = values.index_add(0, torch.tensor(here), change)
        first += len(table)
    return values.reshape(-1, 2)


def optimise(points: torch.Tensor, steps: int) -> tuple[torch.Tensor, list[float]]:
    """Points in the unit square whose longest loop lasts as long as it can, and how long it lasted at each step."""
    moving = points.clone().requires_grad_()
    optimiser = torch.optim.Adam([moving], lr=0.01)
    lasted = []
    for _ in range(steps):
        optimiser.zero_grad()
        diagram = persistence(moving, 1)
        # Radii are lengths, as the square's sides are.
        lifetimes = diagram[:, 1].sqrt() - diagram[:, 0].sqrt()
        outside = (moving - moving.clamp(0, 1)).square().sum()
        loss = outside - lifetimes.max()
        loss.backward()
        optimiser.step()
        lasted.append(float(lifetimes.detach().max()))
    return moving.detach(), lasted


if __name__ == "__main__":
    torch.manual_seed(1)
    _, lasted = optimise(torch.rand(60, 2, dtype=torch.float64), 200)
    print(f"the longest loop lasts {lasted[0]:.3f} at first, and {lasted[-1]:.3f} after {len(lasted)} steps")
