use std::io::{self, Write};

use serde_json::{Map, Value};

use super::GeoJson;
use super::geojson;
#[cfg(all(feature = "las", not(target_family = "wasm")))]
use super::geopackage;
use walpha_points::Crs;
use walpha_shape::AlphaShape;

/// An outline to write as one feature: its shape, whose points lie in a plane, and properties in their order.
#[derive(Clone, Debug)]
pub struct OutlineFeature<'a> {
    /// The shape.
    pub shape: &'a AlphaShape,
    /// The properties of the feature.
    pub properties: Map<String, Value>,
}

/// A format that holds a feature for each of several outlines: a `MultiPolygon` of all its polygons, or no geometry if it has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureFormat {
    /// A feature collection, with coordinates as in [`GeoJson`].
    GeoJson,
    /// A layer `outlines`, with the coordinates of the points, and properties as columns.
    #[cfg(all(feature = "las", not(target_family = "wasm")))]
    GeoPackage,
}

impl FeatureFormat {
    /// The format with this extension, which has no dot and is in lower case.
    pub fn of(extension: &str) -> Option<Self> {
        match extension {
            "geojson" => Some(Self::GeoJson),
            #[cfg(all(feature = "las", not(target_family = "wasm")))]
            "gpkg" => Some(Self::GeoPackage),
            _ => None,
        }
    }

    /// Writes features in this coordinate reference system, as far as it is known.
    ///
    /// # Errors
    /// Errors of `out`, and a shape without an outline that is not on a line.
    pub fn write(
        self,
        features: &[OutlineFeature<'_>],
        crs: Option<&Crs>,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        match self {
            Self::GeoJson => geojson::write_features(features, crs, out),
            #[cfg(all(feature = "las", not(target_family = "wasm")))]
            Self::GeoPackage => geopackage::write_features(features, crs, out),
        }
    }

    /// What users should know of a file in this coordinate reference system, if it is not placed on the Earth.
    pub fn remark(self, crs: Option<&Crs>) -> Option<String> {
        match self {
            Self::GeoJson => GeoJson::not_converted(crs),
            #[cfg(all(feature = "las", not(target_family = "wasm")))]
            Self::GeoPackage => super::GeoPackage::not_stated(crs).map(str::to_owned),
        }
    }
}
