//! Files of several arrays or volumes, samples that are NaN, parts of a volume, and standard input.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use walpha::volume::{Nan, ReadOptions, read};

use super::files::*;
use crate::common::Told;
use crate::common::{json, ok, run};

/// Two volumes of 3×2×2 shorts, the second the ten-fold of the first.
fn two() -> Vec<u8> {
    let ten: Vec<u8> = (0..12i16).flat_map(|i| (20 * i).to_le_bytes()).collect();
    [shorts(), ten].concat()
}

#[test]
fn one_of_several_volumes_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let nrrd = NRRD.replace("dimension: 3\nsizes: 3 2 2", "dimension: 4\nsizes: 3 2 2 2");
    let mha = MHA.replace("NDims = 3\nDimSize = 3 2 2", "NDims = 4\nDimSize = 3 2 2 2");
    let mha = format!("{mha}ElementSpacing = 1 2 3 4\nElementDataFile = LOCAL\n");
    let mut nifti = vec![0; 352];
    nifti[..4].copy_from_slice(&348i32.to_le_bytes());
    for (k, size) in [4i16, 3, 2, 2, 2].into_iter().enumerate() {
        nifti[40 + 2 * k..][..2].copy_from_slice(&size.to_le_bytes());
    }
    nifti[70..72].copy_from_slice(&4i16.to_le_bytes());
    nifti[108..112].copy_from_slice(&352f32.to_le_bytes());
    nifti[344..348].copy_from_slice(b"n+1\0");
    let mut npy = Vec::new();
    let array: Vec<i16> = two().chunks(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect();
    let array = ndarray::Array4::from_shape_vec((2, 2, 2, 3), array).unwrap();
    ndarray_npy::WriteNpyExt::write_npy(&array, &mut npy).unwrap();
    let text: Vec<String> = array.iter().map(i16::to_string).collect();
    let with = |head: &str, payload: &[u8]| [head.as_bytes(), payload].concat();
    for (name, bytes) in [
        ("a.nrrd", with(&format!("{nrrd}\n"), &two())),
        ("b.nrrd", with(&format!("{}\n", nrrd.replace("raw", "gzip")), &gzip(&two()))),
        ("c.nrrd", with(&format!("{}\n", nrrd.replace("raw", "text")), text.join(" ").as_bytes())),
        ("a.mha", with(&mha, &two())),
        ("a.nii", [nifti.clone(), two()].concat()),
        ("a.nii.gz", gzip(&[nifti, two()].concat())),
        ("a.npy", npy),
    ] {
        let path = save(folder.path(), name, bytes);
        let frame = |frame| read(&path, &ReadOptions::default().frame(frame));
        let expected = |factor: f32| numbers().iter().map(|v| factor * v).collect::<Vec<_>>();
        assert_eq!(frame(Some(0)).unwrap().as_slice(), expected(1.0), "{name}");
        assert_eq!(frame(Some(1)).unwrap().as_slice(), expected(10.0), "{name}");
        for wrong in [None, Some(2)] {
            let error = frame(wrong).unwrap_err().told();
            assert!(error.contains(name) && error.contains("`frame`, from 0 to 1"), "{error}");
        }
    }
    let one = save(folder.path(), "v.vtk", VTK);
    let options = ReadOptions::default().frame(0);
    assert!(read(&one, &options).unwrap_err().told().contains("omit `frame`"));
}

