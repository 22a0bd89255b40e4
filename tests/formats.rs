//! Files of each format and damage, written here byte by byte, and our own read back.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use ndarray::Array3;
use proptest::prelude::*;
use walpha::Points;
use walpha::export::{Format, VolumeFormat};
use walpha::points::{PointsError, WeightedPoints, read_points, scattered_difference};
use walpha::shape::{Alpha, ShapeOptions, alpha_shape};
use walpha::volume::*;

mod common;

/// Samples 0, 2, 4, … of a 3×2×2 grid, in the byte order of most files.
fn shorts() -> Vec<u8> {
    (0..12i16).flat_map(|i| (2 * i).to_le_bytes()).collect()
}

fn numbers() -> Vec<f32> {
    (0..12).map(|i| 2.0 * i as f32).collect()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let of_group = |group: &[u8]| {
        let mut bits = [0; 4];
        bits[1..=group.len()].copy_from_slice(group);
        let bits = u32::from_be_bytes(bits);
        (0..4)
            .map(move |i| {
                let place = (bits >> (18 - 6 * i)) as usize & 63;
                if i <= group.len() { char::from(LETTERS[place]) } else { '=' }
            })
            .collect::<String>()
    };
    bytes.chunks(3).map(of_group).collect()
}

fn save(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn open(path: &Path) -> Result<Volume, VolumeError> {
    read(path, &ReadOptions::default())
}

/// Reads bytes under a name; the error must name the file and these parts.
fn refuses(name: &str, bytes: impl AsRef<[u8]>, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let text = open(&save(folder.path(), name, bytes)).unwrap_err().to_string();
    for part in parts.iter().chain(&[name]) {
        assert!(text.contains(part), "{part:?} is missing in: {text}");
    }
}

/// A turn about z and a flip, so that a transposed matrix is found out.
fn turned() -> Frame {
    let axes = [[0.3, 0.4, 0.0], [0.8, -0.6, 0.0], [0.0, 0.0, -2.0]];
    Frame::from_axes([1.5, -2.0, 30.0], axes).unwrap()
}

fn close(a: &Frame, b: &Frame) -> bool {
    let all = |f: &Frame| [f.origin, f.spacing, f.direction[0], f.direction[1], f.direction[2]];
    all(a).as_flattened().iter().zip(all(b).as_flattened()).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn written_volumes_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Array3::from_shape_fn((3, 4, 5), |(z, y, x)| (100 * z + 10 * y + x) as f32 / 3.0);
    let volume = Volume::new(samples, turned()).unwrap();
    for (format, extension) in VolumeFormat::ALL {
        let path = folder.path().join(format!("v.{extension}"));
        assert_eq!(VolumeFormat::of(&path), Ok(format));
        let mut bytes = Vec::new();
        format.write(&volume, &mut bytes).unwrap();
        fs::write(&path, bytes).unwrap();
        let options = match format {
            VolumeFormat::Raw => {
                let (dims, dtype, endian) = (volume.dims(), Dtype::F32, Endian::Little);
                ReadOptions { raw: Some(RawLayout { dims, dtype, endian, offset: 0 }), level: None }
            }
            _ => ReadOptions::default(),
        };
        let back = read(&path, &options).unwrap();
        assert_eq!(back.as_slice(), volume.as_slice(), "{extension}");
        let has_frame = !matches!(format, VolumeFormat::Npy | VolumeFormat::Raw);
        let frame = if has_frame { turned() } else { Frame::VOXEL };
        assert!(close(back.frame(), &frame), "{extension}: {:?}", back.frame());
        // By content too.
        if format != VolumeFormat::Raw {
            let renamed = folder.path().join("unnamed");
            fs::copy(&path, &renamed).unwrap();
            assert_eq!(open(&renamed).unwrap().as_slice(), volume.as_slice(), "{extension}");
        }
    }
    let long = Volume::new(Array3::ones((1, 1, 40_000)), turned()).unwrap();
    let mut bytes = Vec::new();
    VolumeFormat::Nifti.write(&long, &mut bytes).unwrap();
    assert_eq!(bytes[0..4], 540u32.to_le_bytes(), "version 2");
    let back = open(&save(folder.path(), "long.nii", bytes)).unwrap();
    assert_eq!(back.dims().x(), 40_000);
    let text = VolumeFormat::of(Path::new("a.mha")).unwrap_err().to_string();
    assert!(text.contains("a volume") && text.contains(".nii.gz"), "{text}");
}

const NRRD: &str = "NRRD0004\n# a remark\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\n\
                    encoding: raw\nkey:=value\n";
const MHA: &str = "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nElementType = MET_SHORT\n";
const VTK: &str = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET STRUCTURED_POINTS\n\
                   DIMENSIONS 3 2 2\nSPACING 1 2 3\nORIGIN 4 5 6\nPOINT_DATA 12\n\
                   SCALARS s short\nLOOKUP_TABLE default\n";

fn nrrd(change: impl Fn(String) -> String, payload: &[u8]) -> Vec<u8> {
    [change(NRRD.into()).as_bytes(), b"\n", payload].concat()
}

fn vti(attributes: &str, array: &str, appended: &[u8]) -> Vec<u8> {
    let head = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" \
         byte_order=\"LittleEndian\" {attributes}>\n\
         <ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"4 5 6\" Spacing=\"1 2 3\">\n\
         <Piece Extent=\"0 2 0 1 0 1\"><PointData Scalars=\"s\">\n\
         <DataArray type=\"Int16\" Name=\"s\" {array}</DataArray>\n\
         </PointData></Piece></ImageData>\n"
    );
    [head.as_bytes(), appended, b"</VTKFile>\n"].concat()
}

