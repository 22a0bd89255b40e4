//! The table and the figures, one by one.

mod barycentric;
mod bench;
mod common;
mod comparison;
mod compression;
mod extension;
mod geomview;
mod isosurface;
mod min_max;
mod plane;
mod points;
mod power_cells;
mod table;
mod unweighted;

use Shared::{
    Barycentric, BarycentricN, Common, Hull, MinMax, MinMaxMean, MinMaxRadius, Plain, Shifted,
};

use super::study::{BY_ALPHA, Shared};
use super::{Item, ReproduceError};
pub(in crate::reproduce) use bench::Bench;

/// An item: its name, and the function that makes it.
pub(in crate::reproduce) struct Entry {
    /// The name of the item, with which the names of its files begin.
    pub name: &'static str,
    /// The name of its stage.
    pub stage: &'static str,
    /// The shapes that it takes from the bench.
    pub needs: &'static [Shared],
    /// Makes it, and adds its files to the bench.
    pub make: fn(&mut Bench<'_>) -> Result<Item, ReproduceError>,
}

const fn entry(
    name: &'static str,
    stage: &'static str,
    needs: &'static [Shared],
    make: fn(&mut Bench<'_>) -> Result<Item, ReproduceError>,
) -> Entry {
    Entry { name, stage, needs, make }
}

/// All items in the paper's order, and our extensions.
pub(super) const ALL: [Entry; 14] = [
    entry("table-1", "Table 1", &[], table::table_1),
    entry("figure-01", "Figure 1", &[Plain, Hull], points::figure_1),
    entry("figure-02", "Figure 2", &[], plane::figure_2),
    entry("figure-03", "Figure 3", &[], plane::figure_3),
    entry("figure-04", "Figure 4", &[], power_cells::figure_4),
    entry("figure-05", "Figure 5", &[Plain], isosurface::figure_5),
    entry("figure-06", "Figure 6", &BY_ALPHA, unweighted::figure_6),
    entry("figure-07", "Figure 7", &[Plain, Common, Shifted], common::figure_7),
    entry("figure-08", "Figure 8", &[MinMax, MinMaxRadius], min_max::figure_8),
    entry("figure-09", "Figure 9", &[Plain, Barycentric, BarycentricN], barycentric::figure_9),
    entry("figure-10", "Figure 10", &COMPARED, comparison::figure_10),
    entry("figure-11", "Figure 11", &[Plain, Barycentric], geomview::figure_11),
    entry("extension-1", "Extension", &[], extension::error_against_points),
    entry("extension-2", "Compression", &[], compression::bytes_against_error),
];

/// The shapes that Figure 10 compares.
const COMPARED: [Shared; 6] = [Plain, Shifted, MinMax, MinMaxMean, Barycentric, BarycentricN];
