"""Check what GUDHI and SciPy made: exactly, simplex by simplex, without trusting walpha's engines."""

import gudhi
import numpy as np
import scipy.spatial

import walpha

points = np.random.default_rng(1).random((2000, 3))

# SciPy: a Delaunay triangulation is the alpha shape at α = ∞.
triangulation = scipy.spatial.Delaunay(points)
verdict = walpha.check(points, np.inf, cells=triangulation.simplices)
print("SciPy's Delaunay triangulation is", "right" if verdict else f"wrong: {verdict.findings[0]}")

# On a grid eight points lie on each sphere, and Qhull joins flat cells.
grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3), axis=-1).reshape(-1, 3)
verdict = walpha.check(grid, np.inf, cells=scipy.spatial.Delaunay(grid).simplices)
print(f"on a grid: {verdict.total} findings,", verdict.findings[0] if verdict.findings else "none")

# GUDHI: its filtration values are α, squared lengths, too.
alpha = 0.003
tree = gudhi.AlphaComplex(points=points.tolist(), precision="exact").create_simplex_tree()
theirs = walpha.Complex.from_simplices(points, tree.get_filtration(), alpha=alpha)
print("GUDHI's alpha complex is", "right" if walpha.check(theirs) else "wrong")
print("and", "equal to ours" if walpha.compare(theirs, walpha.alpha_shape(points, alpha=alpha)) else "not ours")
