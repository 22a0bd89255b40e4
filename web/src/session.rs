//! The opened and computed data, and the answers to requests.

use std::io;
use std::path::Path;
use std::sync::Arc;

use self_cell::self_cell;
use serde_json::{Map, Value, json};
use walpha_balls::{BallUnion, with_probe};
use walpha_base::advice::{Advise, told};
use walpha_model::export::{EmptyShape, ExportOptions, Format};
use walpha_model::pipeline::{
    AlphaRule, Input, Model, Opened as OpenInput, Origin, Parameter, ParameterOrigin, Values,
    Weighed,
};
use walpha_model::progress::{Listener, Monitor, Stage};
use walpha_model::settings::PRESETS;
use walpha_model::{Recipe, Settings};
use walpha_points::colours::{has_classes, scan_classes, scan_colours};
use walpha_points::{
    Attributes, Column, Element, ModelMetadata, Packing, PointOptions, PointWriter, Points,
    SampleGrid, ScanSummary, bounding_box, read_model_file,
};
use walpha_shape::ladder::{Cycles, Drawn, Filtration, Interval, Ordered, Span, frame_of};
use walpha_shape::{
    Alpha, AlphaShape, Betti, ByClass, Class, NO_COMPONENT, ShapeOptions, WeightedPoints,
    alpha_shape,
};
use walpha_volume::{
    self as volume, Dims, Hounsfield, Labels, ReadOptions, SampleStats, Series, Volume,
};

use crate::answer::{Answer, Array};
use crate::request::Request;
use crate::shell::{argument, quoted};

/// Bars of the histogram.
const BARS: usize = 256;
/// Number of critical values of α among which the page moves without computing: more than its slider has pixels.
const STOPS: usize = 1024;

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

/// Points, and their shapes.
struct Made {
    settings: Settings,
    recipe: Recipe,
    what: What,
    metadata: ModelMetadata,
    /// The α that weights are computed for, or else the suggested one.
    reference: Parameter,
    /// All shapes, after they are requested.
    all: Option<All>,
    /// The volume that coverage is a share of.
    domain: f64,
    /// The offset that is subtracted from coordinates for the page: in single precision, the coordinates of a map would be metres
    /// apart.
    centre: [f64; 3],
    /// The further columns of the points, which some formats hold.
    columns: Arc<[Column]>,
    /// Of atoms, where they are known; empty if the points are not atoms.
    elements: Vec<Option<Element>>,
    /// Whether the columns are those of a laser scan.
    is_scan: bool,
}

/// The data of which shapes are made.
#[expect(clippy::large_enum_variant, reason = "there is one")]
enum What {
    /// Points, which have a shape at each α.
    Weighed(Weighed),
    /// A solid of labels or inside an isosurface, which no α changes.
    Solid(Model),
}

impl What {
    fn points(&self) -> &WeightedPoints {
        match self {
            Self::Weighed(weighed) => &weighed.points,
            Self::Solid(model) => model.shape.points(),
        }
    }

    fn origin(&self) -> &Origin {
        match self {
            Self::Weighed(weighed) => &weighed.origin,
            Self::Solid(model) => &model.origin,
        }
    }
}

/// The shapes at all α. A solid without α stands at α = 0 alone.
struct All {
    /// `None` of a solid.
    filtration: Option<Arc<Filtration>>,
    stops: Shown,
    /// Cycles of the persistence pairs, after the diagram is requested.
    cycles: Option<CyclesInOrder>,
}

self_cell! {
    /// A filtration with its simplices in order.
    struct InOrder {
        owner: Arc<Filtration>,
        #[covariant]
        dependent: Ordered,
    }
}

self_cell! {
    /// What finds cycles of persistence pairs, with what it is made of.
    struct CyclesInOrder {
        owner: InOrder,
        #[covariant]
        dependent: Cycles,
    }
}

