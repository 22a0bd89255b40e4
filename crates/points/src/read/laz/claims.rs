//! Checks the claims of a LAZ file about its compression before it is decompressed: the decompression library trusts items that
//! do not add up to a record, and allocates as much as a table of chunks or the layers of a chunk claim.
//!
//! Source: `LASzip`'s `laszip.hpp` and the LAZ specification (Isenburg, "`LASzip`: lossless compression of `LiDAR` data", 2013).

use std::io::{self, Read, Seek, SeekFrom};

use crate::read::las::count;
use walpha_volume::Reason;

/// The record that describes the compression: its user and number, and the number of its bytes before the items.
const RECORD: (&[u8], u16) = (b"laszip encoded", 22204);
const BEFORE_ITEMS: usize = 34;
/// The size in bytes of a record's header.
const RECORD_HEADER: u64 = 54;
/// The compressors: all points in one stream, in chunks, or in chunks of layers, with one layer for each kind of field.
pub(super) const POINTWISE: u16 = 1;
pub(super) const CHUNKED: u16 = 2;
pub(super) const LAYERED: u16 = 3;
/// The types of items, with their sizes in bytes.
const BYTES: u16 = 0;
const BYTES_14: u16 = 14;
const POINT_10: (u16, u16) = (6, 20);
const GPS_TIME: (u16, u16) = (7, 8);
const RGB_12: (u16, u16) = (8, 6);
const WAVE_13: (u16, u16) = (9, 29);
const POINT_14: (u16, u16) = (10, 30);
const RGB_14: (u16, u16) = (11, 6);
const RGB_NIR_14: (u16, u16) = (12, 8);
const WAVE_14: (u16, u16) = (13, 29);

/// The items of each point format, except further bytes.
const ITEMS: [&[(u16, u16)]; 11] = [
    &[POINT_10],
    &[POINT_10, GPS_TIME],
    &[POINT_10, RGB_12],
    &[POINT_10, GPS_TIME, RGB_12],
    &[POINT_10, GPS_TIME, WAVE_13],
    &[POINT_10, GPS_TIME, RGB_12, WAVE_13],
    &[POINT_14],
    &[POINT_14, RGB_14],
    &[POINT_14, RGB_NIR_14],
    &[POINT_14, WAVE_14],
    &[POINT_14, RGB_NIR_14, WAVE_14],
];

/// The claims that are checked against the file.
pub(in crate::read) struct Claims {
    /// The compressor, and the type and size in bytes of each item.
    pub(in crate::read) compressor: u16,
    pub(super) items: Vec<(u16, u16)>,
    /// The size of a point in bytes.
    pub(super) record: u64,
    /// The number of points.
    pub(super) points: u64,
    /// The position of the points.
    pub(in crate::read) data: u64,
    /// The size of the file in bytes.
    pub(in crate::read) length: u64,
    /// The chunks of layers, once they have been checked.
    pub(in crate::read) chunks: Vec<Chunk>,
}

/// A chunk of points.
#[derive(Clone, Copy)]
pub(in crate::read) struct Chunk {
    /// Its position in the file.
    pub start: u64,
    /// The position of its end.
    pub end: u64,
    /// The number of its points.
    pub points: u64,
}

impl Claims {
    /// Reads the claims; `None` if the points are not compressed. The inner error says which claim is impossible.
    ///
    /// # Errors
    /// Errors of the file system, including an early end of the file.
    pub(in crate::read) fn of(
        reader: &mut (impl Read + Seek),
        header: &las::raw::Header,
        length: u64,
    ) -> io::Result<Option<Result<Self, Reason>>> {
        const COMPRESSED: u8 = 0x80;
        let format = header.point_data_record_format;
        if format & COMPRESSED == 0 {
            return Ok(None);
        }
        let mut at = u64::from(header.header_size);
        let data = u64::from(header.offset_to_point_data);
        for _ in 0..header.number_of_variable_length_records {
            // Records end where points begin.
            if at + RECORD_HEADER > data {
                break;
            }
            reader.seek(SeekFrom::Start(at))?;
            let record: [u8; RECORD_HEADER as usize] = array(reader)?;
            let number = |from: usize| u16::from_le_bytes([record[from], record[from + 1]]);
            let bytes = usize::from(number(20));
            let user = record[2..18].split(|&byte| byte == 0).next().unwrap_or_default();
            if (user, number(18)) != RECORD {
                at += RECORD_HEADER + bytes as u64;
                continue;
            }
            let mut bytes = vec![0; bytes];
            reader.read_exact(&mut bytes)?;
            let record = header.point_data_record_length.into();
            // The two highest bits belong to the compression.
            let format = format & 0x3f;
            let compression = items(&bytes, format, record)
                .and_then(|items| Ok((compressor(&bytes, format)?, items)));
            return Ok(Some(compression.map(|(compressor, items)| Self {
                compressor,
                items,
                record,
                points: count(header),
                data,
                length,
                chunks: Vec::new(),
            })));
        }
        Ok(Some(Err(Reason::header("is compressed, and has no record that says how"))))
    }

    /// Compares the claims with the content of the file. The inner error says which claim is impossible.
    ///
    /// # Errors
    /// Errors of the file system, including an early end of the file.
    pub(in crate::read) fn check(
        &mut self,
        reader: &mut (impl Read + Seek),
    ) -> io::Result<Result<(), Reason>> {
        match self.compressor {
            POINTWISE => Ok(Ok(())),
            CHUNKED => self.check_table(reader),
            _ => Ok(match self.check_table(reader)? {
                Ok(()) => self.check_layers(reader)?,
                refused => refused,
            }),
        }
    }

