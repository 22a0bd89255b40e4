//! `walpha shape`: the whole pipeline.

mod outputs;

use std::path::PathBuf;

use clap::Args;
use walpha_base::shown::shown;
use walpha_files::Working;

use crate::Recipe;
use crate::export::{FORMATS, Format};
use crate::outofcore::{Pieces, Team};
use crate::progress::Stage;

use super::args::{OutputArgs, PeriodicArgs, PipelineArgs, ShapeArgs};
use super::formats::shape_output;
use super::output::{remark, tell};
use super::picture::PictureArgs;
use super::progress::Progress;
use super::report::Report;
use super::said::misused;
use super::together::{self, Work};
use super::{Global, blocks, pipeline};
use outputs::Outputs;

/// Compute the weighted alpha shape of a volume or of points.
///
/// Examples:
///
/// walpha shape ct.nii.gz --gray 0..1000 --gray-min 64 --threshold 30 -o bone.ply
///
/// walpha shape sample:skull --weights min-max --alpha 10 -o skull.ply skull.vtu
///
/// walpha shape scan.xyz --alpha auto --solid -o scan.stl
///
/// walpha shape foam.xyz --periodic 20,20,20 --alpha 1.5 -o foam.npz foam.vtu
#[derive(Args)]
pub(super) struct Shape {
    #[arg(short, long, value_name = "FILE", num_args = 1.., help = shape_output())]
    output: Vec<PathBuf>,
    /// Write PLY as text instead of binary.
    #[arg(long)]
    ascii: bool,
    /// Write boundaries as solids, for 3D printing or meshing: only regular facets, closed, oriented, and
    /// cut apart where parts touch along edges or at vertices.
    #[arg(long)]
    solid: bool,
    /// Distinguish regular and singular facets, which some programs do not expect: by groups (OBJ),
    /// colours (OFF) or numbers (PLY, with components and sheets).
    #[arg(long)]
    groups: bool,
    /// Refuse points that span no volume; without it those in one plane or on one line get the shape
    /// that they have there: triangles or edges, and no cells.
    #[arg(long, value_name = "3", value_parser = clap::value_parser!(u8).range(3..=3))]
    dimension: Option<u8>,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: ShapeArgs,
    #[command(flatten)]
    periodic: PeriodicArgs,
    #[command(flatten)]
    format: OutputArgs,
    #[command(flatten)]
    picture: PictureArgs,
}

/// Refuses a switch that has no effect.
fn unused(name: &str, given: bool, why: &str) -> anyhow::Result<()> {
    if given {
        misused!("{name} has no effect: {why}" => "omit it");
    }
    Ok(())
}

impl Shape {
    /// The options of all stages; refuses those that no output has a use for.
    fn recipe(&self) -> anyhow::Result<Recipe> {
        let input = &self.pipeline.input;
        self.format.check(self.output.iter())?;
        let names: Vec<PathBuf> =
            self.output.iter().map(|path| self.format.named(path)).collect::<Result<_, _>>()?;
        let written =
            |has: fn(&Format) -> bool| names.iter().any(|name| Format::of(name).is_ok_and(has));
        let known = |has: fn(&Format) -> bool| {
            let names = FORMATS.iter().filter(|format| has(format)).map(|format| format.name);
            let mut names: Vec<&str> = names.collect();
            names.sort_unstable();
            match &names[..] {
                [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
                _ => names.concat(),
            }
        };
        if self.solid && self.periodic.periodic.is_some() {
            misused!("--solid is for shapes in space, and the boundary of one of a torus is cut open at the sides of the box" => "omit it, or omit --periodic");
        }
        if !names.iter().any(|name| PictureArgs::wanted(name)) {
            input.given.refuse(&PictureArgs::NAMES, "no picture (.png) is written")?;
        }
        if !written(|format| format.ascii) {
            let why = format!("only {} has a binary form and a text form", known(|f| f.ascii));
            unused("--ascii", self.ascii, &why)?;
        }
        if !written(|format| format.groups) {
            let why =
                format!("only {} can separate regular and singular facets", known(|f| f.groups));
            unused("--groups", self.groups, &why)?;
        }
        if !written(|format| format.boundary) {
            unused("--solid", self.solid, "no output holds a boundary alone")?;
        }
        let recipe = self.pipeline.recipe_of(&self.shape, self.periodic.periodic)?;
        Ok(recipe.refuse_flat(self.dimension.is_some()))
    }

    pub(super) fn run(self, global: Global, team: &dyn Team) -> anyhow::Result<()> {
        // Before the long work: a bad option, extension or place costs nothing yet.
        let recipe = self.recipe()?;
        let folder = together::folder(&self.output, &self.pipeline.input.input);
        let in_blocks =
            team.size() > 1 || self.output.iter().any(|path| Pieces::of(path).is_some());
        let working = (in_blocks && !global.in_place).then(|| Working::folder(&folder));
        let outputs = Outputs::open(&self)?;
        // From here on the blocks are written there.
        drop(working);
        let mut progress = Progress::new(global);
        let mut report = if in_blocks {
            self.in_blocks(recipe, outputs, folder, global, &mut progress, team)?
        } else {
            self.at_once(&recipe, outputs, global, &mut progress)?
        };
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        if team.size() > 1 {
            report.peak_memory_bytes = together::peak(team);
        }
        tell(global, &report)
    }

    /// Makes the shape in blocks, from file to file.
    fn in_blocks(
        &self,
        recipe: Recipe,
        outputs: Outputs,
        folder: PathBuf,
        global: Global,
        progress: &mut Progress,
        team: &dyn Team,
    ) -> anyhow::Result<Report> {
        let flat = "a block may be flat where the whole is not";
        unused("--dimension", self.dimension.is_some(), flat)?;
        let parts = "it takes the whole boundary, and there are blocks";
        unused("--solid", self.solid, parts)?;
        self.pipeline.input.given.refuse(&["refit", "periodic"], "there are blocks")?;
        if let Some((target, _)) = outputs.models.first() {
            let name = shown(target.path());
            misused!("{name} takes all points at once, and there are blocks" => "write it by `walpha points`");
        }
        let outputs = blocks::Outputs { pieces: outputs.pieces, whole: outputs.whole };
        let pieces = outputs.pieces.clone();
        let work = Work::new(&self.pipeline.input, recipe, pieces, folder, global)?;
        work.lead(outputs, progress, team)
    }

    /// Makes the shape in memory.
    fn at_once(
        &self,
        recipe: &Recipe,
        outputs: Outputs,
        global: Global,
        progress: &mut Progress,
    ) -> anyhow::Result<Report> {
        let input = &self.pipeline.input;
        let (weighed, volume) = pipeline::weighted_points(input, recipe, progress)?;
        let mut report = Report::of_points(&input.input, &weighed, volume.as_ref());
        let mut facts = pipeline::model_facts(&weighed, volume.as_ref());
        let model = pipeline::shape(weighed, recipe, progress)?;
        facts.alpha = Some(model.parameter.alpha);
        progress.stage(Stage::Measure, || {
            report.add_model(&model);
            if self.solid {
                report.add_solid(model.shape.solid().1);
            }
        });
        let remarks = outputs.remarks(&model.shape);
        progress.stage(Stage::Write, || outputs.write(&model.shape, &facts))?;
        if !global.quiet {
            remarks.iter().for_each(|text| remark(&format!("walpha: {text}")));
        }
        Ok(report)
    }
}
