"""What programs make of hard and real sets, judged by `walpha check`: makes docs/verdicts.md.

    pip install numpy scipy pyvista gudhi open3d gmsh diode geogram alphashape     (diode is compiled, with CGAL and Boost)
    apt-get install tetgen libcgal-dev libtbb-dev
    python3 benches/verdicts.py target/release/walpha > docs/verdicts.md

Each program gets the same doubles and its most robust setting that does not move points, in a process of its own with a time limit. What cannot
be imported or found is left out. Cells are handed to `walpha check` as a triangulation (α = ∞) of all points of the set.
"""

import datetime
import importlib
import importlib.metadata
import importlib.util
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

SECONDS = 120
# Of `voxels` under another name, for a box that no other program here has.
LEFT_OUT = {"periodic"}
# These have no cells to be right about.
FLAT = {"oblique-plane", "line"}


def scipy(points, weights):
    from scipy.spatial import Delaunay

    return Delaunay(points).simplices


def vtk(points, weights):
    import pyvista

    # No tolerance: 0 is the least that it takes, points nearer to each other than this share of the size are merged.
    grid = pyvista.PolyData(points.copy()).delaunay_3d(alpha=0.0, tol=0.0)
    return grid.cells_dict.get(pyvista.CellType.TETRA, np.empty((0, 4), int))


def gudhi(precision):
    def run(points, weights):
        import gudhi

        given = {} if weights is None else {"weights": weights}
        complex_ = gudhi.AlphaComplex(points=points, precision=precision, **given)
        # Kept, as iterating does not keep it.
        tree = complex_.create_simplex_tree()
        return [row for row, _ in tree.get_skeleton(3) if len(row) == 4]

    return run


def open3d(points, weights):
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    mesh, numbers = open3d.geometry.TetraMesh.create_from_point_cloud(cloud)
    return np.asarray(numbers)[np.asarray(mesh.tetras)]


def gmsh(points, weights):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    cells, added = gmsh.algorithm.tetrahedralize(points.ravel())
    assert len(added) == 0, "points were added"
    return np.asarray(cells).reshape(-1, 4).astype(int) - 1


def tetgen(points, weights):
    with tempfile.TemporaryDirectory() as name:
        path = pathlib.Path(name) / "set.node"
        rows = [f"{k} " + " ".join(repr(float(x)) for x in row) for k, row in enumerate(points)]
        # 17 digits at most: they read back as the same doubles.
        if weights is not None:
            rows = [f"{row} {float(weight)!r}" for row, weight in zip(rows, weights)]
        path.write_text(f"{len(points)} 3 {int(weights is not None)} 0\n" + "\n".join(rows) + "\n")
        subprocess.run(["tetgen", "-QJNF" + ("w" if weights is not None else ""), str(path)], check=True, stdout=subprocess.DEVNULL)
        lines = (pathlib.Path(name) / "set.1.ele").read_text().splitlines()
        return [list(map(int, line.split()[1:5])) for line in lines[1:] if not line.startswith("#")]


def diode(points, weights):
    import diode

    fill = diode.fill_alpha_shapes if weights is None else diode.fill_weighted_alpha_shapes
    table = points if weights is None else np.column_stack([points, weights])
    return [row for row, _ in fill(table, exact=True) if len(row) == 4]


def alphashape(points, weights):
    import alphashape

    return [row for row, _ in alphashape.alphasimplices(points)]


def compiled(program, *arguments):
    """A program of this folder, which reads x, y, z, ω of each point and writes the corners of each cell."""

    def run(points, weights):
        with tempfile.TemporaryDirectory() as name:
            np.column_stack([points, np.zeros(len(points)) if weights is None else weights]).tofile(f"{name}/set.bin")
            path = pathlib.Path(os.environ["WALPHA_PEERS"]) / program
            subprocess.run([path, "set.bin", *arguments, "cells.bin"], cwd=name, check=True, stdout=subprocess.DEVNULL)
            return np.fromfile(f"{name}/cells.bin", np.uint32).reshape(-1, 4)

    return run


