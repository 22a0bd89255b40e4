//! `walpha balls`: its report, tables and errors.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use walpha_base::vector::{cross, dot, sub};

use crate::common::{fails, json, names, ok, run};

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
    fails(
        f,
        2,
        "balls cube.csv --periodic 9,9,9 -o pockets.csv",
        &["not measured in a periodic box"],
    );
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
    fails(f, 2, "balls three.csv -o a.txt", &["a.txt", ".csv", ".ply"]);
    fails(f, 1, "balls negative.csv --probe 1", &["point 1 has a negative squared radius"]);
    assert_eq!(json(f, &["balls", "negative.csv"])["balls"]["euler_characteristic"], 1);
}

/// The volume that the facets of an STL file enclose, and their area.
fn measures_of_stl(path: &Path) -> [f64; 2] {
    let bytes = fs::read(path).unwrap();
    let facets = bytes[84..].chunks_exact(50);
    assert_eq!(facets.len(), u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize);
    facets.fold([0.0; 2], |[volume, area], facet| {
        let number = |k: usize| {
            let at = 12 + 4 * k;
            f64::from(f32::from_le_bytes(facet[at..at + 4].try_into().unwrap()))
        };
        let [a, b, c] = [0, 3, 6].map(|at| [0, 1, 2].map(|k| number(at + k)));
        let normal = cross(sub(b, a), sub(c, a));
        [volume + dot(a, cross(b, c)) / 6.0, area + dot(normal, normal).sqrt() / 2.0]
    })
}

#[test]
fn surfaces_are_written_with_their_balls() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "three.csv", THREE);
    for (tolerance, off) in [("0.05", 0.1), ("0.001", 0.002)] {
        let outputs = ["--tolerance", tolerance, "-o", "a.stl", "a.ply", "a.vtp"];
        let facts = json(f, &[&["balls", "three.csv"][..], &outputs].concat());
        let [volume, area] = measures_of_stl(&f.join("a.stl"));
        for (found, name) in [(volume, "volume"), (area, "area")] {
            let share = found / facts["balls"][name].as_f64().unwrap();
            assert!((1.0 - off..1.0).contains(&share), "{name}: {share}");
        }
    }
    let stl = fs::read(f.join("a.stl")).unwrap();
    let facets = u32::from_le_bytes(stl[80..84].try_into().unwrap()) as usize;
    let ply = fs::read(f.join("a.ply")).unwrap();
    let end = ply.windows(11).position(|text| text == b"end_header\n").unwrap() + 11;
    let head = String::from_utf8_lossy(&ply[..end]);
    names(&head, &["property uint ball\nend_header", &format!("element face {facets}")]);
    // A face is a count, three vertices and the ball. Those of a ball follow each other.
    let faces: Vec<&[u8]> = ply[ply.len() - 17 * facets..].chunks(17).collect();
    let ball = |face: &&[u8]| u32::from_le_bytes(face[13..17].try_into().unwrap());
    assert_eq!((ball(&faces[0]), ball(&faces[facets - 1])), (0, 2));
    assert!(faces.iter().all(|face| face[0] == 3));
    assert!(faces.iter().map(ball).is_sorted());
    let vtp = fs::read(f.join("a.vtp")).unwrap();
    let text = String::from_utf8_lossy(&vtp);
    names(
        &text,
        &[&format!("NumberOfPolys=\"{facets}\""), "Name=\"ball\"", "off by at most 0.001"],
    );
    // Atoms have the colours of their elements, hydrogen white.
    ok(f, &["balls", "sample:peptide", "-o", "b.ply", "b.vtp"]);
    names(&String::from_utf8_lossy(&fs::read(f.join("b.ply")).unwrap()), &["uchar blue\nend"]);
    names(&String::from_utf8_lossy(&fs::read(f.join("b.vtp")).unwrap()), &["Name=\"colour\""]);
}

