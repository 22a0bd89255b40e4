//! NPY.

use super::*;

fn npy<T: WritableElement>(array: &Array3<T>) -> Vec<u8> {
    let mut bytes = Vec::new();
    array.write_npy(&mut bytes).unwrap();
    bytes
}

#[test]
fn npy_arrays_of_every_type_and_order() {
    let folder = Folder::new();
    macro_rules! each {
        ($($type:ty),*) => {$(
            let c = Array3::from_shape_fn((2, 3, 4), |(z, y, x)| (100 * z + 10 * y + x) as $type);
            let mut fortran = Array3::zeros((2, 3, 4).f());
            fortran.assign(&c);
            for array in [c, fortran] {
                let volume = read(&folder.file("v.npy", &npy(&array)), &known()).unwrap();
                assert_eq!(volume.dims().xyz(), [4, 3, 2]);
                assert_eq!(volume.samples()[[1, 2, 3]], 123.0);
                assert_eq!(volume.as_slice()[4], 10.0);
                assert_eq!(volume.has_gray_levels(), size_of::<$type>() == 1 && <$type>::MAX as u8 == 255);
            }
        )*};
    }
    each!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64);
    let (payload, expected) = three(Dtype::I16, Endian::Big);
    let header = "{'descr': '>i2', 'fortran_order': False, 'shape': (3, 1, 1), }\n";
    let volume = read(&folder.file("v.npy", &npy_of(header, &payload)), &known()).unwrap();
    assert_eq!(volume.as_slice(), expected);
    let mask = Array3::from_shape_vec((1, 1, 2), vec![true, false]).unwrap();
    let volume = read(&folder.file("mask", &npy(&mask)), &known()).unwrap();
    assert_eq!(volume.as_slice(), [1.0, 0.0]);
    assert!(!volume.has_gray_levels(), "0 and 1 are not gray levels");
}

#[test]
fn damaged_npy_files_are_refused() {
    let folder = Folder::new();
    let refuses = |bytes: &[u8], parts: &[&str]| folder.refuses("v.npy", bytes, &known(), parts);
    let good = npy(&Array3::<f32>::zeros((2, 2, 2)));
    refuses(b"", &["is empty"]);
    refuses(b"hello world", &["not an NPY file"]);
    refuses(&good[..40], &["truncated"]);
    refuses(&good[..good.len() - 1], &["32 bytes", "31", "truncated"]);
    refuses(&[&good[..], b"x"].concat(), &["32 bytes", "33", "too long"]);
    let header = |descr: &str, order: &str, shape: &str| {
        npy_of(
            &format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}}}"),
            &[0; 4],
        )
    };
    assert!(read(&folder.file("v.npy", &header("'<f4'", "False", "(1, 1, 1)")), &known()).is_ok());
    refuses(&header("'<f4'", "False", "(1,)"), &["1 axes", "three"]);
    refuses(&header("'<c8'", "False", "(1, 1, 1)"), &["<c8"]);
    refuses(&header("'<f2'", "False", "(1, 1, 1)"), &["<f2", "astype"]);
    refuses(&header("[('a', '<f4')]", "False", "(1, 1, 1)"), &["('a', '<f4')"]);
    refuses(&header("'é'", "False", "(1, 1, 1)"), &["é"]);
    refuses(&header("'<f4'", "Perhaps", "(1, 1, 1)"), &["not understood"]);
    refuses(&header("'<f4'", "False", "(1, -1, 1)"), &["not understood"]);
    refuses(&header("'<f4'", "False", "(0, 1, 1)"), &["1×1×0", "empty"]);
    refuses(b"\x93NUMPY\x09\x00..", &["version 9"]);
    let infinite = npy(&Array3::from_elem((1, 2, 2), f32::NEG_INFINITY));
    refuses(&infinite, &["[0, 0, 0]", "-inf"]);
    // 10³⁰⁰ is finite in the file, and no f32.
    refuses(&npy(&Array3::from_elem((1, 1, 1), 1e300)), &["inf"]);
}
