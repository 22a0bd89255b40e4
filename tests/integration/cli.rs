//! The command as a user meets it: results, and the α that is chosen where none is given.

use std::fs;

use walpha_base::random::Random;

use crate::common::{fails, json, names, ok, run};

fn cube() -> String {
    let corner = |i: usize| format!("{},{},{},0,{}\n", i & 1, i >> 1 & 1, i >> 2, 10 * i);
    "x,y,z,weight,value\n".to_owned() + &(0..8).map(corner).collect::<String>()
}

#[test]
fn json_has_what_is_promised() {
    let folder = tempfile::tempdir().unwrap();
    let report =
        json(folder.path(), &["shape", "sample:phantom@24", "--weights", "min-max", "--hidden"]);
    for path in [
        "/schema_version",
        "/input/dims",
        "/input/gray_range",
        "/haar/kept",
        "/haar/epsilon",
        "/haar/rms",
        "/points/selected",
        "/points/duplicates",
        "/points/hidden",
        "/points/in_shape",
        "/alpha/squared",
        "/alpha/radius",
        "/weights/kind",
        "/weights/min",
        "/weights/mean",
        "/weights/max",
        "/shape/cells/interior",
        "/shape/facets/regular",
        "/shape/edges/singular",
        "/shape/vertices/interior",
        "/shape/betti/2",
        "/shape/volume",
        "/shape/area",
        "/engine",
        "/seconds/total",
        "/peak_memory_bytes",
    ] {
        assert!(report.pointer(path).is_some(), "{path} is missing: {report:#}");
    }
    assert_eq!(report["points"]["selected"], (0.0609f64 * 24.0 * 24.0 * 24.0).round() as u64);
    assert_eq!(report["weights"]["max"], 10.0);
}

/// The report of a shape is for people: a few lines, and no number has more than six digits.
#[test]
fn reports_are_short() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text = ok(f, &["shape", "sample:ct", "-o", "bone.ply"]);
    assert!((5..=8).contains(&text.lines().count()), "{text}");
    names(
        &text,
        &[
            "input     sample:ct, 128×128×72 samples, lengths in mm, LPS\n",
            "points    51 410 selected\n",
            "parameter ball radius 6.623 mm (α = 43.87 mm²), the default\n",
            "shape     1 component, 5 tunnels, 20 voids; volume 709.2 cm³, surface 1 776 cm²\n",
            "loose     104 triangles (820.4 mm²), 2 edges: part of no cell\n",
            "wrote     bone.ply, 1.3 MB\n",
        ],
    );
    let info = ok(f, &["info", "sample:ct"]);
    names(&info, &["origin    -111.125 -76.86 -133.355 mm\n"]);
    let all = ok(f, &["shape", "sample:ct", "--verbose"]);
    names(
        &all,
        &["facets       521979 interior     35306 regular       104 singular\n", "haar 0."],
    );
    // Counts have all of their digits.
    let measured = |text: &str| {
        let words = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
        words.filter(|word| word.contains('.')).map(str::to_owned).collect::<Vec<_>>()
    };
    for number in [&text, &info, &all].into_iter().flat_map(|text| measured(text)) {
        let digits = number.trim_start_matches(['0', '.']).matches(|c: char| c.is_ascii_digit());
        assert!(digits.count() <= 6, "{number} in\n{all}");
    }
    // The surface of a sphere without an inside is what is said first.
    let sphere = ok(f, &["shape", "hard:sphere"]);
    let area = sphere.split("surface ").nth(1).unwrap().split(' ').next().unwrap();
    let area: f64 = area.parse().unwrap();
    assert!((area / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{sphere}");
    names(&sphere, &["nothing written: add -o bone.ply"]);
    names(&ok(f, &["points", "hard:sphere"]), &["nothing written: add -o points.csv"]);
    names(&ok(f, &["interpolate", "sample:phantom@8"]), &["nothing written: add -o values.nrrd"]);
}

#[test]
fn a_cube_of_points_is_a_cube() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.csv"), cube()).unwrap();
    let args = ["shape", "cube.csv", "--weights", "column", "--alpha", "0.75"];
    let report = json(folder.path(), &args);
    assert_eq!(report["shape"]["volume"], 1.0);
    assert_eq!(report["shape"]["area"], 6.0);
    assert_eq!(report["shape"]["betti"], serde_json::json!([1, 0, 0]));
    // The cube's sphere has squared radius 3/4 exactly.
    let args = ["shape", "cube.csv", "--weights", "column", "--alpha", "0.7499999999999999"];
    let report = json(folder.path(), &args);
    assert_eq!(report["shape"]["cells"]["interior"], 0);
    assert_eq!(report["shape"]["betti"], serde_json::json!([1, 0, 1]));
    let hull = json(folder.path(), &["shape", "cube.csv", "--alpha", "inf"]);
    assert_eq!(hull["shape"]["volume"], 1.0);
    assert_eq!(hull["alpha"]["squared"], "inf");
    let empty = json(folder.path(), &["shape", "cube.csv", "--alpha=-1", "--allow-empty"]);
    assert_eq!(empty["points"]["in_shape"], 0);
    assert_eq!(empty["shape"]["volume"], 0.0);
    let said = ok(folder.path(), &["shape", "cube.csv", "--alpha=-1", "--allow-empty"]);
    assert!(said.contains("the shape is empty"), "{said}");
}

