//! VTK's formats: the legacy formats and those in XML.

mod ghosts;
mod image;
mod legacy;
mod legacy_arrays;
mod legacy_points;
mod xml;
mod xml_arrays;

pub(crate) use image::read as read_image;
pub(crate) use legacy::read as read_legacy;
pub use legacy_points::VtkPoints;
pub use xml::VtkXml;
#[cfg(feature = "zarr")]
pub(super) use xml_arrays::Base64;
