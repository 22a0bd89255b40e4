#!/usr/bin/env python3
"""Checks walpha's readers of molecules and crystals against gemmi, ASE and FreeSASA, and `walpha balls` against Voronota-LT, FreeSASA and published numbers.

    scripts/check_molecules.py [--walpha target/release/walpha] [--env /tmp/walpha-molecules] [--alphamol FOLDER] [--poreblazer FOLDER] [FILE...]

Makes a Python environment (once) with gemmi, FreeSASA, Voronota-LT, and MDAnalysisTests, which ships files of many programs, and reads each PDB,
mmCIF and PQR file of it, or those named: atoms, places and elements of the first model are those of gemmi, with everything and by default, and
the default has as many atoms as FreeSASA takes. CIF of crystals, which ASE ships, is compared with gemmi, and GRO and LAMMPS with ASE, in the
order of the file; dumps are not, as ASE puts parts of a tilted box elsewhere. Sites of water that are not atoms are left out on both sides. PQR is compared with its own words. Files that walpha refuses are listed with the reason.

Then, unless files are named, it measures balls: of HIV protease (1HVR) against published numbers, and of some molecules against Voronota-LT, for
each atom, and against FreeSASA. The balls of the crate voronota-ltr are measured if cargo has it, and the examples of AlphaMol if
--alphamol names their folder, each against the number that is published for them; and the pores of HKUST-1, if --poreblazer names the folder of that
example, against what PoreBlazer prints for it.
Prints a line for each difference; exits with 1 when there is one, and with 77 when the packages cannot be had.
"""

import argparse
import collections
import csv
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

from environment import enter

PACKAGES = ["numpy", "scipy", "ase", "gemmi", "freesasa", "voronotalt"]
# It ships files and needs MDAnalysis only for its tests.
FILES = "MDAnalysisTests"
# Seconds for the installation of all of them.
PATIENCE = 600
WATERS = {"HOH", "DOD", "H2O", "SOL", "TIP", "TIP2", "TIP3", "TIP4", "TIP5", "WAT"}
# In water, places of charge that are not atoms.
SITES = {"MW", "MW1", "MW2", "EPW", "EP1", "EP2", "OM", "LP1", "LP2"}
EVERYTHING = ["--hydrogens", "--waters", "--hetero"]
# Radii of Bondi 1964, as the published numbers of 1HVR have them.
BONDI = {"C": 1.7, "N": 1.55, "O": 1.52, "S": 1.8}
# Volume and area of 1HVR: the heavy atoms of the protein, without the inhibitor XK2. They were sampled, to half a percent.
PUBLISHED_1HVR = 1514, 16511, 19832, 0.005
# Files of the crate voronota-ltr, the probe, and the volume and the area that Voronota-LT is said to find.
OF_VORONOTA = {
    "balls_2zsk.xyzr": (1.4, 83956.43577433, 18649.94224553),
    "balls_3dlb.xyzr": (1.4, 240565.9288, 58651.0195),
}
# Of its examples, AlphaMol prints ten digits.
OF_ALPHAMOL = ["Vol1", "Vol2", "Vol3", "Vol4", "Vol10", "Vol30", "Vol100"]


