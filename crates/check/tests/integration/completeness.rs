//! Whether simplices are missing from a shape alone, against the definition.

use std::collections::BTreeSet;

use walpha_base::random::Random;
use walpha_check::schema::{ComplexFile, PlacedComplex};
use walpha_check::{Certificate, Complex, Finding, Verdict};

use crate::common::{Case, definition, grid};

/// A simplex by its vertices, ascending.
type Row = Vec<u32>;

/// Points of a kind: in general position, of a lattice with its ties, of a plane or a line, with weights that hide some of them.
fn case(random: &mut Random, kind: usize) -> Case {
    let count = 5 + random.below(9);
    let sides = match kind {
        0 | 1 => [1000; 3],
        2 => [2; 3],
        3 => [2, 3, 0],
        4 => [9, 0, 0],
        _ => [3; 3],
    };
    let side = sides[0] as f64;
    let positions = (0..count).map(|_| sides.map(|side| random.whole(0, side))).collect();
    let levels: &[f64] = match kind {
        0 => &[0.0],
        1 => &[0.0, 7.0, 40_000.0, -900.0],
        5 => &[0.0, 0.5, 1.0, 2.0],
        _ => &[0.0, 0.0, 0.5],
    };
    let weights = (0..count).map(|_| random.pick(levels)).collect();
    let alpha = side * side * random.pick(&[-0.125, 0.0, 0.0625, 0.125, 0.1875, 0.25, 0.5, 4.0]);
    Case { positions, weights, alpha }
}

/// All simplices of a complex.
fn rows(complex: &Complex) -> BTreeSet<Row> {
    fn of<const N: usize>(rows: &[[u32; N]]) -> impl Iterator<Item = Row> {
        rows.iter().map(|row| crate::common::sorted(row))
    }
    let cells = of(complex.cells.rows()).chain(of(complex.facets.rows()));
    cells.chain(of(complex.edges.rows())).chain(of(complex.vertices.rows())).collect()
}

/// The shape by the definition.
fn shape(case: &Case) -> Complex {
    let mut complex = definition(case).unwrap().complex;
    complex.retain_shape();
    complex
}

/// The simplices that are not faces of others.
fn maximal(rows: &BTreeSet<Row>) -> Vec<Row> {
    let bounds = |row: &Row, other: &Row| {
        other.len() == row.len() + 1 && row.iter().all(|v| other.contains(v))
    };
    rows.iter().filter(|row| !rows.iter().any(|other| bounds(row, other))).cloned().collect()
}

/// The faces of some simplices, and these themselves.
fn closure<'a>(rows: impl IntoIterator<Item = &'a Row>) -> BTreeSet<Row> {
    let faces = |row: &'a Row| {
        (1u32..1 << row.len()).map(|mask| {
            let corners = row.iter().enumerate().filter(move |(k, _)| mask >> k & 1 == 1);
            corners.map(|(_, v)| *v).collect()
        })
    };
    rows.into_iter().flat_map(faces).collect()
}

/// The findings if these simplices are listed, with the classes that follow from them; or if the cells alone are listed.
fn judged(case: &Case, listed: &BTreeSet<Row>, cells_alone: bool) -> (Vec<Finding>, Certificate) {
    fn of<const N: usize>(rows: &BTreeSet<Row>) -> Vec<[u32; N]> {
        rows.iter().filter_map(|row| row[..].try_into().ok()).collect()
    }
    let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
    file.weights = Some(case.weights.clone());
    file.cells = Some(of(listed));
    if !cells_alone {
        (file.facets, file.edges) = (Some(of(listed)), Some(of(listed)));
        file.vertices =
            Some(listed.iter().filter(|row| row.len() == 1).map(|row| row[0]).collect());
    }
    PlacedComplex::try_from(file).unwrap().findings().unwrap()
}

fn cells(rows: &BTreeSet<Row>) -> Vec<&Row> {
    rows.iter().filter(|row| row.len() == 4).collect()
}

/// Any part of a shape is wrong, and the whole of it is exact. The parts are the faces of some of its simplices, or of those of a
/// smaller α.
#[test]
fn whatever_is_missing_is_found() {
    let mut random = Random::new(22);
    let (mut exact, mut wrong, mut without_cells) = ([0; 6], [0; 6], 0);
    for round in 0..6000 {
        let kind = round % 6;
        let case = case(&mut random, kind);
        let all = rows(&shape(&case));
        assert_eq!(judged(&case, &all, false).0, [], "{case:?}");
        let lower = Case {
            alpha: case.alpha - random.pick(&[0.0, 0.0, 0.1]) * case.alpha.abs(),
            ..case.clone()
        };
        let mut part = maximal(&rows(&shape(&lower)));
        let fewer = random.below(3).min(part.len());
        for _ in 0..fewer {
            part.swap_remove(random.below(part.len()));
        }
        let part = closure(&part);
        let (findings, certificate) = judged(&case, &part, false);
        assert_eq!(
            certificate.verdict == Verdict::Exact,
            part == all,
            "{case:?}\n{part:?}\n{findings:?}"
        );
        assert_eq!(certificate.verdict == Verdict::Wrong, part != all, "{case:?}\n{findings:?}");
        // For cells alone, nothing else is missing.
        let (findings, certificate) = judged(&case, &part, true);
        let verdict = if cells(&part) == cells(&all) { Verdict::Exact } else { Verdict::Wrong };
        assert_eq!(certificate.verdict, verdict, "{case:?}\n{part:?}\n{findings:?}");
        without_cells += usize::from(part != all && verdict == Verdict::Exact);
        exact[kind] += usize::from(part == all);
        wrong[kind] += usize::from(part != all);
    }
    assert!(exact.iter().chain(&wrong).all(|&count| count > 100), "{exact:?} {wrong:?}");
    assert!(without_cells > 100, "{without_cells}");
}

