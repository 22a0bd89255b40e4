#!/usr/bin/env python3
"""Checks walpha's readers of molecules against gemmi and FreeSASA.

    scripts/check_molecules.py [--walpha target/release/walpha] [--env /tmp/walpha-molecules] [FILE...]

Makes a Python environment (once) with gemmi, FreeSASA, and MDAnalysisTests, which ships files of many programs, and reads each PDB, mmCIF
and PQR file of it, or those named: atoms, places and elements of the first model are those of gemmi, with everything and by default, and the
default has as many atoms as FreeSASA takes. PQR is compared with its own words. Files that walpha refuses are listed with the reason.
Prints a line for each difference; exits with 1 when there is one, and with 77 when the packages cannot be had.
"""

import argparse
import collections
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

from environment import enter

PACKAGES = ["numpy", "gemmi", "freesasa"]
# It ships files and needs MDAnalysis only for its tests.
FILES = "MDAnalysisTests"
# Seconds for the installation of all of them.
PATIENCE = 600
WATERS = {"HOH", "DOD", "H2O", "SOL", "TIP", "TIP2", "TIP3", "TIP4", "TIP5", "WAT"}
EVERYTHING = ["--hydrogens", "--waters", "--hetero"]


class Checker:
    def __init__(self, walpha, folder):
        self.walpha, self.folder = str(pathlib.Path(walpha).resolve()), pathlib.Path(folder)
        self.done = self.wrong = 0
        # A radius for each element, so that weights tell elements; all that are not known have none.
        self.table = self.folder / "elements.txt"
        elements = [gemmi.Element(number).name for number in range(1, 119)]
        self.table.write_text("".join(f"{name} {number}\n" for number, name in enumerate(elements, 1)))

    def judge(self, name, complaint):
        self.done += 1
        self.wrong += complaint is not None
        if complaint is not None:
            print(f"WRONG {name}: {complaint}")

    def read(self, path, *options):
        """Places and weights, or why there are none."""
        out = self.folder / "points.npy"
        run = subprocess.run([self.walpha, "points", path, *options, "--quiet", "-o", out], capture_output=True, text=True, timeout=600)
        if run.returncode:
            return None, next(line for line in run.stderr.splitlines() if "why:" in line).split("why:")[1].strip()
        points = np.load(out)
        return np.column_stack([points["x"], points["y"], points["z"], points["weight"]]), None

    def equal(self, name, found, expected):
        order = lambda rows: rows[np.lexsort(rows.T[::-1])]  # noqa: E731
        if len(found) != len(expected):
            return self.judge(name, f"{len(found)} atoms, not {len(expected)}")
        if not expected:
            return self.judge(name, None)
        found, expected = order(found), order(np.asarray(expected, float))
        differ = ~np.isclose(found, expected, rtol=0, atol=1e-6).all(axis=1)
        return self.judge(name, f"{differ.sum()} atoms differ: {found[differ][0]}, not {expected[differ][0]}" if differ.any() else None)


def expected(path):
    """Places and squares of atomic numbers of the first model's atoms, all of them and by default."""
    everything, default = [], []
    model = gemmi.read_structure(str(path))[0]
    # The first label of each residue counts, in the order of the file, also where two residues share a number.
    for chosen, everywhere in ((everything, True), (default, False)):
        residues = collections.defaultdict(list)
        for chain in model:
            for residue in chain:
                hetero = residue.het_flag == "H"
                for atom in residue:
                    is_water = residue.name in WATERS
                    hydrogen = atom.element.atomic_number == 1
                    if everywhere or not (is_water or hetero or hydrogen):
                        residues[chain.name, str(residue.seqid)].append((atom.serial, atom))
        for atoms in residues.values():
            labels = [atom.altloc for _, atom in sorted(atoms, key=lambda of: of[0]) if atom.altloc != "\0"]
            for _, atom in atoms:
                if atom.altloc in ("\0", *labels[:1]):
                    chosen.append([*atom.pos.tolist(), atom.element.atomic_number ** 2])
    return everything, default


def of_pqr(path):
    rows = []
    with (gzip.open if path.suffix == ".gz" else open)(path, "rt") as file:
        for line in file:
            if line.startswith(("ATOM", "HETATM")):
                x, y, z, _, radius = map(float, line.split()[-5:])
                rows.append([x, y, z, radius ** 2])
    return rows


def check(checker, path, refused):
    name = path.name
    if ".pqr" in name:
        found, why = checker.read(path)
        if why:
            refused[why.split(": ", 1)[-1]].append(name)
        else:
            checker.equal(name, found, of_pqr(path))
        return
    radii = ["--radii", checker.table]
    found, why = checker.read(path, *EVERYTHING, *radii)
    if why:
        refused[why.split(": ", 1)[-1]].append(name)
        return
    try:
        everything, default = expected(path)
    except RuntimeError as error:
        print(f"passed over by gemmi: {name} ({error})")
        return
    # Without columns of elements gemmi knows some, and walpha tells others by their residues.
    if any(row[3] == 0 for row in everything):
        checker.equal(f"{name}, places", found[:, :3], [row[:3] for row in everything])
        return
    checker.equal(f"{name}, everything", found, everything)
    found, why = checker.read(path, *radii)
    if why and not default:
        return
    if why:
        checker.judge(f"{name}, by default", why)
        return
    checker.equal(f"{name}, by default", found, default)
    info = subprocess.run([checker.walpha, "info", path, "--radii", "none", "--json"], capture_output=True, text=True)
    left_out = json.loads(info.stdout)["atoms"]["left_out"]
    if ".pdb" in name and not name.endswith((".gz", ".bz2")):
        # FreeSASA knows water by its record alone, and one label for all residues.
        try:
            count = freesasa.Structure(str(path), None).nAtoms()
        except Exception as error:  # noqa: BLE001
            print(f"passed over by FreeSASA: {name} ({error})")
            return
        if count != len(found):
            print(f"FreeSASA takes {count} atoms of {name}, not {len(found)}; left out: {left_out}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--walpha", default="target/release/walpha")
    parser.add_argument("--env", default="/tmp/walpha-molecules")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("files", nargs="*")
    args = parser.parse_args()
    if not args.inside:
        enter(args.env, [*PACKAGES, "--no-deps", FILES], PATIENCE)
    freesasa.setVerbosity(freesasa.nowarnings)
    files = [pathlib.Path(file) for file in args.files]
    if not files:
        folder = next(pathlib.Path(sys.prefix).glob(f"lib/python*/site-packages/{FILES}"))
        kinds = (".pdb", ".ent", ".cif", ".mmcif", ".pqr")
        files = sorted(file for file in folder.rglob("*") if file.name.removesuffix(".gz").endswith(kinds))
    refused = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        checker = Checker(args.walpha, folder)
        for file in files:
            check(checker, file, refused)
    for why, names in sorted(refused.items()):
        print(f"refused: {', '.join(names)}: {why}")
    print(f"{len(files)} files, {checker.done} comparisons, {checker.wrong} wrong, {sum(map(len, refused.values()))} refused")
    sys.exit(1 if checker.wrong or not checker.done else 0)


if __name__ == "__main__":
    if "--inside" in sys.argv:
        import freesasa
        import gemmi
        import numpy as np
    main()
