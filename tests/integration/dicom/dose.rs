//! Doses of radiation: the frames of one file, each so far from the first, in units that the file scales.

use super::{Slice, open, slice};
use crate::common::told::Told;

/// Three frames at 30, 32 and 34 mm of 32 bits, with such offsets.
fn dose(offsets: &str) -> Slice {
    let number = |n: u16| n.to_le_bytes().to_vec();
    let pixels = (0..18u32).flat_map(|i| (100_000 * i + 1).to_le_bytes()).collect();
    let changed = vec![
        (8, 0x60, b"CS", b"RTDOSE".to_vec()),
        (0x28, 8, b"IS", b"3".to_vec()),
        (0x28, 0x100, b"US", number(32)),
        (0x28, 0x101, b"US", number(32)),
        (0x28, 0x102, b"US", number(31)),
        (0x28, 0x103, b"US", number(0)),
        (0x28, 0x1052, b"DS", Vec::new()),
        (0x28, 0x1053, b"DS", Vec::new()),
        (0x3004, 0xc, b"DS", offsets.as_bytes().to_vec()),
        (0x3004, 0xe, b"DS", b"0.0005".to_vec()),
        (0x7fe0, 0x10, b"OW", pixels),
    ];
    Slice { changed, ..slice(0, 30.0) }
}

#[test]
fn a_dose_is_a_volume_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    // From the first, or in places of the patient.
    for (offsets, order) in
        [("0\\2\\4", [0, 1, 2]), ("30\\32\\34", [0, 1, 2]), ("0\\-2\\-4", [2, 1, 0])]
    {
        dose(offsets).save(folder.path(), "dose.dcm");
        let volume = open(&folder.path().join("dose.dcm")).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((volume.dims().xyz(), volume.dtype()), ([3, 2, 3], walpha::volume::Dtype::F32));
        let value = |i: u32| (f64::from(100_000 * i + 1) * 0.0005) as f32;
        let frames = order.into_iter().flat_map(|frame| (0..6).map(move |i| value(6 * frame + i)));
        assert_eq!(volume.as_slice(), frames.collect::<Vec<f32>>(), "{offsets}");
        let lowest = if order[0] == 0 { 30.0 } else { 26.0 };
        let frame = volume.frame();
        assert_eq!((frame.spacing, frame.origin), ([0.75, 0.5, 2.0], [-10.0, 5.5, lowest]));
    }
    for (offsets, words) in
        [("0\\2", "Grid Frame Offset Vector"), ("", "one place for all of them")]
    {
        dose(offsets).save(folder.path(), "dose.dcm");
        let error = open(&folder.path().join("dose.dcm")).unwrap_err().told();
        assert!(error.contains(words) && !error.contains("echoes"), "{error}");
    }
}
