//! The header of a file: its metadata, and the lengths of its layers.

use walpha_complex::Alpha;

use super::fields::{FieldReader, FieldWriter};
use crate::model::MODEL;
use crate::{ModelMetadata, SampleGrid, Units};
use walpha_volume::{Coordinates, Dims, Frame, GrayRange, Reason};

/// The version of the format.
const VERSION: u8 = 1;

/// The maximum number of points per byte of a layer, so that a reader's memory is proportional to the file.
pub(super) const POINTS_PER_BYTE: u64 = 64;

/// The size of a checksum in bytes.
pub(super) const CHECKSUM: usize = 4;

/// The header of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub grid: Option<SampleGrid>,
    pub coordinates: Coordinates,
    pub alpha: Option<Alpha>,
    pub range: Option<GrayRange>,
    pub recipe: Option<String>,
    pub values: Values,
    pub weights: Weights,
    pub layers: Vec<Layer>,
}

/// The encoding of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Values {
    None,
    /// The values are `base` plus whole multiples of `step`.
    Steps {
        base: f64,
        step: f64,
    },
    /// Bit for bit.
    Exact,
}

/// The encoding of weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Weights {
    /// One weight for all points.
    Common(f64),
    /// Bit for bit.
    Exact,
}

/// The number of points of a layer, and the bytes of its positions, values and weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Layer {
    pub count: u64,
    pub bytes: [u64; 3],
}

impl Layer {
    fn of_fields(fields: &mut FieldReader<'_>) -> Result<Self, Reason> {
        let count = fields.whole()?;
        Ok(Self { count, bytes: [fields.whole()?, fields.whole()?, fields.whole()?] })
    }

    /// The size in bytes of all parts of the layer; `None` on overflow.
    pub(super) fn length(&self) -> Option<u64> {
        self.bytes.iter().try_fold(0u64, |sum, &part| sum.checked_add(part))
    }
}

// These are the bits of the flags.
const GRID: u8 = 1;
const FRAME: u8 = 2;
const WORLD: u8 = 4;
const STEPS: u8 = 8;
const EXACT_VALUES: u8 = 16;
const EXACT_WEIGHTS: u8 = 32;
const ALPHA: u8 = 64;
const RANGE: u8 = 128;

impl Header {
    /// The metadata of the points.
    pub(super) fn metadata(&self) -> ModelMetadata {
        let Self { grid, coordinates, alpha, range, .. } = *self;
        let recipe = self.recipe.clone();
        ModelMetadata { grid, coordinates, alpha, range, recipe, ..ModelMetadata::default() }
    }

    /// The frame of the grid, unless it is the default.
    fn frame(&self) -> Option<Frame> {
        let default = Frame::VOXEL.with_coordinates(self.coordinates);
        self.grid.map(|grid| grid.frame).filter(|frame| *frame != default)
    }

