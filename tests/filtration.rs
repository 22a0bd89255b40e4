//! The filtration simplex by simplex: against shapes made one by one and the exact checker, and its
//! pairs against a plain reduction of matrices.

mod common;
#[path = "common/random.rs"]
mod random;

use std::collections::{BTreeMap, HashMap};
use std::io::Cursor;
use std::path::Path;

use walpha::check::schema::FiltrationFile;
use walpha::check::{Bound, FiltrationFinding, certify_filtration, compare_filtrations};
use walpha::export::FiltrationFormat;
use walpha::ladder::{Entry, Filtration, Ordered};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};

use random::Random;

/// Makes a place and a weight.
type Family = fn(&mut Random) -> ([f64; 3], f64);

/// What a set is made of, by its number.
const FAMILIES: [Family; 6] = [
    |r| ([0; 3].map(|_| r.whole(0, 3)), 0.0),
    |r| ([0; 3].map(|_| r.whole(0, 3)), r.whole(-2, 4) / 2.0),
    |r| ([0; 3].map(|_| r.whole(0, 4)), if r.below(3) == 0 { r.unit() } else { 0.1 }),
    |r| ([0; 3].map(|_| r.unit()), 0.0),
    |r| ([0; 3].map(|_| r.unit()), r.unit() / 8.0),
    |r| {
        // Lattice points moved by one place of their last digit, or not.
        let near = |r: &mut Random| {
            let x = 1.0 + r.whole(0, 2);
            [x, x, x.next_up(), x.next_down()][r.below(4) as usize]
        };
        ([0; 3].map(|_| near(r)), r.whole(0, 1))
    },
];

/// Sets of up to so many points that span a volume.
fn sets(count: usize, most: u64) -> impl Iterator<Item = WeightedPoints> {
    let mut random = Random(17);
    let sets = (0..).map(move |k| {
        let family = FAMILIES[k % FAMILIES.len()];
        let size = 4 + random.below(most - 3);
        let (positions, weights) = (0..size).map(|_| family(&mut random)).unzip();
        WeightedPoints::new(positions, weights).unwrap()
    });
    sets.filter(|points| common::spans_a_volume(&points.positions)).take(count)
}

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

fn shape(points: &WeightedPoints, squared: f64) -> AlphaShape {
    let options = ShapeOptions::new(alpha(squared)).engine(Engine::Native).exterior(true);
    alpha_shape(points.clone(), &options).unwrap()
}

/// The class at an α, which must not be the double of a value.
fn class(simplex: &Entry<'_>, squared: f64) -> Class {
    if squared < simplex.value {
        Class::Exterior
    } else if squared < simplex.regular.min(simplex.interior) {
        Class::Singular
    } else if squared < simplex.interior {
        Class::Regular
    } else {
        Class::Interior
    }
}

fn classes(shape: &AlphaShape) -> HashMap<Vec<u32>, Class> {
    fn sorted(row: &[u32]) -> Vec<u32> {
        let mut row = row.to_vec();
        row.sort_unstable();
        row
    }
    let complex = shape.complex();
    let cells = complex.cells.iter().map(|(row, class)| (sorted(row), class));
    let facets = complex.facets.iter().map(|(row, class)| (sorted(row), class));
    let edges = complex.edges.iter().map(|(row, class)| (sorted(row), class));
    let vertices = complex.vertices.iter().map(|(row, class)| (sorted(row), class));
    cells.chain(facets).chain(edges).chain(vertices).collect()
}

/// Doubles between the values, and on both sides of all.
fn between(ordered: &Ordered<'_>) -> Vec<f64> {
    let mut values: Vec<f64> = ordered.values().iter().map(|value| value.squared()).collect();
    values.dedup();
    let middles = values.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0);
    let inside: Vec<f64> = middles
        .filter(|middle| values.binary_search_by(|v| v.total_cmp(middle)).is_err())
        .collect();
    let beyond = |value: f64, sign: f64| value + sign * (value.abs() + 1.0);
    let ends = [beyond(values[0], -1.0), beyond(values[values.len() - 1], 1.0)];
    inside.into_iter().chain(ends).collect()
}

#[test]
fn classes_are_those_of_shapes_made_one_by_one() {
    let mut compared = 0;
    for points in sets(60, 24) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let all = between(&ordered);
        for squared in all.iter().copied().step_by(1 + all.len() / 12) {
            let shape = shape(&points, squared);
            let expected = classes(&shape);
            assert_eq!(expected.len(), ordered.len());
            for simplex in ordered.iter() {
                let wanted = expected[simplex.vertices];
                assert_eq!(
                    class(&simplex, squared),
                    wanted,
                    "{simplex:?} at {squared}\n{points:?}"
                );
                compared += 1;
            }
            assert_eq!(filtration.shape(alpha(squared)).betti(), shape.betti());
        }
    }
    assert!(compared > 50_000);
}

