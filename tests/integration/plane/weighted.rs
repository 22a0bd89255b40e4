//! Weighted shapes of the plane, against the union of discs computed without a triangulation.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use proptest::prelude::*;
use walpha::Class;
use walpha::reproduce::plane::{Arc, OutlinePiece};

use super::{lattice, places, weighted};

#[test]
fn points_on_a_line_have_cells_and_a_shape() {
    let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [5.0, 5.0]];
    let shape = weighted(&points, &[0.0, 0.0, 0.0, 0.25], 0.5);
    let complex = shape.complex();
    assert_eq!(complex.edges.rows(), [[0, 1], [1, 2]]);
    assert_eq!(complex.vertices.classes()[3], Class::Singular);
    assert_eq!(complex.betti(), [2, 0]);
    assert_eq!(shape.cells().len(), 4);
    let alone = weighted(&points[..1], &[-2.0], 1.0);
    assert_eq!((alone.complex().betti(), alone.cells().len()), ([0, 0], 0));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, ..ProptestConfig::default() })]

    #[test]
    fn the_dual_complex_has_the_homotopy_type_of_the_union(
        points in lattice(),
        steps in prop::collection::vec(0..12i32, 18),
        alpha in 0..40i32,
    ) {
        // The lattice makes ties in the triangulation; the odd α keeps circles from touching.
        let alpha = f64::from(alpha) / 8.0 + 0.0137;
        let weights: Vec<f64> = points.iter().zip(&steps).map(|(_, &s)| f64::from(s / 3) / 4.0).collect();
        union_agrees(&places(&points), &weights, alpha);
    }

    #[test]
    fn scattered_discs_too(
        discs in prop::collection::vec(([0.0..10.0f64, 0.0..10.0f64], -1.0..3.0f64), 1..40),
        alpha in -0.5..2.0f64,
    ) {
        let (points, weights): (Vec<_>, Vec<_>) = discs.into_iter().unzip();
        union_agrees(&points, &weights, alpha);
        complex_agrees(&points, &weights, alpha);
    }

    #[test]
    fn a_common_weight_shifts_alpha_in_the_plane(points in lattice(), common in -4..12i32, alpha in 0..20i32) {
        let (points, zero) = (places(&points), vec![0.0; points.len()]);
        let (common, alpha) = (f64::from(common) / 4.0, f64::from(alpha) / 4.0);
        let shifted = weighted(&points, &vec![common; points.len()], alpha);
        let plain = weighted(&points, &zero, alpha + common);
        prop_assert_eq!(shifted.complex(), plain.complex());
    }
}

/// Betti numbers and outline of the union, counted without a triangulation.
fn union_agrees(points: &[[f64; 2]], weights: &[f64], alpha: f64) {
    let shape = weighted(points, weights, alpha);
    // Of discs around one place, the first of the largest counts.
    let gone: BTreeSet<u32> = shape.duplicates().iter().map(|pair| pair[0]).collect();
    let discs: Vec<Disc> = (points.iter().zip(shape.radii()).enumerate())
        .filter(|(k, _)| !gone.contains(&(*k as u32)))
        .filter_map(|(_, (&centre, radius))| Some((centre, radius?)))
        .collect();
    let outline = outline(&discs);
    assert_eq!(shape.complex().betti(), betti(&outline), "{points:?} {weights:?} {alpha}");
    assert_eq!(betti(&shape.outline()), betti(&outline));
    let (ours, theirs) = (length(&shape.outline()), length(&outline));
    assert!((ours - theirs).abs() < 1e-6 * theirs.max(1.0), "{ours} {theirs}");

    let cells = shape.cells();
    for cell in &cells {
        let starts = cell.boundary.iter().map(|piece| piece.ends()[0]).cycle().skip(1);
        assert!(cell.boundary.iter().zip(starts).all(|(piece, next)| piece.ends()[1] == next));
    }
    let tiles: f64 = cells.iter().flat_map(|cell| &cell.boundary).map(area_under).sum();
    let whole: f64 = outline.iter().map(|&arc| area_under(&OutlinePiece::Arc(arc))).sum();
    assert!((tiles - whole).abs() < 1e-6 * whole.max(1.0), "{tiles} {whole}");
}

