//! `walpha ladder`: many α, or many levels of detail, and the error of each.

mod detail;
mod summary;

use std::borrow::Borrow;
use std::fmt::{Display, LowerExp};
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::commands::folder::Folder;
use crate::cli::commands::outline;
use crate::cli::commands::pipeline::{self, filled_in};
use crate::cli::options::{self, global::Global};
use crate::cli::options::{Alphas, Declared, FrozenPipelineArgs, Groups, Kept, Periodic};
use crate::cli::process::errors::{CommandError, Result, fail_usage};
use crate::cli::process::output::print_summary;
use crate::cli::process::progress::Progress;
use crate::cli::report::offsets::{FileOffset, Told};
use crate::export::{ExportOptions, Exporter, Format};
use crate::interpolate::{Deviation, Grid, Interpolant, InterpolateError};
use crate::ladder::{Ladder as Levels, Level};
use crate::points::Region;
use crate::progress::Stage;
#[cfg(feature = "render")]
use crate::render::ladder_figure;
use crate::settings::Group;
use crate::{AlphaShape, Coordinates, Units, Volume};
use summary::{LadderSummary, write_levels, write_voids};

/// Compute shapes at many α from one triangulation, or at several levels of detail.
///
/// Over α, weights are frozen, so that the shapes are nested: ladder.csv and ladder.json have counts,
/// Betti numbers, volume and area of each level, voids.csv has every void with the α that fills
#[cfg_attr(feature = "render", doc = " it, ladder.png and ladder.svg draw it.")]
#[cfg_attr(not(feature = "render"), doc = " it.")]
/// Values of α to try are suggested.
///
/// Over points (--counts) or the error of the wavelet stage (--epsilons) there is a mesh for each level of detail.
/// Unless --alpha is given, α of a level is 10·h² as for the whole volume, or α from the spacing of its own points (as
/// --alpha auto) where that is greater, and no less than that of a level with more points. detail.csv and detail.json list for each level α, sizes,
/// errors, the share of the vertices in the largest part, and the distance from the surface of full detail: the mean over
/// both surfaces, and the greatest.
///
/// Examples:
///
/// walpha ladder ct.nii.gz -o ladder   # 16 values of α
///
/// walpha ladder sample:skull --alphas 1,2,5,10,20,50 -o ladder   # α of your own
///
/// walpha ladder sample:skull --counts 1000,4000,16000 --focus 20:40,20:40,20:40 -o detail   # detail
#[derive(Args)]
pub(crate) struct Ladder {
    /// Folder to write to, created if needed; existing files in it are replaced, all at the end.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Squared lengths, as in 1,2,5,inf; or auto, for critical values of the topology.
    #[arg(
        long,
        value_name = "A,A,…",
        default_value = "auto",
        group = "levels",
        allow_hyphen_values = true
    )]
    alphas: Alphas,
    /// Levels of detail: numbers of points. Each level is a subset of the points that --count, --ratio or --threshold selects,
    /// spread over all of them, preferring large gray differences; a level with more points than these has the samples of
    /// largest difference.
    #[arg(long, value_name = "N,N,…", value_delimiter = ',', group = "levels")]
    counts: Vec<u64>,
    /// Levels of detail: L² norms of the error allowed in the wavelet stage, in gray levels.
    #[arg(long, value_name = "E,E,…", value_delimiter = ',', group = "levels",
          value_parser = crate::cli::options::not_negative)]
    epsilons: Vec<f64>,
    /// A region with full detail at every level: all points in it that --count, --ratio or --threshold
    /// selects are added to those of the level. Limits are inclusive, in the units of the points.
    #[arg(long, value_name = "X0:X1,Y0:Y1,Z0:Z1", value_parser = crate::cli::options::places,
          allow_hyphen_values = true)]
    focus: Option<Region>,
    /// Meshes to write for each level, by extension, as in ply,vtu [default: none for α, ply for
    /// levels of detail].
    #[arg(long, value_name = "EXT,EXT,…", value_delimiter = ',')]
    mesh: Vec<String>,
    #[command(flatten)]
    alpha: Declared<OfLevels>,
    #[command(flatten)]
    pipeline: FrozenPipelineArgs,
    #[command(flatten)]
    periodic: Declared<Periodic>,
    /// Over α those of the shape at --alpha-ref, whose points alone make the ladder; of levels of detail, those of each.
    #[command(flatten)]
    kept: Declared<Kept>,
}

/// α of levels of detail.
struct OfLevels;

impl Groups for OfLevels {
    const GROUPS: &[(Group, &str)] = &[(Group::Weights, "Levels of detail")];
}

/// Number of levels that `--alphas auto` chooses, besides the suggested ones.
const AUTO_LEVELS: usize = 24;