/// Gray pages of 3×2 16-bit samples.
fn tiff(pages: usize, description: Option<&str>) -> Vec<u8> {
    use tiff::encoder::{TiffEncoder, colortype::Gray16};
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for page in 0..pages as u16 {
        let mut image = encoder.new_image::<Gray16>(3, 2).unwrap();
        if let Some(text) = description {
            image.encoder().write_tag(tiff::tags::Tag::ImageDescription, text).unwrap();
        }
        let samples: Vec<u16> = (0..6).map(|i| 2 * (6 * page + i)).collect();
        image.write_data(&samples).unwrap();
    }
    bytes.into_inner()
}

fn npz(arrays: &[(&str, &Array3<f32>)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).unwrap();
        ndarray_npy::WriteNpyExt::write_npy(*array, &mut archive).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// A valid small file of each format, whose samples are [`numbers`].
fn examples() -> Vec<(&'static str, Vec<u8>)> {
    let text = numbers().iter().map(f32::to_string).collect::<Vec<_>>().join(" ");
    let volume = Array3::from_shape_vec((2, 2, 3), numbers()).unwrap();
    let written = |format: VolumeFormat| {
        let mut bytes = Vec::new();
        let volume = Volume::new(volume.clone(), turned()).unwrap();
        format.write(&volume, &mut bytes).unwrap();
        bytes
    };
    let size = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let packed = zlib(&shorts());
    let blocks = [1u32, 24, 0, packed.len() as u32].map(u32::to_le_bytes).concat();
    let big: Vec<u8> = shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
    let inline = base64(&[&size(&shorts())[..], &shorts()].concat());
    let pieces = base64(&blocks) + &base64(&packed);
    let raw = [
        b"<AppendedData encoding=\"raw\">\n_",
        &size(&shorts())[..],
        &shorts(),
        b"</AppendedData>",
    ]
    .concat();
    let appended = format!("<AppendedData encoding=\"base64\">_{pieces}</AppendedData>");
    let zlib_xml = "compressor=\"vtkZLibDataCompressor\" header_type=\"UInt32\"";
    vec![
        ("raw.nrrd", nrrd(|h| h, &shorts())),
        ("gzip.nrrd", nrrd(|h| h.replace("raw", "gzip"), &gzip(&shorts()))),
        ("text.nrrd", nrrd(|h| h.replace("raw", "ascii"), text.as_bytes())),
        ("big.nrrd", nrrd(|h| h.replace("little", "big"), &big)),
        ("end.nrrd", nrrd(|h| h + "byte skip: -1\n", &[b"junk", &shorts()[..]].concat())),
        ("raw.mha", [MHA.as_bytes(), b"ElementDataFile = LOCAL\n", &shorts()].concat()),
        (
            "zlib.mha",
            [MHA.as_bytes(), b"CompressedData = True\nElementDataFile = LOCAL\n", &packed].concat(),
        ),
        (
            "big.mha",
            [MHA.as_bytes(), b"ElementByteOrderMSB = True\nElementDataFile = LOCAL\n", &big]
                .concat(),
        ),
        (
            "text.mha",
            [MHA.as_bytes(), b"BinaryData = False\nElementDataFile = LOCAL\n", text.as_bytes()]
                .concat(),
        ),
        ("text.vtk", [VTK, &text, "\nMETADATA\nINFORMATION 0\n"].concat().into()),
        ("binary.vtk", [VTK.replace("ASCII", "BINARY").as_bytes(), &big, b"\n"].concat()),
        ("field.vtk", {
            let scalars = "SCALARS s short\nLOOKUP_TABLE default\n";
            [&VTK.replace(scalars, "FIELD FieldData 1\ns 1 12 short\n"), &text[..]].concat().into()
        }),
        ("text.vti", vti("", &format!("format=\"ascii\">{text}"), b"")),
        ("base64.vti", vti("", &format!("format=\"binary\">\n {inline}\n"), b"")),
        ("zlib.vti", vti(zlib_xml, &format!("format=\"binary\">{pieces}"), b"")),
        ("raw.vti", vti("", "format=\"appended\" offset=\"0\">", &raw)),
        ("appended.vti", vti(zlib_xml, "format=\"appended\" offset=\"0\">", appended.as_bytes())),
        ("one.nii", written(VolumeFormat::Nifti)),
        ("one.nii.gz", written(VolumeFormat::NiftiGzip)),
        ("ours.nrrd", written(VolumeFormat::Nrrd)),
        ("pages.tif", tiff(2, None)),
        ("arrays.npz", npz(&[("a", &volume)])),
    ]
}

#[test]
fn small_files_of_every_flavour_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in examples() {
        let volume = open(&save(folder.path(), name, bytes)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(volume.dims().xyz(), [3, 2, 2], "{name}");
        assert_eq!(volume.as_slice(), numbers(), "{name}");
        if name.ends_with(".vtk") || name.ends_with(".vti") {
            let frame = Frame { origin: [4.0, 5.0, 6.0], spacing: [1.0, 2.0, 3.0], ..Frame::VOXEL };
            assert_eq!(*volume.frame(), frame, "{name}");
        }
    }
}

#[test]
fn detached_samples_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("data")).unwrap();
    save(f, "data/all.raw", [b"head", &shorts()[..]].concat());
    save(f, "data/all.gz", gzip(&shorts()));
    save(f, "s1.raw", &shorts()[..12]);
    save(f, "s2.raw", &shorts()[12..]);
    for tail in [
        "byte skip: 4\ndata file: data/all.raw\n",
        "byte skip: -1\ndata file: data/all.raw\n",
        "data file: LIST\ns1.raw\ns2.raw\n",
        "data file: s%d.raw 1 2 1\n",
        "data file: s%d.raw 1 2 1 2\n\n",
    ] {
        let volume = open(&save(f, "v.nhdr", [NRRD, tail].concat())).unwrap();
        assert_eq!(volume.as_slice(), numbers(), "{tail}");
    }
    let packed = [&NRRD.replace("raw", "gz"), "datafile: data/all.gz\n"].concat();
    assert_eq!(open(&save(f, "v.nhdr", packed)).unwrap().as_slice(), numbers());
    for tail in [
        "HeaderSize = 4\nElementDataFile = data/all.raw\n",
        "HeaderSize = -1\nElementDataFile = data/all.raw\n",
        "ElementDataFile = LIST\ns1.raw\ns2.raw\n",
        "ElementDataFile = s%d.raw 1 2 1\n",
    ] {
        let volume = open(&save(f, "v.mhd", [MHA, tail].concat())).unwrap();
        assert_eq!(volume.as_slice(), numbers(), "{tail}");
    }
    let missing = open(&save(f, "v.nhdr", [NRRD, "data file: no.raw\n"].concat()));
    assert!(missing.unwrap_err().to_string().contains("no.raw"));
    let short = open(&save(f, "v.nhdr", [NRRD, "data file: s1.raw\n"].concat())).unwrap_err();
    assert!(short.to_string().contains("24 bytes, but 12 follow"), "{short}");
}

