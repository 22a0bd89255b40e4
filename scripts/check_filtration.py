"""Our filtrations against GUDHI's in exact mode, on some hundred small sets.

    pip install gudhi numpy
    python3 scripts/check_filtration.py [target/release/walpha]

In general position: the same simplices with the same values, to the last digits that GUDHI keeps. On
lattices, where triangulations differ by how ties are broken: the same persistence diagrams of all
dimensions, that of our pairs and that which GUDHI computes from our simplices.

In a periodic box, with and without weights, where gudhi-utils of Debian is installed: the persistence
diagrams of its program, which writes six digits. That program lacks cells of some sets with weights;
there, ours must be as many as GUDHI's triangulation of 27 copies has for each period.
"""

import itertools
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import gudhi
import numpy as np

SETS = 520
CLOSE = 1e-12
PERIODIC_SETS = 12
PERIODIC_PROGRAM = "gudhi-alpha-complex-3d-persistence"


def families(random):
    """Points, weights, and whether they are in general position."""
    count = int(random.integers(5, 60))
    yield random.random((count, 3)), np.zeros(count), True
    yield random.random((count, 3)), random.random(count) / 8, True
    grid = random.integers(0, 4, (count, 3)).astype(float)
    grid = np.unique(grid, axis=0)
    yield grid, np.zeros(len(grid)), False
    yield grid / 2, random.integers(0, 3, len(grid)) / 4, False


def ours(walpha, folder, points, weights):
    table = np.column_stack([points, weights])
    np.savetxt(folder / "set.csv", table, delimiter=",", header="x,y,z,weight", comments="", fmt="%.17g")
    command = [walpha, "filtration", "set.csv", "--weights", "column", "-q", "-o", "set.npz"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr)
    return dict(np.load(folder / "set.npz"))


def simplices(file):
    """Each simplex with its value, by number."""
    rows = [file["vertices"][:, None], file["edges"], file["facets"], file["cells"]]
    names = ["vertex", "edge", "facet", "cell"]
    return [
        (tuple(map(int, row)), float(value))
        for name, of_dimension in zip(names, rows)
        for row, value in zip(of_dimension, file[name + "_values"])
    ]


def tree_of(listed, order):
    tree = gudhi.SimplexTree()
    for number in order:
        tree.insert(listed[number][0], filtration=listed[number][1])
    return tree


def diagrams(tree):
    tree.compute_persistence(homology_coeff_field=2)
    return [tree.persistence_intervals_in_dimension(dimension) for dimension in range(3)]


def same_diagram(a, b):
    """Whether two diagrams are alike but for intervals of no length worth the name."""
    def lasting(intervals):
        rows = [(x, y) for x, y in intervals if not y - x <= CLOSE * max(1, abs(x))]
        return np.array(sorted(rows)).reshape(-1, 2)

    a, b = lasting(a), lasting(b)
    return a.shape == b.shape and np.allclose(a, b, rtol=CLOSE, atol=CLOSE)


def our_pairs(file, listed):
    value = [simplex[1] for simplex in listed]
    of = lambda pairs: [(value[x], value[y]) for x, y in file[pairs]]
    lasting = [(value[x], np.inf) for x in file["lasting_components"]]
    return of("component_pairs") + lasting, of("loop_pairs"), of("void_pairs")


def check(file, points, weights, general):
    listed = simplices(file)
    alpha = gudhi.AlphaComplex(points=points, weights=weights, precision="exact")
    theirs = alpha.create_simplex_tree()
    if general:
        expected = {tuple(sorted(row)): value for row, value in theirs.get_filtration()}
        got = dict(listed)
        if expected.keys() != got.keys():
            return "other simplices"
        off = max(abs(got[row] - value) / max(1, abs(value)) for row, value in expected.items())
        if off > CLOSE:
            return f"values off by {off}"
    expected, got = diagrams(theirs), diagrams(tree_of(listed, file["order"]))
    for dimension in range(3):
        if not same_diagram(expected[dimension], got[dimension]):
            return f"another diagram of dimension {dimension}"
    for dimension, pairs in enumerate(our_pairs(file, listed)):
        if not same_diagram(expected[dimension], pairs):
            return f"other pairs of dimension {dimension}"
    return None


