//! `walpha balls`: its report, tables and errors.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use crate::common::{fails, json, names, ok};

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

/// The columns of a table by their names.
fn table(path: &Path) -> BTreeMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let mut columns: Vec<Vec<String>> = vec![Vec::new(); names.len()];
    for row in reader.records() {
        row.unwrap().iter().zip(&mut columns).for_each(|(field, column)| column.push(field.into()));
    }
    names.into_iter().zip(columns).collect()
}

fn numbers(column: &[String]) -> Vec<f64> {
    column.iter().map(|field| field.parse().unwrap()).collect()
}

/// Two balls of radius 1, 1 apart, and one of radius 2 far away.
const THREE: &str = "x,y,z,radius\n0,0,0,1\n1,0,0,1\n9,0,0,2\n";

#[test]
fn volumes_and_areas_of_few_balls_are_those_of_closed_forms() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "three.csv", THREE);
    let outputs = ["-o", "atoms.csv", "x-contacts.csv"];
    let facts = json(f, &[&["balls", "three.csv"][..], &outputs].concat());
    let balls = &facts["balls"];
    let near = |name: &str, expected: f64| {
        let value = balls[name].as_f64().unwrap();
        let bound = balls[format!("{name}_bound")].as_f64().unwrap();
        assert!((value - expected).abs() <= bound + 1e-13 * expected.abs(), "{name}: {value}");
        assert!(bound <= 1e-9 * expected.abs(), "{name}: {bound}");
    };
    near("volume", 9.0 / 4.0 * PI + 32.0 / 3.0 * PI);
    near("area", 6.0 * PI + 16.0 * PI);
    near("gaussian_curvature", 8.0 * PI);
    assert_eq!((&balls["euler_characteristic"], &balls["contacts"]), (&2.into(), &1.into()));
    let atoms = table(&f.join("atoms.csv"));
    let volumes = numbers(&atoms["volume"]);
    assert_eq!(numbers(&atoms["radius"]), [1.0, 1.0, 2.0]);
    for (volume, expected) in volumes.iter().zip([9.0 / 8.0 * PI, 9.0 / 8.0 * PI, 32.0 / 3.0 * PI])
    {
        assert!((volume - expected).abs() < 1e-12, "{volumes:?}");
    }
    let contacts = table(&f.join("x-contacts.csv"));
    assert_eq!((&contacts["first"], &contacts["second"]), (&vec!["0".into()], &vec!["1".into()]));
    assert!((numbers(&contacts["area"])[0] - 0.75 * PI).abs() < 1e-12);
    let text = ok(f, &["balls", "three.csv"]);
    names(
        &text,
        &[
            "volume    40.5789",
            "area      69.115",
            "contacts  1 between two balls",
            "radii     1 to 2",
        ],
    );
}

/// With a probe all radii grow, whether they are given one by one or for all.
#[test]
fn a_probe_enlarges_all_balls() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "one.csv", "x,y,z,radius\n0,0,0,1.5\n");
    write(f, "place.csv", "x,y,z\n0,0,0\n");
    for args in [
        &["balls", "one.csv", "--probe", "1.5"][..],
        &["balls", "place.csv", "--alpha-radius", "1.5", "--probe", "1.5"],
        &["balls", "place.csv", "--alpha-radius", "3"],
    ] {
        let facts = json(f, args);
        let volume = facts["balls"]["volume"].as_f64().unwrap();
        assert!((volume - 36.0 * PI).abs() < 1e-12, "{args:?}: {volume}");
        assert_eq!(facts["radii"], serde_json::json!([3.0, 3.0]));
    }
}