#[test]
fn channels_and_times_of_a_tiff_are_volumes() {
    let folder = tempfile::tempdir().unwrap();
    let sizes = "SizeZ=\"3\" SizeC=\"2\" SizeT=\"2\"";
    let ome = |order| format!("<OME><Image><Pixels {order} {sizes}/></Image></OME>");
    // The page of a slice, channel and time.
    type Page = fn(u64, u64, u64) -> u64;
    let cases: [(String, Page); 3] = [
        ("ImageJ=1.53\nimages=12\nchannels=2\nslices=3\nframes=2\n".into(), |z, c, t| {
            (3 * t + z) * 2 + c
        }),
        (ome("DimensionOrder=\"XYTZC\""), |z, c, t| (3 * c + z) * 2 + t),
        (ome(""), |z, c, t| (2 * t + c) * 3 + z),
    ];
    for (description, page) in cases {
        let path = save(folder.path(), "v.tif", tiff(12, Some(&description)));
        let frame = |frame| read(&path, &ReadOptions::default().frame(frame));
        for k in 0..4 {
            let volume = frame(Some(k)).unwrap();
            assert_eq!(volume.dims().xyz(), [3, 2, 3]);
            let pages = (0..3).map(|z| page(z, k % 2, k / 2));
            let expected: Vec<f32> =
                pages.flat_map(|page| (0..6).map(move |i| (2 * (6 * page + i)) as f32)).collect();
            assert_eq!(volume.as_slice(), expected, "{description} {k}");
        }
        let error = frame(None).unwrap_err().told();
        assert!(error.contains("4 volumes") && error.contains("`frame`, from 0 to 3"), "{error}");
        // Too few pages, and the first volume whole.
        let path = save(folder.path(), "few.tif", tiff(11, Some(&description)));
        let last = ReadOptions::default().frame(3);
        assert!(read(&path, &last).unwrap_err().told().contains("fewer pages"));
    }
}

#[test]
fn arrays_are_read_by_name_and_points_come_before_cells() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text = |factor: i32, n: i32| {
        (0..n).map(|i| (factor * i).to_string()).collect::<Vec<_>>().join(" ")
    };
    let grid = VTK.split_once("POINT_DATA").unwrap().0;
    let ascii = format!(
        "{grid}CELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\n{}\nPOINT_DATA 12\n\
         VECTORS v float\n{}\nSCALARS p short\nLOOKUP_TABLE default\n{}\nFIELD more 2\n\
         q 1 12 short\n{}\nr 1 12 int\n{}\n",
        text(7, 2),
        text(1, 36),
        text(2, 12),
        text(3, 12),
        text(4, 12)
    );
    save(f, "a.vtk", &ascii);
    let big =
        |factor: i16, n: i16| (0..n).flat_map(|i| (factor * i).to_be_bytes()).collect::<Vec<u8>>();
    let head = grid.replace("ASCII", "BINARY");
    let binary = [
        head.as_bytes(),
        b"CELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\n",
        &big(7, 2),
        b"\nPOINT_DATA 12\nSCALARS p short\nLOOKUP_TABLE default\n",
        &big(2, 12),
        b"\nFIELD more 1\nq 1 12 short\n",
        &big(3, 12),
        b"\n",
    ];
    save(f, "b.vtk", binary.concat());
    let array = |name: &str, n| {
        format!(
            "<DataArray type=\"Int16\" Name=\"{name}\" format=\"ascii\">{}</DataArray>",
            text(n, if name == "c" { 2 } else { 12 })
        )
    };
    let vti = format!(
        "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 2 0 1 0 1\">\
         <Piece Extent=\"0 2 0 1 0 1\"><CellData>{}</CellData><PointData Scalars=\"p\">{}{}</PointData>\
         </Piece></ImageData></VTKFile>\n",
        array("c", 7),
        array("q", 3),
        array("p", 2)
    );
    save(f, "a.vti", vti);
    for name in ["a.vtk", "b.vtk", "a.vti"] {
        let max = |options: &[&str]| json(f, &[&["info", name], options].concat())["max"].clone();
        assert_eq!(max(&[]), 22.0, "{name}");
        assert_eq!(max(&["--array", "q"]), 33.0, "{name}");
        assert_eq!(max(&["--array", "c"]), 7.0, "{name}");
        let (code, _, said) = run(f, &["info", name]);
        assert!(
            code == 0 && said.contains("c (of cells)") && said.contains("--array names another"),
            "{said}"
        );
        let (code, _, said) = run(f, &["info", name, "--array", "x"]);
        assert!(code == 1 && said.contains("no array \"x\""), "{said}");
    }
    assert_eq!(json(f, &["info", "a.vtk", "--array", "r"])["max"], 44.0);
    let (code, _, said) = run(f, &["haar", "a.vtk", "--array", "v"]);
    assert!(code == 1 && said.contains("3 values a voxel"), "{said}");
    let arrays =
        [("a", 1.0f32), ("b", 2.0)].map(|(n, v)| (n, ndarray::Array3::from_elem((2, 2, 2), v)));
    save(f, "a.npz", npz(&arrays.each_ref().map(|(n, a)| (*n, a))));
    assert_eq!(json(f, &["info", "a.npz", "--array", "b"])["max"], 2.0);
}