#[test]
fn both_readings_of_the_balls() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.csv"), cube()).unwrap();
    // A radius of α + 0 = 0.5 is a squared radius of 0.25: edges of length 1 just close.
    let args = ["shape", "cube.csv", "--balls", "radius", "--alpha", "0.5"];
    let radius = json(folder.path(), &args);
    let power = json(folder.path(), &["shape", "cube.csv", "--alpha", "0.25"]);
    assert_eq!(radius["shape"], power["shape"]);
    assert_eq!(power["shape"]["edges"]["singular"], 12);
    fails(
        folder.path(),
        1,
        "shape cube.csv --balls radius --alpha=-1",
        &["radius", "--balls power"],
    );
}

#[test]
fn points_written_are_points_read() {
    let folder = tempfile::tempdir().unwrap();
    let select = ["sample:phantom@24", "--weights", "min-max", "--alpha", "4"];
    let direct = json(folder.path(), &[&["shape"], &select[..]].concat());
    for file in ["p.csv", "p.npy"] {
        ok(folder.path(), &[&["points"], &select[..], &["-o", file]].concat());
        let read = json(folder.path(), &["shape", file, "--alpha", "4"]);
        assert_eq!(read["weights"]["kind"], "column");
        assert_eq!(read["shape"], direct["shape"]);
    }
}

#[test]
fn check_names_a_wrong_simplex() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let make = ["shape", "sample:phantom@12", "--weights", "min-max", "--exterior", "-o", "a.json"];
    ok(f, &make);
    assert!(ok(f, &["check", "a.json"]).contains("exact: no findings"));
    let mut file: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(f.join("a.json")).unwrap()).unwrap();
    let classes = file["classes"]["facets"].as_array_mut().unwrap();
    let at = classes.iter().position(|class| class == "regular").unwrap();
    classes[at] = "interior".into();
    let facet = format!("facet {}", file["facets"][at]).replace(',', ", ");
    fs::write(f.join("b.json"), file.to_string()).unwrap();

    let (code, stdout, _) = run(f, &["check", "b.json"]);
    assert_eq!(code, 3);
    assert!(stdout.contains(&facet) && stdout.contains("wrong: 1 finding"), "{facet}\n{stdout}");
    let (code, stdout, _) = run(f, &["compare", "a.json", "b.json"]);
    assert_eq!(code, 3);
    assert!(stdout.contains(&facet) && stdout.contains("A Regular, B Interior"), "{stdout}");
    assert!(ok(f, &["compare", "a.json", "a.json"]).contains("equal"));
    // Points may stand in a file of their own.
    ok(f, &["points", "sample:phantom@12", "--weights", "min-max", "-o", "p.csv"]);
    file["points"] = serde_json::json!([]);
    fs::write(f.join("c.json"), file.to_string()).unwrap();
    let (code, _, stderr) = run(f, &["check", "c.json"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("c.json") && stderr.contains("--points"), "{stderr}");
    assert_eq!(run(f, &["check", "c.json", "--points", "p.csv"]).0, 3);
    fails(f, 1, "compare a.json missing.json", &["missing.json"]);
    fails(f, 1, "check sample:phantom@16 --enumerate", &["at most 200 points"]);
    fails(f, 2, "check sample:phantom --points p.csv", &["--points belongs to a complex"]);
    ok(f, &["check", "sample:phantom@12", "--weights", "min-max", "--enumerate", "--count", "50"]);
}

