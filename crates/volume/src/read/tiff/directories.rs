//! The directories of a TIFF file: what each page states, before a page is decoded.

use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use crate::error::{format_error, io_error};
use crate::read::OpenFile;
use crate::{Reason, VolumeError};

/// A page, described by its directory.
pub(super) struct Directory {
    /// The locations of its values: tag, type, count, and position.
    entries: Vec<Entry>,
}

/// A field of a directory.
struct Entry {
    tag: u16,
    /// 1 stands for bytes, 2 for text, 3 and 4 for whole numbers, 5 for pairs of them, 16 for whole numbers of 64 bits.
    kind: u16,
    count: u64,
    /// The position of its bytes in the file.
    at: u64,
}

/// The tags that are read here; the decoder reads those of pixels.
pub(super) mod tag {
    pub(crate) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(crate) const SUBFILE_TYPE: u16 = 255;
    pub(crate) const IMAGE_WIDTH: u16 = 256;
    pub(crate) const IMAGE_LENGTH: u16 = 257;
    pub(crate) const BITS_PER_SAMPLE: u16 = 258;
    pub(crate) const COMPRESSION: u16 = 259;
    pub(crate) const PHOTOMETRIC: u16 = 262;
    pub(crate) const FILL_ORDER: u16 = 266;
    pub(crate) const IMAGE_DESCRIPTION: u16 = 270;
    pub(crate) const ORIENTATION: u16 = 274;
    pub(crate) const SAMPLES_PER_PIXEL: u16 = 277;
    pub(crate) const X_RESOLUTION: u16 = 282;
    pub(crate) const Y_RESOLUTION: u16 = 283;
    pub(crate) const RESOLUTION_UNIT: u16 = 296;
    pub(crate) const PREDICTOR: u16 = 317;
    pub(crate) const TILE_WIDTH: u16 = 322;
    pub(crate) const TILE_LENGTH: u16 = 323;
    pub(crate) const SAMPLE_FORMAT: u16 = 339;
    pub(crate) const IMAGE_DEPTH: u16 = 32997;
    pub(crate) const MODEL_PIXEL_SCALE: u16 = 33550;
    pub(crate) const UIC2: u16 = 33629;
    pub(crate) const CZ_LSMINFO: u16 = 34412;
    pub(crate) const GDAL_METADATA: u16 = 42112;
    pub(crate) const GDAL_NODATA: u16 = 42113;
}

/// The tags above; all others are ignored.
const LOOKED_AT: [u16; 24] = [
    tag::NEW_SUBFILE_TYPE,
    tag::SUBFILE_TYPE,
    tag::IMAGE_WIDTH,
    tag::IMAGE_LENGTH,
    tag::BITS_PER_SAMPLE,
    tag::COMPRESSION,
    tag::PHOTOMETRIC,
    tag::FILL_ORDER,
    tag::IMAGE_DESCRIPTION,
    tag::ORIENTATION,
    tag::SAMPLES_PER_PIXEL,
    tag::X_RESOLUTION,
    tag::Y_RESOLUTION,
    tag::RESOLUTION_UNIT,
    tag::PREDICTOR,
    tag::TILE_WIDTH,
    tag::TILE_LENGTH,
    tag::SAMPLE_FORMAT,
    tag::IMAGE_DEPTH,
    tag::MODEL_PIXEL_SCALE,
    tag::UIC2,
    tag::CZ_LSMINFO,
    tag::GDAL_METADATA,
    tag::GDAL_NODATA,
];

/// The largest number of entries: tags have 16 bits.
const MOST_ENTRIES: u64 = 1 << 16;
/// The value of photometric interpretation for images in which 0 is white.
const WHITE_IS_ZERO: u64 = 0;
const BLACK_IS_ZERO: u64 = 1;

/// The directories of a file, one for each page, and the file from which their values are read.
pub(super) struct Directories<'a> {
    path: &'a Path,
    pub(super) file: &'a OpenFile,
    big_endian: bool,
    pub(super) pages: Vec<Directory>,
}

