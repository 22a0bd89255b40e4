//! Segmentations: what they are taken for, and the solids of their labels.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{fails, json, names, ok, run};

/// An uncompressed NRRD of bytes, of 1 × 1 × 2 mm voxels whose z axis points down; x fastest.
fn save(
    folder: &Path,
    name: &str,
    sizes: [usize; 3],
    more: &str,
    label: impl Fn([usize; 3]) -> u8,
) {
    let [x, y, z] = sizes;
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {x} {y} {z}\nencoding: raw\nspace: LPS\n\
         space directions: (1,0,0) (0,1,0) (0,0,-2)\nspace origin: (5,6,7)\nspace units: \"mm\" \"mm\" \"mm\"\n{more}\n"
    );
    let at = |i: usize| label([i % x, i / x % y, i / x / y]);
    let samples = (0..x * y * z).map(at);
    fs::write(
        folder.join(name),
        header.into_bytes().into_iter().chain(samples).collect::<Vec<_>>(),
    )
    .unwrap();
}

/// A ball of label 1 with a core of label 2.
fn ball([x, y, z]: [usize; 3]) -> u8 {
    let from = |i: usize, step: f64, middle: f64| (i as f64 * step - middle).powi(2);
    let squared = from(x, 1.0, 9.5) + from(y, 1.0, 9.5) + from(z, 2.0, 9.0);
    u8::from(squared < 64.0) + u8::from(squared < 16.0)
}

/// The voxels of a ball of 20 × 20 × 10 with a label that `is` one of those wanted.
fn count(is: impl Fn(u8) -> bool) -> u64 {
    (0..4000).filter(|i| is(ball([i % 20, i / 20 % 20, i / 400]))).count() as u64
}

fn balls(folder: &Path) {
    save(folder, "ball.nrrd", [20, 20, 10], "", ball);
}

#[test]
fn a_segmentation_gives_its_solid() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    let facts = json(f, &["info", "ball.nrrd"]);
    let (one, two) = (count(|l| l == 1), count(|l| l == 2));
    assert_eq!((&facts["preset"], &facts["labels"]["stated"]), (&"labels".into(), &false.into()));
    assert_eq!(facts["labels"]["labels"][0]["voxels"], one);
    assert_eq!(facts["labels"]["labels"][1]["volume"], 2.0 * two as f64);
    names(
        &ok(f, &["info", "ball.nrrd"]),
        &["labels    the values look like labels", &format!("2: {two} voxels, {} mm³", 2 * two)],
    );

    for (options, voxels) in [
        (&[][..], one + two),
        (&["--label", "all"], one + two),
        (&["--preset", "labels"], one + two),
        (&["--label", "2"], two),
        (&["--label", "2,1"], one + two),
        (&["--units", "voxel", "--label", "1"], one),
    ] {
        let made = json(f, &[&["shape", "ball.nrrd"], options].concat());
        let voxel = if options.contains(&"voxel") { 1.0 } else { 2.0 };
        assert_eq!(made["labels"]["voxels"], voxels, "{options:?}");
        assert_eq!(made["shape"]["volume"], voxel * voxels as f64, "{options:?}");
        assert_eq!(made["labels"]["volume"], made["shape"]["volume"]);
        assert_eq!(
            (&made["alpha"], &made["haar"], &made["weights"]),
            (&Value::Null, &Value::Null, &Value::Null)
        );
        assert_eq!(made["shape"]["betti"][0], 1);
        assert_eq!(made["shape"]["betti"][2], u64::from(options.contains(&"1")), "{options:?}");
    }
    let (_, told, warned) = run(f, &["shape", "ball.nrrd"]);
    names(&told, &["labels    1, 2: ", "without α"]);
    assert!(!told.contains("weights") && !told.contains("parameter"), "{told}");
    names(&warned, &["the values look like labels (1, 2)", "--preset labels", "--label"]);
    let (_, _, warned) = run(f, &["shape", "ball.nrrd", "--label", "1"]);
    assert!(!warned.contains("look like"), "{warned}");
}