# What PoreBlazer 4 prints of HKUST-1, whose atoms are half as wide as their Lennard-Jones σ: the volume outside of them, sampled to about a
# thousandth, and the diameters of the spheres that pass and that fit, on a grid of 0.2 Å.
OF_POREBLAZER = {"box": 26.28791, "volume": 12757.117, "free": 6.38, "included": 12.86, "grid": 0.2}


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

    def measure(self, rows, probe):
        """The measures of balls, and those of each: volume, area."""
        table, atoms = self.folder / "balls.csv", self.folder / "atoms.csv"
        with table.open("w") as file:
            file.write("x,y,z,radius\n")
            file.writelines(",".join(map(repr, row)) + "\n" for row in rows)
        command = [self.walpha, "balls", table, "--json", "--probe", str(probe), "-o", atoms]
        run = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600)
        with atoms.open() as file:
            parts = [[float(row["volume"]), float(row["area"])] for row in csv.DictReader(file)]
        return json.loads(run.stdout)["balls"], np.array(parts)

    def near(self, name, what, found, expected, tolerance):
        """Judges a number by a relative tolerance."""
        wrong = abs(found - expected) > tolerance * abs(expected)
        self.judge(f"{name}, {what}", f"{found!r}, not {expected!r}" if wrong else None)

    def equal(self, name, found, expected):
        order = lambda rows: rows[np.lexsort(rows.T[::-1])]  # noqa: E731
        if len(found) != len(expected):
            return self.judge(name, f"{len(found)} atoms, not {len(expected)}")
        if not expected:
            return self.judge(name, None)
        found, expected = order(found), order(np.asarray(expected, float))
        differ = ~np.isclose(found, expected, rtol=0, atol=1e-6).all(axis=1)
        return self.judge(name, f"{differ.sum()} atoms differ: {found[differ][0]}, not {expected[differ][0]}" if differ.any() else None)


# Ions as CHARMM calls them.
CHARMM = {"CAL": "Ca", "CES": "Cs", "CLA": "Cl", "LIT": "Li", "POT": "K", "SOD": "Na"}


def number(residue, atom):
    """The atomic number: where a file states no element, gemmi takes that of an ion from the columns of its name alone."""
    name, of_atom = (text.rstrip("0123456789+-").upper() for text in (residue.name, atom.name))
    ion = gemmi.Element(CHARMM.get(name, name)).atomic_number if len(residue) == 1 and name == of_atom else 0
    return ion or atom.element.atomic_number


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
                    if is_water and atom.name in SITES:
                        continue
                    if everywhere or not (is_water or hetero or hydrogen):
                        residues[chain.name, str(residue.seqid)].append((atom.serial, atom, number(residue, atom)))
        for atoms in residues.values():
            labels = [atom.altloc for _, atom, _ in sorted(atoms, key=lambda of: of[0]) if atom.altloc != "\0"]
            for _, atom, of_element in atoms:
                if atom.altloc in ("\0", *labels[:1]):
                    chosen.append([*atom.pos.tolist(), of_element ** 2])
    return everything, default


def of_pqr(path):
    rows = []
    with (gzip.open if path.suffix == ".gz" else open)(path, "rt") as file:
        for line in file:
            if line.startswith(("ATOM", "HETATM")):
                x, y, z, _, radius = map(float, line.split()[-5:])
                rows.append([x, y, z, radius ** 2])
    return rows


def check_crystal(checker, path, refused):
    """Compares all atoms of a cell with those of gemmi, up to whole vectors of the cell."""
    found, why = checker.read(path, "--radii", checker.table)
    if why:
        refused[why.split(": ", 1)[-1]].append(path.name)
        return
    structure = gemmi.read_small_structure(str(path))
    sites = structure.get_all_unit_cell_sites()
    if len(found) != len(sites):
        checker.judge(path.name, f"{len(found)} atoms, not {len(sites)}")
        return
    theirs = np.array([[*site.fract.tolist(), site.element.atomic_number ** 2] for site in sites])
    fractions = np.array([structure.cell.fractionalize(gemmi.Position(*row[:3])).tolist() for row in found])
    way = fractions[:, None] - theirs[None, :, :3]
    near = (abs(way - way.round()) < 1e-3).all(axis=2) & (found[:, None, 3] == theirs[None, :, 3])
    checker.judge(path.name, None if near.any(axis=0).all() and near.any(axis=1).all() else "atoms differ")


