//! Shapes of a torus: against copies in space, against homology by matrices, and by the laws that only a
//! torus has; filtrations, too.

mod command;
mod oracle;

use walpha::check::schema::{ComplexFile, PlacedComplex};
use walpha::ladder::Filtration;
use walpha::shape::{
    Betti, ByClass, Class, Complex, Engine, ShapeError, ShapeOptions, Torus, Void, placed_complex,
};
use walpha::{Alpha, AlphaShape, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use oracle::{by_copies, homology};

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

/// A box along the axes, or any other.
trait Periodic {
    fn torus(self) -> Torus;
}

impl Periodic for [f64; 3] {
    fn torus(self) -> Torus {
        Torus::new(self).unwrap()
    }
}

impl Periodic for Torus {
    fn torus(self) -> Torus {
        self
    }
}

fn options(periodic: impl Periodic, squared: f64) -> ShapeOptions {
    let engine = Engine::Native;
    ShapeOptions::new(alpha(squared)).periodic(Some(periodic.torus())).engine(engine)
}

fn shape(
    points: &WeightedPoints,
    periodic: impl Periodic,
    squared: f64,
) -> Result<AlphaShape, ShapeError> {
    alpha_shape(points.clone(), &options(periodic, squared))
}

/// The shape, if no edge of it spans half of the box, so that rows name points alone.
fn in_large_box(points: &WeightedPoints, periodic: Torus, squared: f64) -> Option<AlphaShape> {
    let shape = shape(points, periodic, squared).unwrap();
    shape.copies().is_empty().then_some(shape)
}

/// A box of these sides along the axes, slanted by up to so many units: the box along the axes holds one copy of each point of
/// the torus.
fn boxed([x, y, z]: [f64; 3], most: usize, random: &mut Random) -> Torus {
    let mut shear = || random.below(2 * most + 1) as f64 - most as f64;
    Torus::of_vectors([[x, 0.0, 0.0], [shear(), y, 0.0], [shear(), shear(), z]]).unwrap()
}

fn unweighted(positions: Vec<[f64; 3]>) -> WeightedPoints {
    let weights = vec![0.0; positions.len()];
    WeightedPoints::new(positions, weights).unwrap()
}

/// A lattice in a box with these numbers of cells, with these points in each cell.
fn crystal(cells: [i32; 3], basis: &[[f64; 3]]) -> WeightedPoints {
    let mut positions = Vec::new();
    for x in 0..cells[0] {
        for y in 0..cells[1] {
            for z in 0..cells[2] {
                let at = [x, y, z].map(f64::from);
                positions.extend(basis.iter().map(|b| [0, 1, 2].map(|k| at[k] + b[k])));
            }
        }
    }
    unweighted(positions)
}

const CUBIC: [[f64; 3]; 1] = [[0.0; 3]];
const BCC: [[f64; 3]; 2] = [[0.0; 3], [0.5; 3]];
const FCC: [[f64; 3]; 4] = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];

/// Points of a box: of a lattice or anywhere, weighted or not, each place once.
fn sets(count: u64) -> impl Iterator<Item = (WeightedPoints, Torus)> {
    (0..count).map(|seed| {
        let mut random = Random::new(1000 + seed);
        let sides = [0; 3].map(|_| [4.0, 5.0, 6.0, 8.0][random.below(4)]);
        let size = 1 + random.below([12, 60, 150][seed as usize % 3]);
        let (mut positions, mut weights) = (Vec::new(), Vec::new());
        for _ in 0..size {
            let place = [0, 1, 2].map(|k: usize| match seed % 4 {
                0 | 1 => random.below(sides[k] as usize) as f64,
                2 => random.below(2 * sides[k] as usize) as f64 / 2.0,
                _ => (random.below(1 << 30) as f64) / (1u64 << 30) as f64 * sides[k],
            });
            let weight = match seed % 5 {
                0 | 1 => 0.0,
                2 => random.below(5) as f64 / 4.0 - 0.5,
                _ => random.unit() * 0.7,
            };
            if !positions.contains(&place) {
                positions.push(place);
                weights.push(weight);
            }
        }
        let torus = boxed(sides, if seed % 7 >= 4 { 2 } else { 0 }, &mut random);
        positions.iter_mut().for_each(|place| *place = torus.wrap(*place));
        (WeightedPoints::new(positions, weights).unwrap(), torus)
    })
}