#[test]
fn the_order_is_by_value_dimension_and_vertices() {
    for points in sets(120, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let mut seen = BTreeMap::new();
        let mut last = None;
        for simplex in ordered.iter() {
            let key = (simplex.rank, simplex.vertices.len(), simplex.vertices.to_vec());
            assert!(last.is_none_or(|last| last < key));
            assert_eq!(ordered.values()[simplex.rank as usize].squared(), simplex.value);
            let n = simplex.vertices.len();
            for gone in (0..n).filter(|_| n > 1) {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                assert!(seen[&face] <= simplex.rank);
            }
            seen.insert(simplex.vertices.to_vec(), simplex.rank);
            last = Some(key);
        }
        assert_eq!(seen.len(), ordered.len());
        assert!(ordered.values().is_sorted());
    }
}

/// Where doubles cannot tell two values apart the order still does: a point off the middle of an edge
/// by less than its square can show.
#[test]
fn values_with_one_double_are_told_apart() {
    let tiny = 2f64.powi(-40);
    let positions =
        vec![[0.0; 3], [2.0, 0.0, 0.0], [9.0, 9.0, 9.0], [9.0, 11.0, 9.0 + tiny], [0.0, 40.0, 7.0]];
    let points = WeightedPoints::unweighted(positions);
    let filtration = Filtration::new(points).unwrap();
    let ordered = filtration.simplices().unwrap();
    let edge = |row: [u32; 2]| ordered.iter().find(|simplex| simplex.vertices == row).unwrap();
    let (exact, longer) = (edge([0, 1]), edge([2, 3]));
    assert_eq!((exact.value, longer.value), (1.0, 1.0));
    assert!(exact.rank < longer.rank);
}

#[test]
fn the_curve_is_the_same_as_that_of_levels() {
    for points in sets(40, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let curve = filtration.curve();
        let betti = ordered.betti_curve();
        let values = ordered.values();
        for (k, above) in curve.alphas().enumerate() {
            // The last value that is not above that double; several may be between two doubles.
            let rank = values.partition_point(|value| value.squared() <= above);
            let nearest_below = (rank > 0).then(|| betti[rank - 1]);
            let unsure = rank > 0 && values[rank - 1].squared() == above;
            assert!(unsure || nearest_below == Some(curve.betti[k]));
        }
        assert_eq!(betti.last(), curve.betti.last());
    }
}

#[test]
fn fewer_components_take_a_larger_alpha() {
    let two = std::num::NonZeroU64::new(2).unwrap();
    // Two tetrahedra far apart.
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let far = corners.map(|[x, y, z]| [x + 9.0, y, z]);
    let positions = [corners, far].concat();
    let points = WeightedPoints::unweighted(positions);
    let filtration = Filtration::new(points).unwrap();
    assert_eq!(filtration.optimal_alpha(two).squared(), 0.75);
    assert!(filtration.optimal_alpha(std::num::NonZeroU64::MIN) == filtration.one_region());
    assert!(filtration.one_region().squared() > 16.0);
}

/// Pairs of all dimensions by numbers of simplices, and the simplices without one: columns of the
/// boundary matrix over Z/2, reduced from the left.
fn reduced(ordered: &Ordered<'_>) -> (Vec<Vec<[u32; 2]>>, Vec<u32>) {
    let place: HashMap<Vec<u32>, usize> =
        ordered.iter().enumerate().map(|(at, simplex)| (simplex.vertices.to_vec(), at)).collect();
    let mut with_low: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut pairs = vec![Vec::new(); 3];
    let mut alone: Vec<bool> = vec![true; ordered.len()];
    for (at, simplex) in ordered.iter().enumerate() {
        let n = simplex.vertices.len();
        let mut column: Vec<usize> = (0..n)
            .filter(|_| n > 1)
            .map(|gone| {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                place[&face]
            })
            .collect();
        column.sort_unstable();
        while let Some(other) = column.last().and_then(|low| with_low.get(low)) {
            let mut sum: BTreeMap<usize, bool> = BTreeMap::new();
            column.iter().chain(other).for_each(|&row| *sum.entry(row).or_default() ^= true);
            column = sum.into_iter().filter(|(_, odd)| *odd).map(|(row, _)| row).collect();
        }
        if let Some(&low) = column.last() {
            pairs[n - 2].push([ordered.order()[low], ordered.order()[at]]);
            (alone[low], alone[at]) = (false, false);
            with_low.insert(low, column);
        }
    }
    let alone = (0..ordered.len()).filter(|&at| alone[at]).map(|at| ordered.order()[at]).collect();
    (pairs, alone)
}

