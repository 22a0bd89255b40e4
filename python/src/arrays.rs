//! Arrays of numpy as the library takes them, and back.
//!
//! The caller must release what is read: numpy keeps track of the readers of an array, by its shape, and panics if that is
//! different when the reader is done. So reading must be done before any Python code runs, such as a callback for progress.

use numpy::ndarray::{Array2, Array3, ArrayView2, Ix1, Ix2, Ix3};
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use crate::errors::wrong;

/// Rows of `N` numbers, copied once: the work owns them, as it may outlive the call that is interrupted.
pub fn rows<const N: usize, T: Element + Copy>(
    name: &str,
    array: PyReadonlyArray<'_, T, Ix2>,
) -> PyResult<Vec<[T; N]>> {
    let view = array.as_array();
    if view.ncols() != N {
        let shape = view.shape();
        return Err(wrong(format!("{name} has shape {shape:?}, expected (n, {N})")));
    }
    let mut rows = room(view.nrows())?;
    match view.as_slice() {
        Some(flat) => rows.extend_from_slice(flat.as_chunks::<N>().0),
        None => {
            rows.extend(
                view.rows().into_iter().map(|row| std::array::from_fn::<T, N, _>(|k| row[k])),
            );
        }
    }
    drop(array);
    Ok(rows)
}

/// Numbers, copied once.
pub fn numbers<T: Element + Copy>(array: PyReadonlyArray<'_, T, Ix1>) -> PyResult<Vec<T>> {
    let view = array.as_array();
    let mut numbers = room(view.len())?;
    numbers.extend(view);
    drop(array);
    Ok(numbers)
}

/// Samples of a volume, copied once, x fastest.
pub fn samples(array: PyReadonlyArray<'_, f32, Ix3>) -> PyResult<Array3<f32>> {
    let view = array.as_array();
    let (dim, mut samples) = (view.dim(), room(view.len())?);
    samples.extend(view);
    drop(array);
    Ok(Array3::from_shape_vec(dim, samples).expect("as many samples as in the array"))
}

/// A new array of these numbers.
pub fn column<'py, T: Element>(
    py: Python<'py>,
    numbers: impl ExactSizeIterator<Item = T>,
) -> PyResult<Bound<'py, PyArray1<T>>> {
    let mut column = room(numbers.len())?;
    column.extend(numbers);
    Ok(column.into_pyarray(py))
}

/// Rows of `N` as an array.
pub fn array2<const N: usize, T>(rows: Vec<[T; N]>) -> Array2<T> {
    let count = rows.len();
    Array2::from_shape_vec((count, N), rows.into_flattened()).expect("as many numbers in each row")
}

/// A copy of a slice.
pub fn copied<T: Copy>(items: &[T]) -> PyResult<Vec<T>> {
    let mut copy = room(items.len())?;
    copy.extend_from_slice(items);
    Ok(copy)
}

/// Allocates room for this number of items, or fails with `MemoryError`. These copies are made in Python's own thread, where no
/// other failure can be survived.
fn room<T>(count: usize) -> PyResult<Vec<T>> {
    let mut items = Vec::new();
    let refused = |_| {
        let bytes = count as u128 * size_of::<T>() as u128;
        PyMemoryError::new_err(format!("not enough memory: a copy of an array needs {bytes} bytes"))
    };
    items.try_reserve_exact(count).map_err(refused)?;
    Ok(items)
}

/// An array over rows that an object owns, without a copy. It cannot be written to.
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
