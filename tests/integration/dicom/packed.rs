//! Files that are deflated as a whole, and what they claim.

use std::fs;
use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;

use super::{element, open, slice};
use crate::common::alone::alone;
use crate::common::largest::largest;
use crate::common::told::Told;

/// A slice without its pixels, from the header of a file on.
fn header() -> Vec<u8> {
    let bytes = slice(1, 0.0).bytes();
    let mark = element(8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.2");
    let start = bytes.windows(mark.len()).position(|part| part == mark).unwrap();
    let pixels = bytes.windows(4).rposition(|part| part == b"\xe0\x7f\x10\x00").unwrap();
    bytes[start..pixels].to_vec()
}

/// A file of what is written.
fn packed(write: impl FnOnce(&mut dyn Write)) -> Vec<u8> {
    let meta = [
        element(2, 1, b"OB", &[0, 1]),
        element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2"),
        element(2, 3, b"UI", b"1.2.3.4"),
        element(2, 0x10, b"UI", b"1.2.840.10008.1.2.1.99"),
        element(2, 0x12, b"UI", b"1.2.3.5"),
    ]
    .concat();
    let length = element(2, 0, b"UL", &(meta.len() as u32).to_le_bytes());
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    write(&mut encoder);
    [&[0; 128][..], b"DICM", &length, &meta, &encoder.finish().unwrap()].concat()
}

/// The header of an element of so many bytes.
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

        fs::write(&path, packed(|out| out.write_all(&[&header[..], &pixels].concat()).unwrap()))
            .unwrap();
        assert_eq!(open(&path).unwrap().as_slice(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);

        // An element of nobody in front of the header.
        let bytes = packed(|out| {
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
            packed(|out| {
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
            packed(|out| {
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
