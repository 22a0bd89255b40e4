use std::io::{self, Write};

use walpha_base::Monitor;
use walpha_base::memory;

use super::lasting;
use crate::check::schema::{Below, FiltrationFile, PairsFile, SchemaError, Values};
use crate::ladder::{Entry, Ordered};
use crate::shape::Alpha;

pub(super) fn write(ordered: &Ordered<'_>, out: &mut dyn Write, _: &Monitor) -> io::Result<()> {
    // Rows, four numbers each, and a place in the order.
    let bytes = ordered.len() * (size_of::<[u32; 4]>() + size_of::<[f64; 3]>() + size_of::<u32>());
    memory::afford(bytes, || format!("the JSON of {} simplices", ordered.len()))
        .map_err(io::Error::other)?;
    file(ordered).write_json(out).map_err(|error| match error {
        SchemaError::Io(error) => error,
        other => io::Error::other(other),
    })
}

fn file(ordered: &Ordered<'_>) -> FiltrationFile {
    let pairs = ordered.pairs();
    let whole = ordered.filtration().whole();
    let mut first = [0; 4];
    for dimension in 1..4 {
        first[dimension] = first[dimension - 1] + ordered.count(dimension - 1) as u32;
    }
    let entries = |dimension: usize| {
        let numbers = first[dimension]..first[dimension] + ordered.count(dimension) as u32;
        numbers.map(|number| ordered.simplex(number))
    };
    let values = |dimension| entries(dimension).map(|simplex| alpha(simplex.value)).collect();
    fn below<'a, T, I: Iterator<Item = Entry<'a>>>(
        entries: impl Fn(usize) -> I,
        of: fn(Entry<'_>) -> T,
    ) -> Below<T> {
        let [vertices, edges, facets] =
            [0, 1, 2].map(|dimension| entries(dimension).map(of).collect());
        Below { vertices, edges, facets }
    }
    FiltrationFile {
        points: whole.points().positions.clone(),
        weights: Some(whole.power_weights().to_vec()),
        vertices: ordered.vertices().as_flattened().to_vec(),
        edges: ordered.edges().to_vec(),
        facets: ordered.facets().to_vec(),
        cells: ordered.cells().to_vec(),
        values: Values {
            vertices: values(0),
            edges: values(1),
            facets: values(2),
            cells: values(3),
        },
        gabriel: Some(below(entries, |simplex| simplex.gabriel)),
        regular: Some(below(entries, |simplex| alpha(simplex.regular))),
        interior: Some(below(entries, |simplex| alpha(simplex.interior))),
        order: ordered.order().to_vec(),
        pairs: Some(PairsFile {
            components: lasting(ordered, &pairs.components),
            lasting: pairs.lasting.clone(),
            voids: lasting(ordered, &pairs.voids),
            lasting_voids: pairs.lasting_voids.clone(),
            last: pairs.last,
        }),
        periodic: ordered.filtration().torus().map(|torus| torus.sides()),
        hidden: whole.hidden().map(<[u32]>::to_vec),
        duplicates: Some(whole.duplicates().to_vec()),
        info: Some(serde_json::json!({
            "program": concat!("walpha ", env!("CARGO_PKG_VERSION")),
            "coordinates": whole.coordinates(),
        })),
    }
}

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).expect("radii are numbers")
}
