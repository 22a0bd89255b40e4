//! Floor 5: shapes as files for other programs.
//!
//! A writer turns a shape into bytes behind one trait and knows no paths; [`Target`] gives it a
//! file that appears under its name only when it is complete.

mod format;
mod json;
mod obj;
mod off;
mod ply;
mod target;
mod volume;
mod vtu;

pub use format::{Exporter, Format, UnknownFormat};
pub use json::Json;
pub use obj::Obj;
pub use off::Off;
pub use ply::Ply;
pub use target::{Target, TargetError};
pub use volume::write_volume_npy;
pub use vtu::Vtu;
