//! The volume, points, shapes and cameras that the figures share.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Index;
use std::time::Instant;

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use super::{Input, ItemName, Origin, ReproduceError, ShapeNumbers, text};
use crate::haar::{Truncation, smooth};
use crate::pipeline::{Choice, Recipe};
use crate::points::{Points, Units, Weighting, difference, select, weigh};
use crate::render::{
    Background, Camera, Colouring, Content, Panel, Picture, Projection, Scene, ShapeStyle, Size,
    View,
};
use crate::shape::{Alpha, AlphaShape, Balls, Engine, ShapeOptions, alpha_shape};
use crate::volume::{Dims, GrayRange, Volume};

/// The volume on which the paper is reproduced.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The gray levels.
    pub volume: &'a Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The name that a user writes to get this volume: a sample's name, or a file.
    pub name: &'a str,
    /// The day to write into the report, as 2025-12-31.
    pub date: &'a str,
}

impl Subject<'_> {
    /// The command line that makes one item, or all.
    pub(super) fn command(&self, item: Option<ItemName>) -> String {
        let all = format!("walpha reproduce --input {}", text::shell(self.name));
        item.map_or(all.clone(), |item| format!("{all} --only {}", item.as_str()))
    }
}

/// The paper's α for all figures of the skull.
pub(super) const ALPHA: f64 = 10.0;
/// The paper's common factor of Figure 7.
pub(super) const COMMON: f64 = 10.0;

/// The volume, its wavelet approximation, and the points selected.
pub(super) struct Study<'a> {
    pub subject: &'a Subject<'a>,
    pub smoothed: Volume,
    pub truncation: Truncation,
    pub points: Points,
    pub cameras: Cameras,
}

impl<'a> Study<'a> {
    pub(super) fn new(subject: &'a Subject<'a>, monitor: &Monitor) -> Result<Self, ReproduceError> {
        let volume = subject.volume;
        let recipe = Recipe::paper();
        let Choice::Difference(selection) = recipe.choice else {
            unreachable!("the paper selects by difference")
        };
        let (smoothed, truncation) = monitor.watch(|| smooth(volume, &recipe.haar))?;
        let differences = difference(&smoothed);
        let points = select(volume, &smoothed, &differences, &selection, Units::Voxel)?;
        let cameras = Cameras::of(volume.dims());
        Ok(Self { subject, smoothed, truncation, points, cameras })
    }

    pub(super) fn input(&self, origin: Origin) -> Input {
        let dims = self.subject.volume.dims();
        Input {
            name: self.subject.name.to_owned(),
            dims: dims.xyz(),
            samples: dims.samples(),
            origin,
            gray_range: [self.subject.range.low, self.subject.range.high],
            haar: self.truncation,
            points: self.points.len(),
            percent: self.percent(),
        }
    }

    /// Points over samples, in percent.
    pub(super) fn percent(&self) -> f64 {
        100.0 * self.points.len() as f64 / self.subject.volume.dims().samples() as f64
    }

    /// The command `walpha COMMAND INPUT` with the options that select our points, and the paper's weights. Values are gray levels, as here.
    pub(super) fn command(&self, command: &str) -> String {
        format!("walpha {command} {} --preset paper --gray-out", text::shell(self.subject.name))
    }

    /// The shape with these weights at this α, with its exterior simplices.
    pub(super) fn shape(&self, variant: Variant) -> Result<Shaped, ReproduceError> {
        let Variant { weighting, alpha, balls } = variant;
        let alpha = Alpha::from_squared(alpha).expect("a variant's α is a number");
        let weighted = weigh(self.points.clone(), weighting, alpha)?;
        // This is CGAL's engine, as the paper used CGAL.
        let engine = Engine::Cgal;
        let options =
            ShapeOptions::new(alpha).balls(balls).engine(engine).exterior(true).refuse_flat(true);
        let coordinates = Units::Voxel.coordinates(self.subject.volume);
        let shape = alpha_shape(weighted, &options)?.with_coordinates(coordinates);
        let mut command = self.command("shape");
        command += &format!(" --weights {weighting} --alpha {}", alpha.squared());
        if balls == Balls::Radius {
            command += " --balls radius";
        }
        command += " --exterior";
        let numbers = ShapeNumbers::of(&shape, variant.label(), command);
        Ok(Shaped { shape, numbers })
    }
}