impl<'a> Directories<'a> {
    /// Follows the chain of directories. Each must begin in another place.
    pub(super) fn read(file: &'a OpenFile) -> Result<Self, VolumeError> {
        let path = file.path();
        let failed = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                format_error(path, Reason::truncated("ends inside its TIFF pages: it is truncated"))
            }
            _ => io_error(path)(error),
        };
        let mut reader = file.reader()?;
        let mut start = [0; 8];
        reader.read_exact(&mut start).map_err(failed)?;
        let big_endian = start.starts_with(b"MM");
        let number = |bytes: &[u8]| number(bytes, big_endian);
        let big = number(&start[2..4]) == 43;
        // The sizes in bytes of a count of entries, of an entry, and of a position.
        let (count_size, entry_size, place_size) = if big { (8, 20, 8) } else { (2, 12, 4) };
        let mut next = number(&start[4..]);
        if big {
            let mut place = [0; 8];
            reader.read_exact(&mut place).map_err(failed)?;
            next = number(&place);
        }
        let mut pages: Vec<Directory> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        while next != 0 {
            if !seen.insert(next) {
                let what = format!("has pages that lead back to byte {next}: it never ends");
                return Err(format_error(path, Reason::damaged(what)));
            }
            let mut read = |at: u64, size: u64| -> io::Result<Vec<u8>> {
                reader.seek(SeekFrom::Start(at))?;
                let mut bytes = Vec::new();
                (&mut reader).take(size).read_to_end(&mut bytes)?;
                if (bytes.len() as u64) < size {
                    Err(io::ErrorKind::UnexpectedEof.into())
                } else {
                    Ok(bytes)
                }
            };
            let count = number(&read(next, count_size).map_err(failed)?);
            if count > MOST_ENTRIES {
                let what = format!(
                    "claims a directory of {count} entries at byte {next}, more than a TIFF file has"
                );
                return Err(format_error(path, Reason::damaged(what)));
            }
            let size = count.saturating_mul(entry_size);
            let first = next.saturating_add(count_size);
            let bytes = read(first, size.saturating_add(place_size)).map_err(failed)?;
            let (entries, rest) = bytes.split_at(size as usize);
            let entries = entries.chunks(entry_size as usize).zip(0..).filter_map(|(entry, i)| {
                let tag = number(&entry[..2]) as u16;
                LOOKED_AT.contains(&tag).then(|| {
                    let kind = number(&entry[2..4]) as u16;
                    let (count, value) = entry[4..].split_at(place_size as usize);
                    let count = number(count);
                    let inline = count.saturating_mul(size_of_kind(kind)) <= place_size;
                    let at = first + i * entry_size + 4 + place_size;
                    Entry { tag, kind, count, at: if inline { at } else { number(value) } }
                })
            });
            pages.push(Directory { entries: entries.collect() });
            next = number(rest);
        }
        Ok(Self { path, file, big_endian, pages })
    }

    /// The bytes of a value, as far as the file contains them.
    fn bytes(&self, page: usize, tag: u16) -> Result<Option<(&Entry, Vec<u8>)>, VolumeError> {
        let entry = self.pages.get(page).and_then(|page| page.entry(tag));
        let Some(entry) = entry else { return Ok(None) };
        let mut bytes = Vec::new();
        let size = entry.count.saturating_mul(size_of_kind(entry.kind)).min(self.file.length());
        let read = self.file.reader_at(entry.at)?.take(size).read_to_end(&mut bytes);
        read.map_err(io_error(self.path))?;
        Ok(Some((entry, bytes)))
    }

    /// The first number of a value.
    pub(super) fn number(&self, page: usize, tag: u16) -> Result<Option<u64>, VolumeError> {
        let found = self.bytes(page, tag)?;
        Ok(found.and_then(|(entry, bytes)| {
            let size = size_of_kind(entry.kind) as usize;
            bytes.get(..size).map(|first| number(first, self.big_endian))
        }))
    }

    /// The number of values of a field.
    pub(super) fn count(&self, page: usize, tag: u16) -> Option<u64> {
        self.pages.get(page)?.entry(tag).map(|entry| entry.count)
    }

    /// A value that is a table of whole numbers and doubles at certain positions.
    pub(super) fn table(&self, page: usize, tag: u16) -> Result<Option<Table>, VolumeError> {
        let found = self.bytes(page, tag)?;
        Ok(found.map(|(_, bytes)| Table { bytes, big_endian: self.big_endian }))
    }

    /// A value that is a ratio of two numbers.
    pub(super) fn ratio(&self, page: usize, tag: u16) -> Result<Option<f64>, VolumeError> {
        let found = self.bytes(page, tag)?.filter(|(entry, _)| entry.kind == 5);
        Ok(found.and_then(|(_, bytes)| {
            let [n, d] =
                [bytes.get(..4)?, bytes.get(4..8)?].map(|part| number(part, self.big_endian));
            (n > 0 && d > 0).then(|| n as f64 / d as f64)
        }))
    }

    /// A text up to its first 0, in UTF-8 or else in Latin-1.
    pub(super) fn text(&self, page: usize, tag: u16) -> Result<Option<String>, VolumeError> {
        let found = self.bytes(page, tag)?;
        Ok(found.map(|(_, bytes)| {
            let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
            match std::str::from_utf8(text) {
                Ok(text) => text.to_owned(),
                Err(_) => text.iter().copied().map(char::from).collect(),
            }
        }))
    }

    /// Whether a page is a mask, or a smaller copy of another page (a thumbnail, a level of a pyramid).
    pub(super) fn is_copy(&self, page: usize) -> Result<bool, VolumeError> {
        let flags = self.number(page, tag::NEW_SUBFILE_TYPE)?.unwrap_or(0);
        let old = self.number(page, tag::SUBFILE_TYPE)?.unwrap_or(1);
        Ok(flags & 0b101 != 0 || old == 2)
    }

    /// Whether a page is a mask of transparency.
    pub(super) fn is_mask(&self, page: usize) -> Result<bool, VolumeError> {
        Ok(self.number(page, tag::NEW_SUBFILE_TYPE)?.unwrap_or(0) & 0b100 != 0)
    }

    /// Whether a page states that 0 is white.
    pub(super) fn is_white_zero(&self, page: usize) -> Result<bool, VolumeError> {
        Ok(self.number(page, tag::PHOTOMETRIC)? == Some(WHITE_IS_ZERO))
    }

    /// The tiles of a page that are compressed by LZW. The decoder fails at some of them where it does not decode a whole tile at once, which it does
    /// by itself only where one tile is as wide as the page (tiff 0.11.3, weezl 0.1.12).
    pub(super) fn lzw_tiles(&self, page: usize) -> Result<Option<Tiles>, VolumeError> {
        const LZW: u64 = 5;
        /// Larger ones are left to the decoder, so that a tile does not take more memory than the file can hold.
        const LARGEST_TILE: u64 = 1 << 12;
        if self.number(page, tag::COMPRESSION)? != Some(LZW) {
            return Ok(None);
        }
        let mut tiles = Tiles { page: [0; 2], tile: [0; 2] };
        let tags = [(tag::IMAGE_WIDTH, tag::TILE_WIDTH), (tag::IMAGE_LENGTH, tag::TILE_LENGTH)];
        for (axis, (size, tile)) in tags.into_iter().enumerate() {
            let (Some(size), Some(tile)) = (self.number(page, size)?, self.number(page, tile)?)
            else {
                return Ok(None);
            };
            if !(1..=LARGEST_TILE).contains(&tile) {
                return Ok(None);
            }
            (tiles.page[axis], tiles.tile[axis]) = (size, tile);
        }
        Ok(Some(tiles))
    }

    /// The file for a decoder that would invert white and black, and fails at some tiles: every page states that 0 is black, and
    /// has the size of all its [tiles](Self::lzw_tiles).
    pub(super) fn as_stored(&self) -> Result<AsStored<'a>, VolumeError> {
        let mut stated = Vec::new();
        for (page, directory) in self.pages.iter().enumerate() {
            if self.is_white_zero(page)? {
                stated.push((directory.entry(tag::PHOTOMETRIC), BLACK_IS_ZERO));
            }
            if let Some(tiles) = self.lzw_tiles(page)? {
                let [width, length] = tiles.whole();
                stated.push((directory.entry(tag::IMAGE_WIDTH), width));
                stated.push((directory.entry(tag::IMAGE_LENGTH), length));
            }
        }
        let mut bytes = Vec::new();
        for (entry, number) in stated {
            let Some(entry) = entry else { continue };
            let size = size_of_kind(entry.kind);
            let places =
                (0..size).map(|k| entry.at + if self.big_endian { size - 1 - k } else { k });
            bytes.extend(places.zip(number.to_le_bytes()));
        }
        bytes.sort_unstable();
        Ok(AsStored { reader: self.file.reader()?, at: 0, bytes })
    }
}

