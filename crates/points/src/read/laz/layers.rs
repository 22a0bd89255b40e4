//! Points of formats 6 to 10, compressed in layers, with their GPS times.
//!
//! The library decodes all layers but that of times. Which points have a new time is stated in the layer of x, y and returns, which
//! is decoded here a second time where times are wanted.
//!
//! Source: `LASzip`'s item `POINT14`, version 3, in `lasreaditemcompressed_v3.cpp`.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use laz::DecompressionSelection;
use laz::decoders::ArithmeticDecoder;
use laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use laz::record::LayeredFieldDecompressor;

use super::times::GpsTimes;

/// The size of a point in bytes without colours and further bytes, and where its time is.
const SIZE: usize = 30;
const TIME: usize = 22;
/// The number of layers of a point; x, y and returns are the first, and times are the last.
const LAYERS: usize = 9;

/// The model of a step along x or y, by the number of returns and the number of this one.
const MODELS: [&[u8; 16]; 16] = [
    b"0123453445555555",
    b"1013333333333333",
    b"2124444444433333",
    b"3345444444444444",
    b"4344544444444444",
    b"5344454444444444",
    b"3344445444444444",
    b"4344444544444444",
    b"4344444454444444",
    b"5344444445444444",
    b"5344444444544444",
    b"5334444444455444",
    b"5334444444455544",
    b"5334444444445554",
    b"5334444444444555",
    b"5334444444444455",
];

type Layer = ArithmeticDecoder<Cursor<Vec<u8>>>;

/// About the median of the last steps: five of them in order, of which a new one replaces the largest or the smallest.
#[derive(Clone, Copy)]
struct Median {
    steps: [i32; 5],
    /// Whether the largest is replaced.
    is_high: bool,
}

impl Median {
    const NEW: Self = Self { steps: [0; 5], is_high: true };

    fn get(&self) -> i32 {
        self.steps[2]
    }

    fn add(&mut self, step: i32) {
        let middle = self.get();
        self.steps[if self.is_high { 4 } else { 0 }] = step;
        self.steps.sort_unstable();
        self.is_high = step < middle || step == middle && !self.is_high;
    }
}

/// Decompresses a point by the decompressor of the library, which is asked for no times, and its time.
pub(super) struct WithTimes<D> {
    own: D,
    /// The sizes of the layers of this chunk, in bytes.
    sizes: [u32; LAYERS],
    places: Layer,
    times: Layer,
    /// Whether the layer of times is empty: all points have that of the first.
    is_one_time: bool,
    /// The models of each channel of the scanner that has occurred.
    channels: [Option<Box<Channel>>; 4],
    current: usize,
}

/// What predicts the next point of a channel.
struct Channel {
    /// Of the last point: the number of its return, the number of returns, its time, and whether it was a new one.
    number: u8,
    returns: u8,
    time: i64,
    is_new: bool,
    /// What changes, by the kind of return of the last point.
    changes: Vec<ArithmeticModel>,
    channel: ArithmeticModel,
    counts: Vec<ArithmeticModel>,
    numbers: Vec<ArithmeticModel>,
    number_at_once: ArithmeticModel,
    steps: [IntegerDecompressor; 2],
    medians: [[Median; 2]; 12],
    times: GpsTimes,
}

impl<D: Default> WithTimes<D> {
    pub(super) fn new() -> Self {
        let layer = || ArithmeticDecoder::new(Cursor::new(Vec::new()));
        Self {
            own: D::default(),
            sizes: [0; LAYERS],
            places: layer(),
            times: layer(),
            is_one_time: true,
            channels: [const { None }; 4],
            current: 0,
        }
    }
}

