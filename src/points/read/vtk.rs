use std::path::Path;

use walpha_check::schema::ComplexFile;
use walpha_complex::{Alpha, Class};

use super::{CellCount, Points, PointsError, format, take_radii};
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
    let types = Grid::new(path, &file, piece)?.types()?;
    let mut counts: Vec<CellCount> = Vec::new();
    for kind in types.iter().map(|&kind| kind_of(kind)) {
        match counts.iter_mut().find(|cells| cells.kind == kind) {
            Some(cells) => cells.count += 1,
            None => counts.push(CellCount::new(kind, 1)),
        }
    }
    let are_points = counts.iter().all(|cells| cells.kind == kind_of(VERTEX));
    Ok(if are_points && stated_alpha(&file, dataset)?.is_none() { Vec::new() } else { counts })
}

/// Number of cells of each kind in a legacy file, without vertices.
pub(crate) fn cells_of_legacy(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let cells = VtkPoints::open(file)?.cells.into_iter();
    Ok(cells.map(|(kind, count)| CellCount::new(kind, count as usize)).collect())
}

/// Reads the simplices of a VTU file with its points and weights, and the classes and α if walpha wrote it.
/// Otherwise α is ∞, and all listed simplices are in the shape.
pub(crate) fn read_complex(file: &OpenFile) -> Result<ComplexFile, PointsError> {
    let path = file.path();
    let file = VtkXml::open(file)?;
    let points = points(path, &file)?;
    let (dataset, piece) = file.piece()?;
    if file.kind() != "UnstructuredGrid" {
        let reason = Reason::unsupported(
            "lists polygons, which cannot be read as a complex",
            "give an unstructured grid (.vtu), .json or .npz",
        );
        return Err(format(path, reason));
    }
    let stated = stated_alpha(&file, dataset)?;
    let grid = Grid::new(path, &file, piece)?;
    let types = grid.types()?;
    let ends = grid.array("offsets", grid.count)?;
    let corners = grid.array("connectivity", ends.last().copied().unwrap_or(0.0) as u64)?;
    let classes = stated.map(|_| grid.classes()).transpose()?.flatten();
    let mut file = ComplexFile::of_points(points.positions, stated.unwrap_or(Alpha::INFINITE));
    file.weights = points.weights;
    let (mut cells, mut facets, mut edges, mut vertices) =
        <(Vec<_>, Vec<_>, Vec<_>, Vec<_>)>::default();
    let mut by_kind = <[Vec<Class>; 4]>::default();
    let mut from = 0;
    for (row, (&kind, &end)) in types.iter().zip(&ends).enumerate() {
        let to = end as usize;
        let bad = |what: String| format(path, Reason::damaged(what));
        let found = corners.get(from..to).ok_or_else(|| {
            bad(format!("has offsets of cells that do not ascend, at cell {row}: it is damaged"))
        })?;
        let wanted = match kind {
            VERTEX => 1,
            LINE => 2,
            TRIANGLE => 3,
            TETRA => 4,
            _ => {
                let reason = Reason::unsupported(
                    format!("lists {}, which are not simplices", kind_of(kind)),
                    "cut them into tetrahedra and triangles",
                );
                return Err(format(path, reason));
            }
        };
        if found.len() != wanted {
            let kind = kind_of(kind);
            return Err(bad(format!(
                "has {} corners in cell {row}, one of its {kind}",
                found.len()
            )));
        }
        let number = |i: usize| {
            let corner = found[i];
            let is_whole = corner >= 0.0 && corner < f64::from(u32::MAX) && corner.fract() == 0.0;
            is_whole.then_some(corner as u32).ok_or_else(|| {
                bad(format!("has corner {corner} in cell {row}, which is not the index of a point"))
            })
        };
        match kind {
            VERTEX => vertices.push(number(0)?),
            LINE => edges.push([number(0)?, number(1)?]),
            TRIANGLE => facets.push([number(0)?, number(1)?, number(2)?]),
            _ => cells.push([number(0)?, number(1)?, number(2)?, number(3)?]),
        }
        if let Some(classes) = &classes {
            by_kind[wanted - 1].push(classes[row]);
        }
        from = to;
    }
    // With classes, an empty list means that there are no such simplices; without, they are derived as faces.
    fn listed<T>(rows: Vec<T>, all: bool) -> Option<Vec<T>> {
        (all || !rows.is_empty()).then_some(rows)
    }
    let all = classes.is_some();
    let [of_vertices, of_edges, of_facets, of_cells] = by_kind.map(|classes| listed(classes, all));
    (file.cells, file.facets) = (listed(cells, all), listed(facets, all));
    (file.edges, file.vertices) = (listed(edges, all), listed(vertices, all));
    (file.classes.cells, file.classes.facets) = (of_cells, of_facets);
    (file.classes.edges, file.classes.vertices) = (of_edges, of_vertices);
    Ok(file)
}

const VERTEX: u8 = 1;
const LINE: u8 = 3;
const TRIANGLE: u8 = 5;
const TETRA: u8 = 10;

/// The name of a cell type (VTK User's Guide, "Linear cell types in VTK").
fn kind_of(kind: u8) -> &'static str {
    match kind {
        VERTEX => "vertices",
        LINE => "edges",
        TRIANGLE => "triangles",
        TETRA => "tetrahedra",
        2 => "sets of vertices",
        4 => "polylines",
        6 => "strips",
        7 => "polygons",
        8 | 9 => "quadrilaterals",
        11 | 12 => "hexahedra",
        13 => "wedges",
        14 => "pyramids",
        _ => "cells of higher order",
    }
}

/// The α in the field data `alpha`, which walpha writes.
fn stated_alpha(file: &VtkXml, dataset: usize) -> Result<Option<Alpha>, PointsError> {
    let Some(fields) = file.children(dataset, "FieldData").next() else { return Ok(None) };
    let named = |&array: &usize| file.attribute(array, "Name") == Some("alpha");
    let Some(array) = file.children(fields, "DataArray").find(named) else { return Ok(None) };
    let alpha: Vec<f64> = file.values(array, 1)?;
    Ok(Alpha::from_squared(alpha[0]).ok())
}

/// The cells of an unstructured grid.
struct Grid<'a> {
    path: &'a Path,
    file: &'a VtkXml<'a>,
    piece: usize,
    count: u64,
}

impl<'a> Grid<'a> {
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
    fn classes(&self) -> Result<Option<Vec<Class>>, PointsError> {
        let file = self.file;
        let data = file.children(self.piece, "CellData").next();
        let named = |&array: &usize| file.attribute(array, "Name") == Some("class");
        let Some(array) = data.and_then(|data| file.children(data, "DataArray").find(named)) else {
            return Ok(None);
        };
        let numbers: Vec<f64> = file.values(array, self.count)?;
        let class = |number: f64| {
            let class =
                Class::from_number(number as u8).filter(|class| f64::from(*class as u8) == number);
            class.ok_or_else(|| {
                let reason = Reason::value(format!("has class {number}: classes are 0 to 3"));
                format(self.path, reason)
            })
        };
        numbers.into_iter().map(class).collect::<Result<_, _>>().map(Some)
    }
}
