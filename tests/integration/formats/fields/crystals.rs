//! Crystals and simulations: CIF, GRO, LAMMPS and POSCAR.

use std::path::Path;

use walpha::points::{PointOptions, read_model};

use super::molecules::{WEIGHTS, atoms, quietly, with_radii};
use super::points::{PLACES, row};
use super::{Fate, walk};
use crate::common::json;

/// A cell of 10 × 20 × 30 in which these fractions are the places of all tables.
const CELL: &str = "data_x\n_cell_length_a 10.0(1)\n_cell_length_b 20\n_cell_length_c 30\n";
const SITES: &str = "N1 N 0.1 0.1 0.1\nC1 C 0.4 0.25 0.2(1)\n";

fn crystal(before: &str, items: &str, rows: &str) -> String {
    let tags: String = items.split(' ').map(|item| format!("_atom_site_{item}\n")).collect();
    format!("{CELL}{before}loop_\n{tags}{rows}")
}

const SITE: &str = "label type_symbol fract_x fract_y fract_z";

/// Places but for rounding, and the cell.
fn of_cell(path: &Path) {
    let (points, metadata) = read_model(path, &PointOptions::default()).unwrap();
    for (place, expected) in points.positions.iter().zip(PLACES) {
        assert!((0..3).all(|k| (place[k] - expected[k]).abs() < 1e-9), "{place:?}");
    }
    assert_eq!(points.len(), 2);
    assert_eq!(points.weights.as_deref(), Some(&WEIGHTS[..]));
    assert_eq!(metadata.cell.unwrap().sides(), Some([10.0, 20.0, 30.0]));
}

/// The cell, of the lengths 10, 20 and 30, that is tilted.
fn tilted(path: &Path) {
    let (points, metadata) = read_model(path, &PointOptions::default()).unwrap();
    assert_eq!(points.len(), 2);
    let vectors = [[10.0, 0.0, 0.0], [-2.5, 20.0, 0.0], [1.25, 5.0, 30.0]];
    assert_eq!(metadata.cell.unwrap().vectors, vectors);
}

#[test]
fn each_field_of_crystals() {
    const OPERATIONS: &str = "'x, y, z'\n1/2+x,-y,z\n";
    let twice: fn(&Path) = |path| {
        let points = read_model(path, &PointOptions::default()).unwrap().0;
        assert_eq!(points.len(), 4);
    };
    walk(
        "CIF of crystals",
        &[
            row!(
                "`_cell_length_a` and others",
                "a.cif",
                crystal("", SITE, SITES),
                Fate::Read(of_cell)
            ),
            row!(
                "no cell",
                "a.cif",
                crystal("", SITE, SITES).replace("_cell_length_b 20\n", ""),
                Fate::Refused(&["without its _cell_length_b"])
            ),
            row!(
                "`_symmetry_equiv_pos_as_xyz`",
                "a.cif",
                crystal(&format!("loop_\n_symmetry_equiv_pos_as_xyz\n{OPERATIONS}"), SITE, SITES),
                Fate::Read(twice)
            ),
            row!(
                "`_space_group_symop_operation_xyz`",
                "a.cif",
                crystal(
                    &format!("loop_\n_space_group_symop_operation_xyz\n{OPERATIONS}"),
                    SITE,
                    SITES
                ),
                Fate::Read(twice)
            ),
            row!(
                "an operation that is malformed",
                "a.cif",
                crystal("_space_group_symop_operation_xyz x,y\n", SITE, SITES),
                Fate::Refused(&["line 5 has \"x,y\" as a symmetry operation"])
            ),
            row!(
                "a space group without operations",
                "a.cif",
                crystal("_space_group_IT_number 5\n", SITE, SITES),
                Fate::Refused(&["the space group \"5\"", "does not list", "ase convert"])
            ),
            row!(
                "`_atom_site_fract_x`, `_y`, `_z`",
                "a.cif",
                crystal("", "fract_z fract_y fract_x type_symbol", "1.1 -.9 0.1 N\n.2 .25 .4 C\n"),
                Fate::Read(of_cell)
            ),
            row!(
                "`?` as a coordinate",
                "a.cif",
                crystal("", SITE, &format!("{SITES}H1 H ? ? ?\n")),
                Fate::PassedOver(&["1 site without coordinates"])
            ),
            row!(
                "no `_atom_site_fract_y`",
                "a.cif",
                crystal("", "label fract_x fract_z", "N1 0.1 0.1\n"),
                Fate::Refused(&["without _atom_site_fract_y"])
            ),
            row!(
                "`_atom_site_Cartn_x` alone",
                "a.cif",
                crystal("", "label Cartn_x Cartn_y Cartn_z", "N1 1 2 3\n"),
                Fate::Refused(&["CIF of small molecules without fractions"])
            ),
            row!(
                "`_atom_site_type_symbol`",
                "a.cif",
                crystal("", SITE, &SITES.replace("N1 N", "X1 N3-")),
                Fate::Read(of_cell)
            ),
            row!(
                "no `_atom_site_type_symbol`",
                "a.cif",
                crystal(
                    "",
                    "label fract_x fract_y fract_z",
                    &SITES.replace("N1 N", "N1").replace("C1 C", "C1A")
                ),
                Fate::Read(of_cell)
            ),
            row!(
                "`_atom_site_occupancy`, `_atom_site_disorder_group`",
                "a.cif",
                crystal(
                    "",
                    "label fract_x fract_y fract_z occupancy disorder_group",
                    "N1 .1 .1 .1 0.5(1) .\nC1 .4 .25 .2 1 2\n"
                ),
                Fate::PassedOver(&["2 of 2 sites are occupied in part"])
            ),
            row!(
                "dummies",
                "a.cif",
                crystal(
                    "",
                    "label fract_x fract_y fract_z calc_flag",
                    "N1 .1 .1 .1 d\nC1 .4 .25 .2 dum\n"
                ),
                Fate::PassedOver(&["1 site of dummies"])
            ),
            row!(
                "several blocks with atoms",
                "a.cif",
                crystal("", SITE, SITES) + &crystal("", SITE, SITES),
                Fate::PassedOver(&["2 of its blocks have atoms"])
            ),
            row!(
                "other fields",
                "a.cif",
                crystal("_chemical_formula_sum 'C N'\n", SITE, SITES)
                    + "loop_\n_geom_bond_atom_site_label_1\n_geom_bond_distance\nN1 1.5(2)\n",
                Fate::Read(of_cell)
            ),
        ],
    );
}

