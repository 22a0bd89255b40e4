//! Texts that are made from the tables of formats: the tables of docs/formats.md, the list of fuzz targets, and help.

use std::collections::BTreeSet;
use std::path::Path;

use walpha::{export, points, volume};

use crate::common::ok;

fn file(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

fn dotted<'a>(extensions: impl IntoIterator<Item = &'a str>) -> String {
    let dotted: Vec<String> = extensions.into_iter().map(|e| format!(".{e}")).collect();
    if dotted.is_empty() { "–".into() } else { dotted.join(" ") }
}

/// The way a file to read is recognized: by its extension at the latest.
fn read(extensions: &'static [&str], tells: bool) -> String {
    match (extensions, tells) {
        ([], true) => "by content".into(),
        ([], false) => "with `--dims`".into(),
        _ => dotted(extensions.iter().copied()),
    }
}

/// The tables of docs/formats.md, as the library's are.
fn tables() -> String {
    let mut text =
        "| volumes | read | written | keeps | feature |\n|---|---|---|---|---|\n".to_owned();
    for format in &volume::FORMATS {
        let keeps = format.keeps;
        let kept = [
            ("spacing", keeps.spacing),
            ("place and directions", keeps.directions),
            ("space", keeps.space),
            ("unit", keeps.unit),
            ("type", keeps.dtype),
        ];
        let kept: Vec<&str> =
            kept.iter().filter(|(_, kept)| *kept).map(|(name, _)| *name).collect();
        text += &format!(
            "| {} | {} | {} | {} | {} |\n",
            format.name,
            read(format.extensions, format.keeps.dtype),
            dotted(format.writers.iter().map(|writer| writer.extension)),
            if kept.is_empty() { "samples".into() } else { kept.join(", ") },
            format.feature.unwrap_or("–"),
        );
    }
    text += "\n| points | read | written | feature |\n|---|---|---|---|\n";
    for format in &points::FORMATS {
        text += &format!(
            "| {} | {} | {} | {} |\n",
            format.name,
            dotted(format.extensions.iter().copied()),
            dotted(format.writers.iter().map(|writer| writer.extension)),
            format.feature.unwrap_or("–"),
        );
    }
    text += "\n| meshes, to be judged | read |\n|---|---|\n";
    for format in &walpha::check::meshes::FORMATS {
        text += &format!("| {} | {} |\n", format.name, dotted(format.extensions.iter().copied()));
    }
    text += "\n| shapes | written | holds |\n|---|---|---|\n";
    for format in &export::FORMATS {
        let (name, extension, about) = (format.name, format.extension, format.about);
        text += &format!("| {name} | .{extension} | {about} |\n");
    }
    text
}

/// The rows that say what this build can do: not those of writers that are part of the feature `las` alone.
fn built_in(text: &str) -> String {
    let left_out =
        if cfg!(feature = "las") { vec![] } else { vec!["| LAS, LAZ |", "| GeoPackage |"] };
    let is_kept = |line: &&str| !left_out.iter().any(|row| line.starts_with(row));
    text.lines().filter(is_kept).map(|line| format!("{line}\n")).collect()
}

#[test]
fn the_documentation_has_the_tables() {
    let (page, tables) = (built_in(&file("docs/formats.md")), built_in(&tables()));
    assert!(page.contains(&tables), "docs/formats.md lacks these tables:\n\n{tables}");
}

/// Every format that is read has a target, and every target is one of a format, of weights, of complexes, or of the files
/// of plans.
#[test]
fn every_reader_is_fuzzed() {
    let manifest: toml::Table = file("fuzz/Cargo.toml").parse().unwrap();
    let bins = manifest["bin"].as_array().unwrap();
    let targets: BTreeSet<&str> = bins.iter().map(|bin| bin["name"].as_str().unwrap()).collect();
    let bins = targets.iter().map(|name| format!("fuzz/fuzz_targets/{name}.rs"));
    bins.for_each(|path| assert!(file(&path).contains("fuzz_target!"), "{path}"));
    let of_volumes = volume::FORMATS.iter().flat_map(|format| format.fuzzed_by).copied();
    let of_points = points::FORMATS.iter().map(|format| format.fuzzed_by);
    let of_meshes = walpha::check::meshes::FORMATS.iter().map(|format| format.fuzzed_by);
    let complexes = ["weights", "complex", "check_json", "check_npz", "filtration"];
    let plans = ["plan", "block", "sums", "truncated"];
    let others = complexes.into_iter().chain(plans);
    let wanted: BTreeSet<&str> =
        of_volumes.chain(of_points).chain(of_meshes).chain(others).collect();
    assert_eq!(targets, wanted);
    // A file without a header is for its user to describe.
    for format in volume::FORMATS.iter().filter(|format| format.keeps.dtype) {
        assert!(!format.fuzzed_by.is_empty(), "{}", format.name);
    }
}

#[test]
fn help_knows_the_formats() {
    let folder = tempfile::tempdir().unwrap();
    let help = ok(folder.path(), &["--help"]).replace('\n', " ");
    let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    let names = volume::FORMATS.iter().map(|format| format.name);
    for name in names.chain(points::FORMATS.iter().map(|format| format.name)) {
        assert!(words.contains(name), "{name} is missing in: {words}");
    }
    let written = |command: &str| {
        let help = ok(folder.path(), &[command, "--help"]);
        help.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let haar = written("haar");
    for writer in volume::VolumeWriter::all() {
        assert!(haar.contains(&format!(".{}", writer.extension)), "{} in {haar}", writer.extension);
    }
    let shape = written("shape");
    for format in &export::FORMATS {
        assert!(shape.contains(&format!(".{}", format.extension)), "{}", format.name);
    }
}