/// Balls at the corners of a cube leave a void in its middle.
#[test]
fn voids_and_pockets_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let corners = (0..8).map(|i| format!("{},{},{},0.85\n", i & 1, i >> 1 & 1, i >> 2));
    write(f, "cube.csv", &format!("x,y,z,radius\n{}", corners.collect::<String>()));
    let outputs = ["-o", "voids.csv", "pockets.csv", "pockets.pdb"];
    let facts = json(f, &[&["balls", "cube.csv"][..], &outputs].concat());
    let balls = &facts["balls"];
    assert_eq!(balls["betti"], serde_json::json!([1, 0, 1]));
    assert_eq!(
        (balls["voids"].as_array().unwrap().len(), &balls["voids"][0]["balls"]),
        (1, &8.into())
    );
    let voids = table(&f.join("voids.csv"));
    assert_eq!(voids["balls"], ["0 1 2 3 4 5 6 7"]);
    let volume = numbers(&voids["volume"])[0];
    assert_eq!(balls["voids"][0]["volume"], volume);
    assert_eq!(numbers(&table(&f.join("pockets.csv"))["mouths"])[0], 0.0);
    let pdb = fs::read_to_string(f.join("pockets.pdb")).unwrap();
    let atoms: Vec<&str> = pdb.lines().filter(|line| line.starts_with("HETATM")).collect();
    assert_eq!(atoms.len(), 8);
    for line in atoms {
        assert_eq!((line.len(), line[60..66].trim()), (78, "1.00"));
    }
    // In a periodic box there is no outside.
    let periodic = json(f, &["balls", "cube.csv", "--periodic", "9,9,9"]);
    assert!(periodic["balls"]["box_fraction"].as_f64().unwrap() < 0.02);
    fails(f, 2, "balls cube.csv --periodic 9,9,9 -o pockets.csv", &["no outside"]);
    // Voids take the whole triangulation, which a lattice has.
    let lattice = (0..125).map(|i| format!("{},{},{},0.6\n", i % 5, i / 5 % 5, i / 25));
    write(f, "lattice.csv", &format!("x,y,z,radius\n{}", lattice.collect::<String>()));
    let facts = json(f, &["balls", "lattice.csv", "--periodic", "5,5,5", "-o", "voids.csv"]);
    assert_eq!(
        facts["balls"]["voids"].as_array().unwrap().len(),
        table(&f.join("voids.csv"))["void"].len()
    );
}

#[test]
fn a_molecule_has_tables_of_atoms_and_residues() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let outputs = ["-o", "atoms.csv", "residues.csv"];
    let args = ["balls", "sample:peptide", "--probe", "1.4"];
    let facts = json(f, &[&args[..], &outputs].concat());
    let (atoms, residues) = (table(&f.join("atoms.csv")), table(&f.join("residues.csv")));
    assert_eq!(atoms["x"].len() as u64, facts["points"].as_u64().unwrap());
    for name in ["volume", "area"] {
        let total = facts["balls"][name].as_f64().unwrap();
        for table in [&atoms, &residues] {
            let sum: f64 = numbers(&table[name]).iter().sum();
            assert!((sum / total - 1.0).abs() < 1e-12, "{name}: {sum} {total}");
        }
    }
    let counts: f64 = numbers(&residues["atoms"]).iter().sum();
    assert_eq!(counts as usize, atoms["x"].len());
    assert_eq!(facts["coordinates"]["unit"], "Å");
    names(&ok(f, &args), &["molecule  ", "atoms", "with the probe's 1.4 Å", "Å³", "Å²"]);
}

#[test]
fn what_has_no_balls_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "places.csv", "x,y,z\n0,0,0\n1,0,0\n");
    write(f, "three.csv", THREE);
    write(f, "negative.csv", "x,y,z,weight\n0,0,0,1\n5,0,0,-1\n");
    fails(f, 2, "balls places.csv", &["has no radii", "--alpha-radius"]);
    fails(f, 2, "balls places.csv --alpha auto", &["--alpha finds"]);
    fails(f, 1, "balls places.csv --alpha inf", &["∞"]);
    fails(f, 2, "balls sample:phantom@16", &["holds a volume", "radius"]);
    fails(f, 2, "balls three.csv -o residues.csv", &["is not a molecule"]);
    fails(f, 2, "balls three.csv -o a.txt", &["a.txt", ".csv"]);
    fails(f, 1, "balls negative.csv --probe 1", &["point 1 has a negative squared radius"]);
    assert_eq!(json(f, &["balls", "negative.csv"])["balls"]["euler_characteristic"], 1);
}
