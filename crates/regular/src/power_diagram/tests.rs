use walpha_base::random::Random;

use super::*;
use crate::locate::tests::{Place, doubles};
use crate::triangulate;
use crate::triangulation::tests::set;

/// Sets of a few dozen points, which have cells with one sphere, hidden points and duplicates.
fn sets() -> impl Iterator<Item = (Vec<Place>, Vec<f64>, Triangulation)> {
    let mut random = Random::new(11);
    (0..300).filter_map(move |case| {
        let (points, weights) = set(&mut random, case);
        let made = triangulate(&doubles(&points), Some(&weights)).ok()?;
        Some((points, weights, made))
    })
}

/// The centre of the orthogonal sphere as numerators and their denominator, by integers.
fn centre([a, b, c, d]: [(Place, f64); 4]) -> ([i128; 3], i128) {
    let ray = |(q, weight): (Place, f64)| {
        let vector = [0, 1, 2].map(|k| i128::from(q[k] - a.0[k]));
        let power = vector.iter().map(|x| x * x).sum::<i128>() + (a.1 - weight) as i128;
        (vector, power)
    };
    let rays = [b, c, d].map(ray);
    let determinant = |column: &dyn Fn(usize) -> [i128; 3]| {
        let [x, y, z] = [0, 1, 2].map(column);
        x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0])
    };
    let vectors = |k: usize| rays.map(|(vector, _)| vector[k]);
    let twice = 2 * determinant(&vectors);
    // Cramer's rule: powers in place of one column.
    let replaced = |at: usize| {
        determinant(&|k: usize| if k == at { rays.map(|(_, power)| power) } else { vectors(k) })
    };
    ([0, 1, 2].map(|k| i128::from(a.0[k]) * twice + replaced(k)), twice)
}

#[test]
fn cells_with_one_centre_have_one_number() {
    let (mut shared, mut cells) = (0, 0);
    for (points, weights, made) in sets() {
        let diagram = PowerDiagram::of(&made, Some(&weights)).unwrap();
        let site = |v: u32| (points[v as usize], weights[v as usize]);
        let centres: Vec<_> =
            made.finite_cells().map(|(_, corners)| centre(corners.map(site))).collect();
        let numbers = diagram.same_sphere();
        assert_eq!(numbers.len(), centres.len());
        for (i, (numerators, denominator)) in centres.iter().enumerate() {
            for (j, (others, other)) in centres[..i].iter().enumerate() {
                let equal = (0..3).all(|k| numerators[k] * other == others[k] * denominator);
                assert_eq!(equal, numbers[i] == numbers[j], "cells {i} and {j}");
            }
            // Numbers count up in the order of cells.
            assert!(numbers[i] <= numbers[..i].iter().max().map_or(0, |most| most + 1));
            for (found, &numerator) in
                diagram.vertices()[numbers[i] as usize].into_iter().zip(numerators)
            {
                let exact = numerator as f64 / *denominator as f64;
                assert!((found - exact).abs() < 1e-6 * (1.0 + exact.abs()), "{found} {exact}");
            }
        }
        shared += numbers.len() - diagram.vertices().len();
        cells += numbers.len();
    }
    assert!(shared > 1000 && shared < cells - 1000, "{shared} of {cells}");
}

/// Each cell is divided into simplices whose corners are the weighted circumcentres of a vertex, an edge, a facet and a
/// tetrahedron, each a face of the next. They have a sign, because centres may lie outside of their faces (Mullen, Memari, de
/// Goes and Desbrun 2011, doi:10.1145/1964921.1964998).
fn by_centres(made: &Triangulation, weights: &[f64]) -> Vec<f64> {
    let bounded = |v: u32| made.star(v).into_iter().all(|cell| made.is_finite(cell));
    let none = |v: u32| if !made.is_vertex(v) || bounded(v) { 0.0 } else { f64::INFINITY };
    let mut volumes: Vec<f64> = (0..made.infinite_vertex()).map(none).collect();
    for (_, corners) in made.finite_cells() {
        for order in orders(corners) {
            let site = |v: u32| (made.positions()[v as usize], weights[v as usize]);
            volumes[order[0] as usize] += signed_volume(order.map(site));
        }
    }
    volumes
}