def compile_cgal(program):
    """Compiles CGAL's parallel triangulation, and returns its version."""
    flags = ["-DNDEBUG", "-frounding-math", "-DCGAL_LINKED_WITH_TBB", "-lmpfr", "-lgmp", "-ltbb", "-ltbbmalloc"]
    compile_with("plain_cgal.cc", program, flags)
    asked = subprocess.run(["c++", "-E", "-dM", "-include", "CGAL/version.h", "-x", "c++", "/dev/null"], capture_output=True, text=True, check=True)
    return re.search(r"#define CGAL_VERSION ([\d.]+)", asked.stdout)[1]


def compile_geogram(program):
    """Compiles Geogram's triangulation, of the headers and the static library in its wheel, and returns its version."""
    wheel = pathlib.Path(importlib.util.find_spec("geogram").origin).parents[1]
    libraries = wheel / "geogram.libs"
    flags = ["-fopenmp", "-DGEOGRAM_WITH_PDEL", f"-I{wheel / 'include/geogram1'}", wheel / "lib64/libgeogram.a", *libraries.glob("libtbb-*")]
    compile_with("race_geogram.cc", program, [*flags, f"-Wl,-rpath,{libraries}", "-ldl"])
    said = next((wheel / "lib64/pkgconfig").glob("*.pc")).read_text()
    return re.search(r"Version: (\S+)", said)[1]


def compile_with(source, program, flags):
    source = pathlib.Path(__file__).with_name(source)
    subprocess.run(["c++", "-std=c++17", "-O3", "-pthread", "-o", program, source, *flags], check=True, capture_output=True)


COMPILERS = {"cgal_with_tbb": compile_cgal, "geogram": compile_geogram}


def walpha(engine):
    def run(points, weights):
        with tempfile.TemporaryDirectory() as name:
            table = np.column_stack([points, np.zeros(len(points)) if weights is None else weights])
            np.savetxt(f"{name}/set.csv", table, delimiter=",", header="x,y,z,weight", comments="", fmt="%.17g")
            command = [WALPHA, "shape", "set.csv", "--alpha", "inf", "--engine", engine, "-q", "-o", "set.npz"]
            subprocess.run(command, cwd=name, check=True)
            return np.load(f"{name}/set.npz")["cells"]

    return run


# Name, what runs it, whether it takes weights, what must be there, and where its authors say what it does with such input.
PROGRAMS = {
    "walpha, native": (walpha("native"), True, None, "[ties](ties.md)"),
    "CGAL, by walpha": (walpha("cgal"), True, None, "[manual](https://doc.cgal.org/latest/Triangulation_3/index.html)"),
    "CGAL with TBB": (compiled("cgal_with_tbb", "triangulation", "2"), True, "cgal_with_tbb", "the same"),
    "GUDHI, exact": (gudhi("exact"), True, "gudhi", "[manual](https://gudhi.inria.fr/python/latest/alpha_complex_user.html)"),
    "GUDHI, fast": (gudhi("fast"), True, "gudhi", "the same"),
    "diode, exact": (diode, True, "diode", "[README](https://github.com/mrzv/diode)"),
    "Geogram": (compiled("geogram", "1"), True, "geogram", "[RegularWeightedDelaunay3d](https://github.com/BrunoLevy/geogram/wiki/Delaunay3D)"),
    "TetGen -J": (tetgen, True, "tetgen", "[manual](https://wias-berlin.de/software/tetgen/)"),
    "SciPy (Qhull)": (scipy, False, "scipy", "[imprecision in Qhull](http://www.qhull.org/html/qh-impre.htm)"),
    "alphashape (Qhull)": (alphashape, False, "alphashape", "as SciPy"),
    "VTK": (vtk, False, "vtk", "[vtkDelaunay3D](https://vtk.org/doc/nightly/html/classvtkDelaunay3D.html)"),
    "Open3D (Qhull)": (open3d, False, "open3d", "as Qhull"),
    "Gmsh": (gmsh, False, "gmsh", "[manual](https://gmsh.info/doc/texinfo/gmsh.html)"),
}


def child(program, source, target):
    file = np.load(source)
    weights = file["weights"] if "weights" in file else None
    cells = PROGRAMS[program][0](file["points"], weights)
    np.save(target, np.asarray(cells, dtype=np.int64).reshape(-1, 4))


