//! The solid inside an isosurface: `walpha shape --surface`.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{fails, json, names, ok, run};

/// Saves a NRRD of floats, of 0.5 × 0.5 × 2 mm voxels in slices that lean; x fastest.
fn save(folder: &Path, name: &str, sizes: [usize; 3], sample: impl Fn([usize; 3]) -> f64) {
    let [x, y, z] = sizes;
    let header = format!(
        "NRRD0004\ntype: float\nendian: little\ndimension: 3\nsizes: {x} {y} {z}\nencoding: raw\nspace: LPS\n\
         space directions: (0.5,0,0) (0,0.48,0.14) (0,-0.56,1.92)\nspace origin: (5,6,7)\n\
         space units: \"mm\" \"mm\" \"mm\"\n\n"
    );
    let at = |i: usize| sample([i % x, i / x % y, i / x / y]) as f32;
    let samples = (0..x * y * z).flat_map(|i| at(i).to_le_bytes());
    fs::write(
        folder.join(name),
        header.into_bytes().into_iter().chain(samples).collect::<Vec<_>>(),
    )
    .unwrap();
}

/// The depth below the surface of a ball of radius 8 mm in the middle, in mm, from 1000 on.
fn ball([x, y, z]: [usize; 3]) -> f64 {
    let from = |i: usize, step: f64, middle: f64| (i as f64 * step - middle).powi(2);
    1000.0 + 8.0 - (from(x, 0.5, 10.0) + from(y, 0.5, 10.0) + from(z, 2.0, 10.0)).sqrt()
}

/// A head as T1 shows it: scalp, dark skull, brain with ventricles, and specks of noise in the air around it, which is not 0.
fn head([x, y, z]: [usize; 3]) -> f64 {
    let at = [x, y, z].map(|i| i as f64 - 23.5);
    let r = ((at[0] / 17.0).powi(2) + (at[1] / 20.0).powi(2) + (at[2] / 18.0).powi(2)).sqrt();
    let noise = ((x * 7919 + y * 104_729 + z * 1_299_709) % 97) as f64 / 4.0;
    let tissue = match r {
        r if r < 0.25 => 120.0,
        r if r < 0.7 => 600.0,
        r if r < 0.85 => 420.0,
        // Bone, and what joins brain and scalp below.
        r if r < 0.93 => {
            if at[2] < -12.0 && at[0].abs() < 5.0 {
                380.0
            } else {
                60.0
            }
        }
        r if r < 1.0 => 800.0,
        _ => 20.0,
    };
    tissue + noise
}

#[test]
fn a_volume_gives_the_solid_inside_its_isosurface() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "ball.nrrd", [41, 41, 11], ball);
    let made = json(f, &["shape", "ball.nrrd", "--surface", "1000", "-o", "ball.json", "ball.npz"]);
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 512.0;
    let volume = made["shape"]["volume"].as_f64().unwrap();
    assert!((volume / expected - 1.0).abs() < 0.03, "{volume} {expected}");
    assert_eq!(
        made["isovalue"],
        serde_json::json!({ "value": 1000.0, "found": false, "closed": false })
    );
    for unknown in ["alpha", "haar", "weights"] {
        assert_eq!(made[unknown], Value::Null, "{unknown}");
    }
    assert_eq!(
        made["shape"]["betti"]["b0"].as_u64().or(made["shape"]["betti"][0].as_u64()),
        Some(1)
    );
    assert_eq!(made["coordinates"]["unit"], "mm");
    // Points have values of the file: that of the surface, and those of samples.
    let file: Value = serde_json::from_slice(&fs::read(f.join("ball.json")).unwrap()).unwrap();
    assert_eq!((&file["isovalue"], &file["alpha"]), (&1000.0.into(), &"inf".into()));
    let values = file["info"]["values"].as_array().unwrap();
    let (mut at_surface, mut inside) = (0, 0);
    for value in values.iter().map(|value| value.as_f64().unwrap()) {
        at_surface += usize::from(value == 1000.0);
        inside += usize::from(value > 1000.0);
    }
    assert!(at_surface > 1000 && inside > 1000 && at_surface + inside == values.len());

    let told = ok(f, &["shape", "ball.nrrd", "--surface", "1000", "--solid", "-o", "ball.stl"]);
    names(
        &told,
        &["surface   at 1000; the samples decide which cells are inside", "manifold as it is"],
    );
    assert!(!told.contains("weights") && !told.contains("parameter"), "{told}");
    assert!(
        fs::read(f.join("ball.stl")).unwrap().starts_with(b"walpha, solid inside an isosurface")
    );
    // In voxels it is a ball that the axes squeeze.
    let voxels = json(f, &["shape", "ball.nrrd", "--surface", "1000", "--units", "voxel"]);
    let ratio = volume / voxels["shape"]["volume"].as_f64().unwrap();
    assert!((ratio - 0.5).abs() < 1e-9, "{ratio}");
}