/// The 24 orders of four corners.
fn orders([a, b, c, d]: [u32; 4]) -> impl Iterator<Item = [u32; 4]> {
    let first = [[a, b, c, d], [b, a, c, d], [c, a, b, d], [d, a, b, c]];
    first.into_iter().flat_map(|[p, q, r, s]| {
        [[p, q, r, s], [p, q, s, r], [p, r, q, s], [p, r, s, q], [p, s, q, r], [p, s, r, q]]
    })
}

/// The volume of the simplex of the centres of the first point, the first two, three and four; negative if the way from centre to
/// centre leads away from the next point an odd number of times.
fn signed_volume([(p, weight), rest @ ..]: [([f64; 3], f64); 4]) -> f64 {
    // The centre, relative to p, and orthogonal directions: Gram and Schmidt. A step along a direction does not change the powers
    // of the points before. Its length makes the power of the next point equal to theirs.
    let (mut centre, mut volume) = ([0.0; 3], 1.0 / 6.0);
    let mut directions: Vec<[f64; 3]> = Vec::new();
    for (q, other) in rest {
        let way = sub(q, p);
        let mut direction = way;
        for d in &directions {
            let share = dot(way, *d) / dot(*d, *d);
            direction = [0, 1, 2].map(|k| direction[k] - share * d[k]);
        }
        let square = dot(direction, direction);
        let step = ((dot(way, way) + weight - other) / 2.0 - dot(centre, way)) / square;
        centre = [0, 1, 2].map(|k| centre[k] + step * direction[k]);
        volume *= step * square.sqrt();
        directions.push(direction);
    }
    volume
}

