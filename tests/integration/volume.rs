//! Volume files of each kind and damage, written here byte by byte: INRIMAGE, NPY, raw samples.

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use ndarray::{Array3, ShapeBuilder};
use ndarray_npy::{WritableElement, WriteNpyExt};
use walpha::volume::*;

use crate::common::Told;

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
        let text = read(self.file(name, bytes), options).unwrap_err().told();
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

/// No file may allocate what it claims: 2³¹ per axis, and 4 GB in a few bytes.
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
    folder.refuses("v.dat", b"something", &known(), &["not in a format"]);
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

#[test]
fn inrimages_of_every_type_and_order() {
    let folder = Folder::new();
    for dtype in Dtype::ALL {
        for (endian, cpu) in [
            (Endian::Little, "decm"),
            (Endian::Little, "alpha"),
            (Endian::Little, "pc"),
            (Endian::Big, "sun"),
            (Endian::Big, "sgi"),
        ] {
            let (payload, expected) = three(dtype, endian);
            let kind = match dtype.name().as_bytes()[0] {
                b'f' => "float",
                b'u' => "unsigned fixed",
                _ => "signed fixed",
            };
            let bits = 8 * dtype.size();
            let header = format!(
                "XDIM=1\nYDIM=3\nZDIM=1\nVDIM=1\nTYPE={kind}\nPIXSIZE={bits} bits\nSCALE=2**0\n\
                 CPU={cpu}\nVX=0.5\nVY=2\nVZ=3.25\nTX=-1\n# a remark"
            );
            let bytes = inr(&header, &payload);
            for (name, bytes) in
                [("v.inr", bytes.clone()), ("v.inr.gz", gzip(&bytes)), ("v", bytes)]
            {
                let volume = read(folder.file(name, &bytes), &known()).unwrap();
                assert_eq!(volume.as_slice(), expected, "{dtype} {cpu} {name}");
                assert_eq!(volume.dims().xyz(), [1, 3, 1]);
                assert_eq!(volume.frame().spacing, [0.5, 2.0, 3.25]);
                assert_eq!(volume.frame().origin, [-1.0, 0.0, 0.0]);
                assert_eq!(volume.has_gray_levels(), dtype == Dtype::U8);
            }
        }
    }
}

#[test]
fn long_inrimage_headers_are_read() {
    let header = format!(
        "XDIM=1\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=pc\n#{}",
        "-".repeat(700)
    );
    let bytes = inr(&header, &2.5f32.to_le_bytes());
    assert_eq!(bytes.len(), 4 * 256 + 4, "four blocks");
    let volume = read(Folder::new().file("v.inr", &bytes), &known());
    assert_eq!(volume.unwrap().as_slice(), [2.5]);
}

/// Some writers pad to other lengths than multiples of 256, or not at all; CGAL reads them, too.
#[test]
fn inrimage_headers_of_any_length_are_read() {
    let lines = "XDIM=1\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=pc\n";
    for padding in [0, 1, 100, 255, 256, 700] {
        let header = format!("#INRIMAGE-4#{{\n{lines}{}##}}\n", "\n".repeat(padding));
        let bytes = [header.as_bytes(), &2.5f32.to_le_bytes()].concat();
        let volume = read(Folder::new().file("v.inr", &bytes), &known());
        assert_eq!(volume.unwrap().as_slice(), [2.5], "{padding}");
    }
}