impl All {
    fn filtration(&self) -> Result<&Arc<Filtration>, Failure> {
        let none = || Failure::new("a solid without α is the same at all α");
        self.filtration.as_ref().ok_or_else(none)
    }
}

/// The simplices that are drawn at some of these α, and all cells, with the levels at which they change.
struct Shown {
    alphas: Vec<Alpha>,
    facets: Vec<([u32; 3], Span)>,
    edges: Vec<([u32; 2], Span)>,
    vertices: Vec<(u32, Span)>,
    cells: Vec<([u32; 4], u32)>,
    betti: Vec<Betti>,
    /// In a periodic box, what is laid out in space.
    copies: Option<Copies>,
}

/// The points of a periodic box followed by copies of them, which the page draws beyond the box.
struct Copies {
    positions: Vec<[f64; 3]>,
    /// The point that each copy is of.
    of: Vec<u32>,
}

impl Shown {
    /// Decided exactly at each α.
    fn at(filtration: &Filtration, alphas: &[Alpha]) -> Self {
        let levels = filtration.levels(alphas);
        let Drawn { points, copies, facets, edges, vertices, .. } = levels.drawn(0);
        let copies = filtration.torus().map(|_| Copies::new(&points, copies));
        let (cells, betti) = (levels.cells(), levels.betti());
        Self { facets, edges, vertices, copies, cells, betti, alphas: levels.alphas().to_vec() }
    }
}

impl Copies {
    fn new(points: &WeightedPoints, of: Vec<u32>) -> Self {
        Self { positions: points.positions().to_vec(), of }
    }
}

impl Shown {
    /// All simplices of a shape, at α = 0.
    fn of(shape: &AlphaShape) -> Result<Self, Failure> {
        let complex = shape.complex();
        let span = |class: Class| {
            let from = |least: Class| u32::from(number(class) < number(least));
            Span {
                first: from(Class::Singular),
                regular: from(Class::Regular),
                interior: from(Class::Interior),
            }
        };
        Ok(Self {
            alphas: vec![Alpha::from_squared(0.0)?],
            facets: complex.facets.iter().map(|(&row, class)| (row, span(class))).collect(),
            edges: complex.edges.iter().map(|(&row, class)| (row, span(class))).collect(),
            vertices: complex.vertices.iter().map(|(row, class)| (row[0], span(class))).collect(),
            cells: complex.cells.rows().iter().map(|&row| (row, 0)).collect(),
            betti: vec![
                shape.betti().ok_or_else(|| Failure::new("its Betti numbers are not known"))?,
            ],
            copies: None,
        })
    }
}

/// The simplices of a stop, or of another α.
enum Lent<'a> {
    Stop(&'a Shown),
    Made(Shown),
}

impl std::ops::Deref for Lent<'_> {
    type Target = Shown;

    fn deref(&self) -> &Shown {
        match self {
            Self::Stop(shown) => shown,
            Self::Made(shown) => shown,
        }
    }
}

/// A failure: its reason, and what to do next.
struct Failure {
    why: String,
    next: Option<String>,
}

impl Failure {
    fn new(why: impl Into<String>) -> Self {
        Self { why: why.into(), next: None }
    }

    fn of_no_shape() -> Self {
        Self::new("there is no shape yet")
    }

    /// The page moves α by its slider.
    fn of_empty(error: EmptyShape) -> Self {
        match error.suggested {
            Some(radius) => {
                let next = Some(format!("move α up, to √α = {radius} say"));
                Self { why: error.to_string(), next }
            }
            None => error.into(),
        }
    }
}

