//! Small files of each format.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use ndarray::Array3;
use walpha::volume::*;

use crate::common::Told;

/// Samples 0, 2, 4, … of a 3×2×2 grid, in the byte order of most files.
pub fn shorts() -> Vec<u8> {
    (0..12i16).flat_map(|i| (2 * i).to_le_bytes()).collect()
}

pub fn numbers() -> Vec<f32> {
    (0..12).map(|i| 2.0 * i as f32).collect()
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn base64(bytes: &[u8]) -> String {
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

pub fn save(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

pub fn open(path: &Path) -> Result<Volume, VolumeError> {
    read(path, &ReadOptions::default())
}

/// Reads bytes under a name; the error must name the file and these parts.
pub fn refuses(name: &str, bytes: impl AsRef<[u8]>, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let text = open(&save(folder.path(), name, bytes)).unwrap_err().told();
    for part in parts.iter().chain(&[name]) {
        assert!(text.contains(part), "{part:?} is missing in: {text}");
    }
}

/// A volume as a file of this extension.
pub fn written(extension: &str, volume: &Volume) -> Vec<u8> {
    let mut bytes = Vec::new();
    let writer = VolumeWriter::of(Path::new(&format!("v.{extension}"))).unwrap();
    writer.write(volume, &mut bytes).unwrap();
    bytes
}

/// A turn about z and a flip, so that a transposed matrix is found out.
pub fn turned() -> Frame {
    let axes = [[0.3, 0.4, 0.0], [0.8, -0.6, 0.0], [0.0, 0.0, -2.0]];
    Frame::from_axes([1.5, -2.0, 30.0], axes).unwrap()
}

pub fn close(a: &Frame, b: &Frame) -> bool {
    let all = |f: &Frame| [f.origin, f.spacing, f.direction[0], f.direction[1], f.direction[2]];
    all(a).as_flattened().iter().zip(all(b).as_flattened()).all(|(a, b)| (a - b).abs() < 1e-6)
}

pub const NRRD: &str = "NRRD0004\n# a remark\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\n\
                    encoding: raw\nkey:=value\n";
pub const MHA: &str = "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nElementType = MET_SHORT\n";
pub const VTK: &str = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET STRUCTURED_POINTS\n\
                   DIMENSIONS 3 2 2\nSPACING 1 2 3\nORIGIN 4 5 6\nPOINT_DATA 12\n\
                   SCALARS s short\nLOOKUP_TABLE default\n";

pub fn nrrd(change: impl Fn(String) -> String, payload: &[u8]) -> Vec<u8> {
    [change(NRRD.into()).as_bytes(), b"\n", payload].concat()
}

pub fn vti(attributes: &str, array: &str, appended: &[u8]) -> Vec<u8> {
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
pub fn tiff(pages: usize, description: Option<&str>) -> Vec<u8> {
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

pub fn npz(arrays: &[(&str, &Array3<f32>)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).unwrap();
        ndarray_npy::WriteNpyExt::write_npy(*array, &mut archive).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// A valid small file of each format, whose samples are [`numbers`].
pub fn examples() -> Vec<(&'static str, Vec<u8>)> {
    let text = numbers().iter().map(f32::to_string).collect::<Vec<_>>().join(" ");
    let volume = Array3::from_shape_vec((2, 2, 3), numbers()).unwrap();
    let own = |extension: &str| written(extension, &Volume::new(volume.clone(), turned()).unwrap());
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
        ("one.nii", own("nii")),
        ("one.nii.gz", own("nii.gz")),
        ("ours.nrrd", own("nrrd")),
        ("pages.tif", tiff(2, None)),
        ("arrays.npz", npz(&[("a", &volume)])),
    ]
}

pub const PLY: &str = "ply\nformat ascii 1.0\ncomment c\nelement face 1\nproperty list uchar int vertex_indices\n\
                   element vertex 2\nproperty float x\nproperty float y\nproperty double z\n\
                   property uchar red\nproperty float Value\nend_header\n";

pub fn vtp(array: &str) -> String {
    format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>\
         <Piece NumberOfPoints=\"2\"><PointData Scalars=\"temperature\">\
         <DataArray type=\"Float32\" Name=\"temperature\" format=\"ascii\">7 8</DataArray>\
         </PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
         format=\"ascii\">{array}</DataArray></Points></Piece></PolyData></VTKFile>"
    )
}

/// A small file of each point format, all of the points (1, 2, 3) and (4, 5, 6) with values 7 and 8.
pub fn point_examples() -> Vec<(&'static str, Vec<u8>)> {
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
