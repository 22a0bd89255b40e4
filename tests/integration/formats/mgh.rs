//! `FreeSurfer`'s volumes.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use walpha::volume::{Dtype, ReadOptions, Source, Space, read};

use super::files::save;
use crate::common::told::Told;
use crate::common::{fails, json};

/// Frames of 2×3×2 samples of a type, 0, 1, 2, …
fn mgh(kind: i32, frames: i32, placed: bool, sample: impl Fn(u8) -> Vec<u8>) -> Vec<u8> {
    let whole = [1, 2, 3, 2, frames, kind, 0].map(i32::to_be_bytes).concat();
    // x runs to the left, y down, z to the front, as `FreeSurfer` has it.
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
            read(&save(f, name, bytes), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
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
        read(&save(f, "n.mgh", mgh(3, 1, false, float)), &ReadOptions::default()).unwrap();
    assert_eq!(*unplaced.frame(), walpha::Frame::VOXEL);
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
