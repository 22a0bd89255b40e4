//! `walpha shape` without α: the solid of the labels of a segmentation, in one file or in one for each label, and the solid inside
//! an isosurface.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::path::Path;

use serde::Serialize;
use walpha_base::shown::grouped;

use crate::cli::commands::folder::Folder;
use crate::cli::commands::ladder::{Mesh, meshes};
use crate::cli::commands::pipeline;
use crate::cli::commands::shape::{Outputs, Shape, unused};
use crate::cli::options::global::Global;
use crate::cli::options::refuse_gray_levels;
use crate::cli::process::errors::{Result, fail_usage};
use crate::cli::process::output::print_summary;
use crate::cli::process::progress::Progress;
use crate::cli::report::offsets::{FileOffset, Told, print_offsets};
use crate::cli::report::{Report, SCHEMA_VERSION, ending, measure, print_cuts, print_kept};
use crate::labels::{LabelChoice, LabelSize, chosen};
use crate::pipeline::{Input, Model};
use crate::points::ModelMetadata;
use crate::progress::Stage;
use crate::shape::{Betti, Cuts, Kept};
use crate::volume::Volume;
use crate::{AlphaShape, Coordinates, Recipe};

/// The default format of the solids.
const DEFAULT_MESH: &str = "stl";

impl Shape {
    /// Computes the solid of the labels that the recipe names.
    pub(crate) fn of_labels(
        &self,
        volume: &Volume,
        recipe: &Recipe,
        outputs: Outputs,
        progress: &mut Progress,
    ) -> Result<Report> {
        refuse_gray_levels(&self.pipeline.input)?;
        self.refuse_for("the solid of labels", &outputs)?;
        let model = progress.watch(|| recipe.solid(volume))?;
        self.deliver_solid(volume, &model, outputs, progress)
    }

    /// Makes the solid inside the isosurface that the recipe names.
    pub(crate) fn of_surface(
        &self,
        volume: &Volume,
        recipe: &Recipe,
        outputs: Outputs,
        progress: &mut Progress,
    ) -> Result<Report> {
        self.refuse_for("the solid inside an isosurface", &outputs)?;
        let surface = recipe.surface.expect("the recipe names one");
        let model = progress.watch(|| recipe.solid_inside(volume, surface))?;
        self.deliver_solid(volume, &model, outputs, progress)
    }

    /// Refuses outputs that hold points alone, from which a shape is made by α, and what has no effect on a solid that has none.
    fn refuse_for(&self, solid: &str, outputs: &Outputs) -> Result<()> {
        unused("--require-3d", self.require_3d, &format!("{solid} spans a volume"))?;
        if let Some((target, _)) = outputs.models.first() {
            let name = walpha_base::shown::shown(target.path());
            fail_usage!("{name} holds points, of which shapes are made by α, and this is {solid}" => "write a mesh, .json or .npz");
        }
        Ok(())
    }

    fn deliver_solid(
        &self,
        volume: &Volume,
        model: &Model,
        outputs: Outputs,
        progress: &mut Progress,
    ) -> Result<Report> {
        let mut report = Report::of_solid(&self.pipeline.input.input, volume.dims().xyz(), model);
        progress.stage(Stage::Measure, || report.add_shape(model));
        self.deliver(&model.shape, &ModelMetadata::default(), report, outputs, progress)
    }

