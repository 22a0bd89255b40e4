//! `FreeSurfer`'s volumes.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use ndarray::Array3;
use walpha::volume::{
    Coordinates, Dtype, Endian, FORMATS, Frame, OpenVolume, RawLayout, ReadOptions, Source, Space,
    Volume, VolumeWriter, format_name, phantom, read,
};

use super::files::{save, *};
use crate::common::{Told, fails, json, ok, run};

#[test]
fn written_volumes_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Array3::from_shape_fn((3, 4, 5), |(z, y, x)| (100 * z + 10 * y + x) as f32 / 3.0);
    let volume = Volume::new(samples, turned()).unwrap();
    for (format, writer) in FORMATS.iter().flat_map(|f| f.writers.iter().map(move |w| (f, w))) {
        let extension = writer.extension;
        let path = folder.path().join(format!("v.{extension}"));
        assert_eq!(VolumeWriter::of(&path).unwrap().extension, extension);
        let mut bytes = Vec::new();
        writer.write(&volume, &mut bytes).unwrap();
        fs::write(&path, bytes).unwrap();
        let (dims, dtype, endian) = (volume.dims(), Dtype::F32, Endian::Little);
        let layout = RawLayout::new(dims, dtype).endian(endian);
        let raw = (!format.keeps.dtype).then_some(layout);
        let options = ReadOptions::default().raw(raw);
        let back = read(&path, &options).unwrap();
        assert_eq!(back.as_slice(), volume.as_slice(), "{extension}");
        let frame = match (format.keeps.spacing, format.keeps.directions) {
            (false, _) => Frame::VOXEL,
            (true, false) => Frame { spacing: turned().spacing, ..Frame::VOXEL },
            (true, true) => turned(),
        };
        assert!(close(back.frame(), &frame), "{extension}: {:?}", back.frame());
        // The format is also recognized by content.
        if format.keeps.dtype {
            let renamed = folder.path().join("unnamed");
            fs::copy(&path, &renamed).unwrap();
            assert_eq!(open(&renamed).unwrap().as_slice(), volume.as_slice(), "{extension}");
        }
    }
    let long = Volume::new(Array3::ones((1, 1, 40_000)), turned()).unwrap();
    let bytes = written("nii", &long);
    assert_eq!(bytes[0..4], 540u32.to_le_bytes(), "version 2");
    let back = open(&save(folder.path(), "long.nii", bytes)).unwrap();
    assert_eq!(back.dims().x(), 40_000);
    let text = VolumeWriter::of(Path::new("a.mhb")).unwrap_err().told();
    assert!(text.contains("a volume") && text.contains(".nii.gz"), "{text}");
}

#[test]
fn small_files_of_every_flavour_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in examples() {
        let volume = open(&save(folder.path(), name, bytes)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(volume.dims().xyz(), [3, 2, 2], "{name}");
        assert_eq!(volume.as_slice(), numbers(), "{name}");
        if [".vtk", ".vti"].iter().any(|extension| name.ends_with(extension)) {
            let frame = Frame { origin: [4.0, 5.0, 6.0], spacing: [1.0, 2.0, 3.0], ..Frame::VOXEL };
            assert_eq!(*volume.frame(), frame.with_coordinates(Coordinates::default()), "{name}");
        }
    }
}

/// A file that is gone once it is open can be read no second time.
#[test]
#[cfg(unix)]
fn volumes_are_read_from_a_file_that_is_opened_once() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in examples() {
        let path = save(folder.path(), name, bytes);
        let options = ReadOptions::default();
        let named = format_name(&path, &options).unwrap();
        let in_parts = Source::open(&path, &options).is_ok();
        let file = OpenVolume::open(&path).unwrap();
        fs::remove_file(&path).unwrap();
        let volume = file.read(&options);
        let volume = volume.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(volume.as_slice(), numbers(), "{name}");
        assert_eq!(file.format_name(&options).unwrap(), named, "{name}");
        assert_eq!(file.data_files(&options).unwrap(), [""; 0].map(PathBuf::from), "{name}");
        let source = file.source(&options);
        assert_eq!(source.is_ok(), in_parts, "{name}: {:?}", source.err());
        if let Ok(source) = source {
            let samples = source.read([0; 3], [3, 2, 2]).unwrap();
            assert_eq!(samples, volume.as_slice(), "{name}");
        }
    }
}

