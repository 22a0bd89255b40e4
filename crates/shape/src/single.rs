//! Coordinates in single precision, which some formats use and in which all pages draw.

use walpha_base::parallel::prelude::*;
use walpha_base::shown::{number, rounded};

use super::Surface;

/// The conversion of coordinates to single precision. Far from the origin rounding moves them, and vertices may even coincide; an
/// offset that is subtracted first keeps them apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SinglePrecision {
    /// The offset that is subtracted along x, y and z: a multiple of the largest power of ten that suffices. 0 along axes that
    /// need no offset.
    pub offset: [f64; 3],
    /// The largest error of a coordinate after that, in the unit of the coordinates.
    pub error: f64,
    /// The number of different places that become equal to others with this offset.
    pub merged: usize,
    /// Whether a mesh changes with this offset: the error is more than a thousandth of its shortest edge, or different vertices
    /// have become one.
    pub is_lossy: bool,
}

/// The share of the shortest edge by which rounding may move a coordinate.
const TOLERATED: f64 = 1e-3;
/// The largest relative error of rounding to single precision, 2⁻²⁴.
const HALF_STEP: f64 = f32::EPSILON as f64 / 2.0;

impl SinglePrecision {
    /// Chooses the conversion of a surface to single precision, from the positions of the input. O(n log n) if coordinates are
    /// not in single precision already, otherwise O(n).
    pub fn of_surface(surface: &Surface, of_input: &[[f64; 3]]) -> Self {
        let places: Vec<[f64; 3]> = surface.positions(of_input).collect();
        Self::of(&places, surface.sides())
    }

    /// The conversion of a surface with an offset that is given.
    pub fn with_offset(offset: [f64; 3], surface: &Surface, of_input: &[[f64; 3]]) -> Self {
        let places: Vec<[f64; 3]> = surface.positions(of_input).collect();
        let found = Self { offset, ..Self::default() }.measured(&places);
        let merged = found.merges(&places);
        let is_lossy = merged > 0 || found.error > tolerated(&places, surface.sides());
        Self { merged, is_lossy, ..found }
    }

    /// Chooses the conversion of positions, and of edges between them.
    pub fn of(places: &[[f64; 3]], edges: impl Iterator<Item = [u32; 2]>) -> Self {
        let exact = Self::default();
        if exact.errors(places) == [0.0; 3] {
            return exact;
        }
        let tolerated = tolerated(places, edges);
        let suffices = |found: &Self| found.error <= tolerated && found.merges(places) == 0;
        let plain = exact.measured(places);
        if suffices(&plain) {
            return plain;
        }
        let [low, high] = bounds(places);
        let around = |tolerated: f64| {
            let errors = exact.errors(places);
            let of_axis = |axis: usize| {
                if errors[axis] <= tolerated {
                    0.0
                } else {
                    offset(low[axis], high[axis], tolerated)
                }
            };
            let shifted = Self { offset: [0, 1, 2].map(of_axis), ..exact };
            // Leaves an axis unchanged if the offset gains nothing there.
            let gains = shifted.errors(places);
            let kept =
                |axis: usize| if gains[axis] < errors[axis] { shifted.offset[axis] } else { 0.0 };
            Self { offset: [0, 1, 2].map(kept), ..exact }.measured(places)
        };
        // If vertices that no edge joins are nearer to each other than any edge is long, the error is made as small as possible.
        let found = [tolerated, 0.0].map(around);
        let best = found.into_iter().find(suffices);
        best.unwrap_or_else(|| {
            let merged = found[1].merges(places);
            Self { merged, is_lossy: true, ..found[1] }
        })
    }

