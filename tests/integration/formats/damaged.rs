//! A row for each damage: the file, and what its error says.

use std::io::{self, Write};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use ndarray::Array3;
use proptest::prelude::*;
use walpha::points::read_points;

use super::files::*;
use crate::common::{Told, alone, largest};

#[test]
fn a_damaged_nrrd_says_what_is_wrong() {
    let n = |from: &'static str, to: &'static str| nrrd(move |h| h.replace(from, to), &shorts());
    refuses("v.nrrd", "hello", &["not an NRRD file"]);
    refuses("v.nrrd", NRRD, &["truncated"]);
    refuses("v.nrrd", nrrd(|h| h, &shorts()[1..]), &["24 bytes, but 23 follow", "truncated"]);
    refuses("v.nrrd", nrrd(|h| h, &[&shorts()[..], b"x"].concat()), &["25 follow", "too long"]);
    refuses("v.nrrd", n("short", "block"), &["type block"]);
    refuses("v.nrrd", n("raw", "hex"), &["hex", "not read"]);
    refuses("v.nrrd", n("raw", "gzip"), &["encoded data"]);
    refuses("v.nrrd", n("endian: little\n", ""), &["endian"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 2"), &["2 sizes"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 0 2"), &["empty"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 2 -2"), &["not numbers"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3000000 2000000 2"), &["too many"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 1600 1600 1600"), &["but 24 follow"]);
    refuses("v.nrrd", n("3\nsizes: 3 2 2", "4\nsizes: 3 2 2 2"), &["2 volumes", "`frame`"]);
    refuses("v.nrrd", n("key:=value", "kinds: RGB-color space space"), &["only scalar"]);
    refuses("v.nrrd", n("key:=value", "spacings: 1 0 1"), &["spacing must not be 0"]);
    refuses("v.nrrd", n("key:=value", "space origin: (1,2"), &["not a vector"]);
    refuses("v.nrrd", n("key:=value", "line skip: 3"), &["line skip"]);
    refuses("v.nrrd", n("key:=value", "no field"), &["not a field"]);
    refuses("v.nrrd", n("key:=value", "type: short"), &["twice"]);
    refuses("v.nrrd", n("key:=value", "data file: a%d 1 9999999 1"), &["not a valid sequence"]);
    refuses("v.nrrd", nrrd(|h| h.replace("raw", "text"), b"1 2 3"), &["cannot hold"]);
    let words = "1 2 3 4 5 6 7 8 9 10 11 twelve";
    refuses(
        "v.nrrd",
        nrrd(|h| h.replace("raw", "text"), words.as_bytes()),
        &["twelve", "number 12"],
    );
    let large = words.replace("twelve", "40000");
    refuses("v.nrrd", nrrd(|h| h.replace("raw", "text"), large.as_bytes()), &["not a valid i16"]);
}

#[test]
fn a_damaged_metaimage_says_what_is_wrong() {
    let m = |from: &str, to: &str, tail: &str| {
        [MHA.replace(from, to).as_bytes(), tail.as_bytes(), &shorts()].concat()
    };
    let local = "ElementDataFile = LOCAL\n";
    refuses("v.mha", "hello", &["not a MetaImage"]);
    refuses("v.mha", MHA, &["ElementDataFile"]);
    refuses("v.mha", m("Image", "Tube", local), &["type Tube"]);
    refuses("v.mha", m("NDims = 3", "NDims = 4", local), &["4 sizes"]);
    refuses("v.mha", m("NDims = 3", "NDims = 5", local), &["NDims = 5"]);
    refuses("v.mha", m("3 2 2", "3 2", local), &["DimSize = 3 2"]);
    refuses("v.mha", m("3 2 2", "3 2 3", local), &["36 bytes, but 24"]);
    refuses("v.mha", m("MET_SHORT", "MET_STRING", local), &["MET_STRING"]);
    refuses("v.mha", m("NDims", "ElementNumberOfChannels = 3\nNDims", local), &["only scalar"]);
    refuses("v.mha", m("NDims", "CompressedData = True\nNDims", local), &["encoded data"]);
    refuses("v.mha", m("NDims", "ElementSpacing = 1 2\nNDims", local), &["not 3 numbers"]);
}

#[test]
fn a_damaged_vtk_says_what_is_wrong() {
    let v = |from: &str, to: &str| VTK.replace(from, to) + "0 1 2 3 4 5 6 7 8 9 10 11\n";
    refuses("v.vtk", "hello", &["not a legacy VTK"]);
    refuses("v.vtk", v("STRUCTURED_POINTS", "POLYDATA"), &["POLYDATA"]);
    refuses("v.vtk", v("s short", "s short 3"), &["only scalar"]);
    refuses("v.vtk", v("s short", "s string"), &["type string"]);
    refuses("v.vtk", v("SCALARS", "VECTORS"), &["only scalar"]);
    refuses("v.vtk", v("LOOKUP_TABLE default", "0 0"), &["LOOKUP_TABLE"]);
    refuses("v.vtk", v("3 2 2", "3 2 3"), &["12 values for 3×2×3"]);
    refuses("v.vtk", v("3 2 2", "3 1 2"), &["12 values for 3×1×2"]);
    refuses("v.vtk", v("3 2 2", "3 2"), &["not 3 numbers"]);
    refuses("v.vtk", v("ASCII", "BINARY"), &["bytes behind the 24"]);
    refuses("v.vtk", v("ASCII\n", ""), &["no ASCII or BINARY"]);
    refuses("v.vtk", &VTK[..90], &["\"SPACIN\""]);
}

#[test]
fn a_damaged_vti_says_what_is_wrong() {
    let text = "format=\"ascii\">0 1 2 3 4 5 6 7 8 9 10 11";
    let x = |from: &str, to: &str| {
        String::from_utf8(vti("", text, b"")).unwrap().replace(from, to).into_bytes()
    };
    refuses("v.vti", "hello", &["v.vti"]);
    refuses("v.vti", x("ImageData", "PolyData"), &["PolyData"]);
    refuses("v.vti", x("Int16", "String"), &["String"]);
    refuses("v.vti", x("Name=", "NumberOfComponents=\"3\" Name="), &["only scalar"]);
    refuses("v.vti", x(" 10 11<", " 1011<"), &["but has 11"]);
    refuses("v.vti", x(" 11<", " 11 12<"), &["more follow"]);
    refuses("v.vti", x("Piece Extent=\"0 2", "Piece Extent=\"0 1"), &["larger image"]);
    refuses("v.vti", x("</VTKFile>", ""), &["inside its element VTKFile"]);
    refuses("v.vti", x("LittleEndian", "MiddleEndian"), &["MiddleEndian"]);
    refuses("v.vti", x("ascii", "appended"), &["no appended data"]);
    let packed = "format=\"binary\">GAAA";
    refuses("v.vti", vti("compressor=\"vtkLZMADataCompressor\"", packed, b""), &["vtkLZMA"]);
    refuses("v.vti", vti("", "format=\"binary\">GAAA", b""), &["truncated"]);
    refuses("v.vti", vti("", "format=\"binary\">////////AAAA", b""), &["4294967295 bytes"]);
    let lying = [u32::MAX, u32::MAX, 0, 1].map(u32::to_le_bytes).concat();
    let blocks = format!("format=\"binary\">{}", base64(&lying));
    refuses(
        "v.vti",
        vti("compressor=\"vtkZLibDataCompressor\"", &blocks, b""),
        &["compressed blocks"],
    );
    // A block of 12 bytes of the following file is far too small for its stated content.
    let lying = [[1u32, 1 << 20, 0, 12].map(u32::to_le_bytes).concat(), vec![0; 3000]].concat();
    let blocks = format!("format=\"binary\">{}", base64(&lying));
    let file = vti("compressor=\"vtkZLibDataCompressor\"", &blocks, b"");
    refuses("v.vti", file, &["12 compressed bytes", "hold 1048576, which they cannot"]);
}

#[test]
fn a_damaged_nifti_says_what_is_wrong() {
    let (_, nifti) = examples().into_iter().find(|(name, _)| *name == "one.nii").unwrap();
    let with = |place: usize, value: &[u8]| {
        let mut bytes = nifti.clone();
        bytes[place..place + value.len()].copy_from_slice(value);
        bytes
    };
    refuses("v.nii", "hello", &["truncated"]);
    refuses("v.nii", vec![1; 400], &["not a NIfTI file"]);
    refuses("v.nii", &nifti[..nifti.len() - 1], &["48 bytes, but 47 follow"]);
    refuses("v.nii", [&nifti[..], b"x"].concat(), &["too long"]);
    refuses("v.nii", with(344, b"\0\0\0\0"), &["Analyze"]);
    refuses("v.nii", with(70, &128i16.to_le_bytes()), &["colours"]);
    refuses("v.nii", with(70, &32i16.to_le_bytes()), &["complex"]);
    refuses("v.nii", with(40, &9i16.to_le_bytes()), &["dim[0] = 9"]);
    refuses(
        "v.nii",
        with(42, &(-3i16).to_le_bytes()),
        &["axes of [-3, 2, 2, 1, 1, 1, 1] samples (dim)"],
    );
    refuses("v.nii", with(40, &[4, 0, 3, 0, 2, 0, 2, 0, 2, 0]), &["2 volumes", "`frame`"]);
    refuses("v.nii", with(108, &1e9f32.to_le_bytes()), &["ends before its samples"]);
    refuses("v.nii.gz", gzip(&nifti[..300]), &["truncated"]);
}

#[test]
fn a_damaged_tiff_says_what_is_wrong() {
    let pages = tiff(2, None);
    refuses("v.tif", &pages[..pages.len() - 9], &["v.tif"]);
    refuses("v.tif", &pages[..9], &["truncated"]);
    let hyper = "ImageJ=1.53\nimages=4\nslices=2\nframes=2\n";
    refuses("v.tif", tiff(4, Some(hyper)), &["2 volumes", "`frame`"]);
    refuses("v.tif", tiff(2, Some("<OME><Pixels SizeZ=\"x\"/></OME>")), &["OME-XML"]);
    let many = "ImageJ=1.53\nimages=1000\nslices=1000\n";
    refuses("v.tif", tiff(1, Some(many)), &["12000 bytes"]);
}

#[test]
fn a_damaged_npz_says_what_is_wrong() {
    let array = Array3::zeros((1, 1, 1));
    refuses("v.npz", npz(&[]), &["no array of three axes"]);
    refuses("v.npz", npz(&[("a", &array), ("b", &array)]), &["a.npy, b.npy"]);
    refuses("v.npz", &npz(&[("a", &array)])[..40], &["begins as a zip archive"]);
    let header = "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 1, 1)}\n";
    let preamble = [&b"\x93NUMPY\x01\x00"[..], &[header.len() as u8, 0]].concat();
    let mut halves = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
    halves.start_file("a.npy", zip::write::SimpleFileOptions::default()).unwrap();
    halves.write_all(&[&preamble[..], header.as_bytes(), &[0; 2]].concat()).unwrap();
    let halves = halves.finish().unwrap().into_inner();
    refuses("v.npz", halves, &["elements of type <f2", "a.astype('f4')"]);
}

#[test]
fn files_of_no_known_format_are_refused() {
    for (start, what, next) in [
        (&b"GIF89a"[..], "is a GIF picture", "the folder of all slices"),
        (b"7z\xbc\xaf\x27\x1c", "is a 7z archive", "unpack it"),
        (b"<!DOCTYPE html>", "is an HTML page", "download the file itself"),
        (
            b"<!DOCTYPE html><!-- Made by `node web/page/build.mjs` from",
            "is a page of `walpha view`",
            "open it in a browser",
        ),
        (b"{\"points\":[[0,0,0]]}", "the simplices of a shape or a filtration", "walpha check"),
        (b"version https://git-lfs.github.com/spec/v1", "a pointer of Git LFS", "git lfs pull"),
        (b"MATLAB 5.0 MAT-file", "is a MATLAB file", "numpy.save"),
        (b"HEADER    HYDROLASE", "is a PDB or PQR file of a molecule", "call it .pdb or .pqr"),
        (b"ITEM: TIMESTEP\n0\n", "is a LAMMPS dump", "call it .lammpstrj"),
        (b"ASTM-E57", "is an E57 scan", "LAS or PLY"),
        (b"\x80\x04\x95", "is a pickle of Python", "numpy.save"),
        (b"<?xml version=\"1.0\"?><gpx/>", "is XML, and no file of VTK", "name a file"),
        (
            b"<?xml version=\"1.0\"?><OME/>",
            "is OME-XML, the metadata of an image",
            "name a TIFF file",
        ),
        (b"\xfd7zXZ", "compressed with xz", "unpack it"),
    ] {
        // Whatever the name says.
        for name in ["v.bin", "v.nii", "v.nrrd"] {
            refuses(name, start, &[what, next]);
        }
        refuses("v.gz", gzip(start), &["compressed with gzip", what, next]);
    }
    refuses("v.img", [0; 100], &["header", "v.hdr is missing"]);
    refuses("v.nii", "", &["is empty"]);
    refuses("v.bin", b"\x89HDF\r\n\x1a\n rest", &["HDF5"]);
    refuses("v.png", b"\x89PNG\r\n\x1a\n rest", &["folder of all slices"]);
    refuses("v.gz", gzip(b"something else"), &["holds no format that is recognised"]);
    refuses("v.las.gz", gzip(b"LASF and more"), &["LAS or LAZ compressed with gzip", "unpack it"]);
    refuses("v.nrrd.gz", gzip(&nrrd(|h| h, &shorts())), &["unpack it first"]);
    refuses("v.bin", "hello", &["not in a format", "`dims`"]);
}

proptest! {
    // A smaller example of what hangs is not worth minutes.
    #![proptest_config(ProptestConfig { cases: 4000, max_shrink_time: 30_000, ..ProptestConfig::default() })]

    fn damage_does_no_harm(
        which in any::<prop::sample::Index>(),
        edits in prop::collection::vec(
            (any::<prop::sample::Index>(), prop_oneof![any::<u8>(), b'0'..=b'9', Just(0), Just(0xff)]),
            0..5,
        ),
        // Headers are where damage matters most.
        in_head in any::<bool>(),
        keep in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let volumes = examples();
        let files = [&volumes[..], &point_examples()[..]].concat();
        let (name, mut bytes) = which.get(&files).clone();
        for (place, value) in edits {
            let length = if in_head { bytes.len().min(400) } else { bytes.len() };
            bytes[place.index(length)] = value;
        }
        if let Some(keep) = keep {
            bytes.truncate(keep.index(bytes.len()));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = save(folder.path(), name, bytes);
        let (done, wait) = channel();
        let reader = thread::spawn(move || {
            let _ = open(&path);
            let _ = walpha::points::is_point_file(&path);
            let _ = read_points(&path, None);
            let _ = done.send(());
        });
        // A reader that hangs stays behind; one that panics sends nothing, and is told by its join.
        let waited = wait.recv_timeout(Duration::from_secs(10));
        prop_assert!(waited != Err(RecvTimeoutError::Timeout), "{name} hangs");
        prop_assert!(reader.join().is_ok(), "{name} makes the reader panic");
        let largest = largest();
        prop_assert!(largest < 1 << 30, "{name} asks for {largest} bytes");
    }
}

/// Bytes changed anywhere and files cut anywhere make errors or other numbers: no panic, no
/// hang, and no allocation beyond what the file can hold.
#[test]
fn no_damage_does_harm() {
    alone(|| {
        damage_does_no_harm();
    });
}

/// The advice to copy a file again is given only if it is shorter than it says.
#[test]
fn advice_follows_from_the_cause() {
    let n = |from: &'static str, to: &'static str| nrrd(move |h| h.replace(from, to), &shorts());
    let again = "copy it again";
    refuses("v.nrrd", nrrd(|h| h, &shorts()[1..]), &[again, "or correct its header"]);
    refuses("v.nii.gz", &gzip(&[0; 100])[..20], &[again]);
    for (name, bytes) in [
        ("v.nrrd", nrrd(|h| h, &[&shorts()[..], b"x"].concat())),
        ("v.nrrd", n("sizes: 3 2 2", "sizes: 3 2")),
        ("v.nrrd", n("raw", "gzip")),
        ("v.nrrd", n("type: short\n", "")),
        (
            "v.mha",
            [MHA.replace("NDims = 3\n", "").as_bytes(), b"ElementDataFile = LOCAL\n", &shorts()]
                .concat(),
        ),
        ("v.vtk", (VTK.replace("LOOKUP_TABLE default", "0 0") + "0 1").into()),
        ("v.npy", b"\x93NUMPY\x01\0\x04\0{}  ".to_vec()),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let error = open(&save(folder.path(), name, bytes)).unwrap_err();
        let told = error.told();
        assert!(!told.contains(again) && told.contains("write it anew"), "{told}");
    }
}
