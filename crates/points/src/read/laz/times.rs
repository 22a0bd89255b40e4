//! GPS times: of points in formats 1 and 3 to 5, where they are a field of their own, and of those in formats 6 to 10, where they
//! are a layer.
//!
//! Source: `LASzip`'s items `GPSTIME11`, version 2, and `POINT14`, version 3 (Isenburg, "`LASzip`: lossless compression of `LiDAR`
//! data", 2013).

use std::io::{self, Read};

use laz::decoders::ArithmeticDecoder;
use laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use laz::record::FieldDecompressor;

/// The symbols after a step of 0: the same time, a step of 32 bits, or a whole time; higher symbols change the sequence.
const STILL: u32 = 0;
const STEP: u32 = 1;
const WHOLE: u32 = 2;
const STILL_SYMBOLS: u32 = 6;

/// The symbols after another step: 0 for a step unlike the last one; 1 for a similar one; a multiple of the last step, up to
/// [`MOST`], or behind that down to -[`LEAST`]; the same time; a whole time; higher symbols change the sequence.
const UNLIKE: u32 = 0;
const LIKE: u32 = 1;
const MOST: u32 = 500;
const LEAST: u32 = 10;
const SAME: u32 = MOST + LEAST + 1;
const WHOLE_TIME: u32 = SAME + 1;
const STEP_SYMBOLS: u32 = WHOLE_TIME + 4;

/// The number of steps unlike the last one after which the last one is replaced.
const PATIENCE: u8 = 3;

/// Times, as the bits of doubles, of points that were measured one after another.
#[derive(Clone, Copy, Default)]
struct Sequence {
    time: i64,
    step: i32,
    /// The number of steps that were unlike `step`.
    unlike: u8,
}

/// A decoder of GPS times. Lasers alternate, so it follows four sequences of times.
pub(super) struct GpsTimes {
    /// Whether symbols say that a time is the same. In layers, another one says that it changes, and they lack these symbols.
    may_stay: bool,
    sequences: [Sequence; 4],
    current: usize,
    newest: usize,
    still: ArithmeticModel,
    steps: ArithmeticModel,
    differences: IntegerDecompressor,
}

impl GpsTimes {
    pub(super) fn new() -> Self {
        Self::with(true, 0)
    }

    /// Those of a layer, which begins with a time (the bits of a double).
    pub(super) fn in_layer(first: i64) -> Self {
        Self::with(false, first)
    }

    fn with(may_stay: bool, first: i64) -> Self {
        let mut sequences = [Sequence::default(); 4];
        sequences[0].time = first;
        let symbols = |all: u32| ArithmeticModelBuilder::new(all - u32::from(!may_stay)).build();
        Self {
            may_stay,
            sequences,
            current: 0,
            newest: 0,
            still: symbols(STILL_SYMBOLS),
            steps: symbols(STEP_SYMBOLS),
            differences: IntegerDecompressorBuilder::new().bits(32).contexts(9).build_initialized(),
        }
    }

