//! Decompresses the points of a LAZ file to the records of a LAS file.

use std::io::{self, Read, Seek, SeekFrom};

use laz::laszip::ChunkTable;
use laz::record::{RecordDecompressor, SequentialPointRecordDecompressor};
use laz::{DecompressionSelection, LasZipDecompressor, LasZipError, LazItemType, LazVlr};

use super::claims::{LAYERED, POINTWISE};
use super::times::GpsTimes;

/// Decompresses records, one after another.
pub(in crate::read) struct Records<R: Read + Seek + Send + Sync + 'static>(Kind<R>);

enum Kind<R: Read + Seek + Send + Sync + 'static> {
    /// Formats 0 to 5: in one stream or in chunks.
    Sequential {
        description: LazVlr,
        decompressor: SequentialPointRecordDecompressor<'static, R>,
        /// The numbers of points in the remaining chunks.
        chunks: Box<dyn Iterator<Item = u64> + Send>,
        /// The number of points left in this chunk.
        left: u64,
    },
    /// Formats 6 to 10: in layers. Fields that are not needed stay 0, including GPS times.
    Layered(LasZipDecompressor<'static, R>),
}

impl<R: Read + Seek + Send + Sync + 'static> Records<R> {
    /// Decompresses the points that begin at byte `data`, with the compressor that the file names: of layers those of coordinates,
    /// intensities, classes and flags, or, with `whole`, all but the times.
    ///
    /// # Errors
    /// Errors of the stream, or of the record that describes the compression.
    pub(in crate::read) fn new(
        mut stream: R,
        data: u64,
        compressor: u16,
        description: LazVlr,
        whole: bool,
    ) -> Result<Self, LasZipError> {
        stream.seek(SeekFrom::Start(data))?;
        if compressor == LAYERED {
            let selection = if whole {
                DecompressionSelection::all().skip_gps_time().skip_wavepacket()
            } else {
                DecompressionSelection::base()
                    .decompress_z()
                    .decompress_intensity()
                    .decompress_classification()
                    .decompress_flags()
            };
            let decompressor = LasZipDecompressor::selective(stream, description, selection)?;
            return Ok(Self(Kind::Layered(decompressor)));
        }
        let chunks: Box<dyn Iterator<Item = u64> + Send> = if compressor == POINTWISE {
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
        Ok(Self(Kind::Sequential { description, decompressor, chunks, left: 0 }))
    }

    /// Fills `records` with the next whole records.
    ///
    /// # Errors
    /// Errors of the stream; `UnexpectedEof` behind the last chunk; `InvalidData` for data that no writer creates.
    pub(in crate::read) fn fill(&mut self, records: &mut [u8]) -> io::Result<()> {
        match &mut self.0 {
            Kind::Layered(decompressor) => decompressor.decompress_many(records),
            Kind::Sequential { description, decompressor, chunks, left } => {
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

/// Begins a chunk. Each chunk has its own models, and its first point is not compressed.
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
            decompressor
                .set_fields_from(&vec![*item])
                .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
        }
    }
    Ok(())
}

fn damaged(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use laz::{LasZipCompressor, LazItemRecordBuilder, LazItemType, LazVlrBuilder};

    use super::super::claims::CHUNKED;
    use super::*;

    /// The size in bytes of a point of format 1.
    const BYTES: usize = 28;

    /// Records whose times use all ways of storing them: equal times, steps that are similar, dissimilar, multiples and reversed,
    /// several sequences that alternate, and times far from all of them.
    fn records(count: usize) -> Vec<u8> {
        let mut random = 0x2545_f491_4f6c_dd1d_u64;
        let mut next = move |bound: u64| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            random % bound
        };
        let mut times = [4.1e5_f64, 4.2e5, 4.3e5, 4.4e5, 9.9e8];
        let (mut way, mut of) = (0, 0);
        let mut records = vec![0; count * BYTES];
        for (k, record) in records.chunks_exact_mut(BYTES).enumerate() {
            if k % 97 == 0 {
                (way, of) = (next(7), next(5) as usize);
            }
            let step = match way {
                0 => 0.0,
                1 => 1e-6,
                2 => 1e-6 * next(600) as f64,
                3 => -1e-6 * next(12) as f64,
                4 => next(1 << 40) as f64,
                5 => f64::from_bits(times[of].to_bits() + next(20)) - times[of],
                _ => {
                    of = next(5) as usize;
                    1e-6
                }
            };
            times[of] += step;
            record[0] = next(256) as u8;
            record[12] = next(4) as u8;
            record[20..].copy_from_slice(&times[of].to_le_bytes());
        }
        records
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
            let description = if variable {
                builder.with_variable_chunk_size().build()
            } else {
                builder.with_fixed_chunk_size(7_001).build()
            };
            let mut packed = Cursor::new(vec![0; 9]);
            packed.set_position(9);
            let mut compressor = LasZipCompressor::new(packed, description.clone()).unwrap();
            compressor.reserve_offset_to_chunk_table().unwrap();
            for (k, record) in whole.chunks_exact(BYTES).enumerate() {
                if variable && [5, 6, 80_000].contains(&k) {
                    compressor.finish_current_chunk().unwrap();
                }
                compressor.compress_one(record).unwrap();
            }
            compressor.done().unwrap();
            let mut packed = compressor.into_inner();
            packed.set_position(0);
            let mut read = Records::new(packed, 9, CHUNKED, description, false).unwrap();
            let mut found = vec![0; whole.len()];
            let (begin, rest) = found.split_at_mut(BYTES * 777);
            read.fill(begin).unwrap();
            read.fill(rest).unwrap();
            assert!(found == whole, "variable: {variable}");
            if variable {
                assert!(read.fill(&mut [0; BYTES]).is_err());
            }
        }
    }
}
