//! Points in one plane, on one line, or one alone: their shape there, against the definition.

use std::num::NonZeroUsize;

use walpha::check::enumerate;
use walpha::ladder::Filtration;
use walpha::shape::{Betti, Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common;

/// Points of a plane or line through the lattice, tilted as it comes, with ties everywhere.
fn set(random: &mut Random) -> WeightedPoints {
    let steps = [0, 1].map(|_| [0; 3].map(|_| random.whole(-2, 2)));
    let origin = [0; 3].map(|_| random.whole(-3, 3));
    let (line, weighted) = (random.below(3) == 0, random.below(2) == 0);
    // Powers of two change nothing.
    let scale = [1.0, 0.125, 2f64.powi(40)][random.below(3)];
    let count = 1 + random.below(13);
    let point = |random: &mut Random| {
        let (u, v) = (random.whole(-3, 3), if line { 0.0 } else { random.whole(-2, 2) });
        let at = |k: usize| scale * (origin[k] + u * steps[0][k] + v * steps[1][k]);
        let weight = if weighted { random.whole(-2, 4) / 2.0 * scale * scale } else { 0.0 };
        ([0, 1, 2].map(at), weight)
    };
    let (positions, weights) = (0..count).map(|_| point(random)).unzip();
    WeightedPoints::new(positions, weights).unwrap()
}

fn shape(points: &WeightedPoints, alpha: f64, engine: Engine, exterior: bool) -> AlphaShape {
    let alpha = Alpha::from_squared(alpha).unwrap();
    let options = ShapeOptions::new(alpha).engine(engine).exterior(exterior);
    alpha_shape(points.clone(), &options).unwrap()
}

/// Betti numbers by flooding, and the Euler characteristic.
fn betti(shape: &AlphaShape) -> Betti {
    let complex = shape.complex();
    let inside = |class: Class| class != Class::Exterior;
    let vertices: Vec<u32> =
        complex.vertices.iter().filter(|v| inside(v.1)).map(|(&[v], _)| v).collect();
    let edges: Vec<[u32; 2]> =
        complex.edges.iter().filter(|e| inside(e.1)).map(|(&e, _)| e).collect();
    let facets = complex.facets.iter().filter(|f| inside(f.1)).count() as i64;
    let mut seen = std::collections::HashSet::new();
    let mut b0 = 0;
    for &v in &vertices {
        b0 += u64::from(!seen.contains(&v));
        let mut open = vec![v];
        while let Some(v) = open.pop() {
            if seen.insert(v) {
                let near = edges.iter().filter(|edge| edge.contains(&v));
                open.extend(near.map(|&[a, b]| a + b - v));
            }
        }
    }
    let euler = vertices.len() as i64 - edges.len() as i64 + facets;
    Betti::in_space(b0, (b0 as i64 - euler) as u64, 0)
}

#[test]
fn flat_shapes_are_those_of_the_definition() {
    let mut random = Random::new(3);
    let mut counts = [0; 4];
    let mut done = 0;
    while done < 400 {
        let points = set(&mut random);
        if common::spans_a_volume(points.positions()) {
            continue;
        }
        done += 1;
        let scale = points.positions().as_flattened().iter().fold(1e-3f64, |m, x| m.max(x.abs()));
        for alpha in [-0.5, 0.0, 0.02, 0.05, 0.1, 0.25, 1.0, f64::INFINITY] {
            let alpha = alpha * scale * scale;
            let made = enumerate(
                points.positions(),
                points.weights(),
                Alpha::from_squared(alpha).unwrap(),
            )
            .unwrap();
            for engine in [Engine::Native, Engine::Cgal] {
                let whole = shape(&points, alpha, engine, true);
                assert_eq!(*whole.complex(), made.complex, "{engine:?} at {alpha}: {points:?}");
                assert_eq!(whole.hidden(), Some(&made.hidden[..]));
                assert_eq!(whole.duplicates(), made.duplicates);
                assert_eq!(whole.betti(), Some(betti(&whole)));
                assert_eq!(whole.voids(), Some(vec![]));
                let alone = shape(&points, alpha, engine, false);
                assert_eq!(alone.betti(), whole.betti());
                assert!(alone.complex().facets.counts()[Class::Exterior] == 0);
            }
            for class in Class::ALL {
                counts[class as usize] += made.complex.edges.counts()[class];
            }
        }
    }
    assert_eq!(counts[Class::Interior as usize], 0);
    assert!(
        [Class::Exterior, Class::Regular, Class::Singular]
            .map(|c| counts[c as usize])
            .iter()
            .all(|&count| count > 1000),
        "{counts:?}"
    );
}

/// Compares points in a plane of the axes with the same points in another plane, turned and scaled by √2.
#[test]
fn a_turn_changes_nothing_but_places() {
    let flat: Vec<[f64; 3]> =
        (0..30).map(|i: i32| [(i * 7 % 11).into(), (i * i % 13).into(), 0.0]).collect();
    let turned = flat.iter().map(|&[x, y, _]| [x + y, x - y, 5.0]).collect();
    let with = WeightedPoints::unweighted;
    for alpha in [1.0, 2.0, 4.0] {
        let one = shape(&with(flat.clone()), alpha, Engine::Native, false);
        let other = shape(&with(Vec::clone(&turned)), 2.0 * alpha, Engine::Native, false);
        assert_eq!(one.betti(), other.betti());
        let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(close(2.0 * one.measures().area, other.measures().area));
    }
}

#[test]
fn one_piece_of_a_plane_and_of_a_line() {
    let with = WeightedPoints::unweighted;
    let at = |alpha: f64, points: &WeightedPoints| shape(points, alpha, Engine::Native, false);
    let grid = with((0..20).map(|i| [f64::from(i % 5), f64::from(i / 5), 1.0]).collect());
    let one_region =
        |points: &WeightedPoints| Filtration::new(points.clone()).unwrap().one_region().squared();
    let found = one_region(&grid);
    assert_eq!(found, 0.5);
    assert_eq!(at(found, &grid).betti().unwrap(), Betti::in_space(1, 0, 0));
    assert_eq!(at(found, &grid).measures().area, 12.0);
    assert!(at(found.next_down(), &grid).complex().facets.is_empty());
    let line = with([0.0, 1.0, 3.0, 4.0].map(|x| [x, 2.0 * x, -x]).into());
    assert_eq!(one_region(&line), 6.0);
    assert_eq!(at(6.0, &line).betti().unwrap().b0, 1);
    assert_eq!(at(6f64.next_down(), &line).betti().unwrap().b0, 2);
}

#[test]
fn blocks_do_not_matter_and_flat_points_can_be_refused() {
    let positions: Vec<[f64; 3]> =
        (0..900).map(|i| [f64::from(i % 30), f64::from(i / 30), f64::from(i % 30)]).collect();
    let points = WeightedPoints::unweighted(positions);
    let options = ShapeOptions::new(Alpha::from_squared(0.75).unwrap());
    let one = alpha_shape(points.clone(), &options).unwrap();
    assert_eq!(one.complex().facets.len(), 2 * 29 * 29);
    let blocks = options.blocks(NonZeroUsize::new(7));
    assert_eq!(alpha_shape(points.clone(), &blocks).unwrap().complex(), one.complex());
    let refuse = options.refuse_flat(true);
    let error = alpha_shape(points, &refuse).unwrap_err();
    assert!(error.is_flat() && error.to_string().contains("in one plane"), "{error}");
}

#[test]
fn the_command_takes_tables_of_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows: String = (0..16).map(|i| format!("{},{}\n", i % 4, i / 4)).collect();
    std::fs::write(f.join("plane.csv"), format!("x,y\n{rows}")).unwrap();
    let outputs = ["-o", "a.json", "a.vtu", "a.ply", "a.off"];
    let rule = ["shape", "plane.csv", "--alpha", "auto:connected"];
    let told = common::json(f, &[&rule[..], &outputs].concat());
    assert_eq!(told["alpha"]["squared"], 0.5);
    assert_eq!(told["shape"]["area"], 9.0);
    assert_eq!(told["shape"]["facets"]["singular"], 18);
    assert_eq!(told["shape"]["betti"], serde_json::json!([1, 0, 0]));
    common::ok(f, &["compare", "a.json", "a.json"]);
    common::fails(f, 1, "shape plane.csv --require-3d --alpha 1", &["in one plane"]);
}