#[test]
fn threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "2", "5"] {
        let file = format!("{threads}.vtu");
        let args = ["shape", "sample:phantom@24", "--threads", threads, "-o", &file];
        ok(folder.path(), &args);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("1.vtu"), bytes("2.vtu"));
    assert_eq!(bytes("1.vtu"), bytes("5.vtu"));
}

/// All differences are 0: the first voxels are taken, which are coplanar or a slab.
#[test]
fn a_constant_volume_is_refused_unless_all_samples_are_requested() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("flat.raw"), [7; 64]).unwrap();
    let raw = ["flat.raw", "--dims", "4,4,4", "--dtype", "u8"];
    let flat = "shape flat.raw --dims 4,4,4 --dtype u8 --count 10";
    fails(f, 1, flat, &["none of the 64 that take part differs from a neighbour"]);
    // If all are requested, none is chosen before another.
    let args = [&["shape"], &raw[..], &["--ratio", "1", "--weights", "min-max"]].concat();
    let report = json(f, &args);
    assert_eq!(report["weights"]["max"], 0.0);
    assert_eq!(report["shape"]["volume"], 27.0);
}

/// α of scattered points comes from their spacing: a stray is left apart, and the report says so.
#[test]
fn a_stray_point_does_not_decide_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut random = Random::new(7);
    let rows = |rows: &[[f64; 3]]| {
        let row = |[x, y, z]: &[f64; 3]| format!("{x} {y} {z}\n");
        rows.iter().map(row).collect::<String>()
    };
    let points: Vec<[f64; 3]> = (0..5000).map(|_| [0; 3].map(|_| random.unit())).collect();
    fs::write(f.join("ball.xyz"), rows(&points)).unwrap();
    fs::write(f.join("stray.xyz"), rows(&[&points[..], &[[30.0, 0.0, 0.0]]].concat())).unwrap();
    let [ball, stray] = ["ball.xyz", "stray.xyz"].map(|name| json(f, &["shape", name]));
    let alpha = |made: &serde_json::Value| made["alpha"]["squared"].as_f64().unwrap();
    assert_eq!(ball["alpha"]["origin"], "auto");
    assert!((alpha(&stray) / alpha(&ball) - 1.0).abs() < 0.01);
    let numbers = |made: &serde_json::Value| {
        (made["shape"]["betti"][0].as_u64(), made["shape"]["apart"].as_u64())
    };
    assert_eq!((numbers(&ball), numbers(&stray)), ((Some(1), Some(0)), (Some(2), Some(1))));
    assert!(ball["shape"]["volume"].as_f64().unwrap() > 0.8, "the cube is filled");
    let told = ok(f, &["shape", "stray.xyz"]);
    assert!(told.contains("apart     1 of 5 001 points"), "{told}");
    assert!(!ok(f, &["shape", "ball.xyz"]).contains("apart"));
    // By the other rule the stray point decides.
    let connected = json(f, &["shape", "stray.xyz", "--alpha", "auto:connected"]);
    assert!(alpha(&connected) > 100.0 * alpha(&stray) && numbers(&connected) == (Some(1), Some(0)));
    let ladder = json(f, &["ladder", "ball.xyz", "--alphas", "1", "-o", "ladder"]);
    assert_eq!(ladder["alpha_ref"]["squared"], ball["alpha"]["squared"]);
}

