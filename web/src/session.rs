//! The opened and computed data, and the answers to requests.

use std::path::Path;

use serde_json::{Map, json};
use walpha_balls::{BallUnion, with_probe};
use walpha_model::Settings;
use walpha_model::pipeline::{AlphaRule, Input, Opened as OpenInput, Values};
use walpha_model::progress::{Listener, Monitor, Stage};
use walpha_model::settings::PRESETS;
use walpha_points::{
    Attributes, ModelMetadata, PointOptions, Points, bounding_box, read_model_file,
};
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, WeightedPoints, alpha_shape};
use walpha_volume::{
    self as volume, Dims, Hounsfield, Labels, ReadOptions, SampleStats, Series, Volume,
};

use crate::answer::{Answer, Array};
use crate::failure::Failure;
use crate::made::{Made, What};
use crate::request::Request;

/// Bars of the histogram.
const BARS: usize = 256;

/// Volumes of more samples than this are made coarser: a page has 4 GiB.
const MOST_SAMPLES: f64 = (1u64 << 26) as f64;

/// The data that the page works on.
pub(crate) struct Session {
    input: String,
    opened: Option<Opened>,
    made: Option<Made>,
}

/// The content of the input, without changes.
#[expect(clippy::large_enum_variant, reason = "there is one")]
enum Opened {
    Volume(Volume),
    Points(Points, ModelMetadata),
}

/// Passes progress on to the page.
struct ToPage;

#[cfg(target_family = "wasm")]
mod page {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        /// A stage begins: place and length of its name.
        pub(super) safe fn stage(name: usize, length: usize);
        /// This share of the stage is done.
        pub(super) safe fn progress(share: f64);
    }
}

impl Listener for ToPage {
    fn stage(&self, name: &'static str) {
        #[cfg(target_family = "wasm")]
        page::stage(name.as_ptr() as usize, name.len());
        let _ = name;
    }

    fn progress(&self, done: u64, total: u64) {
        #[cfg(target_family = "wasm")]
        page::progress(done as f64 / total.max(1) as f64);
        let _ = (done, total);
    }
}

impl Session {
    pub(crate) const EMPTY: Self = Self { input: String::new(), opened: None, made: None };

    /// Carries out a request.
    pub(crate) fn answer(&mut self, request: Request) -> Answer {
        match Monitor::new(ToPage).watch(|| self.carry_out(request)) {
            Ok(answer) => answer,
            Err(Failure { why, next }) => Answer::failed(&why, next),
        }
    }

    fn carry_out(&mut self, request: Request) -> Result<Answer, Failure> {
        match request {
            Request::Presets => Ok(presets()),
            Request::Open { input, options } => self.open(input, &options),
            Request::Plane { axis, index } => self.plane(axis, index),
            Request::Shape { options } => self.shape(options),
            Request::Filtration => self.made_mut()?.filtration(),
            Request::At { alpha } => self.made()?.at(alpha),
            Request::Measure { alpha } => self.made()?.measure(alpha),
            Request::Voids { alpha, most } => self.made()?.voids(alpha, most),
            Request::Balls { probe } => self.balls(probe),
            Request::Section { alpha, axis, place } => self.made()?.section(alpha, axis, place),
            Request::Suggest => self.made()?.suggest(),
            Request::Diagram => self.made_mut()?.diagram(),
            Request::Cycle { dimension, simplex } => self.made()?.cycle(dimension, simplex),
            Request::Save { name, alpha, solid } => {
                self.made()?.save(&self.input, &name, alpha, solid)
            }
            Request::Command { name, alpha, solid } => {
                self.made()?.command(&self.input, &name, alpha, solid)
            }
        }
    }

    fn made(&self) -> Result<&Made, Failure> {
        self.made.as_ref().ok_or_else(Failure::of_no_shape)
    }

    fn made_mut(&mut self) -> Result<&mut Made, Failure> {
        self.made.as_mut().ok_or_else(Failure::of_no_shape)
    }

