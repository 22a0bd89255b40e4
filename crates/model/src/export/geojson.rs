use std::io::{self, Write};

use serde::Serialize;
use walpha_base::advice::Advice;

use super::planar::{self, Planar};
use super::{Exporter, Needs};
use walpha_shape::{Alpha, AlphaShape};
use walpha_volume::LengthUnit;

/// Writes `GeoJSON` (RFC 7946): a feature collection. Its first feature is the polygons of an [outline](AlphaShape::outline) as
/// one `MultiPolygon`, outer rings counter-clockwise and holes clockwise, with α, area, perimeter and the unit of length as
/// properties. Singular edges (`MultiLineString`) and vertices (`MultiPoint`) are separate features, if there are any. The
/// property `part` distinguishes the features. Coordinates are those of the points, even though RFC 7946 requires longitude and
/// latitude, and have a z unless it is 0 everywhere.
#[derive(Clone, Copy, Debug)]
pub struct GeoJson;

impl Exporter for GeoJson {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let planar = Planar::of(shape)?;
        let outline = &planar.outline;
        let polygons = outline.polygons.iter().map(|polygon| {
            let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
            rings.map(|ring| planar.ring(ring)).collect()
        });
        let polygons = Feature {
            properties: Properties {
                part: "polygons",
                size: Some(Size {
                    alpha: shape.options().alpha,
                    area: outline.area,
                    perimeter: outline.perimeter,
                    unit: shape.coordinates().unit,
                }),
            },
            geometry: Geometry::MultiPolygon(polygons.collect()),
        };
        let beside =
            |part, geometry| Feature { properties: Properties { part, size: None }, geometry };
        let mut features = vec![polygons];
        if !outline.edges.is_empty() {
            let edges = outline.edges.iter().map(|edge| planar.places(edge)).collect();
            features.push(beside("singular edges", Geometry::MultiLineString(edges)));
        }
        if !outline.points.is_empty() {
            let points = Geometry::MultiPoint(planar.places(&outline.points));
            features.push(beside("singular vertices", points));
        }
        serde_json::to_writer(&mut *out, &FeatureCollection { features })?;
        writeln!(out)
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        planar::remark(shape)
    }

    fn needs(&self) -> Needs {
        Needs::Facet
    }
}

#[derive(Serialize)]
#[serde(tag = "type")]
struct FeatureCollection<'a> {
    features: Vec<Feature<'a>>,
}

#[derive(Serialize)]
#[serde(tag = "type")]
struct Feature<'a> {
    properties: Properties,
    geometry: Geometry<'a>,
}

#[derive(Serialize)]
struct Properties {
    part: &'static str,
    #[serde(flatten)]
    size: Option<Size>,
}

#[derive(Serialize)]
struct Size {
    /// α as a squared length.
    alpha: Alpha,
    area: f64,
    perimeter: f64,
    unit: LengthUnit,
}

/// A position: x, y and perhaps z.
type Place<'a> = &'a [f64];

#[derive(Serialize)]
#[serde(tag = "type", content = "coordinates")]
#[expect(clippy::enum_variant_names, reason = "these are the names of the format")]
enum Geometry<'a> {
    MultiPolygon(Vec<Vec<Vec<Place<'a>>>>),
    MultiLineString(Vec<Vec<Place<'a>>>),
    MultiPoint(Vec<Place<'a>>),
}
