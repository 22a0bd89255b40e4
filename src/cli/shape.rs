//! `walpha shape`: the whole pipeline.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use walpha::alpha_shape;
use walpha::export::{Content, ExportOptions, Exporter, Format, Target, UnknownFormat, write_all};
use walpha::shape::{ShapeOptions, Surface};
use walpha::shown::shown;

use super::args::{PipelineArgs, ShapeArgs};
use super::given::misused;
use super::output::tell;
use super::picture::PictureArgs;
use super::progress::Progress;
use super::report::Report;
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
#[derive(Args)]
pub struct Shape {
    /// Files to write: .ply, .off, .obj, .stl, .glb, .vtp (boundary), .vtu, .npz or .json (all
    /// simplices), .png (a picture); or - (standard output, with --format). Files that are there are replaced.
    #[arg(short, long, value_name = "FILE", num_args = 1..)]
    output: Vec<PathBuf>,
    /// Write text where a format has a binary form too (PLY).
    #[arg(long)]
    ascii: bool,
    /// Write boundaries as those of solids, for programs that print or compute with them: regular
    /// facets alone, closed, oriented, and cut apart where parts touch along edges or at vertices.
    #[arg(long)]
    solid: bool,
    /// Tell regular and singular facets apart, where some programs do not expect it: by groups (OBJ),
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
    picture: PictureArgs,
}

/// Refuses a switch that has no effect.
fn unused(name: &str, given: bool, why: &str) -> anyhow::Result<()> {
    if given {
        misused!("{name} has no effect: {why}; omit it");
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
        let written = |format| names.iter().any(|name| Format::of(name).is_ok_and(|f| f == format));
        self.shape.check(self.pipeline.weights.alpha())?;
        if !names.iter().any(|name| PictureArgs::wanted(name)) {
            input.given.refuse(&PictureArgs::NAMES, "no picture (.png) is written")?;
        }
        if !written(Format::Ply) {
            unused("--ascii", self.ascii, "only PLY has a binary form and a text form")?;
        }
        if ![Format::Obj, Format::Off, Format::Ply].into_iter().any(written) {
            unused("--groups", self.groups, "only OBJ, OFF and PLY can tell facets apart")?;
        }
        if !names.iter().any(|name| Format::of(name).is_ok_and(Format::is_boundary)) {
            unused("--solid", self.solid, "no output holds a boundary alone")?;
        }
        Ok(())
    }

    pub fn run(self, global: Global) -> anyhow::Result<()> {
        // Before the long work: a bad option, extension or place costs nothing yet.
        self.check()?;
        let mut targets = Vec::new();
        let export = ExportOptions {
            ascii: self.ascii,
            solid: self.solid,
            groups: self.groups,
            input: Some(self.pipeline.input.input.clone()),
        };
        for path in &self.output {
            let name = self.pipeline.input.output(path)?;
            let exporter: Box<dyn Exporter> = if PictureArgs::wanted(&name) {
                Box::new(self.picture)
            } else {
                let known = Format::ALL.into_iter().map(|(_, extension)| extension);
                let unknown = |_| UnknownFormat::new(path, "a shape", known.chain(["png"]));
                Format::of(&name).map_err(unknown)?.exporter(&export)
            };
            targets.push((Target::open(path)?, exporter));
        }

        let mut progress = Progress::new(global);
        let mut weighed = pipeline::weighted_points(&self.pipeline, &mut progress)?;
        let alpha = weighed.find_parameter(&self.shape, &mut progress)?.alpha;
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed);
        let refuse_flat = self.dimension.is_some();
        let options = ShapeOptions { refuse_flat, ..self.shape.options(alpha) };
        let shape = progress.stage("shape", || alpha_shape(weighed.points, &options))?;
        let shape = shape.meaning(weighed.coordinates);
        report.add_shape(&shape);
        if self.solid {
            report.add_solid(Surface::solid(&shape).1);
        }
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            Some(format!("{}: {}", shown(target.path()), exporter.remark(&shape)?))
        };
        let remarks: Vec<String> = targets.iter().filter_map(remark).collect();
        progress.stage("write", || {
            write_all(targets.into_iter().map(|(target, exporter)| {
                let shape = &shape;
                let content = move |out: &mut dyn Write| exporter.write(shape, out);
                (target, Box::new(content) as Content<'_>)
            }))
        })?;
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        if !global.quiet {
            remarks.iter().for_each(|remark| eprintln!("walpha: {remark}"));
        }
        tell(global, &report)
    }
}