/// Commands that make all shapes together, show them, or interpolate on them accept the same points as `shape`.
#[test]
fn all_commands_take_what_lies_in_a_plane_on_a_line_or_at_a_point() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let row = |x: i32, y: i32| format!("{x},{y},{},{}\n", x + y, x);
    let plane: String = (0..16).map(|i| row(i % 4, i / 4)).collect();
    let line: String = (0..5).map(|i| row(i * i, 0)).collect();
    for (name, rows, vertices, area, one_region, dims) in [
        ("plane", plane, 16, 9.0 * 3f64.sqrt(), 2.0 / 3.0, "4,4,4"),
        ("line", line, 5, 0.0, 24.5, "4,1,4"),
        ("point", row(1, 2), 1, 0.0, 0.0, "1,1,1"),
    ] {
        let table = format!("{name}.csv");
        std::fs::write(f.join(&table), format!("x,y,z,value\n{rows}")).unwrap();
        let told = common::json(f, &["filtration", &table, "-o", "a.json", "a.npz", "a.txt"]);
        assert_eq!(told["simplices"]["cells"]["count"].as_u64().unwrap_or(0), 0, "{told}");
        let told = common::json(f, &["ladder", &table, "-o", "made", "--mesh", "ply"]);
        let last = told["levels"].as_array().unwrap().last().unwrap();
        assert_eq!(last["coverage"], 0.0, "{last}");
        let told = common::json(f, &["ladder", &table, "--alphas", "inf", "-o", "made"]);
        let last = &told["levels"][0];
        assert_eq!(
            (last["cells"].as_u64(), &last["betti"]),
            (Some(0), &serde_json::json!([1, 0, 0]))
        );
        assert!((last["area"].as_f64().unwrap() - area).abs() < 1e-9, "{last}");
        common::ok(f, &["view", &table, "-o", "a.html"]);
        let told = common::json(f, &["shape", &table, "--alpha", "auto:connected"]);
        assert!((told["alpha"]["squared"].as_f64().unwrap() - one_region).abs() < 1e-9, "{name}");
        assert_eq!(
            told["shape"]["vertices"]["regular"].as_u64().unwrap()
                + told["shape"]["vertices"]["singular"].as_u64().unwrap(),
            vertices
        );
        let args = ["interpolate", &table, "--alpha", "inf", "-o", "a.npy", "--dims"];
        let sampled = common::json(f, &[&args[..], &[dims]].concat());
        assert_eq!(sampled["shape"]["betti"], serde_json::json!([1, 0, 0]));
        // Several samples are a step apart, which they have no room for across a line or a point.
        if dims != "4,4,4" {
            let args = [&args[..], &["4,4,4"]].concat();
            let (code, _, text) = common::run(f, &args);
            assert!(code == 1 && text.contains("4 samples along "), "{text}");
        }
    }
}
