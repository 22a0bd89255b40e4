//! Molecules on the command line.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{fails, json as told, ok};

/// A residue in each of two chains, water, an ion, and a hydrogen.
const PDB: &str = "\
ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N
ATOM      2  CA  ALA A   1       1.500   0.000   0.000  1.00  0.00           C
ATOM      3  HA  ALA A   1       1.500   1.000   0.000  1.00  0.00           H
ATOM      4  C   ALA B   1       0.000   1.500   0.000  1.00  0.00           C
ATOM      5  O   ALA B   1       0.000   0.000   1.500  1.00  0.00           O
HETATM    6  O   HOH A 101       5.000   5.000   5.000  1.00  0.00           O
HETATM    7 FE   HEM A 102       7.000   5.000   5.000  1.00  0.00          FE
END
";

fn save(folder: &Path) {
    fs::write(folder.join("a.pdb"), PDB).unwrap();
}

fn count(f: &Path, options: &str) -> Value {
    let args: Vec<&str> =
        ["points", "a.pdb"].into_iter().chain(options.split_whitespace()).collect();
    told(f, &args)["points"]["selected"].clone()
}

#[test]
fn options_choose_atoms() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f);
    for (options, expected) in [
        ("", 4),
        ("--hydrogens", 5),
        ("--waters", 5),
        ("--hetero --radii none", 5),
        ("--hetero --weights common=0", 5),
        ("--chains B", 2),
        ("--chains A,B --models all", 4),
        ("--models 1 --hydrogens --waters", 6),
    ] {
        assert_eq!(count(f, options), expected, "{options}");
    }
    fails(f, 1, "points a.pdb --hetero", &["bondi does not tell: FE of HEM", "(--radii FILE;"]);
    fails(f, 1, "points a.pdb --chains C", &["no chain \"C\"", "give --chains some of A, B"]);
    fails(f, 1, "points a.pdb --models 2", &["no model 2", "give --models all, or one of 1"]);
    fails(f, 2, "points a.pdb --models first", &["\"first\" is not the number of a model"]);
    fails(f, 2, "points a.pdb --chains A,", &["names of chains are needed"]);
    fails(f, 2, "points a.pdb --radii bondi --weights common=1", &["--radii has no effect"]);
    fails(
        f,
        2,
        "points sample:phantom@8 --radii bondi --waters",
        &["--radii, --waters have no effect", "holds a volume"],
    );
    fs::write(f.join("mine.toml"), "chains = [\"B\"]\nradii = \"protor\"\n").unwrap();
    let of_file = told(f, &["points", "a.pdb", "--config", "mine.toml"]);
    assert_eq!(of_file["points"]["selected"], 2);
    assert_eq!(of_file["weights"]["max"], json!(1.61 * 1.61));
}

#[test]
fn what_is_left_out_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f);
    let summary = "4 atoms: protein of chains A, B; left out: 1 water (--waters), 1 ligand (HEM) (--hetero), 1 hydrogen (--hydrogens)";
    let info = told(f, &["info", "a.pdb"]);
    assert_eq!(info["atoms"]["summary"], summary);
    assert_eq!(info["atoms"]["left_out"]["ligands"], json!([["HEM", 1]]));
    assert_eq!((&info["of_radii"], &info["coordinates"]["unit"]), (&json!(true), &json!("Å")));
    assert!(ok(f, &["info", "a.pdb"]).contains(&format!("molecule  {summary}\n")));
    for args in [&["shape", "a.pdb", "--preset", "molecule"][..], &["filtration", "a.pdb"]] {
        let told = told(f, args);
        assert_eq!(told["warnings"], json!([summary]), "{args:?}");
    }
    // Nothing is left out, and nothing is said.
    let all =
        told(f, &["shape", "a.pdb", "--waters", "--hydrogens", "--hetero", "--radii", "none"]);
    assert_eq!(all.get("warnings"), None);
}

#[test]
fn the_balls_of_atoms_have_their_radii() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let shape = told(f, &["shape", "sample:peptide", "--preset", "molecule"]);
    assert_eq!(shape["weights"]["of_radii"], true);
    assert_eq!(shape["weights"]["max"], json!(1.7 * 1.7));
    assert_eq!(
        (&shape["points"]["in_shape"], &shape["shape"]["betti"][0]),
        (&json!(61), &json!(1))
    );
    fs::write(f.join("table.csv"), "C 2\nN 2\nO 2\n").unwrap();
    let args = ["points", "sample:peptide", "--radii", "table.csv"];
    assert_eq!(told(f, &args)["weights"]["min"], 4.0);
    // The table is read, so no output replaces it.
    fails(
        f,
        1,
        "points sample:peptide --radii table.csv -o table.csv",
        &["table.csv", "--in-place"],
    );
    fails(f, 1, "points sample:peptide --radii bondy", &["bondy", "give --radii bondi, protor"]);
}

/// Extended XYZ states elements by names or, as ASE writes them, by atomic numbers.
#[test]
fn atomic_numbers_are_elements() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows = "0 0 0 8\n1 0 0 1\n";
    fs::write(f.join("z.xyz"), format!("2\nProperties=pos:R:3:Z:I:1\n{rows}")).unwrap();
    let named = "0 0 0 O\n1 0 0 H\n";
    fs::write(f.join("s.xyz"), format!("2\nProperties=pos:R:3:species:S:1\n{named}")).unwrap();
    let [by_number, by_name] = ["z.xyz", "s.xyz"].map(|name| told(f, &["info", name]));
    assert_eq!(by_number["weights"], by_name["weights"]);
    assert_eq!(by_number["atoms"], by_name["atoms"]);
    assert!(!by_number["atoms"].is_null());
    // A column of that name with other numbers is a column.
    fs::write(f.join("r.xyz"), format!("2\nProperties=pos:R:3:Z:R:1\n{rows}")).unwrap();
    assert!(told(f, &["info", "r.xyz"])["atoms"].is_null());
}
