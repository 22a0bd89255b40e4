//! Decompresses the points of a LAZ file to the records of a LAS file.

use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::panic::resume_unwind;

use laz::las::{v3, v4};
use laz::laszip::ChunkTable;
use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};
use laz::{DecompressionSelection, LasZipError, LazItemType, LazVlr};
use walpha_base::foreign::decode;
use walpha_base::parallel::prelude::*;

use super::claims::{Chunk, Claims, LAYERED, POINTWISE};
use super::layers::WithTimes;
use super::times::GpsTimes;

/// Decompresses records, one after another.
pub(in crate::read) struct Records<R: Read + Seek + Send + Sync + 'static>(Kind<R>);

enum Kind<R: Read + Seek + Send + Sync + 'static> {
    /// Formats 0 to 5 in one stream, or in chunks of which no table says where they are.
    Stream {
        description: LazVlr,
        decompressor: SequentialPointRecordDecompressor<'static, R>,
        /// The numbers of points in the remaining chunks.
        chunks: Box<dyn Iterator<Item = u64> + Send>,
        /// The number of points left in this chunk.
        left: u64,
    },
    /// Chunks, which are decompressed in parallel. Of layers, fields that are not needed stay 0.
    Chunks {
        description: LazVlr,
        stream: R,
        chunks: std::vec::IntoIter<Chunk>,
        /// `None` for formats 0 to 5.
        layers: Option<Layers>,
        /// A chunk of which some points have been read.
        begun: Option<Begun>,
    },
}

/// Which layers are decompressed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layers {
    /// Those of coordinates, returns, intensities, classes and flags.
    Needed,
    /// All but waveforms.
    Whole,
}

/// A chunk in memory.
struct Begun {
    decompressor: Box<dyn RecordDecompressor<Cursor<Vec<u8>>> + Send>,
    /// The number of points left in this chunk.
    left: u64,
}

impl<R: Read + Seek + Send + Sync + 'static> Records<R> {
    /// Decompresses the points of a file with these claims: all, or, of layers, those of the chunks that are left there. Of layers
    /// those of coordinates, returns, intensities, classes and flags, or, with `whole`, all but waveforms.
    ///
    /// # Errors
    /// Errors of the stream, or of the record that describes the compression.
    pub(in crate::read) fn new(
        mut stream: R,
        claims: &Claims,
        description: LazVlr,
        whole: bool,
    ) -> Result<Self, LasZipError> {
        let (chunks, layers) = if claims.compressor == LAYERED {
            let layers = if whole { Layers::Whole } else { Layers::Needed };
            (Some(claims.chunks.clone()), Some(layers))
        } else {
            (chunks(&mut stream, claims, &description), None)
        };
        if let Some(chunks) = chunks {
            let chunks = chunks.into_iter();
            return Ok(Self(Kind::Chunks { description, stream, chunks, layers, begun: None }));
        }
        stream.seek(SeekFrom::Start(claims.data))?;
        let chunks: Box<dyn Iterator<Item = u64> + Send> = if claims.compressor == POINTWISE {
            Box::new(std::iter::once(u64::MAX))
        } else if description.uses_variable_size_chunks() {
            let table = ChunkTable::read_from(&mut stream, &description)?;
            let chunks: Vec<u64> = table.into_iter().map(|chunk| chunk.point_count).collect();
            Box::new(chunks.into_iter())
        } else {
            stream.seek(SeekFrom::Current(ChunkTable::OFFSET_SIZE as i64))?;
            Box::new(std::iter::repeat(description.chunk_size().into()))
        };
        let decompressor = SequentialPointRecordDecompressor::new(stream);
        Ok(Self(Kind::Stream { description, decompressor, chunks, left: 0 }))
    }

    /// Fills `records` with the next whole records.
    ///
    /// # Errors
    /// Errors of the stream; `UnexpectedEof` behind the last chunk; `InvalidData` for data that no writer creates.
    pub(in crate::read) fn fill(&mut self, records: &mut [u8]) -> io::Result<()> {
        match &mut self.0 {
            Kind::Chunks { description, stream, chunks, layers, begun } => {
                let size = description.items_size() as usize;
                let mut parts = Vec::new();
                let mut rest = records;
                while rest.len() >= size {
                    let chunk = if let Some(chunk) = begun.take() {
                        chunk
                    } else {
                        let chunk = chunks.next().ok_or(io::ErrorKind::UnexpectedEof)?;
                        Begun::new(stream, chunk, description, *layers)?
                    };
                    let count = chunk.left.min((rest.len() / size) as u64) as usize;
                    let (part, after) = rest.split_at_mut(count * size);
                    rest = after;
                    parts.push((chunk, part));
                }
                // Panics of the library end in the thread that asked, which turns them into errors.
                let fill = |(chunk, part): &mut (Begun, &mut [u8])| {
                    decode(|| chunk.fill(part, size)).map_err(|panicked| panicked.message)
                };
                let filled: Vec<_> = parts.par_iter_mut().map(fill).collect();
                for filled in filled {
                    filled.unwrap_or_else(|message| resume_unwind(Box::new(message)))?;
                }
                *begun = parts.pop().map(|(chunk, _)| chunk).filter(|chunk| chunk.left > 0);
                Ok(())
            }
            Kind::Stream { description, decompressor, chunks, left } => {
                for record in records.chunks_exact_mut(description.items_size() as usize) {
                    if *left == 0 {
                        *left = chunks.next().ok_or(io::ErrorKind::UnexpectedEof)?;
                        begin(decompressor, description)?;
                    }
                    decompressor.decompress_next(record)?;
                    *left = left.checked_sub(1).ok_or_else(|| damaged("a chunk has no points"))?;
                }
                Ok(())
            }
        }
    }
}

