//! Molecules: which atoms are read, their radii, and the sample.

use std::path::{Path, PathBuf};

use walpha_points::{
    AtomSelection, Models, Molecule, PointOptions, Points, PointsError, Radii, is_point_file,
    read_model,
};

use crate::Told as _;

/// A record, a name in four columns, an alternate place, a residue, its chain, number and insertion code, and an element.
type Record = (&'static str, &'static str, char, &'static str, char, i32, char, &'static str);

/// A file of PDB. The x of an atom is its index.
fn pdb(atoms: &[Record]) -> String {
    let line = |(index, atom): (usize, &Record)| {
        let (record, name, place, residue, chain, number, code, element) = *atom;
        format!(
            "{record:6}{index:5} {name:4}{place}{residue:>3} {chain}{number:4}{code}   {:8.3}{:8.3}{:8.3}  1.00  0.00          \
             {element:>2}\n",
            index as f64, 0.0, 0.0
        )
    };
    atoms.iter().enumerate().map(line).collect::<String>() + "END\n"
}

/// Two chains, with everything that is left out.
fn complex() -> String {
    pdb(&[
        ("ATOM", " N  ", ' ', "SER", 'A', 1, ' ', "N"),
        ("ATOM", " H  ", ' ', "SER", 'A', 1, ' ', "H"),
        // The first label of each residue is taken, whichever it is.
        ("ATOM", " CB ", 'B', "SER", 'A', 1, ' ', "C"),
        ("ATOM", " CB ", 'A', "SER", 'A', 1, ' ', "C"),
        ("ATOM", " OG ", 'A', "SER", 'A', 1, ' ', "O"),
        ("ATOM", " OG ", 'B', "SER", 'A', 1, ' ', "O"),
        ("ATOM", " CB ", 'C', "SER", 'A', 1, 'X', "C"),
        // Two residues at one place.
        ("ATOM", " CA ", 'A', "SER", 'A', 2, ' ', "C"),
        ("ATOM", " CA ", 'B', "THR", 'A', 2, ' ', "C"),
        ("ATOM", " P  ", ' ', " DA", 'B', 1, ' ', "P"),
        ("ATOM", " OW ", ' ', "SOL", 'B', 2, ' ', "O"),
        ("HETATM", "ZN  ", ' ', " ZN", 'A', 9, ' ', "ZN"),
        ("HETATM", "ZN  ", ' ', " ZN", 'A', 10, ' ', "ZN"),
        ("HETATM", " C1 ", ' ', "NAG", 'A', 11, ' ', "C"),
        ("HETATM", " O1 ", ' ', "NAG", 'A', 11, ' ', "O"),
        ("HETATM", " O  ", ' ', "HOH", 'A', 12, ' ', "O"),
        ("HETATM", " D1 ", ' ', "HOH", 'A', 12, ' ', "D"),
    ])
}

