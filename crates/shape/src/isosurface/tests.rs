use walpha_base::random::Random;

use super::*;
use crate::make::alpha_shape_by;
use crate::voxels::tests::by_definition;

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const VALUE: f64 = 3.0;

/// Samples by their indices.
struct Scan {
    dims: [usize; 3],
    samples: Vec<f64>,
}

impl Scan {
    fn new(dims: [usize; 3], mut sample: impl FnMut([usize; 3]) -> f64) -> Self {
        let [x, y, z] = dims;
        let all = (0..x * y * z).map(|i| sample([i % x, i / x % y, i / x / y]));
        Self { dims, samples: all.collect() }
    }

    fn lattice(&self) -> SampleLattice {
        SampleLattice { dims: self.dims, origin: [0.0; 3], axes: UNIT }
    }

    fn shape(&self) -> AlphaShape {
        isosurface_shape(&self.lattice(), |i| self.samples[i], VALUE, Extent::Whole).unwrap()
    }

    fn at(&self, at: [usize; 3]) -> f64 {
        self.samples[at[0] + self.dims[0] * (at[1] + self.dims[1] * at[2])]
    }

    fn field(&self) -> Field<impl Fn(usize) -> f64 + Sync> {
        Field { dims: self.dims, sample: |i: usize| self.samples[i], value: VALUE }
    }
}

/// A ball about the middle, by the distance from its surface.
fn ball(side: usize, radius: f64) -> Scan {
    let middle = (side - 1) as f64 / 2.0;
    Scan::new([side; 3], |at| {
        VALUE + radius - at.iter().map(|&i| (i as f64 - middle).powi(2)).sum::<f64>().sqrt()
    })
}

/// Fields with what makes surfaces hard: samples at the value and one bit below it, plates, gaps and cavities one sample wide, samples inside
/// that share an edge or a corner of a cube, faces and cubes that are ambiguous, borders, and places without a sample.
fn scans() -> Vec<Scan> {
    let below = VALUE.next_down();
    let either = |inside: bool| if inside { VALUE } else { below };
    let mut random = Random::new(11);
    let mut scans = vec![
        Scan::new([2; 3], |_| VALUE),
        Scan::new([2; 3], |at| either(at == [0; 3])),
        Scan::new([2; 3], |at| either(at[0] == at[1] && at[1] == at[2])),
        Scan::new([2; 3], |at| either((at[0] + at[1] + at[2]) % 2 == 0)),
        Scan::new([5; 3], |at| either((at[0] + at[1] + at[2]) % 2 == 0)),
        Scan::new([6, 5, 4], |at| if at[0] == 3 { 0.0 } else { 4.0 }),
        Scan::new([6, 5, 4], |at| if at[0] == 3 { 4.0 } else { 0.0 }),
        Scan::new([7; 3], |at| if at == [3; 3] { -100.0 } else { 100.0 }),
        Scan::new([9; 3], |at| if at.iter().all(|&i| i > 0 && i < 8) { 4.0 } else { 1.0 }),
        Scan::new([3, 4, 70], |at| if at[2] % 33 == 1 { f64::NAN } else { 5.0 }),
        Scan::new([4, 4, 4], |at| f64::INFINITY * if at[0] < 2 { 1.0 } else { -1.0 }),
        ball(12, 4.3),
        ball(15, 6.0),
    ];
    for levels in [2, 3, 7, 1000] {
        for share in [0.3, 0.5, 0.8] {
            let field = |_| {
                let inside = random.unit() < share;
                let off = (random.below(levels) as f64) / levels as f64;
                if inside { VALUE + off } else { below - off }
            };
            scans.push(Scan::new([6, 5, 7], field));
        }
    }
    scans
}

/// Whether a place, in steps, is that of a sample; and the sample.
fn sample_at(place: [f64; 3]) -> Option<[usize; 3]> {
    place.iter().all(|x| x % STEPS == 0.0).then(|| place.map(|x| (x / STEPS) as usize))
}