#[test]
fn frames_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let steps = "space dimension: 3\nspace directions: (0.3,0.4,0) (0.8,-0.6,0) (0,0,-2)\n\
                 space origin: (1.5,-2,30)\n";
    let volume = open(&save(folder.path(), "v.nrrd", nrrd(|h| h + steps, &shorts()))).unwrap();
    assert!(close(volume.frame(), &turned()));
    let spaced = nrrd(|h| h + "spacings: 0.5 nan 2\n", &shorts());
    let volume = open(&save(folder.path(), "v.nrrd", spaced)).unwrap();
    assert_eq!(volume.frame().spacing, [0.5, 1.0, 2.0]);
    // The grid has 3×2×2 samples; cells are wider by half a sample on either side.
    for (fields, spacing, origin) in [
        ("axis mins: 1 2 nan\nspacings: 2 4 8\n", [2.0, 4.0, 8.0], [2.0, 4.0, 0.0]),
        ("axis mins: 0 0 0\naxis maxs: 6 4 1\n", [2.0, 2.0, 0.5], [1.0, 1.0, 0.25]),
        (
            "axis mins: 0 1 2\naxis maxs: 6 4 3\ncenterings: node node cell\n",
            [3.0, 3.0, 0.5],
            [0.0, 1.0, 2.25],
        ),
    ] {
        let bytes = nrrd(|h| h + fields, &shorts());
        let volume = open(&save(folder.path(), "v.nrrd", bytes)).unwrap();
        assert_eq!((volume.frame().spacing, volume.frame().origin), (spacing, origin), "{fields}");
    }
    refuses("v.nrrd", nrrd(|h| h + "axis mins: 1 2\n", &shorts()), &["axis mins", "3 numbers"]);
    let header = "ElementSpacing = 0.5 1 2\nOffset = 1.5 -2 30\n\
                  TransformMatrix = 0.6 0.8 0 0.8 -0.6 0 0 0 -1\nElementDataFile = LOCAL\n";
    let bytes = [MHA.as_bytes(), header.as_bytes(), &shorts()].concat();
    let volume = open(&save(folder.path(), "v.mha", bytes)).unwrap();
    assert!(close(volume.frame(), &turned()), "{:?}", volume.frame());
    let imagej = "ImageJ=1.53\nimages=2\nslices=2\nspacing=2.5\n";
    let volume = open(&save(folder.path(), "v.tif", tiff(2, Some(imagej)))).unwrap();
    assert_eq!(volume.frame().spacing, [1.0, 1.0, 2.5]);
    let ome = "<?xml version=\"1.0\"?><OME><Image><Pixels SizeZ=\"2\" PhysicalSizeX=\"0.5\" \
               PhysicalSizeY=\"0.75\" PhysicalSizeZ=\"2\"/></Image></OME>";
    let volume = open(&save(folder.path(), "v.tif", tiff(2, Some(ome)))).unwrap();
    assert_eq!(volume.frame().spacing, [0.5, 0.75, 2.0]);
}