const GRO: &str = "t\n 2\n    1ALA      N    1   0.100   0.200   0.300\n    1ALA     CA    2   0.400   0.500   0.600\n   1.00000   2.00000   3.00000\n";

#[test]
fn each_field_of_gro() {
    walk(
        "GRO",
        &[
            row!("atoms", "a.gro", GRO, Fate::Read(quietly)),
            row!(
                "velocities",
                "a.gro",
                GRO.replace("0.300\n", "0.300  0.1000 -0.2000  0.3000\n"),
                Fate::Read(quietly)
            ),
            row!("a box of three numbers", "a.gro", GRO, Fate::Read(of_cell)),
            row!(
                "a box of nine numbers",
                "a.gro",
                GRO.replace("3.00000\n", "3.00000 0 0 -0.25 0 0.125 0.5\n"),
                Fate::Read(tilted)
            ),
            row!(
                "a box of zeros",
                "a.gro",
                GRO.replace("   1.00000   2.00000   3.00000", "0 0 0"),
                Fate::Read(|path| {
                    atoms(path);
                    assert_eq!(read_model(path, &PointOptions::default()).unwrap().1.cell, None);
                })
            ),
            row!(
                "water, hydrogens",
                "a.gro",
                GRO.replace(" 2\n", " 4\n").replace(
                    "   1.00000",
                    "    1ALA     HA    3   0.400   0.500   0.600\n    2SOL     OW    4   0.400   0.500   0.600\n   1.00000"
                ),
                Fate::Read(|path| {
                    atoms(path);
                    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
                    let summary = told["atoms"]["summary"].as_str().unwrap();
                    assert!(summary.ends_with("1 water (--waters), 1 hydrogen (--hydrogens)"), "{summary}");
                })
            ),
            row!(
                "virtual sites of water, such as `MW`",
                "a.gro",
                GRO.replace(" 2\n", " 4\n").replace(
                    "   1.00000",
                    "    2SOL     OW    3   0.700   0.800   0.900\n    2SOL     MW    4   0.710   0.800   0.900\n   1.00000"
                ),
                Fate::Read(|path| {
                    atoms(path);
                    let told = json(path.parent().unwrap(), &["info", "--waters", path.to_str().unwrap()]);
                    assert_eq!(told["count"], 3);
                    assert_eq!(told["atoms"]["left_out"]["virtual_sites"], 1);
                    let summary = told["atoms"]["summary"].as_str().unwrap();
                    assert!(summary.ends_with("left out: 1 virtual site of water"), "{summary}");
                })
            ),
            row!(
                "several frames",
                "a.gro",
                GRO.repeat(2),
                Fate::PassedOver(&["2 frames, of which the first is read"])
            ),
            row!(
                "a count that is too high",
                "a.gro",
                GRO.replace(" 2\n", " 3\n"),
                Fate::Refused(&["claims 3 atoms and a box in line 2"])
            ),
            row!(
                "a count that is too low",
                "a.gro",
                GRO.replace(" 2\n", " 1\n"),
                Fate::Refused(&["line 4 has", "as the box"])
            ),
            row!(
                "a coordinate that is not a number",
                "a.gro",
                GRO.replace("0.500", "0.5o0"),
                Fate::Refused(&["line 4 has \"0.5o0\" as y, in columns 29 to 36"])
            ),
        ],
    );
}

