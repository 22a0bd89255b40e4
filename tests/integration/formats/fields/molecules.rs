//! Molecules and crystals: PDB, mmCIF, PQR, CIF, GRO, LAMMPS and POSCAR.

use std::path::Path;

use walpha::points::{Molecule, PointOptions, Points, read_model};

use super::points::{PLACES, row, warnings};
use super::{Fate, walk};
use crate::common::json;
use crate::formats::files::gzip;

/// The squares of Bondi's radii of nitrogen and carbon.
const WEIGHTS: [f64; 2] = [1.55 * 1.55, 1.7 * 1.7];

/// Lines of PDB: the record, the number, name and residue as they stand in columns 7 to 27, and the element.
fn pdb(atoms: &[(&str, &str, &str)]) -> String {
    let places = PLACES.into_iter().chain([[7.0, 8.0, 9.0], [9.0, 8.0, 7.0]]);
    let line = |(&(record, names, element), [x, y, z]): (&(&str, &str, &str), [f64; 3])| {
        format!("{record:6}{names:21}   {x:8.3}{y:8.3}{z:8.3}  1.00  0.00          {element:>2}\n")
    };
    atoms.iter().zip(places).map(line).collect()
}

const N: (&str, &str, &str) = ("ATOM", "    1  N   ALA A   1 ", "N");
const CA: (&str, &str, &str) = ("ATOM", "    2  CA  ALA A   1 ", "C");

/// Two atoms, which are a file.
fn two() -> String {
    pdb(&[N, CA]) + "END\n"
}

/// The two atoms with another second one, between lines.
fn with(before: &str, second: (&str, &str, &str), after: &str) -> String {
    format!("{before}{}{after}", pdb(&[N, second]))
}