    /// Computes the solid of each label, and writes it to a separate file.
    pub(crate) fn each_label(&self, recipe: &Recipe, global: Global) -> Result<()> {
        let [folder] = &self.output[..] else {
            fail_usage!("--each-label writes a file for each label to one folder" => "name it, as in -o labels");
        };
        let meshes = self.meshes()?;
        if recipe.surface.is_some() {
            fail_usage!("--each-label has no effect: an isosurface has no labels" => "omit it, or --surface");
        }
        let choice = recipe.labels.clone().unwrap_or(LabelChoice::All);
        let recipe = recipe.clone().labels(Some(choice.clone()));
        refuse_gray_levels(&self.pipeline.input)?;
        let mut folder = Folder::open(folder, "--output", &[])?;
        let mut progress = Progress::new(global);
        let input = &self.pipeline.input;
        let read = pipeline::read(input, &recipe, &mut progress)?;
        pipeline::accept(&read, input)?;
        let Input::Volume(volume) = read else {
            fail_usage!("{} holds points, which have no labels", input.input => "omit --each-label");
        };
        let (mut solids, mut told) = (Vec::new(), Told::default());
        let mut coordinates = volume.frame().coordinates;
        for (label, voxels) in chosen(&volume, &choice)? {
            let one = vec![(label, voxels)];
            let model = progress.watch(|| recipe.solid_of(&volume, one))?;
            coordinates = model.origin.coordinates;
            let shape = &model.shape;
            let stem = format!("label-{label}");
            let (files, offsets) =
                write_part(&mut folder, &meshes, &stem, shape, &mut told, &mut progress)?;
            let size = model.labels.as_ref().and_then(|sizes| sizes.labels.first().copied());
            let size = size.expect("a label that is there");
            let solid = self.solid.then(|| shape.solid().1);
            let (betti, kept) = (shape.betti(), shape.kept());
            solids.push(SolidSummary { size, betti, kept, solid, files, offsets });
        }
        folder.finish()?;
        print_summary(
            global,
            &EachLabel {
                schema_version: SCHEMA_VERSION,
                input: input.input.to_string(),
                coordinates,
                labels: solids,
                seconds: progress.finish().into_iter().collect(),
            },
        )
    }

    /// The formats for `--each-label`.
    pub(crate) fn meshes(&self) -> Result<Vec<Mesh>> {
        meshes(&self.mesh, &[DEFAULT_MESH], &self.export())
    }
}

/// Writes the meshes of a part to a folder, under a name with the extension of each. Returns the paths, and the offsets that files
/// in single precision have subtracted from coordinates, which `offset` finds.
pub(crate) fn write_part<'a>(
    folder: &mut Folder,
    meshes: impl IntoIterator<Item = &'a Mesh>,
    stem: &str,
    shape: &AlphaShape,
    told: &mut Told,
    progress: &mut Progress,
) -> Result<(Vec<String>, Vec<FileOffset>)> {
    let (mut files, mut offsets) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let name = format!("{stem}.{}", mesh.extension);
        offsets.extend(told.offset(Path::new(&name), mesh.exporter.as_ref(), shape));
        progress
            .stage(Stage::Write, || folder.write(&name, |out| mesh.exporter.write(shape, out)))?;
        files.extend(folder.written().last().cloned());
    }
    Ok((files, offsets))
}

/// The summary printed after writing a solid for each label.
#[derive(Serialize)]
struct EachLabel {
    schema_version: u32,
    input: String,
    coordinates: Coordinates,
    labels: Vec<SolidSummary>,
    seconds: BTreeMap<&'static str, f64>,
}

/// The solid of a label.
#[derive(Serialize)]
struct SolidSummary {
    #[serde(flatten)]
    size: LabelSize,
    betti: Option<Betti>,
    /// How many of its components were kept, if not all were to be.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept: Option<Kept>,
    /// Where the boundary was cut apart, if it is written as that of a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    solid: Option<Cuts>,
    files: Vec<String>,
    /// The offsets that files in single precision have subtracted from coordinates, if they have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    offsets: Vec<FileOffset>,
}

impl Display for EachLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.coordinates.unit;
        writeln!(f, "input     {}", crate::cli::process::output::name(&self.input))?;
        writeln!(f, "lengths   in {}", self.coordinates)?;
        for SolidSummary { size, betti, kept, solid, .. } in &self.labels {
            let LabelSize { label, voxels, volume, .. } = size;
            let volume = measure(*volume, unit, 3);
            write!(f, "label     {label}: {} voxels, {volume}", grouped(*voxels))?;
            match betti {
                Some(betti) => writeln!(f, "; {betti}")?,
                None => writeln!(f)?,
            }
            if let Some(kept) = kept {
                print_kept(f, kept, unit)?;
            }
            if let Some(cuts) = solid {
                print_cuts(f, cuts, unit)?;
            }
        }
        let offsets = self.labels.iter().flat_map(|solid| &solid.offsets);
        print_offsets(offsets, f)?;
        let files: Vec<String> = self.labels.iter().flat_map(|solid| solid.files.clone()).collect();
        ending(f, &files, &["read", "shape", "write", "total"], &self.seconds)
    }
}
