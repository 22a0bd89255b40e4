#!/usr/bin/env python3
"""Has trimesh, admesh and PrusaSlicer judge what `--solid` writes: programs that take equal coordinates for one vertex.

    scripts/check_solids.py [--walpha target/release/walpha] [--env /tmp/walpha-solids] [--shapes 300] [VOLUME...]

Makes a Python environment (once) with trimesh, and solids of scattered points, of lattices, of samples and of VOLUMES as STL, PLY, OBJ and 3MF.
For trimesh each is watertight, winds one way and bounds a volume, which is that of the shape. For admesh, if it is installed (Debian's package
admesh), an STL has no facet to turn, no backwards and no disconnected edge. For PrusaSlicer, if it is installed (Debian's package prusa-slicer), STL,
OBJ and 3MF of samples and VOLUMES are manifold. Prints a line for what is wrong, and a summary; exits with 1 when anything is, and with 77 when the
packages cannot be had.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from environment import enter

PACKAGES = ["numpy", "scipy", "trimesh", "networkx", "lxml"]
# Seconds for the installation of all of them.
PATIENCE = 300
FORMATS = ["stl", "ply", "obj", "3mf"]
# What moving vertices may change of the volume.
CLOSE = 2e-3
# What admesh counts of a mesh that is fine, in the words of its report.
NOTHING = ["Facets reversed", "Backwards edges", "Total disconnected facets"]
# The formats that PrusaSlicer reads; each run takes it a second.
SLICED = [".stl", ".obj", ".3mf"]
SAMPLES = [["sample:ct"], ["sample:phantom@64"], ["sample:ct", "--surface", "250"]]


def sources(folder, shapes, volumes):
    """Inputs with their options, and whether they are sliced: points at random, points of lattices, samples, and volumes."""
    random = np.random.default_rng(1)
    for i in range(shapes):
        if i % 2:
            side = int(random.integers(4, 10))
            points = np.argwhere(random.random((side, side, side)) < random.uniform(0.3, 0.95))
            alpha = random.choice([0.75, 0.8, 1.0, 1.5])
        else:
            points = random.random((int(random.integers(60, 400)), 3))
            alpha = random.uniform(0.3, 0.9) / len(points) ** (2 / 3)
        file = folder / f"{i}.csv"
        np.savetxt(file, points, delimiter=",", fmt="%.17g", header="x,y,z", comments="")
        yield f"{'lattice' if i % 2 else 'random'} {i}", [file, "--alpha", alpha], False
    for source in [*SAMPLES, *([volume] for volume in volumes)]:
        yield " ".join(source), source, True


def complaints(file, volume, sliced):
    """What trimesh, admesh of an STL, and PrusaSlicer, if the file is sliced, find wrong with it."""
    mesh = trimesh.load_mesh(file)
    for what in ["is_watertight", "is_winding_consistent", "is_volume"]:
        if not getattr(mesh, what):
            yield f"trimesh: not {what}"
    if not np.isclose(mesh.volume, volume, rtol=CLOSE):
        yield f"trimesh: volume {mesh.volume}, not {volume}"
    if file.suffix == ".stl" and shutil.which("admesh"):
        report = subprocess.run(["admesh", file], capture_output=True, text=True, check=True).stdout
        for name in NOTHING:
            count = int(re.search(rf"{name}\s*:\s*(\d+)", report)[1])
            if count:
                yield f"admesh: {name} {count}"
    if sliced and file.suffix in SLICED and shutil.which("prusa-slicer"):
        report = subprocess.run(["prusa-slicer", "--info", file], capture_output=True, text=True, check=True).stdout
        if "manifold = yes" not in report:
            yield f"PrusaSlicer: {' '.join(report.split())}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--walpha", default="target/release/walpha")
    parser.add_argument("--env", default="/tmp/walpha-solids")
    parser.add_argument("--shapes", type=int, default=300)
    parser.add_argument("volumes", nargs="*", metavar="VOLUME")
    options = parser.parse_args([word for word in sys.argv[1:] if word != "--inside"])
    walpha = str(pathlib.Path(options.walpha).resolve())
    if "--inside" not in sys.argv:
        enter(options.env, PACKAGES, PATIENCE)
    done = wrong = pinched = moved = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        files = [folder / f"solid.{extension}" for extension in FORMATS]
        for name, source, sliced in sources(folder, options.shapes, options.volumes):
            command = [walpha, "shape", *source, "--solid", "--json", "-o", *files]
            run = subprocess.run(list(map(str, command)), capture_output=True, text=True)
            if "no regular facet" in run.stderr:
                continue
            if run.returncode:
                print(f"WRONG {name}: {run.stderr.strip()}")
                wrong += 1
                continue
            report = json.loads(run.stdout)
            cuts, volume = report["solid"], report["shape"]["volume"]
            found = [f"{file.suffix}: {text}" for file in files for text in complaints(file, volume, sliced)]
            if cuts["together"]:
                found.append(f"{cuts['together']} vertices are together")
            done += 1
            pinched += cuts["moved"] > 0
            moved += cuts["moved"]
            wrong += bool(found)
            for text in found:
                print(f"WRONG {name} ({cuts}): {text}")
    judges = ", ".join(f"{judge}{'' if shutil.which(judge) else ' (not installed)'}" for judge in ["admesh", "prusa-slicer"])
    print(f"{done} solids as {', '.join(FORMATS)} for trimesh, {judges}: {pinched} were cut apart, {moved} vertices moved, {wrong} wrong")
    return 1 if wrong or not done else 0


if "--inside" in sys.argv:
    import numpy as np
    import trimesh

if __name__ == "__main__":
    sys.exit(main())
