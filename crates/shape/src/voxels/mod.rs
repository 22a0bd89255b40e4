//! The solid of a region of voxels, such as those of a label: a complex whose cells fill these voxels exactly, independent of α.
//!
//! The points are corners of voxels, in *index space*: the lattice of integers, in which a voxel is a cube of side 1. A cube of the lattice is a
//! Delaunay polytope of every set of lattice points that contains its eight corners: the sphere through them has radius √¾, and any other
//! lattice point is at √11/2 or more from its centre. So by the rule for ties (`docs/ties.md`) each such cube is a union of cells, which depend on
//! nothing else, and which are the same in every cube, since moving points does not change their order. [`closure`] therefore writes the
//! cells of voxels down without a triangulation.
//!
//! **Deep voxels**, whose 26 neighbours are all in the region, need no corners of their own. Let D be the deep voxels, and L, the
//! lining, the other voxels of the region that have a neighbour in D. Take the Delaunay triangulation of the corners of L. Each
//! voxel of L is a union of cells. Every face of D that is not between two voxels of D is a face of a voxel of L, because all
//! neighbours of D are in the region, so in L or in D; and D lies in the hull of L, because a ray that leaves D in any direction
//! passes through L. A cell is convex, and its interior meets no face of a voxel of L, so it lies entirely in D or outside of it:
//! D is a union of cells. A cell belongs to D if the voxel that contains its centroid does. The faces that L and D share are cut
//! by the same rule in the plane of the face: the cells meet face to face.
//!
//! All of this is in integers. Finally, corners get their positions in the world, each coordinate rounded. This is an affine map,
//! so all cells keep their orientation or all change it; in the latter case they are turned over. [`voxel_shape`] refuses a grid
//! that is so fine, and so far from the origin, that rounding could matter.

mod cells;
mod closure;
mod sheets;

#[cfg(test)]
pub(crate) mod tests;

use std::sync::Arc;

use walpha_base::advice::{Advice, Advise};
use walpha_base::memory::try_with_capacity;
use walpha_base::shown::number;
use walpha_base::{Coordinates, Monitor};
use walpha_complex::Voxels;

use super::alpha_shape::Assembled;
use super::bits::Bits;
use super::topology::{components, sheet_betti};
use super::{Alpha, AlphaShape, Engine, ShapeError, ShapeOptions, WeightedPoints};
use cells::Lattice;

/// Why voxels have no solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VoxelsError {
    /// The region contains no voxel.
    #[error("the region holds no voxel")]
    Empty,
    /// Runs that overlap, are out of order or leave the grid.
    #[error("the runs of voxels overlap, are not in order, or leave the grid")]
    Runs,
    /// More corners than can be numbered.
    #[error(
        "the boundary of the region has {corners} corners of voxels, and at most {} can be numbered",
        cells::MOST_CORNERS
    )]
    TooMany {
        /// The number of corners.
        corners: u64,
    },
    /// Doubles cannot tell corners apart.
    #[error(
        "coordinates of up to {} are too large for voxels of volume {}: doubles would not tell their corners apart",
        number(*far),
        number(*volume)
    )]
    Rounded {
        /// The largest coordinate.
        far: f64,
        /// The volume of a voxel.
        volume: f64,
    },
}

impl Advise for VoxelsError {
    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Empty => "name labels that are there",
            Self::Runs => "list runs in ascending order",
            Self::TooMany { .. } => "crop or downsample the input",
            Self::Rounded { .. } => "use voxels as units",
        };
        Some(advice.into())
    }
}

