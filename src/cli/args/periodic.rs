//! Points of a torus.

use clap::Args;

use super::values::number;
use crate::cli::said::{Said, refused};
use crate::shape::Torus;

/// Points of a torus.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub(crate) struct PeriodicArgs {
    /// Sides of a box that repeats along x, y and z, in the unit of the points: these are those of a torus.
    /// No edge may span half of the box; with 4·√(α + largest weight) less than each side none does.
    #[arg(long, value_name = "X,Y,Z", value_parser = torus)]
    pub periodic: Option<Torus>,
}

fn torus(text: &str) -> Result<Torus, Said> {
    let sides: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    let &[x, y, z] = &sides[..] else {
        refused!("three sides are needed" => "give those along x, y and z, as in 10,10,20");
    };
    Ok(Torus::new([x, y, z])?)
}