#[test]
fn packed_with_bzip2_and_lz4() {
    let folder = tempfile::tempdir().unwrap();
    let mut packed = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
    packed.write_all(&shorts()).unwrap();
    let packed = packed.finish().unwrap();
    let nrrd = nrrd(|h| h.replace("raw", "bzip2"), &packed);
    assert_eq!(open(&save(folder.path(), "a.nrrd", &nrrd)).unwrap().as_slice(), numbers());
    refuses("cut.nrrd", &nrrd[..nrrd.len() - 9], &["bzip2"]);

    let packed = lz4_flex::block::compress(&shorts());
    let blocks = [1u32, 24, 0, packed.len() as u32].map(u32::to_le_bytes).concat();
    let inline = format!("format=\"binary\">{}{}", base64(&blocks), base64(&packed));
    let vti = vti("compressor=\"vtkLZ4DataCompressor\" header_type=\"UInt32\"", &inline, b"");
    assert_eq!(open(&save(folder.path(), "a.vti", vti)).unwrap().as_slice(), numbers());
}

#[test]
fn samples_that_are_nan_are_replaced_or_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut samples =
        ndarray::Array3::from_shape_fn((8, 8, 8), |(z, y, x)| ((x * y + z) % 7 * 9) as f32);
    samples.slice_mut(ndarray::s![.., .., 0..2]).fill(f32::NAN);
    let mut bytes = Vec::new();
    ndarray_npy::WriteNpyExt::write_npy(&samples, &mut bytes).unwrap();
    let path = save(f, "n.npy", bytes);
    assert!(open(&path).unwrap_err().told().contains("`nan` VALUE"));
    let with = |nan| read(&path, &ReadOptions::default().nan(nan)).unwrap();
    let replaced = with(Nan::Value(-5.0));
    assert!(replaced.as_slice()[0] == -5.0 && !replaced.has_missing());
    let masked = with(Nan::Mask);
    assert!(masked.is_missing(1) && !masked.is_missing(2) && masked.as_slice()[0] == 0.0);

    let least = |options: &[&str]| {
        ok(f, &[&["points", "n.npy", "--ratio", "0.6", "-o", "p.csv"], options].concat());
        let text = fs::read_to_string(f.join("p.csv")).unwrap();
        let x = |line: &str| line.split(',').next().unwrap().parse::<f64>().unwrap();
        text.lines().skip(1).map(x).fold(f64::INFINITY, f64::min)
    };
    assert_eq!(least(&["--nan", "100"]), 1.0);
    assert_eq!(least(&["--nan"]), 2.0);
    let facts = json(f, &["interpolate", "n.npy", "--ratio", "0.6", "--fill", "--nan"]);
    assert_eq!(facts["interpolation"]["filled"]["samples"], 384);
    let (code, _, error) = run(f, &["points", "n.npy", "--nan", "--select", "adaptive"]);
    assert!(code == 1 && error.contains("--nan a value"), "{error}");
}