/// The complex, sheets and Betti numbers are those that follow from the whole triangulation of the points and the samples at the
/// corners of its cells, no cell of which has samples on both sides.
#[test]
fn the_solid_is_that_of_the_definition() {
    let mut between_crossings = [0; 2];
    for (number, scan) in scans().iter().enumerate() {
        let field = scan.field();
        let Points { places, inside, .. } = field.points(Extent::Whole).unwrap();
        let counts = std::cell::Cell::new(between_crossings);
        let is_inside = |corners: [[f64; 3]; 4]| {
            let samples = corners.into_iter().filter_map(sample_at).map(|at| scan.at(at) >= VALUE);
            let samples: Vec<bool> = samples.collect();
            if let Some(&first) = samples.first() {
                assert!(samples.iter().all(|&other| other == first), "scan {number}");
                return first;
            }
            // All corners are crossings of one cube.
            let least = |k: usize| corners.iter().map(|p| p[k]).fold(f64::MAX, f64::min) / STEPS;
            let most = |k: usize| corners.iter().map(|p| p[k]).fold(f64::MIN, f64::max) / STEPS;
            assert!((0..3).all(|k| most(k) <= least(k).floor() + 1.0), "scan {number}");
            let centroid = [0, 1, 2].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 4.0);
            let reached = field.reaches(centroid);
            let mut both = counts.get();
            both[usize::from(reached)] += 1;
            counts.set(both);
            reached
        };
        let whole = by_definition(&places, is_inside);
        between_crossings = counts.get();
        let expected = alpha_shape_by(
            WeightedPoints::unweighted(places.clone()),
            &ShapeOptions::new(Alpha::INFINITE),
            |_, _| Ok(whole.clone()),
            &Monitor::noop(),
        )
        .unwrap();
        let found = scan.shape();
        assert_eq!(found.points().len(), inside);
        assert_eq!(found.complex(), expected.complex(), "scan {number}");
        assert_eq!(found.sheets(), expected.sheets(), "scan {number}");
        assert_eq!(found.betti(), expected.betti(), "scan {number}");
        assert!(found.solid().0.manifold_defects().is_empty(), "scan {number}");
    }
    assert!(between_crossings.iter().all(|&count| count > 20), "{between_crossings:?}");
}

/// The boundary has its vertices where edges of the grid take the value, and otherwise lies in the border of the grid. Samples inside are
/// inside, and no other sample is in the solid.
#[test]
fn the_boundary_is_where_edges_take_the_value() {
    for (number, scan) in scans().iter().enumerate() {
        let shape = scan.shape();
        let place = |v: u32| shape.points().positions()[v as usize].map(|x| x * STEPS);
        let values = shape.points().values().unwrap();
        for facet in shape.complex().facets.of(Class::Regular) {
            let at_border = (0..3).any(|k| {
                let end = STEPS * (scan.dims[k] - 1) as f64;
                [0.0, end].iter().any(|&x| facet.iter().all(|&v| place(v)[k] == x))
            });
            assert!(at_border || facet.iter().all(|&v| sample_at(place(v)).is_none()), "{number}");
        }
        for (v, &value) in (0..).zip(values) {
            let place = place(v);
            if let Some(at) = sample_at(place) {
                assert!(value == scan.at(at) && value >= VALUE, "scan {number}");
                continue;
            }
            assert_eq!(value, VALUE);
            let along = (0..3).find(|&k| place[k] % STEPS != 0.0).unwrap();
            let low = place.map(|x| (x / STEPS) as usize);
            let mut high = low;
            high[along] += 1;
            let [f, g] = [low, high].map(|at| scan.at(at));
            assert!((f >= VALUE) != (g >= VALUE), "scan {number}");
            let share = (place[along] % STEPS) / STEPS;
            let expected = (VALUE - f) / (g - f);
            if expected.is_nan() {
                assert_eq!(share, 0.5);
            } else {
                assert!(
                    (share - expected.clamp(MARGIN / STEPS, 1.0 - MARGIN / STEPS)).abs()
                        <= 0.5 / STEPS,
                    "{share}"
                );
            }
        }
    }
}

/// Of a ball the volume is that of a ball, and of a linear field the solid ends in a plane.
#[test]
fn volumes_are_those_of_what_was_sampled() {
    for (side, radius) in [(24, 10.3), (40, 17.0)] {
        let volume = ball(side, radius).shape().measures().volume;
        let expected = 4.0 / 3.0 * std::f64::consts::PI * f64::powi(radius, 3);
        assert!((volume / expected - 1.0).abs() < 0.01, "{volume} for {expected}");
    }
    // x + y / 2 + z / 4 ≤ 3 in a cube of side 4, which ends within the sides: the integral of the reach along x.
    let wedge = Scan::new([5; 3], |[x, y, z]| 6.0 - x as f64 - y as f64 / 2.0 - z as f64 / 4.0);
    let volume = wedge.shape().measures().volume;
    assert!((volume - 16.0 * (3.0 - 1.0 - 0.5)).abs() < 0.02, "{volume}");
}

/// A gap one sample wide stays open, a cavity of one sample is there, and a plate of one sample is thin and whole.
#[test]
fn what_is_one_sample_wide_is_there() {
    let betti = |scan: &Scan| {
        let betti = scan.shape().betti().unwrap();
        [betti.b0, betti.b1, betti.b2]
    };
    assert_eq!(betti(&Scan::new([7, 5, 5], |at| if at[0] == 3 { 0.0 } else { 4.0 })), [2, 0, 0]);
    assert_eq!(betti(&Scan::new([7; 3], |at| if at == [3; 3] { 0.0 } else { 4.0 })), [1, 0, 1]);
    let plate = Scan::new([7, 5, 5], |at| if at[0] == 3 { 4.0 } else { 2.0 });
    assert_eq!(betti(&plate), [1, 0, 0]);
    assert_eq!(plate.shape().measures().volume, 16.0);
}