    /// Decodes the next time.
    ///
    /// # Errors
    /// Errors of the stream; `InvalidData` if the sequence changes more often than there are sequences, as a writer changes it at
    /// most once.
    pub(super) fn next<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<i64> {
        // The numbers of symbols from this one on are one less where there is none for the same time.
        let lacks = !self.may_stay;
        let symbol = |read: u32, same: u32| read + u32::from(lacks && read >= same);
        for _ in 0..=self.sequences.len() {
            let change = if self.sequences[self.current].step == 0 {
                match symbol(decoder.decode_symbol(&mut self.still)?, STILL) {
                    STILL => 0,
                    STEP => {
                        let step = self.differences.decompress(decoder, 0, 0)?;
                        self.advance(step);
                        self.replace(step);
                        0
                    }
                    WHOLE => {
                        self.whole(decoder)?;
                        0
                    }
                    symbol => symbol - WHOLE,
                }
            } else {
                match symbol(decoder.decode_symbol(&mut self.steps)?, SAME) {
                    symbol @ ..SAME => {
                        self.step(decoder, symbol)?;
                        0
                    }
                    SAME => 0,
                    WHOLE_TIME => {
                        self.whole(decoder)?;
                        0
                    }
                    symbol => symbol - WHOLE_TIME,
                }
            };
            if change == 0 {
                return Ok(self.sequences[self.current].time);
            }
            self.current = (self.current + change as usize) % self.sequences.len();
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "its GPS times are damaged"))
    }

    /// Decodes a step that is predicted from the last one.
    fn step<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>, symbol: u32) -> io::Result<()> {
        let (multiple, context) = match symbol {
            UNLIKE => (0, 7),
            LIKE => (1, 1),
            2..10 => (symbol.cast_signed(), 2),
            10..MOST => (symbol.cast_signed(), 3),
            MOST => (MOST.cast_signed(), 4),
            _ if symbol < MOST + LEAST => (MOST.cast_signed() - symbol.cast_signed(), 5),
            _ => (-LEAST.cast_signed(), 6),
        };
        let last = self.sequences[self.current].step;
        let step = self.differences.decompress(decoder, last.wrapping_mul(multiple), context)?;
        self.advance(step);
        let sequence = &mut self.sequences[self.current];
        match context {
            1 => sequence.unlike = 0,
            4 | 6 | 7 if sequence.unlike == PATIENCE => self.replace(step),
            4 | 6 | 7 => sequence.unlike += 1,
            _ => {}
        }
        Ok(())
    }

    /// Decodes a time that is near none of the sequences. It starts anew the sequence that was started longest ago.
    fn whole<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<()> {
        let last = self.sequences[self.current].time >> 32;
        let high = self.differences.decompress(decoder, last as i32, 8)?;
        let time = i64::from(high) << 32 | i64::from(decoder.read_int()?);
        self.newest = (self.newest + 1) % self.sequences.len();
        self.current = self.newest;
        self.sequences[self.current] = Sequence { time, ..Sequence::default() };
        Ok(())
    }

    fn advance(&mut self, step: i32) {
        let time = &mut self.sequences[self.current].time;
        *time = time.wrapping_add(step.into());
    }

    fn replace(&mut self, step: i32) {
        let sequence = &mut self.sequences[self.current];
        (sequence.step, sequence.unlike) = (step, 0);
    }
}

impl<R: Read> FieldDecompressor<R> for GpsTimes {
    fn size_of_field(&self) -> usize {
        size_of::<f64>()
    }

    fn decompress_first(&mut self, src: &mut R, first_point: &mut [u8]) -> io::Result<()> {
        let mut bytes = [0; size_of::<f64>()];
        src.read_exact(&mut bytes)?;
        self.sequences[0].time = i64::from_le_bytes(bytes);
        first_point.copy_from_slice(&bytes);
        Ok(())
    }

    fn decompress_with(
        &mut self,
        decoder: &mut ArithmeticDecoder<R>,
        buf: &mut [u8],
    ) -> io::Result<()> {
        buf.copy_from_slice(&self.next(decoder)?.to_le_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use laz::encoders::ArithmeticEncoder;

    use super::*;

    /// A million changes of the sequence do not exhaust the stack: the fifth is an error.
    #[test]
    fn changes_without_an_end_are_an_error() {
        let mut encoder = ArithmeticEncoder::new(Vec::new());
        let mut still = ArithmeticModelBuilder::new(STILL_SYMBOLS);
        let mut still = still.with_compression(true).build();
        for _ in 0..1_000_000 {
            encoder.encode_symbol(&mut still, WHOLE + 1).unwrap();
        }
        encoder.done().unwrap();
        let stream = encoder.into_inner();
        assert!(stream.len() < 1 << 10, "{}", stream.len());
        let mut decoder = ArithmeticDecoder::new(stream.as_slice());
        decoder.read_init_bytes().unwrap();
        let refused = GpsTimes::new().next(&mut decoder).unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::InvalidData);
    }
}
