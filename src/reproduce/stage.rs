//! One camera for all pictures of a volume.

use super::ReproduceError;
use crate::render::{
    Background, Camera, Colouring, Content, Panel, Picture, Scene, ShapeStyle, Size,
};
use crate::shape::AlphaShape;
use crate::volume::Dims;

/// Where the eye is and what it looks at: a face that is turned to −y with its crown to +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    eye: [f64; 3],
    target: [f64; 3],
}

/// Pixels of a panel in a row of `columns`.
pub(super) fn panel_size(columns: usize) -> Size {
    let (width, height) = if columns == 1 { (1600, 1360) } else { (1080, 980) };
    Size::new(width, height).expect("a size that is right")
}

impl Stage {
    /// For 64³ samples the eye is at (90, −110, 60), and looks at (32, 32, 30).
    pub fn of(dims: Dims) -> Self {
        let scales = dims.xyz().map(|n| n as f64 / 64.0);
        let largest = scales.iter().fold(0.0, |a: f64, &b| a.max(b));
        let target = [32.0 * scales[0], 32.0 * scales[1], 30.0 * scales[2]];
        let away = [58.0, -142.0, 30.0].map(|d| d * largest);
        Self { eye: [0, 1, 2].map(|k| target[k] + away[k]), target }
    }

    /// The options of `walpha shape` for this camera and a picture of this size.
    pub fn options(&self, size: Size) -> String {
        let all = [self.eye, self.target].concat();
        let numbers: Vec<String> = all.iter().map(f64::to_string).collect();
        format!("--camera={} --size {}x{}", numbers.join(","), size.width(), size.height())
    }

    pub fn render(&self, scene: &Scene, size: Size) -> Result<Picture, ReproduceError> {
        let camera = Camera::portrait(self.eye, self.target);
        Ok(scene.render(&camera, size, Background::White)?)
    }

    /// The picture of a shape, in the colour of bone.
    pub fn shape(&self, shape: &AlphaShape, size: Size) -> Result<Picture, ReproduceError> {
        let style = ShapeStyle { colouring: Colouring::Plain, ..ShapeStyle::default() };
        self.render(&Scene::of_shape(&shape.points().positions, shape.complex(), &style)?, size)
    }
}

/// A picture with words around it.
pub(super) fn panel(title: impl Into<String>, picture: Picture, captions: Vec<String>) -> Panel {
    Panel { title: title.into(), content: Content::Picture(picture), captions }
}
