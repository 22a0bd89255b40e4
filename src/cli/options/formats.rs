//! Help texts that list formats, generated from the library's tables.

use crate::outofcore::BlockwiseFormat;
use crate::{export, points, volume};

/// The list of inputs.
fn inputs() -> String {
    let volumes: Vec<&str> = volume::FORMATS.iter().map(|format| format.name).collect();
    let points: Vec<&str> = points::FORMATS.iter().map(|format| format.name).collect();
    format!(
        "INPUT is a volume ({} with --dims), a point file ({}), one of {}, sample:peptide, sample:tile, or a set of points that is hard to triangulate (hard:NAME). α and weights are squared \
         lengths.",
        volumes.join(", "),
        points.join(", "),
        volume::SAMPLES.join(", ")
    )
}

/// The long help of the command.
pub(crate) fn about() -> String {
    format!(
        "Volume modelling of scattered data with wavelet-weighted alpha shapes.\n\n\
         A volume is Haar-transformed, small coefficients are dropped, the samples of largest gray \
         difference become weighted points, and the alpha shape of these points is \
         computed exactly: cells, facets, edges and vertices.\n\n{}\n\n\
         Examples:\n\n\
         walpha shape ct.nii.gz -o bone.ply\n\n\
         walpha view scan.xyz -o scan.html\n\n\
         walpha reproduce",
        inputs()
    )
}

fn dotted<'a>(extensions: impl IntoIterator<Item = &'a str>) -> String {
    let dotted: Vec<String> = extensions.into_iter().map(|e| format!(".{e}")).collect();
    match &dotted[..] {
        [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
        _ => dotted.concat(),
    }
}

/// The help of an output that is a volume; `what` says what is written.
pub(crate) fn volume_output(what: &str) -> String {
    format!(
        "{what}, as f32, replaced if it exists: {}; or - (standard output, with --output-format)",
        dotted(volume::VolumeWriter::all().map(|writer| writer.extension))
    )
}

/// The help of the outputs of a shape.
pub(crate) fn shape_output() -> String {
    let of = |is_meant: fn(&&export::Format) -> bool| {
        dotted(export::FORMATS.iter().filter(is_meant).map(|format| format.extension))
    };
    format!(
        "Files to write: {} (boundary), {} (all simplices), {} (outlines of points in a \
         plane: polygons with holes), .png (a picture), .wvm (the points, compressed, to \
         recompute the shape from); {} (for volumes larger \
         than memory, whose shape is computed block by block); or \
         - (standard output, with --output-format). Existing files are replaced",
        of(|format| format.boundary),
        of(|format| !format.boundary && !format.outline),
        of(|format| format.outline),
        dotted(BlockwiseFormat::ALL.iter().map(|(_, extension)| *extension))
    )
}

/// The help of the outputs of a filtration.
pub(crate) fn filtration_output() -> String {
    format!(
        "Files to write: {}; or - (standard output, with --output-format). Existing files are replaced",
        dotted(export::FILTRATION_FORMATS.iter().map(|format| format.extension))
    )
}

/// The help of an output of points.
pub(crate) fn points_output() -> String {
    format!(
        "File to write, replaced if it exists: {} (columns x, y, z, weight and value); or - (standard \
         output, with --output-format)",
        dotted(points::PointWriter::all().map(|writer| writer.extension))
    )
}
