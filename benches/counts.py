#!/usr/bin/env python3
"""What a program does for each point, counted by valgrind, since virtual machines have no counters.

    python3 benches/counts.py target/release/deps/triangulations-… {}   # cargo bench -p walpha-benches --bench triangulations --no-run
    python3 benches/counts.py race_geogram {} 1
    python3 benches/counts.py plain_cgal {} triangulation 1

{} stands for a file of points, as for benches/race. The program runs with 100 000 random points in the unit cube and with 1 000, and the
difference is divided by that of the numbers. Misses are those of a simulated cache of one core: 32 KiB, then 1 MiB.
"""

import os
import subprocess
import sys
import tempfile

import numpy as np

CACHES = ["--cache-sim=yes", "--branch-sim=yes", "--I1=32768,8,64", "--D1=32768,8,64", "--LL=1048576,8,64"]
COUNTED = {
    "instructions": ["Ir"],
    "branches": ["Bc", "Bi"],
    "mispredicted": ["Bcm", "Bim"],
    "misses beyond 32 KiB": ["D1mr", "D1mw"],
    "misses beyond 1 MiB": ["DLmr", "DLmw"],
}


def events(command, folder, count):
    rows = np.zeros((count, 4))
    rows[:, :3] = np.random.default_rng(1).random((count, 3))
    points, counts = os.path.join(folder, "points"), os.path.join(folder, "counts")
    rows.tofile(points)
    valgrind = ["valgrind", "--tool=cachegrind", *CACHES, f"--cachegrind-out-file={counts}"]
    program = [word.replace("{}", points) for word in command]
    one_thread = os.environ | {"RAYON_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(valgrind + program, env=one_thread, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    with open(counts) as lines:
        lines = [line.split() for line in lines if line.startswith(("events:", "summary:"))]
    [names, numbers] = [line[1:] for line in lines]
    return dict(zip(names, map(int, numbers)))


def main():
    command = sys.argv[1:]
    if not any("{}" in word for word in command):
        sys.exit(__doc__)
    sizes = [1000, 100_000]
    with tempfile.TemporaryDirectory() as folder:
        few, many = (events(command, folder, size) for size in sizes)
    for what, names in COUNTED.items():
        more = sum(many[name] - few[name] for name in names)
        print(f"{what}\t{more / (sizes[1] - sizes[0]):.0f}")


if __name__ == "__main__":
    main()
