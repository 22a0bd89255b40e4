use crate::light::{Exposure, Studio};
use crate::scene::{Lens, Scene};

/// All that shading needs to know.
pub(crate) struct Stage<'a> {
    pub scene: &'a Scene,
    pub lens: Lens,
    pub studio: Studio,
    pub exposure: Exposure,
}
