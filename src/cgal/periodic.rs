//! `Periodic_3_regular_triangulation_3`.

use walpha_complex::canonical::sorted;
use walpha_regular::Torus;
use walpha_regular::internals::{AXES, Sites};

use super::{Error, or_zeros, thrown};

/// The entry point of `cpp/periodic.cc`.
#[allow(unused_qualifications, reason = "in what the macro writes")]
#[cxx::bridge(namespace = "walpha")]
mod bridge {
    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/periodic.h");

        /// The cells of a periodic triangulation.
        type PeriodicTriangulation;

        fn is_single(self: &PeriodicTriangulation) -> bool;
        fn cells(self: &PeriodicTriangulation) -> &[u32];

        fn periodic(
            positions: &[f64],
            weights: &[f64],
            side: f64,
        ) -> Result<UniquePtr<PeriodicTriangulation>>;
    }
}

/// The cells of CGAL's `Periodic_3_regular_triangulation_3` of points in a cube whose opposite faces are identified, from 0 to
/// `side` along each axis. `None` if the points are so few or so uneven that CGAL needs several copies of the cube.
///
/// Each cell is a row of point indices, ascending; rows are in lexicographic order. The corners of a cell are the copies that are
/// nearest to each other. Without weights it is the periodic Delaunay triangulation.
///
/// Weights, squared lengths, must be at least 0 and less than 1/64 of the squared side, as CGAL requires. Ties between
/// cospherical points may be broken differently from [`walpha_shape::Filtration::on`](walpha_shape::ladder::Filtration::on).
///
/// CGAL works on 27 copies of the cube until one is enough: about a millisecond and 20 to 50 kB a point for a few thousand
/// points.
///
/// # Errors
/// [`Error::Side`], [`Error::Outside`], [`Error::Weight`]; [`Error::Sites`]: the numbers of weights and points differ, or there
/// is no point. [`Error::Cgal`]: out of memory, or a bug in the program.
pub fn periodic_regular_triangulation_3(
    positions: &[[f64; 3]],
    weights: Option<&[f64]>,
    side: f64,
) -> Result<Option<Vec<[u32; 4]>>, Error> {
    let weights = or_zeros(weights, positions.len());
    let (low, high) = (Torus::MIN_SIDE, Torus::MAX_SIDE);
    // NaN is outside every range.
    if !(low..=high).contains(&side) {
        return Err(Error::Side { side, low, high });
    }
    let sites = Sites::any(positions, &weights)?;
    for (index, position) in positions.iter().enumerate() {
        for (axis, &value) in AXES.into_iter().zip(position) {
            if !(0.0..side).contains(&value) {
                return Err(Error::Outside { index, axis, value, side });
            }
        }
    }
    let limit = side * side / 64.0;
    if let Some(index) = weights.iter().position(|weight| !(0.0..limit).contains(weight)) {
        return Err(Error::Weight { index, weight: weights[index], limit });
    }
    let found = bridge::periodic(sites.positions().as_flattened(), sites.weights(), side)
        .map_err(thrown("periodic triangulation"))?;
    if !found.is_single() {
        return Ok(None);
    }
    let named = |cell: &[u32; 4]| sorted(cell.map(|site| sites.input()[site as usize]));
    let mut cells: Vec<_> = found.cells().as_chunks().0.iter().map(named).collect();
    cells.sort_unstable();
    Ok(Some(cells))
}