#[test]
fn damaged_inrimages_are_refused() {
    let folder = Folder::new();
    let refuses = |bytes: &[u8], parts: &[&str]| folder.refuses("v.inr", bytes, &known(), parts);
    let good = "XDIM=3\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    let payload = [0; 12];
    assert!(read(folder.file("v.inr", &inr(good, &payload)), &known()).is_ok());

    refuses(b"", &["is empty"]);
    refuses(b"hello", &["not an INRIMAGE"]);
    refuses(&inr(good, &payload)[..200], &["truncated"]);
    refuses(&inr(good, &payload[..11]), &["3×1×1", "12 bytes", "11", "truncated"]);
    refuses(&inr(good, &[0; 13]), &["12 bytes", "13", "too long"]);
    refuses(&inr(&good.replace("XDIM=3\n", ""), &payload), &["no XDIM"]);
    refuses(&inr(&good.replace("XDIM=3", "XDIM=0"), &payload), &["0×1×1", "empty"]);
    refuses(&inr(&good.replace("XDIM=3", "XDIM=-3"), &payload), &["XDIM=-3"]);
    refuses(&inr(&good.replace("=32 bits", "=24 bits"), &payload), &["PIXSIZE=24"]);
    refuses(&inr(&good.replace("decm", "vax"), &payload), &["CPU=vax"]);
    refuses(&inr(&good.replace("CPU=decm\n", ""), &payload), &["CPU=(missing)"]);
    refuses(&inr(&format!("{good}VDIM=3"), &payload), &["3 values a voxel"]);
    refuses(&inr(&format!("{good}RX=0.5"), &payload), &["RX"]);
    refuses(&inr(&format!("{good}VX=0"), &payload), &["VX", "positive"]);
    refuses(&inr(&format!("{good}VX=nan"), &payload), &["VX=nan"]);
    let nan = [1f32, 2.0, f32::NAN].map(f32::to_le_bytes).concat();
    refuses(&inr(good, &nan), &["[2, 0, 0]", "NaN"]);
    let endless = [inr(good, &[])[..252].to_vec(), vec![b'\n'; 20_000]].concat();
    refuses(&endless, &["no end of header"]);
}

fn npy<T: WritableElement>(array: &Array3<T>) -> Vec<u8> {
    let mut bytes = Vec::new();
    array.write_npy(&mut bytes).unwrap();
    bytes
}

#[test]
fn npy_arrays_of_every_type_and_order() {
    let folder = Folder::new();
    macro_rules! each {
        ($($type:ty),*) => {$(
            let c = Array3::from_shape_fn((2, 3, 4), |(z, y, x)| (100 * z + 10 * y + x) as $type);
            let mut fortran = Array3::zeros((2, 3, 4).f());
            fortran.assign(&c);
            for array in [c, fortran] {
                let volume = read(&folder.file("v.npy", &npy(&array)), &known()).unwrap();
                assert_eq!(volume.dims().xyz(), [4, 3, 2]);
                assert_eq!(volume.samples()[[1, 2, 3]], 123.0);
                assert_eq!(volume.as_slice()[4], 10.0);
                assert_eq!(volume.has_gray_levels(), size_of::<$type>() == 1 && <$type>::MAX as u8 == 255);
            }
        )*};
    }
    each!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64);
    let (payload, expected) = three(Dtype::I16, Endian::Big);
    let header = "{'descr': '>i2', 'fortran_order': False, 'shape': (3, 1, 1), }\n";
    let volume = read(folder.file("v.npy", &npy_of(header, &payload)), &known()).unwrap();
    assert_eq!(volume.as_slice(), expected);
    let mask = Array3::from_shape_vec((1, 1, 2), vec![true, false]).unwrap();
    let volume = read(folder.file("mask", &npy(&mask)), &known()).unwrap();
    assert_eq!(volume.as_slice(), [1.0, 0.0]);
    assert!(!volume.has_gray_levels(), "0 and 1 are not gray levels");
}

