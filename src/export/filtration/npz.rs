use std::io::{self, Write};

use walpha_base::Monitor;
use zip::ZipWriter;

use super::lasting;
use crate::export::npz::Archive;
use crate::ladder::{Entry, Ordered};

/// Arrays of each dimension, by their names.
const DIMENSIONS: [&str; 4] = ["vertex", "edge", "facet", "cell"];

pub(super) fn write(
    ordered: &Ordered<'_>,
    out: &mut dyn Write,
    monitor: &Monitor,
) -> io::Result<()> {
    let pairs = ordered.pairs();
    let mut archive = Archive::compressed(ZipWriter::new_stream(out));
    let whole = ordered.filtration().whole();
    archive.rows("points", &whole.points().positions)?;
    archive.list("weights", whole.power_weights())?;
    archive.list("vertices", ordered.vertices().as_flattened())?;
    archive.rows("edges", ordered.edges())?;
    archive.rows("facets", ordered.facets())?;
    archive.rows("cells", ordered.cells())?;
    let mut first = 0;
    for (dimension, name) in DIMENSIONS.into_iter().enumerate() {
        monitor.report(dimension as u64, DIMENSIONS.len() as u64).map_err(io::Error::other)?;
        let count = ordered.count(dimension) as u32;
        let numbers = first..first + count;
        first += count;
        let doubles = |of: fn(Entry<'_>) -> f64| -> Vec<f64> {
            numbers.clone().map(|number| of(ordered.simplex(number))).collect()
        };
        archive.list(&format!("{name}_values"), &doubles(|simplex| simplex.value))?;
        // A cell is interior from its value on, by its own sphere.
        if name != "cell" {
            archive.list(&format!("{name}_regular"), &doubles(|simplex| simplex.regular))?;
            archive.list(&format!("{name}_interior"), &doubles(|simplex| simplex.interior))?;
            let gabriel = numbers.clone().map(|number| ordered.simplex(number).gabriel);
            archive.list(&format!("{name}_gabriel"), &gabriel.collect::<Vec<_>>())?;
        }
    }
    archive.list("order", ordered.order())?;
    archive.rows("component_pairs", &lasting(ordered, &pairs.components))?;
    archive.list("lasting_components", &pairs.lasting)?;
    archive.rows("void_pairs", &lasting(ordered, &pairs.voids))?;
    if let Some(torus) = ordered.filtration().torus() {
        archive.list("lasting_voids", &pairs.lasting_voids)?;
        archive.list("last_cell", pairs.last.as_slice())?;
        archive.list("periodic", &torus.sides())?;
    }
    archive.list("hidden", whole.hidden().unwrap_or_default())?;
    archive.rows("duplicates", whole.duplicates())?;
    archive.finish().map(drop)
}
