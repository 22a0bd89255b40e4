//! The part of a report on points in a plane.

use std::fmt;

use serde::Serialize;
use walpha_base::shown::counted;

use super::measure;
use super::parts::{Line, loose};
use crate::shape::ByClass;
use crate::{AlphaShape, LengthUnit};

/// The shape of points in a plane, as a region of that plane.
#[derive(Serialize)]
pub(super) struct PlaneReport {
    /// The numbers of simplices by their classes in the plane.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    facets: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    edges: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    vertices: ByClass<usize>,
    polygons: usize,
    holes: usize,
    area: f64,
    /// The length of all rings.
    perimeter: f64,
}

impl PlaneReport {
    /// The report on a shape; `None` unless its points lie in one plane, but not on one line.
    pub(super) fn of(shape: &AlphaShape) -> Option<Self> {
        let outline = shape.outline().ok()?;
        Some(Self {
            facets: outline.complex.facets.counts(),
            edges: outline.complex.edges.counts(),
            vertices: outline.complex.vertices.counts(),
            polygons: outline.polygons.len(),
            holes: outline.holes(),
            area: outline.area,
            perimeter: outline.perimeter,
        })
    }

    /// Prints the numbers of simplices.
    pub(super) fn print_classes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "plane     all points lie in one; simplices have the classes of the plane")?;
        writeln!(f, "facets    {}", Line(&self.facets))?;
        writeln!(f, "edges     {}", Line(&self.edges))?;
        writeln!(f, "vertices  {}", Line(&self.vertices))
    }

    /// The outline and its sizes, in words.
    pub(super) fn sizes(&self, unit: LengthUnit) -> String {
        let Self { polygons, holes, area, perimeter, .. } = self;
        let (polygons, holes) =
            (counted(*polygons as u64, "polygon"), counted(*holes as u64, "hole"));
        let (area, perimeter) = (measure(*area, unit, 2), measure(*perimeter, unit, 1));
        format!("{polygons} with {holes}, area {area}, perimeter {perimeter}")
    }

    /// The edges and vertices that hang loose, in words.
    pub(super) fn loose(&self) -> Option<String> {
        loose([0, self.edges.singular, self.vertices.singular], "")
    }
}