/// Points so dense that the whole triangulation has no long edge: on a lattice, on half of one, anywhere.
fn dense(seed: u64) -> (WeightedPoints, Torus) {
    let mut random = Random::new(seed);
    // In a slanted box, edges span more of it.
    let slanted = seed % 5 >= 3;
    let x = if slanted { 5 } else { 4 };
    let sides = [f64::from(x), 4.0, 5.0];
    let points = crystal([x, 4, 5], [&CUBIC[..], &BCC, &FCC][seed as usize % 3]);
    let (mut positions, mut weights, _) = points.into_parts();
    for (place, weight) in positions.iter_mut().zip(&mut weights) {
        match seed % 4 {
            0 => {}
            1 => *weight = random.below(3) as f64 / 8.0,
            2 => place.iter_mut().for_each(|x| *x += random.unit() / 4.0),
            _ => {
                place.iter_mut().for_each(|x| *x += random.below(2) as f64 / 4.0);
                *weight = random.unit() / 2.0;
            }
        }
    }
    let torus = boxed(sides, usize::from(slanted), &mut random);
    positions.iter_mut().for_each(|place| *place = torus.wrap(*place));
    (WeightedPoints::new(positions, weights).unwrap(), torus)
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let lattice = crystal([2, 4, 4], &CUBIC);
    let reference = options([4.0; 3], 1.0).engine(Engine::Cgal);
    let error = alpha_shape(lattice.clone(), &reference).unwrap_err();
    assert!(matches!(error, ShapeError::Unrepeated), "{error:?}");
    let nan = unweighted(vec![[0.0; 3], [f64::NAN, 0.0, 0.0]]);
    assert!(shape(&nan, [4.0; 3], 1.0).is_err());
    assert!(shape(&unweighted(vec![]), [4.0; 3], 1.0).is_err());
}

#[test]
fn points_beyond_the_box_are_moved_into_it() {
    let points = crystal([4, 4, 4], &CUBIC);
    let inside = shape(&points, [4.0; 3], 0.75).unwrap();
    let (mut positions, ..) = points.into_parts();
    positions.iter_mut().enumerate().for_each(|(i, p)| p[i % 3] += 4.0 * (i % 5) as f64 - 8.0);
    // A point and its copy are duplicates.
    positions.push([-4.0, 8.0, 3.0]);
    let outside = shape(&unweighted(positions), [4.0; 3], 0.75).unwrap();
    assert_eq!(inside.complex(), outside.complex());
    assert_eq!(outside.duplicates(), [[64, 3]]);
    assert_eq!(outside.points().positions()[..64], *inside.points().positions());
}

/// The numbers of simplices of each dimension and class.
fn counts(complex: &Complex) -> [ByClass<usize>; 4] {
    let Complex { cells, facets, edges, vertices } = complex;
    [cells.counts(), facets.counts(), edges.counts(), vertices.counts()]
}

