//! Stores doubles bit for bit, as byte planes: the first bytes of all, then the second ones, and so on, deflated.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

/// Packs numbers.
pub(super) fn pack(numbers: &[f64]) -> std::io::Result<Vec<u8>> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::best());
    for byte in 0..8 {
        let plane: Vec<u8> = numbers.iter().map(|number| number.to_le_bytes()[byte]).collect();
        out.write_all(&plane)?;
    }
    out.finish()
}

/// Unpacks `count` numbers; `None` if the bytes contain fewer or more.
pub(super) fn unpack(bytes: &[u8], count: usize) -> Option<Vec<f64>> {
    let mut planes = Vec::new();
    let length = count.checked_mul(8)?;
    ZlibDecoder::new(bytes).take(length as u64 + 1).read_to_end(&mut planes).ok()?;
    if planes.len() != length {
        return None;
    }
    let number =
        |k: usize| f64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|b| planes[b * count + k]));
    Some((0..count).map(number).collect())
}
