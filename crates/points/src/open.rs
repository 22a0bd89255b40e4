//! Reading points from files. The format is recognised by the content first, then by the extension.

use std::borrow::Cow;
use std::path::Path;

use walpha_base::advice::Setting;
use walpha_base::setters;
use walpha_base::shown::shown;

use super::formats::{FORMATS, OF_ATOMS, PointFormat};
use super::molecule::{AtomSelection, PEPTIDE, Radii, peptide};
use super::read::content::Packed;
use super::read::{COLUMNS, format};
use super::tile::{TILE, tile};
use super::{Attributes, Columns, ModelMetadata, Points, PointsError, Region, bounding_box, hard};
use walpha_volume::{OpenFile, Reason, begins_as_volume, other_kind};

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
    /// The frame to read from a text with several: a scan of PTS, a step of a trajectory. Counted from 0.
    pub frame: Option<u64>,
    /// The classes of points to read from LAS and LAZ, by their ASPRS codes; `None` reads all.
    pub classes: Option<Vec<u8>>,
    /// Whether points of LAS and LAZ are read that are flagged *withheld*, which are not to be processed.
    pub withheld: bool,
    /// The column whose numbers are the values F, by its name; `height` is z. `None` takes a column `value`, or the intensity.
    pub value: Option<String>,
    /// The columns that are kept beside coordinates, weights and values.
    pub attributes: Attributes,
    /// Whether the points are only described: ranges of columns are found, and coordinates need not be lengths in one unit.
    pub(crate) describe: bool,
    /// Whether a column that is not a weight by its name is one where the file has no other: the values.
    pub weights: bool,
    /// Reads only the points in this box; `None` reads all.
    pub region: Option<Region>,
    /// Keeps the first point in each cube of this side, in the unit of the points; `None` keeps all. The cubes start at the least
    /// coordinates of the points that are read.
    pub thin: Option<f64>,
    /// Where the radii of atoms come from; `None` takes those of the file, or else Bondi's.
    pub radii: Option<Radii>,
    /// Which atoms of PDB, mmCIF and the sample `sample:peptide` are read, and of GRO as to hydrogens and water. Other formats
    /// are read as a whole, but for `chains` of PQR.
    pub atoms: AtomSelection,
}

impl PointOptions {
    setters! {
        columns: Option<Columns>,
        level: Option<u32>,
        format: Option<String>,
        frame: Option<u64>,
        classes: Option<Vec<u8>>,
        withheld: bool,
        value: Option<String>,
        attributes: Attributes,
        weights: bool,
        region: Option<Region>,
        thin: Option<f64>,
        radii: Option<Radii>,
        atoms: AtomSelection,
    }

    /// These options for a description of a file: all columns are kept, unless the reader describes them.
    fn describing(&self, file: &OpenFile) -> Self {
        let describes = self.format_of(file).is_some_and(|format| format.describes);
        let attributes = if describes { Attributes::None } else { Attributes::All };
        Self { describe: true, ..self.clone().attributes(attributes) }
    }