def check_simulation(checker, path, refused):
    """Compares places with those of ASE, in the order of the file, up to whole vectors of the cell."""
    kind = "gromacs" if ".gro" in path.name else "lammps-data"
    options = ["--hydrogens", "--waters"] if kind == "gromacs" else []
    found, why = checker.read(path, *options, "--radii", "none")
    if why:
        refused[why.split(": ", 1)[-1]].append(path.name)
        return
    try:
        atoms = ase.io.read(path, format=kind, **({"sort_by_id": False} if kind == "lammps-data" else {}))
    except Exception as error:  # noqa: BLE001
        print(f"passed over by ASE: {path.name} ({error})")
        return
    if kind == "gromacs":
        names = zip(atoms.arrays["residuenames"], atoms.arrays["atomtypes"], strict=True)
        atoms = atoms[[not (residue in WATERS and name in SITES) for residue, name in names]]
    if len(atoms) != len(found):
        checker.judge(path.name, f"{len(found)} atoms, not {len(atoms)}")
        return
    way = found[:, :3] - atoms.positions
    if atoms.cell.rank == 3:
        # ASE moves atoms by the passages through sides that LAMMPS counts.
        parts = atoms.cell.scaled_positions(way)
        way = atoms.cell.cartesian_positions(parts - parts.round())
    same = np.abs(way).max() < 1e-6
    checker.judge(path.name, None if same else "atoms at other places")


def check(checker, path, refused):
    name = path.name
    if ".gro" in name or name.endswith(".data"):
        check_simulation(checker, path, refused)
        return
    if name.endswith(".cif") and "_atom_site_fract_x" in path.read_text(errors="replace"):
        check_crystal(checker, path, refused)
        return
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


def xyzr(path):
    """The last four words of each line."""
    return [tuple(map(float, line.split()[-4:])) for line in path.read_text().splitlines() if line.strip()]


def against_programs(checker, name, rows, probe):
    """Volume and area of balls, as Voronota-LT and FreeSASA find them."""
    measures, parts = checker.measure(rows, probe)
    # The cells are freed with it.
    tessellation = voronotalt.RadicalTessellation([voronotalt.Ball(*row) for row in rows], probe=probe)
    cells = tessellation.cells
    theirs = np.array([[cell.volume, cell.sas_area] for cell in cells])
    for k, what in enumerate(("volume", "area")):
        # It sums in doubles, without bounds: nine digits of a total are common.
        checker.near(name, f"{what} by Voronota-LT", measures[what], theirs[:, k].sum(), 1e-7)
        off = np.abs(parts[:, k] - theirs[:, k])
        worst = off.argmax()
        complaint = f"atom {worst}: {parts[worst, k]!r}, not {theirs[worst, k]!r}" if off[worst] > 1e-4 else None
        checker.judge(f"{name}, {what} of each atom by Voronota-LT", complaint)
    options = {"algorithm": freesasa.ShrakeRupley, "n-points": 10000, "probe-radius": probe}
    coordinates = [x for row in rows for x in row[:3]]
    sampled = freesasa.calcCoord(coordinates, [row[3] for row in rows], freesasa.Parameters(options))
    # Each atom's part is a number of 10 000 points.
    checker.near(name, "area by FreeSASA", measures["area"], sampled.totalArea(), 5e-4)


def check_measures(checker, files, alphamol):
    structure = gemmi.read_structure(str(next(file for file in files if file.name == "1hvr.pdb")))
    atoms = [at for at in structure[0].all() if at.atom.element.name != "H" and at.residue.name != "XK2"]
    rows = [(*at.atom.pos.tolist(), BONDI[at.atom.element.name]) for at in atoms]
    count, volume, area, tolerance = PUBLISHED_1HVR
    checker.judge("1HVR", None if len(rows) == count else f"{len(rows)} atoms, not {count}")
    measures, _ = checker.measure(rows, 0)
    checker.near("1HVR", "volume", measures["volume"], volume, tolerance)
    checker.near("1HVR", "area", measures["area"], area, tolerance)
    for probe in (0.0, 1.4):
        against_programs(checker, f"1HVR with probe {probe}", rows, probe)
    for folder in sorted(pathlib.Path.home().glob(".cargo/registry/src/*/voronota-ltr-*/benches/data"))[:1]:
        for name, (probe, volume, area) in OF_VORONOTA.items():
            measures, _ = checker.measure(xyzr(folder / name), probe)
            checker.near(name, "volume", measures["volume"], volume, 1e-9)
            checker.near(name, "area", measures["area"], area, 1e-9)
    for name in OF_ALPHAMOL if alphamol else []:
        said = dict(line.split(":", 1) for line in (alphamol / f"{name}.info").read_text().splitlines() if ":" in line)
        said = {words.strip(): number.strip() for words, number in said.items()}
        rows = xyzr(alphamol / f"{name}.crd")
        measures, parts = checker.measure(rows, 0)
        # It counts an arc with its length times the angle between the spheres, and not half of that, by which a rounded arc would have
        # the mean of its two curvatures.
        spheres = sum(area / row[3] for row, (_, area) in zip(rows, parts, strict=True))
        for words, found in (
            ("volume", measures["volume"]),
            ("surface area", measures["area"]),
            ("mean curvature", 2 * measures["mean_curvature"] - spheres),
            ("Gauss curvature", measures["gaussian_curvature"]),
        ):
            expected = said[f"Unweighted {words}"]
            checker.judge(f"{name}, {words}", None if f"{found:.8f}" == expected else f"{found}, not {expected}")