#[test]
fn volumes_are_sums_over_simplices_of_centres() {
    let (mut bounded, mut none) = (0, 0);
    for (_, weights, made) in sets() {
        let diagram = PowerDiagram::of(&made, Some(&weights)).unwrap();
        for (v, expected) in (0..).zip(by_centres(&made, &weights)) {
            let found = diagram.volumes()[v as usize];
            assert!(
                found == expected || (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                "of {v}: {found}, not {expected}"
            );
            bounded += usize::from(found > 0.0 && found.is_finite());
            none += usize::from(!made.is_vertex(v) && found == 0.0);
        }
    }
    assert!(bounded > 500 && none > 500, "{bounded} {none}");
}

/// A bounded cell is a closed polyhedron: the sum of its facets, each times its normal, is zero.
#[test]
fn facets_close_cells() {
    let mut closed = 0;
    for (_, weights, made) in sets() {
        let diagram = PowerDiagram::of(&made, Some(&weights)).unwrap();
        assert!(diagram.facets().is_sorted_by(|a, b| a < b));
        let mut sums = vec![[0.0; 3]; weights.len()];
        let mut surfaces = vec![0.0; weights.len()];
        for (&[p, q], &area) in diagram.facets().iter().zip(diagram.areas()) {
            assert!(p < q && area > 0.0);
            let way = sub(made.positions()[q as usize], made.positions()[p as usize]);
            for (v, sign) in [(p as usize, 1.0), (q as usize, -1.0)] {
                surfaces[v] += area;
                sums[v] = [0, 1, 2].map(|k| sums[v][k] + sign * area * way[k] / length(way));
            }
        }
        for (v, &volume) in diagram.volumes().iter().enumerate() {
            if volume > 0.0 && volume.is_finite() {
                assert!(length(sums[v]) < 1e-6 * surfaces[v], "of {v}: {:?}", sums[v]);
                closed += 1;
            } else {
                assert!(volume == 0.0 || surfaces[v] == f64::INFINITY);
            }
        }
    }
    assert!(closed > 500, "{closed}");
}

/// Whether a point that is not hidden is in a segment, a triangle or a tetrahedron of others, and its height |p|² − ω is the mean
/// of their heights, weighted by their shares in its place.
fn is_just_seen(points: &[Place], heights: &[i64], v: usize) -> bool {
    let lifted = |i: usize| {
        let way = [0, 1, 2].map(|k| points[i][k] - points[v][k]);
        (way, heights[i] - heights[v])
    };
    let dot = |a: Place, b: Place| (0..3).map(|k| a[k] * b[k]).sum::<i64>();
    let cross = |a: Place, b: Place| {
        [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let balance = |shares: &[(i64, usize)]| {
        shares.iter().all(|(share, _)| *share > 0)
            && shares.iter().map(|&(share, i)| share * lifted(i).1).sum::<i64>() == 0
    };
    let others: Vec<usize> = (0..points.len()).filter(|&i| i != v).collect();
    let way = |i: usize| lifted(i).0;
    others.iter().enumerate().any(|(first, &a)| {
        others[..first].iter().enumerate().any(|(second, &b)| {
            let normal = cross(way(a), way(b));
            if normal == [0; 3] {
                return balance(&[(dot(way(b), way(b)), a), (-dot(way(a), way(b)), b)]);
            }
            others[..second].iter().enumerate().any(|(third, &c)| {
                let sides = [(cross(way(b), way(c)), a), (cross(way(c), way(a)), b), (normal, c)];
                let volume = dot(way(c), normal);
                if volume == 0 {
                    return balance(&sides.map(|(side, i)| (dot(side, normal), i)));
                }
                others[..third].iter().any(|&d| {
                    let [of_a, of_b, of_c] =
                        sides.map(|(side, _)| -volume.signum() * dot(side, way(d)));
                    balance(&[(of_a, a), (of_b, b), (of_c, c), (volume.abs(), d)])
                })
            })
        })
    })
}

/// Heights that are the largest of a few linear functions are on no corner of their graph at most points.
#[test]
fn points_that_are_just_not_hidden_have_no_volume() {
    let mut random = Random::new(12);
    let (mut flat, mut solid) = ([0; 2], 0);
    for _ in 0..60 {
        let mut points: Vec<Place> =
            (0..18).map(|_| [0; 3].map(|_| random.below(3) as i64)).collect();
        points.sort_unstable();
        points.dedup();
        let slopes: Vec<Place> =
            (0..3).map(|_| [0; 3].map(|_| random.below(7) as i64 - 3)).collect();
        let height =
            |p: &Place| slopes.iter().map(|s| (0..3).map(|k| s[k] * p[k]).sum::<i64>()).max();
        let heights: Vec<i64> = points.iter().map(|p| height(p).unwrap()).collect();
        let square = |p: &Place| p.iter().map(|x| x * x).sum::<i64>();
        let weights: Vec<f64> =
            points.iter().zip(&heights).map(|(p, height)| (square(p) - height) as f64).collect();
        let Ok(made) = triangulate(&doubles(&points), Some(&weights)) else { continue };
        let diagram = PowerDiagram::of(&made, Some(&weights)).unwrap();
        for v in made.vertices() {
            let volume = diagram.volumes()[v as usize];
            let seen = is_just_seen(&points, &heights, v as usize);
            let has_facet = diagram.facets().iter().any(|facet| facet.contains(&v));
            assert_eq!(
                (volume == 0.0, !has_facet),
                (seen, seen),
                "{v} of {points:?} {weights:?}: {volume}"
            );
            let on_hull = made.star(v).into_iter().any(|cell| !made.is_finite(cell));
            assert!(seen || (volume == f64::INFINITY) == on_hull);
            flat[usize::from(on_hull)] += usize::from(seen);
            solid += usize::from(!seen);
        }
    }
    assert!(flat[0] > 10 && flat[1] > 100 && solid > 100, "{flat:?} {solid}");
}

/// Neighbours are points whose cells have a common area, also if cells without volume of one point or several are between them.
#[test]
fn cells_without_volume_have_no_facets() {
    let row = |inner: &[f64]| {
        let mut points = vec![[0.0; 3], [8.0, 0.0, 0.0], [4.0, 8.0, 0.0], [4.0, 0.0, 8.0]];
        let mut weights = vec![0.0; 4];
        for &x in inner {
            points.push([x, 0.0, 0.0]);
            // The height of the segment from 0 to 8 at this position.
            weights.push(x * x - 8.0 * x);
        }
        PowerDiagram::of(&triangulate(&points, Some(&weights)).unwrap(), Some(&weights)).unwrap()
    };
    let alone = row(&[]);
    assert_eq!(alone.facets(), [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]);
    for inner in [&[4.0][..], &[1.0, 3.0], &[7.0, 2.0, 5.0]] {
        let made = row(inner);
        assert_eq!((made.facets(), made.areas()), (alone.facets(), alone.areas()));
        assert_eq!(made.volumes()[..4], *alone.volumes());
        assert!(made.volumes()[4..].iter().all(|&volume| volume == 0.0), "{inner:?}");
    }
    // A point in the middle of a facet of the hull, and one in the middle of the cell.
    let corners = [[0.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 8.0]];
    for (inner, weight) in [([2.0, 2.0, 0.0], 8.0 - 24.0), ([1.5, 1.5, 2.0], 8.5 - 34.0)] {
        let points = [&corners[..], &[inner]].concat();
        let weights = [0.0, 0.0, 0.0, 0.0, weight];
        let made = triangulate(&points, Some(&weights)).unwrap();
        assert!(made.is_vertex(4));
        let diagram = PowerDiagram::of(&made, Some(&weights)).unwrap();
        assert_eq!(diagram.volumes()[4], 0.0);
        assert_eq!(diagram.facets(), alone.facets());
    }
}

/// Facets of a point in the middle of a lattice, with the area of each, and the volume of its cell.
fn of_middle(points: &[Place]) -> (Vec<f64>, f64) {
    let middle = points.iter().position(|&p| p == [0; 3]).unwrap() as u32;
    let diagram = PowerDiagram::of(&triangulate(&doubles(points), None).unwrap(), None).unwrap();
    let facets = diagram.facets().iter().zip(diagram.areas());
    let mut areas: Vec<f64> =
        facets.filter(|(facet, _)| facet.contains(&middle)).map(|(_, &area)| area).collect();
    areas.sort_by(f64::total_cmp);
    (areas, diagram.volumes()[middle as usize])
}

#[test]
fn lattices_have_the_cells_of_textbooks() {
    let box_of = |kept: fn(Place) -> bool| -> Vec<Place> {
        (0..343).map(|i| [i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3]).filter(|&p| kept(p)).collect()
    };
    let near = |found: f64, expected: f64| (found - expected).abs() < 1e-12 * expected;
    let (cube, volume) = of_middle(&box_of(|_| true));
    assert!(cube.len() == 6 && cube.iter().all(|&area| near(area, 1.0)) && near(volume, 1.0));
    let (rhombic, volume) = of_middle(&box_of(|p| p.iter().sum::<i64>() % 2 == 0));
    assert!(rhombic.len() == 12 && rhombic.iter().all(|&area| near(area, 0.5f64.sqrt())));
    assert!(near(volume, 2.0));
    // A truncated octahedron: six squares, and eight hexagons with edges of the same length √(1/2).
    let (truncated, volume) = of_middle(&box_of(|[x, y, z]| (x - y) % 2 == 0 && (y - z) % 2 == 0));
    assert_eq!(truncated.len(), 14);
    assert!(truncated[..6].iter().all(|&area| near(area, 0.5)));
    assert!(truncated[6..].iter().all(|&area| near(area, 0.75 * 3f64.sqrt())));
    assert!(near(volume, 4.0));
}

/// Facets of cells on the hull: also there, those that degenerate are not listed.
#[test]
fn a_lattice_has_facets_between_neighbours_alone() {
    let points: Vec<Place> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16]).collect();
    let diagram = PowerDiagram::of(&triangulate(&doubles(&points), None).unwrap(), None).unwrap();
    assert_eq!((diagram.vertices().len(), diagram.facets().len()), (27, 3 * 4 * 4 * 3));
    let finite = diagram.areas().iter().filter(|area| area.is_finite()).count();
    assert_eq!(finite, 3 * 2 * 2 * 3);
}

/// Lengths scale only by powers of two, so they are the same except for these; also far from the origin.
#[test]
fn tiny_huge_and_distant_cells_are_as_precise() {
    let mut random = Random::new(7);
    let points: Vec<[f64; 3]> = (0..300).map(|_| [0; 3].map(|_| random.whole(0, 4000))).collect();
    let of =
        |points: &[[f64; 3]]| PowerDiagram::of(&triangulate(points, None).unwrap(), None).unwrap();
    let made = of(&points);
    // Faces have about 4·10⁵ square units, cells 2·10⁸ cubic ones.
    let near = |a: f64, b: f64, tolerance: f64| a == b || (a - b).abs() <= tolerance;
    assert!(made.volumes().iter().filter(|volume| volume.is_finite()).count() > 100);
    for power in [-330, 300] {
        let scale = 2f64.powi(power);
        let scaled: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        let other = of(&scaled);
        assert_eq!(made.facets(), other.facets());
        for (area, theirs) in made.areas().iter().zip(other.areas()) {
            assert!(near(area * scale * scale, *theirs, 1e-3 * scale * scale));
        }
        for (volume, theirs) in made.volumes().iter().zip(other.volumes()) {
            assert!(near(volume * scale * scale * scale, *theirs, scale * scale * scale));
        }
    }
    let moved: Vec<_> = points.iter().map(|p| p.map(|x| x + 2f64.powi(40))).collect();
    let other = of(&moved);
    for (volume, theirs) in made.volumes().iter().zip(other.volumes()) {
        assert!(near(*volume, *theirs, 1.0));
    }
}

/// If doubles do not hold areas or volumes, these are NaN; unbounded ones are known.
#[test]
fn what_doubles_do_not_hold_is_nan() {
    let mut random = Random::new(8);
    let points: Vec<[f64; 3]> = (0..100).map(|_| [0; 3].map(|_| random.whole(0, 4000))).collect();
    let of =
        |points: &[[f64; 3]]| PowerDiagram::of(&triangulate(points, None).unwrap(), None).unwrap();
    let made = of(&points);
    for (power, areas_too) in [(-400, false), (-900, true), (340, false), (480, true)] {
        let scaled: Vec<_> = points.iter().map(|p| p.map(|x| x * 2f64.powi(power))).collect();
        let other = of(&scaled);
        assert_eq!(made.facets(), other.facets());
        for (area, theirs) in made.areas().iter().zip(other.areas()) {
            let infinite = *area == f64::INFINITY;
            assert!(
                infinite == (*theirs == f64::INFINITY)
                    && (infinite || areas_too == theirs.is_nan())
            );
        }
        for (volume, theirs) in made.volumes().iter().zip(other.volumes()) {
            let infinite = *volume == f64::INFINITY;
            assert!(if infinite { theirs == volume } else { theirs.is_nan() }, "{power}: {theirs}");
        }
    }
    // A cell so flat that its centre is beyond the doubles: four points within a sphere of a radius of 10³³⁰.
    let flat = [[0.0; 3], [1e150, 0.0, 0.0], [0.0, 1e150, 0.0], [1e150, 2e150, 1e-30]];
    let diagram = of(&flat);
    assert!(diagram.vertices()[0].iter().any(|x| x.is_infinite()), "{:?}", diagram.vertices());
    assert!(diagram.volumes().iter().all(|&volume| volume == f64::INFINITY));
}

/// The corners of a tetrahedron, one of them a last bit away from the next.
#[test]
fn thin_cells_have_centres_to_the_last_bit() {
    let up = 1f64.next_up();
    let corners = [[0.0, 0.0, 1.0], [0.0, 0.0, up], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let made = triangulate(&corners, None).unwrap();
    let diagram = PowerDiagram::of(&made, None).unwrap();
    assert_eq!(diagram.vertices(), [[0.5, 0.5, 1.0]]);
}

#[test]
fn the_same_on_any_number_of_threads_and_errors() {
    let mut random = Random::new(3);
    let points: Vec<[f64; 3]> = (0..20_000).map(|_| [0; 3].map(|_| random.whole(0, 60))).collect();
    let made = triangulate(&points, None).unwrap();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| PowerDiagram::of(&made, None).unwrap())
    };
    assert!(made.cells().len() > 10 * CHUNK);
    assert!(on(1) == on(3));

    use crate::SitesError::{Lengths, Value};
    let of = |weights: &[f64]| PowerDiagram::of(&made, Some(weights)).err();
    assert!(matches!(of(&[0.0]), Some(TriangulationError::Sites(Lengths { .. }))));
    assert!(matches!(
        of(&vec![f64::NAN; 20_000]),
        Some(TriangulationError::Sites(Value { index: 0, .. }))
    ));
    let cancelled = Monitor::new(|_, _| ());
    cancelled.cancel();
    let stopped = cancelled.watch(|| PowerDiagram::of(&made, None));
    assert!(matches!(stopped, Err(TriangulationError::Cancelled(_))));
}
