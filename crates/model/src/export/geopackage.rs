//! `GeoPackage` (OGC 12-128r19): outlines in a database of `SQLite`, in the coordinate system of the points.

use std::fmt::Write as _;
use std::io::{self, Write};

use rusqlite::types::Value as Stored;
use rusqlite::{Connection, MAIN_DB, params, params_from_iter};
use serde_json::Value;
use walpha_base::advice::Advice;

use super::planar::{self, Planar};
use super::{ExportOptions, Exporter, Needs, OutlineFeature};
use walpha_points::Crs;
use walpha_shape::{AlphaShape, Outline, Polygon};

/// Writes a `GeoPackage`: a layer `polygons` with a feature for each polygon of an [outline](AlphaShape::outline) and α, area,
/// perimeter and the unit of length as columns; singular edges and vertices are layers of their own, if there are any. Coordinates
/// are those of the points, in the coordinate reference system of the options.
#[derive(Clone, Debug, Default)]
pub struct GeoPackage(pub ExportOptions);

/// Writes a `GeoPackage` with a layer `outlines`: a feature for each outline, a `MultiPolygon` of all its polygons, or no geometry
/// if it has none, with the properties as columns.
///
/// # Errors
/// Errors of `out`; too large a file for `SQLite` in memory.
pub(super) fn write_features(
    features: &[OutlineFeature<'_>],
    crs: Option<&Crs>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let outlines: Vec<_> = features.iter().map(|feature| Planar::of(feature.shape).ok()).collect();
    let has_z = outlines.iter().flatten().any(Planar::has_z);
    let mut layer = Layer::new("outlines", Kind::MultiPolygon, has_z);
    for (feature, planar) in features.iter().zip(&outlines) {
        let geometry = planar.as_ref().filter(|planar| !planar.outline.polygons.is_empty());
        let geometry = geometry.map(|planar| {
            let mut geometry = layer.geometry();
            geometry.count(planar.outline.polygons.len());
            for polygon in &planar.outline.polygons {
                geometry.begin(Kind::Polygon);
                geometry.polygon(planar, polygon);
            }
            geometry
        });
        let properties = feature.properties.iter();
        layer
            .add(geometry, properties.map(|(name, value)| (name.clone(), value.clone())).collect());
    }
    write(&[layer], crs, out)
}

impl GeoPackage {
    /// Why the coordinate system is not stated; `None` if it is.
    pub(super) fn not_stated(crs: Option<&Crs>) -> Option<&'static str> {
        (System::of(crs).id == System::UNKNOWN).then_some(
            "the coordinate system of the points is not known, so the file states none: tell your program which it is",
        )
    }
}

impl Exporter for GeoPackage {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let planar = Planar::of(shape)?;
        let Outline { polygons, edges, points, .. } = planar.outline;
        let layer = |name, kind| Layer::new(name, kind, planar.has_z());
        let mut layers = vec![layer("polygons", Kind::Polygon)];
        for polygon in polygons {
            let mut geometry = layers[0].geometry();
            geometry.polygon(&planar, polygon);
            let column = |name: &str, value: Value| (name.to_owned(), value);
            let columns = vec![
                column("alpha", serde_json::to_value(shape.options().alpha)?),
                column("area", planar.area(polygon).into()),
                column("perimeter", planar.perimeter(polygon).into()),
                column("unit", serde_json::to_value(shape.coordinates().unit)?),
            ];
            layers[0].add(Some(geometry), columns);
        }
        let mut beside = |name, kind, parts: &[Vec<&[f64]>], of| {
            if !parts.is_empty() {
                let mut layer = layer(name, kind);
                let mut geometry = layer.geometry();
                geometry.count(parts.len());
                for part in parts {
                    geometry.begin(of);
                    geometry.places(part, of == Kind::Line);
                }
                layer.add(Some(geometry), Vec::new());
                layers.push(layer);
            }
        };
        let edges: Vec<_> = edges.iter().map(|edge| planar.places(edge)).collect();
        beside("singular_edges", Kind::MultiLine, &edges, Kind::Line);
        let points: Vec<_> = points.iter().map(|&point| vec![planar.place(point)]).collect();
        beside("singular_vertices", Kind::MultiPoint, &points, Kind::Point);
        write(&layers, self.0.crs.as_ref(), out)
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        planar::remark(shape).or_else(|| Self::not_stated(self.0.crs.as_ref()).map(Into::into))
    }

    fn needs(&self) -> Needs {
        Needs::Facet
    }
}

