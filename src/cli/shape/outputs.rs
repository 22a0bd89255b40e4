//! Where a shape goes.

use std::io::Write;
use std::path::PathBuf;

use walpha_base::shown::shown;

use crate::AlphaShape;
use crate::cli::picture::PictureArgs;
use crate::cli::said::option;
use crate::export::{
    Content, ExportOptions, Exporter, FORMATS, Format, Target, TargetError, write_all,
};
use crate::outofcore::Pieces;
use crate::points::{ModelFacts, Packing, PointWriter};
use crate::volume::UnknownFormat;

use super::Shape;

/// The outputs by what they take.
#[derive(Default)]
pub(super) struct Outputs {
    /// A file for each block.
    pub pieces: Vec<(Pieces, PathBuf)>,
    /// The shape.
    pub whole: Vec<(Target, Box<dyn Exporter>)>,
    /// The points, and what the shape can be made from again.
    pub models: Vec<(Target, &'static PointWriter)>,
}

impl Outputs {
    /// Looks at what the options name.
    pub(super) fn open(shape: &Shape) -> anyhow::Result<Self> {
        let export = ExportOptions {
            ascii: shape.ascii,
            solid: shape.solid,
            groups: shape.groups,
            input: Some(shape.pipeline.input.input.to_string()),
        };
        let mut outputs = Self::default();
        for path in &shape.output {
            let name = shape.format.named(path)?;
            if let Some(pieces) = Pieces::of(&name) {
                pieces.check(path)?;
                outputs.pieces.push((pieces, path.clone()));
            } else if let Some(writer) = PointWriter::of(&name).ok().filter(|writer| writer.packs) {
                outputs.models.push((Target::open(path)?, writer));
            } else if PictureArgs::wanted(&name) {
                outputs.whole.push((Target::open(path)?, shape.picture.exporter()));
            } else {
                let unknown = |_| UnknownFormat::new(path, "a shape", extensions());
                let format = Format::of(&name).map_err(unknown)?;
                outputs.whole.push((Target::open(path)?, format.exporter(&export)));
            }
        }
        Ok(outputs)
    }

    /// What there is to say of the shape in the formats chosen.
    pub(super) fn remarks(&self, shape: &AlphaShape) -> Vec<String> {
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            let remark = exporter.remark(shape)?.with_names(option);
            Some(format!("{}: {remark}", shown(target.path())))
        };
        self.whole.iter().filter_map(remark).collect()
    }

    /// Writes all that take a whole shape.
    pub(super) fn write(self, shape: &AlphaShape, facts: &ModelFacts) -> Result<(), TargetError> {
        let whole = self.whole.into_iter().map(|(target, exporter)| {
            let content = move |out: &mut dyn Write| exporter.write_any(shape, out);
            (target, Box::new(content) as Content<'_>)
        });
        let models = self.models.into_iter().map(|(target, writer)| {
            let content = move |out: &mut dyn Write| {
                writer.write_model(shape.points(), facts, &Packing::default(), out)
            };
            (target, Box::new(content) as Content<'_>)
        });
        write_all(whole.chain(models))
    }
}

/// Extensions of all formats that a shape is written in.
fn extensions() -> impl Iterator<Item = &'static str> + Clone {
    let pieces = Pieces::ALL.iter().map(|(_, extension)| *extension);
    let models = PointWriter::all().filter(|writer| writer.packs).map(|writer| writer.extension);
    let shapes = FORMATS.iter().map(|format| format.extension);
    shapes.chain(PictureArgs::EXTENSIONS).chain(models).chain(pieces)
}