/// Options that choose by gray levels make the α-shape, not the solid of labels.
#[test]
fn options_of_gray_levels_take_precedence() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    let mut found = 0;
    for options in [
        ["--threshold", "0"],
        ["--count", "300"],
        ["--ratio", "0.2"],
        ["--alpha", "3"],
        ["--weights", "min-max"],
        ["--rms", "0"],
    ] {
        let (code, stdout, stderr) =
            run(f, &["shape", "ball.nrrd", options[0], options[1], "--json"]);
        if code == 1 {
            // If gray levels are searched for, the wavelet stage leaves nothing of values up to 2.
            let report: Value = serde_json::from_str(&stdout).unwrap();
            let why = report["error"]["why"].as_str().unwrap();
            assert!(why.contains("nothing tells which samples to select"), "{why} {stderr}");
            continue;
        }
        let made: Value = serde_json::from_str(&stdout).unwrap();
        assert_eq!(made["labels"], Value::Null, "{options:?}");
        assert!(made["alpha"]["squared"].is_number());
        found += 1;
    }
    assert!(found >= 2, "{found}");
}

/// The offset of single precision is reported for the solid of labels, and for each label.
#[test]
fn solids_far_from_the_origin_report_their_offset() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    let near = fs::read_to_string(f.join("ball.nrrd")).unwrap();
    fs::write(f.join("far.nrrd"), near.replace("(5,6,7)", "(434000.3,5412000.3,0)")).unwrap();
    let is_far = |offsets: &Value, file: &str| {
        let stated = json!([{ "file": file, "offset": [430_000.0, 5_400_000.0, 0.0] }]);
        assert_eq!(*offsets, stated);
    };
    let made = json(f, &["shape", "far.nrrd", "-o", "b.stl"]);
    is_far(&made["offsets"], "b.stl");
    let each = json(f, &["shape", "far.nrrd", "--each-label", "-o", "parts"]);
    is_far(&each["labels"][0]["offsets"], "label-1.stl");
    is_far(&each["labels"][1]["offsets"], "label-2.stl");
    assert_eq!(json(f, &["shape", "ball.nrrd", "-o", "b.stl"])["offsets"], Value::Null);
}

#[test]
fn what_labels_have_no_use_for_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    for option in [
        "--alpha 3",
        "--threshold 1",
        "--rms 2",
        "--weights min-max",
        "--gray 0..3",
        "--exterior",
        "--engine native",
        "--refit",
    ] {
        let name = option.split(' ').next().unwrap();
        fails(
            f,
            2,
            &format!("shape ball.nrrd --label 1 {option}"),
            &[name, "no effect", "solid of labels"],
        );
    }
    fails(f, 2, "shape ball.nrrd --hidden", &["--hidden has no effect", "solid of labels"]);
    fails(f, 1, "shape ball.nrrd --label 1,7", &["no voxel has the label 7", "there are 1, 2"]);
    fails(f, 2, "shape ball.nrrd --label one", &["\"one\" is not a label"]);
    fails(f, 2, "shape ball.nrrd -o ball.wvm", &["ball.wvm holds points", "solid of labels"]);
    fails(f, 1, "shape sample:phantom@16 --label 1", &["whole numbers"]);
    for command in [
        "points ball.nrrd -o p.csv",
        "ladder ball.nrrd -o l",
        "filtration ball.nrrd -o f.npz",
        "blocks plan ball.nrrd -o b --blocks 2",
    ] {
        fails(f, 1, command, &["holds labels", "`walpha shape`", "--threshold"]);
    }
    fs::write(f.join("p.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    fails(f, 2, "shape p.xyz --label 1", &["--label has no effect", "holds points"]);
}

/// Files state it: 3D Slicer's segmentations, and the intent of `NIfTI`.
#[test]
fn files_state_labels() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // A single voxel in each of two corners: no flat region.
    let sparse = |at: [usize; 3]| u8::from(at == [0; 3]) + 3 * u8::from(at == [3; 3]);
    save(f, "keys.nrrd", [4, 4, 4], "Segment0_LabelValue:=1\n", sparse);
    save(f, "name.seg.nrrd", [4, 4, 4], "", sparse);
    save(f, "none.nrrd", [4, 4, 4], "Segmentation_Source:=1\n", sparse);
    nifti(f, "intent.nii", 1002, sparse);
    nifti(f, "other.nii", 0, sparse);
    for (name, stated) in [
        ("keys.nrrd", true),
        ("name.seg.nrrd", true),
        ("none.nrrd", false),
        ("intent.nii", true),
        ("other.nii", false),
    ] {
        for options in [&[][..], &["--roi", ":,:,:"], &["--nan"]] {
            let facts = json(f, &[&["info", name], options].concat());
            assert_eq!(facts["labels"]["stated"] == true, stated, "{name} {options:?}");
        }
        if stated {
            let made = json(f, &["shape", name]);
            assert_eq!(
                (&made["labels"]["voxels"], &made["shape"]["betti"][0]),
                (&2.into(), &2.into()),
                "{name}"
            );
        }
    }
    names(&ok(f, &["info", "keys.nrrd"]), &["the file states labels"]);
}

