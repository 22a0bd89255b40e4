use std::path::Path;

use walpha_check::meshes::{Grid, Mesh, MeshFormat};
use walpha_complex::Alpha;

use super::{CellCount, Points, PointsError, format, mesh_error, take_radii};
use crate::volume::{OpenFile, Reason, VtkPoints, VtkXml};

/// Names of arrays that are not read as values, even if they are the active scalars.
const WEIGHT_NAMES: [&str; 2] = ["weight", "radius"];

/// Whether a file holds points rather than a volume.
pub(crate) fn holds_points(file: &OpenFile) -> Result<bool, PointsError> {
    Ok(is_geometry(&VtkXml::open(file)?))
}

fn is_geometry(file: &VtkXml) -> bool {
    matches!(file.kind(), "UnstructuredGrid" | "PolyData")
}

/// Reads the points of VTU or VTP, VTK's unstructured grids and polygons in XML, in one piece, with the point
/// data `weight` (or `radius`) and `value`, in any letter case. Without a `value`, the active scalars are read.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    points(file.path(), &VtkXml::open(file)?)
}

fn points(path: &Path, file: &VtkXml) -> Result<Points, PointsError> {
    if !is_geometry(file) {
        let reason = Reason::unsupported(
            format!("holds {}: points are read from .vtu and .vtp", file.kind()),
            "convert it first",
        );
        return Err(format(path, reason));
    }
    let (_, piece) = file.piece()?;
    let count = file.attribute(piece, "NumberOfPoints").and_then(|text| text.parse::<u64>().ok());
    let count = count
        .ok_or_else(|| format(path, Reason::damaged("has no NumberOfPoints: it is damaged")))?;
    let places = file.children(piece, "Points").next();
    let places = places.and_then(|points| file.children(points, "DataArray").next());
    let Some(places) = places else {
        return Err(format(path, Reason::damaged("has no array of points: it is damaged")));
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
    let named = |wanted: &str| {
        let is_named = |&array: &usize| {
            let name = file.attribute(array, "Name").unwrap_or_default();
            name.eq_ignore_ascii_case(wanted) && file.components(array) == "1"
        };
        file.children(data?, "DataArray").find(is_named)
    };
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
    Ok(points)
}

/// Reads the points of a legacy VTK file, with the same point data.
pub(crate) fn read_legacy(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let file = VtkPoints::open(file)?;
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
    Ok(points)
}

/// Number of cells of each kind in a VTU or VTP file. If all are vertices and no α is stated, the file is a list
/// of points and has none.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let (dataset, piece) = file.piece()?;
    if file.kind() == "PolyData" {
        let count = |(attribute, kind): (&str, &'static str)| {
            let count = file.attribute(piece, attribute).and_then(|text| text.parse().ok());
            CellCount::new(kind, count.unwrap_or_default())
        };
        let kinds = [
            ("NumberOfPolys", "polygons"),
            ("NumberOfStrips", "strips"),
            ("NumberOfLines", "lines"),
        ];
        return Ok(kinds.into_iter().map(count).collect());
    }
    let types = Cells::new(path, &file, piece)?.types()?;
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

/// Number of cells of each kind in a legacy file, without vertices.
pub(crate) fn cells_of_legacy(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let cells = VtkPoints::open(file)?.cells.into_iter();
    Ok(cells.map(|(kind, count)| CellCount::new(kind, count as usize)).collect())
}

/// Reads the simplices of a VTU file with its points and weights, and the classes and α if walpha wrote it. Of
/// another grid only the tetrahedra are read, if it has some, and α is ∞.
pub(crate) fn read_complex(file: &OpenFile) -> Result<Mesh, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let Points { positions: points, weights, .. } = points(path, &file)?;
    let (dataset, piece) = file.piece()?;
    if file.kind() != "UnstructuredGrid" {
        let reason = Reason::unsupported(
            "lists polygons, which cannot be read as a complex",
            "give an unstructured grid (.vtu), .json or .npz",
        );
        return Err(format(path, reason));
    }
    let alpha = stated_alpha(&file, dataset)?;
    let cells = Cells::new(path, &file, piece)?;
    let (types, ends) = (cells.types()?, cells.array("offsets", cells.count)?);
    let corners = cells.array("connectivity", ends.last().copied().unwrap_or(0.0) as u64)?;
    let classes = alpha.map(|_| cells.classes()).transpose()?.flatten();
    let grid = Grid { points, weights, types, ends, corners, alpha, classes };
    grid.mesh().map_err(|error| mesh_error(path, &error))
}

/// Reads the simplices of a legacy VTK file in the same way.
pub(crate) fn read_legacy_complex(file: &OpenFile) -> Result<Mesh, PointsError> {
    let format = MeshFormat::named("vtk").expect("VTK is a format of meshes");
    format.read_bytes(file.path(), &file.bytes()?).map_err(|error| mesh_error(file.path(), &error))
}

/// VTK's type of single points.
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
        let count = file.attribute(piece, "NumberOfCells").and_then(|text| text.parse().ok());
        match count {
            Some(count) => Ok(Self { path, file, piece, count }),
            None => Err(format(path, Reason::damaged("has no NumberOfCells: it is damaged"))),
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
            format(self.path, Reason::damaged(format!("has no array {name} of its cells")))
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