fn save(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn read(path: &Path, options: &PointOptions) -> Result<(Points, Molecule), PointsError> {
    let (mut points, _) = read_model(path, options)?;
    let molecule = points.molecule.take().expect("atoms");
    Ok((points, molecule))
}

/// The indices of the atoms that are read, and what is said about them.
#[track_caller]
fn taken(path: &Path, selection: AtomSelection) -> (Vec<usize>, String) {
    let (points, molecule) = read(path, &PointOptions::default().atoms(selection)).unwrap();
    assert_eq!(points.len(), molecule.atoms.len());
    (
        points.positions.iter().map(|place| place[0] as usize).collect(),
        molecule.summary().to_string(),
    )
}

fn refused(path: &Path, options: &PointOptions) -> String {
    read(path, options).unwrap_err().told()
}

#[test]
fn the_heavy_atoms_of_polymers_are_taken_and_others_by_options() {
    let folder = tempfile::tempdir().unwrap();
    let path = save(folder.path(), "a.pdb", &complex());
    let all = AtomSelection::default();
    let (atoms, said) = taken(&path, all.clone());
    assert_eq!(atoms, [0, 2, 5, 6, 7, 9]);
    assert_eq!(
        said,
        "6 atoms: protein and nucleic acid of chains A, B; left out: 2 waters (`waters`), 3 ligands (2 ZN, NAG) \
         (`hetero`), 1 hydrogen (`hydrogens`), 3 alternate places"
    );
    assert_eq!(taken(&path, all.clone().hydrogens(true)).0, [0, 1, 2, 5, 6, 7, 9]);
    let (atoms, said) = taken(&path, all.clone().hetero(true));
    assert_eq!(atoms, [0, 2, 5, 6, 7, 9, 11, 12, 13, 14]);
    assert!(
        said.starts_with(
            "10 atoms: protein and nucleic acid of chains A, B, 3 ligands (2 ZN, NAG); left"
        ),
        "{said}"
    );
    // Hydrogens of water are not waters.
    let (atoms, said) = taken(&path, all.clone().waters(true));
    assert_eq!(atoms, [0, 2, 5, 6, 7, 9, 10, 15]);
    assert!(said.contains(", 2 waters; left out: 3 ligands"), "{said}");
    assert!(said.contains("2 hydrogens (`hydrogens`)"), "{said}");
    let (atoms, said) = taken(&path, all.clone().chains(Some(vec!["B".into()])));
    assert_eq!((atoms, said), (vec![9], "1 atom: nucleic acid of chain B; left out: 1 water (`waters`), 15 atoms of other chains (`chains`)".into()));
    let everything = all.hydrogens(true).waters(true).hetero(true).models(Some(Models::All));
    assert_eq!(taken(&path, everything).0.len(), 14);
}

#[test]
fn models_are_chosen_by_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let atom = |x: f64| {
        format!("ATOM      1  CA  ALA A   1    {x:8.3}   0.000   0.000  1.00  0.00           C\n")
    };
    let text: String = [2, 5, 7]
        .iter()
        .map(|&k| format!("MODEL     {k:4}\n{}ENDMDL\n", atom(f64::from(k))))
        .collect();
    let path = save(folder.path(), "a.pdb", &text);
    let of = |models| taken(&path, AtomSelection::default().models(models));
    assert_eq!(of(None).0, [2]);
    assert_eq!(of(Some(Models::One(7))).0, [7]);
    assert_eq!(of(Some(Models::All)), (vec![2, 5, 7], "3 atoms: protein of chain A".into()));
    assert!(of(None).1.ends_with("left out: 2 atoms of other models (`models`)"));
    let options =
        PointOptions::default().atoms(AtomSelection::default().models(Some(Models::One(1))));
    let error = refused(&path, &options);
    assert!(error.contains("has no model 1; give `models` all, or one of 2, 5, 7"), "{error}");
    // Labels of one model have nothing to do with those of another.
    let labelled = |place: char, x: f64| atom(x).replace(" CA  ALA", &format!(" CA {place}ALA"));
    let text = format!(
        "MODEL        1\n{}ENDMDL\nMODEL        2\n{}ENDMDL\n",
        labelled('A', 1.0),
        labelled('B', 2.0)
    );
    let path = save(folder.path(), "b.pdb", &text);
    assert_eq!(taken(&path, AtomSelection::default().models(Some(Models::All))).0, [1, 2]);
}

#[test]
fn each_model_has_its_cell_and_number() {
    let folder = tempfile::tempdir().unwrap();
    let atom = |x: f64| {
        format!("ATOM      1  CA  ALA A   1    {x:8.3}   0.000   0.000  1.00  0.00           C\n")
    };
    let frame = |model: u32, side: f64| {
        format!(
            "CRYST1{side:9.3}{side:9.3}{side:9.3}  90.00  90.00  90.00 P 1           1\nMODEL     {model:4}\n{}ENDMDL\n",
            atom(side)
        )
    };
    let of = |text: &str, models| {
        let path = save(folder.path(), "a.pdb", text);
        let options = PointOptions::default().atoms(AtomSelection::default().models(models));
        let (points, metadata) = read_model(&path, &options).unwrap();
        let xs: Vec<f64> = points.positions.iter().map(|place| place[0]).collect();
        (xs, metadata.cell.unwrap().sides().unwrap()[0])
    };
    // Trajectories state the box of each frame.
    let trajectory = frame(1, 3.0) + &frame(2, 30.0);
    assert_eq!(of(&trajectory, None), (vec![3.0], 3.0));
    assert_eq!(of(&trajectory, Some(Models::One(2))), (vec![30.0], 30.0));
    // Models of one number are several.
    let alike = frame(1, 3.0) + &frame(1, 30.0);
    assert_eq!(of(&alike, None), (vec![3.0], 3.0));
    assert_eq!(of(&alike, Some(Models::One(2))), (vec![30.0], 30.0));
    // SCALE has fractions of a cell that lies otherwise, or as it does without.
    let scaled = |y: &str| {
        let scale = |k: u32, x: &str, y: &str| {
            format!("SCALE{k}    {x:>10}{y:>10}  0.000000        0.00000\n")
        };
        let (first, rest) =
            frame(1, 5.0).split_once('\n').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
        let text = format!(
            "{first}\n{}{}{rest}",
            scale(1, "0.200000", "0.000000"),
            scale(2, "0.000000", y)
        );
        let path = save(folder.path(), "s.pdb", &text);
        read_model(&path, &PointOptions::default()).unwrap().1.cell.is_some()
    };
    assert_eq!([scaled("0.200000"), scaled("0.100000")], [true, false]);
    // A cell behind the atoms is theirs.
    assert_eq!(of(&(atom(5.0) + frame(1, 7.0).lines().next().unwrap()), None), (vec![5.0], 7.0));
    // Those of PQR are numbered in order.
    let pqr = "MODEL 4\n  ATOM 1 C ALA A 1 0 0 0 0.5 1.9\nENDMDL\nMODEL 4\nATOM 1 C ALA A 1 9 0 0 0.5 1.9\nENDMDL\n";
    let pqr = save(folder.path(), "a.pqr", pqr);
    assert_eq!(taken(&pqr, AtomSelection::default()).0, [0]);
    assert_eq!(taken(&pqr, AtomSelection::default().models(Some(Models::One(2)))).0, [9]);
}