#[test]
fn parts_and_coarser_volumes_stay_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let nrrd = nrrd(|h| h + "space: LPS\nspace directions: (0.5,0,0) (0,1,0) (0,0,2)\n", &shorts());
    save(f, "v.nrrd", nrrd);
    let facts = json(f, &["info", "v.nrrd", "--roi", "1:,:,1:2"]);
    assert_eq!(
        (&facts["dims"], &facts["origin"]),
        (&serde_json::json!([2, 2, 1]), &serde_json::json!([0.5, 0.0, 2.0]))
    );
    assert_eq!((facts["min"].as_f64(), facts["max"].as_f64()), (Some(14.0), Some(22.0)));
    let facts = json(f, &["info", "v.nrrd", "--downsample", "2"]);
    assert_eq!(
        (&facts["dims"], &facts["origin"]),
        (&serde_json::json!([1, 1, 1]), &serde_json::json!([0.25, 0.5, 1.0]))
    );
    assert_eq!(facts["min"], 10.0);
    // Nothing beyond the region counts: neither its least value, which missing samples get, nor that it is NaN.
    let mut samples: Vec<f32> =
        (0..512).map(|i| (10 * (i % 8) + (i % 8 * (i / 8 % 8) * (i / 64)) % 7) as f32).collect();
    (samples[0], samples[1 + 8 * 9 + 64 * 3]) = (-1000.0, f32::NAN);
    let array = ndarray::Array3::from_shape_vec((8, 8, 8), samples).unwrap();
    ndarray_npy::write_npy(f.join("missing.npy"), &array).unwrap();
    for (roi, nan) in [(":,:,1:", &["--nan"][..]), (":,:,5:", &[])] {
        let told = |output: &str, blocks: &[&str]| {
            let shape = ["shape", "missing.npy", "--alpha", "4", "--roi", roi, "-o", output];
            let mut told = json(f, &[&shape[..], nan, blocks].concat());
            let facts = ["input", "coefficients", "points", "shape"].map(|key| told[key].take());
            facts.map(|fact| fact.to_string())
        };
        let whole = told("whole.vtu", &[]);
        assert!(whole[0].contains("70.0") && !whole[0].contains("-1000"), "{whole:?}");
        let blocks = told("blocks.pvtu", &["--blocks", "2"]);
        assert_eq!(whole[..3], blocks[..3], "{roi}");
    }
    for output in ["whole.vtu", "blocks.pvtu"] {
        let shape = ["shape", "missing.npy", "--alpha", "4", "--roi", ":,:,2:", "-o", output];
        let (code, _, error) = run(f, &shape);
        assert_eq!(code, 1);
        assert!(error.contains("[1, 1, 4] is NaN"), "{error}");
    }

    for (roi, code, word) in
        [("1:9,:,:", 1, "--roi"), ("1,:,:", 2, "not a range"), (":,:", 2, "three ranges")]
    {
        let (found, _, error) = run(f, &["haar", "v.nrrd", "--roi", roi]);
        assert!(found == code && error.contains(word), "{error}");
    }
    let small =
        json(f, &["shape", "sample:phantom@32", "--roi", "8:24,8:24,8:24", "--downsample", "2"]);
    assert_eq!(small["input"]["dims"], serde_json::json!([8, 8, 8]));
}

#[test]
fn a_dash_is_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let piped = |bytes: &[u8], args: &[&str]| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_walpha"))
            .args(args)
            .env("TMPDIR", folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // The command may end before it has read all.
        let _ = child.stdin.take().unwrap().write_all(bytes);
        let done = child.wait_with_output().unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
        (done.status.code().unwrap(), done.stdout, String::from_utf8(done.stderr).unwrap())
    };
    let (code, out, error) = piped(&nrrd(|h| h, &shorts()), &["info", "-"]);
    assert!(
        code == 0 && String::from_utf8_lossy(&out).contains("NRRD, samples of type i16"),
        "{error}"
    );
    let csv = b"x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n";
    let (code, out, error) = piped(csv, &["info", "-", "--input-format", "csv"]);
    assert!(code == 0 && out.starts_with(b"points    4"), "{error}");
    let (code, _, error) = piped(csv, &["info", "-"]);
    assert!(code == 1 && error.contains("standard input") && !error.contains("walpha-"), "{error}");
    let (code, out, error) = piped(
        &nrrd(|h| h, &shorts()),
        &["haar", "-", "--rms", "0", "-o", "-", "--output-format", "raw"],
    );
    assert_eq!((code, out.len()), (0, 48), "{error}");
    let back: Vec<f32> = out.chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(back, numbers());
    assert!(Path::new(folder.path()).is_dir());
}
