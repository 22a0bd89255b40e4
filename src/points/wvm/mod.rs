//! `.wvm`: points of a model in few bytes. `docs/wvm.md` describes the format byte by byte.
//!
//! Places are coded as voxels of a grid, values as whole numbers, each bit by a range coder with a
//! probability that is learnt on the way ([`mixer`]); what does not fit that is kept bit for bit
//! ([`column`]). The tetrahedra are not kept: they are a function of the points.

mod around;
mod blocks;
mod coder;
mod column;
mod fields;
mod header;
mod mixer;
mod places;
mod predict;
mod read;
mod values;
mod write;

pub(super) use read::read;
pub(super) use write::write;
