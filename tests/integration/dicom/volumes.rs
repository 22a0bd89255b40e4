//! Copies of slices, and several volumes in a series: times, stacks, nuclear medicine.

use walpha::volume::{ReadOptions, read};

use super::{Slice, element, items, open, series, slice};
use crate::common::{Told, json};

#[test]
fn copies_count_once() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for n in 0..3 {
        slice(n, f64::from(n)).save(f, &format!("{n}.dcm"));
        slice(n, f64::from(n)).save(f, &format!("copy of {n}.dcm"));
    }
    assert_eq!(open(f).unwrap().dims().xyz(), [3, 2, 3]);
    let warned = json(f, &["info", "."])["warnings"].to_string();
    assert!(warned.contains("3 slices of") && warned.contains("are copies of others"), "{warned}");
    let name = (8, 0x18, b"UI", b"1.2.3".to_vec());
    let named = |n: i16, z: f64| slice(n, z).with([name.clone()]);
    let text = series(&[named(0, 0.0), named(5, 0.0), slice(1, 1.0)]).unwrap_err();
    assert!(text.contains("two files of one SOP Instance UID whose pixels differ"), "{text}");
    // At other places they are not copies, regardless of their names.
    assert_eq!(series(&[named(0, 0.0), named(0, 1.0)]).unwrap().dims().z(), 2);
}

/// The volumes of a file, by `frame`; the error without.
fn volumes(slices: &[Slice], count: u64) -> Vec<Vec<f32>> {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (n, slice) in slices.iter().enumerate() {
        slice.save(f, &format!("{n}.dcm"));
    }
    let text = open(f).unwrap_err().told();
    assert!(text.contains(&format!("holds {count} volumes")) && text.contains("`frame`"), "{text}");
    assert_eq!(json(f, &["info", "."])["volumes"], count);
    let of = |k| read(f, &ReadOptions::default().frame(Some(k)));
    assert!(of(count).is_err());
    let first = |k| of(k).unwrap().as_slice().chunks(6).map(|plane| plane[0]).collect();
    (0..count).map(first).collect()
}

/// Frames of an enhanced image, each with its height and what Frame Content says.
fn content(frames: &[(f64, Vec<u8>)]) -> Slice {
    let heights: Vec<f64> = frames.iter().map(|(z, _)| *z).collect();
    let frame = |(z, content): &(f64, Vec<u8>)| {
        let place = element(0x20, 0x32, b"DS", format!("1\\2\\{z}").as_bytes());
        let place = element(0x20, 0x9113, b"SQ", &items(&[place]));
        [place, element(0x20, 0x9111, b"SQ", &items(std::slice::from_ref(content)))].concat()
    };
    let frames: Vec<Vec<u8>> = frames.iter().map(frame).collect();
    super::frames::enhanced(&heights).with([(0x5200, 0x9230, b"SQ", items(&frames))])
}

#[test]
fn times_and_stacks_are_volumes() {
    let time = |t: u32| element(0x20, 0x9128, b"UL", &t.to_le_bytes());
    let frames = [(0.0, time(2)), (0.0, time(1)), (1.0, time(2)), (1.0, time(1))];
    assert_eq!(volumes(&[content(&frames)], 2), [[6.0, 18.0], [0.0, 12.0]]);
    // Stacks are apart, also where their places are.
    let stack = |name: &str| element(0x20, 0x9056, b"SH", name.as_bytes());
    let frames = [(0.0, stack("1")), (1.0, stack("1")), (9.0, stack("2")), (10.0, stack("2"))];
    assert_eq!(volumes(&[content(&frames)], 2), [[0.0, 6.0], [12.0, 18.0]]);
    // A dimension that only its index tells apart.
    let indices = |echo: u32, place: u32| {
        element(0x20, 0x9157, b"UL", &[echo.to_le_bytes(), place.to_le_bytes()].concat())
    };
    let frames =
        [(0.0, indices(1, 1)), (1.0, indices(1, 2)), (0.0, indices(2, 1)), (1.0, indices(2, 2))];
    let pointer = |group: u16, number: u16| {
        element(0x20, 0x9165, b"AT", &[group.to_le_bytes(), number.to_le_bytes()].concat())
    };
    let pointers = items(&[pointer(0x18, 0x9082), pointer(0x20, 0x9057)]);
    let both = content(&frames).with([(0x20, 0x9222, b"SQ", pointers)]);
    assert_eq!(volumes(&[both], 2), [[0.0, 6.0], [12.0, 18.0]]);
    // Files of one series that say when they were.
    let when = |n: i16, z: f64, t: &str| slice(n, z).with([(0x20, 0x100, b"IS", t.into())]);
    let files = [when(0, 0.0, "2"), when(1, 1.0, "2"), when(2, 0.0, "10"), when(3, 1.0, "10")];
    assert_eq!(volumes(&files, 2), [[0.0, 10.0], [20.0, 30.0]]);
    let text = series(&[slice(0, 0.0), slice(1, 0.0)]).unwrap_err();
    assert!(text.contains("two slices at one place"), "{text}");
}

/// Frames of nuclear medicine, in one file.
fn nuclear(kind: &str, count: i16, changed: Vec<super::Element>) -> Slice {
    let detector = [
        element(0x20, 0x32, b"DS", b"-10\\-20\\100"),
        element(0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0"),
    ];
    let own = [
        (8, 8, b"CS", format!("ORIGINAL\\PRIMARY\\{kind}\\EMISSION").into_bytes()),
        (8, 0x60, b"CS", b"NM".to_vec()),
        (0x20, 0x32, b"DS", Vec::new()),
        (0x20, 0x37, b"DS", Vec::new()),
        (0x28, 8, b"IS", count.to_string().into_bytes()),
        (0x54, 0x22, b"SQ", items(&[detector.concat()])),
    ];
    Slice { pixels: (0..6 * count).collect(), ..slice(0, 0.0) }.with(own).with(changed)
}

#[test]
fn nuclear_medicine_counts_its_slices() {
    let vector = |number, n: &[u16]| {
        (0x54, number, b"US", n.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>())
    };
    let step = |step: &str| (0x18, 0x88, b"DS", step.into());
    let forth = nuclear("RECON TOMO", 3, vec![step("4"), vector(0x80, &[1, 2, 3])]);
    let volume = series(&[forth]).unwrap();
    assert_eq!((volume.frame().origin[2], volume.frame().spacing[2]), (100.0, 4.0));
    assert_eq!(volume.as_slice()[6], 6.0);
    // Against the normal.
    let back = nuclear("RECON TOMO", 3, vec![step("-4"), vector(0x80, &[1, 2, 3])]);
    let volume = series(&[back]).unwrap();
    assert_eq!((volume.frame().origin[2], volume.as_slice()[0]), (92.0, 12.0));
    let gated = vec![step("4"), vector(0x80, &[1, 2, 1, 2]), vector(0x70, &[1, 1, 2, 2])];
    let gated = nuclear("RECON GATED TOMO", 4, gated);
    assert_eq!(volumes(&[gated], 2), [[0.0, 6.0], [12.0, 18.0]]);
    let text = series(&[nuclear("TOMO", 3, vec![])]).unwrap_err();
    assert!(text.contains("views or times of one place, not a volume"), "{text}");
    let text = series(&[nuclear("RECON TOMO", 3, vec![])]).unwrap_err();
    assert!(text.contains("no Spacing Between Slices"), "{text}");
}