/// An uncompressed NIfTI-1 of 4³ bytes, in millimetres.
fn nifti(folder: &Path, name: &str, intent: i16, label: impl Fn([usize; 3]) -> u8) {
    let mut bytes = vec![0; 352];
    bytes[..4].copy_from_slice(&348i32.to_le_bytes());
    let mut shorts = |at: usize, numbers: &[i16]| {
        for (k, number) in numbers.iter().enumerate() {
            bytes[at + 2 * k..at + 2 * k + 2].copy_from_slice(&number.to_le_bytes());
        }
    };
    shorts(40, &[3, 4, 4, 4, 1, 1, 1, 1]);
    shorts(68, &[intent]);
    shorts(70, &[2, 8]);
    for k in 0..4 {
        bytes[76 + 4 * k..80 + 4 * k].copy_from_slice(&1f32.to_le_bytes());
    }
    bytes[108..112].copy_from_slice(&352f32.to_le_bytes());
    bytes[123] = 2;
    bytes[344..348].copy_from_slice(b"n+1\0");
    bytes.extend((0..64).map(|i| label([i % 4, i / 4 % 4, i / 16])));
    fs::write(folder.join(name), bytes).unwrap();
}

/// A file for each label, each closed, and each alone.
#[test]
fn each_label_has_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    let made = json(
        f,
        &["shape", "ball.nrrd", "--each-label", "--solid", "-o", "parts", "--mesh", "stl,off"],
    );
    let (one, two) = (count(|l| l == 1), count(|l| l == 2));
    assert_eq!(made["labels"][0]["voxels"], one);
    assert_eq!(made["labels"][0]["betti"][2], 1);
    assert_eq!(
        (&made["labels"][1]["label"], &made["labels"][1]["volume"]),
        (&2.into(), &(2.0 * two as f64).into())
    );
    let mut files: Vec<String> = fs::read_dir(f.join("parts"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files, ["label-1.off", "label-1.stl", "label-2.off", "label-2.stl"]);
    assert!((volume_of_stl(&f.join("parts/label-1.stl")) - 2.0 * one as f64).abs() < 1e-2);
    names(
        &ok(f, &["shape", "ball.nrrd", "--each-label", "--label", "2", "-o", "two"]),
        &["label     2: ", "label-2.stl"],
    );
    assert!(!f.join("two/label-1.stl").exists());
    fails(f, 1, "shape ball.nrrd --each-label --label 5 -o five", &["label 5", "there are 1, 2"]);
    fails(
        f,
        2,
        "shape ball.nrrd --each-label",
        &["--each-label writes a file for each label to one folder"],
    );
    fails(f, 2, "shape ball.nrrd --mesh ply", &["--each-label"]);
}

