use std::path::Path;

use super::described::{Described, Encoding, frame};
use super::format_error;
use super::vtk::to_centres;
use super::vtk_xml::VtkXml;
use crate::volume::{Coordinates, Dims, Endian, LengthUnit, Space, Volume, VolumeError};

/// Reads VTI, VTK's image data in XML, in one piece: the active scalars of its points, or else its
/// first array of points, or of cells, whose samples stand at the cells' centres.
pub(super) fn read(path: &Path) -> Result<Volume, VolumeError> {
    let said = |what: String| format_error(path, what);
    let file = VtkXml::open(path)?;
    if file.kind() != "ImageData" {
        let kind = file.kind();
        return Err(said(format!("holds {kind}: a volume is ImageData (.vti) in one file")));
    }
    let (image, piece) = file.piece()?;
    let origin = file.numbers(image, "Origin", Some([0.0; 3]))?;
    let spacing = file.numbers(image, "Spacing", Some([1.0; 3]))?;
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let direction = file.numbers(image, "Direction", Some(identity))?;
    let axes = [0, 1, 2].map(|c| [0, 1, 2].map(|r| direction[3 * r + c] * spacing[c]));
    let extent: [f64; 6] = file.numbers(piece, "Extent", None)?;
    let whole = file.numbers(image, "WholeExtent", Some(extent))?;
    if whole != extent {
        return Err(said("is a piece of a larger image: write it whole".into()));
    }

    let mut dims = [0; 3];
    let mut corner = origin;
    for axis in 0..3 {
        let (first, last) = (extent[2 * axis], extent[2 * axis + 1]);
        if first.fract() != 0.0 || last.fract() != 0.0 || last < first || last - first > 4e9 {
            return Err(said(format!("has Extent {extent:?}: it is no grid of samples")));
        }
        dims[axis] = (last - first) as u64 + 1;
        for (component, step) in corner.iter_mut().zip(axes[axis]) {
            *component += first * step;
        }
    }

    let array = |data: &str| {
        let data = file.children(piece, data).next()?;
        let active = file.attribute(data, "Scalars");
        let named = |&array: &usize| active.is_some() && file.attribute(array, "Name") == active;
        file.children(data, "DataArray")
            .find(named)
            .or_else(|| file.children(data, "DataArray").next())
    };
    let array = match (array("PointData"), array("CellData")) {
        (Some(array), _) => array,
        (None, Some(array)) => {
            to_centres(&mut dims, &mut corner, axes);
            array
        }
        (None, None) => {
            return Err(said("has no array of samples: there is no volume in it".into()));
        }
    };
    let components = file.components(array);
    if components != "1" {
        return Err(said(format!(
            "has {components} values a voxel: only scalar volumes are read; extract one first"
        )));
    }
    let dims = Dims::new(dims[0], dims[1], dims[2])?;
    let (frame, dtype) =
        (frame(path, corner, axes, coordinates(&file, image)?)?, file.dtype(array)?);
    let samples = file.values(array, dims.samples() as u64)?;
    Described { dims, dtype, endian: Endian::Little, frame, encoding: Encoding::Raw }
        .volume(samples)
}

/// What the field data `SPACE` and `UNIT` say, as our own files have them.
fn coordinates(file: &VtkXml, image: usize) -> Result<Coordinates, VolumeError> {
    let space = match file.field_text(image, "SPACE")?.as_deref() {
        Some("LPS") => Space::Lps,
        Some("RAS") => Space::Ras,
        _ => Space::Unknown,
    };
    let unit = file.field_text(image, "UNIT")?.map(|name| LengthUnit::named(&name));
    Ok(Coordinates { space, unit: unit.unwrap_or_default() })
}
