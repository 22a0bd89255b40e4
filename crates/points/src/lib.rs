//! Computes weighted points from a volume.
//!
//! Steps 5 to 7 of the paper: the difference L of each voxel of the truncated volume, the selection of the
//! voxels of largest L, and their weights (equations 4.1 and 4.2).
//!
//! ```
//! use walpha_points::haar::{HaarOptions, smooth};
//! use walpha_points::{Selection, Units, Weighting, difference, select, weigh};
//! use walpha_shape::Alpha;
//! use walpha_volume::sample;
//!
//! let volume = sample("sample:phantom@32")?;
//! let (smoothed, _) = smooth(&volume, &HaarOptions::default())?;
//! let points = select(&volume, &smoothed, &difference(&smoothed), &Selection::default(), Units::Voxel)?;
//! assert_eq!(points.len(), 1996); // 6.09 % of 32³
//! let weighted = weigh(points, Weighting::MinMax, Alpha::from_squared(10.0)?)?;
//! assert_eq!((weighted.summary().min, weighted.summary().max), (0.0, 10.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
// The slicing macro of ndarray allows unsafe code within itself, so it cannot be forbidden.
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

pub mod haar;

mod attributes;
mod cell_count;
pub mod colours;
mod crs;
mod difference;
mod error;
mod focus;
mod formats;
mod hard;
mod largest;
mod las_header;
mod mesh;
mod model;
mod molecule;
mod open;
mod read;
mod select;
mod sets;
mod spread;
mod tile;
mod weigh;
mod weighting;
mod write;
mod wvm;

pub use attributes::{Attributes, Column, ColumnSummary, Flags, ScanSummary};
pub use cell_count::CellCount;
pub use crs::{Crs, Vertical};
pub use difference::{difference, scattered_difference};
pub use error::PointsError;
pub use focus::{Region, focus};
pub use formats::{FORMATS, PointFormat, PointWriter};
pub use hard::{HARD_SETS, HardSet, hard};
pub use las_header::LasHeader;
pub use mesh::{cells_of, read_complex};
pub use model::{Cell, ModelMetadata, Packing, SampleGrid};
pub use molecule::{Atom, AtomSelection, Element, LeftOut, Models, Molecule, Radii};
pub use open::{PointOptions, is_point_file, read_model, read_model_file, read_points};
pub use read::{Columns, UnknownColumns};
pub use select::{Selection, SelectionRule, Units, points_at, select};
pub use sets::{Points, bounding_box};
pub use spread::spread_order;
pub use walpha_base::advice::Advise;
pub use walpha_shape::{WeightSummary, WeightedPoints};
pub use weigh::{weigh, weights};
pub use weighting::{UnknownWeighting, Weighting};

/// Items for the other crates of walpha besides the public ones; not covered by semantic versioning.
#[doc(hidden)]
pub mod internal {
    pub use crate::difference::difference_row;
    pub use crate::haar::internal::{Bricks, Slabs};
    pub use crate::largest::{Budget, Counts, Cut, Search};
    pub use crate::mesh::{cells_of_file, read_complex_file};
    pub use crate::open::describe_file;
    pub use crate::select::{Asked, LEAST_GRAY, check_least};
    pub use crate::weighting::{Differences, Shares};
}
