//! Single items, as their commands make them.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use super::read_all;
use crate::common::{ok, run};

/// The command of each item makes its files, under their names, and no others; those of its parts make the files
/// that they name. All as the whole run has them.
pub fn commands_make_their_files(files: &BTreeMap<String, Vec<u8>>, report: &Value) {
    let mut by_hand = 0;
    for item in report["items"].as_array().unwrap() {
        let folder = tempfile::tempdir().unwrap();
        let f = folder.path();
        let words = |command: &Value| -> Vec<String> {
            command.as_str().unwrap().split(' ').skip(1).map(String::from).collect()
        };
        let run = |words: &[String]| ok(f, &words.iter().map(String::as_str).collect::<Vec<_>>());
        let command = &item["command"];
        assert_eq!(words(command)[3..], ["--only", item["id"].as_str().unwrap()]);
        run(&words(command));
        let mut made = read_all(&f.join("reproduction"));
        let alone: Value = serde_json::from_slice(&made.remove("report.json").unwrap()).unwrap();
        assert_eq!(alone["items"].as_array().unwrap(), std::slice::from_ref(item), "{command}");
        assert_eq!(alone["complete"], false);
        let brief = String::from_utf8(made.remove("reproduction.md").unwrap()).unwrap();
        assert!(brief.contains(&format!("```sh\n{}\n```", command.as_str().unwrap())), "{brief}");
        assert!(brief.contains("Not all items"), "{brief}");
        let html = String::from_utf8(made.remove("report.html").unwrap()).unwrap();
        assert!(html.contains("Not all of it.") && !html.contains("In plain words."), "{command}");
        let listed = item["files"].as_array().unwrap().iter().chain([&item["picture"]]);
        let mut listed: Vec<&str> = listed.filter_map(Value::as_str).collect();
        listed.sort_unstable();
        assert_eq!(made.keys().collect::<Vec<_>>(), listed, "{command}");
        for (name, bytes) in &made {
            assert!(*bytes == files[name], "{command} makes another {name}");
        }

        for command in item["commands"].as_array().unwrap() {
            let words = words(command);
            run(&words);
            let Some(at) = words.iter().position(|word| word == "-o") else { continue };
            let name = &words[at + 1];
            let made = fs::read(f.join(name)).unwrap();
            if let Some(bytes) = files.get(name) {
                assert!(made == *bytes, "{command} makes another {name}");
                by_hand += 1;
            }
        }
    }
    assert_eq!(by_hand, 8, "meshes made by hand");
}

#[test]
fn items_come_in_the_order_of_the_report_and_once() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let args = "reproduce --input sample:phantom@12 --only figure-04,table-1 --only figure-04 --out a --json";
    let report: Value = serde_json::from_str(&ok(f, &args.split(' ').collect::<Vec<_>>())).unwrap();
    let ids: Vec<_> = report["items"].as_array().unwrap().iter().map(|item| &item["id"]).collect();
    assert_eq!(ids, ["table-1", "figure-04"]);
    assert_eq!(report["verdicts"]["reproduced"], 6);
}

#[test]
fn unknown_items_are_told_which_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (name, near) in [("figure-6", "figure-06"), ("table-2", "table-1")] {
        let (code, stdout, stderr) = run(f, &["reproduce", "--only", name]);
        assert_eq!((code, stdout.as_str()), (2, ""), "{stderr}");
        let next = stderr.lines().find(|line| line.trim_start().starts_with("next:")).unwrap();
        assert!(next.contains(near), "{stderr}");
        for known in ["table-1", "figure-01", "figure-11", "extension-2"] {
            assert!(stderr.contains(known), "no {known} in {stderr}");
        }
    }
    assert_eq!(fs::read_dir(f).unwrap().count(), 0);
}
