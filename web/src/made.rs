//! Points, and their shapes.

use std::io;
use std::path::Path;
use std::sync::Arc;

use self_cell::self_cell;
use serde_json::{Map, Value, json};
use walpha_model::export::{EmptyShape, ExportOptions, Format};
use walpha_model::pipeline::{Model, Origin, Parameter, ParameterOrigin, Weighed};
use walpha_model::progress::Stage;
use walpha_model::{Recipe, Settings};
use walpha_points::colours::{has_classes, scan_classes, scan_colours};
use walpha_points::{
    Column, Element, ModelMetadata, Packing, PointWriter, SampleGrid, ScanSummary, bounding_box,
};
use walpha_shape::ladder::{Cycles, Drawn, Filtration, Interval, Ordered, frame_of};
use walpha_shape::{Alpha, AlphaShape, Betti, ByClass, Class, NO_COMPONENT, WeightedPoints};

use crate::answer::{Answer, Array};
use crate::failure::Failure;
use crate::shell::{argument, quoted};
use crate::shown::{Copies, HIDDEN, Lent, Shown, drawn, number};

/// Number of critical values of α among which the page moves without computing: more than its slider has pixels.
const STOPS: usize = 1024;

/// Points, and their shapes.
pub(crate) struct Made {
    pub settings: Settings,
    pub recipe: Recipe,
    pub what: What,
    pub metadata: ModelMetadata,
    /// The α that weights are computed for, or else the suggested one.
    pub reference: Parameter,
    /// All shapes, after they are requested.
    pub all: Option<All>,
    /// The volume that coverage is a share of.
    pub domain: f64,
    /// The offset that is subtracted from coordinates for the page: in single precision, the coordinates of a map would be metres
    /// apart.
    pub centre: [f64; 3],
    /// The further columns of the points, which some formats hold.
    pub columns: Arc<[Column]>,
    /// Of atoms, where they are known; empty if the points are not atoms.
    pub elements: Vec<Option<Element>>,
    /// Whether the columns are those of a laser scan.
    pub is_scan: bool,
}

/// The data of which shapes are made.
#[expect(clippy::large_enum_variant, reason = "there is one")]
pub(crate) enum What {
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

    pub(crate) fn origin(&self) -> &Origin {
        match self {
            Self::Weighed(weighed) => &weighed.origin,
            Self::Solid(model) => &model.origin,
        }
    }
}

/// The shapes at all α. A solid without α stands at α = 0 alone.
pub(crate) struct All {
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

impl Made {
    /// A solid that has no α.
    pub(crate) fn solid(settings: Settings, recipe: Recipe, model: Model) -> Self {
        let [low, high] = bounding_box(model.shape.points().positions());
        let mut reference = model.parameter;
        reference.alpha = Alpha::from_squared(0.0).unwrap_or(reference.alpha);
        Self {
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
        }
    }

    pub(crate) fn filtration(&mut self) -> Result<Answer, Failure> {
        Stage::Filtration.begin()?;
        let weighed = match &self.what {
            What::Weighed(weighed) => weighed,
            What::Solid(model) => {
                let stops = Shown::of(&model.shape)?;
                let all = All { filtration: None, stops, cycles: None };
                return Ok(self.all.insert(all).described());
            }
        };
        let filtration = Filtration::on(weighed.origin.torus, weighed.points.clone())?;
        Stage::Curve.begin()?;
        let mut alphas = filtration.coarse_alphas(STOPS);
        alphas.push(self.reference.alpha);
        let stops = Shown::at(&filtration, &alphas);
        let all = All { filtration: Some(Arc::new(filtration)), stops, cycles: None };
        Ok(self.all.insert(all).described())
    }

    fn all(&self) -> Result<&All, Failure> {
        self.all.as_ref().ok_or_else(|| Failure::new("the shapes at other α are not computed yet"))
    }

    /// The points, the shape to look at first, and what is known besides.
    pub(crate) fn described(&self, shape: &AlphaShape) -> Answer {
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

    pub(crate) fn at(&self, alpha: f64) -> Result<Answer, Failure> {
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

    pub(crate) fn measure(&self, alpha: f64) -> Result<Answer, Failure> {
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
    pub(crate) fn voids(&self, alpha: f64, most: usize) -> Result<Answer, Failure> {
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
    pub(crate) fn section(&self, alpha: f64, axis: usize, place: f64) -> Result<Answer, Failure> {
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
    pub(crate) fn suggest(&self) -> Result<Answer, Failure> {
        let filtration = self.all()?.filtration()?;
        let suggested = filtration.suggest(&filtration.coarse_curve(STOPS));
        let suggested = serde_json::to_value(suggested).map_err(io::Error::from)?;
        Ok(Answer::of(suggested, Vec::new()))
    }

    pub(crate) fn diagram(&mut self) -> Result<Answer, Failure> {
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
    pub(crate) fn cycle(&self, dimension: usize, simplex: u32) -> Result<Answer, Failure> {
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

    pub(crate) fn save(
        &self,
        input: &str,
        name: &Path,
        alpha: f64,
        solid: bool,
    ) -> Result<Answer, Failure> {
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

    pub(crate) fn command(
        &self,
        input: &str,
        name: &str,
        alpha: f64,
        solid: bool,
    ) -> Result<Answer, Failure> {
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

/// The writer of points for a file, if it is not one of shapes.
fn point_writer(name: &Path) -> Option<&'static PointWriter> {
    PointWriter::of(name).ok().filter(|writer| writer.packs || writer.extension == "csv")
}

/// The indices (x, y, z) of the samples that are points.
fn samples(grid: &SampleGrid, positions: &[[f64; 3]]) -> Vec<u32> {
    let sample = |position: &[f64; 3]| grid.sample_at(*position).unwrap_or([u32::MAX; 3]);
    positions.iter().flat_map(sample).collect()
}
