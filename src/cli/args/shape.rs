//! How the shape is computed.

use std::num::NonZeroUsize;

use clap::Args;

use crate::cli::said::{Said, misused};
use crate::shape::Engine;
use crate::{Balls, Recipe};

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
    /// A recipe with these options, which are refused where they have no use for each other.
    pub(crate) fn set(&self, recipe: Recipe) -> Result<Recipe, Said> {
        let Self { balls, engine, exterior, hidden, blocks, memory } = *self;
        if engine == Engine::Cgal && blocks.is_some_and(|blocks| blocks.get() > 1) {
            misused!("--blocks has no effect: the engine cgal knows no blocks" => "omit it, or take --engine native");
        }
        let recipe = recipe
            .balls(balls)
            .engine(engine)
            .exterior(exterior)
            .hidden(hidden)
            .blocks(blocks)
            .memory(memory);
        recipe.check().map_err(|error| Said::usage_of(&error))?;
        Ok(recipe)
    }
}
