//! Reads `.wvm`.

use std::io::Read;

use walpha_base::advice::{Setting, advice};
use walpha_base::memory::try_with_capacity;

use super::coder::Decoder;
use super::column;
use super::header::{CHECKSUM, Header, Layer, Values, Weights, checksum_matches, damaged};
use super::write::{Coders, sort_key};
use crate::read::format;
use crate::{ModelMetadata, Points, PointsError, SampleGrid};
use walpha_volume::{OpenFile, Reason, io_error};

/// Reads points without the last `level` layers, and their metadata.
///
/// Memory is proportional to the size of the file, whatever its header claims: a byte contains at most 64 points.
pub(crate) fn read(file: &OpenFile, level: u32) -> Result<(Points, ModelMetadata), PointsError> {
    let (path, length) = (file.path(), file.length());
    let fail = |reason: Reason| format(path, reason);
    let room = usize::try_from(length).unwrap_or(usize::MAX);
    let mut bytes = try_with_capacity(room, || format!("{length} bytes of a file"))?;
    file.reader()?.read_to_end(&mut bytes).map_err(io_error(path))?;
    let (header, head) = Header::of_bytes(&bytes).map_err(fail)?;
    let layers = header.layers.len();
    let wanted = layers.saturating_sub(level as usize);
    if wanted == 0 && level > 0 {
        let what = format!("has {layers} levels");
        let most = layers.saturating_sub(1);
        let advice = advice!["give ", Setting::Level, format!(" from 0 to {most}")];
        return Err(fail(Reason::choice(Setting::Level, what, advice)));
    }
    let body = layers_of(&header, &bytes[head..], wanted).map_err(fail)?;
    let mut model = Model::new(&header);
    for (k, (layer, bytes)) in header.layers.iter().zip(body).enumerate() {
        let Some((bytes, checksum)) = bytes.split_last_chunk::<CHECKSUM>() else { continue };
        if !checksum_matches(bytes, u32::from_le_bytes(*checksum)) {
            return Err(fail(damaged(&format!("layer {k}"))));
        }
        model.reserve(layer.count as usize)?;
        if model.layer(layer, bytes).is_none() {
            let what = format!("is damaged: layer {k} does not hold what the header says");
            return Err(fail(Reason::damaged(what)));
        }
    }
    Ok((model.points(), header.metadata()))
}

/// The bytes of the first layers, each with its checksum.
fn layers_of<'a>(
    header: &Header,
    mut bytes: &'a [u8],
    wanted: usize,
) -> Result<Vec<&'a [u8]>, Reason> {
    let found = bytes.len() as u64;
    let lengths: Vec<u64> =
        header.layers.iter().map(|layer| layer.length().unwrap_or(u64::MAX)).collect();
    let needed = lengths
        .iter()
        .fold(0u64, |sum, &length| sum.saturating_add(length).saturating_add(CHECKSUM as u64));
    if found > needed {
        let claim = format!("{} layers", lengths.len());
        return Err(Reason::Length { claim, needed, found, bound: "" });
    }
    let mut layers = Vec::new();
    for (k, length) in lengths.iter().take(wanted).enumerate() {
        let length = usize::try_from(*length).ok().and_then(|length| length.checked_add(CHECKSUM));
        let Some((layer, rest)) = length.and_then(|length| bytes.split_at_checked(length)) else {
            let all = lengths.len();
            let what = format!("is truncated: {k} of its {all} layers are whole");
            if k == 0 {
                return Err(Reason::truncated(what));
            }
            let level = format!(" {} for the layers that are whole", all - k);
            let advice = advice!["copy it again, or give ", Setting::Level, level];
            return Err(Reason::choice(Setting::Level, what, advice));
        };
        layers.push(layer);
        bytes = rest;
    }
    Ok(layers)
}

/// The points read so far.
struct Model<'a> {
    header: &'a Header,
    coders: Option<(SampleGrid, Coders)>,
    /// The sample of each point, if there is a grid.
    cells: Vec<[u32; 3]>,
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    values: Option<Vec<f64>>,
}

impl<'a> Model<'a> {
    fn new(header: &'a Header) -> Self {
        Self {
            header,
            coders: header.grid.map(|grid| (grid, Coders::new(&grid))),
            cells: Vec::new(),
            positions: Vec::new(),
            weights: Vec::new(),
            values: (header.values != Values::None).then(Vec::new),
        }
    }

    /// Checks that there is memory for `count` more points.
    fn reserve(&self, count: usize) -> Result<(), PointsError> {
        /// The memory for a point in bytes, while it is read and sorted.
        const BYTES: usize = 128;
        let all = self.positions.len().saturating_add(count);
        Ok(try_with_capacity::<[u8; BYTES]>(all, || format!("a model of {all} points"))
            .map(drop)?)
    }

    /// Adds a layer; `None` if its bytes are inconsistent with it.
    fn layer(&mut self, layer: &Layer, bytes: &[u8]) -> Option<()> {
        let count = usize::try_from(layer.count).ok()?;
        let (places, rest) = bytes.split_at_checked(layer.bytes[0] as usize)?;
        let (values, weights) = rest.split_at_checked(layer.bytes[1] as usize)?;
        let mut multiples = Vec::new();
        match &mut self.coders {
            None => {
                let numbers = column::unpack(places, count.checked_mul(3)?)?;
                self.positions.extend(numbers.as_chunks().0);
            }
            Some((grid, coders)) => {
                let cells = coders.places.code(&mut Decoder::new(places), &[], count)?;
                if matches!(self.header.values, Values::Steps { .. }) {
                    let known = coders.places.known();
                    multiples =
                        coders.values.code(&mut Decoder::new(values), &cells, known, &[])?;
                }
                self.positions.extend(cells.iter().map(|&cell| grid.position(cell)));
                self.cells.extend(cells);
            }
        }
        if let Some(all) = &mut self.values {
            match self.header.values {
                Values::Steps { base, step } => {
                    all.extend(multiples.iter().map(|&k| base + f64::from(k) * step));
                }
                _ => all.extend(column::unpack(values, count)?),
            }
        }
        match self.header.weights {
            Weights::Common(weight) => {
                self.weights.resize(self.weights.len() + count, weight);
            }
            Weights::Exact => self.weights.extend(column::unpack(weights, count)?),
        }
        Some(())
    }

    /// The points; on a grid, in the order of its samples.
    fn points(self) -> Points {
        let Self { cells, mut positions, mut weights, mut values, .. } = self;
        if !cells.is_sorted_by_key(|&cell| sort_key(cell)) {
            let mut order: Vec<usize> = (0..cells.len()).collect();
            order.sort_unstable_by_key(|&point| sort_key(cells[point]));
            let sorted = |column: &[f64]| order.iter().map(|&point| column[point]).collect();
            positions = order.iter().map(|&point| positions[point]).collect();
            weights = sorted(&weights);
            values = values.as_deref().map(sorted);
        }
        Points { positions, weights: Some(weights), values, ..Points::default() }
    }
}