const DATA: &str = "t\n\n2 atoms\n2 atom types\n\n0 10 xlo xhi\n0 20 ylo yhi\n0 30 zlo zhi\n\nMasses\n\n1 14.0067\n2 12.0\n\nAtoms # atomic\n\n1 1 1 2 3\n2 2 4 5 6\n";

#[test]
fn each_field_of_lammps_data() {
    walk(
        "LAMMPS data",
        &[
            row!("`xlo xhi`, `ylo yhi`, `zlo zhi`", "a.lmp", DATA, Fate::Read(of_cell)),
            row!(
                "`xy xz yz`",
                "a.lmp",
                DATA.replace("zlo zhi\n", "zlo zhi\n-2.5 1.25 5 xy xz yz\n"),
                Fate::Read(tilted)
            ),
            row!(
                "`avec`, `bvec`, `cvec`",
                "a.lmp",
                DATA.replace("0 10 xlo xhi", "10 0 0 avec")
                    .replace("0 20 ylo yhi", "-2.5 20 0 bvec")
                    .replace("0 30 zlo zhi", "1.25 5 30 cvec"),
                Fate::Read(tilted)
            ),
            row!(
                "no box",
                "a.lmp",
                DATA.replace("0 20 ylo yhi\n", ""),
                Fate::Refused(&["states no box", "xlo xhi"])
            ),
            row!(
                "`Atoms` of styles",
                "a.lmp",
                DATA.replace("atomic\n\n1 1 1 2 3\n2 2 ", "full\n\n1 1 1 0.5 1 2 3\n2 1 2 0 "),
                Fate::Read(quietly)
            ),
            row!(
                "`Atoms` without a style",
                "a.lmp",
                DATA.replace(" # atomic", ""),
                Fate::PassedOver(&["taken for those of atomic"])
            ),
            row!(
                "another style",
                "a.lmp",
                DATA.replace("atomic", "ellipsoid"),
                Fate::Refused(&["of the style ellipsoid", "atomic, charge"])
            ),
            row!(
                "`Masses`",
                "a.lmp",
                DATA.replace("1 14.0067", "1 15 # N").replace("2 12.0", "2 13 # C of CH"),
                Fate::Read(quietly)
            ),
            row!(
                "types that are no elements",
                "a.lmp",
                DATA.replace("1 14.0067", "1 1").replace("2 12.0", "2 1"),
                Fate::PassedOver(&["names of atoms are not elements"])
            ),
            row!(
                "a number of atoms that is wrong",
                "a.lmp",
                DATA.replace("2 atoms", "3 atoms"),
                Fate::Refused(&["claims 3 atoms, but has 2"])
            ),
            row!(
                "`Masses` that are small whole numbers, where no units are stated",
                "a.lmp",
                DATA.replace("14.0067", "1").replace("12.0", "4"),
                Fate::PassedOver(&["its masses are small whole numbers", "--radii none"])
            ),
            row!(
                "a coordinate that is not a number",
                "a.lmp",
                DATA.replace("4 5 6", "4 five 6"),
                Fate::Refused(&["line 18 has \"five\" as y"])
            ),
            row!(
                "other fields",
                "data.water",
                DATA.replace("Atoms", "Pair Coeffs # lj\n\n1 2 3\n2 3 4\n\nAtoms")
                    .replace("1 2 3\n2 2", "1 2 3 0 0 -1\n2 2")
                    + "\nVelocities\n\n1 0 0 0\n2 0 0 0\n",
                Fate::Read(quietly)
            ),
        ],
    );
}

const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 20\n0 30\nITEM: ATOMS id element x y z\n1 N 1 2 3\n2 C 4 5 6\n";

