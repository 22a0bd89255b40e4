//! `walpha shape`: runs the whole pipeline, and writes its outputs.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use walpha_base::shown::shown;
use walpha_files::Working;

use crate::cli::commands::blocks;
use crate::cli::commands::outline;
use crate::cli::commands::pipeline;
use crate::cli::commands::pipeline::VolumeSummary;
use crate::cli::commands::shape_in_blocks::{self, SharedWork};
use crate::cli::options::formats::shape_output;
use crate::cli::options::global::Global;
use crate::cli::options::picture::PictureArgs;
use crate::cli::options::{Declared, Kept, OfShape, OutputArgs, Periodic, PipelineArgs};
use crate::cli::process::errors::{CommandError, Result, fail_usage, option};
use crate::cli::process::output::{OF_OUTPUTS, print_summary, print_with};
use crate::cli::process::progress::Progress;
use crate::cli::process::terminal::{InlineArgs, Protocol};
use crate::cli::process::usage;
use crate::cli::report::Report;
use crate::cli::report::offsets::offsets;
use crate::export::{
    Content, EmptyShape, ExportOptions, Exporter, FORMATS, Format, Needs, Target, TargetError,
    write_all,
};
use crate::outofcore::{BlockwiseFormat, Team};
use crate::pipeline::{Input, Values};
use crate::points::{Attributes, Column, ModelMetadata, Packing, PointWriter};
use crate::progress::Stage;
use crate::volume::UnknownFormat;
use crate::{AlphaShape, Recipe};

/// Compute the weighted alpha shape of a volume or of points.
///
/// Examples:
///
/// walpha shape ct.nii.gz -o bone.ply   # bone, if its values are Hounsfield units
///
/// walpha shape ct.nii.gz --gray 0..1000 --gray-min 64 --threshold 30 -o bone.ply   # dense bone
///
/// walpha shape sample:skull --weights min-max --alpha 10 -o skull.ply skull.vtu   # with weights
///
/// walpha shape scan.xyz --alpha auto --solid --keep largest -o scan.stl   # to print
///
/// walpha shape sample:tile --class building --flat --radius 2 -o footprints.geojson   # outlines
///
/// walpha shape sample:tile --by treeID --radius 3 -o crowns.csv crowns.geojson   # one shape a tree
///
/// walpha shape trees.csv --radius 50 -o forest.geojson forest.svg   # in the plane
///
/// walpha shape foam.xyz --periodic 20,20,20 --alpha 1.5 -o foam.npz foam.vtu   # a periodic box
///
/// walpha shape ct.nii.gz --surface 250 --solid -o bone.stl   # an isosurface
///
/// walpha shape labels.nrrd --label 3,5 --solid -o organ.stl   # two labels
///
/// walpha shape labels.nrrd --each-label --solid -o organs   # one solid each
#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Shape {
    #[arg(short, long, value_name = "FILE", num_args = 1.., help = "Files to write, as in bone.ply; --help lists the formats",
          long_help = shape_output())]
    pub(crate) output: Vec<PathBuf>,
    /// Write PLY as text instead of binary.
    #[arg(long)]
    pub(crate) ascii: bool,
    /// Write boundaries as solids, for 3D printing or meshing: only regular facets, closed, oriented, and
    /// cut apart where parts touch along edges or at vertices.
    #[arg(long)]
    pub(crate) solid: bool,
    /// Distinguish regular and singular facets, which some programs do not expect: by groups (OBJ),
    /// colours (OFF) or numbers (PLY, with components and sheets).
    #[arg(long)]
    pub(crate) groups: bool,
    /// Refuse points that span no volume. Otherwise points in one plane or on one line get the shape that
    /// they have there: triangles or edges, and no cells.
    #[arg(long)]
    pub(crate) require_3d: bool,
    /// See points from above: drop z, so that they lie in a plane and have an outline, as the footprint of a building.
    #[arg(long, conflicts_with_all = ["each_label", "require_3d"])]
    pub(crate) flat: bool,
    /// Write files that would be empty, such as an STL without a facet. Otherwise an empty shape or file is an
    /// error.
    #[arg(long)]
    pub(crate) allow_empty: bool,
    /// Write the solid of each label of a segmentation to a file of its own, label-N, in the folder that --output names.
    #[arg(long, help_heading = "Labels", group = "each")]
    each_label: bool,
    /// Make a shape for each value of a column of points, such as treeID, class or label, all at one α. Outputs are a table
    /// (.csv), outlines from above (.geojson, .gpkg), or a folder for meshes.
    #[arg(long, value_name = "COLUMN", help_heading = "Groups of points", group = "each")]
    pub(crate) by: Option<String>,
    /// With --each-label, or --by and a folder: formats to write, by extension, as in ply,vtu [default: stl].
    #[arg(
        long,
        value_name = "EXT,EXT,…",
        value_delimiter = ',',
        requires = "each",
        help_heading = "Groups of points"
    )]
    pub(crate) mesh: Vec<String>,
    #[command(flatten)]
    pub(crate) pipeline: PipelineArgs,
    #[command(flatten)]
    shape: Declared<OfShape>,
    #[command(flatten)]
    periodic: Declared<Periodic>,
    #[command(flatten)]
    kept: Declared<Kept>,
    #[command(flatten)]
    pub(crate) format: OutputArgs,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    inline: InlineArgs,
}

