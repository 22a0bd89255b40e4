//! Outputs contain the values of the file, and selections can be stated in them.

use std::path::Path;

use serde_json::Value;
use walpha::volume::{ReadOptions, Source};

use super::files::*;
use crate::common::{json, ok, run};

/// A block of bone (1200) in water (0) in air (−1000): Hounsfield units, as NRRD of 12³ shorts.
fn head(folder: &Path) -> Vec<i16> {
    let value = |i: i16| {
        let from_middle = [i % 12, i / 12 % 12, i / 144].map(|x| (2 * x - 11).abs() / 2);
        match from_middle.into_iter().max().unwrap() {
            0..=1 => 1200 - 7 * (i % 5),
            2..=3 => i % 3,
            _ => -1000,
        }
    };
    let values: Vec<i16> = (0..1728).map(value).collect();
    let header = "NRRD0004\ntype: short\ndimension: 3\nsizes: 12 12 12\nendian: little\nencoding: raw\n\
                  space: LPS\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,1.5)\n\
                  space origin: (1,2,3)\n\n";
    let samples: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    save(folder, "head.nrrd", [header.as_bytes(), &samples].concat());
    values
}

fn numbers_of(folder: &Path, name: &str) -> Vec<f32> {
    let array: ndarray::Array3<f32> = ndarray_npy::read_npy(folder.join(name)).unwrap();
    array.into_raw_vec_and_offset().0
}

#[test]
fn values_of_the_file_go_out() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let values = head(f);
    let facts = json(f, &["haar", "head.nrrd", "--rms", "0", "-o", "out.npy"]);
    let whole: Vec<f32> = values.iter().map(|&v| f32::from(v)).collect();
    assert_eq!(numbers_of(f, "out.npy"), whole);
    assert_eq!(facts["haar"]["rms_in_values"], 0.0);
    ok(f, &["haar", "head.nrrd", "--rms", "0", "--gray-out", "-o", "gray.npy"]);
    let gray = numbers_of(f, "gray.npy");
    assert_eq!((gray[0], gray.iter().copied().fold(0.0, f32::max)), (0.0, 255.0));

    ok(f, &["points", "head.nrrd", "--ratio", "1", "-o", "p.csv"]);
    let text = std::fs::read_to_string(f.join("p.csv")).unwrap();
    let column: Vec<f32> = text
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(column, whole);

    // A gray level is 2200/255 Hounsfield units.
    let step = 2200.0 / 255.0;
    let facts = json(f, &["haar", "head.nrrd", "--rms", "2"]);
    let [rms, in_values] = ["rms", "rms_in_values"].map(|k| facts["haar"][k].as_f64().unwrap());
    assert!(rms > 0.0 && (in_values / rms - step).abs() < 1e-9);
    let options = ["interpolate", "head.nrrd", "--ratio", "0.3", "--fill", "-o", "f.npy"];
    let facts = json(f, &options);
    let error = &facts["interpolation"]["filled"];
    let [rmse, in_values] = ["rmse", "rmse_in_values"].map(|k| error[k].as_f64().unwrap());
    assert!(rmse > 0.0 && (in_values / rmse - step).abs() < 1e-9);
    let squares =
        numbers_of(f, "f.npy").into_iter().zip(&whole).map(|(a, b)| f64::from(a - b).powi(2));
    let measured = (squares.sum::<f64>() / 1728.0).sqrt();
    assert!((measured - in_values).abs() < 1e-3 * in_values, "{measured}, not {in_values}");
    let told = ok(f, &options);
    assert!(told.contains("gray levels (") && told.contains("in values)"), "{told}");

    // 8-bit values are gray levels, and nothing is told twice.
    let facts = json(f, &["haar", "sample:phantom@8"]);
    assert_eq!(facts["haar"]["rms_in_values"], Value::Null);
}