#[test]
fn blocks_agree_with_the_whole() {
    let mut compared = 0;
    for (k, (points, sides)) in sets(60).enumerate() {
        for squared in [0.5, 1.0, 2.25] {
            let Some(one) = in_large_box(&points, sides, squared) else { continue };
            let whole = options(sides, squared).exterior(true);
            let whole = alpha_shape(points.clone(), &whole).unwrap();
            let mut complex = whole.complex().clone();
            complex.retain_shape();
            assert_eq!(counts(one.complex()), counts(&complex), "set {k}, α = {squared}");
            assert_eq!(one.betti(), whole.betti());
            if whole.copies().is_empty() {
                assert!(*one.complex() == complex, "set {k}, α = {squared}");
            }
            for blocks in [2, 3, 5] {
                let blocks = std::num::NonZeroUsize::new(blocks);
                let options = options(sides, squared).blocks(blocks);
                let other = alpha_shape(points.clone(), &options).unwrap();
                assert_eq!(one.complex(), other.complex(), "set {k}, α = {squared}, {blocks:?}");
                assert_eq!((one.betti(), one.sheets()), (other.betti(), other.sheets()));
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn moving_all_points_changes_nothing() {
    for (k, (points, sides)) in sets(60).enumerate() {
        let still = shape(&points, sides, 1.0).unwrap();
        for by in [[1.0, 0.0, 0.0], [0.0, 2.0, 1.0], [-3.0, 7.0, 2.5], [40.0, -40.0, 1.0]] {
            let mut moved = points.clone();
            moved.positions_mut().iter_mut().for_each(|p| (0..3).for_each(|k| p[k] += by[k]));
            let moved = shape(&moved, sides, 1.0).unwrap();
            assert_eq!(counts(still.complex()), counts(moved.complex()), "set {k} by {by:?}");
            assert_eq!(still.betti(), moved.betti());
            // Copies have other numbers.
            if still.copies().is_empty() {
                assert!(still.complex() == moved.complex(), "set {k} by {by:?}");
            }
        }
    }
}

#[test]
fn voids_that_lie_across_the_sides_of_the_box() {
    // A hollow about the corner of the box, another in its middle, and a pore along z.
    let all = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from));
    let near = |p: [f64; 3], q: [f64; 3], r: f64| {
        let away = |k: usize| (p[k] - q[k]).abs().min(10.0 - (p[k] - q[k]).abs());
        (0..3).map(|k| away(k) * away(k)).sum::<f64>() <= r * r
    };
    let keep = |p: &[f64; 3]| {
        !near(*p, [0.0; 3], 1.0) && *p != [5.0; 3] && !near([p[0], p[1], 0.0], [7.0, 2.0, 0.0], 1.0)
    };
    let points = unweighted(all.filter(keep).collect());
    let options = options([10.0; 3], 0.75).exterior(true);
    let shape = alpha_shape(points, &options).unwrap();
    let voids = shape.voids().unwrap();
    let [corner, middle] = voids[..] else { panic!("{voids:?}") };
    assert_eq!((middle.low, middle.high), ([4.0; 3], [6.0; 3]));
    assert_eq!((0..3).map(|k| corner.high[k] - corner.low[k]).collect::<Vec<_>>(), [4.0; 3]);
    assert!((middle.volume - 4.0 / 3.0).abs() < 1e-12 && corner.volume > 8.0, "{voids:?}");
    // Two voids and the pore are three parts of the complement, and the pore goes round once.
    let betti = shape.betti().unwrap();
    assert_eq!((betti.b2, betti.b3), (3 + 2 - 1, Some(0)));
    assert_eq!(<Vec<u64>>::from(betti), homology(&shape));
}

#[test]
fn betti_numbers_are_those_of_homology() {
    let mut seen = std::collections::BTreeSet::new();
    for (k, (points, sides)) in sets(200).enumerate() {
        for squared in [0.25, 0.5, 0.75, 1.0, 1.5, 2.25, 4.0] {
            let Some(shape) = in_large_box(&points, sides, squared) else { continue };
            let Betti { b0, b1, b2, b3 } = shape.betti().unwrap();
            let found = [b0, b1, b2, b3.unwrap()];
            assert_eq!(found, homology(&shape), "set {k}, α = {squared}");
            seen.insert(found);
        }
    }
    assert!(seen.len() > 100 && seen.contains(&[1, 3, 3, 1]), "{}", seen.len());
}

#[test]
fn a_lattice_covers_the_torus() {
    for (basis, full, almost) in
        [(&CUBIC[..], 0.75, 0.5), (&BCC, 0.3125, 0.28125), (&FCC, 0.25, 0.1875)]
    {
        let points = crystal([4, 5, 6], basis);
        let whole = shape(&points, [4.0, 5.0, 6.0], full).unwrap();
        assert_eq!(whole.betti(), Some(Betti { b0: 1, b1: 3, b2: 3, b3: Some(1) }));
        assert_eq!(whole.measures().volume, 120.0);
        assert_eq!((whole.measures().area, whole.complex().euler_characteristic()), (0.0, 0));
        let open = shape(&points, [4.0, 5.0, 6.0], almost).unwrap();
        let Betti { b0, b1, b2, b3 } = open.betti().unwrap();
        assert_eq!([b0, b1, b2, b3.unwrap()], homology(&open));
        assert_eq!(b3, Some(0));
        // The holes of FCC are octahedra, four in each cell, which touch at vertices and edges.
        if basis.len() == 4 {
            assert_eq!(b2, 4 * 120 + 2);
        }
    }
}

/// A component that winds round has no end along that axis.
#[test]
fn boxes_of_rods_and_slabs_span_the_torus() {
    let box_of = |keep: fn(&[f64; 3]) -> bool| {
        let all = (0..480).map(|i| [i % 8, i / 8 % 10, i / 80].map(f64::from));
        let shape = shape(&unweighted(all.filter(keep).collect()), [8.0, 10.0, 6.0], 0.75).unwrap();
        let parts = shape.components();
        assert_eq!(parts.len(), 1);
        (parts[0].low, parts[0].high)
    };
    assert_eq!(box_of(|p| p[1] == 1.0 && p[2] == 5.0), ([0.0, 1.0, 5.0], [8.0, 1.0, 5.0]));
    assert_eq!(box_of(|p| p[1] == 3.0), ([0.0, 3.0, 0.0], [8.0, 3.0, 6.0]));
    assert_eq!(box_of(|_| true), ([0.0; 3], [8.0, 10.0, 6.0]));
    assert_eq!(
        box_of(|p| p[0] < 3.0 && p[2] == 0.0 && p[1] == 4.0),
        ([0.0, 4.0, 0.0], [2.0, 4.0, 0.0])
    );
}

#[test]
fn things_that_go_round() {
    let betti = |positions: Vec<[f64; 3]>, squared| {
        let shape = shape(&unweighted(positions), [8.0; 3], squared).unwrap();
        assert_eq!(<Vec<u64>>::from(shape.betti().unwrap()), homology(&shape));
        let mut rounds: Vec<_> =
            shape.components().iter().map(|part| part.rounds.unwrap()).collect();
        rounds.sort_unstable();
        (homology(&shape), rounds)
    };
    let all = || (0..512).map(|i| [i % 8, i / 8 % 8, i / 64].map(f64::from));
    // A rod, a slab of one layer, three rods across each other, two slabs, and the torus less a ball.
    let rod = all().filter(|p| p[1] == 1.0 && p[2] == 7.0).collect();
    assert_eq!(betti(rod, 0.75), ([1, 1, 0, 0], vec![1]));
    let slab = all().filter(|p| p[2] == 0.0).collect();
    assert_eq!(betti(slab, 0.75), ([1, 2, 1, 0], vec![2]));
    let rods = all().filter(|p| p.iter().filter(|&&x| x == 0.0).count() >= 2).collect();
    assert_eq!(betti(rods, 0.75), ([1, 3, 0, 0], vec![3]));
    let slabs = all().filter(|p| p[0] == 2.0 || p[0] == 5.0 || *p == [0.0; 3]).collect();
    assert_eq!(betti(slabs, 0.75), ([3, 4, 2, 0], vec![0, 2, 2]));
    let hole = all().filter(|p| *p != [0.0, 3.0, 7.0]).collect();
    assert_eq!(betti(hole, 0.75), ([1, 3, 3, 0], vec![3]));
    // A staircase that winds round in all directions together is one loop.
    let stairs = (0..24).map(|i| [(i + 2) / 3, (i + 1) / 3, i / 3].map(f64::from)).collect();
    assert_eq!(betti(stairs, 0.25), ([1, 1, 0, 0], vec![1]));
}

#[test]
fn simplices_are_those_of_copies_in_space() {
    let (mut equal, mut small) = (0, 0);
    for (k, (points, sides)) in sets(48).enumerate() {
        for squared in [0.5, 1.0, 2.25] {
            let expected = by_copies(&points, sides, alpha(squared), false);
            match (shape(&points, sides, squared), expected) {
                (Ok(shape), Some(expected)) => {
                    assert_eq!(*shape.complex(), expected, "set {k}, α = {squared}");
                    equal += 1;
                }
                // An edge spans half of the box.
                (Ok(shape), None) => {
                    assert!(!shape.copies().is_empty());
                    assert_exact(&shape);
                    small += 1;
                }
                (made, expected) => panic!("set {k}, α = {squared}: {made:?}, not {expected:?}"),
            }
        }
    }
    assert!(equal > 50 && small > 10, "{equal} equal, {small} by copies");
}

/// Asserts that the checker finds nothing wrong.
fn assert_exact(shape: &AlphaShape) {
    let (findings, certificate) = placed_complex(shape).findings().unwrap();
    assert!(findings.is_empty(), "{findings:?}");
    assert!(certificate.verdict.is_complete(), "{certificate:?}");
}

/// Few points, down to one, in boxes in which edges join points to their own copies, at all α.
#[test]
fn shapes_of_small_boxes_are_exact() {
    let mut judged = 0;
    for (k, (points, torus)) in sets(24).enumerate() {
        let count = 1 + k % 4;
        let positions = points.positions()[..count].to_vec();
        let points = WeightedPoints::new(positions, points.weights()[..count].to_vec()).unwrap();
        let filtration = Filtration::on(Some(torus), points.clone()).unwrap();
        let curve = filtration.curve();
        assert!(filtration.suggest(&curve).no_void >= filtration.suggest(&curve).one_region);
        for squared in curve.alphas().step_by(1 + curve.len() / 4).chain([f64::INFINITY]) {
            let whole = options(torus, squared).exterior(true);
            let shape = alpha_shape(points.clone(), &whole).unwrap();
            assert!(!shape.copies().is_empty());
            assert_exact(&shape);
            let (part, taken) = (self::shape(&points, torus, squared).unwrap(), &filtration);
            assert_exact(&part);
            assert_eq!(taken.shape(alpha(squared)).betti(), shape.betti());
            assert_eq!((part.betti(), part.measures()), (shape.betti(), shape.measures()));
            let levels = filtration.levels(&[alpha(squared)]);
            assert_same_voids(&shape.voids().unwrap(), &levels.voids()[0]);
            judged += 1;
        }
    }
    assert!(judged > 80, "{judged}");
}

/// A wrong class, a missing cell and a wrong copy in a small box are found.
#[test]
fn wrong_complexes_of_small_boxes_are_found() {
    let points = unweighted(vec![[0.25, 0.5, 0.125], [0.5, 1.5, 0.75]]);
    let torus = Torus::of_vectors([[2.0, 0.0, 0.0], [0.5, 2.0, 0.0], [0.0, 0.75, 2.0]]).unwrap();
    let whole = options(torus, 0.75).exterior(true);
    let shape = alpha_shape(points, &whole).unwrap();
    let right: ComplexFile = {
        let mut bytes = Vec::new();
        walpha::export::Exporter::write(&walpha::export::Json, &shape, &mut bytes).unwrap();
        ComplexFile::read_json(&bytes[..]).unwrap()
    };
    let findings = |file: &ComplexFile| {
        PlacedComplex::try_from(file.clone()).unwrap().findings().unwrap().0.len()
    };
    assert_eq!((findings(&right), right.points.len()), (0, 2));
    let mut wrong = right.clone();
    let classes = wrong.classes.cells.as_mut().unwrap();
    classes[0] = if classes[0] == Class::Interior { Class::Exterior } else { Class::Interior };
    assert!(findings(&wrong) > 0);
    let mut wrong = right.clone();
    wrong.cells.as_mut().unwrap().pop();
    wrong.classes.cells.as_mut().unwrap().pop();
    assert!(findings(&wrong) > 0);
    let mut wrong = right.clone();
    wrong.copies.as_mut().unwrap()[0][1] += 1;
    assert!(findings(&wrong) > 0);
    let refused = |change: &dyn Fn(&mut ComplexFile)| {
        let mut file = right.clone();
        change(&mut file);
        PlacedComplex::try_from(file).unwrap_err().to_string()
    };
    let error = refused(&|file| file.copies.as_mut().unwrap()[0][0] = 2);
    assert!(error.contains("copies"), "{error}");
    let error = refused(&|file| file.copies.as_mut().unwrap()[0][3] = 30_000);
    assert!(error.contains("copies"), "{error}");
    let error = refused(&|file| file.periodic = None);
    assert!(error.contains("periodic"), "{error}");
    let error = refused(&|file| _ = file.copies.as_mut().unwrap().pop());
    assert!(error.contains("names point"), "{error}");
}

#[test]
fn whole_triangulations_are_those_of_copies_in_space() {
    for seed in 0..12 {
        let (points, sides) = dense(seed);
        for squared in [0.2, 0.5, f64::INFINITY] {
            let whole = options(sides, squared).exterior(true);
            let whole = alpha_shape(points.clone(), &whole).unwrap();
            let expected = by_copies(&points, sides, alpha(squared), true).unwrap();
            assert_eq!(*whole.complex(), expected, "set {seed}, α = {squared}");
            let vertices: Vec<u32> = expected.vertices.rows().iter().map(|&[v]| v).collect();
            let hidden: Vec<u32> =
                (0..points.len() as u32).filter(|v| !vertices.contains(v)).collect();
            assert_eq!(whole.hidden(), Some(&hidden[..]));
            assert_eq!(whole.complex().euler_characteristic(), chi(&whole));
        }
    }
}

/// Spheres across the gap are larger than those that a block looks for first.
#[test]
fn a_gap_is_looked_across() {
    let (points, sides) = (crystal([12, 12, 8], &CUBIC), [12.0; 3].torus());
    let all = options(sides, f64::INFINITY);
    let whole = alpha_shape(points.clone(), &options(sides, 1.0).exterior(true)).unwrap();
    assert!(*whole.complex() == by_copies(&points, sides, alpha(1.0), true).unwrap());
    let expected = by_copies(&points, sides, alpha(f64::INFINITY), false).unwrap();
    for blocks in [1, 3, 8] {
        let cut = all.blocks(std::num::NonZeroUsize::new(blocks));
        let shape = alpha_shape(points.clone(), &cut).unwrap();
        assert!(*shape.complex() == expected, "{blocks}");
    }
}

fn chi(shape: &AlphaShape) -> i64 {
    let [b0, b1, b2, b3] = homology(shape).map(|b| b as i64);
    b0 - b1 + b2 - b3
}

#[test]
fn a_laid_out_shape_has_the_sizes_of_the_torus() {
    for seed in 0..6 {
        let (points, torus) = dense(seed);
        let shape = shape(&points, torus, 0.3).unwrap();
        let flat = shape.unwrapped();
        assert_eq!(flat.complex().cells.len(), shape.complex().cells.len());
        assert_eq!(flat.points().len(), shape.points().len() + flat.copies().len());
        let (here, there) = (shape.measures(), flat.measures());
        assert!((here.volume - there.volume).abs() < 1e-9 && (here.area - there.area).abs() < 1e-9);
        let numbers = flat.component_numbers();
        assert_eq!(&numbers[..shape.points().len()], shape.component_numbers());
        for (at, &of) in flat.copies().iter().enumerate() {
            assert_eq!(numbers[shape.points().len() + at], numbers[of as usize]);
        }
        let inside = |&p: &[f64; 3]| {
            let parts = torus.parts(p);
            parts.iter().all(|part| (-1e-12..1.5).contains(part))
        };
        assert!(flat.points().positions().iter().all(inside));
    }
}

#[test]
fn filtrations_hold_all_shapes_of_the_torus() {
    for seed in 0..8 {
        let (points, sides) = dense(seed);
        let filtration = Filtration::on(Some(sides), points.clone()).unwrap();
        let curve = filtration.curve();
        for (k, squared) in curve.alphas().enumerate().step_by(1 + curve.len() / 12) {
            let one = shape(&points, sides, squared).unwrap();
            let taken = filtration.shape(alpha(squared));
            assert_eq!(one.complex(), taken.complex(), "set {seed}, α = {squared}");
            assert_eq!((one.betti(), one.betti()), (taken.betti(), Some(curve.betti[k])));
            assert_eq!(one.measures(), taken.measures());
            let whole = options(sides, squared).exterior(true);
            let whole = alpha_shape(points.clone(), &whole).unwrap();
            let levels = filtration.levels(&[alpha(squared)]);
            assert_same_voids(&whole.voids().unwrap(), &levels.voids()[0]);
        }
        assert_eq!(curve.betti.last(), Some(&Betti { b0: 1, b1: 3, b2: 3, b3: Some(1) }));
        // Voids are what does not wind round: none at the end, though b2 is 3.
        assert_eq!(curve.voids.last(), Some(&0));
        let (k, _) = curve.alphas().enumerate().max_by_key(|&(k, _)| curve.voids[k]).unwrap();
        let levels = filtration.levels(&[alpha(curve.alphas().nth(k).unwrap())]);
        assert_eq!(curve.voids[k], levels.voids()[0].len() as u64);
        let suggested = filtration.suggest(&curve);
        assert!(suggested.no_void >= suggested.one_region);
    }
}

/// Asserts that voids are equal, except for the rounding of their volumes.
fn assert_same_voids(some: &[Void], others: &[Void]) {
    let sorted = |voids: &[Void]| {
        let mut voids = voids.to_vec();
        voids.sort_by(|a, b| a.low.partial_cmp(&b.low).unwrap().then(a.cells.cmp(&b.cells)));
        voids
    };
    let (some, others) = (sorted(some), sorted(others));
    assert_eq!(some.len(), others.len());
    for (a, b) in some.iter().zip(&others) {
        assert!((a.volume - b.volume).abs() < 1e-12);
        let (mut a, mut b) = (*a, *b);
        (a.volume, b.volume) = (0.0, 0.0);
        assert_eq!(a, b);
    }
}

#[test]
fn persistence_pairs_of_a_torus() {
    for seed in 0..8 {
        let (points, sides) = dense(seed);
        let filtration = Filtration::on(Some(sides), points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let (pairs, loops) = (ordered.pairs(), ordered.loops().unwrap());
        let lasting = [&pairs.lasting, &loops.lasting, &pairs.lasting_voids].map(Vec::len);
        assert_eq!(lasting, [1, 3, 3]);
        assert_eq!(pairs.voids.len() + 1, ordered.count(3));
        // Betti numbers count the classes that are born and have not died.
        let rank = |number: u32| ordered.simplex(number).rank;
        for (at, betti) in ordered.betti_curve().iter().enumerate() {
            let there = |&[from, to]: &[u32; 2]| rank(from) <= at as u32 && (at as u32) < rank(to);
            let come = |number: &u32| rank(*number) <= at as u32;
            let b0 = pairs.components.iter().filter(|pair| there(pair)).count()
                + pairs.lasting.iter().filter(|v| come(v)).count();
            let b1 = loops.pairs.iter().filter(|pair| there(pair)).count()
                + loops.lasting.iter().filter(|edge| come(edge)).count();
            let b2 = pairs.voids.iter().filter(|pair| there(pair)).count()
                + pairs.lasting_voids.iter().filter(|facet| come(facet)).count();
            let b3 = pairs.last.iter().filter(|cell| come(cell)).count();
            let expected = [betti.b0, betti.b1, betti.b2, betti.b3.unwrap()];
            assert_eq!([b0, b1, b2, b3].map(|b| b as u64), expected);
        }
        // Faces never come after what they are faces of.
        let values: Vec<u32> = ordered.iter().map(|entry| entry.rank).collect();
        assert!(values.is_sorted());
    }
}