/// The formats of shapes among the outputs with these names.
fn formats(names: &[PathBuf]) -> impl Iterator<Item = &'static Format> {
    names.iter().filter_map(|name| Format::of(name).ok())
}

/// Refuses a switch that has no effect.
pub(crate) fn unused(name: &str, given: bool, why: &str) -> Result<()> {
    if given {
        fail_usage!("{name} has no effect: {why}" => "omit it");
    }
    Ok(())
}

impl Shape {
    /// The options of all stages. Refuses options that no output uses.
    fn recipe(&self) -> Result<Recipe> {
        let input = &self.pipeline.input;
        self.format.check(self.output.iter())?;
        let names = self.names()?;
        let writes_each = self.each_label || self.writes_groups()?;
        let of_each = if writes_each { self.meshes()? } else { Vec::new() };
        unused("--mesh", !writes_each && !self.mesh.is_empty(), "no folder for meshes is named")?;
        let formats: Vec<&Format> =
            formats(&names).chain(of_each.iter().map(|mesh| mesh.format)).collect();
        let written = |has: fn(&Format) -> bool| formats.iter().any(|format| has(format));
        let known = |has: fn(&Format) -> bool| {
            let names = FORMATS.iter().filter(|format| has(format)).map(|format| format.name);
            let mut names: Vec<&str> = names.collect();
            names.sort_unstable();
            match &names[..] {
                [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
                _ => names.concat(),
            }
        };
        if self.solid && self.pipeline.settings().periodic().is_some() {
            fail_usage!("--solid is for shapes in space, and the boundary of one of a torus is cut open at the sides of the box" => "omit it, or omit --periodic");
        }
        if self.pipeline.settings().periodic().is_some() {
            outline::refuse(formats.iter().copied(), "a periodic box is a torus, not a plane")?;
        }
        let settings = self.pipeline.settings();
        if let Some(format) = formats.iter().find(|format| format.whole)
            && (settings.keep().is_some() || settings.min_volume().is_some())
        {
            let name = format.name;
            fail_usage!("{name} states the whole shape, so that it can be checked, and --keep and --min-volume take a part of it" => "omit them, or write another format, as VTU");
        }
        if self.require_3d {
            outline::refuse(formats.iter().copied(), "--require-3d refuses these")?;
        }
        let is_shown = self.inline.protocol(self.output.is_empty()).is_some();
        if !names.iter().any(|name| PictureArgs::wanted(name)) && !is_shown {
            input.typed.refuse(&PictureArgs::NAMES, "no picture (.png) is written or shown")?;
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
        let recipe = self.pipeline.recipe()?;
        Ok(recipe.refuse_flat(self.require_3d))
    }

    /// The options for writing outputs.
    pub(crate) fn export(&self) -> ExportOptions {
        ExportOptions::default()
            .ascii(self.ascii)
            .solid(self.solid)
            .groups(self.groups)
            .input(Some(self.pipeline.input.input.to_string()))
    }

    /// The error for an output whose extension is that of no shape.
    fn unknown(&self, path: &Path) -> CommandError {
        let error = UnknownFormat::new(path, "a shape", extensions());
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html")) {
            return error.into();
        }
        let [input, page] =
            [&*self.pipeline.input.input, &path.to_string_lossy()].map(usage::quoted);
        CommandError {
            next: Some(format!("a page is written by walpha view {input} -o {page}")),
            ..error.into()
        }
    }

    /// The outputs, as paths whose extensions determine their formats.
    pub(crate) fn names(&self) -> Result<Vec<PathBuf>> {
        self.output.iter().map(|path| self.format.named(path)).collect()
    }

    /// How a picture is shown in the terminal, if one is.
    fn protocol(&self, global: Global) -> Result<Option<Protocol>> {
        let what = if global.piped { "a file" } else { "the report as JSON" };
        if self.inline.is_asked_for() && (global.piped || global.json) {
            fail_usage!("--picture writes to standard output, which has {what}" => "omit it");
        }
        let is_free = self.output.is_empty() && !global.json && !global.quiet;
        Ok(self.inline.protocol(is_free))
    }

    pub(crate) fn run(self, global: Global, team: &dyn Team) -> Result<()> {
        // Before the long work, a bad option, extension or path costs nothing yet.
        let recipe = self.recipe()?;
        let protocol = self.protocol(global)?;
        if self.each_label || self.by.is_some() {
            unused("--picture", self.inline.is_asked_for(), "there are several shapes")?;
        }
        if self.each_label {
            return self.each_label(&recipe, global);
        }
        if let Some(column) = &self.by {
            return self.by_column(column, &recipe, global);
        }
        let folder = shape_in_blocks::working_folder(&self.output, &self.pipeline.input.input);
        let in_blocks =
            team.size() > 1 || self.output.iter().any(|path| BlockwiseFormat::of(path).is_some());
        let working = (in_blocks && !global.in_place).then(|| Working::folder(&folder));
        let mut outputs = Outputs::open(&self)?;
        outputs.protocol = protocol;
        // From here on, blocks are written to the working folder.
        drop(working);
        let mut progress = Progress::new(global);
        let mut report = if in_blocks {
            self.in_blocks(recipe, outputs, folder, global, &mut progress, team)?
        } else {
            self.at_once(&recipe, outputs, &mut progress)?
        };
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        if team.size() > 1 {
            report.peak_memory_bytes = shape_in_blocks::peak(team);
        }
        if let Some(picture) = report.picture.take() {
            print_with(|out| out.write_all(&picture))?;
        }
        print_summary(global, &report)
    }

    /// Computes the shape in blocks, which are stored in files.
    fn in_blocks(
        &self,
        recipe: Recipe,
        outputs: Outputs,
        folder: PathBuf,
        global: Global,
        progress: &mut Progress,
        team: &dyn Team,
    ) -> Result<Report> {
        let flat = "a block may be flat where the whole is not";
        unused("--require-3d", self.require_3d, flat)?;
        outline::refuse(formats(&self.names()?), "there are blocks, which span a volume")?;
        let parts = "it takes the whole boundary, and there are blocks";
        unused("--solid", self.solid, parts)?;
        unused("--flat", self.flat, "points of a plane are not cut into blocks")?;
        unused("--picture", self.inline.is_asked_for(), "there are blocks")?;
        let given = &self.pipeline.input.typed;
        given.refuse(&["refit"], "there are blocks")?;
        if let Some(option) = given.first_of(&["periodic", "keep", "min_volume"]) {
            fail_usage!("blocks are computed of all points in space, without {option}" => "write one file of all points, as .vtu or .npz");
        }
        if let Some((target, _)) = outputs.models.first() {
            let name = shown(target.path());
            fail_usage!("{name} takes all points at once, and there are blocks" => "write it by `walpha points`");
        }
        let outputs = blocks::Outputs { pieces: outputs.pieces, whole: outputs.whole };
        let pieces = outputs.pieces.clone();
        let work = SharedWork::new(&self.pipeline.input, recipe, pieces, folder, global)?;
        work.lead(outputs, progress, team)
    }

    /// The columns of points that outputs with these names hold, or that pictures need, also one that is shown.
    fn columns(&self, names: &[PathBuf], shows: bool) -> Attributes {
        if formats(names).any(|format| format.columns) {
            Attributes::All
        } else if shows || names.iter().any(|name| PictureArgs::wanted(name)) {
            self.picture.columns()
        } else {
            Attributes::None
        }
    }

    /// Computes the shape in memory.
    fn at_once(
        &self,
        recipe: &Recipe,
        mut outputs: Outputs,
        progress: &mut Progress,
    ) -> Result<Report> {
        let input = &self.pipeline.input;
        let names = self.names()?;
        // If the input is a CT, the recipe may be chosen for it.
        let attributes = self.columns(&names, outputs.protocol.is_some());
        let mut recipe = recipe.clone().attributes(attributes);
        let mut read = pipeline::read_suited(input, &mut recipe, progress)?;
        let recipe = &recipe;
        pipeline::accept(&read, input)?;
        if let Input::Points(points, facts) = &mut read {
            if self.flat {
                points.positions.iter_mut().for_each(|place| place[2] = 0.0);
            }
            let columns = std::mem::take(&mut points.columns);
            outputs.describe(self, facts, columns)?;
        } else {
            unused("--flat", self.flat, "a volume is not a set of points")?;
        }
        match &read {
            Input::Volume(volume) if recipe.labels.is_some() => {
                return self.of_labels(volume, recipe, outputs, progress);
            }
            Input::Volume(volume) if recipe.surface.is_some() => {
                return self.of_surface(volume, recipe, outputs, progress);
            }
            Input::Volume(_) => {}
            Input::Points(points, _) => outline::check(formats(&names), &points.positions)?,
        }
        let (weighed, source) = pipeline::weigh(read, input, recipe, Values::Written, progress)?;
        if source.is_some() {
            outline::check(formats(&names), weighed.points.positions())?;
        }
        let volume = source.as_ref().map(VolumeSummary::of);
        drop(source);
        let mut report = Report::of_points(&input.input, &weighed, volume.as_ref());
        let mut facts = weighed.metadata(volume.map(|volume| volume.written));
        let model = pipeline::shape(weighed, recipe, progress)?;
        if !self.allow_empty {
            progress.watch(|| outputs.refuse_empty(&model.shape))?;
        }
        facts.alpha = Some(model.parameter.alpha);
        progress.stage(Stage::Measure, || report.add_model(&model))?;
        self.deliver(&model.shape, &facts, report, outputs, progress)
    }

    /// Writes a shape, and adds the changes that files make to its boundary and its coordinates to its report.
    pub(crate) fn deliver(
        &self,
        shape: &AlphaShape,
        facts: &ModelMetadata,
        mut report: Report,
        outputs: Outputs,
        progress: &mut Progress,
    ) -> Result<Report> {
        if self.solid {
            progress.stage(Stage::Measure, || report.add_solid(shape.solid().1));
        }
        let remarks = outputs.remarks(shape);
        report.offsets = offsets(&outputs.whole, shape);
        let Outputs { protocol, ref columns, is_scan, .. } = outputs;
        let columns = Arc::clone(columns);
        progress.stage(Stage::Write, || outputs.write(shape, facts))?;
        remarks.iter().for_each(|text| tracing::info!(target: OF_OUTPUTS, "{text}"));
        // There may be nothing that a picture shows, as of points alone.
        if let Some(protocol) = protocol
            && EmptyShape::check(shape, Needs::FacetOrLine).is_ok()
        {
            let draw = || {
                let picture = self.picture.in_terminal(shape, columns, is_scan)?;
                protocol.encode(&picture)
            };
            report.picture = Some(progress.stage(Stage::Write, draw)?);
        }
        Ok(report)
    }
}

/// The outputs, grouped by their source.
#[derive(Default)]
pub(crate) struct Outputs {
    /// Outputs made from the blocks, with a file for each block.
    pub pieces: Vec<(BlockwiseFormat, PathBuf)>,
    /// Outputs made from the shape.
    pub whole: Vec<(Target, Box<dyn Exporter>)>,
    /// Outputs made from the points, with all data needed to make the shape again.
    pub models: Vec<(Target, &'static PointWriter)>,
    /// How the shape is shown in the terminal, if it is.
    protocol: Option<Protocol>,
    /// The columns of the points, as far as outputs need them, and whether the points are those of a laser scan.
    columns: Arc<[Column]>,
    is_scan: bool,
}

impl Outputs {
    /// Opens the outputs that the options name.
    pub(crate) fn open(shape: &Shape) -> Result<Self> {
        let export = shape.export();
        let mut outputs = Self::default();
        for path in &shape.output {
            let name = shape.format.named(path)?;
            if let Some(pieces) = BlockwiseFormat::of(&name) {
                pieces.check(path)?;
                if outputs.pieces.iter().any(|(_, known)| known == path) {
                    fail_usage!("{} is named twice", shown(path) => "name it once");
                }
                outputs.pieces.push((pieces, path.clone()));
            } else if let Some(writer) = PointWriter::of(&name).ok().filter(|writer| writer.packs) {
                outputs.models.push((Target::open(path)?, writer));
            } else if PictureArgs::wanted(&name) {
                outputs
                    .whole
                    .push((Target::open(path)?, shape.picture.exporter(Arc::default(), false)));
            } else {
                let format = Format::of(&name).map_err(|_| shape.unknown(path))?;
                outputs.whole.push((Target::open(path)?, format.exporter(&export)));
            }
        }
        Ok(outputs)
    }

