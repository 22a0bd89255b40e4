//! Floor 5: pictures. A scene of triangles, balls and tubes becomes a [`Picture`]; pictures and
//! vector [`Drawing`]s become a [`Figure`] with panels, labels and a colour bar.
//!
//! Every picture is a function of its description alone: the same bytes on any number of threads
//! and in each run. In the three-dimensional part nothing but + − × ÷ √ touches a pixel, which
//! IEEE 754 fixes to the bit, and text is set in fonts that come with the library.

mod camera;
mod capsule;
mod colour;
mod drawing;
mod error;
mod facets;
mod figure;
mod ladder;
mod light;
mod marching;
mod occlusion;
mod picture;
mod raster;
mod scene;
mod shape;
mod sphere;
mod svg;
mod ticks;
mod tile;
mod tiles;
mod triangle;
mod vector;
mod view;

pub use camera::{Camera, Projection, View};
pub use colour::{ColourMap, PALETTE, Rgb};
pub use drawing::{Drawing, Pen, Step};
pub use error::RenderError;
pub use figure::{ColourBar, Content, Figure, Panel};
pub use ladder::ladder_figure;
pub use marching::Isosurface;
pub use picture::{Picture, Size};
pub use scene::{Background, Ball, Colours, Mesh, Scene, Shading, Tube};
pub use shape::{Colouring, ShapeStyle, class_colours, plain_colours};
pub(crate) use svg::base64;
pub use view::{Original, Page, Subject};
