//! Pictures of shapes: the options, and the writer for `.png`.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use clap::{Args, ValueEnum};

use crate::AlphaShape;
use crate::export::{Exporter, Needs};
use crate::pictures::{self, Look};
use crate::points::colours::{
    CLASS_COLUMN, COLOUR_COLUMNS, has_classes, scan_classes, scan_colours,
};
use crate::points::{Attributes, Column, ScanSummary};
use crate::render::{
    self, Background, Ball, Camera, ColourMap, Colouring, Projection, RenderError, Rgb, Scene,
    Size, View,
};

use super::number;
use crate::cli::process::errors::{CommandError, Result, fail};
use crate::settings::parse;

/// Where a picture is taken from, and its size.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Pictures (.png)")]
pub(crate) struct SightArgs {
    /// Viewpoint, for a subject whose face is turned to −y and whose crown to +z [default:
    /// three-quarter].
    #[arg(long, value_enum, value_name = "VIEW", group = "eye")]
    view: Option<ViewArg>,
    /// Eye and target in the units of the points; the field of view is 30°.
    #[arg(long, value_name = "EX,EY,EZ,TX,TY,TZ", value_parser = camera, group = "eye",
          allow_hyphen_values = true)]
    camera: Option<Camera>,
    /// Size of the picture in pixels [default: 1600x1360, and half of it in a terminal].
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<Size>,
}

/// The width and height of pictures.
const SIZE: [u32; 2] = [1600, 1360];

impl SightArgs {
    /// The names of these options.
    pub(crate) const NAMES: [&str; 3] = ["view", "camera", "size"];

    /// The size that is asked for, or the default one divided by a number.
    fn size(&self, divided_by: u32) -> Result<Size, RenderError> {
        let [width, height] = SIZE.map(|side| side / divided_by);
        self.size.map_or_else(|| Size::new(width, height), Ok)
    }

    /// The picture of a scene, as PNG.
    fn draw(&self, scene: &Scene) -> Result<Vec<u8>, RenderError> {
        let view = self.view.map_or(View::ThreeQuarter, View::from);
        let size = self.size(1)?;
        let camera = match self.camera {
            Some(camera) => camera,
            None => scene.camera(view, Projection::Perspective, size)?,
        };
        let picture = scene.render(&camera, size, Background::White)?;
        warn_if_empty(&picture);
        picture.to_png()
    }

    /// The picture of balls with radii and colours, as PNG; those without a colour have that of bone.
    pub(crate) fn draw_balls(
        self,
        balls: impl Iterator<Item = ([f64; 3], f64, Option<[u8; 3]>)>,
    ) -> Result<Vec<u8>, RenderError> {
        let ball = |(centre, radius, colour): (_, _, Option<_>)| Ball {
            centre,
            radius,
            colour: colour.map_or(Rgb::BONE, Rgb),
        };
        let balls = balls.filter(|&(_, radius, _)| radius > 0.0).map(ball).collect();
        let scene = Scene { balls, ..Scene::default() };
        self.draw(&scene)
    }
}

/// How a shape is drawn.
#[derive(Args, Clone, Copy)]
pub(crate) struct PictureArgs {
    #[command(flatten)]
    sight: SightArgs,
    /// What colours show: nothing, the values F, the classes of simplices, the height (z), or of a laser scan its ASPRS
    /// classes or colours [default: of a laser scan asprs, or height where it has no classes; otherwise plain].
    #[arg(
        long,
        visible_alias = "color",
        value_enum,
        value_name = "MEANING",
        help_heading = "Pictures (.png)"
    )]
    colour: Option<ColourArg>,
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

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ColourArg {
    Plain,
    Value,
    Class,
    Height,
    Asprs,
    Rgb,
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

    /// The exporter that writes the picture of a shape whose points have these columns, and may be those of a laser scan.
    pub(crate) fn exporter(self, columns: Arc<[Column]>, is_scan: bool) -> Box<dyn Exporter> {
        Box::new(Picture { args: self, columns, is_scan })
    }

    /// The picture of a shape for a terminal: half as large as that of a file.
    pub(crate) fn in_terminal(
        self,
        shape: &AlphaShape,
        columns: Arc<[Column]>,
        is_scan: bool,
    ) -> Result<render::Picture, RenderError> {
        Picture { args: self, columns, is_scan }.draw(shape, 2)
    }

    /// The columns that the colours need: without an option, those that are there.
    pub(crate) fn columns(self) -> Attributes {
        match self.colour {
            None => Attributes::IfThere(vec![CLASS_COLUMN.to_owned()]),
            Some(ColourArg::Asprs) => Attributes::Named(vec![CLASS_COLUMN.to_owned()]),
            Some(ColourArg::Rgb) => Attributes::Named(COLOUR_COLUMNS.map(str::to_owned).to_vec()),
            Some(_) => Attributes::None,
        }
    }
}