#[test]
fn detached_samples_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("data")).unwrap();
    save(f, "data/all.raw", [b"head", &shorts()[..]].concat());
    save(f, "data/all.gz", gzip(&shorts()));
    save(f, "s1.raw", &shorts()[..12]);
    save(f, "s2.raw", &shorts()[12..]);
    for tail in [
        "byte skip: 4\ndata file: data/all.raw\n",
        "byte skip: -1\ndata file: data/all.raw\n",
        "data file: LIST\ns1.raw\ns2.raw\n",
        "data file: s%d.raw 1 2 1\n",
        "data file: s%d.raw 1 2 1 2\n\n",
    ] {
        let volume = open(&save(f, "v.nhdr", [NRRD, tail].concat())).unwrap();
        assert_eq!(volume.as_slice(), numbers(), "{tail}");
    }
    let packed = [&NRRD.replace("raw", "gz"), "datafile: data/all.gz\n"].concat();
    assert_eq!(open(&save(f, "v.nhdr", packed)).unwrap().as_slice(), numbers());
    for tail in [
        "HeaderSize = 4\nElementDataFile = data/all.raw\n",
        "HeaderSize = -1\nElementDataFile = data/all.raw\n",
        "ElementDataFile = LIST\ns1.raw\ns2.raw\n",
        "ElementDataFile = s%d.raw 1 2 1\n",
    ] {
        let volume = open(&save(f, "v.mhd", [MHA, tail].concat())).unwrap();
        assert_eq!(volume.as_slice(), numbers(), "{tail}");
    }
    let missing = open(&save(f, "v.nhdr", [NRRD, "data file: no.raw\n"].concat()));
    assert!(missing.unwrap_err().told().contains("no.raw"));
    let short = open(&save(f, "v.nhdr", [NRRD, "data file: s1.raw\n"].concat())).unwrap_err();
    assert!(short.to_string().contains("24 bytes, but 12 follow"), "{short}");
}

/// A header may lead anywhere, so the file that was read is told.
#[test]
fn the_files_of_samples_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let f = &folder.path().join("headers");
    fs::create_dir(f).unwrap();
    let all = save(folder.path(), "all.raw", shorts());
    let elsewhere = all.to_str().unwrap();
    let cases = [
        ("v.nhdr", [NRRD, "data file: ../all.raw\n"].concat(), "../all.raw"),
        ("v.nhdr", format!("{NRRD}data file: {elsewhere}\n"), elsewhere),
        ("v.mhd", [MHA, "ElementDataFile = ../all.raw\n"].concat(), "../all.raw"),
        ("v.mhd", format!("{MHA}ElementDataFile = {elsewhere}\n"), elsewhere),
    ];
    for (name, header, data) in cases {
        save(folder.path(), "all.raw", shorts());
        let path = save(f, name, header);
        let told = ok(f, &["info", name]);
        assert!(told.contains(&format!("samples   in {data}")), "{told}");
        let facts = json(f, &["info", name]);
        assert_eq!(facts["data_files"], serde_json::json!([data]));
        fs::write(&all, &shorts()[..10]).unwrap();
        let text = open(&path).unwrap_err().told();
        assert!(text.contains(name) && text.contains(data) && text.contains("but 10"), "{text}");
        fs::remove_file(&all).unwrap();
        let text = open(&path).unwrap_err().told();
        assert!(text.contains(data), "{text}");
    }
    save(f, "1.raw", &shorts()[..12]);
    save(f, "2.raw", &shorts()[12..]);
    save(f, "v.nhdr", [NRRD, "data file: %d.raw 1 2 1\n"].concat());
    assert!(ok(f, &["info", "v.nhdr"]).contains("samples   in 2 files, 1.raw to 2.raw"));
    // Samples that are not numbers are an error about the file they stand in.
    let text = NRRD.replace("type: short", "type: float").replace("raw", "text");
    let path = save(f, "v.nhdr", text + "data file: numbers.txt\n");
    save(f, "numbers.txt", "1e99 ".repeat(12));
    let said = open(&path).unwrap_err().told();
    assert!(said.contains("v.nhdr") && said.contains("numbers.txt"), "{said}");
}

