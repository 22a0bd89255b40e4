//! Writes `.wvm`.

use std::io::{self, Write};

use super::blocks::Cell;
use super::coder::Encoder;
use super::column;
use super::header::{Header, Layer, POINTS_PER_BYTE, Values, Weights};
use super::places::Places;
use super::values;
use crate::{ModelMetadata, Packing, SampleGrid, WeightedPoints};

/// Writes points and their metadata.
///
/// Positions are stored as voxels if each lies exactly on a sample of the grid, or of a grid of whole numbers, and no two on the
/// same sample; the points are then read in the order of the samples. Otherwise positions are stored as doubles, in their order
/// and in one layer.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn write(
    points: &WeightedPoints,
    metadata: &ModelMetadata,
    packing: &Packing,
    out: &mut dyn Write,
) -> io::Result<()> {
    let on_grid = on_grid(points, metadata);
    let layers = match &on_grid {
        Some((_, cells)) => in_layers(cells, metadata, packing),
        None => vec![(0..points.len()).collect()],
    };
    let values = points.values().filter(|_| on_grid.is_some());
    let steps = values.and_then(|values| Steps::of(values, packing.value_error));
    let file = Content { points, on_grid, steps };
    let parts = file.parts(&layers)?;
    let lengths = |(layer, parts): (&Vec<usize>, &[Vec<u8>; 3])| Layer {
        count: layer.len() as u64,
        bytes: parts.each_ref().map(|part| part.len() as u64),
    };
    let header = Header {
        grid: file.on_grid.as_ref().map(|(grid, _)| *grid),
        coordinates: metadata.coordinates,
        alpha: metadata.alpha,
        range: metadata.range,
        recipe: metadata.recipe.clone(),
        values: match (points.values(), &file.steps) {
            (None, _) => Values::None,
            (_, Some(Steps { base, step, .. })) => Values::Steps { base: *base, step: *step },
            _ => Values::Exact,
        },
        weights: file.common_weight().map_or(Weights::Exact, Weights::Common),
        layers: layers.iter().zip(&parts).map(lengths).collect(),
    };
    out.write_all(&header.to_bytes())?;
    for parts in &parts {
        let layer = parts.concat();
        out.write_all(&layer)?;
        out.write_all(&crc32fast::hash(&layer).to_le_bytes())?;
    }
    out.flush()
}

/// The grid and the sample of each point, if all points lie on distinct samples.
fn on_grid(points: &WeightedPoints, metadata: &ModelMetadata) -> Option<(SampleGrid, Vec<Cell>)> {
    let spanned = || SampleGrid::spanned(points.positions(), metadata.coordinates);
    let grid = metadata.grid.or_else(spanned)?;
    let cells = points.positions().iter().map(|&position| grid.sample_at(position));
    let cells = cells.collect::<Option<Vec<_>>>()?;
    let mut sorted = cells.clone();
    sorted.sort_unstable();
    let are_distinct = sorted.windows(2).all(|pair| pair[0] != pair[1]);
    are_distinct.then_some((grid, cells))
}

/// The points of each layer, in the order of their samples: a single layer if no order is known.
fn in_layers(cells: &[Cell], metadata: &ModelMetadata, packing: &Packing) -> Vec<Vec<usize>> {
    let all = cells.len();
    let order = metadata.order.as_ref().filter(|order| order.len() == all);
    let count = match order {
        Some(_) => usize::from(packing.layers.clamp(1, Packing::MOST_LAYERS)),
        None => 1,
    };
    let nth = |k: usize| order.map_or(k, |order| order[k] as usize);
    // The start of a layer, and the end of the one before it: each level has a quarter of the points of the next.
    let start = |layer: usize| if layer == 0 { 0 } else { all >> (2 * (count - layer)) };
    let mut layers = Vec::new();
    for layer in 0..count {
        let mut points: Vec<usize> = (start(layer)..start(layer + 1)).map(nth).collect();
        points.sort_unstable_by_key(|&point| sort_key(cells[point]));
        if !points.is_empty() {
            layers.push(points);
        }
    }
    layers
}

/// Sorts cells by z, then y, then x.
pub(super) fn sort_key([x, y, z]: Cell) -> Cell {
    [z, y, x]
}

/// Values as a base plus whole multiples of a step.
struct Steps {
    base: f64,
    step: f64,
    multiples: Vec<u32>,
}