/// What a file without the volume allows is judged, and what is wrong there is found.
#[test]
fn the_checker_judges_all_but_the_samples() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "ball.nrrd", [41, 41, 11], ball);
    ok(f, &["shape", "ball.nrrd", "--surface", "1000", "-o", "ball.json", "ball.npz"]);
    for input in ["ball.json", "ball.npz", "ball.nrrd"] {
        let surface: &[&str] = if input == "ball.nrrd" { &["--surface", "1000"] } else { &[] };
        let (code, told, stderr) = run(f, &[&["check", input], surface].concat());
        assert_eq!(code, 4, "{told}{stderr}");
        names(
            &told,
            &["exact as far as judged", "which cells the solid inside the isosurface has"],
        );
    }
    let text = fs::read_to_string(f.join("ball.json")).unwrap();
    let mut file: Value = serde_json::from_str(&text).unwrap();
    // A cell that is missing leaves facets that are called interior, and it leaves the boundary a cell too deep.
    file["cells"].as_array_mut().unwrap().remove(40);
    file["classes"]["cells"].as_array_mut().unwrap().remove(40);
    fs::write(f.join("less.json"), file.to_string()).unwrap();
    let (code, told, _) = run(f, &["check", "less.json"]);
    assert!(code == 3 && told.contains("wrong: "), "{code} {told}");
    let mut file: Value = serde_json::from_str(&text).unwrap();
    file["classes"]["cells"][7] = "exterior".into();
    fs::write(f.join("class.json"), file.to_string()).unwrap();
    assert_eq!(run(f, &["check", "class.json"]).0, 3);
    let both = text.replacen("\"isovalue\"", "\"periodic\":[9,9,9],\"isovalue\"", 1);
    fs::write(f.join("both.json"), both).unwrap();
    fails(f, 1, "check both.json", &["periodic", "isosurface"]);
    fails(f, 2, "check ball.json --alpha 3", &["is inside an isosurface, without α"]);
    fails(f, 1, "check ball.nrrd --surface 1000 --enumerate", &["isosurface"]);
}

