//! Pixels that are compressed as other standards have it, and files deflated as a whole.

use std::fs;
use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;

use super::{Slice, element, open, slice};
use crate::common::{Told, alone, largest};

/// 3×2 pixels 10 to 15 of 16 bits, as `OpenJPEG` 2.5 packs them without loss.
const JPEG_2000: &str = "ff4fff5100290000000000030000000200000000000000000000000300000002000000000000\
                         000000010f0101ff52000c00000001000004040001ff5c00044080ff64002500014372656174\
                         6564206279204f70656e4a5045472076657273696f6e20322e352e34ff90000a00000000001b\
                         0001ff93cffc3024089068abf8016e9f7fffd9";

fn packed(syntax: &'static str, mut pixels: Vec<u8>) -> Slice {
    pixels.resize(pixels.len().next_multiple_of(2), 0);
    let unsigned = (0x28, 0x103, b"US", vec![0, 0]);
    Slice { packed: Some((syntax, pixels)), changed: vec![unsigned], ..slice(1, 7.0) }
}

#[test]
fn jpeg_2000_is_read() {
    let pixels = (0..JPEG_2000.len() / 2)
        .map(|i| u8::from_str_radix(&JPEG_2000[2 * i..2 * i + 2], 16).unwrap())
        .collect();
    let folder = tempfile::tempdir().unwrap();
    packed("1.2.840.10008.1.2.4.90", pixels).save(folder.path(), "a.dcm");
    let volume = open(&folder.path().join("a.dcm")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(volume.as_slice(), [10.0, 11.0, 12.0, 13.0, 14.0, 15.0]);
}

#[test]
fn what_is_not_read_is_called_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    for (syntax, name) in [
        ("1.2.840.10008.1.2.4.80", "JPEG-LS Lossless"),
        ("1.2.840.10008.1.2.4.81", "JPEG-LS Lossy"),
        ("1.2.840.10008.1.2.4.100", "MPEG2"),
    ] {
        packed(syntax, vec![1, 2, 3, 4]).save(folder.path(), "a.dcm");
        let error = open(&folder.path().join("a.dcm")).unwrap_err().told();
        assert!(error.contains(name) && error.contains(syntax), "{error}");
        assert!(error.contains("gdcmconv"), "{error}");
    }
}

/// A slice without its pixels, from the header of a file on.
fn header() -> Vec<u8> {
    let bytes = slice(1, 0.0).bytes();
    let mark = element(8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.2");
    let start = bytes.windows(mark.len()).position(|part| part == mark).unwrap();
    let pixels = bytes.windows(4).rposition(|part| part == b"\xe0\x7f\x10\x00").unwrap();
    bytes[start..pixels].to_vec()
}

/// A file of what is written.
fn deflated(write: impl FnOnce(&mut dyn Write)) -> Vec<u8> {
    let meta = [
        element(2, 1, b"OB", &[0, 1]),
        element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2"),
        element(2, 3, b"UI", b"1.2.3.4"),
        element(2, 0x10, b"UI", b"1.2.840.10008.1.2.1.99"),
        element(2, 0x12, b"UI", b"1.2.3.5"),
    ]
    .concat();
    let length = element(2, 0, b"UL", &(meta.len() as u32).to_le_bytes());
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    write(&mut encoder);
    [&[0; 128][..], b"DICM", &length, &meta, &encoder.finish().unwrap()].concat()
}

/// The header of an element of this number of bytes.
fn long(group: u16, number: u16, kind: &[u8], bytes: u32) -> Vec<u8> {
    let mut header = element(group, number, kind, b"");
    header.truncate(8);
    header.extend(bytes.to_le_bytes());
    header
}

fn zeros(out: &mut dyn Write, megabytes: u32) {
    let megabyte = vec![0; 1 << 20];
    (0..megabytes).for_each(|_| out.write_all(&megabyte).unwrap());
}

/// Files of 300 kB that unpack to 300 MB, of which no more is taken than a header needs.
#[test]
fn what_a_small_file_unpacks_to_is_bounded() {
    alone(|| {
        const MEGABYTES: u32 = 300;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.dcm");
        let header = header();
        let pixels = element(0x7fe0, 0x10, b"OW", &[1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0]);

        fs::write(&path, deflated(|out| out.write_all(&[&header[..], &pixels].concat()).unwrap()))
            .unwrap();
        assert_eq!(open(&path).unwrap().as_slice(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);

        // An unknown element in front of the header.
        let bytes = deflated(|out| {
            out.write_all(&long(7, 0x1001, b"OB", MEGABYTES << 20)).unwrap();
            zeros(out, MEGABYTES);
            out.write_all(&[&header[..], &pixels].concat()).unwrap();
        });
        assert!(bytes.len() < 2 << 20);
        fs::write(&path, bytes).unwrap();
        let error = open(&path).unwrap_err().told();
        assert!(error.contains("claims an element of 314572800 bytes"), "{error}");

        // Far more pixels than the header says.
        fs::write(
            &path,
            deflated(|out| {
                out.write_all(&header).unwrap();
                out.write_all(&long(0x7fe0, 0x10, b"OW", MEGABYTES << 20)).unwrap();
                zeros(out, MEGABYTES);
            }),
        )
        .unwrap();
        let error = open(&path).unwrap_err().told();
        assert!(
            error.contains("claims 1 × 3×2 pixels, which are 12 bytes, and 314572800"),
            "{error}"
        );

        // Many elements, each of which may be.
        fs::write(
            &path,
            deflated(|out| {
                for number in 0..30 {
                    out.write_all(&long(7, 0x1001 + number, b"OB", 10 << 20)).unwrap();
                    zeros(out, 10);
                }
                out.write_all(&[&header[..], &pixels].concat()).unwrap();
            }),
        )
        .unwrap();
        let error = open(&path).unwrap_err().told();
        assert!(error.contains("claims an element of 10485760 bytes"), "{error}");

        let largest = largest();
        assert!(largest < 80 << 20, "{largest} bytes at once");
    });
}