    /// The position of the table of chunks, if there is one.
    pub(super) fn table(&self, reader: &mut (impl Read + Seek)) -> io::Result<Option<u64>> {
        reader.seek(SeekFrom::Start(self.data))?;
        let mut table = i64::from_le_bytes(array(reader)?);
        // If the writer could not seek, the position is at the end of the file.
        if table <= self.data.cast_signed() {
            reader.seek(SeekFrom::End(-8))?;
            table = i64::from_le_bytes(array(reader)?);
        }
        Ok(u64::try_from(table).ok().filter(|&table| table > self.data))
    }

    /// Checks the table of chunks. A chunk begins with an uncompressed point, so there are at most as many chunks as points fit
    /// into the file. If there is no table, the library works without one or refuses the file.
    fn check_table(&self, reader: &mut (impl Read + Seek)) -> io::Result<Result<(), Reason>> {
        let Some(table) = self.table(reader)? else { return Ok(Ok(())) };
        if table.saturating_add(8) > self.length {
            return Ok(Err(Reason::claims_more(format!(
                "has its table of chunks at byte {table}, behind its {} bytes",
                self.length
            ))));
        }
        reader.seek(SeekFrom::Start(table + 4))?;
        let chunks = u64::from(u32::from_le_bytes(array(reader)?));
        let most = (table - self.data) / self.record.max(1);
        if chunks > most {
            return Ok(Err(Reason::damaged(format!(
                "claims {chunks} chunks of points, but has room for {most} at most"
            ))));
        }
        Ok(Ok(()))
    }

    /// Checks the chunks of layers. Such a chunk is an uncompressed point, the number of points, the size of each layer, and the
    /// layers. Keeps where they are.
    fn check_layers(&mut self, reader: &mut (impl Read + Seek)) -> io::Result<Result<(), Reason>> {
        let layers_of = |&(item, bytes): &(u16, u16)| match (item, bytes) {
            POINT_14 => 9,
            RGB_NIR_14 => 2,
            (BYTES_14, bytes) => u64::from(bytes),
            _ => 1,
        };
        let layers: u64 = self.items.iter().map(layers_of).sum();
        let (mut at, mut points) = (self.data + 8, 0);
        while points < self.points {
            let start = at;
            reader.seek(SeekFrom::Start(at + self.record))?;
            let count = u32::from_le_bytes(array(reader)?);
            let mut bytes = 0;
            for _ in 0..layers {
                bytes += u64::from(u32::from_le_bytes(array(reader)?));
            }
            at += self.record + 4 + 4 * layers + bytes;
            if count == 0 || at > self.length {
                return Ok(Err(Reason::claims_more(format!(
                    "has a chunk ({}) of {count} points in {bytes} bytes, which are not there",
                    self.chunks.len()
                ))));
            }
            let count = u64::from(count).min(self.points - points);
            self.chunks.push(Chunk { start, end: at, points: count });
            points += count;
        }
        Ok(Ok(()))
    }
}

/// The items that a record describes, if they are those of a point format with `record` bytes.
fn items(bytes: &[u8], format: u8, record: u64) -> Result<Vec<(u16, u16)>, Reason> {
    let number = |from: usize| u16::from_le_bytes([bytes[from], bytes[from + 1]]);
    let Some(listed) = bytes.get(BEFORE_ITEMS..) else {
        return Err(Reason::header("has too short a record of its compression"));
    };
    let count = usize::from(number(BEFORE_ITEMS - 2));
    if listed.len() != 6 * count {
        return Err(Reason::header(format!(
            "lists {count} items of a point in {} bytes",
            listed.len()
        )));
    }
    let found: Vec<(u16, u16)> = (0..count)
        .map(|k| (number(BEFORE_ITEMS + 6 * k), number(BEFORE_ITEMS + 6 * k + 2)))
        .collect();
    let Some(&expected) = ITEMS.get(usize::from(format)) else {
        return Err(Reason::header(format!("has points of format {format}: 0 to 10 are known")));
    };
    let (own, more) = found.split_at_checked(expected.len()).unwrap_or((&found, &[]));
    let further = if format < 6 { BYTES } else { BYTES_14 };
    let fits = own == expected
        && match more {
            [] => true,
            [(item, bytes)] => *item == further && *bytes > 0,
            _ => false,
        };
    let sum: u64 = found.iter().map(|&(_, bytes)| u64::from(bytes)).sum();
    if !fits || sum != record {
        return Err(Reason::header(format!(
            "is compressed by items that do not make a point of format {format} and {record} bytes"
        )));
    }
    Ok(found)
}

/// The compressor of points of a format: those formats that LAS 1.4 introduced are compressed in layers, and no others. The
/// library goes by the items, and would read layers that this does not announce.
fn compressor(bytes: &[u8], format: u8) -> Result<u16, Reason> {
    let compressor = u16::from_le_bytes([bytes[0], bytes[1]]);
    match compressor {
        LAYERED if format >= 6 => Ok(compressor),
        POINTWISE | CHUNKED if format < 6 => Ok(compressor),
        _ => Err(Reason::header(format!(
            "is compressed in a way ({compressor}) that is not one of points of format {format}"
        ))),
    }
}

fn array<const N: usize>(reader: &mut impl Read) -> io::Result<[u8; N]> {
    let mut array = [0; N];
    reader.read_exact(&mut array)?;
    Ok(array)
}
