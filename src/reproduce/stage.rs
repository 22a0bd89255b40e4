//! The cameras that all pictures of a volume share.

use super::ReproduceError;
use crate::render::{
    Background, Camera, Colouring, Content, Panel, Picture, Projection, Scene, ShapeStyle, Size,
    View,
};
use crate::shape::AlphaShape;
use crate::volume::Dims;

/// From where a head is seen whose face is turned to −y and whose crown to +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Eye {
    /// From the front and a little to its left: the portrait.
    Portrait,
    /// From its left.
    Side,
}

/// What is looked at, and the size of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    target: [f64; 3],
    /// The longest axis over 64 samples.
    scale: f64,
    /// The last sample.
    high: [f64; 3],
}

/// Pixels of a panel with a shape, two in a row.
pub(super) fn panel_size() -> Size {
    Size::new(900, 960).expect("a size that is right")
}

impl Stage {
    pub(super) fn of(dims: Dims) -> Self {
        let scales = dims.xyz().map(|n| n as f64 / 64.0);
        Self {
            target: [32.0 * scales[0], 32.0 * scales[1], 30.0 * scales[2]],
            scale: scales.iter().fold(0.0, |a: f64, &b| a.max(b)),
            high: dims.xyz().map(|n| (n - 1) as f64),
        }
    }

    /// For 64³ samples the portrait is taken from (90, −110, 60), looking at (32, 32, 30).
    fn place(&self, eye: Eye) -> [f64; 3] {
        let away = match eye {
            Eye::Portrait => [58.0, -142.0, 30.0],
            Eye::Side => [150.0, -36.0, 22.0],
        };
        [0, 1, 2].map(|k| self.target[k] + away[k] * self.scale)
    }

    /// The options of `walpha shape` that draw a shape as the portrait panels do.
    pub(super) fn options(&self) -> String {
        let all = [self.place(Eye::Portrait), self.target].concat();
        let numbers: Vec<String> = all.iter().map(f64::to_string).collect();
        let size = panel_size();
        format!("--camera={} --size {}x{}", numbers.join(","), size.width(), size.height())
    }

    pub(super) fn render(&self, scene: &Scene, eye: Eye) -> Result<Picture, ReproduceError> {
        let camera = Camera::portrait(self.place(eye), self.target);
        Ok(scene.render(&camera, panel_size(), Background::White)?)
    }

    /// The picture of a scene within the whole box of the volume, in the portrait's direction.
    pub(super) fn render_box(
        &self,
        mut scene: Scene,
        size: Size,
    ) -> Result<Picture, ReproduceError> {
        let bounds = [[0.0; 3], self.high];
        let tube = 0.12 * self.scale;
        scene.add_box(bounds, tube, crate::render::Rgb([110, 110, 110]));
        let camera = Camera::fit(bounds, View::ThreeQuarter, Projection::Perspective, size)?;
        Ok(scene.render(&camera, size, Background::White)?)
    }

    /// The picture of a shape, in the colour of bone.
    pub(super) fn shape(&self, shape: &AlphaShape, eye: Eye) -> Result<Picture, ReproduceError> {
        let style = ShapeStyle { colouring: Colouring::Plain, ..ShapeStyle::default() };
        self.render(&Scene::of_shape(&shape.points().positions, shape.complex(), &style)?, eye)
    }
}

/// A picture with words around it.
pub(super) fn panel(title: impl Into<String>, picture: Picture, captions: Vec<String>) -> Panel {
    Panel { title: title.into(), content: Content::Picture(picture), captions }
}
