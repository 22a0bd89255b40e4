//! Pixels compressed as other standards have it.

use super::{Slice, open, slice};
use crate::common::told::Told;

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