impl<D> WithTimes<D> {
    /// Decodes the next point as far as its time needs it. Returns its time.
    fn next(&mut self) -> io::Result<i64> {
        /// The bits of a change.
        const CHANNEL: u32 = 6;
        const NEW_TIME: u32 = 4;
        const RETURNS: u32 = 2;
        let Self { places, channels, current, .. } = self;
        let has_begun = "a chunk begins with a point";
        let last = channels[*current].as_mut().expect(has_begun);
        let kind = usize::from(last.number == 1)
            + 2 * usize::from(last.number >= last.returns)
            + 4 * usize::from(last.is_new);
        let change = places.decode_symbol(&mut last.changes[kind])?;
        let has = |bit: u32| change >> bit & 1 == 1;
        if has(CHANNEL) {
            let step = places.decode_symbol(&mut last.channel)? as usize + 1;
            let (number, returns, time) = (last.number, last.returns, last.time);
            *current = (*current + step) % channels.len();
            channels[*current].get_or_insert_with(|| Box::new(Channel::new(number, returns, time)));
        }
        let one = channels[*current].as_mut().expect(has_begun);
        one.is_new = has(NEW_TIME);
        if has(RETURNS) {
            let model = &mut one.counts[usize::from(one.returns)];
            one.returns = places.decode_symbol(model)? as u8;
        }
        let number = match change & 3 {
            0 => one.number,
            1 => one.number + 1,
            2 => one.number + 15,
            _ if one.is_new => {
                places.decode_symbol(&mut one.numbers[usize::from(one.number)])? as u8
            }
            _ => one.number + 2 + places.decode_symbol(&mut one.number_at_once)? as u8,
        };
        one.number = number % 16;
        let [n, r] = [one.returns, one.number].map(usize::from);
        let of = 2 * usize::from(MODELS[n][r] - b'0') + usize::from(one.is_new);
        let is_only = u32::from(n == 1);
        let [x, y] = &mut one.steps;
        let [of_x, of_y] = &mut one.medians[of];
        of_x.add(x.decompress(places, of_x.get(), is_only)?);
        // The number of bits of the step along x, as an even number.
        let bits = if x.k() < 20 { x.k() & !1 } else { 20 };
        of_y.add(y.decompress(places, of_y.get(), is_only + bits)?);
        if one.is_new && !self.is_one_time {
            one.time = one.times.next(&mut self.times)?;
        }
        Ok(one.time)
    }
}

impl Channel {
    /// The models of a channel whose first point follows one with these properties.
    fn new(number: u8, returns: u8, time: i64) -> Self {
        let model = |symbols: u32| ArithmeticModelBuilder::new(symbols).build();
        let models = |count: usize, symbols: u32| (0..count).map(|_| model(symbols)).collect();
        let steps = [2, 22].map(|contexts| {
            IntegerDecompressorBuilder::new().bits(32).contexts(contexts).build_initialized()
        });
        Self {
            number,
            returns,
            time,
            is_new: false,
            changes: models(8, 128),
            channel: model(3),
            counts: models(16, 16),
            numbers: models(16, 16),
            number_at_once: model(13),
            steps,
            medians: [[Median::NEW; 2]; 12],
            times: GpsTimes::in_layer(time),
        }
    }
}

impl<R: Read + Seek, D: LayeredFieldDecompressor<R>> LayeredFieldDecompressor<R> for WithTimes<D> {
    fn size_of_field(&self) -> usize {
        SIZE
    }

    fn set_selection(&mut self, selection: DecompressionSelection) {
        self.own.set_selection(selection.skip_gps_time());
    }

    fn init_first_point(
        &mut self,
        src: &mut R,
        first_point: &mut [u8],
        context: &mut usize,
    ) -> io::Result<()> {
        self.own.init_first_point(src, first_point, context)?;
        let returns = first_point[14];
        let (time, _) = first_point[TIME..].split_first_chunk().expect("it has this size");
        self.current = usize::from(first_point[15] >> 4 & 3);
        self.channels = [const { None }; 4];
        let first = Channel::new(returns & 15, returns >> 4, i64::from_le_bytes(*time));
        self.channels[self.current] = Some(Box::new(first));
        Ok(())
    }

    fn decompress_field_with(
        &mut self,
        current_point: &mut [u8],
        context: &mut usize,
    ) -> io::Result<()> {
        self.own.decompress_field_with(current_point, context)?;
        current_point[TIME..].copy_from_slice(&self.next()?.to_le_bytes());
        Ok(())
    }

    fn read_layers_sizes(&mut self, src: &mut R) -> io::Result<()> {
        let start = src.stream_position()?;
        self.own.read_layers_sizes(src)?;
        src.seek(SeekFrom::Start(start))?;
        for size in &mut self.sizes {
            let mut bytes = [0; 4];
            src.read_exact(&mut bytes)?;
            *size = u32::from_le_bytes(bytes);
        }
        Ok(())
    }

    fn read_layers(&mut self, src: &mut R) -> io::Result<()> {
        let start = src.stream_position()?;
        self.own.read_layers(src)?;
        let [places, .., times] = self.sizes;
        src.seek(SeekFrom::Start(start))?;
        self.places = layer(src, places)?;
        let before: u64 = self.sizes[..LAYERS - 1].iter().map(|&size| u64::from(size)).sum();
        src.seek(SeekFrom::Start(start + before))?;
        self.is_one_time = times == 0;
        if !self.is_one_time {
            self.times = layer(src, times)?;
        }
        Ok(())
    }
}

/// Reads a layer of this size in bytes, which the claims of the file were checked for.
fn layer(src: &mut impl Read, size: u32) -> io::Result<Layer> {
    let mut bytes = vec![0; size as usize];
    src.read_exact(&mut bytes)?;
    let mut layer = ArithmeticDecoder::new(Cursor::new(bytes));
    layer.read_init_bytes()?;
    Ok(layer)
}
