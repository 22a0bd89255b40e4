//! `.wvm`: the compressed points of a model. `docs/wvm.md` describes the format byte by byte.
//!
//! Positions are coded as voxels of a grid and values as whole numbers, bit by bit with a range coder and
//! adaptive probabilities ([`mixer`]); anything else is stored bit for bit ([`column`]). The tetrahedra are not
//! stored, as the points determine them.

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