/// A picture of a shape, whose points have these columns.
struct Picture {
    args: PictureArgs,
    columns: Arc<[Column]>,
    is_scan: bool,
}

impl Picture {
    /// What colours show: what was asked for, or what suits the points.
    fn colour(&self) -> ColourArg {
        let has_classes = || scan_classes(&self.columns).is_some_and(|all| has_classes(&all));
        match self.args.colour {
            Some(colour) => colour,
            None if self.is_scan && has_classes() => ColourArg::Asprs,
            None if self.is_scan => ColourArg::Height,
            None => ColourArg::Plain,
        }
    }

    /// The colours of the points, if they have their own.
    fn colours(&self) -> Option<Vec<Rgb>> {
        match self.colour() {
            ColourArg::Asprs => {
                let classes = scan_classes(&self.columns)?.into_iter();
                Some(classes.map(|class| Rgb(ScanSummary::class_colour(class))).collect())
            }
            ColourArg::Rgb => Some(scan_colours(&self.columns)?.into_iter().map(Rgb).collect()),
            _ => None,
        }
    }

    fn draw(&self, shape: &AlphaShape, divided_by: u32) -> Result<render::Picture, RenderError> {
        let positions = shape.points().positions();
        let (values, colours) = (shape.points().values(), self.colours());
        let heights: Vec<f64> = match self.colour() {
            ColourArg::Height => positions.iter().map(|place| place[2]).collect(),
            _ => Vec::new(),
        };
        let over = |numbers: &[f64]| {
            let drawn = pictures::drawn_vertices(shape).map(|v| numbers[v as usize]);
            ColourMap::over(&drawn.collect::<Vec<_>>())
        };
        let colouring = match (self.colour(), values, &colours) {
            (ColourArg::Value, Some(values), _) => Colouring::Values(values, over(values)),
            (ColourArg::Class, ..) => Colouring::Classes,
            (ColourArg::Height, ..) => Colouring::Values(&heights, over(&heights)),
            (.., Some(colours)) => Colouring::Points(colours),
            _ => Colouring::Plain,
        };
        let SightArgs { view, camera, .. } = self.args.sight;
        let view = view.map_or(View::ThreeQuarter, View::from);
        let size = self.args.sight.size(divided_by)?;
        let look = camera.map_or(Look::View(view), Look::Camera);
        let picture = pictures::picture(shape, look, colouring, size)?;
        warn_if_empty(&picture);
        Ok(picture)
    }
}

impl Exporter for Picture {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        if self.colour() == ColourArg::Value && shape.points().values().is_none() {
            return Err(io::Error::other("the points have no values for --colour value"));
        }
        let png = self.draw(shape, 1).and_then(|picture| picture.to_png());
        out.write_all(&png.map_err(io::Error::other)?)
    }

    fn needs(&self) -> Needs {
        Needs::FacetOrLine
    }
}

/// Warns if a picture on white shows nothing.
fn warn_if_empty(picture: &render::Picture) {
    if picture.pixels().iter().all(|&pixel| pixel == [255; 4]) {
        tracing::warn!(
            "the picture is white: nothing lies before the camera, or it is seen edge-on; --view or --camera looks from elsewhere"
        );
    }
}

fn camera(text: &str) -> Result<Camera> {
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_>>()?;
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
    let pixels = |side| {
        let next = Some("give both as in 1600x1360".into());
        parse::whole(side).map_err(|error| CommandError { next, ..CommandError::from(error) })
    };
    Ok(Size::new(pixels(width)?, pixels(height)?)?)
}
