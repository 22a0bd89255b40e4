use std::path::Path;

use walpha_base::shown::shown;
use walpha_check::meshes::{Grid, Mesh, MeshFormat};
use walpha_complex::Alpha;

use super::{CellCount, Points, PointsError, format, mesh_error, take_radii};
use crate::{Attributes, Column};
use walpha_volume::{OpenFile, Reason, VtkPoints, VtkXml};

/// The names of arrays that are not read as values, even if they are the active scalars.
const WEIGHT_NAMES: [&str; 2] = ["weight", "radius"];

/// The names of arrays that are not other columns.
const KNOWN_NAMES: [&str; 4] = ["weight", "radius", "value", GHOSTS];

/// Whether a file contains points and not a volume.
pub(crate) fn holds_points(file: &OpenFile) -> Result<bool, PointsError> {
    Ok(is_geometry(&VtkXml::open(file)?))
}

fn is_geometry(file: &VtkXml) -> bool {
    matches!(file.kind(), "UnstructuredGrid" | "PolyData")
}

/// Reads the points of VTU or VTP, VTK's unstructured grids and polygons in XML, with the point data `weight` (or `radius`) and
/// `value`, in any letter case. Without a `value`, the active scalars are read. Pieces follow each other; points that VTK marks
/// as hidden, or as copies of those in another piece, are left out.
///
/// Other arrays of one number for each point are kept as `attributes` say.
pub(crate) fn read(file: &OpenFile, attributes: &Attributes) -> Result<Points, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let mut all: Option<Points> = None;
    for piece in file.pieces()?.1 {
        let mut points = points(path, &file, piece, attributes)?;
        let ghosts = point_array(&file, piece, GHOSTS);
        let ghosts = ghosts.map(|array| file.values(array, points.len() as u64)).transpose()?;
        leave_out_ghosts(path, &mut points, ghosts);
        // An empty piece may lack arrays.
        match &mut all {
            Some(all) if !all.is_empty() => join(path, all, points)?,
            _ => all = Some(points),
        }
    }
    Ok(all.unwrap_or_default())
}

/// The name of the array of bytes whose bits mark points that are copies or hidden (vtkDataSetAttributes.h).
const GHOSTS: &str = "vtkGhostType";
const COPY_OR_HIDDEN: u8 = 3;

fn leave_out_ghosts(path: &Path, points: &mut Points, ghosts: Option<Vec<f64>>) {
    let Some(ghosts) = ghosts else { return };
    let kept: Vec<bool> = ghosts.iter().map(|&bits| bits as u8 & COPY_OR_HIDDEN == 0).collect();
    let left_out = kept.iter().filter(|kept| !**kept).count();
    if left_out > 0 {
        points.keep(&kept);
        tracing::warn!(
            "{}: {left_out} points are copies or hidden ({GHOSTS}), and left out",
            shown(path)
        );
    }
}

/// Adds the points of another piece, which must have the same data.
fn join(path: &Path, all: &mut Points, piece: Points) -> Result<(), PointsError> {
    if piece.is_empty() {
        return Ok(());
    }
    let columns = [(&mut all.weights, piece.weights), (&mut all.values, piece.values)];
    for (all, piece) in columns {
        match (all, piece) {
            (Some(all), Some(piece)) => all.extend(piece),
            (None, None) => {}
            _ => {
                let what = "has pieces with weights or values, and others without";
                let advice = "write it in one piece, or with the same data in each";
                return Err(format(path, Reason::content(what, advice)));
            }
        }
    }
    all.positions.extend(piece.positions);
    // Columns that a piece lacks are those of no point.
    all.columns.retain_mut(|column| {
        let other = piece.columns.iter().find(|other| other.name == column.name);
        column.values.extend(other.iter().flat_map(|other| &other.values));
        other.is_some()
    });
    Ok(())
}

/// The array with this name, in any letter case, and one number for each point.
fn point_array(file: &VtkXml, piece: usize, wanted: &str) -> Option<usize> {
    let data = file.children(piece, "PointData").next()?;
    let is_it = |&array: &usize| {
        let name = file.attribute(array, "Name").unwrap_or_default();
        name.eq_ignore_ascii_case(wanted) && file.components(array) == "1"
    };
    file.children(data, "DataArray").find(is_it)
}

