use std::fmt;

use walpha_base::setters;
use walpha_base::shown::rounded;
use walpha_complex::Alpha;

use super::{ColumnSummary, Crs, LasHeader, ScanSummary, Units};
use walpha_volume::{Coordinates, Dims, Frame, GrayRange};

/// The grid that points are samples of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleGrid {
    /// The number of samples along each axis.
    pub dims: Dims,
    /// The position of the samples in the world.
    pub frame: Frame,
    /// The units of the coordinates of points.
    pub units: Units,
}

/// A unit cell that repeats, as in crystals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The edge vectors, in the unit of the points.
    pub vectors: [[f64; 3]; 3],
    /// Whether the points repeat along each of these vectors.
    pub repeats: [bool; 3],
}

impl Cell {
    /// The cell of three vectors of these lengths that repeats along all of them, by its angles in degrees: α between b and c, β between a
    /// and c, γ between a and b. The first vector is along x, and the second in the plane of x and y. `None` if no three
    /// vectors have these angles.
    pub fn of_angles([a, b, c]: [f64; 3], angles: [f64; 3]) -> Option<Self> {
        // Right angles are exact, so that boxes are along the axes.
        let cosine = |angle: f64| if angle == 90.0 { 0.0 } else { angle.to_radians().cos() };
        let [alpha, beta, gamma] = angles.map(cosine);
        let sine = if gamma == 0.0 { 1.0 } else { (1.0 - gamma * gamma).sqrt() };
        let y = (alpha - beta * gamma) / sine;
        let z = (1.0 - beta * beta - y * y).sqrt();
        let vectors = [[a, 0.0, 0.0], [b * gamma, b * sine, 0.0], [c * beta, c * y, c * z]];
        let is_finite = vectors.as_flattened().iter().all(|x| x.is_finite());
        let is_angle = |angle: &f64| *angle > 0.0 && *angle < 180.0;
        let exists = angles.iter().all(is_angle) && sine > 0.0 && z > 0.0;
        (is_finite && exists).then_some(Self { vectors, repeats: [true; 3] })
    }

    /// The sum of the vectors, each times its part.
    pub(crate) fn place(&self, parts: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| (0..3).map(|k| parts[k] * self.vectors[k][axis]).sum())
    }

    /// The sides, if the cell is an axis-aligned box that repeats along all axes: the points then lie on a torus.
    pub fn sides(&self) -> Option<[f64; 3]> {
        self.lengths().filter(|_| self.repeats == [true; 3])
    }

    /// The sides, if the cell is an axis-aligned box.
    fn lengths(&self) -> Option<[f64; 3]> {
        let [[x, a, b], [c, y, d], [e, f, z]] = self.vectors;
        let is_box = [a, b, c, d, e, f] == [0.0; 6] && [x, y, z].iter().all(|&side| side > 0.0);
        is_box.then_some([x, y, z])
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |numbers: [f64; 3]| numbers.map(rounded).join(",");
        if let Some(sides) = self.lengths() {
            write!(f, "a box of sides {}", list(sides))?;
        } else {
            let [a, b, c] = self.vectors.map(list);
            write!(f, "the vectors ({a}), ({b}), ({c})")?;
        }
        let named = ["first", "second", "third"].into_iter().zip(self.repeats);
        let along: Vec<&str> =
            named.filter(|(_, repeats)| *repeats).map(|(name, _)| name).collect();
        match &along[..] {
            [] => f.write_str(", along which points do not repeat"),
            [one] => write!(f, ", repeating along the {one} alone"),
            [one, other] => write!(f, ", repeating along the {one} and the {other}"),
            _ => Ok(()),
        }
    }
}

/// The metadata of weighted points. A `.wvm` stores all of it except the cell, which comes from formats of molecules and crystals, and the notes. Of
/// the other formats, text may state a unit.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ModelMetadata {
    /// The grid whose samples the points are.
    pub grid: Option<SampleGrid>,
    /// The axes and unit of the coordinates.
    pub coordinates: Coordinates,
    /// The α intended for their shape, which the weights may be proportional to.
    pub alpha: Option<Alpha>,
    /// The values that were gray 0 and 255.
    pub range: Option<GrayRange>,
    /// The `Recipe` of `walpha-model` that made them, as JSON (`Recipe::to_json`).
    pub recipe: Option<String>,
    /// Indices of all points, the most important first.
    pub order: Option<Vec<u32>>,
    /// The unit cell of periodic points.
    pub cell: Option<Cell>,
    /// The coordinate reference system, if a file states one.
    pub crs: Option<Crs>,
    /// What the file of a laser scan says about all its points.
    pub scan: Option<ScanSummary>,
    /// What a LAS file states beside its points, to be written again.
    pub las: Option<LasHeader>,
    /// The columns beside x, y and z: of LAS all, of other files those that were [kept](crate::Attributes).
    pub columns: Vec<ColumnSummary>,
    /// Remarks of a file on some of its points, for people: how many are synthetic, or noise.
    pub notes: Vec<String>,
}

/// The options for packing a `.wvm`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Packing {
    /// The largest error of a value, in units of the values; it bounds the error of F everywhere. 0 keeps
    /// every value bit for bit.
    pub value_error: f64,
    /// The number of layers of points, the most important first. A reader may stop after any layer: without the last it has a
    /// quarter of the points, without the last two a sixteenth. One layer makes the smallest file.
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
        crs: Option<Crs>,
        scan: Option<ScanSummary>,
        las: Option<LasHeader>,
        columns: Vec<ColumnSummary>,
        notes: Vec<String>,
    }
}

impl Default for Packing {
    fn default() -> Self {
        Self { value_error: 0.0, layers: 1 }
    }
}

impl Packing {
    /// The maximum number of layers.
    pub const MOST_LAYERS: u8 = 8;

    setters! { value_error: f64, layers: u8 }
}

impl SampleGrid {
    /// The position of the sample with these indices (x, y, z).
    pub fn position(&self, sample: [u32; 3]) -> [f64; 3] {
        let index = sample.map(f64::from);
        match self.units {
            Units::Voxel => index,
            Units::World => self.frame.to_world(index),
        }
    }

    /// The sample exactly at a position, if it exists.
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

    /// The grid in voxels from 0 to the largest coordinates of some positions; `None` unless all are
    /// nonnegative whole numbers.
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

/// The signature of a `.wvm`. As in PNG, a transfer that converts line endings damages it detectably.
pub(super) const MODEL: &[u8] = b"\x89wvm\r\n\x1a\n";
