use std::io::{Read, Seek};

use super::{Below, FiltrationFile, PairsFile, Values};
use crate::schema::SchemaError;
use crate::schema::npz::{Kind, Npz, alpha, index};

const ARRAYS: [(&str, Kind); 28] = [
    ("points", Kind::Rows(3)),
    ("weights", Kind::Column("points")),
    ("vertices", Kind::Rows(1)),
    ("edges", Kind::Rows(2)),
    ("facets", Kind::Rows(3)),
    ("cells", Kind::Rows(4)),
    ("vertex_values", Kind::Column("vertices")),
    ("edge_values", Kind::Column("edges")),
    ("facet_values", Kind::Column("facets")),
    ("cell_values", Kind::Column("cells")),
    ("vertex_gabriel", Kind::Column("vertices")),
    ("edge_gabriel", Kind::Column("edges")),
    ("facet_gabriel", Kind::Column("facets")),
    ("vertex_regular", Kind::Column("vertices")),
    ("edge_regular", Kind::Column("edges")),
    ("facet_regular", Kind::Column("facets")),
    ("vertex_interior", Kind::Column("vertices")),
    ("edge_interior", Kind::Column("edges")),
    ("facet_interior", Kind::Column("facets")),
    ("order", Kind::Rows(1)),
    ("component_pairs", Kind::Rows(2)),
    ("lasting_components", Kind::Rows(1)),
    ("void_pairs", Kind::Rows(2)),
    ("lasting_voids", Kind::Rows(1)),
    ("last_cell", Kind::Rows(1)),
    ("periodic", Kind::Rows(1)),
    ("hidden", Kind::Rows(1)),
    ("duplicates", Kind::Rows(2)),
];

/// The names of the arrays of vertices, edges and facets.
struct ArrayNames([&'static str; 3]);

impl FiltrationFile {
    /// Whether NPZ holds a filtration: it has an array `order`.
    pub(in crate::schema) fn is_npz(reader: impl Read + Seek) -> bool {
        Npz::new(reader).is_ok_and(|mut file| matches!(file.member("order"), Ok(Some(_))))
    }

    /// Reads NPZ. Before any array is read, what the headers claim is compared with the size of
    /// the file and with each other.
    ///
    /// # Errors
    /// Missing, ill-shaped or unreadable arrays; numbers that cannot be indices or values.
    pub fn read_npz(reader: impl Read + Seek) -> Result<Self, SchemaError> {
        let mut file = Npz::new(reader)?;
        file.check(&ARRAYS)?;
        let components = file.rows("component_pairs", index)?;
        let lasting = file.list("lasting_components", index)?;
        let voids = file.rows("void_pairs", index)?;
        let pairs = components.zip(lasting).zip(voids);
        let lasting_voids = file.list("lasting_voids", index)?.unwrap_or_default();
        let last = file.list("last_cell", index)?.unwrap_or_default().first().copied();
        let pairs = pairs.map(|((components, lasting), voids)| PairsFile {
            components,
            lasting,
            voids,
            lasting_voids,
            last,
        });
        let values = ArrayNames(["vertex_values", "edge_values", "facet_values"]);
        let values =
            below(&mut file, values, alpha)?.ok_or(SchemaError::Missing("vertex_values"))?;
        let Below { vertices, edges, facets } = values;
        let cells = required(&mut file, "cell_values", alpha)?;
        Ok(Self {
            points: file.rows("points", |_, x| Ok(x))?.unwrap_or_default(),
            weights: file.numbers("weights")?,
            vertices: required(&mut file, "vertices", index)?,
            edges: file.rows("edges", index)?.ok_or(SchemaError::Missing("edges"))?,
            facets: file.rows("facets", index)?.ok_or(SchemaError::Missing("facets"))?,
            cells: file.rows("cells", index)?.ok_or(SchemaError::Missing("cells"))?,
            values: Values { vertices, edges, facets, cells },
            gabriel: below(
                &mut file,
                ArrayNames(["vertex_gabriel", "edge_gabriel", "facet_gabriel"]),
                truth,
            )?,
            regular: below(
                &mut file,
                ArrayNames(["vertex_regular", "edge_regular", "facet_regular"]),
                alpha,
            )?,
            interior: below(
                &mut file,
                ArrayNames(["vertex_interior", "edge_interior", "facet_interior"]),
                alpha,
            )?,
            order: required(&mut file, "order", index)?,
            pairs,
            hidden: file.list("hidden", index)?,
            duplicates: file.rows("duplicates", index)?,
            periodic: file.sides()?,
            #[cfg(feature = "json")]
            info: None,
        })
    }
}

type Convert<T> = fn(&'static str, f64) -> Result<T, SchemaError>;

/// Three arrays; `None` if the first is missing, and an error if only others are.
fn below<R: Read + Seek, T>(
    file: &mut Npz<R>,
    ArrayNames([vertices, edges, facets]): ArrayNames,
    convert: Convert<T>,
) -> Result<Option<Below<T>>, SchemaError> {
    let Some(of_vertices) = file.list(vertices, convert)? else { return Ok(None) };
    let (edges, facets) = (required(file, edges, convert)?, required(file, facets, convert)?);
    Ok(Some(Below { vertices: of_vertices, edges, facets }))
}

fn required<R: Read + Seek, T>(
    file: &mut Npz<R>,
    name: &'static str,
    convert: Convert<T>,
) -> Result<Vec<T>, SchemaError> {
    file.list(name, convert)?.ok_or(SchemaError::Missing(name))
}

fn truth(name: &'static str, value: f64) -> Result<bool, SchemaError> {
    match value {
        0.0 => Ok(false),
        1.0 => Ok(true),
        _ => Err(SchemaError::Value { name, value: value.to_string(), expected: "0 or 1" }),
    }
}
