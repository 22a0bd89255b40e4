//! Stands in for pictures if the command is built without them: no options, no files.

use std::path::Path;

use clap::Args;

use crate::export::Exporter;

#[derive(Args, Clone, Copy)]
pub(super) struct PictureArgs {}

impl PictureArgs {
    pub(super) const NAMES: [&str; 0] = [];
    pub(super) const EXTENSIONS: [&str; 0] = [];

    pub(super) fn wanted(_: &Path) -> bool {
        false
    }

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub(super) fn exporter(self) -> Box<dyn Exporter> {
        unreachable!("no path asks for a picture")
    }
}