impl Steps {
    /// The multiples that represent values within an error, or exactly if it is 0; `None` if a value cannot be represented.
    fn of(values: &[f64], error: f64) -> Option<Self> {
        let base = values.iter().copied().reduce(f64::min)?;
        let step = if error > 0.0 { 2.0 * error } else { common_step(values, base)? };
        if !step.is_finite() {
            return None;
        }
        let multiple = |&value: &f64| {
            let multiple = ((value - base) / step).round();
            let decoded = base + multiple * step;
            let is_valid = error > 0.0 || decoded.to_bits() == value.to_bits();
            (is_valid && multiple <= f64::from(u32::MAX)).then_some(multiple as u32)
        };
        let multiples = values.iter().map(multiple).collect::<Option<_>>()?;
        Some(Self { base, step, multiples })
    }
}

/// The largest step such that all values are whole multiples of it above the base; `None` unless values are
/// whole numbers.
fn common_step(values: &[f64], base: f64) -> Option<f64> {
    /// 2⁵³: doubles up to it represent all whole numbers.
    const MAX_WHOLE: f64 = 9_007_199_254_740_992.0;
    let mut common = 0u64;
    for value in values {
        let above = value - base;
        if value.fract() != 0.0 || value.abs() > MAX_WHOLE || above > MAX_WHOLE {
            return None;
        }
        let mut rest = above as u64;
        while rest != 0 {
            (common, rest) = (rest, common % rest);
        }
    }
    Some(common.max(1) as f64)
}

/// The content of a file, before it is coded.
struct Content<'a> {
    points: &'a WeightedPoints,
    on_grid: Option<(SampleGrid, Vec<Cell>)>,
    steps: Option<Steps>,
}

/// The coders of positions and values, which learn from layer to layer.
pub(super) struct Coders {
    pub places: Places,
    pub values: values::Values,
}

impl Coders {
    pub(super) fn new(grid: &SampleGrid) -> Self {
        // Each dimension is below 2³², as their product is.
        let voxels = grid.dims.xyz().map(|n| n as u32);
        Self { places: Places::new(voxels), values: values::Values::new(voxels) }
    }
}

impl Content<'_> {
    /// The weight of all points, if it is the same for all.
    fn common_weight(&self) -> Option<f64> {
        let weights = self.points.weights();
        let first = weights.first().copied().unwrap_or_default();
        weights.iter().all(|weight| weight.to_bits() == first.to_bits()).then_some(first)
    }

    /// The bytes of positions, values and weights of each layer.
    fn parts(&self, layers: &[Vec<usize>]) -> io::Result<Vec<[Vec<u8>; 3]>> {
        let mut coders = self.on_grid.as_ref().map(|(grid, _)| Coders::new(grid));
        let common = self.common_weight().is_some();
        let mut parts = Vec::new();
        for layer in layers {
            let exact = |column: &[f64]| column::pack(&pick(column, layer));
            let [mut places, mut values] = match &mut coders {
                Some(coders) => self.coded(coders, layer),
                None => [column::pack(self.points.positions().as_flattened())?, Vec::new()],
            };
            if let (None, Some(column)) = (&self.steps, self.points.values()) {
                values = exact(column)?;
            }
            let weights = if common { Vec::new() } else { exact(self.points.weights())? };
            let least = layer.len().div_ceil(POINTS_PER_BYTE as usize);
            let rest = values.len() + weights.len();
            places.resize(places.len().max(least.saturating_sub(rest)), 0);
            parts.push([places, values, weights]);
        }
        Ok(parts)
    }

    /// The bytes of the voxels of a layer, and of its values if they are multiples of a step.
    fn coded(&self, coders: &mut Coders, layer: &[usize]) -> [Vec<u8>; 2] {
        let (_, cells) = self.on_grid.as_ref().expect("coders are for grids");
        let cells = pick(cells, layer);
        let mut places = Encoder::default();
        coders.places.code(&mut places, &cells, cells.len()).expect("an encoder takes all");
        let mut values = Encoder::default();
        if let Some(steps) = &self.steps {
            let (known, multiples) = (coders.places.known(), pick(&steps.multiples, layer));
            let coded = coders.values.code(&mut values, &cells, known, &multiples);
            coded.expect("an encoder takes all");
        }
        [places.finish(), values.finish()]
    }
}

fn pick<T: Copy>(all: &[T], points: &[usize]) -> Vec<T> {
    points.iter().map(|&point| all[point]).collect()
}
