//! Options that several commands share, and how they become options of the library.

mod input;
mod periodic;
mod select;
mod shape;
mod values;
mod weights;

use clap::Args;

pub use input::InputArgs;
pub use periodic::PeriodicArgs;
pub use select::{HaarArgs, SelectArgs};
pub use shape::ShapeArgs;
pub use values::not_negative;
#[cfg(feature = "render")]
pub use values::number;
pub use weights::{Alphas, FrozenArgs, WeightArgs};

/// From an input to weighted points.
#[derive(Args, Clone)]
pub struct PipelineArgs {
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    pub haar: HaarArgs,
    #[command(flatten)]
    pub select: SelectArgs,
    #[command(flatten)]
    pub weights: WeightArgs,
}
