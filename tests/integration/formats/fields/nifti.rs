//! `NIfTI`.

use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, LengthUnit, Space};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// A header of version 1 of 3×2×2 shorts, with bytes in other places, and what follows it.
fn header(changes: &[(usize, &[u8])]) -> Vec<u8> {
    let mut bytes = vec![0; 352];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(0, &348i32.to_le_bytes());
    for (k, size) in [3i16, 3, 2, 2].into_iter().enumerate() {
        put(40 + 2 * k, &size.to_le_bytes());
    }
    put(70, &4i16.to_le_bytes());
    put(72, &16i16.to_le_bytes());
    put(108, &352f32.to_le_bytes());
    put(344, b"n+1\0");
    changes.iter().for_each(|(at, value)| put(*at, value));
    bytes
}

fn with(folder: &Path, changes: &[(usize, &[u8])]) -> PathBuf {
    save(folder, "v.nii", [header(changes), shorts()].concat())
}

fn float(value: f32) -> [u8; 4] {
    value.to_le_bytes()
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

#[test]
fn each_field_of_the_table() {
    walk(
        "NIfTI",
        &[
            Field {
                name: "`sizeof_hdr`: versions 1 and 2, byte order",
                file: |f| with(f, &[]),
                fate: Fate::Read(same),
            },
            Field {
                name: "`magic`: `n+1`, `ni1`",
                file: |f| {
                    save(f, "v.img.gz", gzip(&shorts()));
                    save(f, "v.hdr", header(&[(344, b"ni1\0"), (108, &float(0.0))]))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "no `magic` (Analyze 7.5)",
                file: |f| with(f, &[(344, &[0; 4])]),
                fate: Fate::Refused(&["Analyze 7.5", "says nothing of orientation"]),
            },
            Field {
                name: "`dim[1..3]`",
                file: |f| with(f, &[]),
                fate: Fate::Read(|path| assert_eq!(volume(path).dims().xyz(), [3, 2, 2])),
            },
            Field {
                name: "`dim[4..7]`",
                file: |f| with(f, &[(40, &[5, 0, 3, 0, 2, 0, 1, 0, 1, 0, 2, 0])]),
                fate: Fate::Read(|path| assert_eq!(frame(path, 1).as_slice()[0], 12.0)),
            },
            Field {
                name: "`datatype`, `bitpix`",
                file: |f| with(f, &[(70, &512i16.to_le_bytes())]),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::U16)),
            },
            Field {
                name: "`datatype` of bits, complex and 128-bit numbers",
                file: |f| with(f, &[(70, &32i16.to_le_bytes())]),
                fate: Fate::Refused(&["complex numbers (datatype 32)"]),
            },
            Field {
                name: "`datatype` of colours",
                file: |f| with(f, &[(70, &128i16.to_le_bytes())]),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("colours"), "{error}");
                }),
            },
            Field {
                name: "`scl_slope`, `scl_inter`",
                file: |f| with(f, &[(112, &float(0.5)), (116, &float(-1.0))]),
                fate: Fate::Read(|path| assert_eq!(volume(path).as_slice()[..3], [-1.0, 0.0, 1.0])),
            },
            Field {
                name: "`scl_slope` of 0 or NaN",
                file: |f| with(f, &[(112, &float(f32::NAN)), (116, &float(f32::NAN))]),
                fate: Fate::Read(same),
            },
            Field {
                name: "`scl_inter` that is not a number",
                file: |f| with(f, &[(112, &float(2.0)), (116, &float(f32::NAN))]),
                fate: Fate::PassedOver(&["scl_inter is NaN, and taken as 0; scl_slope is 2"]),
            },
            Field {
                name: "`vox_offset`, extensions",
                file: |f| {
                    let extended = header(&[(108, &float(368.0)), (348, &[1, 0, 0, 0])]);
                    let extension =
                        [16i32.to_le_bytes(), 6i32.to_le_bytes(), *b"a re", *b"mark"].concat();
                    save(f, "v.nii", [extended, extension, shorts()].concat())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`sform_code`, `srow_x`…",
                file: |f| {
                    let rows =
                        floats(&[-2.0, 0.0, 0.0, 4.0, 0.0, 3.0, 0.0, 5.0, 0.0, 0.0, 1.5, 6.0]);
                    with(f, &[(254, &[1, 0]), (280, &rows)])
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!((frame.spacing, frame.origin), ([2.0, 3.0, 1.5], [4.0, 5.0, 6.0]));
                    assert_eq!(
                        (frame.direction[0][0], frame.coordinates.space),
                        (-1.0, Space::Ras)
                    );
                }),
            },
            Field {
                name: "`qform_code`, `quatern_b`…, `qoffset_x`…, `pixdim`",
                // pixdim[0] turns z round.
                file: |f| with(f, &[(252, &[1, 0]), (76, &floats(&[-1.0, 2.0, 3.0, 1.5]))]),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!((frame.spacing, frame.direction[2][2]), ([2.0, 3.0, 1.5], -1.0));
                }),
            },
            Field {
                name: "`quatern_b`… longer than 1",
                file: |f| with(f, &[(252, &[1, 0]), (76, &floats(&[1.0; 4])), (256, &float(1.5))]),
                fate: Fate::PassedOver(&["longer than 1, and shortened"]),
            },
            Field {
                name: "`pixdim` below 0",
                file: |f| with(f, &[(76, &floats(&[1.0, -2.0, 2.0, 2.0]))]),
                fate: Fate::PassedOver(&["pixdim is negative, and taken without the sign"]),
            },
            Field {
                name: "`pixdim` of 0, where there is no sform",
                file: |f| with(f, &[(252, &[1, 0]), (76, &floats(&[1.0, 2.0, 2.0, 0.0]))]),
                fate: Fate::PassedOver(&["pixdim[3] is 0, and taken as 1"]),
            },
            Field {
                name: "`sform` and `qform` that disagree",
                file: |f| {
                    let rows =
                        floats(&[1.0, 0.0, 0.0, 9.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
                    with(
                        f,
                        &[(252, &[1, 0]), (254, &[1, 0]), (76, &floats(&[1.0; 4])), (280, &rows)],
                    )
                },
                fate: Fate::PassedOver(&["sform and qform place samples up to 9 mm apart"]),
            },
            Field {
                name: "`xyzt_units`",
                file: |f| with(f, &[(123, &[3 | 8]), (76, &floats(&[1.0, 2.0, 2.0, 2.0]))]),
                fate: Fate::Read(|path| {
                    assert_eq!(volume(path).frame().coordinates.unit, LengthUnit::Micrometre);
                }),
            },
            Field {
                name: "unknown `xyzt_units`",
                file: |f| with(f, &[(123, &[7])]),
                fate: Fate::PassedOver(&["its unit (xyzt_units 7) is not known"]),
            },
            Field {
                name: "`intent_code` 1002 (labels)",
                file: |f| with(f, &[(68, &1002i16.to_le_bytes())]),
                fate: Fate::Read(|path| assert!(volume(path).states_labels())),
            },
            Field {
                name: "`intent_code` of vectors and matrices, along the fifth axis",
                file: |f| {
                    let sizes = [5i16, 2, 2, 1, 1, 3].map(i16::to_le_bytes).concat();
                    with(f, &[(40, &sizes), (68, &1007i16.to_le_bytes())])
                },
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel"), "{error}");
                }),
            },
            Field {
                name: "other fields",
                // cal_max and cal_min, slice_code, toffset, descrip, dim_info.
                file: |f| {
                    let display = floats(&[9.0, 1.0]);
                    with(
                        f,
                        &[
                            (124, &display),
                            (122, &[1]),
                            (136, &float(3.0)),
                            (148, b"a head"),
                            (39, &[57]),
                        ],
                    )
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