fn points(
    path: &Path,
    file: &VtkXml,
    piece: usize,
    attributes: &Attributes,
) -> Result<Points, PointsError> {
    if !is_geometry(file) {
        let reason = Reason::unsupported(
            format!("holds {}: points are read from .vtu and .vtp", file.kind()),
            "convert it first",
        );
        return Err(format(path, reason));
    }
    let count = file
        .count(piece, "NumberOfPoints")
        .ok_or_else(|| format(path, Reason::header("has a Piece without a NumberOfPoints")))?;
    if count == 0 {
        return Ok(Points::default());
    }
    let places = file.children(piece, "Points").next();
    let places = places.and_then(|points| file.children(points, "DataArray").next());
    let Some(places) = places else {
        return Err(format(path, Reason::header("has no array of points")));
    };
    if file.components(places) != "3" {
        let components = file.components(places);
        return Err(format(
            path,
            Reason::header(format!("has points of {components} coordinates, not 3")),
        ));
    }
    let coordinates: Vec<f64> = file.values(places, count.saturating_mul(3))?;

    let data = file.children(piece, "PointData").next();
    let named = |wanted: &str| point_array(file, piece, wanted);
    let column = |array: Option<usize>| array.map(|array| file.values(array, count)).transpose();
    let active = data.and_then(|data| file.attribute(data, "Scalars"));
    let is_weight = |name: &&str| WEIGHT_NAMES.iter().any(|known| known.eq_ignore_ascii_case(name));
    let active = active.filter(|name| !is_weight(name));
    let mut points = Points {
        positions: coordinates.as_chunks().0.to_vec(),
        weights: column(named("weight"))?,
        values: column(named("value").or_else(|| named(active?)))?,
        ..Points::default()
    };
    take_radii(path, &mut points, column(named("radius"))?)?;
    let arrays = data.into_iter().flat_map(|data| file.children(data, "DataArray"));
    for array in arrays.filter(|&array| file.components(array) == "1") {
        let name = file.attribute(array, "Name").unwrap_or_default();
        let is_known = KNOWN_NAMES.iter().any(|known| known.eq_ignore_ascii_case(name));
        let is_there = points.columns.iter().any(|column| column.name == name);
        if !name.is_empty() && !is_known && !is_there && attributes.keeps(name) {
            let values = file.values(array, count)?;
            points.columns.push(Column { name: name.to_owned(), values });
        }
    }
    Ok(points)
}

/// Reads the points of a legacy VTK file, with the point data that [`read`] takes.
pub(crate) fn read_legacy(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let file = VtkPoints::open(file)?;
    let ghosts = file.named(GHOSTS)?;
    let mut points = Points {
        positions: file.coordinates()?.as_chunks().0.to_vec(),
        weights: file.named("weight")?,
        values: match file.named("value")? {
            Some(values) => Some(values),
            None => file.active(&WEIGHT_NAMES)?,
        },
        ..Points::default()
    };
    take_radii(path, &mut points, file.named("radius")?)?;
    leave_out_ghosts(path, &mut points, ghosts);
    Ok(points)
}

/// The number of cells of each kind in a VTU or VTP file. If all are vertices and no α is stated, the file is a list of points
/// without cells.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let (dataset, pieces) = file.pieces()?;
    if file.kind() == "PolyData" {
        let count = |(attribute, kind): (&str, &'static str)| {
            let counts = pieces.iter().filter_map(|&piece| file.count(piece, attribute));
            CellCount::new(kind, counts.sum::<u64>() as usize)
        };
        let kinds = [
            ("NumberOfPolys", "polygons"),
            ("NumberOfStrips", "strips"),
            ("NumberOfLines", "lines"),
        ];
        return Ok(kinds.into_iter().map(count).collect());
    }
    let mut types = Vec::new();
    for piece in pieces {
        types.extend(Cells::new(path, &file, piece)?.types()?);
    }
    let mut counts: Vec<CellCount> = Vec::new();
    for kind in types.iter().map(|&kind| Grid::kind_of(kind)) {
        match counts.iter_mut().find(|cells| cells.kind == kind) {
            Some(cells) => cells.count += 1,
            None => counts.push(CellCount::new(kind, 1)),
        }
    }
    let are_points = counts.iter().all(|cells| cells.kind == Grid::kind_of(VERTEX));
    Ok(if are_points && stated_alpha(&file, dataset)?.is_none() { Vec::new() } else { counts })
}

/// The number of cells of each kind in a legacy file, without vertices.
pub(crate) fn cells_of_legacy(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let cells = VtkPoints::open(file)?.cells.into_iter();
    Ok(cells.map(|(kind, count)| CellCount::new(kind, count as usize)).collect())
}

