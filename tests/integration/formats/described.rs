//! `info` about content that is not read without changes: several volumes, samples that are not numbers, colours.

use ndarray::{Array3, Array4};
use walpha::volume::{Nan, ReadOptions, Space, read};
use walpha::{Coordinates, Frame, LengthUnit, Volume};

use super::files::{save, written};
use crate::common::Told;
use crate::common::{fails, json, names, ok};

fn npy<D: ndarray::Dimension>(array: &ndarray::Array<f32, D>) -> Vec<u8> {
    let mut bytes = Vec::new();
    ndarray_npy::WriteNpyExt::write_npy(array, &mut bytes).unwrap();
    bytes
}

#[test]
fn several_volumes_are_described() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let array =
        Array4::from_shape_fn((3, 2, 3, 4), |(t, z, y, x)| (100 * t + 12 * z + 4 * y + x) as f32);
    save(f, "t.npy", npy(&array));
    let told = json(f, &["info", "t.npy"]);
    assert_eq!(
        (&told["volumes"], &told["dims"]),
        (&serde_json::json!(3), &serde_json::json!([4, 3, 2]))
    );
    assert_eq!((&told["min"], &told["max"]), (&serde_json::json!(0.0), &serde_json::json!(23.0)));
    names(&ok(f, &["info", "t.npy"]), &["3 in the file", "--frame K"]);
    let told = json(f, &["info", "t.npy", "--frame", "2"]);
    assert_eq!((&told["min"], told.get("volumes")), (&serde_json::json!(200.0), None));
    fails(f, 1, "shape t.npy", &["holds 3 volumes", "--frame, from 0 to 2"]);
}

#[test]
fn samples_that_are_no_numbers_are_described_and_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut array = Array3::from_shape_fn((4, 4, 4), |(z, y, x)| (16 * z + 4 * y + x) as f32);
    let wrong = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    wrong.iter().enumerate().for_each(|(i, &v)| array[[0, 0, i]] = v);
    for name in ["n.npy", "n.nrrd", "n.tif"] {
        let bytes = if name == "n.npy" {
            npy(&array)
        } else {
            // Written with other numbers, which are patched: volumes are finite.
            let numbers = array.map(|&v| if v.is_finite() { v } else { 12345.0 });
            let volume = Volume::new(numbers, Frame::VOXEL).unwrap();
            let mut bytes = written(name.split_once('.').unwrap().1, &volume);
            let mark = 12345f32.to_le_bytes();
            let place = bytes.windows(4).position(|part| part == mark).unwrap();
            for (i, v) in wrong.iter().enumerate() {
                bytes[place + 4 * i..][..4].copy_from_slice(&v.to_le_bytes());
            }
            bytes
        };
        let path = save(f, name, bytes);
        let told = json(f, &["info", name]);
        assert_eq!(
            (&told["missing"], &told["min"], &told["max"]),
            (&serde_json::json!(3), &serde_json::json!(3.0), &serde_json::json!(63.0)),
            "{name}"
        );
        assert!(ok(f, &["info", name]).contains("missing   3 samples are NaN or infinite; --nan"));
        fails(f, 1, &format!("haar {name}"), &["--nan VALUE to replace NaN and infinities"]);
        let masked = read(&path, &ReadOptions::default().nan(Nan::Mask)).unwrap();
        assert!((0..64).all(|i| masked.is_missing(i) == (i < 3)), "{name}");
        assert_eq!(masked.as_slice()[..4], [3.0; 4], "{name}");
        let replaced = read(&path, &ReadOptions::default().nan(Nan::Value(-7.0))).unwrap();
        assert_eq!(replaced.as_slice()[..4], [-7.0, -7.0, -7.0, 3.0], "{name}");
        assert_eq!(json(f, &["info", name, "--nan", "-7"])["min"], -7.0);
        ok(f, &["points", name, "--nan", "--count", "5", "-o", "p.csv"]);
    }
    save(f, "all.npy", npy(&Array3::from_elem((2, 2, 2), f32::NAN)));
    assert!(ok(f, &["info", "all.npy"]).contains("values    none that is a finite number"));
    let error = read(f.join("all.npy"), &ReadOptions::default().nan(Nan::Mask)).unwrap_err().told();
    assert!(error.contains("no sample is a finite number"), "{error}");
}

#[test]
fn colours_are_described() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let nrrd = "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 3 5 4 2\nkinds: RGB-color domain domain domain\n\
                encoding: raw\n\n";
    let mha = "ObjectType = Image\nNDims = 3\nDimSize = 5 4 2\nElementNumberOfChannels = 3\n\
               ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    for (name, head, words) in
        [("c.nrrd", nrrd, "3 values a voxel (axis 0"), ("c.mha", mha, "3 values a voxel (Element")]
    {
        save(f, name, [head.as_bytes(), &[7; 120]].concat());
        let told = json(f, &["info", name]);
        assert_eq!(
            (&told["kind"], &told["dims"]),
            (&serde_json::json!("unread"), &serde_json::json!([5, 4, 2]))
        );
        let text = ok(f, &["info", name]);
        assert!(text.contains(words) && text.contains("size      5×4×2"), "{text}");
        assert!(text.contains("extract one first"), "{text}");
        fails(f, 1, &format!("haar {name}"), &[words, "extract one first"]);
    }
}

/// A `NIfTI` whose two frames say different things, and units that other programs change.
#[test]
fn frames_that_differ_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let frame = Frame::VOXEL
        .with_coordinates(Coordinates { space: Space::Ras, unit: LengthUnit::Millimetre });
    let volume = Volume::new(Array3::zeros((3, 4, 5)), frame).unwrap();
    let good = written("nii", &volume);
    let change = |places: &[(usize, Vec<u8>)]| {
        let mut bytes = good.clone();
        places.iter().for_each(|(at, value)| bytes[*at..at + value.len()].copy_from_slice(value));
        bytes
    };
    let both = |x: f32| {
        change(&[
            (76, 1f32.to_le_bytes().to_vec()),
            (252, vec![1, 0, 1, 0]),
            (256, vec![0; 12]),
            (268, x.to_le_bytes().to_vec()),
            (272, vec![0; 8]),
        ])
    };
    save(f, "same.nii", both(0.0));
    assert_eq!(json(f, &["info", "same.nii"]).get("warnings"), None);
    save(f, "both.nii", both(7.0));
    let told = json(f, &["info", "both.nii"]);
    let warnings = told["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    names(warnings[0].as_str().unwrap(), &["both.nii", "qform", "7 mm", "sform is taken"]);
    assert_eq!(told["origin"], serde_json::json!([0.0, 0.0, 0.0]));
    // If there is only the qform, it is used, without any message.
    let mut alone = both(7.0);
    alone[254] = 0;
    save(f, "qform.nii", alone);
    let told = json(f, &["info", "qform.nii"]);
    assert_eq!((&told["origin"][0], told.get("warnings")), (&serde_json::json!(7.0), None));
    save(f, "small.nii", change(&[(123, vec![3])]));
    let told = json(f, &["info", "small.nii"]);
    assert_eq!(told["unit"], "µm");
    let warned = told["warnings"].to_string();
    assert!(
        warned.contains("lengths are in µm") && warned.contains("ITK scale them to mm"),
        "{warned}"
    );
}