    fn open(&mut self, input: String, settings: &Settings) -> Result<Answer, Failure> {
        *self = Self { input, ..Self::EMPTY };
        let input = Path::new(&self.input);
        Stage::Read.begin()?;
        let recipe = settings.recipe()?;
        if input.is_dir() && settings.series().is_none() {
            let series: Vec<Series> = volume::series(input)?;
            if series.len() > 1 {
                return Ok(Answer::of(json!({ "kind": "series", "series": series }), Vec::new()));
            }
        }
        let file = match recipe.opened(input)? {
            OpenInput::Volume(file) => file,
            OpenInput::Made(points, metadata) => return Ok(self.keep(points, metadata)),
            OpenInput::Points(file) => {
                let of_points = PointOptions::default()
                    .columns(recipe.columns.clone())
                    .attributes(Attributes::All);
                let (points, metadata) = read_model_file(&file, &of_points)?;
                return Ok(self.keep(points, metadata));
            }
        };
        // Before it is read, where the format says how large it is; samples are small.
        if !self.input.starts_with("sample:")
            && let Ok(source) = file.source(&recipe.read)
            && let Some(answer) = too_large(source.dims(), &recipe.read)
        {
            return Ok(answer);
        }
        // Values are not changed: gray levels follow the window, which changes.
        let volume = file.read(&recipe.read)?;
        if let Some(answer) = too_large(volume.dims(), &recipe.read) {
            return Ok(answer);
        }
        let answer = describe_volume(&volume);
        self.opened = Some(Opened::Volume(volume));
        Ok(answer)
    }

    /// Keeps points as the input, and describes them.
    fn keep(&mut self, points: Points, metadata: ModelMetadata) -> Answer {
        let answer = describe_points(&points, &metadata);
        self.opened = Some(Opened::Points(points, metadata));
        answer
    }

    fn plane(&self, axis: usize, index: usize) -> Result<Answer, Failure> {
        let Some(Opened::Volume(volume)) = &self.opened else {
            return Err(Failure::new("points have no planes"));
        };
        let dims = volume.dims().xyz();
        if axis > 2 || index >= dims[axis] {
            return Err(Failure::new(format!("there is no plane {index} across axis {axis}")));
        }
        // The array is [z, y, x].
        let samples = volume.samples();
        let plane = samples.index_axis(ndarray::Axis(2 - axis), index);
        let (rows, columns) = plane.dim();
        let values = plane.iter().copied().collect();
        let head = json!({ "columns": columns, "rows": rows });
        Ok(Answer::of(head, vec![Array::F32("values", values)]))
    }

    fn shape(&mut self, settings: Settings) -> Result<Answer, Failure> {
        self.made = None;
        let recipe = settings.recipe()?;
        if matches!(recipe.alpha, AlphaRule::Given(alpha) if alpha.squared().is_infinite()) {
            return Err(Failure::new("α of the weights has to be finite here"));
        }
        let (mut columns, mut elements, mut is_scan) = (Vec::new(), Vec::new(), false);
        let input =
            match self.opened.as_ref().ok_or_else(|| Failure::new("nothing has been opened"))? {
                Opened::Points(points, metadata) => {
                    let mut points = points.clone();
                    is_scan = metadata.scan.is_some();
                    columns = std::mem::take(&mut points.columns);
                    let atoms = points.molecule.iter().flat_map(|molecule| &molecule.atoms);
                    elements = atoms.map(|atom| atom.element).collect();
                    Input::Points(points, metadata.clone())
                }
                Opened::Volume(volume) if recipe.labels.is_some() || recipe.surface.is_some() => {
                    let model = recipe.run(volume.clone())?;
                    let shape = model.shape.clone();
                    return Ok(self.keep_made(Made::solid(settings, recipe, model), &shape));
                }
                Opened::Volume(volume) => Input::Volume(volume.clone()),
            };
        let (mut weighed, source) = recipe.weigh(input, Values::Written)?;
        let metadata = weighed.metadata(source.as_ref().map(|source| source.written));
        let [low, high] = bounding_box(weighed.points.positions());
        let domain = match &source {
            Some(source) => source.units.box_volume(&source.volume),
            None => (weighed.origin.torus.and_then(|torus| torus.volume()))
                .unwrap_or_else(|| [0, 1, 2].iter().map(|&k| high[k] - low[k]).product()),
        };
        drop(source);
        let reference = weighed.find_parameter()?;
        let shape = recipe.finish(weighed.clone())?.shape;
        let made = Made {
            settings,
            recipe,
            metadata,
            reference,
            all: None,
            domain,
            centre: [0, 1, 2].map(|k| f64::midpoint(low[k], high[k])),
            columns: columns.into(),
            elements,
            is_scan,
            what: What::Weighed(weighed),
        };
        Ok(self.keep_made(made, &shape))
    }