def check_pores(checker, folder):
    side, grid = OF_POREBLAZER["box"], OF_POREBLAZER["grid"]
    sigmas = (line.split() for line in (folder / "UFF.atoms").read_text().splitlines())
    wanted = {words[0]: float(words[1]) / 2 for words in sigmas if words and words[0] in ("H", "C", "O", "Cu")}
    table = checker.folder / "uff.txt"
    table.write_text("".join(f"{element} {radius}\n" for element, radius in wanted.items()))
    options = ["--periodic", f"{side},{side},{side}", "--radii", table, "--json"]
    run = lambda name: json.loads(  # noqa: E731
        subprocess.run([checker.walpha, name, folder / "HKUST1.xyz", *options], capture_output=True, text=True, check=True).stdout
    )
    checker.near("HKUST-1", "volume outside", side**3 - run("balls")["balls"]["volume"], OF_POREBLAZER["volume"], 1e-3)
    pores = run("pores")["pores"]
    for name, found in (("free", pores["free"]["diameter"]), ("included", pores["included"]["diameter"])):
        expected = OF_POREBLAZER[name]
        checker.judge(f"HKUST-1, {name} sphere", None if abs(found - expected) < grid else f"{found}, not {expected}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--walpha", default="target/release/walpha")
    parser.add_argument("--env", default="/tmp/walpha-molecules")
    parser.add_argument("--alphamol", type=pathlib.Path, help="AlphaMol's folder of examples")
    parser.add_argument("--poreblazer", type=pathlib.Path, help="PoreBlazer's folder of the example HKUST-1")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("files", nargs="*")
    args = parser.parse_args()
    if not args.inside:
        enter(args.env, [*PACKAGES, "--no-deps", FILES], PATIENCE)
    freesasa.setVerbosity(freesasa.nowarnings)
    files = [pathlib.Path(file) for file in args.files]
    if not files:
        folder = next(pathlib.Path(sys.prefix).glob(f"lib/python*/site-packages/{FILES}"))
        kinds = (".pdb", ".ent", ".cif", ".mmcif", ".pqr", ".gro", ".data")
        files = sorted(file for file in folder.rglob("*") if file.name.removesuffix(".gz").endswith(kinds))
        files += sorted(folder.parent.glob("ase/test/testdata/minerals/*.cif"))
    refused = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        checker = Checker(args.walpha, folder)
        for file in files:
            check(checker, file, refused)
        if not args.files:
            check_measures(checker, files, args.alphamol)
        if args.poreblazer:
            check_pores(checker, args.poreblazer)
    for why, names in sorted(refused.items()):
        print(f"refused: {', '.join(names)}: {why}")
    print(f"{len(files)} files, {checker.done} comparisons, {checker.wrong} wrong, {sum(map(len, refused.values()))} refused")
    sys.exit(1 if checker.wrong or not checker.done else 0)


if __name__ == "__main__":
    if "--inside" in sys.argv:
        import ase.io
        import freesasa
        import gemmi
        import numpy as np
        import voronotalt
    main()
