//! Crystals and simulations: CIF with symmetry operations, GRO, LAMMPS and POSCAR.

use std::path::{Path, PathBuf};

use walpha_points::{
    AtomSelection, Cell, Element, ModelMetadata, PointOptions, Points, Radii, read_model,
};

use crate::Told as _;

fn save(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

#[track_caller]
fn read(path: &Path) -> (Points, ModelMetadata) {
    let options = PointOptions::default().radii(Some(Radii::None));
    read_model(path, &options).unwrap_or_else(|error| panic!("{}", error.told()))
}

/// Why a text is not read.
#[track_caller]
fn refused(name: &str, text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = save(folder.path(), name, text);
    let options = PointOptions::default().radii(Some(Radii::None));
    read_model(&path, &options).map(|(points, _)| points.len()).unwrap_err().told()
}

fn symbols(points: &Points) -> Vec<&'static str> {
    let atoms = &points.molecule.as_ref().expect("atoms").atoms;
    atoms.iter().map(|atom| atom.element.map_or("-", Element::symbol)).collect()
}

/// How many atoms of an element are at distances in a range from each atom of another, in a cell that repeats.
fn neighbours(
    points: &Points,
    cell: &Cell,
    [of, to]: [&str; 2],
    [low, high]: [f64; 2],
) -> Vec<usize> {
    let symbols = symbols(points);
    let shifts =
        (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k])));
    let shifts: Vec<[i32; 3]> = shifts.collect();
    let indices = |symbol: &str| (0..points.len()).filter(|&i| symbols[i] == symbol).collect();
    let (from, others): (Vec<usize>, Vec<usize>) = (indices(of), indices(to));
    let near = |&i: &usize| {
        let ways = others.iter().flat_map(|&j| shifts.iter().map(move |shift| (j, shift)));
        ways.filter(|&(j, shift)| {
            let way = [0, 1, 2].map(|axis| {
                let moved: f64 = (0..3).map(|k| f64::from(shift[k]) * cell.vectors[k][axis]).sum();
                points.positions[j][axis] + moved - points.positions[i][axis]
            });
            let distance = way.iter().map(|x| x * x).sum::<f64>().sqrt();
            distance >= low && distance <= high
        })
        .count()
    };
    from.iter().map(near).collect()
}

#[track_caller]
fn assert_near(found: &[[f64; 3]], expected: &[[f64; 3]], most: f64) {
    assert_eq!(found.len(), expected.len());
    for (one, other) in found.iter().zip(expected) {
        let off = (0..3).map(|k| (one[k] - other[k]).abs()).fold(0.0, f64::max);
        assert!(off <= most, "{one:?}, not {other:?}");
    }
}

/// α-quartz (Levien, Prewitt & Weidner 1980), as databases write it: comments, uncertainties, quotes, and values that are missing.
const QUARTZ: &str = "#----\n# a database says much first\n#----\ndata_9000775
_chemical_name_mineral Quartz
_journal_paper_doi ?
_publ_section_title
;
 Structure; a text
_atom_of_no_tag
;
_cell_length_a 4.916(1)
_cell_length_b 4.916
_cell_length_c 5.4054(4)
_cell_angle_alpha 90
_cell_angle_beta 90.000
_cell_angle_gamma 120
_symmetry_space_group_name_H-M 'P 32 2 1'
loop_
_space_group_symop_id
_space_group_symop_operation_xyz
1 x,y,z
2 y,x,-z
3 -y,x-y,2/3+z
4 '-x, -x+y, 2/3-z'
5 \"-X+Y,-X,1/3+Z\"
6 x-y,-y,.3333333333-z
loop_
_atom_site_label
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
_atom_site_occupancy
_atom_site_U_iso_or_equiv
Si 0.46970(10) 0.00000 0.66667 1 . # on an axis
O1 0.41350 0.26690(3) 0.78580 1.000 0.01
loop_
_atom_site_aniso_label
_atom_site_aniso_U_11
Si 0.01
";

