//! Reading points from files. The format is recognised by the content first, then by the extension.

use std::path::Path;

use walpha_base::advice::Setting;
use walpha_base::setters;

use super::formats::{FORMATS, PointFormat};
use super::read::{COLUMNS, format};
use super::{Columns, ModelMetadata, Points, PointsError, hard};
use crate::volume::{OpenFile, Reason, begins_as_volume};

/// What a user may state about a file of points.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PointOptions {
    /// What the columns of a table hold.
    pub columns: Option<Columns>,
    /// Number of layers of a `.wvm` to leave out, from the last: each level is a coarser model with a quarter
    /// of the points.
    pub level: Option<u32>,
    /// The extension of the file's format, in place of its own extension; the content takes precedence.
    pub format: Option<String>,
    /// The classes of points to read from LAS and LAZ, by their ASPRS codes; `None` reads all.
    pub classes: Option<Vec<u8>>,
    /// Keeps the first point in each cube of this side, in the unit of the points; `None` keeps all.
    pub thin: Option<f64>,
}

impl PointOptions {
    setters! {
        columns: Option<Columns>,
        level: Option<u32>,
        format: Option<String>,
        classes: Option<Vec<u8>>,
        thin: Option<f64>,
    }

    /// Whether a file holds points rather than a volume under these options; see [`is_point_file`].
    ///
    /// # Errors
    /// As [`is_point_file`].
    pub fn is_point_file(&self, path: impl AsRef<Path>) -> Result<bool, PointsError> {
        let path = path.as_ref();
        if hard(path)?.is_some() {
            return Ok(true);
        }
        // A pipe is recognised by name alone, as bytes read from it are gone.
        if path.is_file() {
            self.holds_points(&OpenFile::open(path)?)
        } else {
            Ok(!path.is_dir() && self.format_named(path).is_some())
        }
    }

    /// [`is_point_file`](Self::is_point_file) for an open file.
    pub(crate) fn holds_points(&self, file: &OpenFile) -> Result<bool, PointsError> {
        match self.format_of(file) {
            Some(format) if file.is_ordinary() => format.holds_points(file),
            named => Ok(named.is_some()),
        }
    }

    /// The format of a file, by its content, or else by its extension.
    pub(super) fn format_of(&self, file: &OpenFile) -> Option<&'static PointFormat> {
        let of_content = FORMATS.iter().find(|format| format.begins(file.start()));
        if of_content.is_some() || begins_as_volume(file.start()) {
            return of_content;
        }
        self.format_named(file.path())
    }

    /// The format of the given extension, or else of the path's.
    pub(super) fn format_named(&self, path: &Path) -> Option<&'static PointFormat> {
        let own = path.extension().unwrap_or_default().to_string_lossy();
        let extension = self.format.as_deref().unwrap_or(&own);
        FORMATS.iter().find(|format| format.is_named(extension))
    }
}

/// Whether a file holds points rather than a volume, by its content or else by its extension
/// ([`FORMATS`](super::FORMATS)). NPY files hold points if their array has two axes, VTK XML files if they
/// hold geometry.
///
/// # Errors
/// A file that cannot be opened, or that begins like NPY or VTK XML and cannot be read.
pub fn is_point_file(path: &Path) -> Result<bool, PointsError> {
    PointOptions::default().is_point_file(path)
}

/// Reads points, with weights and values if the file has such columns. Points are counted from 0.
///
/// - CSV, TSV (fields separated by commas, semicolons or tabs) and XYZ (by white space): the first line
///   may name the columns: x, y, z, optionally weight (or radius, whose square is the weight) and value, in
///   any order and case; others are skipped. Without names, `columns` gives them; without both, x y z are
///   read, followed by a value, or by a normal or a colour, which are skipped. XYZ may also hold atoms, as
///   in chemistry, with the columns and the cell that extended XYZ states.
/// - PTS: as XYZ, optionally after a line with the number of points; the intensity is the value.
/// - PWN: as XYZ; or the number of points, the points, and as many normals.
/// - OFF, OBJ, STL: the vertices; for STL each position once.
/// - PCD: the fields x, y, z, optionally weight or radius, and value or else intensity.
/// - LAS and LAZ: coordinates, and the intensity as value.
/// - PLY (text, or binary of either byte order), VTU, VTP and legacy VTK: the vertices, with their properties
///   or point data `weight` or `radius`, and `value`; VTK's active scalars are the values if no array has
///   that name.
/// - NPY: an array n×3 (x, y, z), n×4 (…, weight) or n×5 (…, value).
/// - WVM: all layers ([`read_model`] can leave some out).
///
/// # Errors
/// The file cannot be read, is truncated or longer than it claims, a column is missing or named twice,
/// a number is not finite or a radius negative (the message says where), the file holds no point, or
/// `columns` are given for a format that names its own.
pub fn read_points(
    path: impl AsRef<Path>,
    columns: Option<&Columns>,
) -> Result<Points, PointsError> {
    Ok(read_model(path, &PointOptions::default().columns(columns.cloned()))?.0)
}

/// Reads points and their metadata, which is empty if the format stores none; or makes those of a [`hard`] set, by its name.
///
/// # Errors
/// As [`read_points`]; a level that the file does not have; a stated format that contradicts the content.
pub fn read_model(
    path: impl AsRef<Path>,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = path.as_ref();
    if let Some(points) = hard(path)? {
        return Ok((points, ModelMetadata::default()));
    }
    read_model_file(&OpenFile::open(path)?, options)
}

/// [`read_model`] from an open file.
pub(crate) fn read_model_file(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let known = options.format_of(file).unwrap_or(&FORMATS[0]);
    let PointOptions { columns, level, format: named, classes, thin } = options;
    let (columns, level) = (columns.as_ref(), *level);
    if named.as_ref().is_some_and(|named| !known.is_named(named)) {
        let what = format!("begins like a file of the format {}", known.name);
        return Err(format(path, Reason::needless(Setting::Format, what)));
    }
    if columns.is_some() && !known.takes_columns {
        let reason = Reason::needless(Setting::Columns, "defines its own columns");
        return Err(format(path, reason));
    }
    if level.is_some() && !known.has_levels() {
        let reason = Reason::needless(Setting::Level, "has no layers of points");
        return Err(format(path, reason));
    }
    let (mut points, metadata) = match classes {
        Some(classes) => (known.read_classes(file, classes)?, ModelMetadata::default()),
        None => known.read(file, columns, level.unwrap_or_default())?,
    };
    if points.is_empty() && classes.is_some() {
        let what = "holds no point of these classes";
        return Err(format(path, Reason::content(what, "see which classes it has, or read all")));
    }
    if points.is_empty() {
        return Err(format(path, Reason::content("holds no points", "name another file")));
    }
    finite(path, &points)?;
    if let Some(side) = *thin {
        points.thin(side)?;
    }
    Ok((points, metadata))
}

/// Refuses NaN and infinities.
fn finite(path: &Path, points: &Points) -> Result<(), PointsError> {
    for (row, position) in points.positions.iter().enumerate() {
        let [weight, value] =
            [&points.weights, &points.values].map(|column| column.as_ref().map_or(0.0, |c| c[row]));
        let numbers = [position[0], position[1], position[2], weight, value];
        if let Some(column) = numbers.iter().position(|number| !number.is_finite()) {
            let (name, value) = (COLUMNS[column], numbers[column]);
            let reason =
                Reason::value(format!("row {row}: {name} is {value}, and must be a finite number"));
            return Err(format(path, reason));
        }
    }
    Ok(())
}
