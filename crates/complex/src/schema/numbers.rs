//! The elements of an NPY array as doubles.

use std::io::Read;

use walpha_base::npy::Header;

use super::SchemaError;

/// Bytes decoded at a time, so that the array and its numbers are never both completely in memory.
const CHUNK_BYTES: usize = 8 << 20;

/// All elements of an array in the order of the file. The reader is positioned after the header;
/// `bytes` more follow, which must be exactly as many as the header claims.
pub(super) fn read(
    name: &'static str,
    header: &Header,
    reader: &mut impl Read,
    bytes: u64,
) -> Result<Vec<f64>, SchemaError> {
    let wrong = |got: String, expected: String| SchemaError::Array { name, got, expected };
    let Some((size, decode)) = element(&header.descr) else {
        let got = format!("elements of type {}", header.descr);
        let expected = "bool, an integer of 8 to 64 bits, f4 or f8; save a.astype('f8')";
        return Err(wrong(got, expected.into()));
    };
    let count = header.shape.iter().fold(1u64, |product, &n| product.saturating_mul(n));
    let needed = count.saturating_mul(size as u64);
    let claim = || format!("{needed} for shape {:?} of type {}", header.shape, header.descr);
    if bytes != needed {
        return Err(wrong(format!("{bytes} bytes of elements"), claim()));
    }
    let mut numbers = Vec::<f64>::new();
    numbers.try_reserve_exact(usize::try_from(count).unwrap_or(usize::MAX)).map_err(|_| {
        let bytes = u128::from(count) * size_of::<f64>() as u128;
        SchemaError::Memory { name, bytes }
    })?;
    let damaged = |error| SchemaError::Zip(format!("{name}: {error}"));
    let mut chunk = vec![0; needed.min(CHUNK_BYTES as u64) as usize];
    let mut left = needed;
    while left > 0 {
        let chunk = &mut chunk[..left.min(CHUNK_BYTES as u64) as usize];
        reader.read_exact(chunk).map_err(damaged)?;
        numbers.extend(chunk.chunks_exact(size).map(decode));
        left -= chunk.len() as u64;
    }
    // The archive verifies its checksum when a member is read to its end.
    match reader.read(&mut [0]).map_err(damaged)? {
        0 => Ok(numbers),
        _ => Err(wrong("more bytes than its archive claims".into(), claim())),
    }
}

/// Converts the bytes of one element to a double.
type Decode = fn(&[u8]) -> f64;

/// The size of an element in bytes and its conversion to a double, for a `NumPy` type such as `<f4`.
/// Integers beyond 2⁵³ are rounded; no point number is that large.
#[expect(clippy::cast_lossless, reason = "one rule for all types, of which two are lossy")]
fn element(descr: &str) -> Option<(usize, Decode)> {
    macro_rules! number {
        ($kind:ty, $from:ident) => {
            Some((size_of::<$kind>(), |bytes| {
                <$kind>::$from(bytes.try_into().expect("the bytes of one element")) as f64
            }))
        };
    }
    let (order, kind) = descr.split_at_checked(1)?;
    match (order, kind) {
        ("<" | ">" | "|", "b1" | "u1") => number!(u8, from_le_bytes),
        ("<" | ">" | "|", "i1") => number!(i8, from_le_bytes),
        ("<", "u2") => number!(u16, from_le_bytes),
        (">", "u2") => number!(u16, from_be_bytes),
        ("<", "i2") => number!(i16, from_le_bytes),
        (">", "i2") => number!(i16, from_be_bytes),
        ("<", "u4") => number!(u32, from_le_bytes),
        (">", "u4") => number!(u32, from_be_bytes),
        ("<", "i4") => number!(i32, from_le_bytes),
        (">", "i4") => number!(i32, from_be_bytes),
        ("<", "u8") => number!(u64, from_le_bytes),
        (">", "u8") => number!(u64, from_be_bytes),
        ("<", "i8") => number!(i64, from_le_bytes),
        (">", "i8") => number!(i64, from_be_bytes),
        ("<", "f4") => number!(f32, from_le_bytes),
        (">", "f4") => number!(f32, from_be_bytes),
        ("<", "f8") => number!(f64, from_le_bytes),
        (">", "f8") => number!(f64, from_be_bytes),
        _ => None,
    }
}