#[test]
fn folders_of_slices_are_read_in_natural_order() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for i in [1u8, 2, 9, 10, 11] {
        image::GrayImage::from_pixel(3, 2, image::Luma([i]))
            .save(f.join(format!("s{i}.png")))
            .unwrap();
    }
    save(f, "notes.txt", "no slice");
    let volume = open(f).unwrap();
    assert_eq!(volume.dims().xyz(), [3, 2, 5]);
    let along: Vec<f32> = volume.samples().slice(ndarray::s![.., 0, 0]).to_vec();
    assert_eq!(along, [1.0, 2.0, 9.0, 10.0, 11.0]);
    assert!(volume.has_gray_levels());
    image::GrayImage::new(2, 2).save(f.join("s12.png")).unwrap();
    assert!(open(f).unwrap_err().to_string().contains("must be alike"));
    image::RgbImage::new(3, 2).save(f.join("s12.png")).unwrap();
    assert!(open(f).unwrap_err().to_string().contains("only gray"));
    save(f, "s12.png", "no image");
    assert!(open(f).unwrap_err().to_string().contains("s12.png"));
    save(f, "s12.jpg", "");
    assert!(open(f).unwrap_err().to_string().contains("several kinds"));
    let empty = tempfile::tempdir().unwrap();
    assert!(open(empty.path()).unwrap_err().to_string().contains("holds no PNG"));
}

