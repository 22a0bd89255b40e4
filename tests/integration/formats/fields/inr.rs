//! INRIMAGE.

use std::path::{Path, PathBuf};

use walpha::volume::Dtype;

use super::volumes::{same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

fn with(folder: &Path, lines: &str) -> PathBuf {
    instead(folder, "", "", lines)
}

fn instead(folder: &Path, from: &str, to: &str, lines: &str) -> PathBuf {
    let header =
        "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nTYPE=signed fixed\nPIXSIZE=16 bits\nCPU=decm\n";
    let header = if from.is_empty() { header.to_owned() } else { header.replace(from, to) };
    save(folder, "v.inr", [header.as_bytes(), lines.as_bytes(), b"\n##}\n", &shorts()].concat())
}

#[test]
fn each_field_of_the_table() {
    walk(
        "INRIMAGE",
        &[
            Field { name: "`XDIM`, `YDIM`, `ZDIM`", file: |f| with(f, ""), fate: Fate::Read(same) },
            Field {
                name: "`TYPE`, `PIXSIZE`",
                file: |f| with(f, ""),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::I16)),
            },
            Field {
                name: "`VDIM` above 1",
                file: |f| with(f, "VDIM=3\n"),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel (VDIM)"), "{error}");
                }),
            },
            Field { name: "`CPU`", file: |f| with(f, ""), fate: Fate::Read(same) },
            Field {
                name: "other `CPU`, or none",
                file: |f| instead(f, "decm", "vax", ""),
                fate: Fate::Refused(&["CPU=vax is not a byte order"]),
            },
            Field {
                name: "`VX`, `VY`, `VZ`, `TX`, `TY`, `TZ`",
                file: |f| with(f, "VX=0.5\nVY=2\nVZ=3\nTX=7\n"),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!((frame.spacing, frame.origin), ([0.5, 2.0, 3.0], [7.0, 0.0, 0.0]));
                }),
            },
            Field {
                name: "`RX`, `RY`, `RZ`",
                file: |f| with(f, "RX=0.5\n"),
                fate: Fate::Refused(&["rotated axes (RX)"]),
            },
            Field {
                name: "`SCALE`",
                file: |f| with(f, "SCALE=2**-4\n"),
                fate: Fate::PassedOver(&["SCALE=2**-4", "as stored"]),
            },
            Field {
                name: "`XO`, `YO`, `ZO`",
                file: |f| with(f, "XO=3\n"),
                fate: Fate::PassedOver(&["XO=3"]),
            },
            Field {
                name: "other fields",
                file: |f| with(f, "# a remark\nSCALE=2**0\nXO=0\nPATIENT=nobody\n"),
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
