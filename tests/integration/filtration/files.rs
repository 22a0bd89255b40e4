//! Files of filtrations: written, read, damaged, checked.

use std::io::Cursor;
use std::path::Path;

use walpha::check::schema::FiltrationFile;
use walpha::check::{
    Bound, Exact, FiltrationFinding, Unjudged, certify_filtration, compare_filtrations,
};
use walpha::export::FiltrationFormat;
use walpha::ladder::{Filtration, Ordered};
use walpha::{Alpha, WeightedPoints};
use walpha_base::random::Random;

use super::sets;
use crate::common;

fn written(ordered: &Ordered<'_>, extension: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let format = FiltrationFormat::of(Path::new("a").with_extension(extension)).unwrap();
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
    let mut without_loops = whole.clone();
    without_loops.pairs.as_mut().unwrap().loops = None;
    assert_eq!(unjudged(without_loops), [Unjudged::Loops]);
    assert_eq!(unjudged(FiltrationFile { pairs: None, ..whole }), [Unjudged::Pairs]);
}

/// Another α.
fn moved(alpha: Alpha, to: fn(f64) -> f64) -> Alpha {
    Alpha::from_squared(to(alpha.squared())).unwrap()
}

fn one_pair(damaged: &FiltrationFile, rule: &dyn Fn(&FiltrationFinding) -> bool) {
    let found = findings(damaged);
    assert!(found.len() == 1 && rule(&found[0]), "{found:?}");
}

/// Faults are found, and named.
#[test]
fn the_checker_finds_what_is_wrong() {
    let mut random = Random::new(5);
    let mut missing_loops = 0;
    for points in sets(24, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let right = file(&ordered);
        let is_when = |wanted: Bound| move |found: &FiltrationFinding| matches!(found, FiltrationFinding::When { bound, .. } if *bound == wanted);
        let one = |damaged: &FiltrationFile, rule: &dyn Fn(&FiltrationFinding) -> bool| {
            let found = findings(damaged);
            assert!(found.len() == 1 && rule(&found[0]), "{found:?}");
            assert!(!compare_filtrations(&right, damaged).unwrap().is_equal());
        };
        let mut damage = right.clone();
        let at = random.below(damage.values.edges.len());
        damage.values.edges[at] = moved(damage.values.edges[at], f64::next_up);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let at = random.below(damage.values.cells.len());
        damage.values.cells[at] = moved(damage.values.cells[at], f64::next_down);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let facets = &mut damage.gabriel.as_mut().unwrap().facets;
        let at = random.below(facets.len());
        facets[at] = !facets[at];
        one(&damage, &|found| matches!(found, FiltrationFinding::Gabriel { .. }));
        let mut damage = right.clone();
        let edges = &mut damage.regular.as_mut().unwrap().edges;
        let at = random.below(edges.len());
        edges[at] = moved(edges[at], f64::next_down);
        one(&damage, &is_when(Bound::Regular));
        let mut damage = right.clone();
        let vertices = &mut damage.interior.as_mut().unwrap().vertices;
        let at = random.below(vertices.len());
        let other = |squared: f64| if squared == f64::INFINITY { 1.0 } else { f64::INFINITY };
        vertices[at] = moved(vertices[at], other);
        one(&damage, &is_when(Bound::Interior));
        let mut damage = right.clone();
        let at = random.below(damage.order.len() - 1);
        damage.order.swap(at, at + 1);
        let found = findings(&damage);
        assert!(!found.is_empty());
        assert!(found.iter().all(|found| matches!(found, FiltrationFinding::Order { .. })));
        let values = damage.values.vertices.iter().chain(&damage.values.edges);
        let values: Vec<_> =
            values.chain(&damage.values.facets).chain(&damage.values.cells).collect();
        let swapped = [at, at + 1].map(|at| values[damage.order[at] as usize].squared());
        assert!(found.iter().any(|found| {
            matches!(found, FiltrationFinding::Order { values, .. } if values.each_ref().map(Exact::nearest) == swapped)
        }), "{swapped:?} {found:?}");
        let is_pair = |wanted: usize, is: bool| move |found: &FiltrationFinding| matches!(found, FiltrationFinding::Pair { dimension, listed, .. } if *dimension == wanted && *listed == is);
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().components.pop().is_some() {
            one_pair(&damage, &is_pair(0, false));
        }
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().voids.pop().is_some() {
            one_pair(&damage, &is_pair(2, false));
        }
        let loops = |file: &mut FiltrationFile, to: &dyn Fn(&mut Vec<[u32; 2]>) -> bool| {
            to(file.pairs.as_mut().unwrap().loops.as_mut().unwrap())
        };
        let mut damage = right.clone();
        if loops(&mut damage, &|loops| loops.pop().is_some()) {
            one_pair(&damage, &is_pair(1, false));
            missing_loops += 1;
        }
        let mut damage = right.clone();
        loops(&mut damage, &|loops| {
            loops.push([0, 1]);
            true
        });
        one_pair(&damage, &is_pair(1, true));
        let mut damage = right.clone();
        damage.pairs.as_mut().unwrap().voids.push([0, 1]);
        one_pair(&damage, &is_pair(2, true));
        let mut damage = right.clone();
        damage.pairs.as_mut().unwrap().lasting.push(u32::MAX);
        one_pair(&damage, &|found| matches!(found, FiltrationFinding::Lasting { .. }));
        let mut damage = right.clone();
        damage.order[0] = damage.order[1];
        let found = findings(&damage);
        assert!(matches!(
            found[..],
            [FiltrationFinding::Number { .. }, FiltrationFinding::Absent { .. }]
        ));
        let mut damage = right.clone();
        damage.edges.pop();
        damage.values.edges.pop();
        for bounds in [&mut damage.regular, &mut damage.interior] {
            bounds.as_mut().unwrap().edges.pop();
        }
        damage.gabriel.as_mut().unwrap().edges.pop();
        let found = findings(&damage);
        assert!(matches!(found[0], FiltrationFinding::Triangulation(_)), "{found:?}");
        let mut damage = right.clone();
        damage.values.facets.pop();
        assert!(certify_filtration(&damage).is_err());
    }
    assert!(missing_loops > 10, "{missing_loops}");
}

