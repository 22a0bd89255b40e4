//! Pictures of shapes: the options, and the writer for `.png`.

use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use crate::AlphaShape;
use crate::export::{Exporter, Needs};
use crate::pictures::{self, Look};
use crate::render::{Camera, ColourMap, Colouring, RenderError, Size, View};

use crate::cli::process::errors::{Result, command_error, fail};

/// How a shape is drawn.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Pictures (.png)")]
pub(crate) struct PictureArgs {
    /// Viewpoint, for a subject whose face is turned to −y and whose crown to +z [default:
    /// three-quarter].
    #[arg(long, value_enum, value_name = "VIEW", group = "eye")]
    view: Option<ViewArg>,
    /// Eye and target in the units of the points; the field of view is 30°.
    #[arg(long, value_name = "EX,EY,EZ,TX,TY,TZ", value_parser = camera, group = "eye",
          allow_hyphen_values = true)]
    camera: Option<Camera>,
    /// What colours show: nothing, the values F, or the classes of simplices.
    #[arg(long, visible_alias = "color", value_enum, default_value_t, value_name = "MEANING")]
    colour: ColourArg,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1600x1360")]
    size: Size,
}

#[derive(Clone, Copy, ValueEnum)]
enum ViewArg {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    ThreeQuarter,
}

impl From<ViewArg> for View {
    fn from(view: ViewArg) -> Self {
        match view {
            ViewArg::Front => Self::Front,
            ViewArg::Back => Self::Back,
            ViewArg::Left => Self::Left,
            ViewArg::Right => Self::Right,
            ViewArg::Top => Self::Top,
            ViewArg::Bottom => Self::Bottom,
            ViewArg::ThreeQuarter => Self::ThreeQuarter,
        }
    }
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum ColourArg {
    #[default]
    Plain,
    Value,
    Class,
}

impl PictureArgs {
    /// The names of these options.
    pub(crate) const NAMES: [&str; 4] = ["view", "camera", "colour", "size"];

    /// The extensions of pictures.
    pub(crate) const EXTENSIONS: [&str; 1] = ["png"];

    /// Whether the extension of a path is that of a picture.
    pub(crate) fn wanted(path: &Path) -> bool {
        let extension = path.extension().and_then(OsStr::to_str);
        extension.is_some_and(|e| Self::EXTENSIONS.iter().any(|png| e.eq_ignore_ascii_case(png)))
    }

    /// The exporter that writes the picture.
    pub(crate) fn exporter(self) -> Box<dyn Exporter> {
        Box::new(self)
    }

    fn draw(&self, shape: &AlphaShape) -> Result<Vec<u8>, RenderError> {
        let values = shape.points().values();
        let colouring = match (self.colour, values) {
            (ColourArg::Value, Some(values)) => Colouring::Values(values, ColourMap::over(values)),
            (ColourArg::Class, _) => Colouring::Classes,
            _ => Colouring::Plain,
        };
        let view = self.view.map_or(View::ThreeQuarter, View::from);
        let look = self.camera.map_or(Look::View(view), Look::Camera);
        pictures::png(shape, look, colouring, self.size)
    }
}

impl Exporter for PictureArgs {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        if self.colour == ColourArg::Value && shape.points().values().is_none() {
            return Err(io::Error::other(
                "the points have no values to colour by; choose --colour plain or class",
            ));
        }
        out.write_all(&self.draw(shape).map_err(io::Error::other)?)
    }

    fn needs(&self) -> Needs {
        Needs::FacetOrLine
    }
}

fn camera(text: &str) -> Result<Camera> {
    let numbers: Vec<f64> = text.split(',').map(parsed).collect::<Result<_>>()?;
    let [ex, ey, ez, tx, ty, tz] = numbers[..] else {
        fail!("six numbers are needed" => "give where the eye is and what it looks at, as in 99,0,9,0,0,0");
    };
    let (eye, target) = ([ex, ey, ez], [tx, ty, tz]);
    if eye == target || !numbers.iter().all(|v| v.is_finite()) {
        fail!("the eye and what it looks at must be two places, with finite coordinates");
    }
    Ok(Camera::portrait(eye, target))
}

fn size(text: &str) -> Result<Size> {
    let Some((width, height)) = text.split_once(['x', '×']) else {
        fail!("two numbers are needed" => "give them as in 1600x1360");
    };
    Ok(Size::new(parsed(width)?, parsed(height)?)?)
}

fn parsed<T: FromStr<Err: Display>>(number: &str) -> Result<T> {
    number.trim().parse().map_err(|error| command_error!("{error}"))
}