/// The kinds of geometries, by their numbers in well-known binary.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Point = 1,
    Line = 2,
    Polygon = 3,
    MultiPoint = 4,
    MultiLine = 5,
    MultiPolygon = 6,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Point => "POINT",
            Self::Line => "LINESTRING",
            Self::Polygon => "POLYGON",
            Self::MultiPoint => "MULTIPOINT",
            Self::MultiLine => "MULTILINESTRING",
            Self::MultiPolygon => "MULTIPOLYGON",
        }
    }
}

/// A geometry in well-known binary, and its box in x and y.
struct Geometry {
    bytes: Vec<u8>,
    has_z: bool,
    low: [f64; 2],
    high: [f64; 2],
}

impl Geometry {
    /// Begins a geometry, or a part of one.
    fn begin(&mut self, kind: Kind) {
        const LITTLE_ENDIAN: u8 = 1;
        const WITH_Z: u32 = 1000;
        self.bytes.push(LITTLE_ENDIAN);
        let number = kind as u32 + if self.has_z { WITH_Z } else { 0 };
        self.bytes.extend(number.to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        self.bytes.extend((count as u32).to_le_bytes());
    }

    /// Adds positions, after their number if they are counted.
    fn places(&mut self, places: &[&[f64]], is_counted: bool) {
        if is_counted {
            self.count(places.len());
        }
        for place in places {
            for axis in 0..2 {
                self.low[axis] = self.low[axis].min(place[axis]);
                self.high[axis] = self.high[axis].max(place[axis]);
            }
            let z = self.has_z.then(|| place.get(2).copied().unwrap_or_default());
            let numbers = place[..2].iter().copied().chain(z);
            numbers.for_each(|number| self.bytes.extend(number.to_le_bytes()));
        }
    }

    fn polygon(&mut self, planar: &Planar<'_>, polygon: &Polygon) {
        self.count(1 + polygon.holes.len());
        let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
        rings.for_each(|ring| self.places(&planar.ring(ring), true));
    }

    /// The geometry as it is stored: a header with the system and the box, and well-known binary.
    fn stored(&self, system: i32) -> Vec<u8> {
        const VERSION: u8 = 0;
        /// Numbers are little-endian, and the box has x and y.
        const FLAGS: u8 = 0b11;
        let [[x, y], [x2, y2]] = [self.low, self.high];
        let ends = [x, x2, y, y2].map(f64::to_le_bytes).concat();
        [&[b'G', b'P', VERSION, FLAGS][..], &system.to_le_bytes(), &ends, &self.bytes].concat()
    }
}

/// A feature: its geometry, if it has one, and its properties by name.
type Row = (Option<Geometry>, Vec<(String, Value)>);

/// A table of features.
struct Layer {
    name: &'static str,
    kind: Kind,
    has_z: bool,
    rows: Vec<Row>,
}

impl Layer {
    fn new(name: &'static str, kind: Kind, has_z: bool) -> Self {
        Self { name, kind, has_z, rows: Vec::new() }
    }