#[test]
fn frames_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let steps = "space dimension: 3\nspace directions: (0.3,0.4,0) (0.8,-0.6,0) (0,0,-2)\n\
                 space origin: (1.5,-2,30)\n";
    let volume = open(&save(folder.path(), "v.nrrd", nrrd(|h| h + steps, &shorts()))).unwrap();
    assert!(close(volume.frame(), &turned()));
    let spaced = nrrd(|h| h + "spacings: 0.5 nan 2\n", &shorts());
    let volume = open(&save(folder.path(), "v.nrrd", spaced)).unwrap();
    assert_eq!(volume.frame().spacing, [0.5, 1.0, 2.0]);
    // The grid has 3×2×2 samples; cells are wider by half a sample on either side.
    for (fields, spacing, origin) in [
        ("axis mins: 1 2 nan\nspacings: 2 4 8\n", [2.0, 4.0, 8.0], [2.0, 4.0, 0.0]),
        ("axis mins: 0 0 0\naxis maxs: 6 4 1\n", [2.0, 2.0, 0.5], [1.0, 1.0, 0.25]),
        (
            "axis mins: 0 1 2\naxis maxs: 6 4 3\ncenterings: node node cell\n",
            [3.0, 3.0, 0.5],
            [0.0, 1.0, 2.25],
        ),
    ] {
        let bytes = nrrd(|h| h + fields, &shorts());
        let volume = open(&save(folder.path(), "v.nrrd", bytes)).unwrap();
        assert_eq!((volume.frame().spacing, volume.frame().origin), (spacing, origin), "{fields}");
    }
    refuses("v.nrrd", nrrd(|h| h + "axis mins: 1 2\n", &shorts()), &["axis mins", "3 numbers"]);
    let header = "ElementSpacing = 0.5 1 2\nOffset = 1.5 -2 30\n\
                  TransformMatrix = 0.6 0.8 0 0.8 -0.6 0 0 0 -1\nElementDataFile = LOCAL\n";
    let bytes = [MHA.as_bytes(), header.as_bytes(), &shorts()].concat();
    let volume = open(&save(folder.path(), "v.mha", bytes)).unwrap();
    assert!(close(volume.frame(), &turned()), "{:?}", volume.frame());
    let imagej = "ImageJ=1.53\nimages=2\nslices=2\nspacing=2.5\n";
    let volume = open(&save(folder.path(), "v.tif", tiff(2, Some(imagej)))).unwrap();
    assert_eq!(volume.frame().spacing, [1.0, 1.0, 2.5]);
    let ome = "<?xml version=\"1.0\"?><OME><Image><Pixels SizeZ=\"2\" PhysicalSizeX=\"0.5\" \
               PhysicalSizeY=\"0.75\" PhysicalSizeZ=\"2\"/></Image></OME>";
    let volume = open(&save(folder.path(), "v.tif", tiff(2, Some(ome)))).unwrap();
    assert_eq!(volume.frame().spacing, [0.5, 0.75, 2.0]);
}

