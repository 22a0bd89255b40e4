//! The paper, made again: files, numbers, and the same bytes each time.

mod brief;
mod only;
mod page;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{ok, run};

/// Runs on a small phantom; gives the files by name.
fn reproduction(threads: &str) -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let args = ["reproduce", "--input", "sample:phantom@24", "--out", "out", "--threads", threads];
    ok(folder.path(), &args);
    read_all(&folder.path().join("out"))
}

fn read_all(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let file = |entry: fs::DirEntry| {
        (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
    };
    entries.map(file).collect()
}

#[test]
fn all_there_and_the_same_each_time() {
    let files = reproduction("2");
    let mut report: Value = serde_json::from_slice(&files["report.json"]).unwrap();
    let ids: Vec<_> =
        report["items"].as_array().unwrap().iter().map(|i| i["id"].as_str().unwrap()).collect();
    let figures: Vec<String> = (1..=11).map(|k| format!("figure-{k:02}")).collect();
    assert_eq!(ids[0], "table-1");
    assert_eq!(ids[1..12], figures);
    assert_eq!(ids[12..], ["extension-1", "extension-2"]);

    // Each figure has a picture, each file named is there, and none is there without a name.
    let mut named = ["report.html", "report.json", "reproduction.md"].map(String::from).to_vec();
    for item in report["items"].as_array().unwrap() {
        let picture = item["picture"].as_str();
        assert_eq!(picture.is_some(), item["id"] != "table-1", "{}", item["id"]);
        if let Some(name) = picture {
            let decoded = image::load_from_memory(&files[name]).unwrap();
            assert!(decoded.width() >= 1600, "{name}");
            named.push(name.to_owned());
        }
        named.extend(item["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap().into()));
    }
    named.sort();
    assert_eq!(files.keys().cloned().collect::<Vec<_>>(), named);

    page::numbers_stand_in_the_report(&files, &report);
    shapes_agree_with_the_shape_command(&report);
    only::commands_make_their_files(&files, &report);

    let mut again = reproduction("1");
    assert_eq!(again.keys().collect::<Vec<_>>(), files.keys().collect::<Vec<_>>());
    let mut other: Value = serde_json::from_slice(&again.remove("report.json").unwrap()).unwrap();
    for (name, bytes) in &again {
        assert!(*bytes == files[name], "{name} differs between two runs");
    }
    for report in [&mut report, &mut other] {
        assert!(report.as_object_mut().unwrap().remove("seconds").is_some());
    }
    assert_eq!(report, other);
}

/// The command lines of the report give its numbers.
fn shapes_agree_with_the_shape_command(report: &Value) {
    let folder = tempfile::tempdir().unwrap();
    let mut compared = 0;
    for item in report["items"].as_array().unwrap() {
        for shape in item["shapes"].as_array().unwrap() {
            let command = shape["command"].as_str().unwrap();
            let args: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
            let told: Value = serde_json::from_str(&ok(folder.path(), &args)).unwrap();
            assert_eq!(told["points"]["selected"], shape["points"], "{command}");
            assert_eq!(told["points"]["hidden"], shape["hidden"], "{command}");
            assert_eq!(told["points"]["in_shape"], shape["points_in_shape"], "{command}");
            assert_eq!(told["shape"]["cells"]["interior"], shape["cells"], "{command}");
            for rows in ["facets", "edges", "vertices", "betti", "volume", "area"] {
                assert_eq!(told["shape"][rows], shape[rows], "{rows} of {command}");
            }
            let voids = told["shape"]["voids"].as_array().unwrap();
            assert_eq!(voids.len() as u64, shape["betti"][2].as_u64().unwrap(), "{command}");
            let volumes = voids.iter().map(|void| void["volume"].as_f64().unwrap());
            let sum = volumes.fold(0.0, |sum, volume| sum + volume);
            assert_eq!(sum, shape["void_volume"].as_f64().unwrap(), "{command}");
            compared += 1;
        }
    }
    assert!(compared >= 8, "{compared} shapes");
}

/// Also for samples that are not gray levels.
#[test]
fn commands_of_the_report_make_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let phantom = walpha::volume::phantom(16).unwrap().samples().mapv(|gray| 3.0 * gray - 100.0);
    ndarray_npy::write_npy(f.join("v.npy"), &phantom).unwrap();
    ok(f, &["reproduce", "--input", "v.npy", "--only", "figure-06", "--out", "made"]);
    let report = fs::read_to_string(f.join("made/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let command = report["items"][0]["shapes"][0]["command"].as_str().unwrap();
    let by_hand = command.split(' ').skip(1).chain(["-o", "by-hand.ply"]).collect::<Vec<_>>();
    ok(f, &by_hand);
    let bytes = |name: &str| fs::read(f.join(name)).unwrap();
    assert!(bytes("by-hand.ply") == bytes("made/figure-06.ply"), "{command}");
}

#[test]
fn bad_places_and_bad_inputs_leave_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("file"), "precious").unwrap();
    fs::write(f.join("p.csv"), "x,y,z\n0,0,0\n1,0,0\n").unwrap();
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--input", "p.csv", "--out", "out"], &["p.csv holds points", "finite samples"]),
        (&["--input", "sample:phantom@12", "--out", "file"], &["file", "--out"]),
        (&["--input", "sample:phantom@12", "--out", "no/such/folder"], &["no/such/folder"]),
        (&["--input", "nothing.inr", "--out", "out"], &["nothing.inr"]),
        (&["--input", "sample:phantom@1", "--out", "out"], &["1 distinct points"]),
    ];
    for (args, words) in cases {
        let (code, stdout, stderr) = run(f, &[&["reproduce"], args].concat());
        assert_eq!((code, stdout.as_str()), (1, ""), "{args:?}\n{stderr}");
        for word in words {
            assert!(stderr.contains(word), "{args:?}: no {word:?} in\n{stderr}");
        }
        assert_eq!(fs::read_dir(f).unwrap().count(), 2, "{args:?} left something behind");
    }
    assert_eq!(fs::read_to_string(f.join("file")).unwrap(), "precious");
}

#[test]
fn a_shape_is_drawn_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let draw = |options: &str| {
        let args = format!("shape sample:phantom@12 --ratio 0.3 -q -o a.png {options}");
        ok(f, &args.trim_end().split(' ').collect::<Vec<_>>());
        image::load_from_memory(&fs::read(f.join("a.png")).unwrap()).unwrap().into_rgba8()
    };
    let size = "--size 96x64";
    let plain = draw(size);
    assert_eq!(plain.dimensions(), (96, 64));
    let drawn = plain.pixels().filter(|p| p.0 != [255; 4]).count();
    assert!(drawn > 600 && drawn < 96 * 64, "{drawn} pixels");
    let others = ["--view back", "--camera 60,5,5,5,5,5", "--colour value", "--colour class"];
    for other in others {
        assert!(draw(&format!("{size} {other}")) != plain, "{other} changes nothing");
    }
    assert!(draw(&format!("{size} --view three-quarter")) == plain);

    fs::write(f.join("p.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    let cases = [
        ("shape p.csv -o b.png --colour value", 1, "no values for --colour value"),
        ("shape p.csv -o b.png --size 0x9", 2, "0×9"),
        ("shape p.csv -o b.png --camera 1,2,3,1,2,3", 2, "two places"),
        ("shape p.csv -o b.png --view top --camera 1,2,3,0,0,0", 2, "cannot be used with"),
    ];
    for (args, code, word) in cases {
        let (got, _, stderr) = run(f, &args.split(' ').collect::<Vec<_>>());
        assert!(got == code && stderr.contains(word), "{args}: {got}\n{stderr}");
        assert!(!f.join("b.png").exists());
    }
}
