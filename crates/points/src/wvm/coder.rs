//! Range coding of bits, each with a probability from a model.

use std::borrow::Borrow;
use std::num::NonZeroU32;

use constriction::stream::model::{DecoderModel, EncoderModel, EntropyModel};
use constriction::stream::queue::{DefaultRangeDecoder, DefaultRangeEncoder};
use constriction::stream::{Decode, Encode};

/// Probabilities are multiples of 2⁻¹⁶.
const PRECISION: usize = 16;

/// The probability 1.
pub(super) const WHOLE: u32 = 1 << PRECISION;

/// An encoder or decoder of bits, so that one model serves both directions.
pub(super) trait Coder {
    /// Codes a bit that is 1 with the probability `one`/2¹⁶, from 1 to 2¹⁶ − 1, and returns it. A
    /// decoder ignores `bit`.
    fn bit(&mut self, one: u32, bit: bool) -> bool;
}

/// Encodes bits into a stream.
#[derive(Default)]
pub(super) struct Encoder(DefaultRangeEncoder);

/// Decodes bits from a stream. After its end, or if it is damaged, the bits are arbitrary.
pub(super) struct Decoder(DefaultRangeDecoder);

/// The distribution of a bit that is 1 with the probability `one`/2¹⁶.
#[derive(Clone, Copy)]
struct Bit {
    one: u32,
}

impl Bit {
    /// The start and length of the interval of a bit.
    fn interval(self, bit: bool) -> (u32, NonZeroU32) {
        let (start, length) = if bit { (0, self.one) } else { (self.one, WHOLE - self.one) };
        (start, NonZeroU32::new(length).expect("neither bit is certain"))
    }
}

impl EntropyModel<PRECISION> for Bit {
    type Symbol = bool;
    type Probability = u32;
}

impl EncoderModel<PRECISION> for Bit {
    fn left_cumulative_and_probability(
        &self,
        symbol: impl Borrow<bool>,
    ) -> Option<(u32, NonZeroU32)> {
        Some(self.interval(*symbol.borrow()))
    }
}

impl DecoderModel<PRECISION> for Bit {
    fn quantile_function(&self, quantile: u32) -> (bool, u32, NonZeroU32) {
        let bit = quantile < self.one;
        let (start, length) = self.interval(bit);
        (bit, start, length)
    }
}

impl Coder for Encoder {
    fn bit(&mut self, one: u32, bit: bool) -> bool {
        self.0.encode_symbol(bit, Bit { one }).expect("both bits are possible");
        bit
    }
}

impl Encoder {
    /// The stream, as little-endian words of 32 bits.
    pub(super) fn finish(self) -> Vec<u8> {
        let words = self.0.into_compressed().expect("writing to memory cannot fail");
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

impl Coder for Decoder {
    fn bit(&mut self, one: u32, _: bool) -> bool {
        self.0.decode_symbol(Bit { one }).unwrap_or_default()
    }
}

impl Decoder {
    /// Reads a stream; bytes after its last whole word are ignored.
    pub(super) fn new(bytes: &[u8]) -> Self {
        let words = bytes.chunks_exact(4);
        let words = words.map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
        let Ok(decoder) = DefaultRangeDecoder::from_compressed(words.collect::<Vec<_>>());
        Self(decoder)
    }
}