#[test]
fn folders_of_slices_are_read_in_natural_order() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for i in [7u8, 8, 9, 10, 11] {
        image::GrayImage::from_pixel(3, 2, image::Luma([i]))
            .save(f.join(format!("s{i}.png")))
            .unwrap();
    }
    save(f, "notes.txt", "no slice");
    let volume = open(f).unwrap();
    assert_eq!(volume.dims().xyz(), [3, 2, 5]);
    let along: Vec<f32> = volume.samples().slice(ndarray::s![.., 0, 0]).to_vec();
    assert_eq!(along, [7.0, 8.0, 9.0, 10.0, 11.0]);
    assert!(volume.has_gray_levels());
    image::GrayImage::new(2, 2).save(f.join("s12.png")).unwrap();
    assert!(open(f).unwrap_err().told().contains("must be alike"));
    image::RgbImage::new(3, 2).save(f.join("s12.png")).unwrap();
    assert!(open(f).unwrap_err().told().contains("only gray"));
    save(f, "s12.png", "not an image");
    assert!(open(f).unwrap_err().told().contains("s12.png"));
    save(f, "s12.jpg", "");
    assert!(open(f).unwrap_err().told().contains("several kinds"));
    // A small file whose header has been changed to claim a huge picture.
    let huge = tempfile::tempdir().unwrap();
    let path = huge.path().join("s.jpg");
    image::GrayImage::new(8, 8).save(&path).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let frame = bytes.windows(2).position(|mark| mark == [0xff, 0xc0]).unwrap();
    bytes[frame + 5..frame + 9].fill(0x7f);
    fs::write(&path, bytes).unwrap();
    assert!(open(huge.path()).unwrap_err().told().contains("claims 32639×32639 pixels"));
    let empty = tempfile::tempdir().unwrap();
    assert!(open(empty.path()).unwrap_err().told().contains("holds no PNG"));
}

/// Frames of 2×3×2 samples of a type, 0, 1, 2, …
fn mgh(kind: i32, frames: i32, placed: bool, sample: impl Fn(u8) -> Vec<u8>) -> Vec<u8> {
    let whole = [1, 2, 3, 2, frames, kind, 0].map(i32::to_be_bytes).concat();
    // x runs to the left, y down, z to the front, like in `FreeSurfer`.
    let reals: [f32; 15] =
        [2.0, 1.0, 0.5, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 10.0, 20.0, 30.0];
    let mut bytes =
        [whole, i16::from(placed).to_be_bytes().to_vec(), reals.map(f32::to_be_bytes).concat()]
            .concat();
    bytes.resize(284, 0);
    bytes.extend((0..12 * frames as u8).flat_map(sample));
    bytes
}