/// The volume that the facets of a binary STL enclose.
fn volume_of_stl(path: &Path) -> f64 {
    let bytes = fs::read(path).unwrap();
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let facet = |k: usize| {
        let corner = |c: usize| [0, 1, 2].map(|i| number(84 + 50 * k + 12 + 12 * c + 4 * i));
        let [a, b, c] = [corner(0), corner(1), corner(2)];
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    (0..(bytes.len() - 84) / 50).map(facet).sum::<f64>() / 6.0
}

/// The value of a corner is the label that most of its voxels have, of equally many the least.
#[test]
fn corners_have_labels() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "two.nrrd", [2, 1, 1], "Segment0_ID:=a\n", |[x, _, _]| [5, 3][x]);
    ok(f, &["shape", "two.nrrd", "-o", "two.json"]);
    let file: Value = serde_json::from_slice(&fs::read(f.join("two.json")).unwrap()).unwrap();
    // x = 4.5, 5.5 and 6.5, where the middle is shared.
    assert_eq!(
        file["info"]["values"],
        serde_json::json!([5.0, 3.0, 3.0, 5.0, 3.0, 3.0, 5.0, 3.0, 3.0, 5.0, 3.0, 3.0])
    );
    assert_eq!(file["voxels"]["runs"], serde_json::json!([[0, 2]]));
    assert_eq!(file["points"][0], serde_json::json!([4.5, 5.5, 8.0]));
}

/// A written solid states what it is, and is judged by it; a changed one is wrong.
#[test]
fn solids_are_certified() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    // Deep voxels, a mirrored axis, and a hole.
    ok(f, &["shape", "ball.nrrd", "--label", "1", "-o", "one.json", "one.npz"]);
    for name in ["one.json", "one.npz", "ball.nrrd"] {
        let judged = json(f, &["check", name]);
        assert_eq!(
            (&judged["verdict"], &judged["extent"]),
            (&"exact".into(), &"labels".into()),
            "{name}"
        );
        assert_eq!(judged["certificate"]["not_judged"], serde_json::json!([]));
    }
    names(&ok(f, &["check", "one.json"]), &["the solid of ", "exact: no findings"]);
    let file: Value = serde_json::from_slice(&fs::read(f.join("one.json")).unwrap()).unwrap();
    let changed = |name: &str, change: &dyn Fn(&mut Value)| {
        let mut file = file.clone();
        change(&mut file);
        fs::write(f.join(name), file.to_string()).unwrap();
        let (code, told, errors) = run(f, &["check", name, "--json"]);
        assert_eq!(code, 3, "{name}: {told}{errors}");
        let told: Value = serde_json::from_str(&told).unwrap();
        assert_eq!(told["verdict"], "wrong", "{name}");
        told["findings_by_rule"].as_object().unwrap().keys().cloned().collect::<Vec<_>>()
    };
    let has = |rules: Vec<String>, rule: &str| {
        assert!(rules.iter().any(|r| r == rule), "{rule}: {rules:?}");
    };
    has(
        changed("cell.json", &|file| {
            file["cells"].as_array_mut().unwrap().remove(2000);
            file["classes"]["cells"].as_array_mut().unwrap().remove(2000);
        }),
        "not_a_border",
    );
    has(changed("run.json", &|file| file["voxels"]["runs"][0][1] = 1.into()), "not_a_border");
    has(
        changed("longer.json", &|file| {
            let runs = file["voxels"]["runs"].as_array_mut().unwrap();
            let end = runs.pop().unwrap();
            runs.push(serde_json::json!([end[0], end[1].as_u64().unwrap() + 1]));
        }),
        "unfilled",
    );
    has(changed("moved.json", &|file| file["points"][9][0] = 1e-9.into()), "not_a_corner");
    has(changed("grid.json", &|file| file["voxels"]["origin"][2] = 8.into()), "not_a_corner");
    has(changed("class.json", &|file| file["classes"]["edges"][4] = "singular".into()), "class");
    has(changed("exterior.json", &|file| file["classes"]["cells"][4] = "exterior".into()), "class");
    has(
        changed("edge.json", &|file| {
            file["edges"].as_array_mut().unwrap().pop();
            file["classes"]["edges"].as_array_mut().unwrap().pop();
        }),
        "missing_face",
    );
    has(
        changed("point.json", &|file| {
            file["points"].as_array_mut().unwrap().push(serde_json::json!([4.5, 5.5, 8.0]));
            file["weights"].as_array_mut().unwrap().push(0.into());
        }),
        "unaccounted",
    );
    // Without its voxels it is not an α-shape.
    has(
        changed("alpha.json", &|file| _ = file.as_object_mut().unwrap().remove("voxels")),
        "hull_bends",
    );
    fails(f, 2, "check one.json --alpha 2", &["--alpha has no effect", "of labels"]);
    fails(f, 1, "check one.json --enumerate", &["--enumerate builds α-shapes"]);
    let mut unsound = file.clone();
    unsound["voxels"]["runs"][0] = serde_json::json!([5, 1_000_000]);
    fs::write(f.join("unsound.json"), unsound.to_string()).unwrap();
    fails(f, 1, "check unsound.json", &["ascending runs of voxels"]);
}

