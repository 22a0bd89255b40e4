//! Bits in and out of the range coder, each with the probability that a model gives it.

use std::borrow::Borrow;
use std::num::NonZeroU32;

use constriction::stream::model::{DecoderModel, EncoderModel, EntropyModel};
use constriction::stream::queue::{DefaultRangeDecoder, DefaultRangeEncoder};
use constriction::stream::{Decode, Encode};

/// Probabilities are multiples of 2⁻¹⁶.
const PRECISION: usize = 16;

/// The whole of a probability.
pub(super) const WHOLE: u32 = 1 << PRECISION;

/// What codes bits. A model is written once, for both directions.
pub(super) trait Coder {
    /// Codes a bit that is 1 with the probability `one`/2¹⁶, from 1 to 2¹⁶ − 1, and returns it. A
    /// decoder takes no notice of `bit`.
    fn bit(&mut self, one: u32, bit: bool) -> bool;
}

/// Bits that go into a stream.
#[derive(Default)]
pub(super) struct Encoder(DefaultRangeEncoder);

/// Bits that come out of a stream. Behind its end, and from a damaged one, come arbitrary bits.
pub(super) struct Decoder(DefaultRangeDecoder);

/// A bit that is 1 with a probability.
#[derive(Clone, Copy)]
struct Bit {
    one: u32,
}

impl Bit {
    /// Where the share of a bit begins, and how long it is.
    fn share(self, bit: bool) -> (u32, NonZeroU32) {
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
        Some(self.share(*symbol.borrow()))
    }
}

impl DecoderModel<PRECISION> for Bit {
    fn quantile_function(&self, quantile: u32) -> (bool, u32, NonZeroU32) {
        let bit = quantile < self.one;
        let (start, length) = self.share(bit);
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
    /// The stream: words of 32 bits, little-endian.
    pub(super) fn finish(self) -> Vec<u8> {
        let words = self.0.into_compressed().expect("memory takes what is written to it");
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

impl Coder for Decoder {
    fn bit(&mut self, one: u32, _: bool) -> bool {
        self.0.decode_symbol(Bit { one }).unwrap_or_default()
    }
}

impl Decoder {
    /// Reads a stream; bytes behind its last whole word are not looked at.
    pub(super) fn new(bytes: &[u8]) -> Self {
        let words = bytes.chunks_exact(4);
        let words = words.map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
        let Ok(decoder) = DefaultRangeDecoder::from_compressed(words.collect::<Vec<_>>());
        Self(decoder)
    }
}
