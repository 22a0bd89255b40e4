//! The output of the command: help, and the errors of wrong arguments, as recorded in `tests/texts`. A changed text is recorded
//! with `TRYCMD=overwrite cargo test --release --test texts`, and reviewed in the diff.

/// Only for the default features, because help lists the built-in ones.
#[cfg(all(
    feature = "paper",
    not(any(feature = "dicom", feature = "las", feature = "mpi", feature = "zarr"))
))]
#[test]
fn texts_are_those_recorded() {
    trycmd::TestCases::new().case("tests/texts/*.trycmd");
}
