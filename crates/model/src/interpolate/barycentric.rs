//! Barycentric coordinates of a position in a simplex. Whether the position is in the simplex is decided exactly: in doubles if
//! these are exact, behind an error bound, or in big integers.

use std::cmp::Ordering;

use dashu_int::IBig;
use walpha_regular::internals::number::{Number, cross, dot, integer, lowest_bit};

/// The coordinates of a position in a simplex of one to four corners, or `None` if it is outside; the boundary is inside. Four
/// corners must be positively oriented: det(b−a, c−a, d−a) > 0. Coordinates beyond the number of corners are 0.
///
/// With `exact`, no operation on these doubles rounds ([`Lattice`](Lattice)), and the coordinates are the doubles nearest to the
/// true ones. Otherwise they are off by at most [`TOLERANCE`], and zeros and ones are still correct.
pub(super) fn coordinates(corners: &[[f64; 3]], place: [f64; 3], exact: bool) -> Option<[f64; 4]> {
    if !in_box(corners, place) {
        return None;
    }
    match *corners {
        [a, b, c, d] => {
            let offsets = [a, b, c, d].map(|p| minus(p, place));
            if exact {
                return of_offsets(&offsets);
            }
            match filtered(&offsets) {
                Filtered::Outside => None,
                Filtered::Inside(coordinates) => Some(coordinates),
                Filtered::Close => of_offsets(&integer_offsets(corners, place)),
            }
        }
        // Thin simplices are rare.
        _ => of_offsets(&integer_offsets(corners, place)),
    }
}

/// Computes the coordinates of many positions in one cell, if no operation on any of them rounds. Each part is a plane, whose
/// normal and offset are exact, too. The results have the same bits as those of [`coordinates`].
pub(super) struct Planes {
    normals: [[f64; 3]; 4],
    offsets: [f64; 4],
    whole: f64,
}

impl Planes {
    /// The planes of positively oriented corners; `None` if they span no volume.
    pub(super) fn of([a, b, c, d]: [[f64; 3]; 4]) -> Option<Self> {
        let normal = |p, q, r| cross(&minus(q, p), &minus(r, p));
        let inward = |n: [f64; 3]| n.map(|x| -x);
        // The volume with the position in place of a corner, with the same orientation.
        let normals =
            [inward(normal(b, c, d)), normal(a, c, d), inward(normal(a, b, d)), normal(a, b, c)];
        let offsets = [b, a, a, a];
        let offsets = [0, 1, 2, 3].map(|k| -dot(&normals[k], &offsets[k]));
        let whole = dot(&normals[3], &d) + offsets[3];
        (whole > 0.0).then_some(Self { normals, offsets, whole })
    }

    /// The coordinates of a position in the cell, or `None` if it is outside.
    #[inline(always)]
    pub(super) fn shares(&self, place: [f64; 3]) -> Option<[f64; 4]> {
        let part = |k: usize| dot(&self.normals[k], &place) + self.offsets[k];
        let parts = [part(0), part(1), part(2), part(3)];
        let outside = parts.iter().any(|&part| part < 0.0);
        (!outside).then(|| parts.map(|part| part / self.whole))
    }
}

/// The largest error of a coordinate if doubles round: 2⁻⁴³ ≈ 1.1e-13.
const TOLERANCE: f64 = f64::from_bits((1023 - 43) << 52);

