//! Replaces pictures where the command is built without them: no options, no files.

use std::path::Path;

use clap::Args;

use crate::export::Exporter;

#[derive(Args, Clone, Copy)]
pub struct PictureArgs {}

impl PictureArgs {
    pub const NAMES: [&str; 0] = [];
    pub const EXTENSIONS: [&str; 0] = [];

    pub fn wanted(_: &Path) -> bool {
        false
    }

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub fn exporter(self) -> Box<dyn Exporter> {
        unreachable!("no path asks for a picture")
    }
}
