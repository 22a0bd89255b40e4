//! Predicates and mesh internals, for the other crates of walpha: **no promise of semantic versioning**. Exact predicates for
//! other programs are in [`predicates`](crate::predicates).

pub mod number;

use walpha_base::parallel::prelude::*;

pub use crate::arrays::CellArrays;
pub use crate::flat::{Flat, auxiliary_positions, check_span, is_flat, spanning, triangulate_flat};
pub use crate::incremental::{Cell, Growing, Workspace, insert_all};
pub use crate::kernel::{
    Interval, Predicates, Ratio, Screen, Share, SmallRadius, Twofold, centre_shares, lattice,
};
pub use crate::lattice::{BitRange, Lattice};
pub use crate::merging::triangulate_along;
pub use crate::power_diagram::{Sides, cell_volumes, dual_facets, is_listed};
pub use crate::scaled::Scaled;
pub use crate::sites::{Sites, check as check_numbers};
pub use crate::torus::{AXES, VECTORS};

/// The points along a Hilbert curve, including hidden and equal ones. O(n log n).
pub fn along_curve(positions: &[[f64; 3]]) -> Vec<u32> {
    crate::order::along_curve(positions).into_par_iter().coarse().map(|(_, point)| point).collect()
}