fn float(value: u8) -> Vec<u8> {
    f32::from(value).to_be_bytes().to_vec()
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn samples_of_every_type_and_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let wanted: Vec<f32> = (0u8..12).map(f32::from).collect();
    let scanner = [mgh(3, 1, true, float), float(9)].concat();
    let cases: Vec<(&str, Vec<u8>, Dtype)> = vec![
        ("b.mgh", mgh(0, 1, true, |v| vec![v]), Dtype::U8),
        ("i.mgh", mgh(1, 1, true, |v| i32::from(v).to_be_bytes().to_vec()), Dtype::I32),
        ("f.mgh", mgh(3, 1, true, float), Dtype::F32),
        ("s.mgh", mgh(4, 1, true, |v| i16::from(v).to_be_bytes().to_vec()), Dtype::I16),
        ("u.mgh", mgh(10, 1, true, |v| u16::from(v).to_be_bytes().to_vec()), Dtype::U16),
        ("footer.mgh", scanner.clone(), Dtype::F32),
        ("f.mgz", packed(&mgh(3, 1, true, float)), Dtype::F32),
        ("footer.mgh.gz", packed(&scanner), Dtype::F32),
        ("named_otherwise", packed(&scanner), Dtype::F32),
    ];
    for (name, bytes, dtype) in cases {
        let volume =
            read(save(f, name, bytes), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((volume.as_slice(), volume.dtype()), (&wanted[..], dtype), "{name}");
        let frame = volume.frame();
        assert_eq!(
            (frame.spacing, frame.coordinates.space),
            ([2.0, 1.0, 0.5], Space::Ras),
            "{name}"
        );
        // The header places sample (1, 1.5, 1), the middle as `FreeSurfer` counts.
        assert_eq!(frame.to_world([1.0, 1.5, 1.0]), [10.0, 20.0, 30.0], "{name}");
        assert_eq!(frame.to_world([0.0, 1.5, 1.0]), [12.0, 20.0, 30.0], "{name}");
        assert_eq!(frame.to_world([1.0, 0.5, 1.0]), [10.0, 20.0, 31.0], "{name}");
        assert_eq!(frame.to_world([1.0, 1.5, 0.0]), [10.0, 19.5, 30.0], "{name}");
    }
    let unplaced =
        read(save(f, "n.mgh", mgh(3, 1, false, float)), &ReadOptions::default()).unwrap();
    assert_eq!(*unplaced.frame(), Frame::VOXEL);
    let part =
        Source::open(f.join("footer.mgh").to_str().unwrap(), &ReadOptions::default()).unwrap();
    assert_eq!(part.read([0, 1, 1], [2, 1, 1]).unwrap(), [8.0, 9.0]);
}

#[test]
fn frames_are_chosen_and_damage_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (name, bytes) in
        [("t.mgh", mgh(3, 3, true, float)), ("t.mgz", packed(&mgh(3, 3, true, float)))]
    {
        let path = save(f, name, bytes);
        let second = read(&path, &ReadOptions::default().frame(1u64)).unwrap();
        assert_eq!(second.as_slice()[0], 12.0, "{name}");
        assert!(
            read(&path, &ReadOptions::default()).unwrap_err().told().contains("holds 3 volumes")
        );
    }
    let refuses = |bytes: Vec<u8>, words: &str| {
        save(f, "bad.mgh", bytes);
        fails(f, 1, "shape bad.mgh", &["bad.mgh", words]);
    };
    let good = mgh(3, 1, true, float);
    refuses(good[..300].to_vec(), "truncated");
    refuses(good[..200].to_vec(), "truncated");
    let change = |place: usize, value: i32| {
        let mut bytes = good.clone();
        bytes[place..place + 4].copy_from_slice(&value.to_be_bytes());
        bytes
    };
    refuses(change(20, 7), "type 7");
    refuses(change(8, -3), "axes of [2, -3, 2, 1]");
    refuses(change(0, 2), "version is 2");
    refuses(change(4, 1 << 19), "truncated");
    save(f, "f.mgz", packed(&good));
    assert_eq!(json(f, &["info", "f.mgz"])["format"], "MGH (FreeSurfer), gzip");
}

/// A mark of UTF-8 shifts what is found by its position in the file.
#[test]
fn marks_before_xml_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let volume = phantom(5).unwrap();
    let path = f.join("a.vti");
    let writer = VolumeWriter::of(&path).unwrap();
    writer.write(&volume, &mut fs::File::create(&path).unwrap()).unwrap();
    let bytes = fs::read(&path).unwrap();
    fs::write(f.join("b.vti"), [b"\xef\xbb\xbf", &bytes[..]].concat()).unwrap();
    let [plain, marked] =
        ["a.vti", "b.vti"].map(|name| read(f.join(name), &ReadOptions::default()).unwrap());
    assert_eq!(marked.as_slice(), plain.as_slice());
}

/// A double beyond single precision becomes infinite, which is not a number of the file.
#[test]
fn numbers_beyond_single_precision_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut samples = Array3::from_shape_fn((2, 2, 2), |(z, y, x)| (x + y + z) as f64);
    ndarray_npy::write_npy(f.join("a.npy"), &samples).unwrap();
    samples[[1, 1, 1]] = 1e300;
    ndarray_npy::write_npy(f.join("b.npy"), &samples).unwrap();
    for (name, is_told) in [("a.npy", false), ("b.npy", true)] {
        let (code, _, stderr) = run(f, &["info", name]);
        assert!(code == 0 && stderr.contains("become infinite") == is_told, "{name}: {stderr}");
    }
}
