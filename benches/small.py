"""Small clouds from Python against GUDHI and SciPy: milliseconds of processor time a cloud, of all threads.

    pip install gudhi scipy numpy   # and walpha's wheel
    python3 benches/small.py

For each size, clouds of random points, each done by all in turn: the filtration, the filtration with its simplices and pairs of
dimension 1, and the triangulation; GUDHI's alpha complex (precision "fast", which is its quickest) with its simplex tree, the same with
persistence over Z/2, and SciPy's Delaunay triangulation. Medians over the clouds.
"""

import statistics
import time

import gudhi
import numpy as np
from scipy.spatial import Delaunay

import walpha


def tree(points):
    return gudhi.AlphaComplex(points=points, precision="fast").create_simplex_tree()


def persistence(points):
    built = tree(points)
    built.compute_persistence(homology_coeff_field=2, min_persistence=0)
    return built.persistence_intervals_in_dimension(1)


WORK = {
    "filtration": walpha.filtration,
    "with pairs": lambda points: walpha.filtration(points).simplices().persistence(1),
    "triangulation": walpha.triangulation,
    "GUDHI": tree,
    "with persistence": persistence,
    "SciPy": Delaunay,
}


def milliseconds(work, points, repeats):
    begun = time.process_time()
    for _ in range(repeats):
        work(points)
    return (time.process_time() - begun) * 1000 / repeats


def main():
    random = np.random.default_rng(1)
    print("points", *WORK, sep="\t")
    for count, clouds, repeats in [(20, 21, 50), (100, 21, 20), (1000, 11, 5), (10_000, 5, 1)]:
        times = {name: [] for name in WORK}
        for points in random.random((clouds, count, 3)):
            for name, work in WORK.items():
                times[name].append(milliseconds(work, points, repeats))
        print(count, *(f"{statistics.median(of):.3g}" for of in times.values()), sep="\t")


if __name__ == "__main__":
    main()