def version(needed):
    if needed is None:
        run = subprocess.run([WALPHA, "--version"], capture_output=True, text=True, check=True)
        return run.stdout.split()[1]
    if needed == "tetgen":
        if shutil.which("tetgen") is None:
            return None
        # It says its version in its help, which some builds end by aborting.
        said = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "tetgen"], capture_output=True, text=True)
        return said.stdout or "unknown"
    try:
        if needed in COMPILERS:
            return COMPILERS[needed](pathlib.Path(os.environ["WALPHA_PEERS"]) / needed)
        module = importlib.import_module(needed)
        distribution = importlib.metadata.packages_distributions().get(needed, [needed])[0]
        return getattr(module, "__version__", None) or importlib.metadata.version(distribution)
    except (ImportError, AttributeError, OSError, StopIteration, TypeError, subprocess.CalledProcessError) as error:
        print(f"{needed} is left out: {error}", file=sys.stderr)
        return None


def verdict(folder, points, weights, cells):
    """What `walpha check` says of cells, in a word or two."""
    if len(cells) == 0:
        return "no cells"
    file = {"points": points.tolist(), "alpha": "inf", "cells": cells.tolist()}
    if weights is not None:
        file["weights"] = weights.tolist()
    (folder / "judged.json").write_text(json.dumps(file))
    run = subprocess.run([WALPHA, "check", "judged.json", "--json"], cwd=folder, capture_output=True, text=True)
    if run.returncode not in (0, 3):
        return "not judged"
    facts = json.loads(run.stdout)
    if facts["verdict"] != "wrong":
        return f"**{facts['verdict']}**"
    rules = facts.get("findings_by_rule") or {}
    if isinstance(rules, dict):
        rules = list(rules.items())
    worst = ", ".join(f"{count} {rule.replace('_', ' ')}" for rule, count in rules[:2])
    return f"wrong: {worst or facts['findings_total']}"


def cell(folder, program, points, weights):
    (folder / "cells.npy").unlink(missing_ok=True)
    command = [sys.executable, __file__, WALPHA, "--child", program, folder / "set.npz", folder / "cells.npy"]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return f"more than {SECONDS} s"
    if run.returncode < 0 or "died with" in run.stderr:
        return "crash"
    if run.returncode or not (folder / "cells.npy").exists():
        return "error"
    return verdict(folder, points, weights, np.load(folder / "cells.npy"))


def main():
    with tempfile.TemporaryDirectory() as name:
        os.environ["WALPHA_PEERS"] = name
        judge()


def judge():
    versions = {name: version(program[2]) for name, program in PROGRAMS.items()}
    programs = [name for name in PROGRAMS if versions[name] is not None]
    help_ = subprocess.run([WALPHA, "points", "hard:"], capture_output=True, text=True).stderr
    sets = [name.strip() for name in help_.split("hard:")[2:]]
    sets = [name.split(",")[0].split()[0] for name in sets]
    print("# What programs make of hard inputs\n")
    print(f"Made by `benches/verdicts.py` on {datetime.date.today()}, {platform.system()} on {platform.machine()}, one run. Each program triangulates")
    print("the [hard sets](cross-checking.md#hard-inputs), with the same doubles and, of its settings, the most robust one that does not move points;")
    print("`walpha check` judges the cells as a triangulation of all points, exactly. *Exact* means that ties are broken by [the rule](ties.md), which other programs")
    print("need not follow; *valid* is equally correct. Programs without weights are not given sets with weights. Programs for meshes of bodies, as Gmsh and Open3D, may not promise what is asked here.\n")
    table(programs, {name: [f"hard:{name}"] for name in sets if name not in LEFT_OUT})
    print("`oblique-plane` and `line` span no volume: *no cells* and an error are both right there, and they are left out.\n")
    print("What is wrong is counted by rule, as `walpha check` prints it: *orientation* is a flat cell, *hull bends* a hull that is not convex, *not regular* a point inside a cell's sphere.\n")
    if "Geogram" in programs:
        print("Geogram gets weights as it takes them, as a fourth coordinate √(max ω − ω), which is rounded.\n")
    print("## Real sets\n")
    print("The same programs and rules. Points of volumes are those that `walpha points` keeps, by voxel or in the units of the file:\n")
    real = real_sets()
    for name in real:
        print(f"- `{name}`: {REAL[name]}")
    print()
    table(programs, real)
    print("| program | version | what its authors say of such input |\n|---|---|---|")
    for program in programs:
        print(f"| {program} | {versions[program]} | {PROGRAMS[program][3]} |")


