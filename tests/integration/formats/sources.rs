//! Compares volumes read box by box with the same volumes read as a whole.

use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};
use std::num::NonZeroUsize;
use std::path::Path;

use ndarray::Array3;
use walpha::advice::Advise;
use walpha::volume::{
    Dtype, Endian, Nan, RawLayout, ReadOptions, Region, Source, VolumeWriter, downsample, open,
};
use walpha::{Dims, Frame, Volume};

fn numbered() -> Volume {
    let samples = Array3::from_shape_fn((7, 5, 6), |(z, y, x)| (100 * z + 10 * y + x) as f32 / 8.0);
    let frame = Frame { origin: [7.0, 8.0, 9.0], spacing: [0.5, 2.0, 3.0], ..Frame::VOXEL };
    Volume::new(samples, frame.with_coordinates(walpha::Coordinates::PATIENT)).unwrap()
}

/// Boxes of a source are those of the volume, and what is made coarser while it is read is the volume made coarser.
fn same(path: &Path, options: &ReadOptions) {
    let (input, whole) = (path.to_str().unwrap(), options);
    let whole = open(input, whole).unwrap();
    let source = Source::open(input, options).unwrap_or_else(|error| panic!("{input}: {error}"));
    assert_eq!(source.dims(), whole.dims(), "{input}");
    assert_eq!(source.frame(), whole.frame(), "{input}");
    assert_eq!(source.dtype(), whole.dtype(), "{input}");
    assert_eq!(source.has_gray_levels(), whole.has_gray_levels(), "{input}");
    let [nx, ny, nz] = whole.dims().xyz();
    for (first, size) in [
        ([0, 0, 0], [nx, ny, nz]),
        ([1, 2, 0], [nx - 1, 1, nz]),
        ([0, 1, 1], [nx, ny - 1, 2]),
        ([nx - 1, ny - 1, nz - 1], [1, 1, 1]),
    ] {
        let read = source.read(first, size).unwrap();
        let [x, y, z] = [0, 1, 2].map(|k| first[k]..first[k] + size[k]);
        let expected = whole.samples().slice_move(ndarray::s![z, y, x]).to_owned();
        assert_eq!(read, expected.into_iter().collect::<Vec<f32>>(), "{input} {first:?} {size:?}");
    }
    let two = NonZeroUsize::new(2).unwrap();
    let coarse = open(input, &options.clone().downsample(two)).unwrap();
    assert_eq!(coarse, downsample(whole, two), "{input}");
}

#[test]
fn every_box_is_that_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let region = Region { first: [1, 0, 2], end: [None, Some(4), None] };
    for extension in ["nrrd", "mha", "nii", "npy"] {
        let path = folder.path().join("volume").with_extension(extension);
        let writer = VolumeWriter::of(&path).unwrap();
        writer.write(&numbered(), &mut File::create(&path).unwrap()).unwrap();
        same(&path, &ReadOptions::default());
        same(&path, &ReadOptions::default().region(region));
    }
    for input in ["sample:phantom@9", "sample:phantom"] {
        same(Path::new(input), &ReadOptions::default());
    }
}

#[test]
fn raw_samples_of_every_type_are_read_in_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("samples.raw");
    for dtype in Dtype::ALL {
        for endian in [Endian::Little, Endian::Big] {
            // Exponents of no NaN and of no infinity.
            let bytes = (0..11 + 4 * 3 * 5 * dtype.size()).map(|i| (i * 7 % 61) as u8);
            fs::write(&path, bytes.collect::<Vec<u8>>()).unwrap();
            let dims = Dims::new(4, 3, 5).unwrap();
            let raw = Some(RawLayout::new(dims, dtype).endian(endian).offset(11u64));
            same(&path, &ReadOptions::default().raw(raw));
        }
    }
}

#[test]
fn samples_beside_their_header_are_read_in_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let bytes: Vec<u8> = (0..5 + 2 * 4 * 3 * 5).map(|i| (i % 120) as u8).collect();
    fs::write(at("samples.bin"), &bytes).unwrap();
    let nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 5\nendian: big\nencoding: raw\n\
                byte skip: -1\ndata file: samples.bin\n";
    fs::write(at("volume.nhdr"), nrrd).unwrap();
    same(&at("volume.nhdr"), &ReadOptions::default());
    let meta = "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\nHeaderSize = 5\n\
                ElementDataFile = samples.bin\n";
    fs::write(at("volume.mhd"), meta).unwrap();
    same(&at("volume.mhd"), &ReadOptions::default());
    // A file of two volumes.
    let two = nrrd.replace("dimension: 3\nsizes: 4 3 5", "dimension: 4\nsizes: 4 3 1 5");
    let two =
        two.replace("sizes: 4 3 1 5", "sizes: 2 3 5 2").replace("byte skip: -1", "byte skip: 5");
    fs::write(at("two.nhdr"), two).unwrap();
    same(&at("two.nhdr"), &ReadOptions::default().frame(1));
}

#[test]
fn volumes_beyond_memory_are_read_in_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.raw");
    // 8·10⁹ bytes that take no room on the disk, except for the last few.
    let size = 2000u64;
    let mut file = File::create(&path).unwrap();
    file.seek(SeekFrom::Start(size.pow(3) - 3)).unwrap();
    file.write_all(&[7, 8, 9]).unwrap();
    drop(file);
    let dims = Dims::unbounded(size, size, size).unwrap();
    let raw = Some(RawLayout::new(dims, Dtype::U8));
    let options = ReadOptions::default().raw(raw);
    let input = path.to_str().unwrap();
    let source = Source::open(input, &options).unwrap();
    assert_eq!(source.read([1996, 1999, 1999], [4, 1, 1]).unwrap(), [0.0, 7.0, 8.0, 9.0]);
    assert_eq!(source.read([0, 0, 1999], [2, 2, 1]).unwrap(), [0.0; 4]);
    // It cannot be read as a whole.
    let error = open(input, &options).unwrap_err().to_string();
    assert!(error.contains("too many"), "{error}");
}

#[test]
fn what_cannot_be_read_in_boxes_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |path: &Path, why: &str| {
        let error = Source::open(path.to_str().unwrap(), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains(why), "{error}");
        assert!(error.advice().is_some(), "{error}");
    };
    for extension in ["nii.gz", "vti", "tif"] {
        let path = folder.path().join(format!("volume.{extension}"));
        let writer = VolumeWriter::of(&path).unwrap();
        writer.write(&numbered(), &mut File::create(&path).unwrap()).unwrap();
        refused(&path, "not read in parts");
    }
    let path = folder.path().join("packed.nrrd");
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: gzip\n\nabc";
    fs::write(&path, header).unwrap();
    refused(&path, "compressed");
    fs::write(&path, header.replace("gzip", "raw")).unwrap();
    refused(&path, "truncated");
    refused(&folder.path().join("nothing.nrrd"), "nothing.nrrd");
    let outside = Region { first: [0; 3], end: [Some(10), None, None] };
    let options = ReadOptions::default().region(outside);
    assert!(Source::open("sample:phantom@9", &options).is_err());
    // The treatment of NaN is left to the reader.
    let options = ReadOptions::default().nan(Nan::Mask);
    assert!(Source::open("sample:phantom@9", &options).is_ok());
}
