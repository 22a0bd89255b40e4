//! `walpha shape`: the whole pipeline.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use crate::blocks::{Pieces, Team};
use crate::export::{Content, ExportOptions, Exporter, FORMATS, Format, Target, write_all};
use crate::progress::Stage;
use crate::shape::{ShapeOptions, Surface};
use crate::shown::shown;
use crate::volume::UnknownFormat;

use super::args::{PeriodicArgs, PipelineArgs, ShapeArgs};
use super::blocks::Outputs;
use super::formats::shape_output;
use super::output::tell;
use super::picture::PictureArgs;
use super::progress::Progress;
use super::report::Report;
use super::said::{misused, option};
use super::together::{self, Work};
use super::{Global, pipeline};

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
    /// Refuses options that no output has a use for.
    fn check(&self) -> anyhow::Result<()> {
        let input = &self.pipeline.input;
        input.check_format(self.output.iter())?;
        let names: Vec<PathBuf> =
            self.output.iter().map(|path| input.output(path)).collect::<Result<_, _>>()?;
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
        self.shape.check(self.pipeline.weights.alpha(), self.periodic.periodic)?;
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
        Ok(())
    }

    pub(super) fn run(self, global: Global, team: &dyn Team) -> anyhow::Result<()> {
        // Before the long work: a bad option, extension or place costs nothing yet.
        self.check()?;
        let mut targets = Vec::new();
        let export = ExportOptions {
            ascii: self.ascii,
            solid: self.solid,
            groups: self.groups,
            input: Some(self.pipeline.input.input.clone()),
        };
        let mut pieces = Vec::new();
        for path in &self.output {
            let name = self.pipeline.input.output(path)?;
            if let Some(of_path) = Pieces::of(&name) {
                pieces.push((of_path, path.clone()));
                continue;
            }
            let exporter: Box<dyn Exporter> = if PictureArgs::wanted(&name) {
                self.picture.exporter()
            } else {
                let pieces = Pieces::ALL.map(|(_, extension)| extension);
                let known = FORMATS.iter().map(|format| format.extension).chain(pieces);
                let unknown =
                    |_| UnknownFormat::new(path, "a shape", known.chain(PictureArgs::EXTENSIONS));
                Format::of(&name).map_err(unknown)?.exporter(&export)
            };
            targets.push((Target::open(path)?, exporter));
        }

        together::check(team, !pieces.is_empty())?;
        let mut progress = Progress::new(global);
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        if !pieces.is_empty() {
            unused(
                "--dimension",
                self.dimension.is_some(),
                "a block may be flat where the whole is not",
            )?;
            unused("--solid", self.solid, "it takes the whole boundary, and there are blocks")?;
            let given = &self.pipeline.input.given;
            given.refuse(&["refit", "periodic"], "there are blocks")?;
            let outputs = Outputs { pieces, whole: targets };
            let work = Work::new(&self.pipeline, &self.shape, &outputs, global)?;
            let mut report = work.lead(outputs, &mut progress, team)?;
            report.finish(progress.finish(), files);
            report.peak_memory_bytes = together::peak(team);
            return tell(global, &report);
        }
        let refuse_flat = self.dimension.is_some();
        let periodic = self.periodic.periodic;
        let options = ShapeOptions { refuse_flat, periodic, ..self.shape.options() };
        let stages = pipeline::stages_to(&self.pipeline, options)?;
        let (weighed, volume) = pipeline::weighted_points(&self.pipeline, stages, &mut progress)?;
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed, volume.as_ref());
        let model = pipeline::shape(weighed, options, &mut progress)?;
        report.add_model(&model);
        let shape = model.shape;
        if self.solid {
            report.add_solid(Surface::solid(&shape).1);
        }
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            let remark = exporter.remark(&shape)?.told(option);
            Some(format!("{}: {remark}", shown(target.path())))
        };
        let remarks: Vec<String> = targets.iter().filter_map(remark).collect();
        progress.stage(Stage::Write, || {
            write_all(targets.into_iter().map(|(target, exporter)| {
                let shape = &shape;
                let content = move |out: &mut dyn Write| exporter.write_any(shape, out);
                (target, Box::new(content) as Content<'_>)
            }))
        })?;
        report.finish(progress.finish(), files);
        if !global.quiet {
            remarks.iter().for_each(|remark| eprintln!("walpha: {remark}"));
        }
        tell(global, &report)
    }
}