fn model(path: &Path) -> (Points, Molecule) {
    let (mut points, metadata) =
        read_model(path, &PointOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
    let molecule = points.molecule.take().unwrap();
    (points, molecule)
}

/// A nitrogen and a carbon, at the places of all tables.
fn atoms(path: &Path) {
    let (points, molecule) = model(path);
    assert_eq!(points.positions, PLACES, "{}", path.display());
    assert_eq!(points.weights.as_deref(), Some(&WEIGHTS[..]));
    assert!(points.of_radii);
    let symbols: Vec<_> =
        molecule.atoms.iter().map(|atom| atom.element.unwrap().symbol()).collect();
    assert_eq!(symbols, ["N", "C"]);
}

/// The same, and nothing is said about them.
fn quietly(path: &Path) {
    atoms(path);
    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    assert!(told.get("warnings").is_none_or(|told| told.as_array().unwrap().is_empty()), "{told}");
}

/// What is left out of a file that has these two atoms.
fn left_out(path: &Path, words: &str) {
    atoms(path);
    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    let summary = told["atoms"]["summary"].as_str().unwrap();
    assert!(summary.starts_with("2 atoms: protein of chain A; left out: "), "{summary}");
    assert!(summary.ends_with(words), "{summary}");
}

#[test]
fn each_field_of_pdb() {
    walk(
        "PDB",
        &[
            row!("`ATOM`", "a.pdb", two(), Fate::Read(quietly)),
            row!(
                "water, `HETATM`, hydrogens",
                "a.ent",
                pdb(&[
                    N,
                    CA,
                    ("HETATM", "    3  O   HOH A 101 ", "O"),
                    ("HETATM", "    4 ZN    ZN A 102 ", "ZN")
                ]) + "ATOM      5  HA  ALA A   1       0.000   0.000   0.000  1.00  0.00           H\nEND\n",
                Fate::Read(|path| {
                    left_out(
                        path,
                        "1 water (--waters), 1 ligand (ZN) (--hetero), 1 hydrogen (--hydrogens)",
                    );
                })
            ),
            row!(
                "nothing but these",
                "a.pdb",
                pdb(&[("HETATM", "    3  O   HOH A 101 ", "O")]) + "END\n",
                Fate::Refused(&["none is left: 1 water", "give --waters"])
            ),
            row!(
                "numbers of atoms",
                "a.pdb",
                with("", ("ATOM", "A0000  CA  ALA A   1 ", "C"), "END\n"),
                Fate::Read(quietly)
            ),
            row!(
                "names, chain, number and insertion code of a residue",
                "a.pdb",
                with("", ("ATOM", "    2  CA  ALA A -12B", "C"), "END\n"),
                Fate::Read(|path| {
                    quietly(path);
                    let atom = &model(path).1.atoms[1];
                    let names = [&*atom.name, &*atom.residue, &*atom.chain];
                    assert_eq!(names, ["CA", "ALA", "A"]);
                    assert_eq!((atom.number, atom.insertion), (Some(-12), Some('B')));
                })
            ),
            row!(
                "residues of four letters, chains of two",
                "a.pdb",
                pdb(&[
                    ("ATOM", "    1  N   ALABC   1 ", "N"),
                    ("ATOM", "    2  C   POPCD   1 ", "C")
                ]) + "END\n",
                Fate::Read(|path| {
                    quietly(path);
                    let names = model(path)
                        .1
                        .atoms
                        .iter()
                        .map(|a| format!("{} {}", a.residue, a.chain))
                        .collect::<Vec<_>>();
                    assert_eq!(names, ["ALA BC", "POPC D"]);
                })
            ),
            row!(
                "a number in hybrid-36",
                "a.pdb",
                with("", ("ATOM", "    2  CA  ALA AA00C ", "C"), "END\n"),
                Fate::Read(|path| {
                    quietly(path);
                    assert_eq!(model(path).1.atoms[1].number, Some(10_012));
                })
            ),
            row!(
                "a number that is neither",
                "a.pdb",
                with("", ("ATOM", "    2  CA  ALA A270f ", "C"), "END\n"),
                Fate::Refused(&["line 2 has \"270f\" as number of a residue", "hybrid-36"])
            ),
            row!(
                "alternate places",
                "a.pdb",
                pdb(&[
                    ("ATOM", "    1  N  BALA A   1 ", "N"),
                    CA,
                    ("ATOM", "    3  N  AALA A   1 ", "N")
                ]) + "END\n",
                Fate::Read(|path| left_out(path, "left out: 1 alternate place"))
            ),
            row!(
                "x, y and z",
                "a.pdb",
                two().replace("   5.000", "   5,000"),
                Fate::Refused(&["line 2 has \"   5,000\" as y, in columns 39 to 46"])
            ),
            row!(
                "a coordinate that is too wide",
                "a.pdb",
                two().replace("    4.000", "-4000.000"),
                Fate::Refused(&["line 2 is not blank in columns 28 to 30"])
            ),
            row!(
                "tabs",
                "a.pdb",
                two().replace("  1.00  0.00", "\t1.00\t0.00"),
                Fate::Refused(&["has a tab"])
            ),
            row!(
                "short lines",
                "a.pdb",
                two().replace("   3.000  1.00  0.00           N", " 3.000"),
                Fate::Refused(&["line 1 ends before"])
            ),
            row!(
                "a last line that is cut",
                "a.pdb",
                two().split_once("   6.000").unwrap().0.to_owned() + "   6.0",
                Fate::Refused(&["ends inside line 2: it is truncated", "copy it again"])
            ),
            row!("no `END`", "a.pdb", pdb(&[N, CA]), Fate::PassedOver(&["may be truncated"])),
            row!(
                "occupancy",
                "a.pdb",
                two().replacen("  1.00  0.00", "  0.50  0.00", 1),
                Fate::Read(|path| {
                    quietly(path);
                    let of =
                        model(path).1.atoms.iter().map(|atom| atom.occupancy).collect::<Vec<_>>();
                    assert_eq!(of, [Some(0.5), Some(1.0)]);
                })
            ),
            row!(
                "no element",
                "a.pdb",
                pdb(&[
                    ("ATOM", "    1  N   LIG A   1 ", ""),
                    ("ATOM", "    2  CA  LIG A   1 ", "")
                ]) + "END\n",
                Fate::Read(quietly)
            ),
            row!(
                "an unknown element",
                "a.pdb",
                with("", ("ATOM", "    2  CA  ALA A   1 ", "X"), "END\n"),
                Fate::Refused(&[
                    "has an atom whose radius bondi does not tell",
                    "CA of ALA",
                    "--radii FILE"
                ])
            ),
            row!(
                "an element without a radius",
                "a.pdb",
                with("", ("ATOM", "    2 FE   HEM A   1 ", "FE"), "END\n"),
                Fate::Refused(&["whose radius bondi does not tell: FE of HEM", "--radii none"])
            ),
            row!(
                "`MODEL`, `ENDMDL`",
                "a.pdb",
                format!(
                    "MODEL        3\n{0}ENDMDL\nMODEL        4\n{0}ENDMDL\nEND\n",
                    pdb(&[N, CA])
                ),
                Fate::Read(|path| {
                    left_out(path, "left out: 2 atoms of other models (--models)");
                    assert_eq!(model(path).1.atoms[0].model, 3);
                })
            ),
            row!(
                "models without numbers",
                "a.pdb",
                format!("MODEL\n{0}ENDMDL\nMODEL  \n{0}ENDMDL\nEND\n", pdb(&[N, CA])),
                Fate::Read(|path| {
                    left_out(path, "left out: 2 atoms of other models (--models)");
                    assert_eq!(model(path).1.atoms[0].model, 1);
                })
            ),
            row!(
                "frames that end with `END`",
                "a.pdb",
                two() + &two(),
                Fate::Read(|path| left_out(path, "left out: 2 atoms of other models (--models)"))
            ),
            row!(
                "a model without an end",
                "a.pdb",
                format!("MODEL        1\n{}", two()),
                Fate::Refused(&["ends inside its model 1", "truncated"])
            ),
            row!(
                "atoms in no model beside models",
                "a.pdb",
                format!("MODEL        1\n{0}ENDMDL\n{0}", pdb(&[N, CA])),
                Fate::Refused(&["line 5 has an atom behind ENDMDL"])
            ),
            row!(
                "`CRYST1`",
                "a.pdb",
                with(
                    "CRYST1   10.000   20.000   30.000  90.00  90.00  90.00 P 1           1\n",
                    CA,
                    "END\n"
                ),
                Fate::Read(|path| {
                    let cell = read_model(path, &PointOptions::default()).unwrap().1.cell;
                    assert_eq!(cell.unwrap().sides(), Some([10.0, 20.0, 30.0]));
                })
            ),
            row!(
                "`CRYST1` with symmetries",
                "a.pdb",
                with(
                    "CRYST1   10.000   20.000   30.000  90.00  90.00  90.00 P 21 21 21    4\n",
                    CA,
                    "END\n"
                ),
                Fate::Read(|path| {
                    quietly(path);
                    assert_eq!(read_model(path, &PointOptions::default()).unwrap().1.cell, None);
                })
            ),
            row!(
                "atoms at one place",
                "a.pdb",
                two().replace("   4.000   5.000   6.000", "   1.000   2.000   3.000"),
                Fate::Read(|path| {
                    assert_eq!(model(path).0.positions, [PLACES[0]; 2]);
                    assert!(warnings(path).contains("an atom lies exactly where another does"));
                })
            ),
            row!(
                "no atoms",
                "a.pdb",
                "HEADER    HYDROLASE\nEND\n",
                Fate::Refused(&["no record ATOM or HETATM"])
            ),
            row!("ends of lines", "a.pdb", two().replace('\n', "\r\n"), Fate::Read(quietly)),
            row!("gzip", "a.pdb.gz", gzip(two().as_bytes()), Fate::Read(quietly)),
            row!(
                "other fields",
                "a.pdb",
                format!("TITLE     ÅB\nREMARK   1\n{}TER\nCONECT    1    2\nEND\n", pdb(&[N, CA])),
                Fate::Read(quietly)
            ),
        ],
    );
}

/// The items of `_atom_site`, and rows of the two atoms.
const ITEMS: &str = "group_PDB id type_symbol label_atom_id label_comp_id label_asym_id auth_asym_id auth_seq_id Cartn_x Cartn_y Cartn_z";
const ROWS: &str = "ATOM 1 N N ALA X A 7 1 2 3\nATOM 2 C CA ALA X A 7 4.0 5 6.000\n";

fn cif(items: &str, rows: &str) -> String {
    let tags: String = items.split(' ').map(|item| format!("_atom_site.{item}\n")).collect();
    format!("data_1ABC\n#\n_entry.id 1ABC\nloop_\n{tags}{rows}#\n")
}

#[test]
fn each_field_of_mmcif() {
    walk(
        "mmCIF",
        &[
            row!("`_atom_site`", "a.cif", cif(ITEMS, ROWS), Fate::Read(quietly)),
            row!(
                "items in another order and letter case",
                "a.mmcif",
                cif("cartn_z CARTN_Y type_symbol extra Cartn_x", "3 2 n ? 1\n6 5 c 'a b' 4\n"),
                Fate::Read(quietly)
            ),
            row!(
                "items outside of a loop",
                "a.cif",
                "data_x\n_atom_site.id 1\n_atom_site.type_symbol Ar\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\n",
                Fate::Read(|path| assert_eq!(model(path).0.positions, [PLACES[0]]))
            ),
            row!(
                "quotes and texts",
                "a.cif",
                cif(
                    ITEMS,
                    "ATOM 1 N 'N' \"ALA\" X 'A' 7 1 2 3\nATOM 2 C\n;CA\n;\nALA X A 7 4 5 6\n"
                ),
                Fate::Read(quietly)
            ),
            row!(
                "`?` and `.`",
                "a.cif",
                cif(ITEMS, "ATOM 1 N N ALA X A ? 1 2 3\nATOM 2 C CA ALA . A . 4 5 6\n"),
                Fate::Read(|path| {
                    quietly(path);
                    assert!(model(path).1.atoms.iter().all(|atom| atom.number.is_none()));
                })
            ),
            row!(
                "`?` as a coordinate",
                "a.cif",
                cif(ITEMS, "ATOM 1 N N ALA X A 7 1 ? 3\n"),
                Fate::Refused(&["line 16 has \"none\" as y"])
            ),
            row!(
                "`auth_asym_id`, `auth_seq_id`",
                "a.cif",
                cif(ITEMS, ROWS),
                Fate::Read(|path| {
                    let atom = &model(path).1.atoms[0];
                    assert_eq!((&*atom.chain, atom.number), ("A", Some(7)));
                })
            ),
            row!(
                "`group_PDB`",
                "a.cif",
                cif(
                    ITEMS,
                    &(ROWS.to_owned()
                        + "HETATM 3 ZN ZN ZN Y A 8 7 8 9\nHETATM 4 O O HOH Z A 9 9 8 7\n")
                ),
                Fate::Read(|path| left_out(path, "1 water (--waters), 1 ligand (ZN) (--hetero)"))
            ),
            row!(
                "`label_alt_id`, `pdbx_PDB_model_num`",
                "a.cif",
                cif(
                    &(ITEMS.to_owned() + " label_alt_id pdbx_PDB_model_num"),
                    "ATOM 1 N N ALA X A 7 1 2 3 . 1\nATOM 2 C CA ALA X A 7 4 5 6 B 1\nATOM 2 C CA ALA X A 7 4 5 7 C 1\nATOM 1 N N ALA X A 7 1 2 3 . 2\n"
                ),
                Fate::Read(|path| left_out(
                    path,
                    "1 alternate place, 1 atom of other models (--models)"
                ))
            ),
            row!(
                "charges behind elements, uncertainties",
                "a.cif",
                cif("type_symbol Cartn_x Cartn_y Cartn_z", "N3- 1.00(2) 2 3\nC4+ 4 5 6(1)\n"),
                Fate::Read(quietly)
            ),
            row!(
                "no `type_symbol`",
                "a.cif",
                cif(
                    "label_atom_id label_comp_id Cartn_x Cartn_y Cartn_z",
                    "N ALA 1 2 3\nCA LIG 4 5 6\n"
                ),
                Fate::Refused(&["does not say of which element", "CA of LIG"])
            ),
            row!(
                "no `Cartn_x`, `Cartn_y` or `Cartn_z`",
                "a.cif",
                cif("id Cartn_x Cartn_y", "1 2 3\n"),
                Fate::Refused(&["without _atom_site.Cartn_z"])
            ),
            row!(
                "an item twice",
                "a.cif",
                cif("id Cartn_x Cartn_y Cartn_z cartn_x", "1 2 3 4 5\n"),
                Fate::Refused(&["_atom_site.cartn_x twice"])
            ),
            row!(
                "a row that is cut",
                "a.cif",
                cif(ITEMS, "ATOM 1 N N ALA X A 7 1 2 3\nATOM 2 C CA"),
                Fate::Refused(&["ends behind 4 of 11 values", "truncated"])
            ),
            row!(
                "a quote or text without an end",
                "a.cif",
                cif(ITEMS, "ATOM 1 N 'N ALA X A 7 1 2 3\n"),
                Fate::Refused(&["line 16 has a quote without an end"])
            ),
            row!(
                "atoms in several blocks",
                "a.cif",
                cif(ITEMS, ROWS) + &cif(ITEMS, ROWS),
                Fate::Refused(&["in several blocks"])
            ),
            row!(
                "`_cell`, `_symmetry`",
                "a.cif",
                cif(ITEMS, ROWS)
                    + "_cell.length_a 10\n_cell.length_b 20.0(1)\n_cell.length_c 30\n_cell.angle_alpha 90\n_cell.angle_beta 90\n_cell.angle_gamma 90.\n_symmetry.space_group_name_H-M 'P 1'\n",
                Fate::Read(|path| {
                    let cell = read_model(path, &PointOptions::default()).unwrap().1.cell;
                    assert_eq!(cell.unwrap().sides(), Some([10.0, 20.0, 30.0]));
                })
            ),
            row!(
                "a tag that is cut off from its value",
                "a.cif",
                cif(ITEMS, ROWS) + "_cell.length_a",
                Fate::Refused(&["ends behind the tag _cell.length_a: it is truncated"])
            ),
            row!(
                "no atoms",
                "a.cif",
                "data_x\n_entry.id x\n",
                Fate::Refused(&["has no atoms (_atom_site)"])
            ),
            row!(
                "ends of lines",
                "a.cif",
                cif(ITEMS, ROWS).replace('\n', "\r\n"),
                Fate::Read(quietly)
            ),
            row!("gzip", "a.cif.gz", gzip(cif(ITEMS, ROWS).as_bytes()), Fate::Read(quietly)),
            row!(
                "other fields",
                "a.cif",
                cif(ITEMS, ROWS)
                    + "loop_\n_atom_site_anisotrop.id\n_atom_site_anisotrop.U\n1 2\nsave_x\nsave_\n",
                Fate::Read(quietly)
            ),
        ],
    );
}

/// Two atoms with radii 2 and 3.
fn with_radii(path: &Path) {
    let (points, molecule) = model(path);
    assert_eq!(points.positions, PLACES);
    assert_eq!(points.weights, Some(vec![4.0, 9.0]));
    assert_eq!(molecule.atoms[1].charge, Some(0.25));
    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    assert_eq!(told.get("warnings"), None, "{told}");
}

#[test]
fn each_field_of_pqr() {
    const ROWS: &str = "ATOM 1 N ALA A 7 1 2 3 -0.5 2\nHETATM 2 H1 LIG A 8 4 5 6 0.25 3.0\n";
    walk(
        "PQR",
        &[
            row!("places, charge and radius", "a.pqr", ROWS, Fate::Read(with_radii)),
            row!("no chain", "a.pqr", ROWS.replace(" A ", " "), Fate::Read(with_radii)),
            row!(
                "a chain right before a number",
                "a.pqr",
                ROWS.replace("A 8", "A1008C"),
                Fate::Read(|path| {
                    with_radii(path);
                    let atom = &model(path).1.atoms[1];
                    assert_eq!(
                        (&*atom.chain, atom.number, atom.insertion),
                        ("A", Some(1008), Some('C'))
                    );
                })
            ),
            row!(
                "a number of more digits",
                "a.pqr",
                ROWS.replace("HETATM 2", "HETATM100002"),
                Fate::Read(with_radii)
            ),
            row!(
                "fields without a blank between them",
                "a.pqr",
                ROWS.replace("1 2 3", "1 -2-3"),
                Fate::Refused(&["line 1", "--whitespace"])
            ),
            row!(
                "a field that is not a number",
                "a.pqr",
                ROWS.replace("0.25", "q"),
                Fate::Refused(&["line 2 has \"q\" as charge"])
            ),
            row!(
                "a radius below 0",
                "a.pqr",
                ROWS.replace("3.0", "-3"),
                Fate::Refused(&["radius is -3"])
            ),
            row!(
                "a last line that is cut",
                "a.pqr",
                ROWS.split_once(" 6 0.25").unwrap().0,
                Fate::Refused(&["ends inside line 2"])
            ),
            row!("no atoms", "a.pqr", "REMARK 1\n", Fate::Refused(&["no record ATOM or HETATM"])),
            row!(
                "other fields",
                "a.pqr",
                format!("REMARK 1\n{ROWS}TER\nEND\n"),
                Fate::Read(with_radii)
            ),
        ],
    );
}

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