#[test]
fn selection_and_isovalue_can_be_said_in_values() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    head(f);
    let select = |options: &[&str]| {
        ok(f, &[&["points", "head.nrrd", "--threshold", "1", "-o", "p.csv"], options].concat());
        std::fs::read_to_string(f.join("p.csv")).unwrap()
    };
    let gray = (300.0 + 1000.0) * 255.0 / 2200.0;
    let by_value = select(&["--value-min", "300"]);
    assert_eq!(by_value, select(&["--gray-min", &gray.to_string()]));
    assert!(by_value.lines().count() > 8 && by_value != select(&[]));
    let page = |isovalue: &str| {
        ok(
            f,
            &[
                "view",
                "head.nrrd",
                "--ratio",
                "0.3",
                "--alphas",
                "1,inf",
                "--isovalue",
                isovalue,
                "-o",
                "v.html",
            ],
        );
        std::fs::read_to_string(f.join("v.html")).unwrap()
    };
    let by_value = page("300v");
    assert_eq!(by_value, page(&gray.to_string()));
    assert!(by_value != page("300"));
    let (code, _, error) = run(f, &["view", "head.nrrd", "-o", "v.html", "--isovalue", "bone"]);
    assert!(code == 2 && error.contains("bone"), "{error}");
    let both = ["points", "head.nrrd", "--gray-min", "1", "--value-min", "1"];
    assert_eq!(run(f, &both).0, 2);
}

/// A file of each format that holds integers of 32 or 64 bits, all 0 but the first. It has a name and what makes a file of
/// that number.
type OfNumber = (&'static str, fn(i32) -> Vec<u8>);

fn integers(first: i32) -> Vec<u8> {
    let all = std::iter::once(first).chain([0; 11]);
    all.flat_map(i32::to_le_bytes).collect()
}

fn text(first: i32) -> Vec<u8> {
    format!("{first} 0 0 0 0 0 0 0 0 0 0 0").into_bytes()
}

fn tiff_of(first: i32) -> Vec<u8> {
    use tiff::encoder::{TiffEncoder, colortype::GrayI32};
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    encoder.write_image::<GrayI32>(3, 2, &[first, 0, 0, 0, 0, 0]).unwrap();
    bytes.into_inner()
}

fn npy_of(descr: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (2, 2, 3)}}\n");
    [b"\x93NUMPY\x01\0", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), numbers]
        .concat()
}

#[test]
fn whole_numbers_that_are_rounded_are_said() {
    let wide: [OfNumber; 10] = [
        ("a.npy", |first| npy_of("<i4", &integers(first))),
        ("b.npy", |first| {
            let all = std::iter::once(first.into()).chain([0; 11]);
            npy_of("<i8", &all.flat_map(i64::to_le_bytes).collect::<Vec<u8>>())
        }),
        ("c.npy", |first| {
            let all = std::iter::once(first.into()).chain([0.0; 11]);
            npy_of("<f8", &all.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
        }),
        ("a.nrrd", |first| nrrd(|h| h.replace("short", "int"), &integers(first))),
        ("b.nrrd", |first| {
            nrrd(|h| h.replace("short", "int").replace("raw", "text"), &text(first))
        }),
        ("a.mha", |first| {
            let header = MHA.replace("SHORT", "INT") + "ElementDataFile = LOCAL\n";
            [header.as_bytes(), &integers(first)].concat()
        }),
        ("a.vti", |first| {
            let text = String::from_utf8(text(first)).unwrap();
            let file = vti("", &format!("format=\"ascii\">{text}"), b"");
            String::from_utf8(file).unwrap().replace("Int16", "Int32").into_bytes()
        }),
        ("a.vtk", |first| [VTK.replace("short", "int").as_bytes(), &text(first)].concat()),
        ("a.inr", |first| {
            let header = "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nTYPE=signed fixed\nPIXSIZE=32 bits\nCPU=decm\n";
            let filled = format!("{header:\n<252}##}}\n");
            [filled.as_bytes(), &integers(first)].concat()
        }),
        ("a.tif", tiff_of),
    ];
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let said = |name: &str| {
        let facts = json(f, &["info", name]);
        let warnings = facts["warnings"].as_array().cloned().unwrap_or_default();
        warnings.iter().filter(|warning| warning.to_string().contains("are rounded")).count()
    };
    for (name, file) in wide {
        for (first, times) in [((1 << 24) + 1, 1), (1 << 24, 0), (1 << 30, 0), (-3 - (1 << 25), 1)]
        {
            save(f, name, file(first));
            assert_eq!(said(name), times, "{name}: {first}");
        }
    }
    // Scaled numbers are not whole ones.
    save(f, "d.npy", npy_of("<f8", &[16777217.5f64; 12].map(f64::to_le_bytes).concat()));
    assert_eq!(said("d.npy"), 0);
    // The message also appears, once, if the file is read in parts.
    save(f, "a.npy", npy_of("<i4", &integers((1 << 24) + 1)));
    let source = Source::open(f.join("a.npy"), &ReadOptions::default()).unwrap();
    assert_eq!(source.read([0; 3], [1; 3]).unwrap(), [16777216.0]);
}
