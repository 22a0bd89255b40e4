"""Atoms of molecules and crystals."""

import gzip

import numpy as np
import pytest

import walpha

PDB = """\
ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00  0.00           N
ATOM      2  CA  GLY A   1       1.450   0.000   0.000  1.00  0.00           C
ATOM      3  H   GLY A   1       0.000   1.000   0.000  1.00  0.00           H
ATOM      4  O   GLY B  -2       9.000   0.000   0.000  1.00  0.00           O
HETATM    5  O   HOH A 101       5.000   5.000   5.000  1.00  0.00           O
HETATM    6 ZN    ZN A 102       7.000   7.000   7.000  1.00  0.00          ZN
END
"""


@pytest.fixture
def pdb(tmp_path):
    path = tmp_path / "small.pdb"
    path.write_text(PDB)
    return path


def test_atoms_come_with_their_names(pdb):
    molecule = walpha.read_molecule(pdb)
    assert molecule.elements.tolist() == ["N", "C", "O"] and molecule.names.tolist() == ["N", "CA", "O"]
    assert molecule.residues.tolist() == ["GLY"] * 3 and molecule.chains.tolist() == ["A", "A", "B"]
    assert molecule.residue_numbers == (1, 1, -2)
    assert np.array_equal(molecule.points[:, 0], [0, 1.45, 9])
    assert molecule.radii.tolist() == [1.55, 1.7, 1.52] and np.array_equal(molecule.weights, molecule.radii**2)
    assert molecule.unit == "Å" and molecule.cell is None and molecule.pbc is None
    assert "hydrogens=True" in molecule.summary and "waters=True" in molecule.summary and "hetero=True" in molecule.summary
    assert repr(molecule).isascii() and "3 atoms" in repr(molecule)


def test_atoms_are_chosen(pdb, tmp_path):
    everything = walpha.read_molecule(pdb, hydrogens=True, waters=True, hetero=True)
    assert everything.elements.tolist() == ["N", "C", "H", "O", "O", "Zn"]
    assert walpha.read_molecule(pdb, chains="B").names.tolist() == ["O"]
    assert len(walpha.read_molecule(pdb, chains=["A", "B"], model="all").points) == 3
    bare = walpha.read_molecule(pdb, radii="none")
    assert bare.radii is None and bare.weights is None
    table = tmp_path / "radii.txt"
    table.write_text("N 1\nC 2\nO 3\n")
    assert walpha.read_molecule(pdb, radii=table).radii.tolist() == [1, 2, 3]
    packed = tmp_path / "small.pdb.gz"
    packed.write_bytes(gzip.compress(PDB.encode()))
    assert np.array_equal(walpha.read_molecule(packed).points, walpha.read_molecule(pdb).points)


def test_a_crystal_has_its_cell(tmp_path):
    path = tmp_path / "salt.xyz"
    path.write_text('2\nLattice="4 0 0 0 4 0 1 0 4" pbc="T T F"\nNa 0 0 0\nCl 2 2 2\n')
    crystal = walpha.read_molecule(path)
    assert np.array_equal(crystal.cell, [[4, 0, 0], [0, 4, 0], [1, 0, 4]]) and crystal.pbc == (True, True, False)
    assert crystal.elements.tolist() == ["Na", "Cl"] and crystal.residue_numbers == (None, None)


def test_what_is_not_a_molecule_is_an_error(pdb, tmp_path):
    table = tmp_path / "points.csv"
    table.write_text("x,y,z,radius\n0,0,0,1\n1,0,0,1\n")
    with pytest.raises(ValueError, match="read_points"):
        walpha.read_molecule(table)
    with pytest.raises(ValueError, match="numbered from 1"):
        walpha.read_molecule(pdb, model=0)
    with pytest.raises(ValueError, match="chain"):
        walpha.read_molecule(pdb, chains="Q")
    with pytest.raises(FileNotFoundError):
        walpha.read_molecule(tmp_path / "none.pdb")


def test_balls_of_a_molecule_are_those_of_the_file():
    molecule = walpha.read_molecule("sample:peptide")
    file = walpha.read_points("sample:peptide")
    assert np.array_equal(molecule.points, file.points) and np.array_equal(molecule.weights, file.weights)