#[test]
fn damaged_volumes_say_what_is_wrong() {
    let n = |from: &'static str, to: &'static str| nrrd(move |h| h.replace(from, to), &shorts());
    refuses("v.nrrd", "hello", &["no NRRD file"]);
    refuses("v.nrrd", NRRD, &["truncated"]);
    refuses("v.nrrd", nrrd(|h| h, &shorts()[1..]), &["24 bytes, but 23 follow", "truncated"]);
    refuses("v.nrrd", nrrd(|h| h, &[&shorts()[..], b"x"].concat()), &["25 follow", "too long"]);
    refuses("v.nrrd", n("short", "block"), &["type block"]);
    refuses("v.nrrd", n("raw", "bzip2"), &["bzip2", "not read"]);
    refuses("v.nrrd", n("raw", "gzip"), &["encoded data"]);
    refuses("v.nrrd", n("endian: little\n", ""), &["endian"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 2"), &["2 sizes"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 0 2"), &["empty"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3 2 -2"), &["no numbers"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 3000000 2000000 2"), &["too many"]);
    refuses("v.nrrd", n("sizes: 3 2 2", "sizes: 1600 1600 1600"), &["but 24 follow"]);
    refuses("v.nrrd", n("3\nsizes: 3 2 2", "4\nsizes: 3 2 2 2"), &["4 axes"]);
    refuses("v.nrrd", n("key:=value", "kinds: RGB-color space space"), &["only scalar"]);
    refuses("v.nrrd", n("key:=value", "spacings: 1 0 1"), &["spacing must not be 0"]);
    refuses("v.nrrd", n("key:=value", "space origin: (1,2"), &["no vector"]);
    refuses("v.nrrd", n("key:=value", "line skip: 3"), &["line skip"]);
    refuses("v.nrrd", n("key:=value", "no field"), &["no field"]);
    refuses("v.nrrd", n("key:=value", "type: short"), &["twice"]);
    refuses("v.nrrd", n("key:=value", "data file: a%d 1 9999999 1"), &["no row"]);
    refuses("v.nrrd", nrrd(|h| h.replace("raw", "text"), b"1 2 3"), &["cannot hold"]);
    let words = "1 2 3 4 5 6 7 8 9 10 11 twelve";
    refuses(
        "v.nrrd",
        nrrd(|h| h.replace("raw", "text"), words.as_bytes()),
        &["twelve", "number 12"],
    );
    let large = words.replace("twelve", "40000");
    refuses("v.nrrd", nrrd(|h| h.replace("raw", "text"), large.as_bytes()), &["no i16"]);

    let m = |from: &str, to: &str, tail: &str| {
        [MHA.replace(from, to).as_bytes(), tail.as_bytes(), &shorts()].concat()
    };
    let local = "ElementDataFile = LOCAL\n";
    refuses("v.mha", "hello", &["no MetaImage"]);
    refuses("v.mha", MHA, &["ElementDataFile"]);
    refuses("v.mha", m("Image", "Tube", local), &["type Tube"]);
    refuses("v.mha", m("NDims = 3", "NDims = 4", local), &["NDims = 4"]);
    refuses("v.mha", m("3 2 2", "3 2", local), &["DimSize = 3 2"]);
    refuses("v.mha", m("3 2 2", "3 2 3", local), &["36 bytes, but 24"]);
    refuses("v.mha", m("MET_SHORT", "MET_STRING", local), &["MET_STRING"]);
    refuses("v.mha", m("NDims", "ElementNumberOfChannels = 3\nNDims", local), &["only scalar"]);
    refuses("v.mha", m("NDims", "CompressedData = True\nNDims", local), &["encoded data"]);
    refuses("v.mha", m("NDims", "ElementSpacing = 1 2\nNDims", local), &["not 3 numbers"]);

    let v = |from: &str, to: &str| VTK.replace(from, to) + "0 1 2 3 4 5 6 7 8 9 10 11\n";
    refuses("v.vtk", "hello", &["no legacy VTK"]);
    refuses("v.vtk", v("STRUCTURED_POINTS", "POLYDATA"), &["POLYDATA"]);
    refuses("v.vtk", v("s short", "s short 3"), &["only scalar"]);
    refuses("v.vtk", v("s short", "s string"), &["type string"]);
    refuses("v.vtk", v("SCALARS", "VECTORS"), &["VECTORS"]);
    refuses("v.vtk", v("LOOKUP_TABLE default", "0 0"), &["LOOKUP_TABLE"]);
    refuses("v.vtk", v("3 2 2", "3 2 3"), &["18 numbers", "truncated"]);
    refuses("v.vtk", v("3 2 2", "3 1 2"), &["more follow"]);
    refuses("v.vtk", v("3 2 2", "3 2"), &["not 3 numbers"]);
    refuses("v.vtk", v("ASCII", "BINARY"), &["bytes behind the 24"]);
    refuses("v.vtk", v("ASCII\n", ""), &["no ASCII or BINARY"]);
    refuses("v.vtk", &VTK[..90], &["SCALARS"]);

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
    refuses("v.vti", vti("compressor=\"vtkLZ4DataCompressor\"", text, b""), &["vtkLZ4"]);
    refuses("v.vti", vti("", "format=\"binary\">GAAA", b""), &["truncated"]);
    refuses("v.vti", vti("", "format=\"binary\">////////AAAA", b""), &["4294967295 bytes"]);
    let lying = [u32::MAX, u32::MAX, 0, 1].map(u32::to_le_bytes).concat();
    let blocks = format!("format=\"binary\">{}", base64(&lying));
    refuses(
        "v.vti",
        vti("compressor=\"vtkZLibDataCompressor\"", &blocks, b""),
        &["compressed blocks"],
    );

    let (_, nifti) = examples().into_iter().find(|(name, _)| *name == "one.nii").unwrap();
    let with = |place: usize, value: &[u8]| {
        let mut bytes = nifti.clone();
        bytes[place..place + value.len()].copy_from_slice(value);
        bytes
    };
    refuses("v.nii", "hello", &["truncated"]);
    refuses("v.nii", vec![1; 400], &["no NIfTI file"]);
    refuses("v.nii", &nifti[..nifti.len() - 1], &["48 bytes, but 47 follow"]);
    refuses("v.nii", [&nifti[..], b"x"].concat(), &["too long"]);
    refuses("v.nii", with(344, b"\0\0\0\0"), &["Analyze"]);
    refuses("v.nii", with(70, &128i16.to_le_bytes()), &["colours"]);
    refuses("v.nii", with(70, &32i16.to_le_bytes()), &["complex"]);
    refuses("v.nii", with(40, &9i16.to_le_bytes()), &["dim[0] = 9"]);
    refuses("v.nii", with(42, &(-3i16).to_le_bytes()), &["damaged"]);
    refuses("v.nii", with(40, &[4, 0, 3, 0, 2, 0, 2, 0, 2, 0]), &["a volume has three"]);
    refuses("v.nii", with(108, &1e9f32.to_le_bytes()), &["ends before its samples"]);
    refuses("v.nii.gz", gzip(&nifti[..300]), &["truncated"]);

    let pages = tiff(2, None);
    refuses("v.tif", &pages[..pages.len() - 9], &["v.tif"]);
    refuses("v.tif", &pages[..9], &["truncated"]);
    let hyper = "ImageJ=1.53\nimages=2\nslices=2\nframes=2\n";
    refuses("v.tif", tiff(2, Some(hyper)), &["2 times"]);
    refuses("v.tif", tiff(2, Some("<OME><Pixels SizeZ=\"x\"/></OME>")), &["OME-XML"]);
    let many = "ImageJ=1.53\nimages=1000\nslices=1000\n";
    refuses("v.tif", tiff(1, Some(many)), &["12000 bytes"]);

    let array = Array3::zeros((1, 1, 1));
    refuses("v.npz", npz(&[]), &["no array of three axes"]);
    refuses("v.npz", npz(&[("a", &array), ("b", &array)]), &["a.npy, b.npy"]);
    refuses("v.npz", &npz(&[("a", &array)])[..40], &["no NPZ archive"]);
    refuses("v.bin", b"\x89HDF\r\n\x1a\n rest", &["HDF5"]);
    refuses("v.png", b"\x89PNG\r\n\x1a\n rest", &["folder of all slices"]);
    refuses("v.gz", gzip(b"something else"), &["holds no format known"]);
    refuses("v.nrrd.gz", gzip(&nrrd(|h| h, &shorts())), &["unpack it first"]);
    refuses("v.bin", "hello", &["no format known", "--dims"]);
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment c\nelement face 1\nproperty list uchar int vertex_indices\n\
                   element vertex 2\nproperty float x\nproperty float y\nproperty double z\n\
                   property uchar red\nproperty float Value\nend_header\n";

fn vtp(array: &str) -> String {
    format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>\
         <Piece NumberOfPoints=\"2\"><PointData Scalars=\"temperature\">\
         <DataArray type=\"Float32\" Name=\"temperature\" format=\"ascii\">7 8</DataArray>\
         </PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
         format=\"ascii\">{array}</DataArray></Points></Piece></PolyData></VTKFile>"
    )
}