    /// Tells the writers of shapes what a file says about its points: their coordinate system and columns.
    fn describe(
        &mut self,
        shape: &Shape,
        facts: &ModelMetadata,
        columns: Vec<Column>,
    ) -> Result<()> {
        let columns: Arc<[Column]> = columns.into();
        (self.columns, self.is_scan) = (columns.clone(), facts.scan.is_some());
        let export = shape.export().crs(facts.crs.clone()).columns(columns.clone());
        for (target, exporter) in &mut self.whole {
            let name = shape.format.named(target.path())?;
            if let Ok(format) = Format::of(&name) {
                *exporter = format.exporter(&export);
            } else if PictureArgs::wanted(&name) {
                *exporter = shape.picture.exporter(columns.clone(), facts.scan.is_some());
            }
        }
        Ok(())
    }

    /// Refuses a shape for which a file would be empty; without files, refuses an empty shape.
    fn refuse_empty(&self, shape: &AlphaShape) -> Result<()> {
        if self.whole.is_empty() && self.models.is_empty() {
            EmptyShape::check(shape, Needs::Simplex).map_err(or_allowed)?;
        }
        for (target, exporter) in &self.whole {
            EmptyShape::check(shape, exporter.needs())
                .map_err(|error| or_allowed(error).context(shown(target.path())))?;
        }
        Ok(())
    }

