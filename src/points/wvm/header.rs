//! The head of a file: what it holds, and the length of everything behind it.

use walpha_complex::Alpha;

use super::fields::{In, Out};
use crate::points::model::MODEL;
use crate::points::{ModelMetadata, SampleGrid, Units};
use crate::volume::{Coordinates, Dims, Frame, GrayRange, Reason};

/// The version without a recipe, which is written where there is none.
const WITHOUT_RECIPE: u8 = 1;
/// The version whose header ends with a recipe.
const WITH_RECIPE: u8 = 2;
/// Longest recipe that is kept, in bytes: the length of a header has 16 bits.
const MAX_RECIPE: usize = 1 << 15;

/// Points per byte of a layer, at most: what is believed of a header is in proportion to the file.
pub(super) const POINTS_PER_BYTE: u64 = 64;

/// Bytes of a checksum.
pub(super) const CHECKSUM: usize = 4;

/// Bytes of the length of the head.
const LENGTH: usize = 2;

/// What a file holds.
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

/// How values are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Values {
    None,
    /// As whole multiples of a step, from a base on.
    Steps {
        base: f64,
        step: f64,
    },
    /// Bit for bit.
    Exact,
}

/// How weights are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Weights {
    /// One for all.
    Common(f64),
    /// Bit for bit.
    Exact,
}

/// Points of a layer, and the bytes of its places, values and weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Layer {
    pub count: u64,
    pub bytes: [u64; 3],
}

impl Layer {
    /// Bytes of all its parts; `None` where they are more than can be.
    pub(super) fn length(&self) -> Option<u64> {
        self.bytes.iter().try_fold(0u64, |sum, &part| sum.checked_add(part))
    }
}

/// The bits of the byte of flags.
const GRID: u8 = 1;
const FRAME: u8 = 2;
const WORLD: u8 = 4;
const STEPS: u8 = 8;
const EXACT_VALUES: u8 = 16;
const EXACT_WEIGHTS: u8 = 32;
const ALPHA: u8 = 64;
const RANGE: u8 = 128;

impl Header {
    /// What is stored besides the points.
    pub(super) fn facts(&self) -> ModelMetadata {
        let Self { grid, coordinates, alpha, range, .. } = *self;
        let recipe = self.recipe.clone();
        ModelMetadata { grid, coordinates, alpha, range, recipe, order: None, cell: None }
    }

    /// The frame of the grid, where it has to be stored.
    fn frame(&self) -> Option<Frame> {
        let default = Frame::VOXEL.with_coordinates(self.coordinates);
        self.grid.map(|grid| grid.frame).filter(|frame| *frame != default)
    }

    /// The bytes of the head, with its checksum.
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
        let recipe = self.recipe.as_ref().filter(|recipe| recipe.len() <= MAX_RECIPE);
        let mut out = Out(MODEL.to_vec());
        out.0.push(if recipe.is_some() { WITH_RECIPE } else { WITHOUT_RECIPE });
        let length = out.0.len();
        out.0.extend([0; LENGTH]);
        out.0.push(flags);
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
        if let Some(recipe) = recipe {
            out.0.extend(recipe.as_bytes());
        }
        let whole =
            u16::try_from(out.0.len() + CHECKSUM).expect("a few hundred bytes and a recipe");
        out.0[length..][..LENGTH].copy_from_slice(&whole.to_le_bytes());
        let checksum = crc32fast::hash(&out.0);
        out.0.extend(checksum.to_le_bytes());
        out.0
    }

    /// Reads the head of a file, and says how long it is. Nothing is believed of it beyond that; what is
    /// allocated is a few kilobytes.
    pub(super) fn of_bytes(file: &[u8]) -> Result<(Self, usize), Reason> {
        let Some(rest) = file.strip_prefix(MODEL) else {
            return Err(Reason::other("is no .wvm: it does not begin as one"));
        };
        let mut fields = In { rest };
        let version = fields.byte()?;
        if ![WITHOUT_RECIPE, WITH_RECIPE].contains(&version) {
            let what = format!(
                "is of version {version} of the format: versions {WITHOUT_RECIPE} and {WITH_RECIPE} are read"
            );
            return Err(Reason::unsupported(what, "update walpha"));
        }
        let length = usize::from(u16::from_le_bytes(fields.bytes()?));
        let whole = file.get(..length).and_then(|head| head.split_last_chunk::<CHECKSUM>());
        let Some((head, checksum)) = whole else {
            return Err(Reason::truncated("is truncated: it ends within its header"));
        };
        if !fits(head, u32::from_le_bytes(*checksum)) {
            return Err(damaged("its header"));
        }
        let mut fields =
            In { rest: head.get(file.len() - fields.rest.len()..).unwrap_or_default() };
        let mut header = Self::of_fields(&mut fields)?;
        if version == WITH_RECIPE {
            let recipe = String::from_utf8(fields.rest.to_vec());
            header.recipe = Some(recipe.map_err(|_| Reason::header("its recipe is not UTF-8"))?);
        } else if !fields.rest.is_empty() {
            return Err(Reason::header("its header is longer than its fields"));
        }
        Ok((header, length))
    }

    fn of_fields(fields: &mut In<'_>) -> Result<Self, Reason> {
        let flags = fields.byte()?;
        let has = |flag: u8| flags & flag != 0;
        let coordinates = fields.coordinates()?;
        let count = fields.byte()?;
        let layers = (0..count).map(|_| fields.layer()).collect::<Result<Vec<_>, _>>()?;
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
            (true, true) => return Err(Reason::header("its header keeps values in two ways")),
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

    /// Refuses what contradicts itself.
    fn check(&self) -> Result<(), Reason> {
        let what = |what: &str| Err(Reason::header(format!("its header {what}")));
        if self.grid.is_none()
            && (self.layers.len() > 1 || matches!(self.values, Values::Steps { .. }))
        {
            return what("has layers or steps without a grid");
        }
        let mut points = 0u64;
        for layer in &self.layers {
            let Some(length) = layer.length() else { return what("claims more bytes than can be") };
            if layer.count > length.saturating_mul(POINTS_PER_BYTE) {
                return what("claims more points than its bytes can hold");
            }
            points = points.saturating_add(layer.count);
        }
        let most = self.grid.map_or(Dims::MAX_SAMPLES, |grid| grid.dims.samples() as u64);
        if points > most { what("claims more points than samples") } else { Ok(()) }
    }
}

/// Whether bytes have this checksum. Fuzzers, which cannot guess one, get past it.
pub(super) fn fits(bytes: &[u8], checksum: u32) -> bool {
    cfg!(fuzzing) || crc32fast::hash(bytes) == checksum
}

/// The error for damaged bytes.
pub(super) fn damaged(what: &str) -> Reason {
    Reason::damaged(format!("is damaged: the checksum of {what} does not fit"))
}
