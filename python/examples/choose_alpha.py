"""Choose α from a Betti curve: where the topology stays the same longest."""

import numpy as np

import walpha

# A noisy torus: one component, two tunnels, one void.
rng = np.random.default_rng(0)
u, v = rng.uniform(0, 2 * np.pi, (2, 4000))
torus = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=1)
torus += rng.normal(0, 0.01, torus.shape)

filtration = walpha.filtration(torus)
curve = filtration.betti_curve()
wanted = (curve.b0 == 1) & (curve.b1 == 2) & (curve.b2 == 1)
low, high = curve.alpha[wanted][[0, -1]]
print(f"a torus from α = {low:.4g} to {high:.4g}, √α = {low**0.5:.3g} to {high**0.5:.3g}")

suggested = filtration.suggestions()
print(f"all points in one solid from α = {suggested.one_region:.4g} on")
print(f"the topology stays longest from α = {suggested.plateau[0]:.4g} to {suggested.plateau[1]:.4g}")

shape = filtration.shape((low * high) ** 0.5)
print(f"between: {tuple(shape.betti)}, area {shape.regular_area + 2 * shape.singular_area:.4g}")
assert shape.betti == (1, 2, 1)