/// A small file of each point format, all of the points (1, 2, 3) and (4, 5, 6) with values 7 and 8.
fn point_examples() -> Vec<(&'static str, Vec<u8>)> {
    let binary = |order: &str, big: bool| {
        let mut bytes = PLY.replace("ascii", order).into_bytes();
        macro_rules! put {
            ($($number:expr),*) => {$(
                bytes.extend(if big { $number.to_be_bytes() } else { $number.to_le_bytes() });
            )*};
        }
        put!(2u8, 0i32, 1i32);
        put!(1f32, 2f32, 3f64, 0u8, 7f32, 4f32, 5f32, 6f64, 0u8, 8f32);
        bytes
    };
    vec![
        ("a.csv", "x,y,z,value\n1,2,3,7\n4,5,6,8\n".into()),
        ("a.tsv", "x\ty\tz\tvalue\n1\t2\t3\t7\n4\t5\t6\t8\n".into()),
        ("a.xyz", "1 2 3 7\n4 5  6 8\n".into()),
        ("named.xyz", "# value Z y x\n7 3 2 1\n# remark\n8\t6\t5\t4\n".into()),
        ("text.ply", format!("{PLY}2 0 1\n1 2 3 0 7\n4 5 6 0 8\n").into()),
        ("little.ply", binary("binary_little_endian", false)),
        ("big.ply", binary("binary_big_endian", true)),
        ("a.vtp", vtp("1 2 3 4 5 6").into()),
    ]
}

#[test]
fn points_of_every_format_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in point_examples() {
        let path = save(folder.path(), name, bytes);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.values, Some(vec![7.0, 8.0]), "{name}");
        assert_eq!(points.weights, None, "{name}");
    }
    let atoms = "2\na molecule\nC 1 2 3\nH 4 5 6 0.1\n";
    let points = read_points(&save(folder.path(), "m.xyz", atoms)).unwrap();
    assert_eq!((points.len(), points.values), (2, None));
    for (name, bytes) in examples() {
        let path = save(folder.path(), name, bytes);
        assert!(!walpha::points::is_point_file(&path).unwrap(), "{name}");
    }
    assert!(!walpha::points::is_point_file(folder.path()).unwrap());
}