    /// The bytes of the header, with its checksum.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let frame = self.frame();
        let world = self.grid.is_some_and(|grid| grid.units == Units::World);
        let flags = [
            (GRID, self.grid.is_some()),
            (FRAME, frame.is_some()),
            (WORLD, world),
            (STEPS, matches!(self.values, Values::Steps { .. })),
            (EXACT_VALUES, self.values == Values::Exact),
            (EXACT_WEIGHTS, self.weights == Weights::Exact),
            (ALPHA, self.alpha.is_some()),
            (RANGE, self.range.is_some()),
        ];
        let flags = flags.iter().filter(|(_, set)| *set).map(|(flag, _)| flag).sum();
        let mut out = FieldWriter(vec![flags]);
        out.coordinates(self.coordinates);
        out.0.push(self.layers.len() as u8);
        for Layer { count, bytes } in &self.layers {
            out.whole(*count);
            bytes.iter().for_each(|&part| out.whole(part));
        }
        if let Some(grid) = self.grid {
            grid.dims.xyz().iter().for_each(|&n| out.whole(n as u64));
        }
        if let Some(frame) = frame {
            out.frame(&frame);
        }
        if let Values::Steps { base, step } = self.values {
            out.doubles(&[base, step]);
        }
        if let Weights::Common(weight) = self.weights {
            out.doubles(&[weight]);
        }
        if let Some(alpha) = self.alpha {
            out.doubles(&[alpha.squared()]);
        }
        if let Some(range) = self.range {
            out.doubles(&[range.low, range.high]);
        }
        if let Some(recipe) = &self.recipe {
            out.0.extend(recipe.as_bytes());
        }
        let FieldWriter(fields) = out;
        // The length counts all of the header, itself included.
        let length = (MODEL.len() + 1 + size_of::<u64>() + fields.len() + CHECKSUM) as u64;
        let mut header = [MODEL, &[VERSION], &length.to_le_bytes(), &fields].concat();
        let checksum = crc32fast::hash(&header);
        header.extend(checksum.to_le_bytes());
        header
    }

    /// Reads the header of a file, and returns it with its length. Allocates a few kilobytes and the recipe, which is
    /// in the file, whatever the header claims.
    pub(super) fn of_bytes(file: &[u8]) -> Result<(Self, usize), Reason> {
        let Some(rest) = file.strip_prefix(MODEL) else {
            return Err(Reason::other("is not a .wvm file: its signature is missing"));
        };
        let mut fields = FieldReader { rest };
        let version = fields.byte()?;
        if version != VERSION {
            let what = format!("is of version {version} of the format: version {VERSION} is read");
            return Err(Reason::unsupported(what, "update walpha"));
        }
        let length = usize::try_from(u64::from_le_bytes(fields.bytes()?)).unwrap_or(usize::MAX);
        let whole = file.get(..length).and_then(|head| head.split_last_chunk::<CHECKSUM>());
        let Some((head, checksum)) = whole else {
            return Err(Reason::truncated("is truncated: it ends within its header"));
        };
        if !checksum_matches(head, u32::from_le_bytes(*checksum)) {
            return Err(damaged("its header"));
        }
        let mut fields =
            FieldReader { rest: head.get(file.len() - fields.rest.len()..).unwrap_or_default() };
        let mut header = Self::of_fields(&mut fields)?;
        if !fields.rest.is_empty() {
            let recipe = String::from_utf8(fields.rest.to_vec());
            header.recipe = Some(recipe.map_err(|_| Reason::header("its recipe is not UTF-8"))?);
        }
        Ok((header, length))
    }

    fn of_fields(fields: &mut FieldReader<'_>) -> Result<Self, Reason> {
        let flags = fields.byte()?;
        let has = |flag: u8| flags & flag != 0;
        let coordinates = fields.coordinates()?;
        let count = fields.byte()?;
        let layers = (0..count).map(|_| Layer::of_fields(fields)).collect::<Result<Vec<_>, _>>()?;
        let grid = if has(GRID) {
            let [x, y, z] = [fields.whole()?, fields.whole()?, fields.whole()?];
            let dims = Dims::new(x, y, z).map_err(|error| Reason::header(error.to_string()))?;
            let default = Frame::VOXEL.with_coordinates(coordinates);
            let frame = if has(FRAME) { fields.frame()? } else { default };
            let units = if has(WORLD) { Units::World } else { Units::Voxel };
            Some(SampleGrid { dims, frame, units })
        } else {
            None
        };
        let values = match (has(STEPS), has(EXACT_VALUES)) {
            (true, true) => {
                return Err(Reason::header("its header says that values are stored in two ways"));
            }
            (true, false) => Values::Steps { base: fields.double()?, step: fields.double()? },
            (false, true) => Values::Exact,
            (false, false) => Values::None,
        };
        let exact_weights = has(EXACT_WEIGHTS);
        let weights =
            if exact_weights { Weights::Exact } else { Weights::Common(fields.double()?) };
        let alpha = if has(ALPHA) { Some(fields.alpha()?) } else { None };
        let range = if has(RANGE) {
            Some(GrayRange { low: fields.double()?, high: fields.double()? })
        } else {
            None
        };
        let header =
            Self { grid, coordinates, alpha, range, recipe: None, values, weights, layers };
        header.check()?;
        Ok(header)
    }

    /// Refuses a header that contradicts itself.
    fn check(&self) -> Result<(), Reason> {
        let what = |what: &str| Err(Reason::header(format!("its header {what}")));
        if self.grid.is_none()
            && (self.layers.len() > 1 || matches!(self.values, Values::Steps { .. }))
        {
            return what("has layers or steps without a grid");
        }
        let mut points = 0u64;
        for layer in &self.layers {
            let Some(length) = layer.length() else {
                return what("claims more bytes than 64 bits can count");
            };
            if layer.count > length.saturating_mul(POINTS_PER_BYTE) {
                return what("claims more points than its bytes can hold");
            }
            points = points.saturating_add(layer.count);
        }
        let most = self.grid.map_or(Dims::MAX_SAMPLES, |grid| grid.dims.samples() as u64);
        if points > most { what("claims more points than samples") } else { Ok(()) }
    }
}

/// Whether bytes have this checksum. Always true for fuzzers, which cannot guess one.
pub(super) fn checksum_matches(bytes: &[u8], checksum: u32) -> bool {
    cfg!(fuzzing) || crc32fast::hash(bytes) == checksum
}

/// The error for a wrong checksum.
pub(super) fn damaged(what: &str) -> Reason {
    Reason::damaged(format!("is damaged: the checksum of {what} does not match"))
}