#[test]
fn pairs_are_those_of_a_matrix() {
    let mut lasting = [0; 3];
    for points in sets(240, 40) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let pairs = ordered.pairs();
        let (mut expected, alone) = reduced(&ordered);
        let sorted = |pairs: &[[u32; 2]]| {
            let mut pairs = pairs.to_vec();
            pairs.sort_unstable();
            pairs
        };
        expected.iter_mut().for_each(|pairs| pairs.sort_unstable());
        assert_eq!(sorted(&pairs.components), expected[0]);
        assert_eq!(sorted(&pairs.voids), expected[2]);
        assert_eq!(pairs.lasting, alone);
        // What is in no pair of these is in one of dimension 1: edges that begin, facets that end.
        let used: std::collections::HashSet<u32> =
            pairs.components.iter().chain(&pairs.voids).flatten().copied().collect();
        let free = |number: &u32| {
            let dimension = ordered.simplex(*number).vertices.len() - 1;
            (1..=2).contains(&dimension) && !used.contains(number)
        };
        let mut of_loops: Vec<u32> = expected[1].iter().flatten().copied().collect();
        of_loops.sort_unstable();
        assert_eq!((0..ordered.len() as u32).filter(free).collect::<Vec<_>>(), of_loops);
        for (count, pairs) in lasting.iter_mut().zip(&expected) {
            *count += pairs.iter().filter(|&&pair| ordered.lasts(pair)).count();
        }
    }
    assert!(lasting.iter().all(|&count| count > 100), "{lasting:?}");
}

fn written(ordered: &Ordered<'_>, extension: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let format = FiltrationFormat::of(&Path::new("a").with_extension(extension)).unwrap();
    format.write(ordered, &mut bytes).unwrap();
    bytes
}

fn file(ordered: &Ordered<'_>) -> FiltrationFile {
    let json = FiltrationFile::read_json(&written(ordered, "json")[..]).unwrap();
    let npz = Cursor::new(written(ordered, "npz"));
    let mut npz = FiltrationFile::read_npz(npz).unwrap();
    npz.info.clone_from(&json.info);
    assert_eq!(npz, json);
    json
}

fn findings(file: &FiltrationFile) -> Vec<FiltrationFinding> {
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

/// Another α.
fn moved(alpha: Alpha, to: fn(f64) -> f64) -> Alpha {
    Alpha::from_squared(to(alpha.squared())).unwrap()
}

fn one_pair(damaged: &FiltrationFile, rule: &dyn Fn(&FiltrationFinding) -> bool) {
    let found = findings(damaged);
    assert!(found.len() == 1 && rule(&found[0]), "{found:?}");
}

/// What is wrong is found, and named.
#[test]
fn the_checker_finds_what_is_wrong() {
    let mut random = Random(5);
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
        let at = random.below(damage.values.edges.len() as u64) as usize;
        damage.values.edges[at] = moved(damage.values.edges[at], f64::next_up);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let at = random.below(damage.values.cells.len() as u64) as usize;
        damage.values.cells[at] = moved(damage.values.cells[at], f64::next_down);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let facets = &mut damage.gabriel.as_mut().unwrap().facets;
        let at = random.below(facets.len() as u64) as usize;
        facets[at] = !facets[at];
        one(&damage, &|found| matches!(found, FiltrationFinding::Gabriel { .. }));
        let mut damage = right.clone();
        let edges = &mut damage.regular.as_mut().unwrap().edges;
        let at = random.below(edges.len() as u64) as usize;
        edges[at] = moved(edges[at], f64::next_down);
        one(&damage, &is_when(Bound::Regular));
        let mut damage = right.clone();
        let vertices = &mut damage.interior.as_mut().unwrap().vertices;
        let at = random.below(vertices.len() as u64) as usize;
        let other = |squared: f64| if squared == f64::INFINITY { 1.0 } else { f64::INFINITY };
        vertices[at] = moved(vertices[at], other);
        one(&damage, &is_when(Bound::Interior));
        let mut damage = right.clone();
        let at = random.below(damage.order.len() as u64 - 1) as usize;
        damage.order.swap(at, at + 1);
        let found = findings(&damage);
        assert!(!found.is_empty());
        assert!(found.iter().all(|found| matches!(found, FiltrationFinding::Order { .. })));
        let is_pair = |wanted: usize, is: bool| move |found: &FiltrationFinding| matches!(found, FiltrationFinding::Pair { dimension, listed, .. } if *dimension == wanted && *listed == is);
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().components.pop().is_some() {
            one_pair(&damage, &is_pair(0, false));
        }
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().voids.pop().is_some() {
            one_pair(&damage, &is_pair(2, false));
        }
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
}

#[test]
fn the_command_writes_checks_and_compares() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let make = ["filtration", "sample:phantom@12", "--weights", "min-max", "-o"];
    let told = common::json(f, &[&make[..], &["a.json", "a.npz", "a.txt"]].concat());
    assert_eq!(told["files"].as_array().unwrap().len(), 3);
    assert!(told["persistence"]["components"].as_array().is_some());
    let checked = common::ok(f, &["check", "a.npz"]);
    assert!(checked.contains("certified: no finding"), "{checked}");
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

/// The example of the documentation is a filtration, and the one we make.
#[test]
fn the_documented_file_is_right() {
    let text = include_str!("../docs/cross-checking.md");
    let at = text.find("## Filtrations").unwrap();
    let json = text[at..].split("```").nth(1).unwrap().trim_start_matches("json");
    let documented = FiltrationFile::read_json(json.as_bytes()).unwrap();
    assert_eq!(findings(&documented), []);
    let points = WeightedPoints::unweighted(documented.points.clone());
    let filtration = Filtration::new(points).unwrap();
    let made = file(&filtration.simplices().unwrap());
    assert_eq!((made.values, made.order), (documented.values, documented.order));
}