/// The parameters of a shape made from the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Variant {
    weighting: Weighting,
    /// A squared length.
    alpha: f64,
    balls: Balls,
}

impl Variant {
    pub(super) fn plain(alpha: f64) -> Self {
        Self { weighting: Weighting::Common(0.0), alpha, balls: Balls::Power }
    }

    pub(super) fn weighted(weighting: Weighting) -> Self {
        Self { weighting, alpha: ALPHA, balls: Balls::Power }
    }

    fn label(self) -> String {
        let weights = match self.weighting {
            Weighting::Common(weight) => format!("ω = {}", text::number(weight)),
            Weighting::MinMax => "min-max".into(),
            Weighting::Barycentric => "barycentric".into(),
            Weighting::BarycentricN => "N × barycentric".into(),
            Weighting::Column => "given ω".into(),
        };
        let balls = if self.balls == Balls::Radius { ", radius α + ω" } else { "" };
        format!("{weights}, α = {}{balls}", text::number(self.alpha))
    }
}

/// A shape and its numbers.
pub(super) struct Shaped {
    pub shape: AlphaShape,
    pub numbers: ShapeNumbers,
}

impl Shaped {
    /// The command line that writes the boundary of this shape, without the figure.
    pub(super) fn makes(&self, file: &str) -> String {
        format!("{} -o {file}", self.numbers.command)
    }
}

/// A shape that several figures use, at α = 10 unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shared {
    /// ω = 0.
    Plain,
    /// ω = 10.
    Common,
    /// ω = 0 at α = 20, which Figure 7 must equal.
    Shifted,
    /// Equation 4.1.
    MinMax,
    /// Equation 4.1 with balls of radius α + ω.
    MinMaxRadius,
    /// ω = 0 at α + the mean of the min-max weights.
    MinMaxMean,
    /// Equation 4.2 as printed.
    Barycentric,
    /// Equation 4.2 times N.
    BarycentricN,
    /// ω = 0 at α = 1, the square of a voxel's edge.
    Edge,
    /// ω = 0 at α = 3, the square of a voxel's diagonal.
    Diagonal,
    /// ω = 0 at α = 50.
    Wide,
    /// ω = 0 at α = 200.
    Wider,
    /// ω = 0 at α = ∞.
    Hull,
}

/// The shapes without weights, by ascending α.
pub(super) const BY_ALPHA: [Shared; 7] = [
    Shared::Edge,
    Shared::Diagonal,
    Shared::Plain,
    Shared::Shifted,
    Shared::Wide,
    Shared::Wider,
    Shared::Hull,
];

impl Shared {
    fn variant(self, study: &Study<'_>) -> Result<Variant, ReproduceError> {
        Ok(match self {
            Self::Plain => Variant::plain(ALPHA),
            Self::Common => Variant::weighted(Weighting::Common(COMMON)),
            Self::Shifted => Variant::plain(ALPHA + COMMON),
            Self::MinMax => Variant::weighted(Weighting::MinMax),
            Self::MinMaxRadius => {
                Variant { balls: Balls::Radius, ..Variant::weighted(Weighting::MinMax) }
            }
            Self::MinMaxMean => {
                let alpha = Alpha::from_squared(ALPHA).expect("a number");
                let weighted = weigh(study.points.clone(), Weighting::MinMax, alpha)?;
                Variant::plain(ALPHA + weighted.summary().mean)
            }
            Self::Barycentric => Variant::weighted(Weighting::Barycentric),
            Self::BarycentricN => Variant::weighted(Weighting::BarycentricN),
            Self::Edge => Variant::plain(1.0),
            Self::Diagonal => Variant::plain(3.0),
            Self::Wide => Variant::plain(50.0),
            Self::Wider => Variant::plain(200.0),
            Self::Hull => Variant::plain(f64::INFINITY),
        })
    }
}

