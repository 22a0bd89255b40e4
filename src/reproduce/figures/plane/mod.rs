//! Figures 2 to 4: shapes in the plane.

mod draw;
mod eks;
mod rung;
mod weighted;

pub(super) use eks::{figure_2, figure_3};
pub(super) use weighted::figure_4;