#[test]
fn each_field_of_lammps_dumps() {
    walk(
        "LAMMPS dump",
        &[
            row!("`x y z`", "a.dump", DUMP, Fate::Read(quietly)),
            row!(
                "`xs ys zs`",
                "a.lammpstrj",
                DUMP.replace("x y z", "xs ys zs")
                    .replace("1 2 3", "0.1 0.1 0.1")
                    .replace("4 5 6", "0.4 0.25 0.2"),
                Fate::Read(of_cell)
            ),
            row!(
                "`xu yu zu`, `xsu ysu zsu`",
                "dump.1",
                DUMP.replace("x y z", "xu yu zu"),
                Fate::Read(of_cell)
            ),
            row!(
                "`BOX BOUNDS pp ff pp`",
                "a.dump",
                DUMP.replace("pp pp pp", "pp ff pp"),
                Fate::Read(|path| {
                    atoms(path);
                    let cell = read_model(path, &PointOptions::default()).unwrap().1.cell;
                    assert_eq!(cell.unwrap().repeats, [true, false, true]);
                })
            ),
            row!(
                "`BOX BOUNDS xy xz yz`",
                "a.dump",
                DUMP.replace("pp pp pp", "xy xz yz pp pp pp")
                    .replace("0 10\n", "-2.5 11.25 -2.5\n")
                    .replace("0 20\n", "0 25 1.25\n")
                    .replace("0 30\n", "0 30 5\n"),
                Fate::Read(tilted)
            ),
            row!(
                "`element`, `mass`, `q`, `radius`, `diameter`",
                "a.dump",
                DUMP.replace("element x", "mass q radius x")
                    .replace("1 N ", "1 14.007 0.5 2 ")
                    .replace("2 C ", "2 12.011 0.25 3 "),
                Fate::Read(with_radii)
            ),
            row!(
                "`UNITS`",
                "a.dump",
                format!(
                    "ITEM: UNITS\nnano\n{}",
                    DUMP.replace("1 2 3", ".1 .2 .3").replace("4 5 6", ".4 .5 .6")
                ),
                Fate::Read(quietly)
            ),
            row!(
                "several frames",
                "a.dump",
                DUMP.repeat(3),
                Fate::PassedOver(&["3 frames, of which the first is read"])
            ),
            row!(
                "a number of atoms that is wrong",
                "a.dump",
                DUMP.replace("ATOMS\n2", "ATOMS\n5"),
                Fate::Refused(&["claims 5 atoms, but has 2"])
            ),
            row!(
                "no columns of places",
                "a.dump",
                DUMP.replace("x y z", "x y vz"),
                Fate::Refused(&["line 9 has no columns x y z"])
            ),
        ],
    );
}

const POSCAR: &str = "t\n2\n5 0 0\n0 10 0\n0 0 15\nN C\n1 1\nDirect\n0.1 0.1 0.1\n0.4 0.25 0.2\n";

#[test]
fn each_field_of_poscar() {
    walk(
        "POSCAR",
        &[
            row!("scale and vectors", "POSCAR", POSCAR, Fate::Read(of_cell)),
            row!(
                "names and numbers of atoms",
                "a.vasp",
                POSCAR.replace("N C", "N_s C_pv/5f"),
                Fate::Read(of_cell)
            ),
            row!(
                "no names",
                "a.vasp",
                POSCAR.replace("N C\n", ""),
                Fate::PassedOver(&["names of atoms are not elements"])
            ),
            row!("`Direct`", "a.vasp", POSCAR, Fate::Read(of_cell)),
            row!(
                "`Cartesian`",
                "a.vasp",
                POSCAR.replace("Direct\n0.1 0.1 0.1\n0.4 0.25 0.2", "Cartesian\n.5 1 1.5\n2 2.5 3"),
                Fate::Read(of_cell)
            ),
            row!(
                "`Selective dynamics`",
                "CONTCAR",
                POSCAR
                    .replace("Direct", "Selective dynamics\nDirect")
                    .replace("0.1\n", "0.1 T T F\n"),
                Fate::Read(of_cell)
            ),
            row!(
                "a coordinate that is not a number",
                "a.vasp",
                POSCAR.replace("0.25", "1/4"),
                Fate::Refused(&["line 10 has \"1/4\" as a coordinate"])
            ),
            row!(
                "lines that are missing",
                "a.vasp",
                POSCAR.replace("1 1\n", "1 7\n"),
                Fate::Refused(&["ends behind line 10: it is truncated"])
            ),
            row!(
                "other fields",
                "a.vasp",
                format!("{POSCAR}\n0 0 0\n0 0 0\n"),
                Fate::Read(of_cell)
            ),
        ],
    );
}
