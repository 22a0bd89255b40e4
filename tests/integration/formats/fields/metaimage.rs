//! `MetaImage`.

use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, LengthUnit};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// A file with further lines in its header.
fn with(folder: &Path, lines: &str) -> PathBuf {
    file(folder, lines, &shorts())
}

fn file(folder: &Path, lines: &str, samples: &[u8]) -> PathBuf {
    let header = format!("{MHA}{lines}ElementDataFile = LOCAL\n");
    save(folder, "v.mha", [header.as_bytes(), samples].concat())
}

fn big() -> Vec<u8> {
    shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect()
}

#[test]
fn each_field_of_the_table() {
    walk(
        "MetaImage",
        &[
            Field {
                name: "`=` or `:` behind a name",
                file: |f| {
                    let header =
                        MHA.replace(" =", ":") + "Comment: a = b\nElementDataFile: LOCAL\n";
                    save(f, "v", [header.as_bytes(), &shorts()].concat())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`NDims`, `DimSize`",
                file: |f| with(f, ""),
                fate: Fate::Read(|path| assert_eq!(volume(path).dims().xyz(), [3, 2, 2])),
            },
            Field {
                name: "`NDims` above 4",
                file: |f| {
                    let header =
                        MHA.replace("NDims = 3", "NDims = 5") + "ElementDataFile = LOCAL\n";
                    save(f, "v.mha", [header.as_bytes(), &shorts()].concat())
                },
                fate: Fate::Refused(&["NDims = 5", "save it with 3 axes"]),
            },
            Field {
                name: "`ObjectType` other than `Image`",
                file: |f| {
                    let header = MHA.replace("Image", "Tube") + "ElementDataFile = LOCAL\n";
                    save(f, "v.mha", [header.as_bytes(), &shorts()].concat())
                },
                fate: Fate::Refused(&["object of type Tube"]),
            },
            Field {
                name: "`ElementType`",
                file: |f| with(f, ""),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::I16)),
            },
            Field {
                name: "`ElementNumberOfChannels`",
                file: |f| with(f, "ElementNumberOfChannels = 3\n"),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel"), "{error}");
                }),
            },
            Field {
                name: "`BinaryDataByteOrderMSB`, `ElementByteOrderMSB`",
                // The former goes before the latter, and flags begin with T, t or 1.
                file: |f| {
                    file(f, "ElementByteOrderMSB = False\nBinaryDataByteOrderMSB = t\n", &big())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`BinaryData`",
                file: |f| {
                    let text = numbers().iter().map(f32::to_string).collect::<Vec<_>>().join(" ");
                    file(f, "BinaryData = False\n", text.as_bytes())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`CompressedData`, `CompressedDataSize`",
                file: |f| {
                    let packed = zlib(&shorts());
                    file(
                        f,
                        &format!("CompressedData = 1\nCompressedDataSize = {}\n", packed.len()),
                        &packed,
                    )
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`ElementSpacing`, `ElementSize`",
                file: |f| with(f, "ElementSize = 1 1 1\nElementSpacing = 0.5 0.6 2.5\n"),
                fate: Fate::Read(|path| assert_eq!(volume(path).frame().spacing, [0.5, 0.6, 2.5])),
            },
            Field {
                name: "`ImagePosition`, `Origin`, `Offset`, `Position`",
                file: |f| with(f, "Position = 1 2 3\nOffset = 4 5 6\n"),
                fate: Fate::Read(|path| assert_eq!(volume(path).frame().origin, [4.0, 5.0, 6.0])),
            },
            Field {
                name: "`TransformMatrix`, `Rotation`, `Orientation`",
                file: |f| {
                    with(f, "Rotation = 1 0 0 0 1 0 0 0 1\nTransformMatrix = 0 1 0 1 0 0 0 0 -1\n")
                },
                fate: Fate::Read(|path| {
                    let axes = volume(path).frame().axes();
                    assert_eq!(axes, [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]);
                }),
            },
            Field {
                name: "synonyms that disagree",
                file: |f| with(f, "Position = 1 2 3\nOffset = 4 5 6\n"),
                fate: Fate::PassedOver(&[
                    "Offset = 4 5 6 is taken",
                    "Position, which says otherwise",
                ]),
            },
            Field {
                name: "`DistanceUnits`",
                file: |f| with(f, "ElementSpacing = 1 1 1\nDistanceUnits = um\n"),
                fate: Fate::Read(|path| {
                    assert_eq!(volume(path).frame().coordinates.unit, LengthUnit::Micrometre);
                }),
            },
            Field {
                name: "`AnatomicalOrientation` without a matrix",
                file: |f| with(f, "AnatomicalOrientation = LPS\n"),
                fate: Fate::PassedOver(&["AnatomicalOrientation = LPS"]),
            },
            Field {
                name: "`CenterOfRotation`",
                file: |f| with(f, "CenterOfRotation = 5 5 5\n"),
                fate: Fate::PassedOver(&["CenterOfRotation = 5 5 5"]),
            },
            Field {
                name: "`ElementToIntensityFunctionSlope`, `…Offset`",
                file: |f| with(f, "ElementToIntensityFunctionSlope = 2\n"),
                fate: Fate::PassedOver(&["ElementToIntensityFunctionSlope"]),
            },
            Field {
                name: "`HeaderSize`",
                file: |f| file(f, "HeaderSize = -1\n", &[b"junk", &shorts()[..]].concat()),
                fate: Fate::Read(same),
            },
            Field {
                name: "`ElementDataFile`",
                // The last number and the step may be left out.
                file: |f| {
                    save(f, "s1.raw", &shorts()[..12]);
                    save(f, "s2.raw", &shorts()[12..]);
                    save(f, "v.mhd", format!("{MHA}ElementDataFile = s%d.raw 1\n"))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "a fourth axis",
                file: |f| {
                    let header = MHA.replace("NDims = 3", "NDims = 4").replace("3 2 2", "3 2 1 2");
                    let header = header + "ElementDataFile = LOCAL\n";
                    save(f, "v.mha", [header.as_bytes(), &shorts()].concat())
                },
                fate: Fate::Read(|path| assert_eq!(frame(path, 1).as_slice()[0], 12.0)),
            },
            Field {
                name: "other fields",
                file: |f| {
                    with(
                        f,
                        "Comment = a head\nModality = MET_MOD_CT\nElementMin = 0\nElementMax = 9\nSequenceID = 0 0 0\n\
                             AcquisitionDate = 2026.11.27\nName = n\nID = 1\nParentID = 2\nColor = 1 1 1 1\n\
                             AnatomicalOrientation = RAI\nCenterOfRotation = 0 0 0\n",
                    )
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