/// The chunks of points that are not in layers, if a table says where they are, and agrees with the file.
fn chunks<R: Read + Seek>(
    stream: &mut R,
    claims: &Claims,
    description: &LazVlr,
) -> Option<Vec<Chunk>> {
    if claims.compressor == POINTWISE {
        return None;
    }
    let end = claims.table(stream).ok()??;
    stream.seek(SeekFrom::Start(claims.data)).ok()?;
    let table = ChunkTable::read_from(stream, description).ok()?;
    let (mut at, mut left) = (claims.data + ChunkTable::OFFSET_SIZE as u64, claims.points);
    let mut chunks = Vec::new();
    for entry in &table {
        let chunk = Chunk {
            start: at,
            end: at.checked_add(entry.byte_count)?,
            points: entry.point_count.min(left),
        };
        at = chunk.end;
        left -= chunk.points;
        if chunk.points > 0 {
            chunks.push(chunk);
        }
    }
    (at == end && left == 0).then_some(chunks)
}

/// Begins a chunk of points that are not in layers. Each chunk has its own models, and its first point is not compressed.
fn begin<R: Read>(
    decompressor: &mut SequentialPointRecordDecompressor<'_, R>,
    description: &LazVlr,
) -> io::Result<()> {
    decompressor.reset();
    for item in description.items() {
        // Version 1 of GPS times has only one sequence.
        if item.item_type() == LazItemType::GpsTime && item.version() == 2 {
            decompressor.add_field_decompressor(GpsTimes::new());
        } else {
            decompressor.set_fields_from(&vec![*item]).map_err(invalid)?;
        }
    }
    Ok(())
}

/// The decompressor of a chunk of layers.
fn begin_layers(
    bytes: Cursor<Vec<u8>>,
    description: &LazVlr,
    layers: Layers,
) -> io::Result<LayeredPointRecordDecompressor<'static, Cursor<Vec<u8>>>> {
    let whole = layers == Layers::Whole;
    let mut decompressor = LayeredPointRecordDecompressor::new(bytes);
    for item in description.items() {
        match (item.item_type(), item.version()) {
            (LazItemType::Point14, 3) if whole => {
                let with_times = WithTimes::<v3::LasPoint6Decompressor>::new();
                decompressor.add_field_decompressor(with_times);
            }
            (LazItemType::Point14, 4) if whole => {
                let with_times = WithTimes::<v4::LasPoint6Decompressor>::new();
                decompressor.add_field_decompressor(with_times);
            }
            _ => decompressor.set_fields_from(&vec![*item]).map_err(invalid)?,
        }
    }
    decompressor.set_selection(if whole {
        DecompressionSelection::all().skip_wavepacket()
    } else {
        DecompressionSelection::base()
            .decompress_z()
            .decompress_intensity()
            .decompress_classification()
            .decompress_flags()
    });
    Ok(decompressor)
}

