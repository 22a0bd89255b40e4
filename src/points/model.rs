use std::fmt;

use walpha_base::setters;
use walpha_complex::Alpha;

use super::Units;
use crate::volume::{Coordinates, Dims, Frame, GrayRange};

/// The grid that points are samples of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleGrid {
    /// Samples along the axes.
    pub dims: Dims,
    /// Where they lie in the world.
    pub frame: Frame,
    /// What coordinates of points are measured in.
    pub units: Units,
}

/// A cell in which points repeat, as crystals do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its edges, in the unit of the points.
    pub vectors: [[f64; 3]; 3],
    /// Along which of these points repeat.
    pub repeats: [bool; 3],
}

impl Cell {
    /// Its sides, where it is a box along the axes that repeats along all of them: then points are those of
    /// a torus.
    pub fn sides(&self) -> Option<[f64; 3]> {
        let [[x, a, b], [c, y, d], [e, f, z]] = self.vectors;
        let is_box = [a, b, c, d, e, f] == [0.0; 6] && [x, y, z].iter().all(|&side| side > 0.0);
        (is_box && self.repeats == [true; 3]).then_some([x, y, z])
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |numbers: [f64; 3]| numbers.map(|x| x.to_string()).join(",");
        match self.sides() {
            Some(sides) => {
                write!(f, "a box of sides {0}, and `periodic` {0} makes its torus", list(sides))
            }
            None if self.repeats == [true; 3] => {
                let [a, b, c] = self.vectors.map(list);
                write!(
                    f,
                    "the vectors ({a}), ({b}), ({c}), which are no box along the axes: it is not supported"
                )
            }
            None => {
                f.write_str("points repeat along some of its vectors only: it is not supported")
            }
        }
    }
}

/// What is known of weighted points besides themselves. A `.wvm` keeps it but for the cell, which extended
/// XYZ states; other formats of points keep nothing.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ModelMetadata {
    /// The grid that they are samples of.
    pub grid: Option<SampleGrid>,
    /// What coordinates mean.
    pub coordinates: Coordinates,
    /// The α that their shape is meant to be made at, and weights in proportion to.
    pub alpha: Option<Alpha>,
    /// The values that were gray 0 and 255.
    pub range: Option<GrayRange>,
    /// The [`Recipe`](crate::Recipe) that made them, as JSON ([`Recipe::to_json`](crate::Recipe::to_json)).
    pub recipe: Option<String>,
    /// All points by their indices, the most important first.
    pub order: Option<Vec<u32>>,
    /// The cell in which they repeat.
    pub cell: Option<Cell>,
}

/// How a `.wvm` is packed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Packing {
    /// The largest error of a value, in units of the values. The values of F then are off by as much at
    /// most, everywhere. 0 keeps every value bit for bit.
    pub value_error: f64,
    /// Layers of points, the most important first; a reader may stop behind any, and has a quarter of the
    /// points without the last, a quarter of these without the last two. One layer makes the smallest file.
    pub layers: u8,
}

impl ModelMetadata {
    setters! {
        grid: Option<SampleGrid>,
        coordinates: Coordinates,
        alpha: Option<Alpha>,
        range: Option<GrayRange>,
        recipe: Option<String>,
        order: Option<Vec<u32>>,
        cell: Option<Cell>,
    }
}

impl Default for Packing {
    fn default() -> Self {
        Self { value_error: 0.0, layers: 1 }
    }
}

impl Packing {
    /// Layers at most.
    pub const MOST_LAYERS: u8 = 8;

    setters! { value_error: f64, layers: u8 }
}

impl SampleGrid {
    /// The position of a sample, by its indices (x, y, z).
    pub fn position(&self, sample: [u32; 3]) -> [f64; 3] {
        let index = sample.map(f64::from);
        match self.units {
            Units::Voxel => index,
            Units::World => self.frame.to_world(index),
        }
    }

    /// The sample exactly at a position.
    pub fn sample_at(&self, position: [f64; 3]) -> Option<[u32; 3]> {
        let index = match self.units {
            Units::Voxel => position,
            Units::World => self.frame.to_index(position),
        };
        let dims = self.dims.xyz();
        let mut sample = [0; 3];
        for k in 0..3 {
            let nearest = index[k].round();
            if !(nearest >= 0.0 && nearest < dims[k] as f64) {
                return None;
            }
            sample[k] = nearest as u32;
        }
        (self.position(sample) == position).then_some(sample)
    }

    /// The grid in voxels that reaches from 0 to the last of some positions, all of them whole numbers
    /// from 0 up.
    #[cfg(feature = "formats")]
    pub(super) fn spanned(positions: &[[f64; 3]], coordinates: Coordinates) -> Option<Self> {
        let mut end = [0u64; 3];
        for position in positions {
            for k in 0..3 {
                let x = position[k];
                if x.fract() != 0.0 || !(0.0..4e9).contains(&x) {
                    return None;
                }
                end[k] = end[k].max(x as u64 + 1);
            }
        }
        let dims = Dims::new(end[0], end[1], end[2]).ok()?;
        Some(Self { dims, frame: Frame::VOXEL.with_coordinates(coordinates), units: Units::Voxel })
    }
}

/// How a `.wvm` begins. As with PNG, a transfer that changes the ends of lines damages it.
pub(super) const MODEL: &[u8] = b"\x89wvm\r\n\x1a\n";
