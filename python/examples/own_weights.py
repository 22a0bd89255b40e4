"""Weights of one's own: atoms as balls, and the void between them that water cannot leave.

A ball of radius r is a point of weight r² at α = 0. A probe of radius p makes every ball larger by p, so the
weights change: there is no α for it.
"""

import numpy as np

import walpha

# A cage of atoms, 1.7 Å in radius, on a sphere of radius 4 Å.
k = np.arange(60) + 0.5
polar, around = np.arccos(1 - 2 * k / 60), np.pi * (1 + 5**0.5) * k
cage = 4 * np.stack([np.cos(around) * np.sin(polar), np.sin(around) * np.sin(polar), np.cos(polar)], axis=1)
radii = np.full(60, 1.7)

for probe in (0.0, 0.5, 1.4, 3.0):
    shape = walpha.alpha_shape(cage, weights=(radii + probe) ** 2, alpha=0, exterior=True)
    voids = [f"{void.volume:.1f} Å³" for void in shape.voids]
    print(f"probe {probe} Å: betti {tuple(shape.betti)}, voids of the dual shape {voids}")
