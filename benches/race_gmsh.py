#!/usr/bin/env python3
"""Times Gmsh's Delaunay triangulation (HXT, arXiv:1805.08831) of the points in a file: race_gmsh.py POINTS THREADS

For benches/race; needs the package `gmsh` from PyPI. Prints seconds, peak KiB, and no counts: HXT breaks ties
otherwise, so its cells are not ours.
"""

import resource
import sys
import time

import gmsh
import numpy

points = numpy.fromfile(sys.argv[1]).reshape(-1, 4)[:, :3]
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.option.setNumber("General.NumThreads", int(sys.argv[2]))
gmsh.option.setNumber("Mesh.Algorithm3D", 10)
flat = points.ravel()
start = time.perf_counter()
made = gmsh.algorithm.tetrahedralize(flat)
seconds = time.perf_counter() - start
# Newer versions give added points, too, of which there are none here.
cells = made[0] if isinstance(made, tuple) else made
assert len(cells) >= 4 * len(points), (type(made), len(cells), len(points))
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(f"{seconds:.4f} {peak}")