#[test]
fn damaged_npy_files_are_refused() {
    let folder = Folder::new();
    let refuses = |bytes: &[u8], parts: &[&str]| folder.refuses("v.npy", bytes, &known(), parts);
    let good = npy(&Array3::<f32>::zeros((2, 2, 2)));
    refuses(b"", &["is empty"]);
    refuses(b"hello world", &["not an NPY file"]);
    refuses(&good[..40], &["truncated"]);
    refuses(&good[..good.len() - 1], &["32 bytes", "31", "truncated"]);
    refuses(&[&good[..], b"x"].concat(), &["32 bytes", "33", "too long"]);
    let header = |descr: &str, order: &str, shape: &str| {
        npy_of(
            &format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}}}"),
            &[0; 4],
        )
    };
    assert!(read(folder.file("v.npy", &header("'<f4'", "False", "(1, 1, 1)")), &known()).is_ok());
    refuses(&header("'<f4'", "False", "(1,)"), &["shape [1]", "three axes"]);
    refuses(&header("'<c8'", "False", "(1, 1, 1)"), &["<c8"]);
    refuses(&header("'<f2'", "False", "(1, 1, 1)"), &["<f2", "astype"]);
    refuses(&header("[('a', '<f4')]", "False", "(1, 1, 1)"), &["('a', '<f4')"]);
    refuses(&header("'é'", "False", "(1, 1, 1)"), &["é"]);
    refuses(&header("'<f4'", "Perhaps", "(1, 1, 1)"), &["not understood"]);
    refuses(&header("'<f4'", "False", "(1, -1, 1)"), &["not understood"]);
    refuses(&header("'<f4'", "False", "(0, 1, 1)"), &["1×1×0", "empty"]);
    refuses(b"\x93NUMPY\x09\x00..", &["version 9"]);
    let infinite = npy(&Array3::from_elem((1, 2, 2), f32::NEG_INFINITY));
    refuses(&infinite, &["[0, 0, 0]", "-inf"]);
    // 10³⁰⁰ is finite in the file, and no f32.
    refuses(&npy(&Array3::from_elem((1, 1, 1), 1e300)), &["inf"]);
}

#[test]
fn raw_samples_of_every_type_and_order() {
    let folder = Folder::new();
    for dtype in Dtype::ALL {
        for endian in [Endian::Little, Endian::Big] {
            let (payload, expected) = three(dtype, endian);
            for offset in [0, 7] {
                let bytes = [vec![9; offset], payload.clone()].concat();
                let options = raw([3, 1, 1], dtype, endian, offset as u64);
                let volume = read(folder.file("v.raw", &bytes), &options).unwrap();
                assert_eq!(volume.as_slice(), expected, "{dtype} {endian}");
                assert_eq!(volume.has_gray_levels(), dtype == Dtype::U8);
            }
        }
    }
}

#[test]
fn raw_samples_run_along_x_first() {
    let folder = Folder::new();
    let path = folder.file("v.raw", &(0..24).collect::<Vec<u8>>());
    let volume = read(&path, &raw([4, 3, 2], Dtype::U8, Endian::Little, 0)).unwrap();
    assert_eq!(volume.samples()[[1, 2, 3]], 23.0);
    assert_eq!(volume.samples()[[0, 0, 3]], 3.0);
    assert_eq!(volume.samples()[[0, 1, 0]], 4.0);
}

#[test]
fn raw_files_of_another_length_are_refused() {
    let folder = Folder::new();
    let options = raw([64, 64, 64], Dtype::U8, Endian::Little, 0);
    let long = vec![0; 262_147];
    folder.refuses(
        "s.raw",
        &long[..262_143],
        &options,
        &["64×64×64 samples of type u8 needs 262144 bytes", "has 262143"],
    );
    folder.refuses("s.raw", &long, &options, &["has 262147", "header of 3 bytes", "`offset`"]);
    folder.refuses("s.raw", &[], &options, &["has 0", "empty"]);
    let offset = raw([64, 64, 64], Dtype::U8, Endian::Little, 5);
    folder.refuses(
        "s.raw",
        &long,
        &offset,
        &["needs 262149 bytes, 5 of them before", "has 262147"],
    );
    let huge = raw([1625, 1625, 1625], Dtype::F64, Endian::Little, u64::MAX);
    folder.refuses("s.raw", &long, &huge, &["has 262147"]);
}