impl Begun {
    /// Reads a chunk, and begins to decompress it.
    fn new<R: Read + Seek>(
        stream: &mut R,
        chunk: Chunk,
        description: &LazVlr,
        layers: Option<Layers>,
    ) -> io::Result<Self> {
        stream.seek(SeekFrom::Start(chunk.start))?;
        let length = chunk.end - chunk.start;
        let mut bytes = Vec::new();
        if stream.take(length).read_to_end(&mut bytes)? as u64 != length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let bytes = Cursor::new(bytes);
        let decompressor: Box<dyn RecordDecompressor<_> + Send> = if let Some(layers) = layers {
            Box::new(begin_layers(bytes, description, layers)?)
        } else {
            let mut decompressor = SequentialPointRecordDecompressor::new(bytes);
            begin(&mut decompressor, description)?;
            Box::new(decompressor)
        };
        Ok(Self { decompressor, left: chunk.points })
    }

    /// Fills `records`, no more than are left, with records of this size.
    fn fill(&mut self, records: &mut [u8], size: usize) -> io::Result<()> {
        for record in records.chunks_exact_mut(size) {
            self.decompressor.decompress_next(record)?;
            self.left -= 1;
        }
        Ok(())
    }
}

fn damaged(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

fn invalid(error: LasZipError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error)
}

#[cfg(test)]
mod tests {
    use laz::{LasZipCompressor, LazItemRecordBuilder, LazItemType, LazVlrBuilder};

    use super::super::claims::CHUNKED;
    use super::*;

    /// The size in bytes of a point of format 1, and of one of format 6, and where their times are.
    const BYTES: usize = 28;
    const LAYERED_BYTES: usize = 30;

    /// Random numbers below a bound.
    struct Random(u64);

