//! Simplices against those of copies in space, and a torus laid out there.

use walpha::AlphaShape;
use walpha::shape::{Measures, ShapeError};

use super::oracle::{by_copies, homology};
use super::{CUBIC, alpha, alpha_shape, crystal, dense, options, sets, shape};

#[test]
fn simplices_are_those_of_copies_in_space() {
    let (mut equal, mut refused) = (0, 0);
    for (k, (points, sides)) in sets(48).enumerate() {
        for squared in [0.5, 1.0, 2.25] {
            let expected = by_copies(&points, sides, alpha(squared), false);
            match (shape(&points, sides, squared), expected) {
                (Ok(shape), Some(expected)) => {
                    assert_eq!(*shape.complex(), expected, "set {k}, α = {squared}");
                    equal += 1;
                }
                (Err(ShapeError::Wraps { .. }), None) => refused += 1,
                (made, expected) => panic!("set {k}, α = {squared}: {made:?}, not {expected:?}"),
            }
        }
    }
    assert!(equal > 50 && refused > 10, "{equal} equal, {refused} refused");
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
    let (points, sides) = (crystal([12, 12, 8], &CUBIC), [12.0; 3]);
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
        let (points, sides) = dense(seed);
        let shape = shape(&points, sides, 0.3).unwrap();
        let flat = shape.unwrapped();
        assert_eq!(flat.complex().cells.len(), shape.complex().cells.len());
        assert_eq!(flat.points().len(), shape.points().len() + flat.copies().len());
        let [here, there] = [&shape, &flat]
            .map(|s| Measures::of(s.complex(), &s.points().positions, s.options().periodic));
        assert!((here.volume - there.volume).abs() < 1e-9 && (here.area - there.area).abs() < 1e-9);
        let numbers = flat.component_numbers();
        assert_eq!(&numbers[..shape.points().len()], shape.component_numbers());
        for (at, &of) in flat.copies().iter().enumerate() {
            assert_eq!(numbers[shape.points().len() + at], numbers[of as usize]);
        }
        let inside = |p: &[f64; 3]| (0..3).all(|k| p[k] >= 0.0 && p[k] < 1.5 * sides[k]);
        assert!(flat.points().positions.iter().all(inside));
    }
}