#[test]
#[cfg(feature = "render")]
fn a_picture_shows_elements() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "water.xyz", "3\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n");
    ok(f, &["balls", "water.xyz", "--size", "80x60", "--view", "top", "-o", "water.png"]);
    let picture = image::open(f.join("water.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (80, 60));
    // Oxygen is red; hydrogens are white or gray, and so is what is around them.
    let pixels = || picture.pixels().map(|pixel| pixel.0.map(u32::from));
    let red = pixels().filter(|[r, g, b]| *r > 100 && *r > 2 * g.max(b)).count();
    let gray = pixels().filter(|[r, g, b]| r.abs_diff(*g).max(r.abs_diff(*b)) < 30).count();
    assert!((300..2400).contains(&red) && red + gray > 4560, "{red} {gray}");
}

#[test]
fn options_of_surfaces_and_pictures_are_refused_without_them() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(f, "three.csv", THREE);
    fails(f, 2, "balls three.csv --tolerance 0.1", &["--tolerance has no effect"]);
    fails(f, 2, "balls three.csv --tolerance 0.7 -o a.ply", &["from 0.000001 to 0.5"]);
    fails(f, 2, "balls three.csv --tolerance 0 -o a.ply", &["from 0.000001 to 0.5"]);
    #[cfg(feature = "render")]
    fails(f, 2, "balls three.csv --view top -o a.ply", &["--view has no effect"]);
    fails(f, 2, "balls three.csv --periodic 20,20,20 -o a.ply", &["periodic box", "cut"]);
}

/// One ball, balls without a radius, duplicates, hidden balls, and balls that touch.
#[test]
fn odd_sets_are_measured() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let ball = 4.0 / 3.0 * PI;
    for (rows, volume, area, components, parts) in [
        ("0,0,0,1\n", ball, 4.0 * PI, 1, &[ball][..]),
        ("0,0,0,1\n5,0,0,0\n", ball, 4.0 * PI, 2, &[ball, 0.0]),
        ("1,2,3,0\n", 0.0, 0.0, 1, &[0.0]),
        ("0,0,0,1\n0,0,0,1\n0,0,0,0.5\n", ball, 4.0 * PI, 1, &[ball, 0.0, 0.0]),
        ("0,0,0,0.5\n0,0,0,1\n", ball, 4.0 * PI, 1, &[0.0, ball]),
        ("0.1,0,0,0.5\n0,0,0,1\n", ball, 4.0 * PI, 1, &[0.0, ball]),
        ("0,0,0,1\n2,0,0,1\n0,2,0,1\n", 3.0 * ball, 12.0 * PI, 1, &[ball; 3]),
        ("0,0,0,1\n0.5,0,0,0.5\n", ball, 4.0 * PI, 1, &[ball, 0.0]),
    ] {
        write(f, "balls.csv", &format!("x,y,z,radius\n{rows}"));
        let facts = json(f, &["balls", "balls.csv", "-o", "atoms.csv", "s.stl"]);
        let balls = &facts["balls"];
        let value = |name: &str| balls[name].as_f64().unwrap();
        assert!((value("volume") - volume).abs() <= 1e-12 * volume, "{rows}: {balls}");
        assert!((value("area") - area).abs() <= 1e-12 * area, "{rows}: {balls}");
        // Three that touch in a row of two have no loop.
        assert_eq!(balls["euler_characteristic"], components, "{rows}");
        let found = numbers(&table(&f.join("atoms.csv"))["volume"]);
        assert_eq!(found.len(), parts.len(), "{rows}");
        assert!(found.iter().zip(parts).all(|(a, b)| (a - b).abs() < 1e-12), "{rows}: {found:?}");
        let [enclosed, _] = measures_of_stl(&f.join("s.stl"));
        assert!((enclosed - volume).abs() <= 0.02 * volume, "{rows}: {enclosed}");
    }
}

#[test]
fn points_in_a_plane_are_discs_too() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Two columns of places are a plane.
    write(f, "discs.csv", "x,y,radius\n0,0,1\n2,0,1\n0,2,1\n2,2,1\n");
    let facts = json(f, &["balls", "discs.csv"]);
    let discs = &facts["balls"]["discs"];
    assert!((discs["area"].as_f64().unwrap() - 4.0 * PI).abs() < 1e-12, "{discs}");
    assert!((discs["perimeter"].as_f64().unwrap() - 8.0 * PI).abs() < 1e-12, "{discs}");
    names(&ok(f, &["balls", "discs.csv"]), &["discs     area 12.5664"]);
    let space = json(f, &["balls", "sample:peptide"]);
    assert!(space["balls"].get("discs").is_none());
}