#[test]
fn damaged_points_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let refuses = |name: &str, text: &str, part: &str| {
        let error = read_points(&save(folder.path(), name, text)).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let rows = "2 0 1\n1 2 3 0 7\n4 5 6 0 8\n";
    let ply = |from: &str, to: &str| (PLY.to_owned() + rows).replace(from, to);
    refuses("a.ply", "hello", "no PLY file");
    refuses("a.ply", &ply("format ascii 1.0\n", ""), "no format");
    refuses("a.ply", &ply("end_header", "end"), "not understood");
    refuses("a.ply", &ply("float x", "float q"), "properties x");
    refuses("a.ply", &ply("float y", "float x"), "properties x");
    refuses("a.ply", &ply("float x", "half x"), "half");
    refuses("a.ply", &ply("vertex 2", "vertex 3"), "truncated");
    refuses("a.ply", &ply("vertex 2", "vertex 99999999999"), "cannot hold");
    refuses("a.ply", &ply("vertex 2", "vertex 1"), "too long");
    refuses("a.ply", &ply("vertex 2", "vertex 0").replace(rows, "0\n"), "no point");
    refuses("a.ply", &ply("element vertex", "element corner"), "no element vertex");
    refuses("a.ply", &ply("1 2 3 0", "1 2 3 300"), "300");
    refuses("a.ply", &ply("1 2 3 0", "1 nan 3 0"), "y is NaN");
    refuses("a.xyz", "1 2\n", "2 columns");
    refuses("a.xyz", "1 2 3\n1 2 3 4\n", "line 2");
    refuses("a.xyz", "1 2 3\n1 two 3\n", "column y");
    refuses("a.xyz", "3\n\nC 1 2 3\n", "claims 3 atoms");
    refuses("a.vtp", &vtp("1 2 3 4 5"), "truncated");
    refuses("a.vtp", &vtp("1 2 3 4 5 6 7"), "more follow");
    refuses("a.vtp", &vtp("1 2 3 4 5 6").replace("PolyData", "Table"), "Table");
    refuses("a.vtp", &vtp("1 2 3 4 5 inf"), "z is inf");
}

fn scattered() -> Points {
    Points {
        positions: vec![
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [0.0, 0.0, 4.0],
            [1.0, 1.0, 1.0],
            [0.0, 0.0, 0.0],
        ],
        values: Some(vec![1.0, 2.0, 3.0, 5.0, 10.0, 4.0]),
        ..Points::default()
    }
}

/// A tetrahedron with a point in it, so that all places are neighbours; the last stands on the first.
#[test]
fn scattered_values_differ_from_their_delaunay_neighbours() {
    let differences = scattered_difference(&scattered()).unwrap();
    let mean = |n: [f64; 4]| n.iter().sum::<f64>() / 4.0;
    assert_eq!(
        differences,
        [
            mean([1.0, 2.0, 4.0, 9.0]),
            mean([1.0, 1.0, 3.0, 8.0]),
            mean([2.0, 1.0, 2.0, 7.0]),
            mean([4.0, 3.0, 2.0, 5.0]),
            mean([9.0, 8.0, 7.0, 5.0]),
            mean([2.0, 1.0, 1.0, 6.0]),
        ]
    );
    let without = Points { values: None, ..scattered() };
    assert!(matches!(scattered_difference(&without), Err(PointsError::NoValues)));
    let mut flat = scattered();
    flat.positions.iter_mut().for_each(|p| p[2] = 0.0);
    assert!(scattered_difference(&flat).unwrap_err().to_string().contains("in one plane"));
}

#[test]
fn the_command_weighs_scattered_values() {
    let folder = tempfile::tempdir().unwrap();
    let points = scattered();
    let mut text = String::from("x,y,z,value\n");
    for ([x, y, z], value) in points.positions.iter().zip(points.values.iter().flatten()) {
        text += &format!("{x},{y},{z},{value}\n");
    }
    save(folder.path(), "s.csv", &text);
    for weights in ["min-max", "barycentric", "barycentric-n"] {
        common::ok(folder.path(), &["points", "s.csv", "--weights", weights, "-o", "w.csv"]);
        let weights = read_points(&folder.path().join("w.csv")).unwrap().weights.unwrap();
        assert!(weights.iter().any(|&w| w > 0.0));
    }
    save(folder.path(), "bare.csv", text.replace("value", "other"));
    let (code, _, said) =
        common::run(folder.path(), &["points", "bare.csv", "--weights", "min-max"]);
    assert!(code == 1 && said.contains("column `value`"), "{said}");
}

fn shape() -> walpha::AlphaShape {
    let Points { positions, values, .. } = scattered();
    let points = WeightedPoints { weights: vec![0.0; positions.len()], positions, values };
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(f64::INFINITY).unwrap())).unwrap()
}

fn exported(format: Format, shape: &walpha::AlphaShape) -> Vec<u8> {
    let mut bytes = Vec::new();
    format.exporter(false).write(shape, &mut bytes).unwrap();
    bytes
}