    /// A place in single precision.
    pub fn round(&self, place: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|axis| (place[axis] - self.offset[axis]) as f32)
    }

    /// Whether all coordinates are in the range of single precision, up to 3.4·10³⁸.
    pub fn is_in_range(&self) -> bool {
        self.error.is_finite()
    }

    /// Whether an offset is subtracted.
    pub fn has_offset(&self) -> bool {
        self.offset != [0.0; 3]
    }

    /// The remark that a user of the mesh needs, if any.
    pub fn remark(&self) -> Option<String> {
        let [x, y, z] = self.offset.map(number);
        let merged = match self.merged {
            0 => String::new(),
            1 => " and lets 1 vertex fall onto another".to_owned(),
            merged => format!(" and lets {merged} vertices fall onto others"),
        };
        let error = rounded(self.error);
        match (self.has_offset(), self.is_lossy) {
            // There is no such file.
            _ if !self.is_in_range() => None,
            (false, false) => None,
            (true, false) => Some(format!(
                "programs read its coordinates in single precision, which does not tell these places apart: {x}, {y}, {z} is \
                 subtracted from x, y, z"
            )),
            (true, true) => Some(format!(
                "programs read its coordinates in single precision: {x}, {y}, {z} is subtracted from x, y, z, and even so they are \
                 rounded by up to {error}, which changes the mesh{merged}; other formats hold doubles"
            )),
            (false, true) => Some(format!(
                "programs read its coordinates in single precision, rounded by up to {error}, which changes the mesh{merged}; other formats \
                 hold doubles"
            )),
        }
    }

    /// Returns this conversion with the error that it makes.
    fn measured(self, places: &[[f64; 3]]) -> Self {
        Self { error: self.errors(places).into_iter().fold(0.0, f64::max), ..self }
    }

    /// The largest error along each axis; infinite beyond the range of single precision.
    fn errors(&self, places: &[[f64; 3]]) -> [f64; 3] {
        let error = |place: &[f64; 3]| {
            let rounded = self.round(*place).map(f64::from);
            [0, 1, 2].map(|axis| match rounded[axis] {
                rounded if rounded.is_finite() => (place[axis] - self.offset[axis] - rounded).abs(),
                _ => f64::INFINITY,
            })
        };
        let larger = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| a[axis].max(b[axis]));
        places.par_iter().map(error).reduce(|| [0.0; 3], larger)
    }

    /// The number of different positions that become equal to others.
    fn merges(&self, places: &[[f64; 3]]) -> usize {
        // Adding 0 turns −0 into 0.
        let rounded = distinct(places, |place| self.round(place).map(|x| (x + 0.0).to_bits()));
        if rounded == places.len() {
            return 0;
        }
        distinct(places, |place| place.map(|x| (x + 0.0).to_bits())) - rounded
    }
}

/// The largest error of a coordinate that leaves a mesh with these edges as it is.
fn tolerated(places: &[[f64; 3]], edges: impl Iterator<Item = [u32; 2]>) -> f64 {
    let shortest = edges.map(|edge| length(edge.map(|v| places[v as usize])));
    TOLERATED * shortest.fold(f64::INFINITY, f64::min)
}

/// Number of different keys.
fn distinct<K: Ord + Send>(places: &[[f64; 3]], key: impl Fn([f64; 3]) -> K + Sync) -> usize {
    let mut keys: Vec<K> = places.par_iter().map(|&place| key(place)).collect();
    keys.par_sort_unstable();
    keys.dedup();
    keys.len()
}

/// The corners of the box of places.
fn bounds(places: &[[f64; 3]]) -> [[f64; 3]; 2] {
    places.iter().fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], place| {
        [[0, 1, 2].map(|k| low[k].min(place[k])), [0, 1, 2].map(|k| high[k].max(place[k]))]
    })
}

fn length([a, b]: [[f64; 3]; 2]) -> f64 {
    [0, 1, 2].map(|axis| a[axis] - b[axis]).into_iter().fold(0.0, f64::hypot)
}

