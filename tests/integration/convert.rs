//! `walpha convert`: a volume as Zarr, and nothing half-written.

use std::fs::{self, File};
use std::path::Path;

use ndarray::{Array3, s};
use ndarray_npy::WriteNpyExt;
use walpha::volume::{ReadOptions, VolumeWriter, open, phantom};
use walpha::{Coordinates, Frame, Volume};

use crate::common::{json, ok, run};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn read(at: &Path, name: &str) -> Volume {
    open(at.join(name).to_str().unwrap(), &ReadOptions::default()).unwrap()
}

fn write(at: &Path, name: &str, volume: &Volume) {
    let path = at.join(name);
    let writer = VolumeWriter::of(&path).unwrap();
    writer.write(volume, &mut File::create(&path).unwrap()).unwrap();
}

/// An array whose size is not a multiple of a chunk along any axis, with samples that all differ from their neighbours.
fn numbers<T>(number: impl Fn(usize) -> T) -> Array3<T> {
    let mut next = 0..;
    Array3::from_shape_simple_fn((67, 130, 71), || number(next.next().unwrap()))
}

#[test]
fn values_spacing_and_origin_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let samples = numbers(|i| (i * 7919 % 100_003) as f32 * 0.37 - 1e4);
    let frame =
        Frame::from_axes([-31.7, 12.25, 1e3], [[0.4, 0., 0.], [0., 0.7, 0.], [0., 0., 1.3]]);
    let frame = frame.unwrap().with_coordinates(Coordinates::PATIENT);
    let volume = Volume::new(samples, frame).unwrap();
    for name in ["scan.mha", "scan.nrrd", "scan.nii", "scan.nii.gz"] {
        write(at, name, &volume);
        let facts = json(at, &["convert", name, "-o", "scan.zarr"]);
        assert_eq!(facts["dims"], serde_json::json!([71, 130, 67]), "{name}");
        let (before, after) = (read(at, name), read(at, "scan.zarr"));
        assert_eq!(before.as_slice(), volume.as_slice(), "{name}");
        assert_eq!(after.as_slice(), before.as_slice(), "{name}");
        let (a, b) = (after.frame(), before.frame());
        assert_eq!((a.spacing, a.origin), (b.spacing, b.origin), "{name}");
        assert_eq!(a.coordinates.unit, b.coordinates.unit, "{name}");
        fs::remove_dir_all(at.join("scan.zarr")).unwrap();
    }
}

/// Small integers stay small, and a region of a converted volume is the region of the volume.
#[test]
fn types_and_regions_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    numbers(|i| (i % 251) as u8).write_npy(File::create(at.join("u8.npy")).unwrap()).unwrap();
    numbers(|i| (i * 31) as i16).write_npy(File::create(at.join("i16.npy")).unwrap()).unwrap();
    numbers(|i| (i * 77) as u16).write_npy(File::create(at.join("u16.npy")).unwrap()).unwrap();
    numbers(|i| i as f64 * 1e-3).write_npy(File::create(at.join("f64.npy")).unwrap()).unwrap();
    for (name, kind) in [("u8", "uint8"), ("i16", "int16"), ("u16", "uint16"), ("f64", "float32")] {
        let (npy, zarr) = (format!("{name}.npy"), format!("{name}.zarr"));
        ok(at, &["convert", &npy, "-o", &zarr]);
        assert_eq!(read(at, &zarr).as_slice(), read(at, &npy).as_slice(), "{name}");
        let metadata = fs::read_to_string(at.join(&zarr).join("zarr.json")).unwrap();
        assert!(metadata.contains(&format!("\"data_type\": \"{kind}\"")), "{metadata}");
    }
    ok(at, &["convert", "i16.npy", "--roi", "3:70,60:,5:66", "-o", "part.zarr"]);
    let whole = numbers(|i| f32::from((i * 31) as i16));
    let part = whole.slice(ndarray::s![5..66, 60.., 3..70]);
    assert!(read(at, "part.zarr").as_slice().iter().eq(part.iter()));
}

#[test]
fn a_shape_of_the_converted_volume_is_that_of_the_volume() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "head.nrrd", &phantom(70).unwrap());
    ok(at, &["convert", "head.nrrd", "-o", "head.zarr"]);
    let shape = |input: &str| {
        let args = ["shape", input, "--weights", "min-max", "--blocks", "5", "-o", "out.pvtp"];
        let mut report = json(at, &args);
        for name in ["input", "files", "seconds", "peak_memory_bytes"] {
            report.as_object_mut().unwrap().remove(name).expect(name);
        }
        report
    };
    assert_eq!(shape("head.zarr"), shape("head.nrrd"));
}