/// The hull of a tetrahedron with a point inside: four facets, no point of them the inner one.
#[test]
fn written_shapes_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let shape = shape();
    for (format, extension, corners) in
        [(Format::Ply, "ply", 4), (Format::Vtp, "vtp", 4), (Format::Vtu, "vtu", 5)]
    {
        let path = save(folder.path(), &format!("s.{extension}"), exported(format, &shape));
        let back = read_points(&path).unwrap();
        assert_eq!(back.positions, shape.points().positions[..corners], "{extension}");
        assert_eq!(back.values.unwrap(), [1.0, 2.0, 3.0, 5.0, 10.0][..corners], "{extension}");
        assert_eq!(back.weights, Some(vec![0.0; corners]), "{extension}");
    }

    let stl = exported(Format::Stl, &shape);
    assert_eq!(stl.len(), 84 + 4 * 50);
    assert_eq!(stl[80..84], 4u32.to_le_bytes());
    let number = |place: usize| f32::from_le_bytes(stl[place..place + 4].try_into().unwrap());
    let mut volume = 0.0;
    for facet in 0..4 {
        let vector = |v: usize| [0, 1, 2].map(|c| number(84 + 50 * facet + 12 * v + 4 * c));
        let [n, a, b, c] = [0, 1, 2, 3].map(vector);
        let cross = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        volume += (a[0] * cross(1, 2) + a[1] * cross(2, 0) + a[2] * cross(0, 1)) / 6.0;
        assert!((n.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-6);
    }
    assert!((volume - 64.0 / 6.0).abs() < 1e-5, "outward: {volume}");

    let glb = exported(Format::Glb, &shape);
    let length =
        |place: usize| u32::from_le_bytes(glb[place..place + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], length(4), length(8)), (&b"glTF"[..], 2, glb.len()));
    let document: serde_json::Value = serde_json::from_slice(&glb[20..20 + length(12)]).unwrap();
    assert_eq!(document["accessors"][0]["max"], serde_json::json!([4.0, 4.0, 4.0]));
    assert_eq!(document["accessors"][2]["count"], 12);

    let path = save(folder.path(), "s.npz", exported(Format::Npz, &shape));
    let mut archive = payloads(&path);
    let cells = archive("cells");
    assert_eq!(cells.len(), shape.complex().cells.len() * 16);
    assert_eq!(archive("cells_classes"), vec![1; 4]);
    assert_eq!(archive("positions").len(), 6 * 24);
}

/// The payload of an array of an NPZ archive.
fn payloads(path: &Path) -> impl FnMut(&str) -> Vec<u8> {
    let mut archive = zip::ZipArchive::new(fs::File::open(path).unwrap()).unwrap();
    move |name| {
        let mut bytes = Vec::new();
        let mut member = archive.by_name(&format!("{name}.npy")).unwrap();
        std::io::copy(&mut member, &mut bytes).unwrap();
        let header = u16::from_le_bytes([bytes[8], bytes[9]]) as usize;
        bytes.split_off(10 + header)
    }
}

#[test]
fn stl_says_when_the_boundary_is_no_manifold() {
    assert_eq!(Format::Stl.exporter(false).remark(&shape()), None);
    // Two tetrahedra that touch at a vertex.
    let folder = tempfile::tempdir().unwrap();
    let text = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 -1 0\n-1 0 -1\n0 -1 -1\n";
    save(folder.path(), "two.xyz", text);
    let args = ["shape", "two.xyz", "--alpha", "0.75", "-o", "two.stl", "two.ply"];
    let (code, _, said) = common::run(folder.path(), &args);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("two.stl: the boundary is not manifold"), "{said}");
    assert!(said.contains("0 edges") && said.contains("1 other vert"), "{said}");
    assert!(!said.contains("two.ply"), "{said}");
    let (_, _, said) = common::run(folder.path(), &[&args[..], &["--quiet"]].concat());
    assert_eq!(said, "");
}

/// The system's allocator, which remembers the largest piece asked for.
struct Remembering;

static LARGEST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is handed to the system's allocator as it came.
unsafe impl GlobalAlloc for Remembering {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LARGEST.fetch_max(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promises are those the system's allocator asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        LARGEST.fetch_max(layout.size(), Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LARGEST.fetch_max(size, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Remembering = Remembering;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Bytes changed anywhere and files cut anywhere make errors or other numbers: no panic, no
    /// hang, and no allocation beyond what the file can hold.
    #[test]
    fn no_damage_does_harm(
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
        let started = Instant::now();
        let _ = open(&path);
        let _ = walpha::points::is_point_file(&path);
        let _ = read_points(&path);
        prop_assert!(started.elapsed() < Duration::from_secs(10), "{name} hangs");
        let largest = LARGEST.load(Ordering::Relaxed);
        prop_assert!(largest < 1 << 30, "{name} asks for {largest} bytes");
    }
}