/// An error of the library, with its causes and its advice. The page's fields have the names of settings.
impl<E: Advise> From<E> for Failure {
    fn from(error: E) -> Self {
        let (why, next) = told(&error, |setting| format!("“{}”", setting.name()));
        Self { why, next }
    }
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
            Request::Filtration => self.filtration(),
            Request::At { alpha } => self.made()?.at(alpha),
            Request::Measure { alpha } => self.made()?.measure(alpha),
            Request::Voids { alpha, most } => self.made()?.voids(alpha, most),
            Request::Balls { probe } => self.balls(probe),
            Request::Section { alpha, axis, place } => self.made()?.section(alpha, axis, place),
            Request::Suggest => self.made()?.suggest(),
            Request::Diagram => self.made.as_mut().ok_or_else(Failure::of_no_shape)?.diagram(),
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
                    return Ok(self.made_without_alpha(settings, recipe, model));
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
        let answer = made.described(&shape);
        self.made = Some(made);
        Ok(answer)
    }

    /// Keeps a solid that has no α, and describes it.
    fn made_without_alpha(&mut self, settings: Settings, recipe: Recipe, model: Model) -> Answer {
        let [low, high] = bounding_box(model.shape.points().positions());
        let shape = model.shape.clone();
        let mut reference = model.parameter;
        reference.alpha = Alpha::from_squared(0.0).unwrap_or(reference.alpha);
        let made = Made {
            settings,
            recipe,
            metadata: ModelMetadata::default(),
            reference,
            all: None,
            domain: [0, 1, 2].iter().map(|&k| high[k] - low[k]).product(),
            centre: [0, 1, 2].map(|k| f64::midpoint(low[k], high[k])),
            columns: Arc::default(),
            elements: Vec::new(),
            is_scan: false,
            what: What::Solid(model),
        };
        let answer = made.described(&shape);
        self.made = Some(made);
        answer
    }

    fn filtration(&mut self) -> Result<Answer, Failure> {
        let made = self.made.as_mut().ok_or_else(Failure::of_no_shape)?;
        Stage::Filtration.begin()?;
        let weighed = match &made.what {
            What::Weighed(weighed) => weighed,
            What::Solid(model) => {
                let stops = Shown::of(&model.shape)?;
                let all = All { filtration: None, stops, cycles: None };
                return Ok(made.all.insert(all).described());
            }
        };
        let filtration = Filtration::on(weighed.origin.torus, weighed.points.clone())?;
        Stage::Curve.begin()?;
        let mut alphas = filtration.coarse_alphas(STOPS);
        alphas.push(made.reference.alpha);
        let stops = Shown::at(&filtration, &alphas);
        let all = All { filtration: Some(Arc::new(filtration)), stops, cycles: None };
        Ok(made.all.insert(all).described())
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

/// The writer of points for a file, if it is not one of shapes.
fn point_writer(name: &Path) -> Option<&'static PointWriter> {
    PointWriter::of(name).ok().filter(|writer| writer.packs || writer.extension == "csv")
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

impl Made {
    fn all(&self) -> Result<&All, Failure> {
        self.all.as_ref().ok_or_else(|| Failure::new("the shapes at other α are not computed yet"))
    }

    /// The points, the shape to look at first, and what is known besides.
    fn described(&self, shape: &AlphaShape) -> Answer {
        let (points, origin) = (self.what.points(), self.what.origin());
        let weights = points.weights().iter().map(|&w| w as f32).collect();
        let mut arrays = vec![Array::F32("weights", weights)];
        let mut cell = None;
        if let Some(torus) = origin.torus {
            let laid_out = shape.unwrapped();
            let copies = Copies::new(laid_out.points(), laid_out.copies().to_vec());
            let [start, vectors @ ..] = frame_of(torus, copies.positions.iter());
            cell = Some((self.seen(start), vectors));
            arrays.extend(drawn(&laid_out));
            arrays.extend(self.laid_out(&copies));
        } else {
            arrays.push(Array::F32("positions", self.places(points.positions())));
            arrays.extend(drawn(shape));
        }
        if let Some(values) = points.values() {
            arrays.push(Array::F32("values", values.iter().map(|&value| value as f32).collect()));
        }
        let samples = origin.grid.map(|grid| samples(&grid, points.positions()));
        if let Some(samples) = samples {
            arrays.push(Array::U32("samples", samples));
        }
        // By atomic number, and 0 where it is not known.
        let mut elements: Map<String, Value> = Map::new();
        if self.elements.len() == points.len() && !self.elements.is_empty() {
            for element in self.elements.iter().flatten() {
                let known = json!({ "name": element.symbol(), "colour": element.colour() });
                elements.insert(element.number().to_string(), known);
            }
            let number = |element: &Option<Element>| element.map_or(0, Element::number);
            arrays.push(Array::U8("atoms", self.elements.iter().map(number).collect()));
        }
        let mut class_names: Map<String, Value> = Map::new();
        let is_all = |count: usize| self.is_scan && count == points.len();
        let classes =
            scan_classes(&self.columns).filter(|all| is_all(all.len()) && has_classes(all));
        if let Some(classes) = classes {
            for &class in &classes {
                let known = || json!({ "name": ScanSummary::class_name(class), "colour": ScanSummary::class_colour(class) });
                class_names.entry(class.to_string()).or_insert_with(known);
            }
            arrays.push(Array::U8("codes", classes));
        }
        if let Some(colours) = scan_colours(&self.columns).filter(|all| is_all(all.len())) {
            arrays.push(Array::U8("tints", colours.into_flattened()));
        }
        let truncation = origin.truncation.map(|t| json!({ "kept": t.kept, "total": t.total }));
        let labels = match &self.what {
            What::Solid(model) => {
                let of_labels = model.labels.as_ref().map(ToString::to_string);
                of_labels.or_else(|| {
                    Some(format!("the solid inside the isosurface at {}", model.isovalue?))
                })
            }
            What::Weighed(_) => None,
        };
        let head = json!({
            "points": points.len(),
            "reference": self.reference.alpha.squared(),
            "origin": self.reference,
            "unit": origin.coordinates.unit.symbol(),
            "space": origin.coordinates.space,
            "elements": elements,
            "classNames": class_names,
            "cell": cell.map(|(start, [a, b, c])| json!([start, a, b, c])),
            "centre": self.centre,
            "largestWeight": points.weights().iter().copied().fold(f64::NEG_INFINITY, f64::max),
            "truncation": truncation,
            "labels": labels,
            "kept": shape.kept().map(|kept| format!("{kept} kept")),
        });
        Answer::of(head, arrays)
    }

    /// A position as the page sees it.
    fn seen(&self, position: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|k| (position[k] - self.centre[k]) as f32)
    }

    fn places(&self, positions: &[[f64; 3]]) -> Vec<f32> {
        positions.iter().flat_map(|&place| self.seen(place)).collect()
    }

    /// The places of points and copies, and the point that each copy is of.
    fn laid_out(&self, copies: &Copies) -> [Array; 2] {
        let positions = Array::F32("positions", self.places(&copies.positions));
        [positions, Array::U32("copies", copies.of.clone())]
    }

    /// The simplices to draw at an α, and their level: of the stops, or else computed now.
    fn shown(&self, alpha: f64) -> Result<(Lent<'_>, u32), Failure> {
        let alpha = Alpha::from_squared(alpha)?;
        let all = self.all()?;
        let stops = &all.stops;
        Ok(match stops.alphas.binary_search(&alpha) {
            Ok(level) => (Lent::Stop(stops), level as u32),
            Err(_) => (Lent::Made(Shown::at(all.filtration()?, &[alpha])), 0),
        })
    }

    /// The components that are to be kept of the shape at an α, if not all are.
    fn kept(&self, alpha: f64) -> Result<Option<AlphaShape>, Failure> {
        if self.recipe.keep.is_all() || matches!(self.what, What::Solid(_)) {
            return Ok(None);
        }
        let levels = self.all()?.filtration()?.levels(&[Alpha::from_squared(alpha)?]);
        let [betti] = levels.betti()[..] else { unreachable!("one level") };
        Ok(Some(levels.shape(0, true, betti).keep(&self.recipe.keep)))
    }

    fn at(&self, alpha: f64) -> Result<Answer, Failure> {
        if let Some(shape) = self.kept(alpha)? {
            return Ok(Answer::of(json!({ "betti": shape.betti() }), drawn(&shape)));
        }
        let (shown, level) = self.shown(alpha)?;
        let of = |wanted: Class| -> Vec<u32> {
            let rows = shown.facets.iter().filter(|(_, span)| span.class(level) == wanted);
            rows.flat_map(|(row, _)| *row).collect()
        };
        let (regular, singular) = (of(Class::Regular), of(Class::Singular));
        let edges = shown.edges.iter().filter(|(_, span)| span.class(level) == Class::Singular);
        let edges: Vec<u32> = edges.flat_map(|(row, _)| *row).collect();
        // Points that are not vertices are hidden.
        let copied = shown.copies.as_ref().map_or(0, |copies| copies.of.len());
        let mut classes = vec![HIDDEN; self.what.points().len() + copied];
        for (v, span) in &shown.vertices {
            classes[*v as usize] = number(span.class(level));
        }
        let head = json!({ "betti": shown.betti[level as usize] });
        let mut arrays = vec![
            Array::U32("regular", regular),
            Array::U32("singular", singular),
            Array::U32("edges", edges),
            Array::U8("classes", classes),
        ];
        arrays.extend(shown.copies.iter().flat_map(|copies| self.laid_out(copies)));
        Ok(Answer::of(head, arrays))
    }

    fn measure(&self, alpha: f64) -> Result<Answer, Failure> {
        if let What::Solid(model) = &self.what {
            return Ok(Answer::of(self.measured(&model.shape), Vec::new()));
        }
        if let Some(shape) = self.kept(alpha)? {
            return Ok(Answer::of(self.measured(&shape), Vec::new()));
        }
        let alpha = Alpha::from_squared(alpha)?;
        let ladder = self.all()?.filtration()?.ladder(&[alpha], self.domain);
        let level = serde_json::to_value(&ladder.levels[0]).map_err(io::Error::from)?;
        Ok(Answer::of(level, Vec::new()))
    }

    /// The corners of the facets around each of the first voids, and where those of the next begin.
    fn voids(&self, alpha: f64, most: usize) -> Result<Answer, Failure> {
        let levels = self.all()?.filtration()?.levels(&[Alpha::from_squared(alpha)?]);
        let Drawn { points, copies, mut voids, .. } = levels.drawn(most);
        let voids = voids.remove(0);
        let starts = voids.iter().scan(0, |so_far, facets| {
            *so_far += 3 * facets.len() as u32;
            Some(*so_far)
        });
        let mut arrays = vec![
            Array::U32("starts", std::iter::once(0).chain(starts).collect()),
            Array::U32("facets", voids.into_iter().flatten().flatten().collect()),
        ];
        // Copies have numbers of their own.
        if !copies.is_empty() {
            arrays.push(Array::F32("positions", self.places(points.positions())));
        }
        Ok(Answer::of(json!({}), arrays))
    }

    /// The numbers of a solid, as those of a level.
    fn measured(&self, shape: &AlphaShape) -> Value {
        let complex = shape.complex();
        let counts = |counts: ByClass<usize>| {
            json!({
                "interior": counts[Class::Interior],
                "regular": counts[Class::Regular],
                "singular": counts[Class::Singular],
            })
        };
        let measures = shape.measures();
        json!({
            "cells": complex.cells.len(),
            "facets": counts(complex.facets.counts()),
            "edges": counts(complex.edges.counts()),
            "vertices": counts(complex.vertices.counts()),
            "betti": shape.betti(),
            "volume": measures.volume,
            "area": measures.area,
            "coverage": if self.domain > 0.0 { measures.volume / self.domain } else { 0.0 },
        })
    }

    /// The section of the cells with a plane across an axis: triangles, and the value at each corner.
    fn section(&self, alpha: f64, axis: usize, place: f64) -> Result<Answer, Failure> {
        let (shown, level) = self.shown(alpha)?;
        let points = self.what.points();
        let (positions, values) = (points.positions(), points.values());
        // In a periodic box, cells are laid out as their facets are.
        let on_torus = self.all()?.filtration.as_ref().filter(|all| all.torus().is_some());
        let (mut corners, mut shades) = (Vec::new(), Vec::new());
        let kept = self.kept(alpha)?.map(|shape| shape.component_numbers());
        let is_kept =
            |v: u32| kept.as_ref().is_none_or(|numbers| numbers[v as usize] != NO_COMPONENT);
        for (cell, first) in &shown.cells {
            if *first > level || !is_kept(cell[0]) {
                continue;
            }
            let places = on_torus
                .map_or_else(|| cell.map(|v| positions[v as usize]), |all| all.places(*cell));
            let side = places.map(|at| at[axis] - place);
            // A cell that only touches the plane is not cut.
            let [below, above] = [false, true]
                .map(|up| (0..4).filter(|&k| (side[k] > 0.0) == up).collect::<Vec<usize>>());
            if below.is_empty() || above.is_empty() {
                continue;
            }
            let cut = |&(a, b): &(usize, usize)| {
                let t = side[a] / (side[a] - side[b]);
                let [p, q] = [places[a], places[b]];
                let at = self.seen([0, 1, 2].map(|k| p[k] + t * (q[k] - p[k])));
                let value = values.map_or(0.0, |values| {
                    let [f, g] = [cell[a], cell[b]].map(|v| values[v as usize]);
                    (f + t * (g - f)) as f32
                });
                (at, value)
            };
            let ring: Vec<(usize, usize)> = match (&below[..], &above[..]) {
                (&[a], &[b, c, d]) | (&[b, c, d], &[a]) => vec![(a, b), (a, c), (a, d)],
                (&[a, b], &[c, d]) => vec![(a, c), (a, d), (b, d), (b, c)],
                _ => unreachable!("four corners on two sides"),
            };
            let ring: Vec<([f32; 3], f32)> = ring.iter().map(cut).collect();
            for k in 1..ring.len() - 1 {
                for corner in [ring[0], ring[k], ring[k + 1]] {
                    corners.extend(corner.0);
                    shades.push(corner.1);
                }
            }
        }
        let arrays = vec![Array::F32("corners", corners), Array::F32("shades", shades)];
        Ok(Answer::of(json!({}), arrays))
    }

    /// Values of α at which something happens, of the stops.
    fn suggest(&self) -> Result<Answer, Failure> {
        let filtration = self.all()?.filtration()?;
        let suggested = filtration.suggest(&filtration.coarse_curve(STOPS));
        let suggested = serde_json::to_value(suggested).map_err(io::Error::from)?;
        Ok(Answer::of(suggested, Vec::new()))
    }

    fn diagram(&mut self) -> Result<Answer, Failure> {
        let none = || Failure::new("the shapes at other α are not computed yet");
        let all = self.all.as_mut().ok_or_else(none)?;
        Stage::Order.begin()?;
        let owner = Arc::clone(all.filtration()?);
        let simplices = InOrder::try_new(owner, |filtration| filtration.simplices())?;
        Stage::Pairs.begin()?;
        simplices.borrow_dependent().loops()?;
        let mut arrays = Vec::new();
        let names = [("pairs0", "simplices0"), ("pairs1", "simplices1"), ("pairs2", "simplices2")];
        for (dimension, (name, simplex)) in names.into_iter().enumerate() {
            let pairs = simplices.borrow_dependent().persistence(dimension)?;
            let flat = pairs.iter().flat_map(|pair| [pair.birth, pair.death]).collect();
            arrays.push(Array::F64(name, flat));
            // A loop is found by what begins it, and a void by what ends it.
            let named = |pair: &Interval| {
                if dimension < 2 { pair.begins } else { pair.ends.unwrap_or(u32::MAX) }
            };
            arrays.push(Array::U32(simplex, pairs.iter().map(named).collect()));
        }
        all.cycles =
            Some(CyclesInOrder::new(simplices, |simplices| simplices.borrow_dependent().cycles()));
        Ok(Answer::of(json!({}), arrays))
    }

    /// The cycle of a pair at its birth: the places along a closed walk, or the corners of the triangles around a void. Without places if the pair has none.
    fn cycle(&self, dimension: usize, simplex: u32) -> Result<Answer, Failure> {
        let none = || Failure::new("the persistence diagram is not computed yet");
        let cycles = self.all()?.cycles.as_ref().ok_or_else(none)?.borrow_dependent();
        let places = match dimension {
            1 => cycles.path_of_loop(simplex).unwrap_or_default(),
            2 => {
                cycles.of_void(simplex).map_or_else(Vec::new, |void| void.corners.into_flattened())
            }
            _ => Vec::new(),
        };
        let places = places.into_iter().flat_map(|place| self.seen(place)).collect();
        Ok(Answer::of(json!({}), vec![Array::F32("places", places)]))
    }

    /// Whether the command `shape` makes this shape: weights that are proportional to α are frozen otherwise.
    fn is_shape(&self, alpha: f64) -> bool {
        let proportional = self.what.origin().weighting.needs_differences();
        !proportional || alpha == self.reference.alpha.squared()
    }

    fn save(&self, input: &str, name: &Path, alpha: f64, solid: bool) -> Result<Answer, Failure> {
        let is_shape = self.is_shape(alpha);
        let alpha = Alpha::from_squared(alpha)?;
        let (mut bytes, mut remarks) = (Vec::new(), Vec::new());
        if let Some(writer) = point_writer(name) {
            // Weights that are frozen belong to their own α.
            let alpha = if is_shape { alpha } else { self.reference.alpha };
            let mut metadata = self.metadata.clone().alpha(Some(alpha));
            // The command's recipe has this α; that of a file stays as it is.
            if metadata.recipe == Some(self.recipe.to_json()) {
                metadata.recipe = Some(self.recipe.clone().alpha(alpha).to_json());
            }
            let What::Weighed(weighed) = &self.what else {
                return Err(Failure::new("the corners of voxels are not points to select"));
            };
            let columns = &self.columns;
            let packing = Packing::default();
            writer.write_model(&weighed.points, columns, &metadata, &packing, &mut bytes)?;
        } else {
            let format = Format::of(name)?;
            if format.whole && !self.recipe.keep.is_all() {
                let why = format!(
                    "{} states the whole shape, and a part of it is to be kept",
                    format.name
                );
                return Err(Failure::new(why));
            }
            let exporter = format.exporter(
                &ExportOptions::default()
                    .solid(solid && is_shape)
                    .input(Some(input.to_owned()))
                    .columns(Arc::clone(&self.columns)),
            );
            let shape = match &self.what {
                What::Solid(model) => model.shape.clone(),
                What::Weighed(weighed) => {
                    let mut weighed = weighed.clone();
                    let mut parameter = self.reference;
                    (parameter.alpha, parameter.origin) = (alpha, ParameterOrigin::Given);
                    weighed.parameter = Some(parameter);
                    self.recipe.finish(weighed)?.shape
                }
            };
            EmptyShape::check(&shape, exporter.needs()).map_err(Failure::of_empty)?;
            if let Some(remark) =
                exporter.single_precision(&shape).and_then(|single| single.remark())
            {
                remarks.push(format!("{}: {remark}", name.display()));
            }
            exporter.write(&shape, &mut bytes)?;
        }
        Ok(Answer::of(json!({ "remarks": remarks }), vec![Array::U8("bytes", bytes)]))
    }

    fn command(&self, input: &str, name: &str, alpha: f64, solid: bool) -> Result<Answer, Failure> {
        let mut settings = self.settings.clone();
        settings.unset("alpha");
        let mut set = |name, alpha: f64| settings.set(name, &alpha.to_string());
        let mut stops = None;
        let input = quoted(input);
        let points = point_writer(Path::new(name));
        let is_shape = self.is_shape(alpha);
        let (program, output) = if matches!(self.what, What::Solid(_)) {
            let solid = if solid { " --solid" } else { "" };
            ("shape", format!("{solid} -o {}", quoted(name)))
        } else if is_shape || points.is_some() {
            let alpha = if is_shape { alpha } else { self.reference.alpha.squared() };
            set("alpha", alpha)?;
            let solid = if solid { " --solid" } else { "" };
            // A format that does not store how the points were made is that of `walpha points`.
            let is_table = points.is_some_and(|writer| !writer.packs);
            let program = if is_table { "points" } else { "shape" };
            (program, format!("{solid} -o {}", quoted(name)))
        } else {
            set("alpha_ref", self.reference.alpha.squared())?;
            stops = Some(alpha);
            let extension = Path::new(name).extension().unwrap_or_default().display().to_string();
            ("ladder", format!(" --mesh={} -o ladder", quoted(&extension)))
        };
        let mut arguments: String =
            settings.arguments().iter().map(|given| format!(" {}", argument(given))).collect();
        let mut lines = settings.to_toml();
        if let Some(alpha) = stops {
            arguments += &format!(" --alphas={alpha}");
            lines += &format!("alphas = \"{alpha}\"\n");
        }
        let toml = format!(
            "# walpha {program} {input} --config=recipe.toml{output}\n[{program}]\n{lines}"
        );
        let head = json!({
            "command": format!("walpha {program} {input}{arguments}{output}"),
            "toml": toml,
        });
        Ok(Answer::of(head, Vec::new()))
    }
}