/// The shapes that the requested figures need.
pub(super) struct Shapes(BTreeMap<Shared, Shaped>);

impl Shapes {
    /// Computes the shapes in parallel: CGAL takes one thread for each.
    pub(super) fn new(
        study: &Study<'_>,
        needed: &BTreeSet<Shared>,
    ) -> Result<Self, ReproduceError> {
        let shape = |&shared: &Shared| Ok((shared, study.shape(shared.variant(study)?)?));
        let shapes = needed
            .iter()
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(shape)
            .collect::<Result<Vec<_>, ReproduceError>>()?;
        Ok(Self(shapes.into_iter().collect()))
    }

    /// The shapes without weights, by ascending α.
    pub(super) fn by_alpha(&self) -> [&Shaped; 7] {
        BY_ALPHA.map(|shared| &self[shared])
    }
}

impl Index<Shared> for Shapes {
    type Output = Shaped;

    /// # Panics
    /// The item does not list this shape among those that it needs.
    fn index(&self, shared: Shared) -> &Shaped {
        &self.0[&shared]
    }
}

/// The viewpoint on a head whose face is turned to −y and whose crown to +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Eye {
    /// Seen from the front and a little to its left: the portrait.
    Portrait,
    /// Seen from its left.
    Side,
}

/// Cameras for one volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cameras {
    target: [f64; 3],
    /// The longest axis divided by 64 samples.
    scale: f64,
    /// The last sample.
    high: [f64; 3],
}

/// Pixels of a panel with a shape, two in a row.
pub(super) fn panel_size() -> Size {
    Size::new(900, 960).expect("a valid size")
}

impl Cameras {
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
        let camera = scene.camera(View::ThreeQuarter, Projection::Perspective, size)?;
        Ok(scene.render(&camera, size, Background::White)?)
    }

    /// The picture of a shape, in the colour of bone.
    pub(super) fn shape(&self, shape: &AlphaShape, eye: Eye) -> Result<Picture, ReproduceError> {
        let style = ShapeStyle { colouring: Colouring::Plain, ..ShapeStyle::default() };
        self.render(&Scene::of_shape(shape.points().positions(), shape.complex(), &style)?, eye)
    }
}

/// A panel of a picture, with a title and captions.
pub(super) fn panel(title: impl Into<String>, picture: Picture, captions: Vec<String>) -> Panel {
    Panel { title: title.into(), content: Content::Picture(picture), captions }
}

/// Times stages, and logs them.
pub(super) struct Clock<'a> {
    monitor: &'a Monitor,
    running: Option<(&'static str, Instant)>,
    started: Instant,
    seconds: Vec<(&'static str, f64)>,
}

impl<'a> Clock<'a> {
    pub(super) fn new(monitor: &'a Monitor) -> Self {
        Self { monitor, running: None, started: Instant::now(), seconds: Vec::new() }
    }

    /// Ends the running stage and starts another. Times of stages with the same name add up.
    pub(super) fn enter(&mut self, name: &'static str) -> Result<(), Cancelled> {
        self.end();
        self.monitor.stage(name)?;
        self.running = Some((name, Instant::now()));
        Ok(())
    }

    fn end(&mut self) {
        if let Some((name, since)) = self.running.take() {
            let seconds = since.elapsed().as_secs_f64();
            match self.seconds.iter_mut().find(|stage| stage.0 == name) {
                Some(stage) => stage.1 += seconds,
                None => self.seconds.push((name, seconds)),
            }
        }
    }

    /// Seconds of each stage, and in all.
    pub(super) fn stop(mut self) -> Vec<(&'static str, f64)> {
        self.end();
        self.seconds.push(("total", self.started.elapsed().as_secs_f64()));
        self.seconds
    }
}
