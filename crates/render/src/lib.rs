//! Pictures. A scene of triangles, balls and tubes becomes a [`Picture`]; pictures and
//! vector drawings become a [`Figure`] with panels, labels and a colour bar.
//!
//! Every picture depends only on its description: the same bytes on any number of threads and in each run. In the
//! three-dimensional part, pixels are computed only by + − × ÷ √, which IEEE 754 fixes to the bit, and text is set in fonts that
//! come with the library.
//!
//! ```
//! use walpha_render::{Background, Projection, Scene, ShapeStyle, Size, View};
//! use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
//!
//! let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let options = ShapeOptions::new(Alpha::from_squared(1.0)?);
//! let shape = alpha_shape(WeightedPoints::unweighted(corners), &options)?;
//!
//! let style = ShapeStyle::default();
//! let scene = Scene::of_shape(shape.points().positions(), shape.complex(), &style)?;
//! let size = Size::new(64, 48)?;
//! let camera = scene.camera(View::ThreeQuarter, Projection::Perspective, size)?;
//! let png = scene.render(&camera, size, Background::White)?.to_png()?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// The macro of ndarray for slices allows it internally, so it cannot be forbidden.
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

mod charts;
mod colour;
mod depth;
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

pub use charts::{RateCurve, ladder_figure, persistence_figure, rate_figure};
pub use colour::{ColourMap, PALETTE, Rgb};
pub use error::RenderError;
pub use figure::Figure;
pub use marching::Isosurface;
pub use pixels::{Picture, Size};
pub use scene::{Background, Ball, Camera, Colours, Mesh, Projection, Scene, Shading, Tube, View};
pub use shape::{Colouring, ShapeStyle, class_colours, plain_colours};
pub use view::{Detail, Differences, Kinds, Original, Page, Subject};
pub use walpha_base::advice::Advise;

// For the figures and the report of walpha. Not covered by semantic versioning.
#[doc(hidden)]
#[doc(hidden)]
pub use figure::{ColourBar, Content, Drawing, Panel, Pen, Scale, Step};

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
