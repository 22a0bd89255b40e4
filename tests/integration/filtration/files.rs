//! Files of filtrations: they come back, and the checker finds nothing in them.

use std::io::Cursor;
use std::path::Path;

use walpha::WeightedPoints;
use walpha::check::schema::FiltrationFile;
use walpha::check::{FiltrationFinding, Unjudged, certify_filtration, compare_filtrations};
use walpha::export::FiltrationFormat;
use walpha::ladder::{Filtration, Ordered};

use super::sets;

fn written(ordered: &Ordered<'_>, extension: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let format = FiltrationFormat::of(&Path::new("a").with_extension(extension)).unwrap();
    format.write(ordered, &mut bytes).unwrap();
    bytes
}

pub fn file(ordered: &Ordered<'_>) -> FiltrationFile {
    let json = FiltrationFile::read_json(&written(ordered, "json")[..]).unwrap();
    let npz = Cursor::new(written(ordered, "npz"));
    let mut npz = FiltrationFile::read_npz(npz).unwrap();
    npz.info.clone_from(&json.info);
    assert_eq!(npz, json);
    json
}

pub fn findings(file: &FiltrationFile) -> Vec<FiltrationFinding> {
    certify_filtration(file).unwrap().0
}

/// The checker computes all values by itself.
#[test]
fn the_checker_finds_nothing() {
    for points in sets(180, 40) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let file = file(&ordered);
        let (findings, certificate) = certify_filtration(&file).unwrap();
        assert_eq!(findings, [], "{points:?}");
        assert_eq!(certificate.values, ordered.values().len());
        assert!(compare_filtrations(&file, &file).unwrap().is_equal());
    }
}

#[test]
fn text_has_a_line_for_each_simplex() {
    let points = sets(1, 12).next().unwrap();
    let filtration = Filtration::new(points).unwrap();
    let ordered = filtration.simplices().unwrap();
    let text = String::from_utf8(written(&ordered, "txt")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("# value gabriel regular interior vertices"));
    for (line, simplex) in lines.by_ref().zip(ordered.iter()) {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        let gabriel = f64::from(u8::from(simplex.gabriel));
        assert_eq!(numbers[..4], [simplex.value, gabriel, simplex.regular, simplex.interior]);
        assert!(numbers[4..].iter().map(|&v| v as u32).eq(simplex.vertices.iter().copied()));
    }
    assert_eq!(text.lines().count(), 1 + ordered.len());
}

/// The example of the documentation is a filtration, and the one we make.
#[test]
fn the_documented_file_is_right() {
    let text = include_str!("../../../docs/cross-checking.md");
    let at = text.find("## Filtrations").unwrap();
    let json = text[at..].split("```").nth(1).unwrap().trim_start_matches("json");
    let documented = FiltrationFile::read_json(json.as_bytes()).unwrap();
    assert_eq!(findings(&documented), []);
    let points = WeightedPoints::unweighted(documented.points.clone());
    let filtration = Filtration::new(points).unwrap();
    let made = file(&filtration.simplices().unwrap());
    assert_eq!((made.values, made.order), (documented.values, documented.order));
}

#[test]
fn what_is_not_there_is_not_judged() {
    let points = sets(1, 12).next().unwrap();
    let filtration = Filtration::new(points).unwrap();
    let whole = file(&filtration.simplices().unwrap());
    let unjudged = |file: FiltrationFile| {
        let (findings, certificate) = certify_filtration(&file).unwrap();
        assert_eq!(findings, []);
        certificate.not_judged
    };
    assert_eq!(unjudged(whole.clone()), []);
    assert_eq!(unjudged(FiltrationFile { gabriel: None, ..whole.clone() }), [Unjudged::Gabriel]);
    assert_eq!(unjudged(FiltrationFile { regular: None, ..whole.clone() }), [Unjudged::Intervals]);
    assert_eq!(unjudged(FiltrationFile { interior: None, ..whole.clone() }), [Unjudged::Intervals]);
    assert_eq!(unjudged(FiltrationFile { pairs: None, ..whole }), [Unjudged::Pairs]);
}