#[test]
fn alpha_is_found_if_it_is_not_given() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Two cubes of different sizes, and a gap of four between them.
    let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
    let cubes = [(0.0, 1.0), (5.0, 3.0)];
    let mut text = "x,y,z,value\n".to_owned();
    for (place, side) in cubes {
        for [x, y, z] in (0..8).map(corner) {
            text += &format!("{},{},{},{}\n", place + side * x, side * y, side * z, x + y);
        }
    }
    fs::write(f.join("two.csv"), &text).unwrap();
    let connected = json(f, &["shape", "two.csv", "--alpha", "auto:connected"]);
    assert_eq!(connected["alpha"]["origin"], "connected");
    assert_eq!(
        (&connected["points"]["in_shape"], &connected["shape"]["betti"][0]),
        (&16.into(), &1.into())
    );
    // It is the smallest: just below it the shape falls apart, or leaves a point out.
    let alpha = connected["alpha"]["squared"].as_f64().unwrap();
    let solid = |alpha: f64| {
        ok(f, &["shape", "two.csv", "--alpha", &alpha.to_string(), "-o", "two.json", "-q"]);
        let made: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(f.join("two.json")).unwrap()).unwrap();
        let cells: Vec<Vec<u64>> = serde_json::from_value(made["cells"].clone()).unwrap();
        let shared = |a: &[u64], b: &[u64]| a.iter().filter(|v| b.contains(v)).count();
        let mut reached = vec![0];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            next += 1;
            for other in 0..cells.len() {
                if shared(&cells[cell], &cells[other]) == 3 && !reached.contains(&other) {
                    reached.push(other);
                }
            }
        }
        let points: std::collections::BTreeSet<&u64> = cells.iter().flatten().collect();
        points.len() == 16 && reached.len() == cells.len()
    };
    assert!(solid(alpha));
    assert!(!solid(alpha.next_down()));
    // The same number, given explicitly, gives the same shape; and every command computes it.
    let given = json(f, &["shape", "two.csv", "--alpha", &alpha.to_string()]);
    assert_eq!(given["shape"], connected["shape"]);
    assert_eq!(given["alpha"]["origin"], "given");
    let interpolated =
        json(f, &["interpolate", "two.csv", "--dims", "3,3,3", "--alpha", "auto:connected"]);
    assert_eq!(interpolated["alpha"], connected["alpha"]);
    assert_eq!(run(f, &["check", "two.csv", "--alpha", "auto:connected"]).0, 0);
    let min_max = ["shape", "two.csv", "--weights", "min-max", "--alpha", "auto:connected"];
    let weighted = json(f, &min_max);
    assert_eq!(weighted["alpha"]["origin"], "connected-unweighted");
    assert_eq!(
        (&weighted["alpha"]["squared"], &weighted["weights"]["max"]),
        (&alpha.into(), &alpha.into())
    );
    // A volume has its own scale.
    let volume = json(f, &["shape", "sample:phantom@8"]);
    assert_eq!(
        (&volume["alpha"]["squared"], &volume["alpha"]["origin"]),
        (&10.0.into(), &"default".into())
    );
    let volume = json(f, &["shape", "sample:phantom@8", "--alpha", "auto:connected"]);
    assert_eq!(volume["alpha"]["squared"], 4.75);
    let skull = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nspacings: 0.25 0.5 1\nencoding: raw\n\n";
    let samples: Vec<u8> = (0..512u32).map(|i| (i * i % 251) as u8).collect();
    fs::write(f.join("v.nrrd"), [skull.as_bytes(), &samples].concat()).unwrap();
    let volume = json(f, &["shape", "v.nrrd", "--units", "world"]);
    assert_eq!(volume["alpha"]["squared"], 2.5, "0.25·0.5·1 is the cube of 0.5");
}

/// A mesh of a coloured scan has the colours of its points, which are read again as such; without them it has those of values.
#[test]
fn the_colours_of_a_scan_are_those_of_its_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let row = |i: usize| {
        format!("{},{},{},{},{},7,{}\n", i & 1, i >> 1 & 1, i >> 2, 30 * i, 255 - i, 10 * i)
    };
    let rows: String = (0..8).map(row).collect();
    fs::write(f.join("c.csv"), format!("x,y,z,red,green,blue,value\n{rows}")).unwrap();
    ok(f, &["shape", "c.csv", "--alpha", "1", "-o", "c.ply", "--ascii"]);
    let ply = fs::read_to_string(f.join("c.ply")).unwrap();
    let (header, body) = ply.split_once("end_header\n").unwrap();
    assert!(header.contains("property uchar red\n"), "{header}");
    for (i, line) in body.lines().take(8).enumerate() {
        let words: Vec<&str> = line.split(' ').collect();
        assert_eq!(words[5..8], [(30 * i).to_string(), (255 - i).to_string(), "7".into()]);
    }
    ok(f, &["points", "c.ply", "-o", "back.csv"]);
    let back = fs::read_to_string(f.join("back.csv")).unwrap();
    let place = back.lines().next().unwrap().split(',').position(|name| name == "red").unwrap();
    let red: Vec<&str> =
        back.lines().skip(1).map(|line| line.split(',').nth(place).unwrap()).collect();
    assert_eq!(red, ["0", "30", "60", "90", "120", "150", "180", "210"]);
    // Without values, too.
    let bare: String =
        rows.lines().map(|row| format!("{}\n", row.rsplit_once(',').unwrap().0)).collect();
    fs::write(f.join("b.csv"), format!("x,y,z,red,green,blue\n{bare}")).unwrap();
    ok(f, &["shape", "b.csv", "--alpha", "1", "-o", "b.ply", "--ascii"]);
    assert!(fs::read_to_string(f.join("b.ply")).unwrap().contains("property uchar blue\n"));
}
