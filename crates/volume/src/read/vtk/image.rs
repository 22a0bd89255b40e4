//! VTI, VTK's image data in XML.

use walpha_base::sort::sort_by_key;

use super::ghosts;
use super::legacy::{choice, to_centres};
use super::xml::VtkXml;
use crate::error::format_error;
use crate::read::OpenFile;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout, frame};
use crate::{Dims, Endian, Reason, Volume, VolumeError};
use walpha_base::Monitor;

/// Reads VTI, VTK's image data in XML, in one piece: the array with this name; or else the active scalars of its points, the
/// first array of points, or one of cells, whose samples are at the cells' centres.
pub(crate) fn read(
    file: &OpenFile,
    wanted: Option<&str>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let fail = |reason: Reason| format_error(path, reason);
    let file = VtkXml::open(file)?.monitored(monitor);
    if file.kind() != "ImageData" {
        let kind = file.kind();
        if ["PUnstructuredGrid", "PPolyData"].contains(&kind) {
            return Err(fail(Reason::unsupported(
                format!("holds {kind}, which names the pieces of a mesh"),
                "name a piece, or the input that it was made from",
            )));
        }
        return Err(fail(Reason::unsupported(
            format!("holds {kind}: a volume is ImageData (.vti) in one file"),
            "save it as ImageData",
        )));
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
        return Err(fail(Reason::unsupported("is a piece of a larger image", "write it whole")));
    }

    let mut dims = [0; 3];
    let mut corner = origin;
    for axis in 0..3 {
        let (first, last) = (extent[2 * axis], extent[2 * axis + 1]);
        if first.fract() != 0.0 || last.fract() != 0.0 || last < first || last - first > 4e9 {
            return Err(fail(Reason::header(format!(
                "has Extent {extent:?}: it is not a grid of samples"
            ))));
        }
        dims[axis] = (last - first) as u64 + 1;
        for (component, step) in corner.iter_mut().zip(axes[axis]) {
            *component += first * step;
        }
    }

    let (array, cells) = choose(&file, piece, wanted).map_err(fail)?;
    if cells {
        to_centres(&mut dims, &mut corner, axes);
    }
    let components = file.components(array);
    if components != "1" {
        return Err(fail(Reason::not_scalar(format!("{components} values a voxel"), Some(dims))));
    }
    let dims = Dims::new(dims[0], dims[1], dims[2])?;
    let (frame, dtype) = (frame(path, corner, axes, file.coordinates(image)?)?, file.dtype(array)?);
    let mut samples = file.values(array, dims.samples() as u64)?;
    let siblings =
        file.elements[array].parent.into_iter().flat_map(|data| file.children(data, "DataArray"));
    let ghosts = siblings.into_iter().find(|&other| file.name(other) == ghosts::NAME);
    let hidden = match ghosts {
        Some(ghosts) => {
            let bytes: Vec<f32> = file.values(ghosts, dims.samples() as u64)?;
            ghosts::hide(path, &mut samples, &bytes, cells)?
        }
        None => None,
    };
    let (endian, encoding, frames) = (Endian::Little, Encoding::Raw, FrameChoice::ONE);
    let volume = Layout { dims, dtype, endian, frame, encoding, frames }.volume(samples)?;
    Ok(volume.with_missing(hidden))
}

/// Chooses the array to read, and returns whether it belongs to cells. Arrays of points come first. If there are others, the
/// choice is reported.
fn choose(file: &VtkXml, piece: usize, wanted: Option<&str>) -> Result<(usize, bool), Reason> {
    let name = |array: usize| file.attribute(array, "Name").unwrap_or_default();
    let mut arrays = Vec::new();
    for (data, cells) in [("PointData", false), ("CellData", true)] {
        let Some(data) = file.children(piece, data).next() else { continue };
        let active = file.attribute(data, "Scalars");
        let is_sample = |&array: &usize| name(array) != ghosts::NAME;
        let mut here: Vec<usize> = file.children(data, "DataArray").filter(is_sample).collect();
        // The sort keeps the order of the others.
        sort_by_key(&mut here, |&array| active != Some(name(array)));
        arrays.extend(here.into_iter().map(|array| (array, cells)));
    }
    let names: Vec<(&str, bool)> =
        arrays.iter().map(|&(array, cells)| (name(array), cells)).collect();
    let place = choice(&names, wanted)?;
    Ok(arrays[place])
}
