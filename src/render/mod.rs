//! Pictures. A scene of triangles, balls and tubes becomes a [`Picture`]; pictures and
//! vector [`Drawing`]s become a [`Figure`] with panels, labels and a colour bar.
//!
//! Every picture is a function of its description alone: the same bytes on any number of threads
//! and in each run. In the three-dimensional part nothing but + − × ÷ √ touches a pixel, which
//! IEEE 754 fixes to the bit, and text is set in fonts that come with the library.
//!
//! ```
//! use walpha::check::{Alpha, enumerate};
//! use walpha::render::{Background, Camera, Projection, Scene, ShapeStyle, Size, View};
//!
//! let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let tetrahedron = enumerate(&positions, &[0.0; 4], Alpha::from_squared(1.0)?)?.complex;
//! let scene = Scene::of_shape(&positions, &tetrahedron, &ShapeStyle::default())?;
//! let size = Size::new(64, 48)?;
//! let bounds = scene.bounds().expect("there is something to see");
//! let camera = Camera::fit(bounds, View::ThreeQuarter, Projection::Perspective, size)?;
//! let png = scene.render(&camera, size, Background::White)?.to_png()?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod base64;
mod charts;
mod error;
mod figure;
mod light;
mod marching;
mod normals;
mod pixels;
mod primitives;
mod renderer;
mod scene;
mod shape;
mod view;

pub use charts::{RateCurve, error_figure, ladder_figure, rate_figure};
pub use error::RenderError;
pub use figure::{ColourBar, Content, Drawing, Figure, Panel, Pen, Step};
pub use marching::Isosurface;
pub use pixels::{ColourMap, PALETTE, Picture, Rgb, Size};
pub use scene::{Background, Ball, Camera, Colours, Mesh, Projection, Scene, Shading, Tube, View};
pub use shape::{Colouring, ShapeStyle, class_colours, plain_colours};
pub use view::{Detail, Differences, Original, Page, Subject};
