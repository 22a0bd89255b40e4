//! Writes shapes to files for other programs.
//!
//! All writers implement one trait, which turns a shape into bytes and does not deal with paths. [`Target`]
//! provides a file that appears under its name only when it is complete.
//!
//! ```
//! use walpha_model::export::{ExportOptions, Format, Save};
//! use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
//!
//! let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let points = WeightedPoints::unweighted(positions);
//! let shape = alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(1.0)?))?;
//!
//! // To a file, which appears under its name only after the last byte is written.
//! let folder = tempfile::tempdir()?;
//! shape.save(folder.path().join("tetrahedron.ply"))?;
//! // To anything else.
//! let exporter = Format::of("tetrahedron.off")?.exporter(&ExportOptions::default());
//! let mut bytes = Vec::new();
//! exporter.write(&shape, &mut bytes)?;
//! assert!(bytes.starts_with(b"OFF"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod about;
mod claim;
mod colour;
mod cycles;
mod empty;
mod exporter;
mod features;
mod filtration;
mod findings;
mod format;
mod geographic;
mod geojson;
#[cfg(all(feature = "las", not(target_family = "wasm")))]
mod geopackage;
mod glb;
mod json;
mod labelled;
mod npz;
mod obj;
mod off;
mod planar;
mod ply;
mod save;
mod stl;
mod svg;
mod threemf;
mod vtp;
mod vtu;
mod wkt;

pub use claim::{claim, placed_complex};
pub use cycles::write_cycles;
pub use empty::{EmptyShape, Needs};
pub use exporter::{ExportOptions, Exporter};
pub use features::{FeatureFormat, OutlineFeature};
pub use filtration::{FILTRATION_FORMATS, FiltrationFormat};
#[doc(hidden)]
pub use findings::write_findings;
pub use format::{FORMATS, Format};
pub use geojson::GeoJson;
#[cfg(all(feature = "las", not(target_family = "wasm")))]
pub use geopackage::GeoPackage;
pub use glb::Glb;
pub use json::Json;
// For the surface of balls, which the command writes. Not covered by semantic versioning.
#[doc(hidden)]
pub use labelled::LabelledMesh;
pub use npz::Npz;
pub use obj::Obj;
pub use off::Off;
pub use ply::Ply;
pub use save::{Save, SaveError};
pub use stl::Stl;
pub use svg::Svg;
pub use threemf::ThreeMf;
pub use vtp::Vtp;
pub(crate) use vtp::{Membership, write_surface};
pub use vtu::Vtu;
pub(crate) use vtu::{PointData, Provenance, write_grid};
pub use walpha_files::{Target, TargetError};
pub use walpha_volume::UnknownFormat;
// These are for the command and for Python, and not covered by semantic versioning.
#[doc(hidden)]
pub use walpha_files::{Content, Filled, NewFolder, Scratch, put_all, sweep, write_all};
pub use wkt::Wkt;