/// Options of gray levels, α, weights and engines have no part in it, and other commands make shapes of α.
#[test]
fn what_does_not_combine_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "ball.nrrd", [21, 21, 6], ball);
    for option in [
        "--count 9",
        "--ratio 0.1",
        "--threshold 3",
        "--gray-min 3",
        "--value-min 3",
        "--rms 2",
        "--epsilon 2",
        "--coefficients 9",
        "--alpha 3",
        "--alpha-radius 3",
        "--weights min-max",
        "--select adaptive",
        "--refit=shape",
        "--label 3",
        "--gray 0..9",
        "--gray-out",
        "--balls power",
        "--engine native",
        "--blocks 2",
        "--memory 1G",
        "--exterior",
        "--hidden",
        "--periodic 9,9,9",
    ] {
        let name = option.split([' ', '=']).next().unwrap();
        fails(f, 2, &format!("shape ball.nrrd --surface 1000 {option}"), &["--surface", name]);
    }
    fails(f, 2, "shape ball.nrrd --surface 1000 --require-3d", &["--require-3d"]);
    fails(f, 2, "shape ball.nrrd --surface 1000 --each-label -o all", &["--each-label"]);
    fails(f, 2, "shape ball.nrrd --surface 1000 -o ball.wvm", &["ball.wvm"]);
    fails(f, 2, "shape ball.nrrd --surface much", &["--surface", "is not a value"]);
    for command in ["points", "interpolate", "filtration", "ladder", "view"] {
        let output = if command == "view" { "a.html" } else { "a" };
        let output = if command == "points" { "a.csv" } else { output };
        let output = if command == "filtration" { "a.json" } else { output };
        let output = if command == "interpolate" { "a.nrrd" } else { output };
        let args = format!("{command} ball.nrrd --surface 1000 -o {output}");
        fails(f, 1, &args, &["the solid inside an isosurface"]);
    }
    fs::write(f.join("a.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    fails(f, 2, "shape a.xyz --surface 1", &["--surface", "holds points"]);
    fails(f, 1, "shape ball.nrrd --surface 5000", &["no sample reaches the value 5000", "smaller"]);
    // Given over a preset, either takes the place of the other.
    let told = ok(f, &["shape", "ball.nrrd", "--preset", "ct-bone", "--surface", "1000"]);
    names(&told, &["surface   at 1000"]);
    let (_, told, stderr) = run(f, &["shape", "ball.nrrd", "--preset", "mri", "--count", "50"]);
    assert!(told.contains("50 selected") && !told.contains("surface   at"), "{told}{stderr}");
}

/// One closed head, of all tissue but bone, with specks of noise left out.
#[test]
fn an_mri_gives_the_head() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "t1.nrrd", [48, 48, 48], head);
    let made = json(
        f,
        &["shape", "t1.nrrd", "--preset", "mri", "--units", "voxel", "--solid", "-o", "t1.stl"],
    );
    let value = made["isovalue"]["value"].as_f64().unwrap();
    assert!(made["isovalue"]["found"] == true && value > 145.0 && value < 380.0, "{value}");
    let betti: Vec<u64> = serde_json::from_value(made["shape"]["betti"].clone()).unwrap();
    assert_eq!((betti[0], betti[2]), (1, 0), "{made}");
    // From the scalp in, with its bone and its ventricles.
    let ellipsoid = 4.0 / 3.0 * std::f64::consts::PI * 17.0 * 20.0 * 18.0;
    let share = made["shape"]["volume"].as_f64().unwrap() / ellipsoid;
    assert!((share - 1.0).abs() < 0.08, "{share}");
    // Without that, bone and ventricles are voids.
    let open = json(f, &["shape", "t1.nrrd", "--surface", "auto", "--units", "voxel"]);
    let voids = open["shape"]["components"][0]["voids"].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let shut_in: f64 = voids.iter().map(|void| number(&void["volume"])).sum();
    let lost = number(&made["shape"]["volume"]) - number(&open["shape"]["volume"]);
    assert!(voids.len() == 2 && (lost / shut_in - 1.0).abs() < 1e-6, "{lost} {open}");
    names(&ok(f, &["shape", "t1.nrrd", "--preset", "mri"]), &["divides the histogram", "Otsu"]);
}

/// Nothing divides samples that are all equal, and nothing is left of samples that are not finite.
#[test]
fn samples_without_a_surface_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "constant.nrrd", [4, 4, 4], |_| 7.0);
    save(f, "nan.nrrd", [4, 4, 4], |_| f64::NAN);
    for (args, words) in [
        ("shape constant.nrrd --surface auto", ["all samples are 7", "give a value"]),
        ("shape constant.nrrd --preset mri", ["all samples are 7", "give a value"]),
        ("shape nan.nrrd --nan", ["no sample is a finite number", "--nan VALUE"]),
        ("haar nan.nrrd --nan -o a.nrrd", ["no sample is a finite number", "--nan VALUE"]),
    ] {
        let (code, _, stderr) = run(f, &args.split(' ').collect::<Vec<_>>());
        assert_eq!(code, 1, "{args}\n{stderr}");
        names(&stderr, &words);
    }
}
