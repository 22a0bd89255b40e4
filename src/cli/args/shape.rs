//! Options of the shape: engine, blocks, memory, a periodic box, and the format of outputs.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::Args;

use super::choices::choice;
use super::values::{bytes, number};
use crate::cli::errors::{CommandError, fail, fail_usage};
use crate::export::Target;
use crate::shape::{Engine, Torus};
use crate::{Balls, Recipe};

/// How the shape is computed.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub(crate) struct ShapeArgs {
    /// A point is a ball of squared radius α + ω (power) or of radius α + ω (radius).
    #[arg(long, value_parser = choice::<Balls>(), default_value = "power", value_name = "READING")]
    balls: Balls,
    /// Engine that computes the shape; both give the same answer.
    #[arg(long, value_parser = choice::<Engine>(), default_value = "auto", value_name = "ENGINE")]
    engine: Engine,
    /// Number of blocks [default: from threads and memory].
    #[arg(long, value_name = "N")]
    blocks: Option<NonZeroUsize>,
    /// Memory limit to size blocks for, as in 2G or 500M; not with options that need the whole
    /// triangulation (α = inf, --exterior, --hidden, --engine cgal).
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
    /// The recipe with these options; refuses options that contradict each other.
    pub(crate) fn set(&self, recipe: Recipe) -> Result<Recipe, CommandError> {
        let Self { balls, engine, exterior, hidden, blocks, memory } = *self;
        if engine == Engine::Cgal && blocks.is_some_and(|blocks| blocks.get() > 1) {
            fail_usage!("--blocks has no effect: the engine cgal does not work in blocks" => "omit it, or take --engine native");
        }
        let recipe = recipe
            .balls(balls)
            .engine(engine)
            .exterior(exterior)
            .hidden(hidden)
            .blocks(blocks)
            .memory(memory);
        recipe.check().map_err(|error| CommandError::usage_of(&error))?;
        Ok(recipe)
    }
}

/// A periodic box.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub(crate) struct PeriodicArgs {
    /// Sides of a periodic box along x, y and z, in the unit of the points, which then lie on a torus.
    /// No edge may span half of the box; with 4·√(α + largest weight) less than each side none does.
    #[arg(long, value_name = "X,Y,Z", value_parser = torus)]
    pub periodic: Option<Torus>,
}

fn torus(text: &str) -> Result<Torus, CommandError> {
    let sides: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    let &[x, y, z] = &sides[..] else {
        fail!("three sides are needed" => "give those along x, y and z, as in 10,10,20");
    };
    Ok(Torus::new([x, y, z])?)
}

/// The format of outputs without an extension.
#[derive(Args, Clone)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of an output whose name has no extension, such as standard output (-), given as an
    /// extension, as in --output-format nrrd.
    #[arg(long, value_name = "EXTENSION")]
    output_format: Option<String>,
}

impl OutputArgs {
    /// A path whose extension names the format of an output: its own path, if that has an extension.
    pub(crate) fn named(&self, path: &Path) -> anyhow::Result<PathBuf> {
        match &self.output_format {
            _ if path.extension().is_some() => Ok(path.to_owned()),
            Some(format) => Ok(format!("output.{}", format.trim_start_matches('.')).into()),
            None if path == Path::new(Target::STDOUT) => {
                fail_usage!("standard output has no extension" => "name the format, as in --output-format nrrd")
            }
            None => Ok(path.to_owned()),
        }
    }

    /// Refuses `--output-format` if no output needs it.
    pub(crate) fn check<'a>(
        &self,
        mut outputs: impl Iterator<Item = &'a PathBuf>,
    ) -> anyhow::Result<()> {
        if self.output_format.is_some() && !outputs.any(|path| path.extension().is_none()) {
            fail_usage!("--output-format has no effect: each output has an extension, which says its format" => "omit it");
        }
        Ok(())
    }
}