impl All {
    /// The curve, and what is known besides.
    fn described(&self) -> Answer {
        let Shown { alphas, betti, cells, .. } = &self.stops;
        let of = |pick: fn(&Betti) -> u64| betti.iter().map(|b| pick(b) as u32).collect();
        let arrays = vec![
            Array::F64("alphas", alphas.iter().map(|alpha| alpha.squared()).collect()),
            Array::U32("b0", of(|betti| betti.b0)),
            Array::U32("b1", of(|betti| betti.b1)),
            Array::U32("b2", of(|betti| betti.b2)),
        ];
        Answer::of(json!({ "cells": cells.len() }), arrays)
    }
}

/// The simplices of a shape that are drawn.
fn drawn(shape: &AlphaShape) -> Vec<Array> {
    let complex = shape.complex();
    let of = |class| complex.facets.of(class).flatten().copied().collect();
    let edges = complex.edges.of(Class::Singular).flatten().copied().collect();
    // Which of the others are hidden is not known.
    let mut classes = vec![number(Class::Exterior); shape.points().len()];
    complex.vertices.iter().for_each(|(row, class)| classes[row[0] as usize] = number(class));
    vec![
        Array::U32("regular", of(Class::Regular)),
        Array::U32("singular", of(Class::Singular)),
        Array::U32("edges", edges),
        Array::U8("classes", classes),
    ]
}

/// The class of hidden points, after those of vertices.
const HIDDEN: u8 = 4;

/// The class of a vertex, in the encoding of the page.
fn number(class: Class) -> u8 {
    match class {
        Class::Exterior => 0,
        Class::Singular => 1,
        Class::Regular => 2,
        Class::Interior => 3,
    }
}

/// The indices (x, y, z) of the samples that are points.
fn samples(grid: &SampleGrid, positions: &[[f64; 3]]) -> Vec<u32> {
    let sample = |position: &[f64; 3]| grid.sample_at(*position).unwrap_or([u32::MAX; 3]);
    positions.iter().flat_map(sample).collect()
}
