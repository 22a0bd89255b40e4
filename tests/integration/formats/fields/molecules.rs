//! Molecules: PDB, mmCIF and PQR.

use std::path::Path;

use walpha::points::{Molecule, PointOptions, Points, read_model};

use super::points::{PLACES, row, warnings};
use super::{Fate, walk};
use crate::common::json;
use crate::formats::files::gzip;

/// The squares of Bondi's radii of nitrogen and carbon.
pub(super) const WEIGHTS: [f64; 2] = [1.55 * 1.55, 1.7 * 1.7];

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
pub(super) fn atoms(path: &Path) {
    let (points, molecule) = model(path);
    assert_eq!(points.positions, PLACES, "{}", path.display());
    assert_eq!(points.weights.as_deref(), Some(&WEIGHTS[..]));
    assert!(points.of_radii);
    let symbols: Vec<_> =
        molecule.atoms.iter().map(|atom| atom.element.unwrap().symbol()).collect();
    assert_eq!(symbols, ["N", "C"]);
}

/// The same, and nothing is said about them.
pub(super) fn quietly(path: &Path) {
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
pub(super) fn with_radii(path: &Path) {
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
