"""Many clouds from Python against GUDHI: processor time of all threads, and how busy the cores are.

    pip install gudhi numpy scikit-learn   # and walpha's wheel
    python3 benches/many.py                # 200 clouds of 855 random points
    python3 benches/many.py 1000 100       # 1000 of 100

Filtrations, and persistence diagrams of dimensions 0, 1 and 2: `walpha.filtrations` and `walpha.tda.AlphaPersistence` on all cores,
beside GUDHI's alpha complex (precision "fast", which is its quickest) and its persistence over Z/2, cloud by cloud. Medians of three rounds, in which
all take turns. Busy is processor time by wall time by cores.
"""

import os
import statistics
import sys
import time

import gudhi
import numpy as np

import walpha
from walpha.tda import AlphaPersistence


def tree(points):
    return gudhi.AlphaComplex(points=points, precision="fast").create_simplex_tree()


def diagrams(points):
    built = tree(points)
    built.compute_persistence(homology_coeff_field=2, min_persistence=0)
    return [built.persistence_intervals_in_dimension(dimension) for dimension in (0, 1, 2)]


WORK = {
    "filtrations": walpha.filtrations,
    "GUDHI": lambda clouds: [tree(points) for points in clouds],
    "diagrams": AlphaPersistence(n_jobs=-1).fit_transform,
    "GUDHI with persistence": lambda clouds: [diagrams(points) for points in clouds],
}


def seconds(work, clouds):
    begun = time.perf_counter(), time.process_time()
    work(clouds)
    return time.perf_counter() - begun[0], time.process_time() - begun[1]


def main():
    count, points = map(int, sys.argv[1:3] or (200, 855))
    cores = len(os.sched_getaffinity(0))
    clouds = np.random.default_rng(1).random((count, points, 3))
    for work in WORK.values():
        work(clouds[:3])
    rounds = [{name: seconds(work, clouds) for name, work in WORK.items()} for _ in range(3)]
    print(f"{count} clouds of {points} points on {cores} cores", "wall s", "CPU s", "busy", sep="\t")
    for name in WORK:
        wall, processor = (statistics.median(of) for of in zip(*(one[name] for one in rounds)))
        print(name, f"{wall:.3g}", f"{processor:.3g}", f"{processor / wall / cores:.0%}", sep="\t")


if __name__ == "__main__":
    main()
