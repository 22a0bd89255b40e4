//! A voxel keeps its place in the patient in any sequence of formats.

use ndarray::Array3;
use proptest::prelude::*;
use walpha::volume::{Coordinates, Frame, LengthUnit, Space, Volume};

use super::files::*;
use crate::common::{json, ok};

/// The formats that place a grid.
const PLACED: [&str; 5] = ["nrrd", "nii", "nii.gz", "mha", "vti"];

/// Written and read again.
fn through(extension: &str, volume: &Volume) -> Volume {
    let folder = tempfile::tempdir().unwrap();
    open(&save(folder.path(), &format!("v.{extension}"), written(extension, volume))).unwrap()
}

/// The place of a sample in a patient, in millimetres.
fn place(volume: &Volume, index: [f64; 3]) -> [f64; 3] {
    let frame = volume.frame().to(Coordinates::PATIENT);
    assert_eq!(frame.coordinates, Coordinates::PATIENT, "{:?}", volume.frame());
    frame.to_world(index)
}

prop_compose! {
    /// A turned, stretched and moved grid in a patient.
    fn frames()(
        angles in [-3.0f64..3.0, -1.5..1.5, -3.0..3.0],
        spacing in [0.1f64..5.0, 0.1..5.0, 0.1..5.0],
        origin in [-900f64..900.0, -900.0..900.0, -900.0..900.0],
        flip in any::<bool>(),
        space in prop::sample::select(vec![Space::Lps, Space::Ras, Space::Las]),
        unit in prop::sample::select(vec![
            LengthUnit::Metre, LengthUnit::Centimetre, LengthUnit::Millimetre, LengthUnit::Micrometre,
            LengthUnit::Nanometre,
        ]),
    ) -> Frame {
        let turn = |v: [f64; 3], axis: usize, angle: f64| {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut turned = v;
            turned[i] = angle.cos() * v[i] - angle.sin() * v[j];
            turned[j] = angle.sin() * v[i] + angle.cos() * v[j];
            turned
        };
        let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, if flip { -1.0 } else { 1.0 }]];
        for (axis, angle) in angles.into_iter().enumerate() {
            axes = axes.map(|v| turn(v, axis, angle));
        }
        let axes = [0, 1, 2].map(|c| axes[c].map(|v| v * spacing[c]));
        Frame::from_axes(origin, axes).unwrap().with_coordinates(Coordinates { space, unit })
    }
}