    impl Random {
        fn next(&mut self, bound: u64) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0 % bound
        }
    }

    /// Times that use all ways of storing them: equal times, steps that are similar, dissimilar, multiples and reversed, several
    /// sequences that alternate, and times far from all of them.
    fn times(count: usize) -> Vec<f64> {
        let mut random = Random(0x2545_f491_4f6c_dd1d);
        let mut times = [4.1e5_f64, 4.2e5, 4.3e5, 4.4e5, 9.9e8];
        let (mut way, mut of) = (0, 0);
        let next = |k: usize| {
            if k.is_multiple_of(97) {
                (way, of) = (random.next(7), random.next(5) as usize);
            }
            let step = match way {
                0 => 0.0,
                1 => 1e-6,
                2 => 1e-6 * random.next(600) as f64,
                3 => -1e-6 * random.next(12) as f64,
                4 => random.next(1 << 40) as f64,
                5 => f64::from_bits(times[of].to_bits() + random.next(20)) - times[of],
                _ => {
                    of = random.next(5) as usize;
                    1e-6
                }
            };
            times[of] += step;
            times[of]
        };
        (0..count).map(next).collect()
    }

    fn records(count: usize) -> Vec<u8> {
        let mut random = Random(7);
        let mut records = vec![0; count * BYTES];
        for (record, time) in records.chunks_exact_mut(BYTES).zip(times(count)) {
            record[0] = random.next(256) as u8;
            record[12] = random.next(4) as u8;
            record[20..].copy_from_slice(&time.to_le_bytes());
        }
        records
    }

    /// Records of format 6 with all numbers of returns, in all channels of the scanner.
    fn layered(count: usize) -> Vec<u8> {
        let mut random = Random(11);
        let mut records = vec![0; count * LAYERED_BYTES];
        let mut place = [0i32; 2];
        let mut channel = 0;
        for (k, (record, time)) in
            records.chunks_exact_mut(LAYERED_BYTES).zip(times(count)).enumerate()
        {
            for (axis, place) in place.iter_mut().enumerate() {
                let step =
                    if k.is_multiple_of(50) { random.next(1 << 31) } else { random.next(90) };
                *place = place.wrapping_add(step as i32);
                record[4 * axis..4 * axis + 4].copy_from_slice(&place.to_le_bytes());
            }
            record[8] = random.next(256) as u8;
            record[12] = random.next(4) as u8;
            record[14] = random.next(256) as u8;
            if k.is_multiple_of(31) {
                channel = random.next(4) as u8;
            }
            record[15] = channel << 4 | random.next(16) as u8;
            record[16] = random.next(20) as u8;
            record[20] = random.next(3) as u8;
            record[22..].copy_from_slice(&time.to_le_bytes());
        }
        records
    }

    fn packed(whole: &[u8], size: usize, description: &LazVlr, ends: &[usize]) -> Cursor<Vec<u8>> {
        let mut packed = Cursor::new(vec![0; 9]);
        packed.set_position(9);
        let mut compressor = LasZipCompressor::new(packed, description.clone()).unwrap();
        compressor.reserve_offset_to_chunk_table().unwrap();
        for (k, record) in whole.chunks_exact(size).enumerate() {
            if ends.contains(&k) {
                compressor.finish_current_chunk().unwrap();
            }
            compressor.compress_one(record).unwrap();
        }
        compressor.done().unwrap();
        let mut packed = compressor.into_inner();
        packed.set_position(0);
        packed
    }

    fn claims(compressor: u16, items: &[(u16, u16)], points: usize, packed: &[u8]) -> Claims {
        Claims {
            compressor,
            items: items.to_vec(),
            record: items.iter().map(|&(_, bytes)| u64::from(bytes)).sum(),
            points: points as u64,
            data: 9,
            length: packed.len() as u64,
            chunks: Vec::new(),
        }
    }

    /// The records that the library compresses are decompressed to the same bytes, in chunks of one size and of varying sizes.
    #[test]
    fn records_are_those_that_were_compressed() {
        let whole = records(120_000);
        let items = || {
            LazItemRecordBuilder::new()
                .add_item(LazItemType::Point10)
                .add_item(LazItemType::GpsTime)
                .build()
        };
        for variable in [false, true] {
            let builder = LazVlrBuilder::new(items());
            let (description, ends) = if variable {
                (builder.with_variable_chunk_size().build(), &[5, 6, 80_000][..])
            } else {
                (builder.with_fixed_chunk_size(7_001).build(), &[][..])
            };
            let packed = packed(&whole, BYTES, &description, ends);
            // The table of chunks has fewer points than the second one claims, so it is not relied on.
            for points in [120_000, 130_000] {
                let claims = claims(CHUNKED, &[], points, packed.get_ref());
                let read = Records::new(packed.clone(), &claims, description.clone(), false);
                let mut read = read.unwrap();
                assert_eq!(matches!(read.0, Kind::Chunks { .. }), points == 120_000);
                let mut found = vec![0; whole.len()];
                let (begin, rest) = found.split_at_mut(BYTES * 777);
                read.fill(begin).unwrap();
                read.fill(rest).unwrap();
                assert!(found == whole, "variable: {variable}, {points} points");
                if variable || points == 120_000 {
                    assert!(read.fill(&mut [0; BYTES]).is_err());
                }
            }
        }
    }

    /// Records in layers are decompressed to the same bytes, with their times; and some of their chunks.
    #[test]
    fn layers_are_those_that_were_compressed() {
        let whole = layered(60_000);
        let items = LazItemRecordBuilder::new().add_item(LazItemType::Point14).build();
        let description = LazVlrBuilder::new(items).with_fixed_chunk_size(7_001).build();
        let packed = packed(&whole, LAYERED_BYTES, &description, &[]);
        let mut claims = claims(LAYERED, &[(10, 30)], 60_000, packed.get_ref());
        claims.check(&mut packed.clone()).unwrap().unwrap();
        assert_eq!(claims.chunks.len(), 9);
        let mut found = vec![0; whole.len()];
        let read = |claims: &Claims, whole: bool, room: &mut [u8]| {
            let records = Records::new(packed.clone(), claims, description.clone(), whole);
            // The first time ends within a chunk.
            let mut records = records.unwrap();
            let (begin, rest) = room.split_at_mut(LAYERED_BYTES * 777);
            records.fill(begin).unwrap();
            records.fill(rest).unwrap();
            assert!(records.fill(begin).is_err());
        };
        read(&claims, true, &mut found);
        let differs = found.chunks(LAYERED_BYTES).zip(whole.chunks(LAYERED_BYTES));
        assert_eq!(differs.enumerate().find(|(_, (found, whole))| found != whole), None);
        claims.chunks.retain(|chunk| chunk.points < 7_001);
        let mut last = vec![0; 60_000 % 7_001 * LAYERED_BYTES];
        read(&claims, true, &mut last);
        assert!(whole.ends_with(&last));
        // Not all layers are needed for places.
        read(&claims, false, &mut last);
        assert!(!whole.ends_with(&last));
        let places = last.chunks(LAYERED_BYTES).zip(whole.chunks(LAYERED_BYTES).skip(8 * 7_001));
        places.for_each(|(found, whole)| assert_eq!(found[..17], whole[..17]));
    }
}