/// The complex from its definition, for points in general position.
fn complex_agrees(points: &[[f64; 2]], weights: &[f64], alpha: f64) {
    let shape = weighted(points, weights, alpha);
    let (mut triangles, mut edges, mut vertices) =
        (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    let n = points.len() as u32;
    for a in 0..n {
        if belongs(points, weights, alpha, &[a]) {
            vertices.insert([a]);
        }
        for b in a + 1..n {
            if belongs(points, weights, alpha, &[a, b]) {
                edges.insert([a, b]);
                vertices.extend([[a], [b]]);
            }
            for c in b + 1..n {
                if belongs(points, weights, alpha, &[a, b, c]) {
                    triangles.insert([a, b, c]);
                    edges.extend([[a, b], [a, c], [b, c]]);
                    vertices.extend([[a], [b], [c]]);
                }
            }
        }
    }
    let complex = shape.complex();
    let sorted = |mut row: [u32; 3]| {
        row.sort_unstable();
        row
    };
    assert_eq!(
        complex.triangles.rows().iter().map(|&row| sorted(row)).collect::<BTreeSet<_>>(),
        triangles
    );
    assert_eq!(complex.edges.rows().iter().copied().collect::<BTreeSet<_>>(), edges);
    assert_eq!(complex.vertices.rows().iter().copied().collect::<BTreeSet<_>>(), vertices);
}

/// Whether the smallest orthogonal circle is small enough and has no point strictly inside.
fn belongs(points: &[[f64; 2]], weights: &[f64], alpha: f64, simplex: &[u32]) -> bool {
    let of = |v: u32| (points[v as usize], weights[v as usize]);
    let (p, weight) = of(simplex[0]);
    let ray = |v: u32| {
        let (q, other) = of(v);
        let a = [q[0] - p[0], q[1] - p[1]];
        (a, a[0] * a[0] + a[1] * a[1] + weight - other)
    };
    // Twice the centre, relative to p.
    let centre = match *simplex {
        [_] => [0.0; 2],
        [_, q] => {
            let (a, t) = ray(q);
            let share = t / (a[0] * a[0] + a[1] * a[1]);
            a.map(|v| v * share)
        }
        [_, q, r] => {
            let ((a, t), (b, u)) = (ray(q), ray(r));
            let det = a[0] * b[1] - a[1] * b[0];
            [(t * b[1] - u * a[1]) / det, (u * a[0] - t * b[0]) / det]
        }
        _ => unreachable!(),
    };
    let square = (centre[0] * centre[0] + centre[1] * centre[1]) / 4.0 - weight;
    square <= alpha
        && (0..points.len() as u32).filter(|v| !simplex.contains(v)).all(|v| {
            let (e, t) = ray(v);
            t >= centre[0] * e[0] + centre[1] * e[1]
        })
}

/// A disc: centre and radius.
pub type Disc = ([f64; 2], f64);

/// The arcs of each circle that no other disc covers, found from all pairs of discs.
pub fn outline(discs: &[Disc]) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for (i, &(centre, radius)) in discs.iter().enumerate() {
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [centre[0] + radius * cos, centre[1] + radius * sin]
        };
        let mut ends = Vec::new();
        for (j, &(other, reach)) in discs.iter().enumerate() {
            let (dx, dy) = (other[0] - centre[0], other[1] - centre[1]);
            let apart = dx.hypot(dy);
            if j != i && apart < radius + reach && apart > (radius - reach).abs() {
                let cos =
                    (apart * apart + radius * radius - reach * reach) / (2.0 * apart * radius);
                let (middle, spread) = (dy.atan2(dx), cos.acos());
                ends.extend([middle - spread, middle + spread].map(|end| end.rem_euclid(TAU)));
            }
        }
        ends.sort_by(f64::total_cmp);
        let free = |angle: f64| {
            let place = at(angle);
            discs.iter().enumerate().all(|(j, &(other, reach))| {
                j == i || (place[0] - other[0]).hypot(place[1] - other[1]) > reach
            })
        };
        let arc = |start, end| Arc { centre, radius, start, end, counter_clockwise: true };
        match ends.first() {
            None if free(0.0) => arcs.push(arc(at(0.0), at(0.0))),
            None => {}
            Some(&first) => {
                let next = ends.iter().copied().skip(1).chain([first + TAU]);
                let pieces = ends.iter().copied().zip(next);
                let free = pieces.filter(|&(from, to)| free(f64::midpoint(from, to)));
                arcs.extend(free.map(|(from, to)| arc(at(from), at(to))));
            }
        }
    }
    arcs
}

/// Components and holes of a region bounded by arcs that have it on their left: loops around it,
/// which enclose a positive area, and loops inside it.
pub fn betti(arcs: &[Arc]) -> [u64; 2] {
    let mut used = vec![false; arcs.len()];
    let mut count = [0, 0];
    for first in 0..arcs.len() {
        if used[first] {
            continue;
        }
        let (mut at, mut area) = (first, 0.0);
        loop {
            used[at] = true;
            area += area_under(&OutlinePiece::Arc(arcs[at]));
            let end = arcs[at].end;
            let gap = |k: &usize| (arcs[*k].start[0] - end[0]).hypot(arcs[*k].start[1] - end[1]);
            at = (0..arcs.len()).min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap();
            assert!(gap(&at) < 1e-6, "the outline is torn: a gap of {}", gap(&at));
            if at == first {
                break;
            }
            assert!(!used[at], "two arcs end in one");
        }
        count[usize::from(area < 0.0)] += 1;
    }
    count
}

/// Half the integral of x dy − y dx along a piece; around a region it sums to the area.
pub fn area_under(piece: &OutlinePiece) -> f64 {
    let arc = match piece {
        OutlinePiece::Segment([a, b]) => return (a[0] * b[1] - a[1] * b[0]) / 2.0,
        OutlinePiece::Arc(arc) => arc,
    };
    let (from, sweep) = (arc.start_angle(), arc.sweep());
    let to = from + sweep;
    let [x, y] = arc.centre;
    let r = arc.radius;
    (r * r * sweep + r * x * (to.sin() - from.sin()) - r * y * (to.cos() - from.cos())) / 2.0
}

/// The sum of lengths.
pub fn length(arcs: &[Arc]) -> f64 {
    arcs.iter().map(|arc| arc.radius * arc.sweep().abs()).sum()
}