#[test]
fn the_command_writes_checks_and_compares() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let make = ["filtration", "sample:phantom@12", "--weights", "min-max", "-o"];
    let told = common::json(f, &[&make[..], &["a.json", "a.npz", "a.txt", "a.csv"]].concat());
    assert_eq!(told["files"].as_array().unwrap().len(), 4);
    let table = std::fs::read_to_string(f.join("a.csv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("dimension,birth,death,birth_simplex,death_simplex"));
    for (dimension, name) in ["components", "loops", "voids"].into_iter().enumerate() {
        let intervals = told["persistence"][name].as_array().unwrap();
        assert!(!intervals.is_empty(), "{name}");
        for interval in intervals {
            let fields: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!(fields[0], dimension.to_string());
            let numbers = [1, 2].map(|at| fields[at].parse::<f64>().unwrap());
            assert_eq!(serde_json::json!(numbers), *interval);
            let corners = [3, 4].map(|at| fields[at].split(' ').count());
            assert_eq!(corners, [dimension + 1, dimension + 2]);
        }
        if dimension == 0 {
            let [dimension, _, death, begins, ends] =
                lines.next().unwrap().split(',').collect::<Vec<_>>()[..]
            else {
                panic!("five columns")
            };
            assert_eq!([dimension, death, ends], ["0", "inf", ""]);
            assert!(begins.parse::<u32>().is_ok());
        }
    }
    assert_eq!(lines.next(), None);
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

/// The cycles of the pairs that last, or of those above a persistence.
#[test]
fn cycles_are_written_for_lasting_pairs() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut random = Random::new(3);
    let points: String = (0..60)
        .map(|_| [0; 3].map(|_| random.unit()))
        .map(|[x, y, z]| format!("{x} {y} {z}\n"))
        .collect();
    std::fs::write(f.join("p.xyz"), points).unwrap();
    let lasting = |name: &str, above: f64| {
        let pairs = common::json(f, &["filtration", "p.xyz"])["persistence"][name].clone();
        let pairs: Vec<[f64; 2]> = serde_json::from_value(pairs).unwrap();
        pairs.iter().filter(|[birth, death]| death - birth > above).count()
    };
    let header = |more: &[&str]| {
        common::ok(f, &[&["filtration", "p.xyz", "--cycles", "c.vtp"], more].concat());
        let bytes = std::fs::read(f.join("c.vtp")).unwrap();
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let number = |name: &str| -> usize {
            let from = text.split_once(&format!("{name}=\"")).unwrap().1;
            from.split_once('"').unwrap().0.parse().unwrap()
        };
        [number("NumberOfLines"), number("NumberOfPolys")]
    };
    let [lines, triangles] = header(&[]);
    assert_eq!(lines, lasting("loops", 0.0).min(100));
    assert!(lines > 10 && triangles >= 4 * lasting("voids", 0.0).min(100), "{lines} {triangles}");
    for above in [0.005, 0.02] {
        let [lines, triangles] = header(&["--cycles-above", &above.to_string()]);
        assert_eq!(lines, lasting("loops", above));
        assert!(triangles >= 4 * lasting("voids", above));
    }
    let refused = |args: &[&str], words: &str| {
        let (code, _, said) = common::run(f, args);
        assert!(code == 2 && said.contains(words), "{code}: {said}");
    };
    refused(&["filtration", "p.xyz", "--cycles", "c.ply"], "vtp");
    refused(&["filtration", "p.xyz", "--cycles-above", "1"], "--cycles");
    refused(&["filtration", "p.xyz", "--cycles", "c.vtp", "--cycles-above", "-1"], "-1");
}