#[test]
fn all_atoms_of_a_crystal_are_those_of_its_operations() {
    let folder = tempfile::tempdir().unwrap();
    let (points, metadata) = read(&save(folder.path(), "quartz.cif", QUARTZ));
    let cell = metadata.cell.expect("a cell");
    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
    assert_eq!(symbols(&points), ["Si", "Si", "Si", "O", "O", "O", "O", "O", "O"]);
    // a along x, b in the plane of x and y.
    let [a, b, c] = cell.vectors;
    assert_eq!((a, b[2], cell.repeats), ([4.916, 0.0, 0.0], 0.0, [true; 3]));
    assert_near(&[b, c], &[[-2.458, 4.257_381, 0.0], [0.0, 0.0, 5.4054]], 1e-6);
    // Each silicon has four oxygens at 1.61 Å, each oxygen two silicons.
    assert_eq!(neighbours(&points, &cell, ["Si", "O"], [1.59, 1.63]), [4; 3]);
    assert_eq!(neighbours(&points, &cell, ["O", "Si"], [1.59, 1.63]), [2; 6]);
    assert_eq!(neighbours(&points, &cell, ["Si", "O"], [0.0, 1.59]), [0; 3]);
    // By ASE 3.29.
    let of_ase = [[2.309_045, 0.0, 3.603_618], [2.458 - 1.303_478, 1.999_692, 1.801_782]];
    assert_near(&points.positions[..1], &of_ase[..1], 1e-3);
    // The atom's radius is Bondi's, and all may repeat.
    let path = folder.path().join("quartz.cif");
    let (points, _) = read_model(&path, &PointOptions::default()).unwrap();
    assert_eq!(points.weights.as_deref().map(|weights| weights[0]), Some(2.1 * 2.1));
}

/// Operations of diamond, F d -3 m in its first setting: those that move (x, x, x) to eight places, and all centrings.
fn diamond(tags: &str, site: &str) -> String {
    let signs = ["x,y,z", "-x,-y,z", "-x,y,-z", "x,-y,-z"];
    let mut operations = String::new();
    for shift in [[0, 0, 0], [0, 2, 2], [2, 0, 2], [2, 2, 0]] {
        for sign in signs {
            for inverted in [false, true] {
                let part = |(k, part): (usize, &str)| {
                    let (part, quarter) = match (inverted, part.strip_prefix('-')) {
                        (false, _) => (part.to_owned(), 0),
                        (true, Some(bare)) => (bare.to_owned(), 1),
                        (true, None) => (format!("-{part}"), 1),
                    };
                    format!("{part}+{}/4", shift[k] + quarter)
                };
                let text: Vec<String> = sign.split(',').enumerate().map(part).collect();
                operations += &format!("'{}'\n", text.join(","));
            }
        }
    }
    format!(
        "data_diamond\n_cell_length_a 3.567\n_cell_length_b 3.567\n_cell_length_c 3.567\n_symmetry_Int_Tables_number 227\nloop_\n\
         _symmetry_equiv_pos_as_xyz\n{operations}loop_\n{tags}{site}"
    )
}

const TAGS: &str = "_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n";

#[test]
fn special_places_are_taken_once() {
    let folder = tempfile::tempdir().unwrap();
    // Angles that are not stated are right ones.
    let (points, metadata) = read(&save(folder.path(), "a.cif", &diamond(TAGS, "C 0 0 0\n")));
    let cell = metadata.cell.unwrap();
    assert_eq!(cell.sides(), Some([3.567; 3]));
    assert_eq!(neighbours(&points, &cell, ["C", "C"], [1.54, 1.55]), [4; 8]);
    // Three digits, outside of the cell, and just beyond its sides.
    for site in ["C 1.0 -3 0\n", "C 0.001 0.999 1.0005\n", "C -0.0001 0 0\n"] {
        let (points, _) = read(&save(folder.path(), "a.cif", &diamond(TAGS, site)));
        assert_eq!(points.len(), 8, "{site}");
    }
    // A general place has all 32 images.
    let (points, _) = read(&save(folder.path(), "a.cif", &diamond(TAGS, "C .1 .17 .29\n")));
    assert_eq!(points.len(), 32);
    assert!(points.positions.iter().flatten().all(|x| (0.0..3.567).contains(x)));
}