fn in_box(corners: &[[f64; 3]], place: [f64; 3]) -> bool {
    (0..3).all(|k| {
        let (mut below, mut above) = (false, false);
        for corner in corners {
            below |= corner[k] <= place[k];
            above |= corner[k] >= place[k];
        }
        below && above
    })
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Computes coordinates from the offsets of the corners from the position. Each coordinate is the share of the whole volume that
/// the simplex with the position in place of that corner has.
fn of_offsets<T: Scalar>(offsets: &[[T; 3]]) -> Option<[f64; 4]> {
    let negative = |x: &T| T::zero().minus(x);
    match offsets {
        [a, b, c, d] => {
            let (ab, cd) = (cross(a, b), cross(c, d));
            shares([dot(b, &cd), negative(&dot(a, &cd)), dot(d, &ab), negative(&dot(c, &ab))])
        }
        [a, b, c] => {
            let parts = [cross(b, c), cross(c, a), cross(a, b)];
            if dot(a, &parts[0]).sign().is_ne() {
                return None;
            }
            // The triangle is projected along an axis in which it does not vanish.
            along_an_axis(parts)
        }
        [a, b] => {
            if cross(a, b).iter().any(|component| component.sign().is_ne()) {
                return None;
            }
            along_an_axis([b.clone(), a.each_ref().map(negative)])
        }
        [a] => a.iter().all(|component| component.sign().is_eq()).then_some([1.0, 0.0, 0.0, 0.0]),
        _ => None,
    }
}

/// The shares in the first component in which the parts do not sum to 0.
fn along_an_axis<T: Scalar, const N: usize>(parts: [[T; 3]; N]) -> Option<[f64; 4]> {
    let whole = |k: usize| parts.iter().fold(T::zero(), |sum, part| sum.plus(&part[k]));
    let (k, sign) = (0..3).map(|k| (k, whole(k).sign())).find(|(_, sign)| sign.is_ne())?;
    shares(parts.map(|part| if sign.is_gt() { part[k].clone() } else { T::zero().minus(&part[k]) }))
}

/// The parts divided by their sum; `None` if one is negative.
fn shares<T: Scalar, const N: usize>(parts: [T; N]) -> Option<[f64; 4]> {
    if parts.iter().any(|part| part.sign() == Ordering::Less) {
        return None;
    }
    let whole = parts.iter().fold(T::zero(), |sum, part| sum.plus(part));
    if whole.sign().is_eq() {
        return None;
    }
    let mut shares = [0.0; 4];
    for (share, part) in shares.iter_mut().zip(&parts) {
        *share = part.over(&whole);
    }
    Some(shares)
}

/// The result of doubles with an error bound.
enum Filtered {
    Outside,
    Inside([f64; 4]),
    /// The position is on or near the boundary, or the simplex is too flat for doubles.
    Close,
}

fn filtered([a, b, c, d]: &[[f64; 3]; 4]) -> Filtered {
    // Each part is a sum of six products of three rounded differences, with eight successive roundings.
    const ROUNDINGS: f64 = 10.0 * f64::EPSILON / 2.0;
    let (ab, cd) = (cross(a, b), cross(c, d));
    let parts = [dot(b, &cd), -dot(a, &cd), dot(d, &ab), -dot(c, &ab)];
    let [pa, pb, pc, pd] = [a, b, c, d].map(|p| p.map(f64::abs));
    let (ab, cd) = (magnitudes(&pa, &pb), magnitudes(&pc, &pd));
    let bounds = [dot(&pb, &cd), dot(&pa, &cd), dot(&pd, &ab), dot(&pc, &ab)]
        .map(|magnitude| magnitude * ROUNDINGS + f64::MIN_POSITIVE);
    if parts.iter().zip(&bounds).any(|(part, bound)| -part > *bound) {
        return Filtered::Outside;
    }
    let whole: f64 = parts.iter().sum();
    let error: f64 = bounds.iter().sum();
    let certain = parts.iter().zip(&bounds).all(|(part, bound)| part > bound);
    if certain && error <= whole * (TOLERANCE / 4.0) && whole.is_finite() {
        Filtered::Inside(parts.map(|part| part / whole))
    } else {
        Filtered::Close
    }
}

/// The cross product with sums in place of differences, for vectors without negative components.
fn magnitudes(u: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
    let sum = |i: usize, j: usize| u[i] * v[j] + u[j] * v[i];
    [sum(1, 2), sum(2, 0), sum(0, 1)]
}

/// A number type for barycentric coordinates. Doubles are exact only if a [`BitRange`](walpha_regular::internals::BitRange)
/// guarantees that no operation rounds.
pub(super) trait Scalar: Number + Clone {
    fn zero() -> Self;
    fn sign(&self) -> Ordering;
    /// The share of a positive whole, from 0 to 1, as the double nearest to it or next to that.
    fn over(&self, whole: &Self) -> f64;
}

impl Scalar for f64 {
    fn zero() -> Self {
        0.0
    }
    fn sign(&self) -> Ordering {
        self.partial_cmp(&0.0).expect("products of bounded numbers")
    }
    fn over(&self, whole: &Self) -> f64 {
        self / whole
    }
}

impl Scalar for IBig {
    fn zero() -> Self {
        Self::ZERO
    }
    fn sign(&self) -> Ordering {
        self.cmp(&Self::ZERO)
    }
    fn over(&self, whole: &Self) -> f64 {
        const BITS: usize = 64;
        let share = (self << BITS) / whole;
        u128::try_from(share).expect("at most the whole") as f64 / 2f64.powi(BITS as i32)
    }
}

/// The differences of positions from another, in a unit in which all of them are integers.
pub(super) fn integer_offsets(corners: &[[f64; 3]], from: [f64; 3]) -> Vec<[IBig; 3]> {
    let numbers = corners.iter().chain([&from]).flatten().copied();
    let unit = numbers.filter_map(lowest_bit).min().unwrap_or(0);
    let origin = from.map(|x| integer(x, unit));
    let offset = |corner: &[f64; 3]| {
        let [x, y, z] = corner.map(|x| integer(x, unit));
        [x - &origin[0], y - &origin[1], z - &origin[2]]
    };
    corners.iter().map(offset).collect()
}

#[cfg(test)]
mod tests {
    use walpha_regular::internals::BitRange;

    use super::*;

    const CELL: [[f64; 3]; 4] = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];

    #[test]
    fn ways_agree_on_a_lattice() {
        let mut inside = 0;
        for i in 0..6 * 6 * 6 {
            let place = [i % 6, i / 6 % 6, i / 36].map(|k| f64::from(k) - 0.5);
            assert!(BitRange::of(&CELL).is_exact_with(place));
            let quick = coordinates(&CELL, place, true);
            assert_eq!(quick, coordinates(&CELL, place, false), "{place:?}");
            let [x, y, z] = place;
            assert_eq!(quick.is_some(), x >= 0.0 && y >= 0.0 && z >= 0.0 && x + y + z <= 4.0);
            if let Some(shares) = quick {
                assert_eq!(shares, [4.0 - x - y - z, x, y, z].map(|v| v / 4.0));
                inside += 1;
            }
        }
        assert_eq!(inside, 10);
    }

    #[test]
    fn planes_give_the_same_bits() {
        let cells = [
            [[1.0, 0.0, 7.0], [5.0, 1.0, 0.0], [0.0, 6.0, 2.0], [3.0, 7.0, 7.0]],
            [[0.0; 3], [0.0, 7.0, 0.0], [7.0, 0.0, 0.0], [3.0, 3.0, -5.0]],
        ];
        let mut inside = 0;
        for cell in cells {
            let planes = Planes::of(cell).expect("a volume");
            for i in 0..8 * 8 * 13 {
                let place = [f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64) - 5.0];
                let slow = coordinates(&cell, place, true);
                assert_eq!(planes.shares(place), slow, "{place:?}");
                inside += usize::from(slow.is_some());
            }
        }
        assert!(inside > 60, "{inside}");
        let [a, b, c, _] = cells[0];
        assert!(Planes::of([a, b, c, a]).is_none());
    }

    #[test]
    fn one_ulp_decides() {
        let third: f64 = 4.0 / 3.0;
        // This position is on the slanted face, rounded to one of its sides.
        let place: [f64; 3] = [third, third, 4.0 - 2.0 * third];
        let sum_is_at_most_four = |p: [f64; 3]| {
            let rows = integer_offsets(&[p, [4.0, 0.0, 0.0]], [0.0; 3]);
            &rows[0][0] + &rows[0][1] + &rows[0][2] <= rows[1][0]
        };
        for step in -2..=2i64 {
            let z = f64::from_bits((place[2].to_bits() as i64 + step) as u64);
            let place = [place[0], place[1], z];
            let inside = coordinates(&CELL, place, false).is_some();
            assert_eq!(inside, sum_is_at_most_four(place), "{step}");
        }
        assert!(coordinates(&CELL, [1.0f64.next_down(), 1.0, 2.0], false).is_some());
        assert!(coordinates(&CELL, [1.0f64.next_up(), 1.0, 2.0], false).is_none());
    }

    #[test]
    fn thin_simplices_hold_what_is_exactly_on_them() {
        let triangle = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
        let on = |place| coordinates(&triangle, place, false);
        assert_eq!(on([1.0, 1.0, 1.0]), Some([0.5, 0.25, 0.25, 0.0]));
        assert_eq!(on([1.0, 1.0, 1.0f64.next_up()]), None);
        assert_eq!(on([3.0, 3.0, 1.0]), None);
        let edge = [[4.0, 2.0, 0.0], [0.0, 0.0, 0.0]];
        let on = |place| coordinates(&edge, place, false);
        assert_eq!(on([1.0, 0.5, 0.0]), Some([0.25, 0.75, 0.0, 0.0]));
        assert_eq!(on([1.0, 0.5, 1e-300]), None);
        assert_eq!(coordinates(&edge[..1], edge[0], false), Some([1.0, 0.0, 0.0, 0.0]));
        assert_eq!(coordinates(&edge[..1], [4.0, 2.0, 1.0], false), None);
    }

    #[test]
    fn slivers_have_coordinates() {
        // Six times the volume is 1e-40, far below the resolution of doubles beside the corners.
        let corners =
            [[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.5, 1.5, 1.0f64.next_up()]];
        let centre = [1.25, 1.25, 1.0];
        assert_eq!(coordinates(&corners, centre, false), Some([0.5, 0.25, 0.25, 0.0]));
        for corner in 0..4 {
            let mut unit = [0.0; 4];
            unit[corner] = 1.0;
            assert_eq!(coordinates(&corners, corners[corner], false), Some(unit));
        }
    }

    #[test]
    fn integers_are_what_doubles_are() {
        let offsets = integer_offsets(&[[3.5, -1.0, 0.0], [0.25, 8.0, -0.0]], [0.5, 0.0, 1.0]);
        let expected = [[12, -4, -4], [-1, 32, -4]].map(|row| row.map(IBig::from));
        assert_eq!(offsets, expected);
    }
}
