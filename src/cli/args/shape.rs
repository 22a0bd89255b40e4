//! How the shape is computed.

use std::num::NonZeroUsize;

use clap::Args;

use crate::cli::said::{Said, misused};
use crate::pipeline::AlphaRule;
use crate::shape::{Engine, ShapeOptions, Torus};
use crate::{Alpha, Balls};

use super::values::bytes;

/// How the shape is computed.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub(crate) struct ShapeArgs {
    /// A point is a ball of squared radius α + ω (power) or of radius α + ω (radius).
    #[arg(long, value_enum, default_value_t, value_name = "READING")]
    balls: Balls,
    /// Engine that computes the shape; both give the same answer.
    #[arg(long, value_enum, default_value_t, value_name = "ENGINE")]
    engine: Engine,
    /// Number of blocks [default: from threads and memory].
    #[arg(long, value_name = "N")]
    blocks: Option<NonZeroUsize>,
    /// Memory limit to size blocks for, as in 2G or 500M; not with what needs the whole triangulation
    /// (α = inf, --exterior, --hidden, --engine cgal).
    #[arg(long, value_name = "SIZE", value_parser = bytes, conflicts_with = "blocks")]
    memory: Option<u64>,
    /// Keep the simplices outside the shape, too: the whole triangulation.
    #[arg(long)]
    exterior: bool,
    /// Count and list the points that heavier ones hide: the whole triangulation.
    #[arg(long)]
    hidden: bool,
}

impl ShapeArgs {
    /// Refuses options that have no use for each other, before the work.
    pub(crate) fn check(&self, alpha: AlphaRule, periodic: Option<Torus>) -> anyhow::Result<()> {
        if self.engine == Engine::Cgal && self.blocks.is_some_and(|blocks| blocks.get() > 1) {
            misused!("--blocks has no effect: the engine cgal knows no blocks" => "omit it, or take --engine native");
        }
        // What is found is finite.
        let alpha = match alpha {
            AlphaRule::Given(alpha) => alpha,
            _ => Alpha::from_squared(0.0)?,
        };
        let options = self.options().alpha(alpha).periodic(periodic);
        Ok(options.check().map_err(|error| Said::usage_of(&error))?)
    }

    /// The stage's options, at α = ∞.
    pub(crate) fn options(&self) -> ShapeOptions {
        let Self { balls, engine, exterior, hidden, blocks, memory } = *self;
        ShapeOptions::new(Alpha::INFINITE)
            .balls(balls)
            .engine(engine)
            .exterior(exterior)
            .hidden(hidden)
            .blocks(blocks)
            .memory(memory)
    }
}