#[test]
fn the_first_block_with_atoms_is_read_and_what_is_left_out_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let cell = "_cell_length_a 10\n_cell_length_b 11\n_cell_length_c 12\n";
    let tags =
        format!("{TAGS}_atom_site_type_symbol\n_atom_site_calc_flag\n_atom_site_disorder_group\n");
    let rows = "X1 0.1 0.2 0.3 Zn2+ d .\nO1 .5 .5 .5 ? d 2\nH1 ? ? ? H d .\nQ1 0 0 0 C dum .\n";
    let text = format!(
        "data_global\n_audit_creation_method x\ndata_one\nloop_\n{tags}{rows}{cell}_symmetry_space_group_name_H-M P1\n\
         data_two\n{cell}loop_\n{TAGS}C1 0 0 0\n"
    );
    let (points, metadata) = read(&save(folder.path(), "a.cif", &text));
    assert_eq!(symbols(&points), ["Zn", "O"]);
    assert_near(&points.positions, &[[1.0, 2.2, 3.6], [5.0, 5.5, 6.0]], 1e-12);
    assert_eq!(metadata.cell.unwrap().sides(), Some([10.0, 11.0, 12.0]));
    let atoms = points.molecule.unwrap().atoms;
    assert_eq!(&*atoms[0].name, "X1");
    // All atoms are read, so that they cannot be chosen.
    let hydrogens = PointOptions::default().atoms(AtomSelection::default().hydrogens(true));
    let error = read_model(folder.path().join("a.cif"), &hydrogens).unwrap_err().told();
    assert!(error.contains("of which all atoms are read; omit `hydrogens`"), "{error}");
    // An atom outside of a loop.
    let text = format!(
        "data_x\n{cell}_atom_site_label Ar1\n_atom_site_fract_x 0.5\n_atom_site_fract_y 0.5\n_atom_site_fract_z 1.5\n"
    );
    let (points, _) = read(&save(folder.path(), "b.cif", &text));
    assert_eq!(
        (points.positions, symbols(&read(&folder.path().join("b.cif")).0)),
        (vec![[5.0, 5.5, 6.0]], vec!["Ar"])
    );
}

#[test]
fn wrong_crystals_are_errors() {
    let with = |old: &str, new: &str| {
        assert!(QUARTZ.contains(old), "{old}");
        refused("a.cif", &QUARTZ.replace(old, new))
    };
    let (operations, _) = QUARTZ.split_once("loop_\n_space_group_symop_id").unwrap();
    let (_, atoms) = QUARTZ.split_once("1/3+Z\"\n6 x-y,-y,.3333333333-z\n").unwrap();
    for (error, words) in [
        (
            refused("a.cif", &format!("{operations}{atoms}")),
            "states the space group \"P 32 2 1\", and does not list its symmetry operations",
        ),
        (with("y,x,-z", "y,x,-w"), "line 23 has \"y,x,-w\" as a symmetry operation"),
        (with("y,x,-z", "x,x,z"), "which is not three sums of x, y, z"),
        (with("0.26690(3)", "0.266x"), "line 36 has \"0.266x\" as y, which is not a number"),
        (with("_atom_site_fract_y\n", "_atom_site_other\n"), "without _atom_site_fract_y"),
        (with("_atom_site_fract_y\n", "_atom_site_fract_x\n"), "_atom_site_fract_x twice"),
        (with("_cell_length_b 4.916\n", ""), "without its _cell_length_b"),
        (with("_cell_length_c 5.4054(4)", "_cell_length_c zero"), "line 14 has \"zero\""),
        (with("gamma 120", "gamma 190"), "which no three vectors have"),
        (with("_cell_length_b 4.916\n", "_cell_length_b -4\n"), "which no three vectors have"),
        (with(" 1.000 0.01\n", " 1.000\n"), "comes behind 5 of 6 values in the last row"),
        (with("1 x,y,z\n", "1 x, y, z\n"), "has \"x,\" as a symmetry operation"),
        (
            refused("a.cif", &QUARTZ.replace("_atom_site_fract_", "_atom_site_Cartn_")),
            "without fractions of a unit cell",
        ),
        (
            refused(
                "a.cif",
                &format!(
                    "data_x\n_cell_length_a 1\nloop_\n{TAGS}C ? ? ?\n_cell_length_b 1\n_cell_length_c 1\n"
                ),
            ),
            "has no atom with coordinates",
        ),
    ] {
        assert!(error.contains(words), "{error}\nlacks {words}");
    }
}

