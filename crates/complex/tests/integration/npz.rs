//! NPZ of other programs, in any number type, byte order and order of axes; and NPZ with false claims.

use std::io::Cursor;

use walpha_complex::schema::{ComplexFile, SchemaError};
use walpha_complex::{Alpha, Class};
use zip::CompressionMethod;

use crate::archive::{archive, npy};

/// A tetrahedron whose cells are an array of this type and data.
fn read(descr: &str, cells: &[u8]) -> Result<ComplexFile, SchemaError> {
    let points: [[f32; 3]; 4] = [[0.0; 3], [1.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -1.0]];
    let points: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_be_bytes()).collect();
    let arrays = [
        ("points", npy(">f4", "(4, 3)", &points)),
        ("alpha", npy("<i8", "()", &(-2i64).to_le_bytes())),
        ("cells", npy(descr, "(1, 4)", cells)),
        ("cell_classes", npy("|u1", "(1,)", &[1])),
    ];
    ComplexFile::read_npz(Cursor::new(archive(&arrays, CompressionMethod::Deflated)))
}

#[test]
fn any_number_type_will_do() {
    let cell = [0u8, 3, 1, 2];
    let little = |width: usize| -> Vec<u8> {
        cell.iter().flat_map(|&v| [vec![v], vec![0; width - 1]].concat()).collect()
    };
    let big = |width: usize| -> Vec<u8> {
        cell.iter().flat_map(|&v| [vec![0; width - 1], vec![v]].concat()).collect()
    };
    let float = |bytes: fn(u8) -> Vec<u8>| cell.iter().flat_map(|&v| bytes(v)).collect::<Vec<u8>>();
    for (descr, data) in [
        ("|u1", little(1)),
        ("|i1", little(1)),
        ("<u2", little(2)),
        ("<i2", little(2)),
        ("<u4", little(4)),
        ("<i4", little(4)),
        ("<u8", little(8)),
        ("<i8", little(8)),
        (">u2", big(2)),
        (">i2", big(2)),
        (">u4", big(4)),
        (">i4", big(4)),
        (">u8", big(8)),
        (">i8", big(8)),
        ("<f4", float(|v| f32::from(v).to_le_bytes().into())),
        (">f4", float(|v| f32::from(v).to_be_bytes().into())),
        ("<f8", float(|v| f64::from(v).to_le_bytes().into())),
        (">f8", float(|v| f64::from(v).to_be_bytes().into())),
    ] {
        let file = read(descr, &data).unwrap();
        assert_eq!(file.cells, Some(vec![[0, 3, 1, 2]]), "{descr}");
        assert_eq!(file.points[1..], [[1.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -1.0]]);
        assert_eq!(file.alpha, Alpha::from_squared(-2.0).unwrap());
        assert_eq!(file.classes.cells, Some(vec![Class::Interior]));
    }
}

#[test]
fn other_types_and_numbers_are_refused() {
    for (descr, data, part) in [
        ("<c16", vec![0; 64], "elements of type <c16"),
        ("<u2", vec![0; 32], "32 bytes of elements, expected 8"),
        ("|i1", vec![0, 1, 2, 255], "`cells` holds -1, expected a point number"),
        ("<f4", [0.5f32; 4].map(f32::to_le_bytes).concat(), "`cells` holds 0.5"),
    ] {
        let error = read(descr, &data).unwrap_err().to_string();
        assert!(error.contains(part), "{descr}: {error}");
    }
}

/// The first axis is fastest, as in `numpy.asfortranarray`.
#[test]
fn columns_may_come_first() {
    let cells: Vec<u8> = [[0, 4], [1, 5], [2, 6], [3, 7]].concat();
    let mut array = npy("|u1", "(2, 4)", &cells);
    let order = array.windows(5).position(|word| word == b"False").unwrap();
    array[order..order + 5].copy_from_slice(b"True ");
    let alpha = npy("<f8", "()", &f64::INFINITY.to_le_bytes());
    let bytes = archive(&[("cells", array), ("alpha", alpha)], CompressionMethod::Stored);
    let file = ComplexFile::read_npz(Cursor::new(bytes)).unwrap();
    assert_eq!(file.cells, Some(vec![[0, 1, 2, 3], [4, 5, 6, 7]]));
    assert_eq!(file.alpha, Alpha::INFINITE);
}

fn npz_error(arrays: &[(&str, Vec<u8>)], method: CompressionMethod) -> SchemaError {
    ComplexFile::read_npz(Cursor::new(archive(arrays, method))).unwrap_err()
}

/// A header is compared with the existing bytes before memory is reserved.
#[test]
fn an_array_that_claims_what_is_not_there() {
    let alpha = ("alpha", npy("<f8", "()", &1f64.to_le_bytes()));
    let cells = ("cells", npy("<u4", "(0, 4)", &[]));
    let points = ("points", npy("<f8", "(1099511627776, 3)", &[0; 48]));
    let error = npz_error(&[points, alpha.clone(), cells.clone()], CompressionMethod::Stored);
    assert!(matches!(error, SchemaError::Array { name: "points", .. }), "{error}");
    assert!(error.to_string().contains("[1099511627776, 3]"), "{error}");
    let few = ("points", npy("<f8", "(2, 3)", &[0; 48]));
    let weights = ("weights", npy("<f8", "(1099511627776,)", &[0; 48]));
    let error = npz_error(&[few, weights, alpha, cells], CompressionMethod::Stored);
    assert!(matches!(error, SchemaError::Lengths { name: "weights", .. }), "{error}");
}

/// A bomb: 48 MB of zeros in 48 kB. Different points cannot be compressed so well.
#[test]
fn an_array_that_only_repeats_itself() {
    let zeros = npy("<f8", "(2000000, 3)", &vec![0; 48_000_000]);
    let alpha = ("alpha", npy("<f8", "()", &1f64.to_le_bytes()));
    let cells = ("cells", npy("<u4", "(0, 4)", &[]));
    let error = npz_error(&[("points", zeros), alpha, cells], CompressionMethod::Deflated);
    assert!(matches!(error, SchemaError::Array { name: "points", .. }), "{error}");
    assert!(error.to_string().contains("does not repeat itself"), "{error}");
}

/// Arrays longer than the part that is read at once. The first number that is not a point's is named, at any position.
#[test]
fn long_arrays_are_read_whole() {
    const ROWS: usize = 600_000;
    let alpha = ("alpha", npy("<f8", "()", &1f64.to_le_bytes()));
    let number = |i: usize| (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
    let read = |numbers: &[u64]| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        let cells = ("cells", npy("<u8", &format!("({ROWS}, 4)"), &bytes));
        let bytes = archive(&[alpha.clone(), cells], CompressionMethod::Stored);
        ComplexFile::read_npz(Cursor::new(bytes))
    };
    let mut numbers: Vec<u64> = (0..4 * ROWS).map(number).collect();
    let cells = read(&numbers).unwrap().cells.unwrap();
    assert_eq!(cells.len(), ROWS);
    assert!(
        cells.as_flattened().iter().zip(&numbers).all(|(&read, &number)| u64::from(read) == number)
    );
    numbers[2_000_000] = 1 << 40;
    numbers[2_300_000] = 1 << 41;
    let error = read(&numbers).unwrap_err().to_string();
    assert!(error.contains("`cells` holds 1099511627776"), "{error}");
}
