//! Slices at several distances: resampled, or with a hole among them.

use std::fs;

use walpha::volume::{ReadOptions, read};

use super::{Slice, open, series, slice};
use crate::common::{Told, fails, json};

/// Slices at these heights, whose pixels are ten times that.
fn at(heights: &[f64]) -> Vec<Slice> {
    let of = |&z: &f64| Slice { pixels: vec![(10.0 * z) as i16; 6], ..slice(0, z) };
    heights.iter().map(of).collect()
}

fn save(slices: &[Slice]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (n, slice) in slices.iter().enumerate() {
        slice.save(folder.path(), &format!("{n:02}.dcm"));
    }
    folder
}

#[test]
fn several_spacings_become_the_finest() {
    for (heights, step, count) in [
        (&[0.0, 2.5, 5.0, 12.5, 20.0][..], 2.5, 9),
        (&[0.0, 1.0, 2.0, 6.0, 10.0, 11.0, 12.0], 1.0, 13),
        (&[0.0, 5.0, 10.0, 12.0, 14.0], 2.0, 8),
    ] {
        let folder = save(&at(heights));
        let f = folder.path();
        let volume = open(f).unwrap_or_else(|error| panic!("{heights:?}: {error}"));
        assert_eq!((volume.dims().z(), volume.frame().spacing[2]), (count, step));
        // Values that are linear in between stay so.
        for (k, value) in volume.as_slice().chunks(6).map(|plane| plane[0]).enumerate() {
            assert!(
                (f64::from(value) - 10.0 * step * k as f64).abs() < 1e-3,
                "{heights:?}, {k}: {value}"
            );
        }
        let warned = json(f, &["info", "."])["warnings"].to_string();
        let said = format!("resampled linearly to {count} slices {step} mm apart");
        assert!(
            warned.contains("slices are at several distances") && warned.contains(&said),
            "{warned}"
        );
        let text = read(f, &ReadOptions::default().no_resample(true)).unwrap_err().told();
        assert!(text.contains("omit `no_resample` to resample them linearly"), "{text}");
        fails(
            f,
            1,
            "info . --no-resample",
            &["slices are at several distances", "omit --no-resample"],
        );
    }
    let folder = save(&at(&[0.0, 1.0, 2.0]));
    assert!(read(folder.path(), &ReadOptions::default().no_resample(true)).is_ok());
    fs::write(folder.path().join("a.npy"), "").unwrap();
    fails(
        folder.path(),
        2,
        "info a.npy --no-resample --dims 1,1,1 --dtype u8",
        &["cannot be used with"],
    );
}

/// At the place of a slice, values are unchanged, and padding extends by one.
#[test]
fn slices_stay_and_padding_spreads_by_one() {
    let padding = (0x28, 0x120, b"SS", 7i16.to_le_bytes().to_vec());
    let mut slices = at(&[0.0, 1.0, 2.0, 4.0, 6.0]);
    slices[3].pixels = vec![7, 41, 41, 41, 41, 41];
    let slices: Vec<Slice> =
        slices.into_iter().map(|slice| slice.with([padding.clone()])).collect();
    let volume = series(&slices).unwrap();
    let planes: Vec<&[f32]> = volume.as_slice().chunks(6).collect();
    assert_eq!((planes.len(), planes[2][1], planes[3][1], planes[4][1]), (7, 20.0, 30.5, 41.0));
    let missing: Vec<usize> = (0..42).filter(|&i| volume.is_missing(i)).collect();
    assert_eq!(missing, [18, 24, 30]);
}

#[test]
fn a_hole_is_an_error_that_names_its_ends() {
    for (heights, words) in [
        (&[0.0, 1.0, 2.0, 4.0, 5.0][..], "gap of 2.000 mm between"),
        (&[0.0, 1.0, 2.0, 6.0], "where 1.000 mm are usual (slices missing: 3)"),
        (&[0.0, 1.0, 2.0, 3.6, 4.6, 5.6], "neither the place of whole slices"),
    ] {
        let folder = save(&at(heights));
        let text = open(folder.path()).unwrap_err().told();
        let ends = text.contains("02.dcm") && text.contains("03.dcm");
        assert!(text.contains(words) && ends && !text.contains("copy"), "{text}");
    }
    // Numbers of slices tell whether any are missing.
    let numbered = |numbers: [i32; 6]| {
        let slices = at(&[0.0, 1.0, 2.0, 3.0, 5.0, 7.0]).into_iter().zip(numbers);
        let number = |n: i32| (0x20, 0x13, b"IS", n.to_string().into_bytes());
        series(&slices.map(|(slice, n)| slice.with([number(n)])).collect::<Vec<_>>())
    };
    assert_eq!(numbered([6, 5, 4, 3, 2, 1]).unwrap().dims().z(), 8);
    assert!(numbered([1, 2, 3, 4, 6, 8]).unwrap_err().contains("slices missing: 1"));
}

#[test]
fn slices_lie_on_one_line() {
    let aside = |n: i16| Slice { position: [f64::from(n % 2), 0.0, f64::from(n)], ..slice(n, 0.0) };
    let text = series(&(0..5).map(aside).collect::<Vec<_>>()).unwrap_err();
    assert!(text.contains("lies 1.000 mm beside the line"), "{text}");
}

#[test]
fn small_unevenness_is_said() {
    let folder = save(&at(&[0.0, 1.0, 2.05, 3.0]));
    let told = json(folder.path(), &["info", "."]);
    assert_eq!(told["dims"][2], 4);
    assert!(
        told["warnings"].to_string().contains("slices lie up to 0.050 mm off places 1 mm apart"),
        "{told}"
    );
}