    /// Checks that all columns that are asked for are there, and takes the values from the one that is named.
    fn take_columns(
        &self,
        path: &Path,
        points: &mut Points,
        others: impl FnOnce() -> Result<Vec<String>, PointsError>,
    ) -> Result<(), PointsError> {
        let mut asked = self.attributes.names().iter().chain(&self.value);
        if let Some(name) = asked.find(|name| points.column(name).is_none()) {
            let known = [("weight", points.weights.is_some()), ("value", points.values.is_some())];
            let known = known.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name);
            let mut names: Vec<String> = ["x", "y", "z"].map(str::to_owned).to_vec();
            names.extend(known.map(str::to_owned));
            names.extend(others()?);
            let what = format!("has no column {name} of numbers, but {}", names.join(", "));
            return Err(format(path, Reason::content(what, "name one of these")));
        }
        if let Some(name) = &self.value {
            let values = points.column(name).map(Cow::into_owned);
            points.values = values;
            if !self.attributes.keeps(name) {
                points
                    .columns
                    .retain(|column| !Attributes::Named(vec![name.clone()]).keeps(&column.name));
            }
        }
        Ok(())
    }

    /// The points of a name that stands for no file: those of a [`hard`] set, or the molecule `sample:peptide`, an α-helix of
    /// twelve alanines; or the laser scan `sample:tile`, with ground, a roof and five trees.
    ///
    /// # Errors
    /// There is no such set, or a radius is not known.
    pub fn made(
        &self,
        name: impl AsRef<Path>,
    ) -> Result<Option<(Points, ModelMetadata)>, PointsError> {
        let name = name.as_ref();
        let (made, chooses) = if name.as_os_str() == PEPTIDE {
            (Some(peptide(self)?), OF_ATOMS)
        } else if name.as_os_str() == TILE {
            (Some(tile(self)?), &[Setting::Class, Setting::Withheld][..])
        } else {
            (hard(name)?.map(|points| (points, ModelMetadata::default())), &[][..])
        };
        let Some((mut points, metadata)) = made else { return Ok(None) };
        refuse_needless(chooses, name, self)?;
        let names: Vec<String> = points.columns.iter().map(|column| column.name.clone()).collect();
        self.take_columns(name, &mut points, || Ok(names))?;
        points.columns.retain(|column| self.attributes.keeps(&column.name));
        self.reduce(name, &mut points)?;
        Ok(Some((points, metadata)))
    }

    /// Keeps the points in the region, and the first in each cube.
    fn reduce(&self, path: &Path, points: &mut Points) -> Result<(), PointsError> {
        if let Some(region) = &self.region {
            let kept: Vec<bool> =
                points.positions.iter().map(|&place| region.contains(place)).collect();
            if !kept.contains(&true) {
                return Err(region.without_points(path, bounding_box(&points.positions)));
            }
            points.keep(&kept);
        }
        self.thin.map_or(Ok(()), |side| points.thin(side))
    }

    /// Whether a file holds points rather than a volume under these options; see [`is_point_file`].
    ///
    /// # Errors
    /// As [`is_point_file`].
    pub fn is_point_file(&self, path: impl AsRef<Path>) -> Result<bool, PointsError> {
        let path = path.as_ref();
        if [PEPTIDE, TILE].iter().any(|name| path.as_os_str() == *name) || hard(path)?.is_some() {
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
    #[doc(hidden)]
    pub fn holds_points(&self, file: &OpenFile) -> Result<bool, PointsError> {
        match self.format_of(file) {
            Some(format) if file.is_ordinary() => format.holds_points(file),
            named => Ok(named.is_some()),
        }
    }

    /// The format of a file, by its content, or else by its extension. Of one that is compressed, what it holds decides.
    pub(super) fn format_of(&self, file: &OpenFile) -> Option<&'static PointFormat> {
        if let Some(Packed { name, start }) = Packed::of(file) {
            return self.format_that_is(&start, &name).filter(|format| format.is_packed);
        }
        self.format_that_is(file.start(), file.path())
    }

    fn format_that_is(&self, start: &[u8], path: &Path) -> Option<&'static PointFormat> {
        let named = self.format_named(path);
        let mut of_content = FORMATS.iter().filter(|format| format.begins(start));
        match (of_content.next(), of_content.next()) {
            (Some(only), None) => Some(only),
            (None, _) if begins_as_volume(start) => None,
            // Of several that begin so, the name says which it is.
            _ => named,
        }
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
/// - Text (CSV, TSV, XYZ, PTS): fields are separated by commas, semicolons, tabs or blanks. The first line may name the
///   columns: x, y, z, optionally weight (or radius, whose square is the weight) and value (or intensity), in any order
///   and case; others are skipped. Without names, `columns` gives them; without both, x y z are read, followed by a value,
///   or by a normal or a colour, which are skipped. XYZ may also hold atoms, as in chemistry, with the columns and the
///   cell that extended XYZ states. Counts of points may come first; of several frames, one is read.
/// - PWN: as XYZ; or the number of points, the points, and as many normals.
/// - OFF, OBJ, STL: the vertices; for STL each position once.
/// - PCD, PLY (text, or binary of either byte order), VTU, VTP and legacy VTK: the points, with their properties, fields or
///   point data of these names; VTK's active scalars are the values if no array is named so.
/// - LAS and LAZ: coordinates, and the intensity as value, without the points that are withheld.
/// - NPY: an array n×3 (x, y, z) or n×4 (…, value), or what `columns` say; of a structured array the fields of these names.
/// - PDB, mmCIF: the heavy atoms of the polymers in the first model ([`AtomSelection`] has more), with the squares of Bondi's
///   radii as weights ([`Radii`]). GRO: the heavy atoms but water. PQR: all atoms, with the radii of the file. XYZ with elements
///   is read so, too.
/// - CIF of crystals: all atoms of the cell, by the symmetry operations that are listed. POSCAR, LAMMPS data and dumps: all
///   atoms; of types that are not elements points without radii.
/// - WVM: all layers ([`read_model`] can leave some out).
///
/// Text, molecules, OFF, OBJ, STL, PCD and PLY may be compressed with gzip, or be alone in a ZIP archive.
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

/// Reads points and their metadata, which is empty if the format stores none; or makes those of a name
/// ([`PointOptions::made`]).
///
/// # Errors
/// As [`read_points`]; a level that the file does not have; a stated format that contradicts the content.
pub fn read_model(
    path: impl AsRef<Path>,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = path.as_ref();
    if let Some(made) = options.made(path)? {
        return Ok(made);
    }
    read_model_file(&OpenFile::open(path)?, options)
}

/// [`read_model`] from an open file.
///
/// # Errors
/// The errors of [`read_model`].
pub fn read_model_file(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let known = options.format_of(file).unwrap_or(&FORMATS[0]);
    if options.format.as_ref().is_some_and(|named| !known.is_named(named)) {
        let what = format!("begins like a file of the format {}", known.name);
        return Err(format(path, Reason::needless(Setting::Format, what)));
    }
    accept(known, path, options)?;
    if let Some(reason) = of_another_kind(known, file) {
        return Err(format(path, reason));
    }
    let keep = options.attributes.and(options.value.as_ref());
    let (mut points, mut metadata) = known.read(file, &options.clone().attributes(keep))?;
    if points.is_empty() {
        return Err(format(path, Reason::content("holds no points", "name another file")));
    }
    let names = || -> Result<Vec<String>, PointsError> {
        let (all, metadata) = known.read(file, &options.describing(file))?;
        let of_scan = metadata.columns.into_iter().map(|column| column.name);
        Ok(of_scan.chain(all.columns.into_iter().map(|column| column.name)).collect())
    };
    options.take_columns(path, &mut points, names)?;
    if metadata.scan.is_none() {
        metadata.columns = points.columns.iter().map(|column| column.summary("float64")).collect();
    }
    finite(path, &points)?;
    if options.weights && points.weights.is_none() && points.values.is_some() {
        tracing::warn!(
            "{} has no column weight or radius: its values are taken for weights, as is asked for",
            shown(path)
        );
        points.weights = points.values.take();
    }
    if options.radii == Some(Radii::None) && points.of_radii {
        (points.weights, points.of_radii) = (None, false);
    }
    if !known.reduces {
        options.reduce(path, &mut points)?;
    }
    Ok((points, metadata))
}

/// Reads a file of points to describe it, with all its columns, whatever its coordinates are. Of a scan they are described and
/// not kept.
///
/// # Errors
/// The errors of [`read_model`].
#[doc(hidden)]
pub fn describe_file(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    read_model_file(file, &options.describing(file))
}

/// Why a file is not read that has the name of a format, and begins as one of another kind does.
fn of_another_kind(known: &PointFormat, file: &OpenFile) -> Option<Reason> {
    if let Some(Packed { start, .. }) = Packed::of(file) {
        return if known.begins(&start) { None } else { other_kind(&start) };
    }
    if known.begins(file.start()) { None } else { other_kind(file.start()) }
}

/// Refuses settings that the format has no use for.
fn accept(format: &PointFormat, path: &Path, options: &PointOptions) -> Result<(), PointsError> {
    // Without its reader, the format says so itself.
    if !format.is_built_in() {
        return Ok(());
    }
    refuse_needless(format.chooses, path, options)
}

/// Refuses settings that are not among those that something is chosen by.
fn refuse_needless(
    chooses: &[Setting],
    path: &Path,
    options: &PointOptions,
) -> Result<(), PointsError> {
    let PointOptions { columns, level, frame, classes, withheld, radii, atoms, .. } = options;
    let of_atoms = if chooses.contains(&Setting::Waters) {
        "is in a format that does not state this"
    } else if chooses.contains(&Setting::Radii) {
        "is in a format whose atoms are all read"
    } else {
        "has no atoms"
    };
    for (setting, given, what) in [
        (Setting::Columns, columns.is_some(), "defines its own columns"),
        (Setting::Level, level.is_some(), "has no layers of points"),
        (Setting::Frame, frame.is_some(), "is in a format with a single frame"),
        (Setting::Class, classes.is_some(), "has no classes of points"),
        (Setting::Withheld, *withheld, "has no points that can be withheld"),
        (Setting::Radii, radii.as_ref().is_some_and(|radii| *radii != Radii::None), of_atoms),
        (Setting::Hydrogens, atoms.hydrogens, of_atoms),
        (Setting::Waters, atoms.waters, of_atoms),
        (Setting::Hetero, atoms.hetero, of_atoms),
        (Setting::Chains, atoms.chains.is_some(), of_atoms),
        (Setting::Models, atoms.models.is_some(), of_atoms),
    ] {
        if given && !chooses.contains(&setting) {
            return Err(format(path, Reason::needless(setting, what)));
        }
    }
    Ok(())
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