#[test]
fn each_atom_has_one_alternate_place() {
    let folder = tempfile::tempdir().unwrap();
    let of = |atoms: &[(&'static str, char, &'static str)]| {
        let record = |&(name, place, residue): &(&'static str, char, &'static str)| {
            ("ATOM", name, place, residue, 'A', 1, ' ', &name[1..2])
        };
        let records: Vec<Record> = atoms.iter().map(record).collect();
        let path = save(folder.path(), "a.pdb", &pdb(&records));
        taken(&path, AtomSelection::default()).0
    };
    // One without a label, and another one.
    let blank = [(" N  ", ' ', "SER"), (" CB ", ' ', "SER"), (" CB ", 'B', "SER")];
    assert_eq!(of(&blank), [0, 1]);
    assert_eq!(of(&[blank[0], blank[2], blank[1]]), [0, 2]);
    // Atoms with labels of their own.
    let sets =
        [(" CB ", 'A', "SER"), (" CB ", 'B', "SER"), (" OG ", 'C', "SER"), (" OG ", 'D', "SER")];
    assert_eq!(of(&sets), [0, 2]);
    // Another residue at the place has other atoms.
    let others = [(" CB ", 'A', "SER"), (" CB ", 'B', "THR"), (" OG1", 'B', "THR")];
    assert_eq!(of(&others), [0]);
}

#[test]
fn an_empty_selection_names_the_options_that_keep_atoms() {
    let folder = tempfile::tempdir().unwrap();
    let water = pdb(&[
        ("HETATM", " O  ", ' ', "HOH", 'A', 1, ' ', "O"),
        ("HETATM", "NA  ", ' ', " NA", 'A', 2, ' ', "NA"),
    ]);
    let path = save(folder.path(), "a.pdb", &water);
    let error = refused(&path, &PointOptions::default());
    assert!(error.contains("holds 2 atoms, and none is left: 1 water, 1 ligand (NA)"), "{error}");
    assert!(error.contains("give `waters` or `hetero` to take them"), "{error}");
    let path = save(folder.path(), "b.pdb", &complex());
    let chain = |name: &str| {
        PointOptions::default().atoms(AtomSelection::default().chains(Some(vec![name.into()])))
    };
    let error = refused(&path, &chain("C"));
    assert!(error.contains("has no chain \"C\"; give `chains` some of A, B"), "{error}");
    let unnamed =
        save(folder.path(), "c.pdb", &complex().replace(" A ", "   ").replace(" B ", "   "));
    assert!(refused(&unnamed, &chain("A")).contains("its chains have no names"));
}

