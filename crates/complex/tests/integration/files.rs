//! Files of either kind.

use std::path::Path;

use walpha_complex::schema::{AnyFile, ComplexFile, FiltrationFile};
use zip::CompressionMethod;

use crate::archive::{archive, npy};

/// Errors of a complex are reported as such, although the file might be read as a filtration.
#[test]
fn errors_are_those_of_the_kind_of_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let points = npy("<f8", "(1, 3)", &[0; 24]);
    let numbers = npy("<f8", "(2,)", &[0; 16]);
    let npz = |name: &str| {
        archive(&[("points", points.clone()), (name, numbers.clone())], CompressionMethod::Stored)
    };
    for (name, bytes, is_filtration) in [
        ("a.json", br#"{"points":[[0,0,0]],"alpha":"big"}"#.to_vec(), false),
        ("b.json", br#"{"points":[[0,0,0]],"order":[0]}"#.to_vec(), true),
        ("a.npz", npz("alpha"), false),
        ("b.npz", npz("order"), true),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        let complex = ComplexFile::open(&path).unwrap_err().to_string();
        let filtration = FiltrationFile::open(&path).unwrap_err().to_string();
        assert_ne!(complex, filtration);
        let expected = if is_filtration { filtration } else { complex };
        assert_eq!(AnyFile::open(&path).unwrap_err().to_string(), expected, "{name}");
    }
}
