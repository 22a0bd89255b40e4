//! The formats of volumes: what each is called, how it is recognised, read and written, and what it stores. All other lists of
//! formats are made from the [table](FORMATS).

mod detect;
mod magic;
mod others;
mod table;
mod unknown;

/// An item that needs a feature, or `None` if the feature was not built in.
#[doc(hidden)]
#[macro_export]
macro_rules! __built {
    ($feature:tt, $what:expr) => {{
        #[cfg(feature = $feature)]
        {
            Some($what)
        }
        #[cfg(not(feature = $feature))]
        {
            None
        }
    }};
}
pub use __built as built;

#[cfg(any(feature = "dicom", feature = "zarr"))]
pub(crate) use detect::decoded;
#[cfg(feature = "dicom")]
pub(crate) use detect::recognised;
pub(crate) use detect::{accept_sample, data_files_of, format_name_of, source, source_of};
pub use detect::{begins_as_volume, data_files, files_of, format_name, read, read_file, series};
pub(crate) use magic::{NIFTI_HEADERS, nifti_version};
#[cfg(feature = "dicom")]
pub(crate) use magic::{dicom_mark, dicom_order};
pub(crate) use magic::{is_dicom, is_gzip};
pub use magic::{is_npy, is_vtk, is_vtk_xml};
pub(crate) use others::OF_SIMPLICES;
pub use others::{is_cif, is_gro, is_lammps_data, is_lammps_dump, is_pdb, is_poscar, other_kind};
pub use table::{FORMATS, Keeps, VolumeFormat, VolumeWriter};
pub use unknown::UnknownFormat;