/// In general position exactly the missing simplices are named that are not faces of others.
#[test]
fn what_is_missing_is_named() {
    let mut random = Random::new(23);
    let mut named = [0; 4];
    for _ in 0..1500 {
        let kind = random.below(2);
        let case = case(&mut random, kind);
        let all = rows(&shape(&case));
        let lower = Case { alpha: case.alpha * 0.8, ..case.clone() };
        let part = closure(&maximal(&rows(&shape(&lower))));
        let missing: BTreeSet<Row> =
            maximal(&all).into_iter().filter(|row| !part.contains(row)).collect();
        let found: BTreeSet<Row> = judged(&case, &part, false)
            .0
            .iter()
            .map(|finding| crate::common::sorted(finding.parts()[0]))
            .collect();
        if !part.is_subset(&all) {
            continue;
        }
        assert_eq!(found, missing, "{case:?}\n{part:?}");
        missing.iter().for_each(|row| named[row.len() - 1] += 1);
    }
    assert!(named[1..].iter().all(|&count| count > 20), "{named:?}");
}

/// Points of a lattice whose cells are cut in another way, or not at all.
#[test]
fn other_ways_to_cut_a_polytope_leave_nothing_missing() {
    let mut random = Random::new(24);
    let (mut valid, mut wrong) = (0, 0);
    for round in 0..1200 {
        let mut case = case(&mut random, if round % 3 == 0 { 5 } else { 2 });
        case.alpha = random.pick(&[0.25, 0.5, 0.75, 1.0, 2.0]);
        let all = rows(&shape(&case));
        // The mirror image is cut by the rule.
        let positions = case.positions.iter().map(|p| [-p[1], p[0], p[2]]).collect();
        let other = rows(&shape(&Case { positions, ..case.clone() }));
        let (findings, certificate) = judged(&case, &other, false);
        assert_ne!(certificate.verdict, Verdict::Wrong, "{case:?}\n{findings:?}");
        valid += usize::from(certificate.verdict == Verdict::Valid && other != all);
        let mut part = maximal(&other);
        if part.is_empty() {
            continue;
        }
        part.swap_remove(random.below(part.len()));
        let part = closure(&part);
        let (findings, certificate) = judged(&case, &part, false);
        assert_eq!(certificate.verdict, Verdict::Wrong, "{case:?}\n{part:?}\n{findings:?}");
        wrong += 1;
    }
    assert!(valid > 100 && wrong > 300, "{valid} {wrong}");
}

/// A cube of which all cells are missing, though its neighbours list all of its facets, and points apart from everything else.
#[test]
fn a_cube_that_is_left_out_is_named_by_its_corners() {
    let mut positions = grid(4);
    positions.extend([[9.0, 9.0, 9.0], [9.5, 9.0, 9.0], [30.0, 0.0, 0.0]]);
    let case = Case { weights: vec![0.0; positions.len()], alpha: 0.75, positions };
    let all = rows(&shape(&case));
    let is_apart = |row: &&Row| row.iter().any(|&v| v >= 64);
    let in_cube = |v: &u32| case.positions[*v as usize].iter().all(|x| (1.0..=2.0).contains(x));
    let left: Vec<Row> = maximal(&all)
        .into_iter()
        .filter(|row| !is_apart(&row) && !row.iter().all(in_cube))
        .collect();
    let (findings, _) = judged(&case, &closure(&left), false);
    let of = |finding: &Finding| match finding {
        Finding::MissingSimplex { points, .. } => points.clone(),
        Finding::MissingVertex { point, .. } => vec![*point],
        other => panic!("{other}"),
    };
    let corners: Row = (0..64).filter(in_cube).collect();
    assert_eq!(corners.len(), 8);
    assert_eq!(findings.iter().map(of).collect::<Vec<_>>(), [corners, vec![64, 65], vec![66]]);
    assert_eq!(
        findings[1].to_string(),
        "edge [64, 65] is missing: it is in the shape (squared radius 0.0625, and no point inside)"
    );
}

/// A verdict exists for any small α.
#[test]
fn an_empty_shape_is_exact_where_nothing_is_in_it() {
    for (alpha, verdict) in
        [(f64::NEG_INFINITY, Verdict::Exact), (-0.5, Verdict::Exact), (0.0, Verdict::Wrong)]
    {
        let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha };
        assert_eq!(judged(&case, &BTreeSet::new(), false).1.verdict, verdict, "{alpha}");
        assert_eq!(judged(&case, &BTreeSet::new(), true).1.verdict, Verdict::Exact, "{alpha}");
    }
}