    /// The remarks of the chosen formats on the shape.
    fn remarks(&self, shape: &AlphaShape) -> Vec<String> {
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            let remark = exporter.remark(shape)?.with_names(option);
            Some(format!("{}: {remark}", shown(target.path())))
        };
        self.whole.iter().filter_map(remark).collect()
    }

    /// Writes all outputs that are made from a whole shape.
    fn write(self, shape: &AlphaShape, facts: &ModelMetadata) -> Result<(), TargetError> {
        let whole = self.whole.into_iter().map(|(target, exporter)| {
            let content = move |out: &mut dyn Write| exporter.write(shape, out);
            (target, Box::new(content) as Content<'_>)
        });
        let models = self.models.into_iter().map(|(target, writer)| {
            let content = move |out: &mut dyn Write| {
                writer.write_model(shape.points(), &[], facts, &Packing::default(), out)
            };
            (target, Box::new(content) as Content<'_>)
        });
        write_all(whole.chain(models))
    }
}

/// The error for an empty shape, which an option may allow.
fn or_allowed(empty: EmptyShape) -> CommandError {
    let error = CommandError::from(empty);
    let next = error.next.map(|next| format!("{next}, or --allow-empty to go on all the same"));
    CommandError { next, ..error }
}

/// The extensions of all formats in which a shape can be written.
pub(super) fn extensions() -> impl Iterator<Item = &'static str> + Clone {
    let pieces = BlockwiseFormat::ALL.iter().map(|(_, extension)| *extension);
    let models = PointWriter::all().filter(|writer| writer.packs).map(|writer| writer.extension);
    let shapes = FORMATS.iter().map(|format| format.extension);
    shapes.chain(PictureArgs::EXTENSIONS).chain(models).chain(pieces)
}