impl Ladder {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        let detail = !(self.counts.is_empty() && self.epsilons.is_empty());
        if self.focus.is_some() && !detail {
            fail_usage!("--focus belongs to levels of detail" => "give --counts or --epsilons too");
        }
        refuse_repeated("--counts", &self.counts)?;
        refuse_repeated("--epsilons", &self.epsilons)?;
        let default: &[&str] = if detail { &["ply"] } else { &[] };
        let meshes = meshes(&self.mesh, default, &ExportOptions::default())?;
        let names: &[&str] = if detail {
            &["detail.csv", "detail.json"]
        } else {
            &[
                "ladder.csv",
                "voids.csv",
                #[cfg(feature = "render")]
                "ladder.png",
                #[cfg(feature = "render")]
                "ladder.svg",
                "ladder.json",
            ]
        };
        let folder = Folder::open(&self.output, "--output", names)?;
        if detail {
            let why = "levels of detail are of volumes, and points repeat in a periodic box";
            self.pipeline.input.typed.refuse(&["periodic"], why)?;
            return self.over_detail(global, &meshes, folder);
        }
        self.over_alpha(global, meshes, folder)
    }

    fn over_alpha(&self, global: Global, meshes: Vec<Mesh>, mut folder: Folder) -> Result<()> {
        let mut progress = Progress::new(global);
        let input = &self.pipeline.input;
        let why = "it belongs to levels of detail (--counts, --epsilons), and here α varies";
        input.typed.refuse(&options::names(&[Group::Weights]), why)?;
        let reference = input.settings().alpha_ref().copied().unwrap_or_default();
        let recipe = self.pipeline.recipe()?.alpha(reference);
        let (mut weighed, volume) = pipeline::weighted_points(input, &recipe, &mut progress)?;
        outline::check(meshes.iter().map(|mesh| mesh.format), weighed.points.positions())?;
        let domain = pipeline::domain(&weighed, volume.as_ref());
        let mut filtration = progress.watch(|| pipeline::filtration(&weighed))?;
        let coordinates = weighed.origin.coordinates;
        let found = || weighed.rule.on(&filtration, coordinates.unit);
        let reference = weighed.parameter.unwrap_or_else(found);
        let mut kept = None;
        if !recipe.keep.is_all() {
            (weighed, kept, _) = progress.watch(|| recipe.part(&weighed, reference.alpha))?;
            filtration = progress.watch(|| pipeline::filtration(&weighed))?;
        }
        let mut facts = LadderSummary::new(&self.pipeline.input.input, &weighed, reference, domain);
        facts.kept = kept;
        let curve = progress.stage(Stage::Curve, || filtration.curve());
        let suggested = progress.stage(Stage::Curve, || filtration.suggest(&curve));
        let alphas = match &self.alphas {
            Alphas::Given(alphas) => alphas.clone(),
            Alphas::Auto => progress.stage(Stage::Curve, || {
                pipeline::readable(&filtration, &curve, AUTO_LEVELS, reference.alpha)
            }),
        };
        let levels = progress.stage(Stage::Ladder, || filtration.levels(&alphas));
        let ladder = progress.stage(Stage::Ladder, || levels.ladder(domain.volume));

        #[cfg(feature = "render")]
        let figure = {
            let title = format!("Ladder of {}, ω frozen", self.pipeline.input.input);
            ladder_figure(&title, &ladder, &curve, &suggested, domain.volume)?
        };
        progress.stage(Stage::Write, || -> Result<()> {
            folder.write("ladder.csv", |out| write_levels(&ladder, out))?;
            folder.write("voids.csv", |out| write_voids(&ladder, out))?;
            #[cfg(feature = "render")]
            {
                let (png, svg) = (figure.to_png()?, figure.to_svg()?);
                folder.write("ladder.png", |out| out.write_all(&png))?;
                folder.write("ladder.svg", |out| out.write_all(svg.as_bytes()))?;
            }
            facts.offsets = write_meshes(&levels, &ladder, coordinates, meshes, &mut folder)?;
            Ok(())
        })?;
        facts.add(&filtration, &curve, suggested, &ladder);
        let mut files = folder.written().to_vec();
        files.push(self.output.join("ladder.json").display().to_string());
        facts.finish(progress.finish(), files);
        folder.write("ladder.json", |out| Ok(serde_json::to_writer_pretty(out, &facts)?))?;
        folder.finish()?;
        print_summary(global, &facts)
    }
}

