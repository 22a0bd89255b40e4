//! NRRD.

use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, LengthUnit, Space};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// A file with further lines in its header.
fn with(folder: &Path, lines: &str) -> PathBuf {
    save(folder, "v.nrrd", nrrd(|header| header + lines, &shorts()))
}

/// A file with another line in place of one.
fn instead(folder: &Path, from: &str, to: &str) -> PathBuf {
    save(folder, "v.nrrd", nrrd(|header| header.replace(from, to), &shorts()))
}

#[test]
fn each_field_of_the_table() {
    walk(
        "NRRD",
        &[
            Field {
                name: "`sizes`, `dimension`",
                file: |f| with(f, ""),
                fate: Fate::Read(|path| assert_eq!(volume(path).dims().xyz(), [3, 2, 2])),
            },
            Field {
                name: "`type`",
                file: |f| instead(f, "type: short", "type: unsigned short int"),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::U16)),
            },
            Field {
                name: "`type: block`",
                file: |f| instead(f, "type: short", "type: block"),
                fate: Fate::Refused(&["type block", "convert it first"]),
            },
            Field {
                name: "`endian`",
                file: |f| {
                    let big: Vec<u8> =
                        shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
                    save(f, "v.nrrd", nrrd(|header| header.replace("little", "big"), &big))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`endian` that is missing",
                file: |f| instead(f, "endian: little\n", ""),
                fate: Fate::Refused(&["endian: (missing)", "correct its header"]),
            },
            Field {
                name: "`encoding`: `raw`, `text`, `gzip`, `bzip2`",
                file: |f| {
                    save(f, "v.nrrd", nrrd(|header| header.replace("raw", "gz"), &gzip(&shorts())))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`encoding: hex`",
                file: |f| instead(f, "raw", "hex"),
                fate: Fate::Refused(&["encoded as hex", "save it as raw or gzip"]),
            },
            Field {
                name: "`kinds`",
                file: |f| with(f, "kinds: domain domain time\n"),
                fate: Fate::Read(|path| {
                    let second = frame(path, 1);
                    assert_eq!((second.dims().xyz(), second.as_slice()[0]), ([3, 2, 1], 12.0));
                }),
            },
            Field {
                name: "`space directions`",
                // An axis without a direction is not one of space, regardless of its kind.
                file: |f| with(f, "space dimension: 3\nspace directions: (2,0,0) (0,0,3) none\n"),
                fate: Fate::Read(|path| {
                    let second = frame(path, 1);
                    assert_eq!(second.dims().xyz(), [3, 2, 1]);
                    // A slice has a direction across it.
                    let axes = [[2.0, 0.0, 0.0], [0.0, 0.0, 3.0], [0.0, -1.0, 0.0]];
                    assert_eq!(second.frame().axes(), axes);
                }),
            },
            Field {
                name: "axes of colours, vectors or lists",
                file: |f| with(f, "space directions: none (1,0,0) (0,1,0)\n"),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel (axis 0 is not spatial)"), "{error}");
                }),
            },
            Field {
                name: "`space`, `space origin`",
                file: |f| {
                    with(
                        f,
                        "space: RAST\nspace directions: (1,0,0,0) (0,1,0,0) (0,0,1,0)\nspace origin: (4,5,6,0)\n",
                    )
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.coordinates.space, frame.origin),
                        (Space::Ras, [4.0, 5.0, 6.0])
                    );
                }),
            },
            Field {
                name: "`space` without a patient",
                file: |f| {
                    with(f, "space: 3D-left-handed\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n")
                },
                fate: Fate::PassedOver(&["3d-left-handed", "passed over"]),
            },
            Field {
                name: "`space units`, `units`",
                file: |f| with(f, "spacings: 1 2 3\nunits: \"mm\" \"mm\" \"um\"\n"),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(frame.coordinates.unit, LengthUnit::Millimetre);
                    assert_eq!(frame.spacing, [1.0, 2.0, 0.003]);
                }),
            },
            Field {
                name: "a unit that is not a length",
                file: |f| with(f, "spacings: 1 2 3\nunits: \"furlong\" \"furlong\" \"furlong\"\n"),
                fate: Fate::PassedOver(&["furlong"]),
            },
            Field {
                name: "`spacings`, `axis mins`, `axis maxs`, `centers`",
                file: |f| {
                    with(
                        f,
                        "spacings: 2 NaN 1\naxis mins: 5 0 0\naxis maxs: NaN 3 NaN\ncenters: node node cell\n",
                    )
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!((frame.spacing, frame.origin), ([2.0, 3.0, 1.0], [5.0, 0.0, 0.5]));
                }),
            },
            Field {
                name: "`byte skip`",
                file: |f| {
                    let junk = [b"junk", &shorts()[..]].concat();
                    save(f, "v.nrrd", nrrd(|header| header + "byte skip: 4\n", &junk))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`line skip`",
                file: |f| with(f, "line skip: 1\n"),
                fate: Fate::Refused(&["line skip: 1 is not read"]),
            },
            Field {
                name: "`data file`",
                file: |f| {
                    save(f, "s0.raw", &shorts()[..12]);
                    save(f, "s1.raw", &shorts()[12..]);
                    save(f, "v.nhdr", format!("{NRRD}data file: LIST 2\ns0.raw\ns1.raw\n"))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "axes beyond the third",
                file: |f| {
                    let header =
                        |header: String| header.replace("3\nsizes: 3 2 2", "4\nsizes: 3 2 2 2");
                    save(f, "v.nrrd", nrrd(header, &[vec![0; 24], shorts()].concat()))
                },
                fate: Fate::Read(|path| assert_eq!(frame(path, 1).as_slice(), numbers())),
            },
            Field {
                name: "four axes without `kinds` or `space directions`",
                file: |f| {
                    let four = |header: String| {
                        header.replace("dimension: 3", "dimension: 4").replace("3 2 2", "3 2 2 2")
                    };
                    save(f, "v.nrrd", nrrd(four, &[shorts(), shorts()].concat()))
                },
                fate: Fate::PassedOver(&["first three", "x, y and z"]),
            },
            Field {
                name: "`old min`, `old max`",
                file: |f| with(f, "old min: -1\nold max: 1\n"),
                fate: Fate::PassedOver(&["old min and old max"]),
            },
            Field {
                name: "fields that NRRD does not have",
                file: |f| with(f, "spacing: 1 2 3\n"),
                fate: Fate::PassedOver(&["spacing", "none of NRRD's"]),
            },
            Field {
                name: "`Segment0_…`, of 3D Slicer",
                file: |f| {
                    with(f, "Segment0_ID:=Segment_1\nSegment0_LabelValue:=2\nSegment0_Layer:=0\n")
                },
                fate: Fate::Read(|path| assert!(volume(path).states_labels())),
            },
            Field {
                name: "other fields",
                file: |f| {
                    with(
                        f,
                        "content: a head\nthicknesses: 9 9 9\nlabels: \"a\" \"b\" \"c\"\nnumber: 12\nsample units: \"HU\"\n\
                             min: 0\nmax: 9\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n",
                    )
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
