use crate::light::{Exposure, Studio};
use crate::scene::{Lens, Scene};

/// The inputs of shading.
pub(crate) struct Stage<'a> {
    pub scene: &'a Scene,
    pub lens: Lens,
    pub studio: Studio,
    pub exposure: Exposure,
}