    /// Keeps points and describes them, with the shape to look at first.
    fn keep_made(&mut self, made: Made, shape: &AlphaShape) -> Answer {
        let answer = made.described(shape);
        self.made = Some(made);
        answer
    }

    /// The union of the balls of the input: what `walpha balls` says of the file.
    fn balls(&self, probe: f64) -> Result<Answer, Failure> {
        let Some(Opened::Points(Points { positions, weights: Some(weights), .. }, _)) =
            &self.opened
        else {
            return Err(Failure::new("the points have no radii"));
        };
        Stage::Measure.begin()?;
        let points = WeightedPoints::new(positions.clone(), weights.clone())
            .map_err(|error| Failure::new(error.to_string()))?;
        let (points, alpha) = with_probe(points, Alpha::ZERO, probe)?;
        let torus = self.made()?.what.origin().torus;
        let shape = alpha_shape(points, &ShapeOptions::new(alpha).periodic(torus))?;
        let union = BallUnion::new(&shape)?;
        let (volume, area) = (union.volume(), union.area());
        let head = json!({
            "volume": volume.value, "volumeBound": volume.bound,
            "area": area.value, "areaBound": area.bound,
        });
        Ok(Answer::of(head, Vec::new()))
    }
}

/// The settings of each preset, by their names.
fn presets() -> Answer {
    let settings = |name| json!(Settings::preset(name));
    let presets: Map<_, _> =
        PRESETS.iter().map(|(name, _)| ((*name).to_owned(), settings(name))).collect();
    Answer::of(json!({ "presets": presets }), Vec::new())
}

/// The answer for a volume with more samples than a page works on, if the request does not make it coarser: the number of samples
/// along each axis that should become one.
fn too_large(dims: Dims, options: &ReadOptions) -> Option<Answer> {
    let samples: f64 = dims.xyz().map(|n| n as f64).iter().product();
    let downsample = (samples / MOST_SAMPLES).cbrt().ceil();
    let head = json!({ "kind": "large", "dims": dims.xyz(), "downsample": downsample });
    (downsample > 1.0 && options.downsample.is_none()).then(|| Answer::of(head, Vec::new()))
}

fn describe_points(points: &Points, metadata: &ModelMetadata) -> Answer {
    let [low, high] = bounding_box(&points.positions);
    let head = json!({
        "kind": "points",
        "count": points.len(),
        "low": low,
        "high": high,
        "weights": points.weights.is_some(),
        "atoms": points.molecule.is_some(),
        "values": points.values.is_some(),
        "unit": metadata.coordinates.unit.symbol(),
        "cell": metadata.cell.filter(|cell| cell.repeats != [false; 3]).map(|cell| cell.to_string()),
    });
    Answer::of(head, Vec::new())
}

fn describe_volume(volume: &Volume) -> Answer {
    let SampleStats { missing, .. } = SampleStats::of_volume(volume);
    let (low, high) = volume.value_range();
    let hounsfield = Hounsfield::of_volume(volume);
    let labels = Labels::of_volume(volume);
    let frame = volume.frame();
    let mut bars = vec![0u32; BARS];
    let scale = BARS as f32 / (high - low).max(f32::MIN_POSITIVE);
    for value in volume.as_slice().iter().filter(|value| value.is_finite()) {
        bars[(((value - low) * scale) as usize).min(BARS - 1)] += 1;
    }
    let head = json!({
        "kind": "volume",
        "dims": volume.dims().xyz(),
        "samples": volume.dtype().name(),
        "spacing": frame.spacing,
        "origin": frame.origin,
        "direction": frame.direction,
        "coordinates": frame.coordinates,
        "unit": frame.coordinates.unit.symbol(),
        "low": low,
        "high": high,
        "missing": missing,
        "grayLevels": volume.has_gray_levels(),
        "labels": labels.map(|labels| labels.foreground().collect::<Vec<_>>()),
        "hounsfield": hounsfield.map(|found| json!({ "air": found.air, "softTissue": found.soft_tissue })),
    });
    Answer::of(head, vec![Array::U32("histogram", bars)])
}
