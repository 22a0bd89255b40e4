"""Persistence in all dimensions against GUDHI: medians of five, in turn, in one process.

    pip install gudhi numpy   # and walpha's wheel
    python3 benches/persistence.py [points, 128000 unless given]

GUDHI: the alpha complex (precision "fast", which is its quickest), its simplex tree, and persistence over Z/2. walpha: the filtration, all
simplices in exact order, and all pairs; on all threads, as GUDHI has one.
"""

import statistics
import sys
import time

import gudhi
import numpy as np

import walpha


def theirs(points):
    tree = gudhi.AlphaComplex(points=points, precision="fast").create_simplex_tree()
    tree.compute_persistence(homology_coeff_field=2, min_persistence=0)
    return len(tree.persistence_intervals_in_dimension(1))


def ours(points):
    return len(walpha.filtration(points).simplices().persistence(1))


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 128_000
    random = np.random.default_rng(1)
    lattice = np.unique(random.integers(0, round((3 * count) ** (1 / 3)), (2 * count, 3)), axis=0)[:count].astype(float)
    for name, points in [("random", random.random((count, 3))), ("lattice", lattice)]:
        seconds, loops = {theirs: [], ours: []}, {}
        for _ in range(5):
            for work in seconds:
                begun = time.perf_counter()
                loops[work] = work(points)
                seconds[work].append(time.perf_counter() - begun)
        gudhi_takes, walpha_takes = (statistics.median(times) for times in seconds.values())
        print(f"{name}: {len(points)} points; GUDHI {gudhi_takes:.2f} s, {loops[theirs]} loops;"
              f" walpha {walpha_takes:.2f} s, {loops[ours]} loops; {gudhi_takes / walpha_takes:.1f} times as fast")


if __name__ == "__main__":
    main()