#[test]
fn nothing_is_written_over_or_left_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let refused = |args: &[&str], expected: i32, why: &str| {
        let (code, _, stderr) = run(at, &[&["convert"], args].concat());
        assert!(code == expected && stderr.contains(why), "{args:?}: {code}\n{stderr}");
        assert!(stderr.contains("\n next: "), "{stderr}");
    };
    refused(&["sample:phantom@20", "-o", "out.nrrd"], 2, ".zarr, the one format");
    refused(&["sample:phantom@20", "--gray", "0..9", "-o", "out.zarr"], 2, "as they are");
    refused(&["nowhere.nrrd", "-o", "out.zarr"], 1, "nowhere.nrrd");
    refused(&["sample:phantom@20", "-o", "nowhere/out.zarr"], 1, "nowhere");
    assert_eq!(names(at), [""; 0]);

    // Another folder of that name.
    fs::create_dir(at.join("kept.zarr")).unwrap();
    fs::write(at.join("kept.zarr/mine"), "mine").unwrap();
    refused(&["sample:phantom@20", "-o", "kept.zarr"], 1, "kept.zarr");
    assert_eq!(names(&at.join("kept.zarr")), ["mine"]);
    fs::remove_dir_all(at.join("kept.zarr")).unwrap();

    // A chunk in the middle is damaged: found when others have been written.
    ok(at, &["convert", "sample:phantom@130", "-o", "in.zarr"]);
    let chunk = at.join("in.zarr/c/1/1/1");
    assert!(chunk.exists(), "{:?}", names(&at.join("in.zarr")));
    fs::write(chunk, "no zstd").unwrap();
    refused(&["in.zarr", "-o", "out.zarr"], 1, "in.zarr");
    assert_eq!(names(at), ["in.zarr"]);
}

/// The remains of a killed run do not get into the result of the next run.
#[test]
fn leavings_of_a_killed_run_are_no_part_of_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let part = at.join(".walpha-out.zarr.part");
    fs::create_dir_all(part.join("c/9")).unwrap();
    fs::write(part.join("c/9/9"), "old").unwrap();
    ok(at, &["convert", "sample:phantom@20", "-o", "out.zarr"]);
    assert_eq!(names(at), ["out.zarr"]);
    assert_eq!(names(&at.join("out.zarr/c")), ["0"]);
}

/// OME-Zarr holds no directions of axes.
#[test]
fn directions_are_not_lost_in_silence() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let samples = Array3::from_shape_fn((3, 3, 3), |(z, y, x)| (x + 2 * y + z * z) as f32);
    let cases = [
        ([[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]], None),
        ([[-1., 0., 0.], [0., 1., 0.], [0., 0., 1.]], Some("its mirror image")),
        ([[0., 1., 0.], [-1., 0., 0.], [0., 0., 1.]], Some("is turned")),
    ];
    for (axes, told) in cases {
        let frame = Frame::from_axes([0.0; 3], axes).unwrap();
        let frame = frame.with_coordinates(Coordinates::PATIENT);
        write(at, "scan.nrrd", &Volume::new(samples.clone(), frame).unwrap());
        let (code, _, stderr) = run(at, &["convert", "scan.nrrd", "-o", "scan.zarr"]);
        let expected = told.map_or("", |told| told);
        assert!(code == 0 && stderr.contains(expected), "{axes:?}: {stderr}");
        assert_eq!(stderr.is_empty(), told.is_none(), "{axes:?}: {stderr}");
        fs::remove_dir_all(at.join("scan.zarr")).unwrap();
    }
}

/// What is not finite stays so, however it is read; and points are not called unknown.
#[test]
fn what_is_missing_stays_missing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut samples = Array3::from_shape_fn((4, 4, 4), |(z, y, x)| (16 * z + 4 * y + x) as f32);
    samples[[0, 0, 0]] = f32::NAN;
    samples.slice_mut(s![2.., 2.., 2..]).fill(f32::NAN);
    samples.write_npy(File::create(at.join("nan.npy")).unwrap()).unwrap();
    ok(at, &["convert", "nan.npy", "--downsample", "2", "-o", "coarse.zarr"]);
    let told = json(at, &["info", "coarse.zarr"]);
    assert_eq!((&told["missing"], &told["max"]), (&1.into(), &50.5.into()), "{told}");
    fs::write(at.join("p.csv"), "x,y,z\n0,0,0\n1,0,0\n").unwrap();
    for args in [&["convert", "p.csv", "-o", "p.zarr"][..], &["haar", "p.csv"]] {
        let (code, _, error) = run(at, args);
        assert!(code == 1 && error.contains("p.csv holds points"), "{error}");
    }
}

/// Means of integers have fractions, and samples that fill no block are not left out in silence.
#[test]
fn means_keep_their_fractions() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let samples = Array3::from_shape_fn((2, 2, 5), |(z, y, x)| (x + y + z) as i16 - 7);
    samples.write_npy(File::create(at.join("i16.npy")).unwrap()).unwrap();
    let (code, _, stderr) =
        run(at, &["convert", "i16.npy", "--downsample", "2", "-o", "coarse.zarr"]);
    assert!(
        code == 0 && stderr.contains("the last 1, 0 and 0 along x, y and z fill no block of 2"),
        "{stderr}"
    );
    let n = std::num::NonZeroUsize::new(2).unwrap();
    let direct = open(at.join("i16.npy"), &ReadOptions::default().downsample(Some(n))).unwrap();
    assert_eq!(direct.as_slice(), [-5.5, -3.5]);
    assert_eq!(read(at, "coarse.zarr").as_slice(), direct.as_slice());
    assert_eq!(json(at, &["info", "i16.npy", "--downsample", "2"])["samples"], "f32");
    ok(at, &["convert", "i16.npy", "-o", "fine.zarr"]);
    assert_eq!(json(at, &["info", "fine.zarr"])["samples"], "i16");
}
