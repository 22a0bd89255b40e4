//! Replaces pictures if the command is built without them: there are no options and no files.

use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

use clap::Args;

use crate::AlphaShape;
use crate::export::Exporter;
use crate::points::{Attributes, Column};

#[derive(Args, Clone, Copy)]
pub(crate) struct SightArgs {}

impl SightArgs {
    pub(crate) const NAMES: [&str; 0] = [];

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub(crate) fn draw_balls(
        self,
        _: impl Iterator<Item = ([f64; 3], f64, Option<[u8; 3]>)>,
    ) -> Result<Vec<u8>, std::io::Error> {
        unreachable!("no path asks for a picture")
    }
}

#[derive(Args, Clone, Copy)]
pub(crate) struct PictureArgs {}

impl PictureArgs {
    pub(crate) const NAMES: [&str; 0] = [];
    pub(crate) const EXTENSIONS: [&str; 0] = [];

    pub(crate) fn wanted(_: &Path) -> bool {
        false
    }

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub(crate) fn exporter(self, _: Arc<[Column]>, _: bool) -> Box<dyn Exporter> {
        unreachable!("no path asks for a picture")
    }

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub(crate) fn in_terminal(
        self,
        _: &AlphaShape,
        _: Arc<[Column]>,
        _: bool,
    ) -> Result<Infallible, std::io::Error> {
        unreachable!("no terminal asks for a picture")
    }

    #[expect(clippy::unused_self, reason = "there are no options")]
    pub(crate) fn columns(self) -> Attributes {
        Attributes::None
    }
}
