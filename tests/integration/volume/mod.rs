//! Volume files of each kind and damage, written here byte by byte.

mod inrimage;
mod npy;
mod raw;

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::{Compression, write::GzEncoder};
use ndarray::{Array3, ShapeBuilder};
use ndarray_npy::{WritableElement, WriteNpyExt};
use walpha::volume::*;

use crate::common::told::Told;

/// A folder that is gone after the test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Reads bytes under this name; the message of the error must name the file and these parts.
    fn refuses(&self, name: &str, bytes: &[u8], options: &ReadOptions, parts: &[&str]) {
        let text = read(&self.file(name, bytes), options).unwrap_err().told();
        for part in parts.iter().chain(&[name]) {
            assert!(text.contains(part), "{part:?} is missing in: {text}");
        }
    }
}

fn known() -> ReadOptions {
    ReadOptions::default()
}

fn raw(dims: [u64; 3], dtype: Dtype, endian: Endian, offset: u64) -> ReadOptions {
    let dims = Dims::new(dims[0], dims[1], dims[2]).unwrap();
    ReadOptions::default().raw(RawLayout::new(dims, dtype).endian(endian).offset(offset))
}

/// The numbers −3, 0, 100 or, without sign, 3, 0, 100, as a file stores them, and as samples.
fn three(dtype: Dtype, endian: Endian) -> (Vec<u8>, [f32; 3]) {
    macro_rules! bytes {
        ($type:ty, $first:expr) => {
            [$first as $type, 0 as $type, 100 as $type].iter().flat_map(|v| match endian {
                Endian::Little => v.to_le_bytes().to_vec(),
                Endian::Big => v.to_be_bytes().to_vec(),
            })
        };
    }
    let (below, above) = ([-3.0, 0.0, 100.0], [3.0, 0.0, 100.0]);
    match dtype {
        Dtype::U8 => (bytes!(u8, 3).collect(), above),
        Dtype::I8 => (bytes!(i8, -3).collect(), below),
        Dtype::U16 => (bytes!(u16, 3).collect(), above),
        Dtype::I16 => (bytes!(i16, -3).collect(), below),
        Dtype::U32 => (bytes!(u32, 3).collect(), above),
        Dtype::I32 => (bytes!(i32, -3).collect(), below),
        Dtype::U64 => (bytes!(u64, 3).collect(), above),
        Dtype::I64 => (bytes!(i64, -3).collect(), below),
        Dtype::F32 => (bytes!(f32, -3).collect(), below),
        Dtype::F64 => (bytes!(f64, -3).collect(), below),
        other => panic!("{other:?} is not tested"),
    }
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn inr(lines: &str, payload: &[u8]) -> Vec<u8> {
    let mut bytes = format!("#INRIMAGE-4#{{\n{lines}\n").into_bytes();
    bytes.resize((bytes.len() + 4).next_multiple_of(256) - 4, b'\n');
    bytes.extend(b"##}\n");
    bytes.extend(payload);
    bytes
}

/// An NPY file of version 1 with this header and payload.
fn npy_of(header: &str, payload: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(payload);
    bytes
}

#[test]
fn sizes_are_checked_when_they_are_read() {
    let dims: Dims = serde_json::from_str(r#"{"x":2,"y":3,"z":4}"#).unwrap();
    assert_eq!((dims.samples(), serde_json::to_value(dims).unwrap()["z"].as_u64()), (24, Some(4)));
    for sizes in [r#"{"x":0,"y":3,"z":4}"#, r#"{"x":65536,"y":65536,"z":1}"#] {
        assert!(serde_json::from_str::<Dims>(sizes).is_err(), "{sizes}");
    }
}

/// None of these may allocate what it claims: 2³¹ per axis, and 4 GB in a few bytes.
#[test]
fn headers_that_claim_too_much_are_refused() {
    let folder = Folder::new();
    let side = 1u64 << 31;
    let header = |x: u64, y: u64, z: u64| {
        let rest = "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=pc";
        inr(&format!("XDIM={x}\nYDIM={y}\nZDIM={z}\n{rest}"), b"abc")
    };
    folder.refuses("v.inr", &header(side, side, side), &known(), &["2147483648×", "too many"]);
    folder.refuses(
        "v.inr",
        &header(1600, 1600, 1600),
        &known(),
        &["4096000000 bytes", "but 3 follow"],
    );
    let packed = gzip(&header(1600, 1600, 1600));
    folder.refuses("v.inr.gz", &packed, &known(), &["4096000000 bytes", "at most"]);
    let shape =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({side}, {side}, {side}), }}");
    folder.refuses("v.npy", &npy_of(&shape, b""), &known(), &["2147483648×", "too many"]);
    let shape = "{'descr': '<f8', 'fortran_order': False, 'shape': (1600, 1600, 1600), }";
    folder.refuses(
        "v.npy",
        &npy_of(shape, b"abc"),
        &known(),
        &["32768000000 bytes", "but 3 follow"],
    );
}