/// From 2²⁴ on, single precision does not distinguish labels.
#[test]
fn labels_that_are_rounded_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let file = |label: i32| {
        let header =
            "NRRD0004\ntype: int\ndimension: 3\nsizes: 4 4 4\nendian: little\nencoding: raw\n\n";
        let label = |i: i32| if i % 4 < 2 { 0 } else { label + i % 2 };
        [header.as_bytes(), &(0..64).flat_map(|i| label(i).to_le_bytes()).collect::<Vec<u8>>()]
            .concat()
    };
    fs::write(f.join("large.nrrd"), file(1 << 24)).unwrap();
    fs::write(f.join("small.nrrd"), file((1 << 24) - 2)).unwrap();
    let told = ["cannot be told apart", "16777216", "number them anew, below 16777216"];
    fails(f, 1, "shape large.nrrd --label all -o a.ply", &told);
    // The file states labels, but they are not requested.
    fs::write(f.join("large.seg.nrrd"), file(1 << 24)).unwrap();
    let (_, _, told) = run(f, &["shape", "large.seg.nrrd", "-o", "a.ply"]);
    names(&told, &["not whole numbers below 16777216", "taken for gray levels"]);
    let labels =
        json(f, &["shape", "small.nrrd", "--label", "all", "-o", "a.ply"])["labels"].to_string();
    assert!(labels.contains("16777214") && labels.contains("16777215"), "{labels}");
}

/// Every format of a mesh says of what it is, and no α.
#[test]
fn all_formats_hold_solids() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    balls(f);
    let names = ["b.ply", "b.stl", "b.obj", "b.off", "b.glb", "b.vtp", "b.vtu", "b.json", "b.npz"];
    ok(f, &[&["shape", "ball.nrrd", "--solid", "-o"][..], &names].concat());
    for name in ["b.ply", "b.obj", "b.off", "b.vtp", "b.vtu", "b.stl"] {
        let bytes = fs::read(f.join(name)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains("solid of labels"), "{name}");
        assert!(!text.contains("α = ") && !text.contains("Name=\"alpha\""), "{name}");
    }
    assert!((volume_of_stl(&f.join("b.stl")) - 2.0 * count(|l| l > 0) as f64).abs() < 1e-2);
    fails(f, 1, "shape ball.nrrd -o b.svg", &["plane"]);
}