/// Writes a mesh of each level in each format; says what those in single precision have subtracted.
fn write_meshes(
    levels: &crate::ladder::Levels<'_>,
    ladder: &Levels,
    coordinates: Coordinates,
    meshes: Vec<Mesh>,
    folder: &mut Folder,
) -> Result<Vec<FileOffset>> {
    let (mut offsets, mut told) = (Vec::new(), Told::default());
    if meshes.is_empty() {
        return Ok(offsets);
    }
    let shape_of = |(k, level): (usize, &Level)| {
        levels.shape(k, false, level.betti).with_coordinates(coordinates)
    };
    let each = || ladder.levels.iter().enumerate();
    let meshes = Mesh::together(meshes, ExportOptions::default(), each().map(shape_of));
    for (k, level) in each() {
        let shape = shape_of((k, level));
        for mesh in &meshes {
            let name = level_name(ladder, k, level, &mesh.extension);
            folder.write(&name, |out| mesh.exporter.write(&shape, out))?;
            offsets.extend(told.offset(Path::new(&name), mesh.exporter.as_ref(), &shape));
        }
    }
    Ok(offsets)
}

/// The name of a level's mesh: its position in the ladder, and its α.
fn level_name(ladder: &Levels, k: usize, level: &Level, extension: &str) -> String {
    let digits = ladder.levels.len().to_string().len();
    format!("level-{:0digits$}-alpha-{}.{extension}", k + 1, short(level.alpha.squared()))
}

/// A number for the name of a file, which must not have hundreds of digits.
fn short(number: impl Display + LowerExp) -> String {
    /// Digits of a double, with sign, point and some zeros.
    const LONG: usize = 24;
    let text = number.to_string();
    if text.len() > LONG { format!("{number:e}") } else { text }
}

/// Refuses values that are given twice, because one file would replace the other.
fn refuse_repeated<T: PartialEq + Display>(option: &str, values: &[T]) -> Result<()> {
    match values.iter().enumerate().find(|(k, value)| values[..*k].contains(value)) {
        Some((_, value)) => {
            fail_usage!("{option} names {value} twice" => "each level has a file of its own")
        }
        None => Ok(()),
    }
}

/// A format of meshes.
pub(crate) struct Mesh {
    pub(crate) extension: String,
    pub(crate) format: &'static Format,
    pub(crate) exporter: Box<dyn Exporter>,
}

impl Mesh {
    /// The formats with one offset for shapes that belong together, if some have single precision.
    pub(crate) fn together(
        meshes: Vec<Self>,
        export: ExportOptions,
        shapes: impl Iterator<Item = impl Borrow<AlphaShape>>,
    ) -> Vec<Self> {
        if !meshes.iter().any(|mesh| mesh.format.single) {
            return meshes;
        }
        let export = export.with_common_offset(shapes);
        let with = |mesh: Self| Self { exporter: mesh.format.exporter(&export), ..mesh };
        meshes.into_iter().map(with).collect()
    }
}

/// The formats asked for by their extensions, or else the default ones.
pub(crate) fn meshes(
    asked: &[String],
    default: &[&str],
    export: &ExportOptions,
) -> Result<Vec<Mesh>> {
    let plain = |extension: &str| extension.trim().trim_start_matches('.').to_ascii_lowercase();
    let mut extensions: Vec<String> = asked.iter().map(|extension| plain(extension)).collect();
    refuse_repeated("--mesh", &extensions)?;
    if extensions.is_empty() {
        extensions = default.iter().map(|extension| plain(extension)).collect();
    }
    let mesh = |extension: String| {
        let name = format!("level.{extension}");
        let format = Format::of(Path::new(&name))
            .map_err(|unknown| CommandError::from(unknown).context("--mesh".into()))?;
        Ok(Mesh { exporter: format.exporter(export), format, extension })
    };
    extensions.into_iter().map(mesh).collect()
}

/// Root mean square differences of F from a volume, in gray levels.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct LevelErrors {
    /// On the samples that the shape covers; null if it covers none.
    #[serde(rename = "rmse_inside")]
    pub inside: Option<f64>,
    /// On all samples, with F filled in.
    #[serde(rename = "rmse_filled")]
    pub filled: f64,
}

impl LevelErrors {
    /// The errors of the shape of a volume's points, whose gray levels are given, because the shape may carry other
    /// values. Costs one triangulation, and two passes over the volume.
    pub(crate) fn of(
        shape: &AlphaShape,
        grays: &[f64],
        volume: &Volume,
        units: Units,
    ) -> Result<Self, InterpolateError> {
        let grid = Grid::of(volume, units);
        let rmse = |interpolant: Interpolant<'_>| -> Result<Option<f64>, InterpolateError> {
            Ok(Deviation::of(volume, &interpolant.resample(&grid)?).rmse)
        };
        let inside = rmse(Interpolant::with_values(shape, grays)?)?;
        let (whole, all) = filled_in(shape, grays, volume, units)?;
        let filled = rmse(Interpolant::with_values(&whole, &all)?)?;
        Ok(Self { inside, filled: filled.unwrap_or_default() })
    }
}
