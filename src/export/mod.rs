//! Floor 5: shapes as files for other programs.
//!
//! A writer turns a shape into bytes behind one trait and knows no paths; [`Target`] gives it a
//! file that appears under its name only when it is complete.

mod format;
mod glb;
mod json;
mod npz;
mod obj;
mod off;
mod part;
mod ply;
mod stl;
mod target;
mod volume;
mod vtp;
mod vtu;

pub use format::{Exporter, Format, UnknownFormat};
pub use glb::Glb;
pub use json::Json;
pub use npz::Npz;
pub use obj::Obj;
pub use off::Off;
pub use part::abandon;
pub use ply::Ply;
pub use stl::Stl;
pub use target::{Target, TargetError};
pub use volume::{
    VolumeFormat, write_volume_nifti, write_volume_npy, write_volume_nrrd, write_volume_raw,
    write_volume_vti,
};
pub use vtp::Vtp;
pub use vtu::Vtu;