    /// A geometry of the layer's kind, to be filled.
    fn geometry(&self) -> Geometry {
        let [low, high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let mut geometry = Geometry { bytes: Vec::new(), has_z: self.has_z, low, high };
        geometry.begin(self.kind);
        geometry
    }

    fn add(&mut self, geometry: Option<Geometry>, properties: Vec<(String, Value)>) {
        self.rows.push((geometry, properties));
    }

    /// Writes the table and what describes it.
    fn store(&self, file: &Connection, system: i32) -> rusqlite::Result<()> {
        let Self { name, kind, has_z, rows } = self;
        let first = rows.first().map_or(&[][..], |(_, properties)| properties);
        let mut names: Vec<String> = vec!["fid".into(), "geom".into()];
        for (name, _) in first {
            let mut own = name.clone();
            // Names of columns are the same in any letter case.
            while names.iter().any(|known| known.eq_ignore_ascii_case(&own)) {
                own.push('_');
            }
            names.push(own);
        }
        let quoted: Vec<String> =
            names.iter().map(|name| format!("\"{}\"", name.replace('"', "\"\""))).collect();
        let mut columns = String::new();
        for (k, name) in quoted.iter().skip(2).enumerate() {
            let mut values = rows.iter().map(|(_, properties)| &properties[k].1);
            let _ = write!(columns, ", {name} {}", type_of(&mut values));
        }
        file.execute_batch(&format!(
            "CREATE TABLE {name} (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom {}{columns})",
            kind.name()
        ))?;
        let places = vec!["?"; quoted.len() - 1].join(", ");
        let insert = format!("INSERT INTO {name} ({}) VALUES ({places})", quoted[1..].join(", "));
        let mut insert = file.prepare(&insert)?;
        let mut ends: Option<[f64; 4]> = None;
        for (geometry, properties) in rows {
            let blob = match geometry {
                Some(geometry) => Stored::Blob(geometry.stored(system)),
                None => Stored::Null,
            };
            if let Some(Geometry { low, high, .. }) = geometry {
                let [x, y, x2, y2] = ends.unwrap_or([low[0], low[1], high[0], high[1]]);
                ends = Some([x.min(low[0]), y.min(low[1]), x2.max(high[0]), y2.max(high[1])]);
            }
            let values = properties.iter().map(|(_, value)| stored(value));
            insert.execute(params_from_iter([blob].into_iter().chain(values)))?;
        }
        let [x, y, x2, y2] = ends.map_or([None; 4], |ends| ends.map(Some));
        file.execute(
            "INSERT INTO gpkg_contents VALUES (?, 'features', ?, '', ?, ?, ?, ?, ?, ?)",
            params![name, name, LAST_CHANGE, x, y, x2, y2, system],
        )?;
        file.execute(
            "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, ?, 0)",
            params![name, kind.name(), system, i32::from(*has_z)],
        )?;
        Ok(())
    }
}

/// The type of a column with these values.
fn type_of(values: &mut dyn Iterator<Item = &Value>) -> &'static str {
    let known = values.filter(|value| !value.is_null());
    let kinds: Vec<_> = known.map(|value| (value.is_i64(), value.is_number())).collect();
    match &kinds[..] {
        all if all.iter().all(|(is_whole, _)| *is_whole) => "INTEGER",
        all if all.iter().all(|(_, is_number)| *is_number) => "REAL",
        _ => "TEXT",
    }
}

fn stored(value: &Value) -> Stored {
    match value {
        Value::Null => Stored::Null,
        Value::String(text) => Stored::Text(text.clone()),
        value => match (value.as_i64(), value.as_f64()) {
            (Some(whole), _) => Stored::Integer(whole),
            (None, Some(number)) => Stored::Real(number),
            (None, None) => Stored::Text(value.to_string()),
        },
    }
}

/// A coordinate reference system as `GeoPackage` has it.
struct System<'a> {
    id: i32,
    name: String,
    organization: &'static str,
    definition: &'a str,
}

impl<'a> System<'a> {
    /// The numbers of a system of lengths that is not known, and of one that only its text states.
    const UNKNOWN: i32 = -1;
    const OWN: i32 = 100_000;

    fn of(crs: Option<&'a Crs>) -> Self {
        let definition = crs.and_then(Crs::well_known_text);
        match (crs, crs.and_then(|crs| crs.epsg), definition) {
            (Some(crs), Some(epsg), Some(definition)) => {
                Self { id: epsg.into(), name: crs.label(), organization: "EPSG", definition }
            }
            (Some(crs), None, Some(definition)) => {
                Self { id: Self::OWN, name: crs.label(), organization: "NONE", definition }
            }
            _ => Self {
                id: Self::UNKNOWN,
                name: "Undefined Cartesian".into(),
                organization: "NONE",
                definition: "undefined",
            },
        }
    }
}

/// When the content is said to have changed: the same shape gives the same bytes.
const LAST_CHANGE: &str = "1970-01-01T00:00:00.000Z";
/// The longitude and latitude of WGS 84, which every file must list.
const WGS_84: &str = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]"#;
/// The tables that a file must have (OGC 12-128r19, annex C), its magic number ("GPKG") and the version 1.3.
const TABLES: &str = "
PRAGMA application_id = 0x47504B47;
PRAGMA user_version = 10300;
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE, description TEXT DEFAULT '',
  last_change DATETIME NOT NULL, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL,
  z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));";

/// Writes a database with these layers.
fn write(layers: &[Layer], crs: Option<&Crs>, out: &mut dyn Write) -> io::Result<()> {
    let database = || -> rusqlite::Result<_> {
        let file = Connection::open_in_memory()?;
        file.execute_batch(TABLES)?;
        let system = System::of(crs);
        let required = [
            System { id: System::UNKNOWN, ..System::of(None) },
            System { id: 0, name: "Undefined geographic".into(), ..System::of(None) },
            System { id: 4326, name: "WGS 84".into(), organization: "EPSG", definition: WGS_84 },
        ];
        let id = system.id;
        let own = (!required.iter().any(|known| known.id == id)).then_some(system);
        for System { id, name, organization, definition } in required.into_iter().chain(own) {
            file.execute(
                "INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, NULL)",
                params![name, id, organization, id, definition],
            )?;
        }
        file.execute_batch("BEGIN")?;
        layers.iter().try_for_each(|layer| layer.store(&file, id))?;
        file.execute_batch("COMMIT")?;
        file.serialize(MAIN_DB).map(|bytes| bytes.to_vec())
    };
    out.write_all(&database().map_err(io::Error::other)?)
}
