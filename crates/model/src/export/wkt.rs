use std::io::{self, Write};

use walpha_base::advice::Advice;

use super::planar::{self, Planar};
use super::{Exporter, Needs};
use walpha_shape::AlphaShape;

/// Writes well-known text (OGC Simple Features, ISO 19125-1): the polygons of an [outline](AlphaShape::outline) as one
/// `MULTIPOLYGON`, outer rings counter-clockwise and holes clockwise. If there are singular edges or vertices, it is part of a
/// `GEOMETRYCOLLECTION` with a `MULTILINESTRING` and a `MULTIPOINT`. Geometries have ` Z` unless z is 0 everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Wkt;

impl Exporter for Wkt {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let planar = Planar::of(shape)?;
        let outline = &planar.outline;
        let z = if planar.has_z() { " Z" } else { "" };
        let polygons = outline.polygons.iter().map(|polygon| {
            let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
            listed(rings.map(|ring| line(&planar.ring(ring))))
        });
        let edges = outline.edges.iter().map(|edge| line(&planar.places(edge)));
        let points = outline.points.iter().map(|&v| line(&[planar.place(v)]));
        let geometries = [
            ("MULTIPOLYGON", polygons.collect::<Vec<_>>()),
            ("MULTILINESTRING", edges.collect()),
            ("MULTIPOINT", points.collect()),
        ];
        let geometries: Vec<String> = (geometries.into_iter())
            .filter(|(_, members)| !members.is_empty())
            .map(|(name, members)| format!("{name}{z} {}", listed(members)))
            .collect();
        match &geometries[..] {
            [] => writeln!(out, "MULTIPOLYGON EMPTY"),
            [alone] => writeln!(out, "{alone}"),
            several => writeln!(out, "GEOMETRYCOLLECTION{z} ({})", several.join(", ")),
        }
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        planar::remark(shape)
    }

    fn needs(&self) -> Needs {
        Needs::Facet
    }
}

/// Joins texts in parentheses.
fn listed(texts: impl IntoIterator<Item = String>) -> String {
    format!("({})", texts.into_iter().collect::<Vec<_>>().join(", "))
}

/// Joins positions in parentheses.
fn line(places: &[&[f64]]) -> String {
    let place = |place: &&[f64]| place.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    listed(places.iter().map(place))
}
