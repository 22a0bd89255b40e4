from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _walpha
from ._typing import Floats


class Molecule(NamedTuple):
    """The atoms of a molecule or a crystal, in the order of their file.

    Attributes
    ----------
    points : ndarray of float64, (n, 3)
        Centres.
    radii : ndarray of float64, (n,), or None
        Radii of the balls; None with ``radii="none"``.
    elements, names, residues, chains : ndarray of str, (n,)
        Symbols of elements, names of atoms in their residues, as in "CA", names of residues, and chains; empty where the file states none.
    residue_numbers : tuple of int or None
        The numbers of residues, as the author of the file gave them.
    cell : ndarray of float64, (3, 3), or None
        The vectors of the cell in which atoms repeat, one in each row, where the file states one.
    pbc : tuple of bool, or None
        Along which of these vectors they repeat.
    unit : str
        Of lengths: "Å", or "unit" if unknown.
    summary : str
        What was read and what was left out, in words.
    """

    points: Floats
    radii: Floats | None
    elements: NDArray[np.str_]
    names: NDArray[np.str_]
    residues: NDArray[np.str_]
    residue_numbers: tuple[int | None, ...]
    chains: NDArray[np.str_]
    cell: Floats | None
    pbc: tuple[bool, bool, bool] | None
    unit: str
    summary: str

    @property
    def weights(self) -> Floats | None:
        """ndarray of float64, (n,), or None: squared radii, the weights of the atoms at α = 0."""
        return None if self.radii is None else np.square(self.radii)

    def __repr__(self) -> str:
        return f"<walpha.Molecule: {self.summary}>".encode("ascii", "backslashreplace").decode()


def read_molecule(
    path: str | os.PathLike[str],
    *,
    radii: Literal["bondi", "protor", "column", "none"] | str | os.PathLike[str] | None = None,
    hydrogens: bool = False,
    waters: bool = False,
    hetero: bool = False,
    chains: str | Iterable[str] | None = None,
    model: int | Literal["all"] | None = None,
) -> Molecule:
    """Read the atoms of a molecule or a crystal.

    Parameters
    ----------
    path : str or path-like
        PDB, mmCIF, CIF of a crystal, PQR, XYZ and extended XYZ with elements, GRO, LAMMPS data and dumps, or POSCAR, also compressed with gzip; or
        ``sample:peptide``, a small molecule.
    radii : str or path-like, optional
        "bondi" (1964), "protor" (Tsai et al. 1999), "column" for those that the file states, "none", or the path of a table with an element and a
        radius in each line. By default those of the file where it has any, or else Bondi's.
    hydrogens, waters, hetero : bool
        Of PDB, mmCIF, PQR and GRO also take hydrogens, waters, and ligands and ions. By default only the heavy atoms of the polymers are read, of each atom
        at its first place.
    chains : str or iterable of str, optional
        The chains to take, as "A"; all by default.
    model : int or "all", optional
        The model to take; the first by default.

    Returns
    -------
    Molecule

    Raises
    ------
    OSError
        The system refuses.
    ValueError
        The file is not what it says, states no atoms, or has elements without a radius.

    Examples
    --------
    >>> molecule = walpha.read_molecule("sample:peptide")
    >>> molecule.elements[:4], round(float(molecule.radii[0]), 2)
    (array(['N', 'C', 'C', 'O'], dtype='<U1'), 1.55)
    >>> shape = walpha.alpha_shape(molecule.points, alpha=0, weights=molecule.weights)
    >>> round(shape.balls.volume.value, 3)
    663.797
    """
    if model == 0:
        raise ValueError('model=0: models are numbered from 1; give "all" for all of them')
    choice: dict[str, object] = {
        "radii": None if radii is None else os.fspath(radii),
        "hydrogens": bool(hydrogens),
        "waters": bool(waters),
        "hetero": bool(hetero),
        "chains": None if chains is None else [chains] if isinstance(chains, str) else list(chains),
        "model": 0 if model == "all" else model,
    }
    read = _walpha.read_molecule(os.fspath(path), choice)
    cell, repeats = read["cell"] or (None, None)
    return Molecule(
        points=read["positions"],
        radii=read["radii"],
        elements=np.array(read["elements"], str),
        names=np.array(read["names"], str),
        residues=np.array(read["residues"], str),
        residue_numbers=tuple(read["numbers"]),
        chains=np.array(read["chains"], str),
        cell=None if cell is None else np.array(cell, float),
        pbc=None if repeats is None else (repeats[0], repeats[1], repeats[2]),
        unit=json.loads(read["coordinates"])["unit"],
        summary=read["summary"],
    )
