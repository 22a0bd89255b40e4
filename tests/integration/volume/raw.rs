//! Raw samples.

use super::*;

#[test]
fn raw_samples_of_every_type_and_order() {
    let folder = Folder::new();
    for dtype in Dtype::ALL {
        for endian in [Endian::Little, Endian::Big] {
            let (payload, expected) = three(dtype, endian);
            for offset in [0, 7] {
                let bytes = [vec![9; offset], payload.clone()].concat();
                let options = raw([3, 1, 1], dtype, endian, offset as u64);
                let volume = read(&folder.file("v.raw", &bytes), &options).unwrap();
                assert_eq!(volume.as_slice(), expected, "{dtype} {endian}");
                assert_eq!(volume.has_gray_levels(), dtype == Dtype::U8);
            }
        }
    }
}

#[test]
fn raw_samples_run_along_x_first() {
    let folder = Folder::new();
    let path = folder.file("v.raw", &(0..24).collect::<Vec<u8>>());
    let volume = read(&path, &raw([4, 3, 2], Dtype::U8, Endian::Little, 0)).unwrap();
    assert_eq!(volume.samples()[[1, 2, 3]], 23.0);
    assert_eq!(volume.samples()[[0, 0, 3]], 3.0);
    assert_eq!(volume.samples()[[0, 1, 0]], 4.0);
}

#[test]
fn raw_files_of_another_length_are_refused() {
    let folder = Folder::new();
    let options = raw([64, 64, 64], Dtype::U8, Endian::Little, 0);
    let long = vec![0; 262_147];
    folder.refuses(
        "s.raw",
        &long[..262_143],
        &options,
        &["64×64×64 samples of type u8 needs 262144 bytes", "has 262143"],
    );
    folder.refuses("s.raw", &long, &options, &["has 262147", "header of 3 bytes", "`offset`"]);
    folder.refuses("s.raw", &[], &options, &["has 0", "empty"]);
    let offset = raw([64, 64, 64], Dtype::U8, Endian::Little, 5);
    folder.refuses(
        "s.raw",
        &long,
        &offset,
        &["needs 262149 bytes, 5 of them before", "has 262147"],
    );
    let huge = raw([1625, 1625, 1625], Dtype::F64, Endian::Little, u64::MAX);
    folder.refuses("s.raw", &long, &huge, &["has 262147"]);
}