#[test]
fn radii_are_those_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let path = save(
        f,
        "a.pdb",
        &pdb(&[
            ("ATOM", " CA ", ' ', "ALA", 'A', 1, ' ', "C"),
            ("ATOM", " CB ", ' ', "ALA", 'A', 1, ' ', "C"),
            ("ATOM", " C  ", ' ', "ALA", 'A', 1, ' ', "C"),
        ]),
    );
    let radii = |path: &Path, radii: Option<Radii>| {
        let (points, _) = read(path, &PointOptions::default().radii(radii)).unwrap();
        assert_eq!(points.of_radii, points.weights.is_some());
        points.weights
    };
    let squares = |radii: [f64; 3]| Some(radii.map(|r| r * r).to_vec());
    assert_eq!(radii(&path, None), squares([1.7; 3]));
    assert_eq!(radii(&path, Some(Radii::Bondi)), squares([1.7; 3]));
    assert_eq!(radii(&path, Some(Radii::ProtOr)), squares([1.88, 1.88, 1.61]));
    assert_eq!(radii(&path, Some(Radii::None)), None);
    let table = save(f, "table.txt", "C 1\n* CA 2\nALA CB 3\n");
    assert_eq!(radii(&path, Some(Radii::File(table))), squares([2.0, 3.0, 1.0]));
    let error = refused(&path, &PointOptions::default().radii(Some(Radii::Column)));
    assert!(error.contains("states no radii; give `radii` bondi, protor"), "{error}");
    let short = save(f, "short.txt", "N 1\n* CA 2\n");
    let error = refused(&path, &PointOptions::default().radii(Some(Radii::File(short))));
    assert!(
        error.contains("has 2 atoms whose radius") && error.contains("CB of ALA, C of ALA;"),
        "{error}"
    );
    let error =
        refused(&path, &PointOptions::default().radii(Some(Radii::File(f.join("none.txt")))));
    assert!(
        error.contains("none.txt")
            && error.contains("give `radii` bondi, protor, column, none or the path"),
        "{error}"
    );
    let bad = save(f, "bad.txt", "C 1\nC\n");
    let error = refused(&path, &PointOptions::default().radii(Some(Radii::File(bad))));
    assert!(error.contains("bad.txt: line 2: \"C\" is not a radius"), "{error}");

    let pqr = save(
        f,
        "a.pqr",
        "ATOM 1 C ALA 1 0 0 0 0.5 1.9\nATOM 2 CB ALA 1 1 0 0 0.5 2.0\nATOM 3 CA ALA 1 2 0 0 0.5 0\n",
    );
    assert_eq!(radii(&pqr, None), squares([1.9, 2.0, 0.0]));
    assert_eq!(radii(&pqr, Some(Radii::Column)), squares([1.9, 2.0, 0.0]));
    assert_eq!(radii(&pqr, Some(Radii::Bondi)), squares([1.7; 3]));
    let xyz = "3\nProperties=species:S:1:pos:R:3:radius:R:1\nC 0 0 0 1\nH 1 0 0 2\nO 2 0 0 3\n";
    let xyz = save(f, "a.xyz", xyz);
    assert_eq!(radii(&xyz, None), squares([1.0, 2.0, 3.0]));
    assert_eq!(radii(&xyz, Some(Radii::Column)), squares([1.0, 2.0, 3.0]));
    assert_eq!(radii(&xyz, Some(Radii::Bondi)), squares([1.7, 1.2, 1.52]));
    assert_eq!(radii(&xyz, Some(Radii::None)), None);
    // A weight that is not a radius stays, unless radii are asked for.
    let xyz = "3\nProperties=species:S:1:pos:R:3:weight:R:1\nC 0 0 0 1\nH 1 0 0 2\nO 2 0 0 3\n";
    let xyz = save(f, "b.xyz", xyz);
    let read_weights = read(&xyz, &PointOptions::default()).unwrap().0;
    assert_eq!((read_weights.weights, read_weights.of_radii), (Some(vec![1.0, 2.0, 3.0]), false));
    assert_eq!(radii(&xyz, Some(Radii::Bondi)), squares([1.7, 1.2, 1.52]));
    // Names that are not elements are known to a table.
    let labels = save(f, "c.xyz", "2\n\nA1 0 0 0\nB1 1 0 0\n");
    let table = save(f, "labels.txt", "* A1 1\n* B1 2\n");
    assert_eq!(radii(&labels, Some(Radii::File(table))), Some(vec![1.0, 4.0]));
    assert_eq!(read_model(&labels, &PointOptions::default()).unwrap().0.weights, None);
}