/// The roundest number that leaves at most the tolerated error after it is subtracted from numbers between two bounds; otherwise
/// a number near their middle.
fn offset(low: f64, high: f64, tolerated: f64) -> f64 {
    let (middle, half) = (f64::midpoint(low, high), high / 2.0 - low / 2.0);
    let first = middle.abs().log10().floor();
    // An offset does not help numbers that are smaller than all numbers of single precision.
    if first < -45.0 {
        return 0.0;
    }
    let mut power = first as i32;
    loop {
        let step = 10f64.powi(power.abs());
        let multiple =
            if power < 0 { (middle * step).round() / step } else { (middle / step).round() * step };
        let suffices = HALF_STEP * f64::max(high - multiple, multiple - low) <= tolerated;
        // No number beyond the digits of a double is rounder.
        let ends = 10f64.powi(power) <= half || f64::from(power) < first - 17.0;
        if suffices || ends {
            return multiple;
        }
        power -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square grid of points 5 cm apart, as far from the origin as in UTM coordinates.
    fn roof(at: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 2]>) {
        let place =
            |i: u32| [at[0] + 0.05 * f64::from(i % 20), at[1] + 0.05 * f64::from(i / 20), at[2]];
        let rows = (0..400).filter(|i| i % 20 < 19).map(|i| [i, i + 1]);
        ((0..400).map(place).collect(), rows.collect())
    }

    fn single(places: &[[f64; 3]], edges: &[[u32; 2]]) -> SinglePrecision {
        SinglePrecision::of(places, edges.iter().copied())
    }

    #[test]
    fn a_round_number_is_subtracted_where_rounding_moves_coordinates() {
        let (places, edges) = roof([434_123.4, 5_412_345.6, 412.0]);
        let found = single(&places, &edges);
        assert_eq!(found.offset, [434_000.0, 5_412_000.0, 0.0]);
        assert!(!found.is_lossy && found.error <= 5e-5, "{found:?}");
        let rounded: Vec<[f32; 3]> = places.iter().map(|&place| found.round(place)).collect();
        for (place, rounded) in places.iter().zip(&rounded) {
            for axis in 0..3 {
                let back = found.offset[axis] + f64::from(rounded[axis]);
                assert!((back - place[axis]).abs() <= found.error + 1e-9);
            }
        }
        let told = found.remark().unwrap();
        assert!(told.contains("434000, 5412000, 0 is subtracted"), "{told}");
    }

    #[test]
    fn what_single_precision_holds_stays() {
        let (places, edges) = roof([0.0; 3]);
        let near = single(&places, &edges);
        assert!(!near.has_offset() && near.error > 0.0 && near.remark().is_none());
        // Whole numbers below 2²⁴, anywhere.
        let whole: Vec<[f64; 3]> =
            (0..9).map(|i| [16_000_000.0 + f64::from(i), 0.0, -1.0]).collect();
        assert_eq!(single(&whole, &[[0, 1]]), SinglePrecision::default());
        assert_eq!(single(&[], &[]), SinglePrecision::default());
    }

    /// Vertices that no edge joins may be nearer to each other than any edge is long.
    #[test]
    fn places_that_differ_stay_different() {
        let places = [[1000.0, 0.0, 0.0], [1000.0 + 1e-5, 0.0, 0.0], [2000.0, 0.0, 0.0]];
        let far = [
            [1e6, 0.0, 0.0],
            [1e6 + 1e-3, 0.0, 0.0],
            [1e6 + 1.0, 0.0, 0.0],
            [1e6 + 900.0, 0.0, 0.0],
        ];
        let found = single(&far, &[[0, 3]]);
        assert!(found.has_offset() && !found.is_lossy, "{found:?}");
        // No offset suffices for points that are far apart and fine.
        let lossy = single(&places, &[[0, 2]]);
        assert!(
            lossy.is_lossy && lossy.remark().unwrap().contains("changes the mesh"),
            "{lossy:?}"
        );
        assert_eq!(lossy.merged, 1);
        assert!(lossy.remark().unwrap().contains("lets 1 vertex fall onto another"));
    }

    #[test]
    fn numbers_of_any_size_are_measured() {
        for scale in [1e-320, 1e-300, 1e-40, 1e30, 1e300] {
            let places: Vec<[f64; 3]> =
                (0..4).map(|i| [scale * f64::from(i), scale, -scale]).collect();
            let found = single(&places, &[[0, 1], [1, 2]]);
            assert!(found.offset.iter().all(|x| x.is_finite()), "{scale}: {found:?}");
        }
        let huge = single(&[[1e300, 0.0, 0.0], [1e300, 1.0, 0.0]], &[[0, 1]]);
        assert_eq!((huge.offset, huge.is_lossy), ([1e300, 0.0, 0.0], false));
    }
}