#[test]
fn symmetries_are_told_by_whatever_states_them() {
    let of = |symmetry: &str| {
        format!(
            "data_x\n_cell_length_a 5\n_cell_length_b 6\n_cell_length_c 7\n{symmetry}\nloop_ {}C 0.1 0.2 0.3\n",
            TAGS.replace('\n', " ")
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let count = |symmetry| read(&save(folder.path(), "a.cif", &of(symmetry))).0.len();
    assert_eq!(count("_space_group_name_H-M_alt 'P 1'"), 1);
    assert_eq!(count("loop_\n_space_group_symop.operation_xyz\nx,y,z\n-x,-y,-z"), 2);
    for (symmetry, words) in [
        ("_space_group.name_H-M_alt 'P n m a'", "states the space group \"P n m a\""),
        ("_space_group_name_H-M_full 'P -1'", "states the space group \"P -1\""),
        ("loop_\n_symmetry.space_group_name_H-M\n'P -1'", "states the space group \"P -1\""),
        ("_symmetry_space_group_name_H-M 'P 1'\n_space_group_IT_number 62", "group \"62\""),
        (
            "loop_\n_space_group_symop_magn_operation.xyz\nx,y,z,+1\n-x,y,z,-1",
            "of a magnetic or modulated structure (_space_group_symop_magn_operation.xyz)",
        ),
        (
            "_space_group_symop_ssg_operation_algebraic x1,x2,x3,x4",
            "of a magnetic or modulated structure",
        ),
    ] {
        let error = refused("a.cif", &of(symmetry));
        assert!(error.contains(words), "{error}\nlacks {words}");
    }
    // In the archive's dictionary symmetries leave a part of the cell.
    let atom = "_atom_site.type_symbol C\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\n";
    let cell = |side: u32, symmetry: &str| {
        let sides = ["a", "b", "c"].map(|axis| format!("_cell.length_{axis} {side}\n"));
        let angles = ["alpha", "beta", "gamma"].map(|angle| format!("_cell.angle_{angle} 90\n"));
        format!("{}{}{symmetry}\n", sides.concat(), angles.concat())
    };
    let of = |text: String| {
        let (_, metadata) = read(&save(folder.path(), "a.cif", &text));
        metadata.cell.map(|cell| cell.sides().unwrap()[0])
    };
    let archive = |symmetry| of(format!("data_x\n{}{atom}", cell(5, symmetry)));
    assert_eq!(archive("_symmetry.space_group_name_H-M 'P 1'"), Some(5.0));
    assert_eq!(archive("_symmetry.Int_Tables_number 19"), None);
    assert_eq!(archive("_space_group.name_Hall 'P 2ac 2ab'"), None);
    let looped = "loop_\n_symmetry.entry_id\n_symmetry.space_group_name_H-M\nX 'P 21 21 21'";
    assert_eq!(archive(looped), None);
    // Another block has another cell.
    let (first, second) = (cell(5, "_symmetry.Int_Tables_number 1"), cell(9, ""));
    assert_eq!(of(format!("data_x\n{first}{atom}data_y\n{second}")), Some(5.0));
    assert_eq!(of(format!("data_y\n{second}data_x\n{first}{atom}")), Some(5.0));
    // A text is no tag.
    let title = format!("data_x\n_struct.title\n;\n_atom_site_fract_x\n;\n{first}{atom}");
    assert_eq!(of(title), Some(5.0));
}

#[test]
fn directions_of_extended_xyz_are_three_or_one_for_all() {
    let text = |pbc: &str| {
        format!(
            "1\nLattice=\"5 0 0 0 6 0 0 0 7\" Properties=species:S:1:pos:R:3 pbc={pbc}\nC 0 0 0\n"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    for (pbc, repeats) in [
        ("\"T T F\"", Some([true, true, false])),
        ("F", None),
        ("T", Some([true; 3])),
        ("\"[True, False, True]\"", Some([true, false, true])),
        ("[F, F, F]", None),
    ] {
        let (_, metadata) = read(&save(folder.path(), "a.xyz", &text(pbc)));
        assert_eq!(metadata.cell.map(|cell| cell.repeats), repeats, "{pbc}");
    }
    for pbc in ["TTF", "\"T T\"", "\"\""] {
        let error = refused("a.xyz", &text(pbc));
        assert!(error.contains("which is not three times T or F"), "{error}");
    }
}

/// Two waters and a residue in a slanted box.
const GRO: &str = "Slanted
    4
    1SOL     OW    1   0.230   0.629   0.113  0.1000  0.2000  0.3000
    1SOL    HW1    2   0.137   0.626   0.150
    2ALA     CA    3  -1.000   2.345   3.210
    2ALA    HA1    4   9.999   0.001   0.000
   2.00000   3.00000   4.00000   0.00000   0.00000   0.50000   0.00000  -0.25000   1.00000
";

#[test]
fn gro_is_read_in_angstroms() {
    let folder = tempfile::tempdir().unwrap();
    let path = save(folder.path(), "a.gro", GRO);
    let all = AtomSelection::default().hydrogens(true).waters(true);
    let (points, metadata) =
        read_model(&path, &PointOptions::default().atoms(all.clone())).unwrap();
    // Exactly as decimals.
    assert_eq!(
        points.positions,
        [[2.3, 6.29, 1.13], [1.37, 6.26, 1.5], [-10.0, 23.45, 32.1], [99.99, 0.01, 0.0]]
    );
    assert_eq!(symbols(&points), ["O", "H", "C", "H"]);
    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
    let vectors = [[20.0, 0.0, 0.0], [5.0, 30.0, 0.0], [-2.5, 10.0, 40.0]];
    assert_eq!(metadata.cell, Some(Cell { vectors, repeats: [true; 3] }));
    let (points, _) = read_model(&path, &PointOptions::default()).unwrap();
    assert_eq!(points.positions, [[-10.0, 23.45, 32.1]]);
    let said = points.molecule.unwrap().summary().to_string();
    assert_eq!(said, "1 atom: protein; left out: 1 water (`waters`), 1 hydrogen (`hydrogens`)");
    // More digits have wider columns. A second frame is the one that is asked for. A box of zeros is none.
    let precise = "t\n1\n    1ALA     CA    1   0.23012   0.62834   0.11356\n 0 0 0\n";
    let path =
        save(folder.path(), "b.gro", &format!("{precise}{}", precise.replace("0.23", "1.23")));
    let (points, metadata) = read(&path);
    assert_eq!((points.positions, metadata.cell), (vec![[2.3012, 6.2834, 1.1356]], None));
    let second = PointOptions::default().frame(Some(1));
    assert_eq!(read_model(&path, &second).unwrap().0.positions, [[12.3012, 6.2834, 1.1356]]);
    let third = read_model(&path, &PointOptions::default().frame(Some(2))).unwrap_err().told();
    assert!(third.contains("has no frame 2: it holds 2"), "{third}");
    for (text, words) in [
        ("title\nmany\n".to_owned(), "has no number of atoms in line 2"),
        (GRO.replace("    4\n", "    6\n"), "claims 6 atoms and a box in line 2"),
        (
            GRO.replace("    4\n", "    3\n"),
            "line 6 has \"2ALA    HA1    4   9.999   0.001   0.000\" as the box",
        ),
        (GRO.replace("2.345", "2.3x5"), "line 5 has \"2.3x5\" as y, in columns 29 to 36"),
        (GRO.replace("    2ALA     CA", "  xy2ALA     CA"), "as the number of a residue"),
        (GRO.replace("4.00000", "four"), "as the box, which is not three or nine numbers"),
        (GRO.replace("   0.230", "\t0.230"), "line 3 has a tab"),
        (GRO.replace("    4\n", "    18446744073709551615\n"), "claims 18446744073709551615 atoms"),
    ] {
        let error = refused("a.gro", &text);
        assert!(error.contains(words), "{error}\nlacks {words}");
    }
}

/// Three atoms in a tilted box whose corner is not the origin.
const DATA: &str = "LAMMPS data file via write_data, version 1, timestep = 0, units = real

3 atoms
2 atom types
1 bonds

-1.0 9.0 xlo xhi
2.0 10.0 ylo yhi
0.0 6.0 zlo zhi
3.0 -2.0 1.0 xy xz yz

Masses

1 28.0855 # Si
2 15.9994

Pair Coeffs # zero

1
2

Atoms # full

1 1 1 0.5 -1.0 2.0 0.0 0 0 0
3 1 2 -0.25 0.5 7.0 3.0 0 0 1
2 1 2 -0.25 20.0 5.0 -3.0 0 0 0

Velocities

1 0 0 0
";

/// The same, as a dump of parts of the box.
const DUMP: &str = "ITEM: UNITS
real
ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
3
ITEM: BOX BOUNDS xy xz yz pp pp ff
-3.0 12.0 3.0
2.0 11.0 -2.0
0.0 6.0 1.0
ITEM: ATOMS id type mass q zs ys xs
1 1 28.0855 0.5 0 0 0
3 2 15.9994 -0.25 0.5 0.5625 0.08125
2 2 15.9994 -0.25 -0.5 0.4375 1.86875
";

#[test]
fn tilted_boxes_of_lammps_are_the_same_in_both_formats() {
    let folder = tempfile::tempdir().unwrap();
    let (points, metadata) = read(&save(folder.path(), "data.peptide", DATA));
    let vectors = [[10.0, 0.0, 0.0], [3.0, 8.0, 0.0], [-2.0, 1.0, 6.0]];
    assert_eq!(metadata.cell, Some(Cell { vectors, repeats: [true; 3] }));
    assert_eq!(points.positions, [[-1.0, 2.0, 0.0], [0.5, 7.0, 3.0], [20.0, 5.0, -3.0]]);
    assert_eq!(symbols(&points), ["Si", "O", "O"]);
    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
    let (dumped, of_dump) = read(&save(folder.path(), "a.lammpstrj", DUMP));
    assert_eq!(of_dump.cell, Some(Cell { vectors, repeats: [true, true, false] }));
    assert_near(&dumped.positions, &points.positions, 1e-12);
    assert_eq!(symbols(&dumped), ["Si", "O", "O"]);
    for points in [points, dumped] {
        let charges = points.molecule.unwrap().atoms.into_iter().map(|atom| atom.charge.unwrap());
        assert_eq!(charges.collect::<Vec<f64>>(), [0.5, -0.25, -0.25]);
    }
    // Vectors in place of a tilt.
    let general = DATA
        .replace("-1.0 9.0 xlo xhi\n", "10 0 0 avec\n")
        .replace("2.0 10.0 ylo yhi\n", "3 8 0 bvec\n")
        .replace("0.0 6.0 zlo zhi\n", "-2 1 6 cvec\n")
        .replace("3.0 -2.0 1.0 xy xz yz\n", "-1 2 0 abc origin\n");
    let cell = read(&save(folder.path(), "b.lmp", &general)).1.cell;
    assert_eq!(cell, Some(Cell { vectors, repeats: [true; 3] }));
    let general = DUMP
        .replace("xy xz yz pp pp ff", "abc origin pp pp ff")
        .replace("-3.0 12.0 3.0\n", "10 0 0 -1\n")
        .replace("2.0 11.0 -2.0\n", "3 8 0 2\n")
        .replace("0.0 6.0 1.0\n", "-2 1 6 0\n");
    let (again, of_dump) = read(&save(folder.path(), "b.dump", &general));
    assert_eq!(of_dump.cell, Some(Cell { vectors, repeats: [true, true, false] }));
    assert_near(&again.positions, &[[-1.0, 2.0, 0.0], [0.5, 7.0, 3.0], [20.0, 5.0, -3.0]], 1e-12);
}

#[test]
fn styles_and_types_of_lammps_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let of = |text: &str| read(&save(folder.path(), "a.lmp", text));
    let rows = DATA.split_once("Atoms # full\n\n").unwrap().0;
    for (style, row, charge) in [
        ("Atoms # atomic", "1 1 4 5 6", None),
        ("Atoms", "1 1 4 5 6 0 0 0", None),
        ("Atoms # charge", "1 1 -0.5 4 5 6", Some(-0.5)),
        ("Atoms", "1 1 -0.5 4 5 6", Some(-0.5)),
        ("Atoms # molecular", "1 7 1 4 5 6", None),
        ("Atoms  # I like comments", "1 7 1 4 5 6 0 0 1", None),
        ("Atoms", "1 7 1 0.5 4 5 6", Some(0.5)),
    ] {
        let text = format!("{rows}{style}\n\n{row} # remark\n").replace("3 atoms", "1 atoms");
        let (points, _) = of(&text);
        assert_eq!(points.positions, [[4.0, 5.0, 6.0]], "{style}: {row}");
        assert_eq!(symbols(&points), ["Si"]);
        assert_eq!(points.molecule.unwrap().atoms[0].charge, charge, "{style}: {row}");
    }
    // Whole charges are not types in every row, and diameters in none.
    let two = |two: &str| format!("{rows}Atoms\n\n{two}").replace("3 atoms", "2 atoms");
    let (ions, _) = of(&two("1 1 2 4 5 6\n2 2 -2 7 5 6\n"));
    assert_eq!(symbols(&ions), ["Si", "O"]);
    let charges: Vec<_> = ions.molecule.unwrap().atoms.iter().map(|atom| atom.charge).collect();
    assert_eq!(charges, [Some(2.0), Some(-2.0)]);
    let balls = save(folder.path(), "b.lmp", &two("1 1 3 1.5 4 5 6\n2 2 1 1.5 7 5 6\n"));
    let (balls, _) = read_model(&balls, &PointOptions::default()).unwrap();
    assert_eq!(balls.weights, Some(vec![2.25, 0.25]));
    // Spheres have radii, and those of a potential no unit.
    let text = format!("{rows}Atoms # sphere\n\n1 1 3.0 1.0 4 5 6\n").replace("3 atoms", "1 atoms");
    let path = save(folder.path(), "b.lmp", &text.replace("real", "lj"));
    let (points, metadata) = read_model(&path, &PointOptions::default()).unwrap();
    assert_eq!((points.weights, points.of_radii), (Some(vec![2.25]), true));
    assert_eq!(metadata.coordinates.unit.symbol(), "unit");
    // Of a dump, too.
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n\
                ITEM: ATOMS id type x y z diameter\n1 1 4 5 6 3\n";
    let (points, _) =
        read_model(save(folder.path(), "b.lammpstrj", dump), &PointOptions::default()).unwrap();
    assert_eq!((points.weights, points.of_radii), (Some(vec![2.25]), true));
    // Nanometres and nanometre-long vectors.
    let (points, metadata) = of(&text.replace("real", "nano"));
    assert_eq!(points.positions, [[40.0, 50.0, 60.0]]);
    assert_eq!(metadata.cell.unwrap().vectors[1], [30.0, 80.0, 0.0]);
    // Labels of types, and masses that are those of no element.
    let labelled = DATA
        .replace(
            "Masses\n\n1 28.0855 # Si\n2 15.9994",
            "Atom Type Labels\n\n1 Ti\n2 Xy\n\nMasses\n\nTi 1.0\nXy 1.0 # O of oxide",
        )
        .replace("\n2 1 2 ", "\n2 1 Xy ");
    let (points, _) = of(&labelled);
    assert_eq!(symbols(&points), ["Ti", "O", "O"]);
    // Without elements they are points, and of no molecule.
    let bare = DATA.replace("28.0855 # Si", "1").replace("15.9994", "1");
    let (points, metadata) =
        read_model(save(folder.path(), "c.lmp", &bare), &PointOptions::default()).unwrap();
    assert_eq!((points.len(), points.molecule, points.weights), (3, None, None));
    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
}

#[test]
fn wrong_files_of_lammps_are_errors() {
    let data = |old: &str, new: &str| refused("a.lmp", &DATA.replacen(old, new, 1));
    let dump = |old: &str, new: &str| refused("a.dump", &DUMP.replacen(old, new, 1));
    for (error, words) in [
        (data("3 atoms\n", ""), "has no line with the number of atoms"),
        (data("3 atoms\n", "4 atoms\n"), "claims 4 atoms, but has 3"),
        (data("3 atoms\n", "2 atoms\n"), "claims 2 atoms, but has 3; correct the count"),
        (data("2.0 10.0 ylo yhi\n", ""), "states no box"),
        (data("2.0 10.0 ylo", "12.0 10.0 ylo"), "states a box without volume"),
        (data("2.0 10.0 ylo", "2.0 y ylo"), "line 8 has \"y\" as a bound of the box"),
        (data("# full", "# ellipsoid"), "has atoms of the style ellipsoid"),
        (data("7.0 3.0", "7.0 3.0x"), "line 25 has \"3.0x\" as z, which is not a number"),
        (data("7.0 3.0 0", "7.0 3.0"), "line 25 has 9 fields, not 7 as atoms of the style full"),
        (
            data("Atoms # full\n\n1 1 1 0.5", "Atoms\n\n1 1 1 1 1 1"),
            "line 24 has 12 fields, and the file does not",
        ),
        (dump("TIMESTEP", "STEP"), "has no ITEM: TIMESTEP"),
        (dump("ITEM: NUMBER OF ATOMS\n3\n", ""), "has no ITEM: NUMBER OF ATOMS"),
        (dump("ATOMS\n3\n", "ATOMS\n4\n"), "claims 4 atoms, but has 3"),
        (dump("2.0 11.0 -2.0\n", "2.0 11.0\n"), "line 9 is not one of three lines of 3 bounds"),
        (dump("2.0 11.0 -2.0\n", "2.0 1.0 -2.0\n"), "bounds of a box without volume"),
        (dump("zs ys xs", "z y xs"), "line 11 has no columns x y z"),
        (dump("0.5 0 0 0\n", "0.5 0 0\n"), "line 12 has 6 fields, not 7"),
        (dump("real", "unreal"), "has units \"unreal\""),
    ] {
        assert!(error.contains(words), "{error}\nlacks {words}");
    }
}

#[test]
fn a_frame_of_a_dump_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let (_, frame) = DUMP.split_once("real\n").unwrap();
    let text = format!(
        "{frame}{}",
        frame.replace("ATOMS id type mass q zs ys xs", "ATOMS id type mass q x y z")
    );
    let path = save(folder.path(), "a.txt", &text);
    let of = |frame| {
        let options = PointOptions::default().radii(Some(Radii::None)).frame(frame);
        read_model(&path, &options).map(|(points, _)| points.positions)
    };
    assert_eq!(of(None).unwrap()[0], [-1.0, 2.0, 0.0]);
    assert_eq!(of(Some(1)).unwrap()[0], [0.0; 3]);
    assert!(of(Some(2)).unwrap_err().told().contains("has no frame 2: it holds 2"));
}

const POSCAR: &str = "quartz, or so
 2.0
 1.0 0.0 0.0
 -0.5 1.0 0.0
 0.0 0.0 2.0
 Si_pv O
 1 2
Selective dynamics
Direct
 0.5 0.0 0.25 T T F
 0.0 0.5 0.5 T T F
 -0.5 1.5 0.0 T T F

 0.0 0.0 0.0
";

#[test]
fn poscar_has_a_scale_and_names() {
    let folder = tempfile::tempdir().unwrap();
    let (points, metadata) = read(&save(folder.path(), "POSCAR", POSCAR));
    let vectors = [[2.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 4.0]];
    assert_eq!(metadata.cell, Some(Cell { vectors, repeats: [true; 3] }));
    assert_eq!(points.positions, [[1.0, 0.0, 1.0], [-0.5, 1.0, 2.0], [-2.5, 3.0, 0.0]]);
    assert_eq!(symbols(&points), ["Si", "O", "O"]);
    // Places, of a cell of 16 Å³.
    let text = POSCAR.replace("Direct", "cartesian").replace(" 2.0\n 1.0", " -16\n 1.0");
    let (points, metadata) = read(&save(folder.path(), "a.vasp", &text));
    assert_near(&metadata.cell.unwrap().vectors, &vectors, 1e-12);
    assert_near(&points.positions[..1], &[[1.0, 0.0, 0.5]], 1e-12);
    for (old, new, words) in [
        (" 2.0\n 1.0", " two\n 1.0", "line 2 has \"two\" as a scale"),
        ("-0.5 1.0 0.0", "2.0 0.0 0.0", "states a cell without volume"),
        (" 1 2\n", " 1\n", "line 7 has 1 numbers of atoms for 2 names"),
        (" 1 2\n", " 1 x\n", "line 7 has \"x\" as a number of atoms"),
        (" 1 2\n", " 1 5\n", "line 13 has 0 words, not three numbers"),
        (" 1 2\n", " 1 4000000000000000000\n", "line 13 has 0 words"),
        (" 0.0 0.5 0.5 T", " 0.0 0.5 half T", "line 11 has \"half\" as a coordinate"),
        (" 1 2\n", " 0 0\n", "has no number of atoms above 0"),
    ] {
        let error = refused("a.vasp", &POSCAR.replace(old, new));
        assert!(error.contains(words), "{error}\nlacks {words}");
    }
    assert!(refused("a.vasp", "t\n1\n").contains("ends behind line 2: it is truncated"));
}
