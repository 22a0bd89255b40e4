//! `walpha._walpha`: what the Python package `walpha` asks of the library.
//!
//! Arrays go in and out, options are passed as numbers and names, and small data with many fields as JSON. Names, defaults and
//! documentation for people are in Python (`walpha/*.py`). Long work runs in separate threads, without the interpreter (`work`).

mod allocator;
mod arrays;
mod boxes;
mod call;
mod complex;
mod errors;
mod filtration;
mod many;
mod molecule;
mod points;
mod shape;
mod triangulation;
mod volume;
mod work;
mod workers;

/// The module.
///
/// It needs no global lock. Every class is frozen and `Sync`, so the compiler has checked that threads may share its objects. The
/// `unsafe` code lends memory of frozen objects to arrays that cannot be written to, and keeps the owner alive; the allocator
/// passes requests on to the system's. Data that one call changes belongs to that call (`call`). A given array is copied before
/// the work begins; as with numpy, it must not be written to meanwhile.
#[pyo3::pymodule(gil_used = false)]
mod _walpha {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::boxes::{periodic_power_diagram, pores};
    #[pymodule_export]
    use super::complex::{Complex, compare};
    #[pymodule_export]
    use super::filtration::{Filtration, Simplices, persistence_svg};
    #[pymodule_export]
    use super::many::{alpha_shapes, diagrams, filtrations};
    #[pymodule_export]
    use super::molecule::read_molecule;
    #[pymodule_export]
    use super::points::{columns, point_column, point_columns, read_points, write_points};
    #[pymodule_export]
    use super::shape::{Shape, Union, alpha_shape, restored, write_whole};
    #[pymodule_export]
    use super::triangulation::{PowerDiagram, Triangulation};
    #[pymodule_export]
    use super::volume::{difference, haar, label_shape, pipeline, read, select, weigh};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// Runs the command line `walpha`, whose arguments these are, and returns its exit code.
    #[pyfunction]
    fn command(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
        py.detach(|| walpha::cli::run(arguments))
    }

    /// Removes files that are not complete: for the end of the process, which may come in the midst of
    /// interrupted work.
    #[pyfunction]
    fn sweep() {
        walpha::export::sweep();
    }
}