/// Reads the simplices of a VTU file with its points and weights, and the classes and α if walpha wrote it. In another grid only
/// the tetrahedra are read, if it has some, and α is ∞.
pub(crate) fn read_complex(file: &OpenFile) -> Result<Mesh, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let (dataset, piece) = file.piece()?;
    let Points { positions: points, weights, .. } = points(path, &file, piece, &Attributes::None)?;
    if file.kind() != "UnstructuredGrid" {
        let reason = Reason::unsupported(
            "lists polygons, which cannot be read as a complex",
            "give an unstructured grid (.vtu), .json or .npz",
        );
        return Err(format(path, reason));
    }
    // Of these, JSON and NPZ say all that a judgement needs.
    let kinds = [("solid", "a solid without α"), ("periodic", "the shape of a periodic box")];
    for (name, what) in kinds {
        if file.field_text(dataset, name)?.is_some() {
            let reason = Reason::unsupported(
                format!("lists the simplices of {what}, which cannot be read as a complex"),
                "write it as .json or .npz",
            );
            return Err(format(path, reason));
        }
    }
    let alpha = stated_alpha(&file, dataset)?;
    let cells = Cells::new(path, &file, piece)?;
    let (types, ends) = (cells.types()?, cells.array("offsets", cells.count)?);
    let corners = cells.array("connectivity", ends.last().copied().unwrap_or(0.0) as u64)?;
    let classes = alpha.map(|_| cells.classes()).transpose()?.flatten();
    let grid = Grid { points, weights, types, ends, corners, alpha, classes };
    grid.mesh().map_err(|error| mesh_error(path, &error))
}

/// Reads the simplices of a legacy VTK file, as [`read_complex`] does those of a VTU file.
pub(crate) fn read_legacy_complex(file: &OpenFile) -> Result<Mesh, PointsError> {
    let format = MeshFormat::named("vtk").expect("VTK is a format of meshes");
    format.read_bytes(file.path(), &file.bytes()?).map_err(|error| mesh_error(file.path(), &error))
}

/// VTK's code for single points.
const VERTEX: u8 = 1;

/// The α in the field data `alpha`, which walpha writes.
fn stated_alpha(file: &VtkXml, dataset: usize) -> Result<Option<Alpha>, PointsError> {
    let Some(fields) = file.children(dataset, "FieldData").next() else { return Ok(None) };
    let named = |&array: &usize| file.attribute(array, "Name") == Some("alpha");
    let Some(array) = file.children(fields, "DataArray").find(named) else { return Ok(None) };
    let alpha: Vec<f64> = file.values(array, 1)?;
    Ok(Alpha::from_squared(alpha[0]).ok())
}

/// The cells of an unstructured grid.
struct Cells<'a> {
    path: &'a Path,
    file: &'a VtkXml<'a>,
    piece: usize,
    count: u64,
}

impl<'a> Cells<'a> {
    fn new(path: &'a Path, file: &'a VtkXml<'a>, piece: usize) -> Result<Self, PointsError> {
        match file.count(piece, "NumberOfCells") {
            Some(count) => Ok(Self { path, file, piece, count }),
            None => Err(format(path, Reason::header("has a Piece without a NumberOfCells"))),
        }
    }

    fn types(&self) -> Result<Vec<u8>, PointsError> {
        Ok(self.array("types", self.count)?.into_iter().map(|kind| kind as u8).collect())
    }

    /// An array of the element `Cells`.
    fn array(&self, name: &str, count: u64) -> Result<Vec<f64>, PointsError> {
        if self.count == 0 {
            return Ok(Vec::new());
        }
        let file = self.file;
        let cells = file.children(self.piece, "Cells").next();
        let named = |&array: &usize| file.attribute(array, "Name") == Some(name);
        let array = cells.and_then(|cells| file.children(cells, "DataArray").find(named));
        let array = array.ok_or_else(|| {
            format(self.path, Reason::header(format!("has no array {name} of its cells")))
        })?;
        Ok(file.values(array, count)?)
    }

    /// The cell data `class`.
    fn classes(&self) -> Result<Option<Vec<f64>>, PointsError> {
        let file = self.file;
        let data = file.children(self.piece, "CellData").next();
        let named = |&array: &usize| file.attribute(array, "Name") == Some("class");
        let array = data.and_then(|data| file.children(data, "DataArray").find(named));
        Ok(array.map(|array| file.values(array, self.count)).transpose()?)
    }
}