#[test]
fn settings_of_molecules_have_no_effect_on_other_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let csv = save(f, "a.csv", "x,y,z,radius\n0,0,0,1\n");
    let xyz = save(f, "a.xyz", "1\n\nC 0 0 0\n");
    let pqr = save(f, "a.pqr", "ATOM 1 C ALA A 1 0 0 0 0.5 1.9\n");
    let told = |path: &Path, options: PointOptions| read_model(path, &options).unwrap_err().told();
    let hydrogens = PointOptions::default().atoms(AtomSelection::default().hydrogens(true));
    let error = told(&csv, PointOptions::default().radii(Some(Radii::Bondi)));
    assert!(error.contains("has no atoms; omit `radii`"), "{error}");
    for path in [&xyz, &pqr] {
        let error = told(path, hydrogens.clone());
        assert!(error.contains("whose atoms are all read; omit `hydrogens`"), "{error}");
    }
    let chain =
        PointOptions::default().atoms(AtomSelection::default().chains(Some(vec!["A".into()])));
    assert_eq!(read_model(&pqr, &chain).unwrap().0.len(), 1);
    assert!(told(&xyz, chain).contains("omit `chains`"));
    let none = PointOptions::default().radii(Some(Radii::None));
    let (points, _) = read_model(&csv, &none).unwrap();
    assert_eq!((points.weights, points.of_radii), (None, false));
}

/// The name tells PDB from PQR, which begin alike; CIF is told by its content.
#[test]
fn formats_that_begin_alike_are_told_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let pdb = complex();
    let told = |path: &Path, format: Option<&str>| {
        let options = PointOptions::default().format(format.map(str::to_owned));
        read(path, &options).map(|(points, _)| points.len()).map_err(|error| error.told())
    };
    let text = save(f, "a.txt", &pdb);
    let error = told(&text, None).unwrap_err();
    assert!(error.contains("is a PDB or PQR file of a molecule; call it .pdb or .pqr"), "{error}");
    assert_eq!(told(&text, Some("pdb")), Ok(6));
    let pqr = "ATOM      1  C   ALA     1       0.000   0.000   0.000  0.500 1.900\n";
    assert_eq!(told(&save(f, "a.pqr", pqr), None), Ok(1));
    assert_eq!(told(&save(f, "b.txt", pqr), Some("pqr")), Ok(1));
    let cif = "data_x\n_atom_site.type_symbol C\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\n";
    assert_eq!(told(&save(f, "c.pdb", cif), None), Ok(1));
    assert!(told(&save(f, "d.cif", &pdb), None).unwrap_err().contains("PDB or PQR"));
    for name in ["a.pdb", "a.ENT", "a.cif", "a.mmcif", "a.pqr", "a.pdb.gz"] {
        let file = f.join(name);
        assert!(is_point_file(&file).unwrap() != name.ends_with("gz"), "{name}");
    }
}

/// Each atom keeps what the file says of it when others are left out.
#[test]
fn thinning_keeps_atoms_beside_their_points() {
    let options = PointOptions::default().thin(Some(3.0));
    let (points, molecule) = read(Path::new("sample:peptide"), &options).unwrap();
    let (all, of_all) = read(Path::new("sample:peptide"), &PointOptions::default()).unwrap();
    assert!(points.len() > 10 && points.len() < all.len(), "{} of {}", points.len(), all.len());
    for (place, atom) in points.positions.iter().zip(&molecule.atoms) {
        let at = all.positions.iter().position(|other| other == place).unwrap();
        assert_eq!(atom, &of_all.atoms[at]);
    }
}

#[test]
fn the_sample_is_a_molecule() {
    let path = Path::new("sample:peptide");
    assert!(is_point_file(path).unwrap());
    // Settings that no sample has a use for are refused.
    let level = PointOptions::default().level(1);
    assert!(refused(path, &level).contains("has no layers of points"));
    let chains =
        PointOptions::default().atoms(AtomSelection::default().chains(Some(vec!["A".into()])));
    let tile = read_model("sample:tile", &chains).map(|(points, _)| points.len()).unwrap_err();
    assert!(tile.told().contains("has no atoms"), "{}", tile.told());
    let (points, metadata) = read_model(path, &PointOptions::default()).unwrap();
    assert_eq!((points.len(), metadata.coordinates.unit.symbol()), (61, "Å"));
    let said = points.molecule.unwrap().summary().to_string();
    assert_eq!(said, "61 atoms: protein of chain A; left out: 62 hydrogens (`hydrogens`)");
    let (points, _) =
        read_model(path, &PointOptions::default().radii(Some(Radii::ProtOr))).unwrap();
    assert_eq!(points.weights.unwrap()[1], 1.88 * 1.88);
}