/// Volume and area of a shape of balls are those of tetrahedra, and those of the balls are beside them.
#[test]
fn a_shape_of_balls_says_whose_volume_is_whose() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let balls = &json(f, &["balls", "sample:peptide"])["balls"];
    let facts = json(f, &["shape", "sample:peptide", "--preset", "molecule"]);
    for name in ["volume", "volume_bound", "area", "area_bound"] {
        assert_eq!(facts["balls"][name], balls[name], "{name}");
    }
    assert!(facts["shape"]["volume"].as_f64().unwrap() < 0.2 * balls["volume"].as_f64().unwrap());
    let text = ok(f, &["shape", "sample:peptide", "--preset", "molecule"]);
    names(&text, &["of tetrahedra", "balls     volume "]);
    // Points without radii are not balls of their own.
    write(f, "points.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n");
    let facts = json(f, &["shape", "points.csv", "--alpha", "1"]);
    assert!(facts.get("balls").is_none());
    let text = ok(f, &["shape", "points.csv", "--alpha", "1"]);
    assert!(!text.contains("tetrahedra"), "{text}");
    // A part that was kept is no union of all balls.
    let facts = json(f, &["shape", "sample:peptide", "--preset", "molecule", "--keep", "1"]);
    assert!(facts.get("balls").is_none());
}

/// Numbers that are far below 1 have their digits, too.
#[test]
fn small_balls_have_digits() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (radius, volume) in [
        ("0.05", "0.000523599 unit³"),
        ("0.001", "4.18879e-9 unit³"),
        ("1e-10", "4.18879e-30 unit³"),
    ] {
        write(f, "one.csv", &format!("x,y,z,radius\n0,0,0,{radius}\n"));
        let text = ok(f, &["balls", "one.csv"]);
        assert!(text.contains(&format!("volume    {volume}")), "{text}");
    }
    fails(f, 2, "balls one.csv --probe -0.5", &["'-0.5'", "--probe"]);
}

/// Files of PDB have columns for four letters of a residue, or two of a chain; what has none is named.
#[test]
fn atoms_at_pockets_have_their_columns() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows: String = (0..8)
        .map(|i| {
            let (chain, residue) = if i == 0 { ("AB", "ALA") } else { ("C", "POPC") };
            format!("ATOM {i} C C . {residue} {chain} {i} {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)
        })
        .collect();
    let items = [
        "group_PDB",
        "id",
        "type_symbol",
        "label_atom_id",
        "label_alt_id",
        "label_comp_id",
        "auth_asym_id",
        "auth_seq_id",
        "Cartn_x",
        "Cartn_y",
        "Cartn_z",
    ];
    let tags = items.map(|item| format!("_atom_site.{item}\n")).concat();
    let molecule = format!("data_x\nloop_\n{tags}{rows}");
    write(f, "radii.txt", "ALA C 0.85\nPOPC C 0.85\n");
    write(f, "cube.cif", &molecule);
    ok(f, &["balls", "cube.cif", "--radii", "radii.txt", "-o", "pockets.pdb"]);
    let pdb = fs::read_to_string(f.join("pockets.pdb")).unwrap();
    let of = |start: &str| pdb.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    let atoms: Vec<&str> = pdb.lines().filter(|line| line.starts_with("ATOM")).collect();
    assert!(atoms.iter().any(|line| &line[17..26] == "ALAAB   0"), "{pdb}");
    assert!(atoms.iter().any(|line| &line[17..26] == "POPCC   1"), "{pdb}");
    assert!(of("ATOM").len() == 78);
    write(f, "long.cif", &molecule.replace("ALA AB", "ALA ABC"));
    let output = ["balls", "long.cif", "--radii", "radii.txt", "-o", "pockets.pdb"];
    let (code, _, stderr) = run(f, &output);
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("the residue ALA of the chain ABC, for which"), "{stderr}");
}

/// A squared radius below 0 is that of no ball, which is said.
#[test]
fn points_without_a_ball_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("p.csv"), "x,y,z,weight\n0,0,0,-5\n1,0,0,-5\n0,1,0,1\n0,0,1,1\n").unwrap();
    let (code, _, stderr) = run(f, &["balls", "p.csv"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("2 of 4 points have a squared radius"), "{stderr}");
    let (_, _, stderr) = run(f, &["balls", "p.csv", "--alpha", "6"]);
    assert!(!stderr.contains("squared radius"), "{stderr}");
}
