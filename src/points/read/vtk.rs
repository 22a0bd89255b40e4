use std::path::Path;

use super::{Points, PointsError, format};
use crate::volume::{Reason, VtkXml};

/// Whether a file holds points and not a volume.
pub(crate) fn holds_points(path: &Path) -> Result<bool, PointsError> {
    Ok(is_geometry(&VtkXml::open(path)?))
}

fn is_geometry(file: &VtkXml) -> bool {
    matches!(file.kind(), "UnstructuredGrid" | "PolyData")
}

/// Reads the points of VTU or VTP, VTK's unstructured grids and polygons in XML, in one piece, with
/// the point data `weight` and `value`, in any case; where none is named value, the active scalars.
pub(crate) fn read(path: &Path) -> Result<Points, PointsError> {
    let file = VtkXml::open(path)?;
    if !is_geometry(&file) {
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
    let active = active.filter(|name| !name.eq_ignore_ascii_case("weight"));
    Ok(Points {
        positions: coordinates.as_chunks().0.to_vec(),
        weights: column(named("weight"))?,
        values: column(named("value").or_else(|| named(active?)))?,
        differences: None,
    })
}
