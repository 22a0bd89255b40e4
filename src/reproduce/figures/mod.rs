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

use super::{Item, ReproduceError};
pub(in crate::reproduce) use bench::Bench;

/// Makes one item, and adds its files to the bench.
type Make = fn(&mut Bench<'_>) -> Result<Item, ReproduceError>;

/// All items in the paper's order, and our extensions.
pub(super) const ALL: [(&str, Make); 14] = [
    ("Table 1", table::table_1),
    ("Figure 1", points::figure_1),
    ("Figure 2", plane::figure_2),
    ("Figure 3", plane::figure_3),
    ("Figure 4", power_cells::figure_4),
    ("Figure 5", isosurface::figure_5),
    ("Figure 6", unweighted::figure_6),
    ("Figure 7", common::figure_7),
    ("Figure 8", min_max::figure_8),
    ("Figure 9", barycentric::figure_9),
    ("Figure 10", comparison::figure_10),
    ("Figure 11", geomview::figure_11),
    ("Extension", extension::error_against_points),
    ("Compression", compression::bytes_against_error),
];
