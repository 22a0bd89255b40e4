//! `walpha check` and `walpha compare`.

mod common;

/// What has no sphere is a finding, and an exit code of its own.
#[test]
fn corners_in_one_place_are_a_finding() {
    let folder = tempfile::tempdir().unwrap();
    let points = r#""points":[[0,0,0],[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"alpha":1"#;
    for rows in [r#""facets":[[0,1,2]]"#, r#""edges":[[0,1]]"#, r#""cells":[[0,1,2,3]]"#] {
        std::fs::write(folder.path().join("c.json"), format!("{{{points},{rows}}}")).unwrap();
        let (code, stdout, stderr) = common::run(folder.path(), &["check", "c.json"]);
        assert_eq!(code, 3, "{rows}: {stdout}{stderr}");
    }
}

/// The command says what it compared, and fails where that differs.
#[test]
fn the_command_compares_weights_and_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, weight: f64, alpha: f64| {
        let points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
        let text = format!(
            r#"{{"points":{points},"weights":[{weight},0,0,0],"alpha":{alpha},"cells":[[0,1,2,3]]}}"#
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("a.json", 0.0, 1.0);
    write("heavy.json", 0.25, 1.0);
    write("high.json", 0.0, 2.0);
    for (other, code, words) in [
        ("a.json", 0, "equal in all that was compared"),
        ("heavy.json", 3, "weights that differ: 1"),
        ("high.json", 3, "α: 1 in A, 2 in B"),
    ] {
        let (got, stdout, _) = common::run(folder.path(), &["compare", "a.json", other]);
        assert_eq!(got, code, "{stdout}");
        assert!(stdout.contains(words), "{stdout}");
        assert!(stdout.contains("not compared: "), "{stdout}");
    }
}