#[test]
fn damaged_gzip_streams_are_refused() {
    let folder = Folder::new();
    let samples: Vec<u8> = (0..30_000u32).map(|i| ((i * i) >> 3) as u8).collect();
    let header = "XDIM=300\nYDIM=100\nZDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=pc";
    let whole = gzip(&inr(header, &samples));
    let refuses = |bytes: &[u8], parts: &[&str]| folder.refuses("v.inr.gz", bytes, &known(), parts);
    refuses(&whole[..whole.len() / 2], &["gzip", "truncated"]);
    refuses(&whole[..20], &["v.inr.gz"]);
    refuses(&gzip(&inr(header, &samples[..29_999])), &["30000 bytes", "but 29999", "truncated"]);
    refuses(&gzip(&inr(header, &[&samples[..], b"x"].concat())), &["at least 30001", "too long"]);
    refuses(&gzip(b"something else"), &["not an INRIMAGE"]);
    refuses(b"not gzip at all", &["not compressed with gzip"]);
    let mut flipped = whole.clone();
    let last = flipped.len() - 6;
    flipped[last] ^= 0xff;
    refuses(&flipped, &["(gzip, zlib, bzip2, LZ4 or base64) are damaged"]);
}

#[test]
fn unknown_and_missing_files_say_what_to_do() {
    let folder = Folder::new();
    folder.refuses("v.raw", &[1, 2, 3], &known(), &["`dims`", ".inr", ".npy"]);
    folder.refuses("v.dat", b"something", &known(), &["no format known"]);
    let text = read(Path::new("no/such.raw"), &known()).unwrap_err().told();
    assert!(text.contains("no/such.raw") && text.contains("sample:phantom"), "{text}");
    let text = read(folder.0.path(), &known()).unwrap_err().told();
    assert!(text.contains("name a file in it"), "{text}");
}

#[test]
fn gray_levels_are_the_samples_of_bytes_and_a_range_of_others() {
    let folder = Folder::new();
    let path = folder.file("v.raw", &[10, 20, 30]);
    let bytes = read(&path, &raw([3, 1, 1], Dtype::U8, Endian::Little, 0)).unwrap();
    let signed = read(&path, &raw([3, 1, 1], Dtype::I8, Endian::Little, 0)).unwrap();
    assert_eq!(bytes.clone().into_gray(Gray::Automatic).unwrap().0.as_slice(), [10.0, 20.0, 30.0]);
    assert_eq!(signed.into_gray(Gray::Automatic).unwrap().0.as_slice(), [0.0, 127.5, 255.0]);
    let range = |low, high| bytes.clone().into_gray(Gray::Range(GrayRange { low, high }));
    assert_eq!(range(10.0, 20.0).unwrap().0.as_slice(), [0.0, 255.0, 510.0]);
    assert!(range(5.0, 5.0).is_err() && range(f64::NAN, 5.0).is_err());
    assert!(range(0.0, 1e-300).is_err(), "30 of 10⁻³⁰⁰ passes every float");
}