proptest! {
    #[test]
    fn a_voxel_keeps_its_place_in_the_patient(
        frame in frames(),
        index in [0f64..4.0, 0.0..3.0, 0.0..2.0],
    ) {
        let volume = Volume::new(Array3::zeros((3, 4, 5)), frame).unwrap();
        let there = place(&volume, index);
        let size = there.iter().fold(frame.to(Coordinates::PATIENT).spacing[0], |most, x| most.max(x.abs()));
        for first in PLACED {
            let once = through(first, &volume);
            for second in PLACED {
                let back = place(&through(second, &once), index);
                for k in 0..3 {
                    // NIfTI-1 has floats.
                    prop_assert!(
                        (back[k] - there[k]).abs() <= 1e-5 * size,
                        "{first:?} then {second:?}: {back:?}, not {there:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_volume_in_voxels_gets_no_place() {
    let volume = Volume::new(Array3::zeros((3, 4, 5)), Frame::VOXEL).unwrap();
    for format in PLACED.into_iter().filter(|format| *format != "vti") {
        assert_eq!(*through(format, &volume).frame(), Frame::VOXEL, "{format:?}");
    }
}

/// The sample of the marker: its place in each file as the format means it.
#[test]
fn headers_say_the_space_and_the_unit() {
    let frame = Frame { origin: [-86.9, 39.2, -678.7], spacing: [0.5, 0.5, 2.0], ..Frame::VOXEL };
    let frame = frame.with_coordinates(Coordinates::PATIENT);
    let volume = Volume::new(Array3::zeros((1, 1, 1)), frame).unwrap();
    let text =
        |format, volume: &Volume| String::from_utf8_lossy(&written(format, volume)).into_owned();
    let nrrd = text("nrrd", &volume);
    assert!(nrrd.contains("space: left-posterior-superior\nspace units: \"mm\""), "{nrrd}");
    assert!(nrrd.contains("space origin: (-86.9,39.2,-678.7)"), "{nrrd}");
    let mha = text("mha", &volume);
    assert!(mha.contains("Offset = -86.9 39.2 -678.7\nDistanceUnits = mm\n"), "{mha}");
    let nifti = written("nii", &volume);
    let float = |at: usize| f32::from_le_bytes(nifti[at..at + 4].try_into().unwrap());
    assert_eq!([float(292), float(308), float(324)], [86.9, -39.2, -678.7]);
    assert_eq!((nifti[123], nifti[254]), (2, 1), "millimetres, scanner");
    let vti = text("vti", &volume);
    assert!(
        vti.contains("Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">76 80 83 0<"),
        "{vti}"
    );

    let ras = frame.to(Coordinates { space: Space::Ras, ..Coordinates::PATIENT });
    let nrrd = text("nrrd", &volume.clone().with_frame(ras));
    assert!(nrrd.contains("space: right-anterior-superior\n"), "{nrrd}");
    assert!(nrrd.contains("space origin: (86.9,-39.2,-678.7)"), "{nrrd}");

    // Micrometres of no patient stay what they are.
    let small = Coordinates { unit: LengthUnit::Micrometre, ..Coordinates::default() };
    let small = volume.with_frame(frame.with_coordinates(small));
    assert!(text("nrrd", &small).contains("space dimension: 3\nspace units: \"um\""));
    assert_eq!(written("nii", &small)[123], 3);
    assert!(text("mha", &small).contains("ElementSpacing = 0.0005 0.0005 0.002"));
}

/// Coordinates are in world units if the file states them, in LPS unless requested otherwise, and the unit is printed with each
/// length.
#[test]
fn lengths_are_in_the_unit_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // 0.5 mm, 0.5 mm, 2 mm: a cell of 0.5 mm³.
    ok(f, &["haar", "sample:phantom@16", "-o", "plain.npy"]);
    let samples: Array3<f32> = ndarray_npy::read_npy(f.join("plain.npy")).unwrap();
    let frame = Frame { origin: [10.0, 20.0, 30.0], spacing: [0.5, 0.5, 2.0], ..Frame::VOXEL };
    let volume = Volume::new(samples, frame.with_coordinates(Coordinates::PATIENT)).unwrap();
    save(f, "v.nii", written("nii", &volume));

    let shape =
        |options: &[&str]| json(f, &[&["shape", "v.nii", "--count", "300"], options].concat());
    let world = shape(&["-o", "lps.ply", "lps.vtp", "lps.obj", "lps.off", "lps.stl"]);
    assert_eq!(world["coordinates"], serde_json::json!({"space": "LPS", "unit": "mm"}));
    let alpha = world["alpha"]["squared"].as_f64().unwrap();
    assert!((alpha - 10.0 * 0.5f64.cbrt().powi(2)).abs() < 1e-9, "{alpha}");
    assert_eq!(world["alpha"]["unit"], "mm");
    let voxel = shape(&["--units", "voxel", "--alpha", "inf"]);
    assert_eq!(voxel["coordinates"]["unit"], "voxel");
    let hull = shape(&["--alpha", "inf"]);
    let volume = |facts: &serde_json::Value| facts["shape"]["volume"].as_f64().unwrap();
    assert!((volume(&hull) - 0.5 * volume(&voxel)).abs() < 1e-6 * volume(&hull));
    let text =
        ok(f, &["shape", "v.nii", "--count", "300", "--quiet", "-o", "ras.ply", "--space", "ras"]);
    assert_eq!(text, "");
    for (name, word) in [
        ("lps.ply", "comment SPACE=LPS UNIT=mm\n"),
        ("lps.obj", "# SPACE=LPS UNIT=mm\n"),
        ("lps.off", "# SPACE=LPS UNIT=mm\n"),
        ("lps.stl", " SPACE=LPS UNIT=mm "),
        ("lps.vtp", "Name=\"SPACE\" NumberOfTuples=\"1\" format=\"appended\""),
        ("lps.vtp", "LPS\0"),
        ("ras.ply", "comment SPACE=RAS UNIT=mm\n"),
    ] {
        let bytes = std::fs::read(f.join(name)).unwrap();
        assert!(String::from_utf8_lossy(&bytes).contains(word), "{word} is missing in {name}");
    }
    let low = |name: &str| json(f, &["info", name])["low"].clone();
    let high = |name: &str| json(f, &["info", name])["high"].clone();
    let [lps, ras] = ["lps.ply", "ras.ply"].map(low);
    assert_eq!(lps[0].as_f64().unwrap(), -high("ras.ply")[0].as_f64().unwrap());
    assert_eq!(lps[2], ras[2]);
    assert!(lps[0].as_f64().unwrap() >= 10.0, "{lps}");

    for (options, word) in [
        (&["shape", "sample:phantom@8", "--space", "ras"][..], "these are voxels"),
        (&["shape", "v.nii", "--units", "voxel", "--space", "ras"], "these are voxels"),
    ] {
        let (code, _, error) = crate::common::run(f, options);
        assert!(code == 1 && error.contains(word), "{error}");
    }
    let info = ok(f, &["info", "v.nii"]);
    assert!(info.contains("space     RAS") && info.contains("spacing   0.5 0.5 2 mm"), "{info}");
}
