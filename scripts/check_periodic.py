#!/usr/bin/env python3
"""Compares triangulations of a periodic cube with CGAL's Periodic_3_regular_triangulation_3, cell by cell:
`python3 scripts/check_periodic.py [WALPHA] [SETS]`. Needs g++ and CGAL.

Points are random, so that no tie is broken in another way; every second set has weights, from 0 to less than
1/64 of the squared side, as CGAL has it.
"""

import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main():
    walpha = sys.argv[1] if len(sys.argv) > 1 else "walpha"
    sets = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    with tempfile.TemporaryDirectory() as folder:
        cgal = Path(folder) / "periodic_cgal"
        source = HERE / "periodic_cgal.cc"
        subprocess.run(["g++", "-O2", "-frounding-math", source, "-o", cgal, "-lgmp", "-lmpfr"], check=True)
        equal = [one(walpha, cgal, Path(folder), seed) for seed in range(sets)]
    print(f"{equal.count(True)} of {sets} sets equal, {equal.count(None)} need several copies in one or both")
    return 1 if False in equal else 0


def one(walpha, cgal, folder, seed):
    """Whether both make the same cells; None if one of them has none."""
    rng = random.Random(seed)
    side = 8.0
    # Places that stay as they are in the box.
    place = lambda: rng.randrange(1 << 40) / (1 << 40) * side
    points = [[place(), place(), place()] for _ in range(rng.choice([300, 600, 1500]))]
    weights = [rng.random() * side * side / 64.5 if seed % 2 else 0.0 for _ in points]
    table = folder / "points.csv"
    rows = "".join(f"{x!r},{y!r},{z!r},{w!r}\n" for (x, y, z), w in zip(points, weights))
    table.write_text("x,y,z,weight\n" + rows)
    given = f"{side}\n" + rows.replace(",", " ")
    theirs = subprocess.run([cgal], input=given, capture_output=True, text=True, check=True).stdout
    made = subprocess.run(
        [walpha, "filtration", table, "--periodic", f"{side},{side},{side}", "--weights", "column", "-o", folder / "f.json"],
        capture_output=True, text=True,
    )
    if made.returncode or not theirs:
        print(f"set {seed}: {'refused: ' + made.stderr.splitlines()[1].strip() if made.returncode else 'no single cover of CGAL'}")
        return None
    theirs = sorted(tuple(map(int, line.split())) for line in theirs.splitlines())
    ours = sorted(map(tuple, json.loads((folder / "f.json").read_text())["cells"]))
    print(f"set {seed}: {len(points)} points, {len(ours)} cells, {'equal' if ours == theirs else 'DIFFERENT'}")
    return ours == theirs


if __name__ == "__main__":
    sys.exit(main())
