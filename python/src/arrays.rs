//! Arrays of numpy as the library takes them, and back.

use numpy::ndarray::{ArrayView2, Ix1, Ix2};
use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray};
use pyo3::prelude::*;

use crate::errors::wrong;

/// Rows of `N` numbers, copied once: the work owns them, as it may outlive the call that is interrupted.
pub fn rows<const N: usize, T: Element + Copy>(
    name: &str,
    array: &PyReadonlyArray<'_, T, Ix2>,
) -> PyResult<Vec<[T; N]>> {
    let array = array.as_array();
    if array.ncols() != N {
        let shape = array.shape();
        return Err(wrong(format!("{name} has shape {shape:?}, expected (n, {N})")));
    }
    Ok(match array.as_slice() {
        Some(flat) => flat.as_chunks::<N>().0.to_vec(),
        None => array.rows().into_iter().map(|row| std::array::from_fn(|k| row[k])).collect(),
    })
}

/// Numbers, copied once.
pub fn numbers<T: Element + Copy>(array: &PyReadonlyArray<'_, T, Ix1>) -> Vec<T> {
    array.as_array().to_vec()
}

/// An array over rows that an object owns, without a copy; nobody can write to it.
///
/// # Safety
/// The rows must stay where they are, unchanged, as long as `owner` lives.
pub unsafe fn lend<'py, const N: usize, T: Element>(
    rows: &[[T; N]],
    owner: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let view = ArrayView2::from_shape((rows.len(), N), rows.as_flattened())
        .expect("as many numbers as rows and columns");
    // SAFETY: the array keeps the owner alive, and the caller vouches for the rest.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}