/// The tiles of a page. Sizes are along x and y.
pub(super) struct Tiles {
    pub(super) page: [u64; 2],
    pub(super) tile: [u64; 2],
}

impl Tiles {
    /// The size of all tiles together, which may reach beyond the page.
    pub(super) fn whole(&self) -> [u64; 2] {
        [0, 1].map(|axis| {
            let size = self.page[axis];
            size.checked_next_multiple_of(self.tile[axis]).unwrap_or(size)
        })
    }
}

impl Directory {
    fn entry(&self, tag: u16) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.tag == tag)
    }
}

/// A value that contains numbers of several types.
pub(super) struct Table {
    bytes: Vec<u8>,
    big_endian: bool,
}

impl Table {
    /// A whole number of `size` bytes at a position.
    pub(super) fn number(&self, place: usize, size: usize) -> Option<u64> {
        Some(number(self.bytes.get(place..place + size)?, self.big_endian))
    }

    /// A double at a position.
    pub(super) fn double(&self, place: usize) -> Option<f64> {
        self.number(place, 8).map(f64::from_bits)
    }
}

/// The size in bytes of a value of a type; 0 for an unknown type.
fn size_of_kind(kind: u16) -> u64 {
    match kind {
        1 | 2 | 6 | 7 => 1,
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => 0,
    }
}

/// Converts up to 8 bytes to a whole number.
fn number(bytes: &[u8], big_endian: bool) -> u64 {
    let add = |sum: u64, &byte: &u8| sum << 8 | u64::from(byte);
    if big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
}

/// A file in which some bytes are read as others.
pub(super) struct AsStored<'a> {
    reader: BufReader<&'a std::fs::File>,
    at: u64,
    /// Their positions, ascending, and what is read there.
    bytes: Vec<(u64, u8)>,
}

impl Read for AsStored<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let found = self.reader.read(buffer)?;
        let Range { start, end } = self.at..self.at + found as u64;
        let first = self.bytes.partition_point(|&(place, _)| place < start);
        for &(place, byte) in self.bytes[first..].iter().take_while(|(place, _)| *place < end) {
            buffer[(place - start) as usize] = byte;
        }
        self.at = end;
        Ok(found)
    }
}

impl Seek for AsStored<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.reader.seek(to)?;
        Ok(self.at)
    }
}
