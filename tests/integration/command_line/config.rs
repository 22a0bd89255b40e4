//! Files of options.

use super::*;

#[test]
fn a_file_sets_options_and_the_command_line_wins() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text = "alpha = 4\nrms = 2.5\nweights = 'min-max'\nquiet = false\n\n\
                [shape]\nalpha = 5.5\nexterior = true\n\n[points]\ncount = 100\n";
    fs::write(f.join("walpha.toml"), text).unwrap();
    let with = |args: &[&str]| json(f, &[args, &["--config", "walpha.toml"]].concat());
    let shape = with(&["shape", "sample:phantom@16"]);
    assert_eq!(shape["alpha"]["squared"], 5.5);
    assert_eq!(shape["weights"]["kind"], "min-max");
    assert!(shape["shape"]["voids"].is_array(), "exterior was set");
    let points = with(&["points", "sample:phantom@16"]);
    assert_eq!(points["alpha"]["squared"], 4.0);
    assert_eq!(points["points"]["selected"], 100);
    // What is given wins, over what it excludes, too.
    let given = with(&["points", "sample:phantom@16", "--alpha-radius", "3", "--ratio", "0.5"]);
    assert_eq!(given["alpha"]["squared"], 9.0);
    assert_eq!(given["points"]["selected"], 2048);
    let epsilon = with(&["haar", "sample:phantom@16", "--epsilon", "0"]);
    assert_eq!(epsilon["haar"]["rms"], 0.0);
}

#[test]
fn what_a_file_says_wrongly_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let cases = [
        ("alhpa = 4", "alhpa", "did you mean alpha?"),
        ("[shape]\nalhpa = 4", "[shape] alhpa", "did you mean alpha?"),
        ("[shape]\ninput = 'a.nrrd'", "[shape] input", ""),
        ("[shap]\nalpha = 4", "shap", "did you mean shape?"),
        ("config = 'b.toml'", "config", ""),
        ("alpha = ", "is no TOML file", "--print-config"),
        ("exterior = 3", "exterior = 3 makes no sense", "give true or false"),
        ("alpha = true", "alpha = true makes no sense", "give a text or a number"),
    ];
    for (text, why, next) in cases {
        fs::write(f.join("c.toml"), text).unwrap();
        let [_, got_why, got_next] = complaint(f, 2, "shape sample:phantom@8 --config c.toml");
        assert!(got_why.contains("c.toml") && got_why.contains(why), "{text}: {got_why}");
        assert!(got_next.contains(next), "{text}: {got_next}");
    }
    let [_, why, _] = complaint(f, 2, "shape sample:phantom@8 --config d.toml");
    assert!(why.contains("d.toml"), "{why}");
    fs::write(f.join("c.toml"), "alpha = 'ten'").unwrap();
    let [what, _, next] = complaint(f, 2, "shape sample:phantom@8 --config c.toml");
    assert!(what.contains("'ten'") && next.contains("--config"), "{what} {next}");
}

#[test]
fn what_is_printed_can_be_fed_back() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let given: [&[&str]; 5] = [
        &["shape"],
        &[
            "shape",
            "--alpha-radius",
            "3",
            "--count",
            "99",
            "-o",
            "a.ply",
            "b file.vtu",
            "--exterior",
        ],
        &["points", "a.raw", "--dims", "2,3,4", "--dtype", "u8", "--gray=-10..20", "--alpha=-1"],
        &["haar", "--epsilon", "1e3", "--threads", "1", "--json"],
        &["reproduce", "--out", "it's"],
    ];
    for args in given {
        let first = ok(f, &[args, &["--print-config"]].concat());
        let table: toml::Table = first.parse().unwrap();
        assert!(!table.is_empty(), "{first}");
        fs::write(f.join("walpha.toml"), &first).unwrap();
        let again = ok(f, &[args[0], "--config", "walpha.toml", "--print-config"]);
        assert_eq!(first, again);
    }
    let text = ok(f, &["shape", "--count", "99", "--print-config"]);
    assert!(text.contains("rms = 1\n") && text.contains("count = 99\n"), "{text}");
    assert!(!text.contains("ratio"), "excluded by --count: {text}");
}
