use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value, json};
use walpha_base::advice::Advice;

use super::geographic::ToWgs84;
use super::planar::{self, Planar};
use super::{ExportOptions, Exporter, Needs, OutlineFeature};
use walpha_points::Crs;
use walpha_shape::{AlphaShape, Outline};

/// Writes `GeoJSON` (RFC 7946): a feature collection. Each polygon of an [outline](AlphaShape::outline) is a feature, its outer
/// ring counter-clockwise and holes clockwise, with α, area, perimeter and the unit of length as properties. Singular edges
/// (`MultiLineString`) and vertices (`MultiPoint`) are separate features, if there are any. The property `part` distinguishes the
/// features. Coordinates are longitude and latitude in WGS 84 if the options have a coordinate reference system with a known code
/// of EPSG; otherwise they are those of the points, with a z unless it is 0 everywhere.
#[derive(Clone, Debug, Default)]
pub struct GeoJson(pub ExportOptions);

/// Writes a collection of features, one for each outline: a `MultiPolygon` of all its polygons, or no geometry if it has none.
/// Coordinates are as in [`GeoJson`].
///
/// # Errors
/// Errors of `out`, and a shape without an outline that is not on a line.
pub(super) fn write_features(
    features: &[OutlineFeature<'_>],
    crs: Option<&Crs>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let places = Places::of(crs);
    let feature = |OutlineFeature { shape, properties }: &OutlineFeature<'_>| {
        let geometry = match Planar::of(shape) {
            Ok(planar) if !planar.outline.polygons.is_empty() => {
                let polygons = planar.outline.polygons.iter();
                let rings = polygons.map(|polygon| places.polygon(&planar, polygon));
                Some(Geometry::MultiPolygon(rings.collect()))
            }
            _ => None,
        };
        Feature { properties: properties.clone(), geometry }
    };
    collection(features.iter().map(feature).collect(), out)
}

impl GeoJson {
    /// Why coordinates are those of the points; `None` if they are longitude and latitude.
    pub(super) fn not_converted(crs: Option<&Crs>) -> Option<String> {
        let why = match crs {
            None => "their coordinate system is not known".to_owned(),
            Some(crs) => ToWgs84::of(crs).err()?,
        };
        Some(format!(
            "coordinates are those of the points, as {why}; programs take GeoJSON for longitude and latitude unless you \
             state the system there"
        ))
    }
}

impl Exporter for GeoJson {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let planar = Planar::of(shape)?;
        let places = Places::of(self.0.crs.as_ref());
        let Outline { polygons, edges, points, .. } = planar.outline;
        let properties = |value: Value| match value {
            Value::Object(properties) => properties,
            _ => Map::new(),
        };
        let mut features: Vec<Feature> = polygons
            .iter()
            .map(|polygon| Feature {
                properties: properties(json!({
                    "part": "polygon",
                    "alpha": shape.options().alpha,
                    "area": planar.area(polygon),
                    "perimeter": planar.perimeter(polygon),
                    "unit": shape.coordinates().unit,
                })),
                geometry: Some(Geometry::Polygon(places.polygon(&planar, polygon))),
            })
            .collect();
        let beside = |part: &str, geometry| Feature {
            properties: properties(json!({ "part": part })),
            geometry: Some(geometry),
        };
        if !edges.is_empty() {
            let edges = edges.iter().map(|edge| places.line(&planar.places(edge))).collect();
            features.push(beside("singular edges", Geometry::MultiLineString(edges)));
        }
        if !points.is_empty() {
            let points = Geometry::MultiPoint(places.line(&planar.places(points)));
            features.push(beside("singular vertices", points));
        }
        collection(features, out)
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        planar::remark(shape).or_else(|| Self::not_converted(self.0.crs.as_ref()).map(Into::into))
    }

    fn needs(&self) -> Needs {
        Needs::Facet
    }
}

fn collection(features: Vec<Feature>, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer(&mut *out, &FeatureCollection { features })?;
    writeln!(out)
}

/// How positions are written: converted, or as they are.
struct Places(Option<ToWgs84>);

impl Places {
    fn of(crs: Option<&Crs>) -> Self {
        Self(crs.and_then(|crs| ToWgs84::of(crs).ok()))
    }

    /// A position of two or three coordinates; converted ones have two, as the heights of RFC 7946 are above the ellipsoid.
    fn place(&self, place: &[f64]) -> Vec<f64> {
        let converted = self.0.as_ref().map(|conversion| conversion.place(place[0], place[1]));
        match converted {
            Some(converted) => converted.unwrap_or([f64::NAN; 2]).to_vec(),
            None => place.to_vec(),
        }
    }

    fn line(&self, places: &[&[f64]]) -> Vec<Vec<f64>> {
        places.iter().map(|place| self.place(place)).collect()
    }

    fn polygon(&self, planar: &Planar<'_>, polygon: &walpha_shape::Polygon) -> Vec<Vec<Vec<f64>>> {
        let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
        rings.map(|ring| self.line(&planar.ring(ring))).collect()
    }
}

#[derive(Serialize)]
#[serde(tag = "type")]
struct FeatureCollection {
    features: Vec<Feature>,
}

#[derive(Serialize)]
#[serde(tag = "type")]
struct Feature {
    properties: Map<String, Value>,
    geometry: Option<Geometry>,
}

/// x, y and perhaps z.
type Place = Vec<f64>;

#[derive(Serialize)]
#[serde(tag = "type", content = "coordinates")]
enum Geometry {
    Polygon(Vec<Vec<Place>>),
    MultiPolygon(Vec<Vec<Vec<Place>>>),
    MultiLineString(Vec<Vec<Place>>),
    MultiPoint(Vec<Place>),
}