/// The solid of a region of voxels: the cells fill exactly its voxels, so the volume is the number of voxels times that of one,
/// up to the rounding of positions. Points are the corners of voxels that have a neighbour outside of the region, among the 26
/// around them, in the order of z, y and x; `value` gives each its value, by its indices in the grid ([`Voxels::corner`]).
///
/// Every simplex is a face of a cell, so nothing is singular. Parts of the region that share an edge or a corner are in one
/// component; parts that share faces are in one [solid](AlphaShape::solid). The options of the shape state α = ∞, because α plays
/// no part. Time and memory grow with the surface of the region, not with its volume.
///
/// ```
/// use walpha_shape::{Voxels, voxel_shape};
///
/// // Two voxels of a row of three, each 2 × 1 × 1.
/// let axes = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let voxels = Voxels { dims: [3, 1, 1], origin: [0.0; 3], axes, runs: vec![[1, 2]] };
/// let shape = voxel_shape(voxels, |_| 1.0)?;
/// assert_eq!(shape.measures().volume, 4.0);
/// assert_eq!(shape.points().positions()[0], [1.0, -0.5, -0.5]);
/// # Ok::<(), walpha_shape::ShapeError>(())
/// ```
///
/// # Errors
/// [`ShapeError::Voxels`], out of memory, and [`ShapeError::Cancelled`].
pub fn voxel_shape(
    voxels: Voxels,
    value: impl Fn([u32; 3]) -> f64,
) -> Result<AlphaShape, ShapeError> {
    let monitor = &*Monitor::current();
    if !voxels.is_sound() {
        return Err(VoxelsError::Runs.into());
    }
    let (region, first) = Bits::of(&voxels)?;
    keeps_orientation(&voxels)?;
    let lattice = Lattice::of(&region)?;
    let points = lattice.corners.len();
    let mirrored = voxels.determinant() < 0.0;
    let complex = closure::complex(&lattice, &region, mirrored, &monitor.part(0, 9, 10))?;
    let what = || "the corners of voxels".to_owned();
    let mut corners = try_with_capacity(points, what)?;
    lattice.corners.each(|corner| corners.push(corner.map(|i| i as u32)));
    let sheets = sheets::sheets(&complex, &corners, &region);
    drop((lattice, region));
    let betti = sheet_betti(&complex, components(&complex), &sheets);
    monitor.part(9, 10, 10).report(1, 1)?;
    let mut positions = try_with_capacity(points, what)?;
    let mut values = try_with_capacity(points, what)?;
    for corner in &corners {
        let corner = [0, 1, 2].map(|k| first[k] + corner[k]);
        positions.push(voxels.corner(corner));
        values.push(value(corner));
    }
    let weights = vec![0.0; points];
    let shape = AlphaShape::assembled(Assembled {
        points: WeightedPoints { positions, weights, values: Some(values) },
        coordinates: Coordinates::default(),
        options: ShapeOptions::new(Alpha::INFINITE).engine(Engine::Native),
        complex,
        hidden: None,
        betti,
        sheets: Some(sheets),
    })?;
    Ok(AlphaShape { voxels: Some(Arc::new(voxels)), ..shape })
}

/// Whether the cells keep their orientation where corners are rounded. A coordinate of the world is rounded by no more than 2⁻⁵⁰ of the sum of
/// its terms; in steps of the grid that moves a corner by δ. The edges of a cell are no longer than the diagonal of the grid, L √3, and its determinant, which
/// is an integer, changes by less than 3 · 2δ√3 · (L√3 + 2δ√3)² < 36 δ L² for small δ.
fn keeps_orientation(voxels: &Voxels) -> Result<(), VoxelsError> {
    let Voxels { dims, origin, axes, .. } = voxels;
    let determinant = voxels.determinant();
    let [a, b, c] = *axes;
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let norm = |v: [f64; 3]| v.iter().map(|x| x.abs()).sum::<f64>();
    let inverse = [cross(b, c), cross(c, a), cross(a, b)].map(norm).into_iter().fold(0.0, f64::max)
        / determinant.abs();
    let reach = |r: usize| {
        origin[r].abs() + (0..3).map(|k| f64::from(dims[k]) * axes[k][r].abs()).sum::<f64>()
    };
    let far = [0, 1, 2].map(reach).into_iter().fold(0.0, f64::max);
    let moved = far * inverse * 2f64.powi(-50);
    let longest = f64::from(dims.iter().copied().fold(1, u32::max));
    // NaN compares false, so it is refused, too.
    if 36.0 * moved * longest * longest < 1.0 && far.is_finite() {
        Ok(())
    } else {
        Err(VoxelsError::Rounded { far, volume: determinant.abs() })
    }
}