REAL = {
    "head": "5000 points of a CT of a head at 64³, the skull of CGAL's demos, with min-max weights",
    "head-unweighted": "the same points without weights",
    "frog": "5000 points of the segmented tissues of a frog, 1 × 1 × 1.5, from PyVista",
    "channels": "5000 points of the pores of a material, from PyVista",
    "airplane": "1335 vertices of a model, single precision, from PyVista",
    "ant": "486 vertices of a model, single precision, from PyVista",
}


def real_sets():
    """What `walpha points` makes each real set of, if it is there."""
    spec = importlib.util.find_spec("pyvista")
    examples = pathlib.Path(spec.origin).with_name("examples") if spec else pathlib.Path("missing")
    skull = subprocess.run([WALPHA, "info", "sample:skull"], capture_output=True).returncode == 0
    volume = ["--count", "5000"]
    sets = {
        "head": skull and ["sample:skull", *volume, "--weights", "min-max"],
        "head-unweighted": skull and ["sample:skull", *volume],
        "frog": [examples / "frog_tissues.vti", *volume],
        "channels": [examples / "channels.vti", *volume],
        "airplane": [examples / "airplane.ply"],
        "ant": [examples / "ant.ply"],
    }
    return {name: where for name, where in sets.items() if where and (isinstance(where[0], str) or where[0].exists())}


def table(programs, sets):
    """Prints the verdict on what each program makes of each set, which `walpha points` makes with these arguments."""
    verdicts = {program: {} for program in programs}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for one, arguments in sets.items():
            subprocess.run([WALPHA, "points", *arguments, "-q", "-o", "set.npy"], cwd=folder, check=True)
            rows = np.load(folder / "set.npy")
            points = np.column_stack([rows[axis] for axis in "xyz"])
            weights = np.ascontiguousarray(rows["weight"]) if rows["weight"].any() else None
            np.savez(folder / "set.npz", points=points, **({} if weights is None else {"weights": weights}))
            for program in programs:
                # Without a word: the program has no weights.
                if weights is None or PROGRAMS[program][1]:
                    verdicts[program][one] = cell(folder, program, points, weights)
    print(arranged(verdicts))


def arranged(verdicts):
    """A table with a line for each program, and the sets by what it makes of them; verdicts by program and set."""
    lines = ["| program | right | exact | valid | wrong, with what is wrong, or failed |", "|---|--:|---|---|---|"]
    for program, found in verdicts.items():
        of = lambda word: [one for one, verdict in found.items() if verdict == f"**{word}**"]
        exact, valid = of("exact"), of("valid")
        tried = [one for one in found if one not in FLAT]
        # The volume does not sum up as a consequence of cells that are flat.
        text = lambda one: found[one].removeprefix("wrong: ").removesuffix(", 1 volume")
        wrong = [f"`{one}`: {text(one)}" for one in tried if one not in exact + valid]
        quoted = lambda sets: ", ".join(f"`{one}`" for one in sets)

        def names(sets):
            rest = [one for one in tried if one not in sets]
            if len(rest) == 0:
                return f"all {len(sets)}"
            return f"all but {quoted(rest)}" if len(rest) == 1 else quoted(sets)

        cells = [f"{len(exact) + len(valid)} of {len(tried)}", names(exact), names(valid), "; ".join(wrong)]
        lines.append(f"| {program} | " + " | ".join(cell or "–" for cell in cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    WALPHA = str(pathlib.Path(sys.argv[1]).resolve())
    if sys.argv[2:3] == ["--child"]:
        child(*sys.argv[3:6])
    else:
        main()