/// A closed solid is one piece without a void, and elsewhere what the whole is.
#[test]
fn closed_solids_are_in_one_piece() {
    let mut filled = 0;
    for (number, scan) in scans().iter().enumerate() {
        let make = |extent| isosurface_shape(&scan.lattice(), |i| scan.samples[i], VALUE, extent);
        let (whole, closed) = (make(Extent::Whole).unwrap(), make(Extent::Closed).unwrap());
        let betti = closed.betti().unwrap();
        assert_eq!((betti.b0, betti.b2), (1, 0), "scan {number}");
        filled += whole.betti().unwrap().b2;
        // Its boundary is a part of that of the whole.
        let places = |shape: &AlphaShape| {
            let facets = shape.complex().facets.of(Class::Regular);
            let ends = facets.flatten().map(|&v| shape.points().positions()[v as usize]);
            ends.map(|place| place.map(f64::to_bits)).collect::<std::collections::BTreeSet<_>>()
        };
        assert!(places(&closed).is_subset(&places(&whole)), "scan {number}");
    }
    assert!(filled > 4, "{filled}");
    // Two balls, the larger one hollow with a core: all of it, and nothing of the other.
    let scan = Scan::new([40, 24, 24], |[x, y, z]| {
        let from = |middle: f64| {
            let squared = [x as f64 - middle, y as f64 - 11.5, z as f64 - 11.5].map(|d| d * d);
            squared.iter().sum::<f64>().sqrt()
        };
        let shell = (10.0 - from(11.5)).min(from(11.5) - 5.0).max(2.0 - from(11.5));
        VALUE + shell.max(5.0 - from(32.0))
    });
    let closed = isosurface_shape(&scan.lattice(), |i| scan.samples[i], VALUE, Extent::Closed);
    let volume = closed.unwrap().measures().volume;
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
    assert!((volume / expected - 1.0).abs() < 0.01, "{volume}");
}

/// A mirrored, an oblique grid: as many cells, positively oriented, of the volume that the steps give them.
#[test]
fn grids_lie_anywhere_in_the_world() {
    let plain = ball(12, 4.3);
    let volume = plain.shape().measures().volume;
    for (axes, factor) in [
        ([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -0.5]], 1.0),
        ([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.25, 1.0]], 1.0),
        ([[0.7, 0.0, 0.0], [0.0, 0.7, 0.1], [0.0, -0.7, 5.0]], 0.7 * (0.7 * 5.0 + 0.07)),
    ] {
        let lattice = SampleLattice { dims: plain.dims, origin: [100.0, -20.0, 3.0], axes };
        let found = isosurface_shape(&lattice, |i| plain.samples[i], VALUE, Extent::Whole).unwrap();
        assert!((found.measures().volume / (factor * volume) - 1.0).abs() < 1e-9, "{axes:?}");
        assert_eq!(found.complex().cells.len(), plain.shape().complex().cells.len());
        assert_eq!(found.betti(), plain.shape().betti());
        let is_positive = |cell: &[u32; 4]| crate::six_volumes(found.corners(*cell)) > 0.0;
        assert!(found.complex().cells.rows().iter().all(is_positive));
        let outward: f64 = found
            .complex()
            .facets
            .of(Class::Regular)
            .map(|&facet| {
                let [a, b, c] = found.corners(facet);
                crate::six_volumes([[100.0, -20.0, 3.0], a, b, c])
            })
            .sum();
        assert!((outward / 6.0 / (factor * volume) - 1.0).abs() < 1e-9, "{outward}");
    }
}

#[test]
fn what_has_no_isosurface_is_refused() {
    let refused = |scan: &Scan, lattice: SampleLattice| {
        isosurface_shape(&lattice, |i| scan.samples[i], VALUE, Extent::Whole).unwrap_err()
    };
    let low = Scan::new([3; 3], |at| at[0] as f64);
    let empty = IsosurfaceError::Empty { value: VALUE, largest: 2.0 };
    assert_eq!(refused(&low, low.lattice()), empty.into());
    let slice = Scan::new([3, 3, 1], |_| 9.0);
    assert_eq!(refused(&slice, slice.lattice()), IsosurfaceError::Flat { dims: [3, 3, 1] }.into());
    let ball = ball(12, 4.3);
    let far = SampleLattice { origin: [1e15, 0.0, 0.0], ..ball.lattice() };
    assert!(matches!(refused(&ball, far), ShapeError::Isosurface(IsosurfaceError::Rounded { .. })));
    // Places beyond all doubles.
    let mut wide = ball.lattice();
    wide.axes[1] = [0.0, 1e308, 0.0];
    assert!(matches!(
        refused(&ball, wide),
        ShapeError::Isosurface(IsosurfaceError::Rounded { .. })
    ));
}