def cells_in_copies(points, weights):
    """The cells that each period of the box has, by 27 copies of it in space."""
    moves = sorted(itertools.product((-1.0, 0.0, 1.0), repeat=3), key=any)
    copies = np.concatenate([points + move for move in moves])
    alpha = gudhi.AlphaComplex(points=copies, weights=np.tile(weights, 27), precision="safe")
    tree = alpha.create_simplex_tree()
    cells = (row for row, _ in tree.get_filtration() if len(row) == 4)
    # Each corner in the box itself, which comes first, is a quarter of a cell.
    return sum(v < len(points) for row in cells for v in row) / 4


def check_periodic(walpha, folder, points, weights):
    """What is wrong, and whether it is GUDHI's program that lacks cells."""
    table = np.column_stack([points, weights])
    np.savetxt(folder / "set.csv", table, delimiter=",", header="x,y,z,weight", comments="", fmt="%.17g")
    np.savetxt(folder / "weights.txt", weights, fmt="%.17g")
    (folder / "box.txt").write_text("0 0 0 1 1 1\n")
    rows = "".join("%.17g %.17g %.17g\n" % tuple(row) for row in points)
    (folder / "set.off").write_text(f"OFF\n{len(points)} 0 0\n{rows}")
    for command in [
        [walpha, "filtration", "set.csv", "--weights", "column", "--periodic", "1,1,1", "-q", "-o", "pairs.csv", "set.npz"],
        [PERIODIC_PROGRAM, "-c", "box.txt", "-w", "weights.txt", "-m", "0", "-p", "3", "-o", "theirs.txt", "set.off"],
    ]:
        subprocess.run(command, cwd=folder, capture_output=True, check=True)
    ours = np.genfromtxt(folder / "pairs.csv", delimiter=",", skip_header=1, usecols=(0, 1, 2))
    theirs = np.genfromtxt(folder / "theirs.txt", usecols=(1, 2, 3))
    diagram = lambda rows, dimension: rows[rows[:, 0] == dimension, 1:]
    distance = max(gudhi.bottleneck_distance(diagram(theirs, d), diagram(ours, d)) for d in range(3))
    if distance < 1e-6:
        return None, False
    cells, expected = len(np.load(folder / "set.npz")["cells"]), cells_in_copies(points, weights)
    return (None if cells == expected else f"{cells} cells in a periodic box, not {expected}"), True


def periodic_sets(walpha, folder, random):
    """The number of wrong sets."""
    if shutil.which(PERIODIC_PROGRAM) is None:
        print(f"skipped: periodic boxes, as there is no {PERIODIC_PROGRAM}")
        return 0
    failed = lacking = 0
    for number in range(PERIODIC_SETS):
        points = random.random((250, 3))
        weights = random.random(250) / 256 * (number % 2)
        wrong, lacks = check_periodic(walpha, folder, points, weights)
        failed += wrong is not None
        lacking += lacks
        if wrong:
            print("wrong:", wrong)
    print(f"{PERIODIC_SETS} sets in periodic boxes, {failed} wrong; GUDHI's program lacks cells of {lacking}")
    # Without weights it lacks none, so that most are compared.
    return failed + (lacking > PERIODIC_SETS // 2)


def main():
    walpha = str(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "target/release/walpha").resolve())
    random = np.random.default_rng(17)
    done = failed = 0
    with tempfile.TemporaryDirectory() as name:
        while done < SETS:
            for points, weights, general in families(random):
                if np.linalg.matrix_rank(points - points[0]) < 3:
                    continue
                wrong = check(ours(walpha, pathlib.Path(name), points, weights), points, weights, general)
                done += 1
                if wrong:
                    failed += 1
                    print("wrong:", wrong, json.dumps([points.tolist(), weights.tolist()]))
        print(f"{done} sets, {failed} wrong")
        failed += periodic_sets(walpha, pathlib.Path(name), random)
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
