//! MGH.

use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, Frame, Space};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// Frames of shorts: sizes, type, and whether the place is good.
fn mgh(sizes: [i32; 4], kind: i32, placed: bool) -> Vec<u8> {
    let [x, y, z, t] = sizes;
    let whole = [1, x, y, z, t, kind, 0].map(i32::to_be_bytes).concat();
    let reals: [f32; 15] =
        [2.0, 1.0, 0.5, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 10.0, 20.0, 30.0];
    let mut bytes =
        [whole, i16::from(placed).to_be_bytes().to_vec(), reals.map(f32::to_be_bytes).concat()]
            .concat();
    bytes.resize(284, 0);
    let big = shorts();
    bytes.extend(big.chunks(2).flat_map(|pair| [pair[1], pair[0]]));
    bytes
}

fn with(folder: &Path, sizes: [i32; 4], kind: i32, placed: bool) -> PathBuf {
    save(folder, "v.mgh", mgh(sizes, kind, placed))
}

#[test]
fn each_field_of_the_table() {
    walk(
        "MGH (FreeSurfer)",
        &[
            Field {
                name: "`width`, `height`, `depth`",
                file: |f| with(f, [3, 2, 2, 1], 4, true),
                fate: Fate::Read(same),
            },
            Field {
                name: "`nframes`",
                file: |f| with(f, [3, 2, 1, 2], 4, true),
                fate: Fate::Read(|path| assert_eq!(frame(path, 1).as_slice()[0], 12.0)),
            },
            Field {
                name: "`type`: 0, 1, 3, 4, 10",
                file: |f| with(f, [3, 2, 2, 1], 4, true),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::I16)),
            },
            Field {
                name: "other `type`",
                file: |f| with(f, [3, 2, 2, 1], 5, true),
                fate: Fate::Refused(&["samples of type 5"]),
            },
            Field {
                name: "`version` other than 1",
                file: |f| {
                    let mut bytes = mgh([3, 2, 2, 1], 4, true);
                    bytes[3] = 2;
                    save(f, "v.mgh", bytes)
                },
                fate: Fate::Refused(&["its version is 2"]),
            },
            Field {
                name: "`spacing`, direction cosines, `c_ras`",
                file: |f| with(f, [3, 2, 2, 1], 4, true),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing, frame.coordinates.space),
                        ([2.0, 1.0, 0.5], Space::Ras)
                    );
                    assert_eq!(frame.to_world([1.5, 1.0, 1.0]), [10.0, 20.0, 30.0]);
                }),
            },
            Field {
                name: "`goodRASFlag` 0",
                file: |f| with(f, [3, 2, 2, 1], 4, false),
                fate: Fate::Read(|path| assert_eq!(*volume(path).frame(), Frame::VOXEL)),
            },
            Field {
                name: "other fields",
                // dof, and scan parameters and tags behind the samples.
                file: |f| {
                    let mut bytes = mgh([3, 2, 2, 1], 4, true);
                    bytes[27] = 1;
                    bytes.extend([2300f32, 0.1, 3.0, 900.0, 0.0].map(f32::to_be_bytes).concat());
                    save(f, "v.mgh", bytes)
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
