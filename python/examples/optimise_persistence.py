"""Moves points until their loops last: a persistence diagram that gradients of PyTorch pass through.

    pip install torch
    python optimise_persistence.py
"""

from __future__ import annotations

import torch

import walpha.torch


def optimise(points: torch.Tensor, steps: int) -> tuple[torch.Tensor, list[float]]:
    """Points in the unit square whose longest loop lasts as long as it can, and how long it lasted at each step."""
    moving = points.clone().requires_grad_()
    optimiser = torch.optim.Adam([moving], lr=0.01)
    lasted = []
    for _ in range(steps):
        optimiser.zero_grad()
        [loops] = walpha.torch.persistence(moving, [1])
        # Radii are lengths, as the square's sides are.
        lifetimes = loops[:, 1].sqrt() - loops[:, 0].sqrt()
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
