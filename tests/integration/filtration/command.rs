//! `walpha filtration`, and what other commands make of its files.

use crate::common;

#[test]
fn the_command_writes_checks_and_compares() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let make = ["filtration", "sample:phantom@12", "--weights", "min-max", "-o"];
    let told = common::json(f, &[&make[..], &["a.json", "a.npz", "a.txt"]].concat());
    assert_eq!(told["files"].as_array().unwrap().len(), 3);
    assert!(told["persistence"]["components"].as_array().is_some());
    let checked = common::ok(f, &["check", "a.npz"]);
    assert!(checked.contains("exact: no findings"), "{checked}");
    common::ok(f, &["compare", "a.json", "a.npz"]);
    let text = std::fs::read_to_string(f.join("a.json")).unwrap();
    let wrong =
        text.replacen("\"gabriel\":{\"vertices\":[true", "\"gabriel\":{\"vertices\":[false", 1);
    let wrong = if wrong == text {
        text.replacen("\"gabriel\":{\"vertices\":[false", "\"gabriel\":{\"vertices\":[true", 1)
    } else {
        wrong
    };
    std::fs::write(f.join("b.json"), wrong).unwrap();
    let (code, said, _) = common::run(f, &["check", "b.json"]);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("Gabriel"), "{said}");
    assert_eq!(common::run(f, &["compare", "a.json", "b.json"]).0, 3);
    let (code, _, said) = common::run(f, &["check", "a.npz", "--alpha", "3"]);
    assert_eq!(code, 2, "{said}");
    common::ok(f, &["shape", "sample:phantom@12", "-o", "shape.json"]);
    assert_eq!(common::run(f, &["compare", "shape.json", "a.json"]).0, 1);
}
