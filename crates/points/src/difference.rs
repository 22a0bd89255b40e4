use ndarray::Array3;
use walpha_base::parallel::prelude::*;
use walpha_regular::{Triangulation, triangulate};

use super::{Points, PointsError};
use walpha_volume::Volume;

/// The minimum number of voxel rows in one parallel task.
const ROWS: usize = 32;

/// The difference L of each voxel, `[z, y, x]`: a sixth of the sum of |f(voxel) − f(neighbour)|
/// over its neighbours in ±x, ±y and ±z, where a missing neighbour adds 0.
///
/// The result is in double precision: the six differences are exact unless samples differ 2²⁸-fold in magnitude, so voxels of
/// equal L have the same double, which is the one nearest to L. O(n), parallel.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn difference(volume: &Volume) -> Array3<f64> {
    let [nx, ny, nz] = volume.dims().xyz();
    let samples = volume.as_slice();
    let mut differences = vec![0.0; samples.len()];
    let rows = differences.par_chunks_mut(nx).with_min_len(ROWS).enumerate();
    rows.for_each(|(row, differences)| {
        let (y, z) = (row % ny, row / ny);
        // The row itself replaces a missing neighbour, and adds 0.
        let at = |y: usize, z: usize| &samples[(z * ny + y) * nx..][..nx];
        let neighbours = [
            at(y.saturating_sub(1), z),
            at((y + 1).min(ny - 1), z),
            at(y, z.saturating_sub(1)),
            at(y, (z + 1).min(nz - 1)),
        ];
        row_differences(at(y, z), neighbours, 6.0, differences);
    });
    Array3::from_shape_vec(volume.dims().shape(), differences).expect("one for each voxel")
}

/// The differences along a single row, with a given divisor: the worked example of the paper's Table 1.
///
/// ```
/// use walpha_points::internal::difference_row;
///
/// assert_eq!(difference_row(&[8.0, 8.0, 4.0, 4.0], 2.0), [0.0, 2.0, 2.0, 0.0]);
/// ```
pub fn difference_row(row: &[f32], divisor: f64) -> Vec<f64> {
    let mut differences = vec![0.0; row.len()];
    row_differences(row, [row; 4], divisor, &mut differences);
    differences
}

/// The differences of a row, from neighbours in the row itself and in the four rows next to it.
fn row_differences(row: &[f32], neighbours: [&[f32]; 4], divisor: f64, differences: &mut [f64]) {
    let n = row.len();
    let [a, b, c, d] = neighbours.map(|row| &row[..n]);
    let at = |i: usize, left: f32, right: f32| {
        let value = f64::from(row[i]);
        let from = |other: f32| (value - f64::from(other)).abs();
        let sum = from(left) + from(right) + from(a[i]) + from(b[i]) + from(c[i]) + from(d[i]);
        sum / divisor
    };
    let differences = &mut differences[..n];
    // Slices of equal length let the compiler vectorise the middle; the ends follow below.
    if n > 2 {
        let m = n - 2;
        let (left, here, right) = (&row[..m], &row[1..][..m], &row[2..][..m]);
        let [a, b, c, d] = [a, b, c, d].map(|row| &row[1..][..m]);
        for (i, difference) in differences[1..][..m].iter_mut().enumerate() {
            let value = f64::from(here[i]);
            let from = |other: f32| (value - f64::from(other)).abs();
            let sum =
                from(left[i]) + from(right[i]) + from(a[i]) + from(b[i]) + from(c[i]) + from(d[i]);
            *difference = sum / divisor;
        }
    }
    if n > 0 {
        differences[0] = at(0, row[0], row[1.min(n - 1)]);
        differences[n - 1] = at(n - 1, row[n.saturating_sub(2)], row[n - 1]);
    }
}

/// The difference L of each scattered point: the mean of |F(point) − F(neighbour)| over its
/// neighbours in the Delaunay triangulation of the positions.
///
/// Of several points at one position, only the first is in the triangulation; all share its neighbours, and each uses its own
/// value. On a regular grid, where many neighbours lie on one sphere, the symbolic perturbation chooses among them. Sums are
/// doubles, in ascending order of the neighbours. Takes the time and memory of a triangulation.
///
/// # Errors
/// The points have no values; and the errors of [`triangulate`]: numbers that are not finite, fewer than four distinct positions,
/// or coplanar positions.
pub fn scattered_difference(points: &Points) -> Result<Vec<f64>, PointsError> {
    let values = points.values.as_deref().ok_or(PointsError::NoValues)?;
    let delaunay = triangulate(&points.positions, None)?;
    let neighbours = Neighbours::of(&delaunay);

    let mut vertex_of: Vec<u32> = (0..delaunay.infinite_vertex()).collect();
    for &[removed, kept] in delaunay.duplicates() {
        vertex_of[removed as usize] = kept;
    }
    let difference = |(&value, &vertex): (&f64, &u32)| {
        let around = neighbours.around(vertex);
        let from = |&other: &u32| (value - values[other as usize]).abs();
        around.iter().map(from).sum::<f64>() / around.len() as f64
    };
    Ok(values.iter().zip(&vertex_of).map(difference).collect())
}

/// The neighbours of all points, ascending, in one list.
struct Neighbours {
    /// The end of the neighbours of each point in `vertices`.
    ends: Vec<usize>,
    vertices: Vec<u32>,
}

impl Neighbours {
    fn of(delaunay: &Triangulation) -> Self {
        let edges_of = |[a, b, c, d]: [u32; 4]| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]];
        // All edges of the hull are edges of finite cells.
        let edges = delaunay.finite_cells().flat_map(|(_, corners)| edges_of(corners));
        let mut pairs: Vec<[u32; 2]> = edges.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut ends = vec![0; delaunay.infinite_vertex() as usize];
        for (i, &[vertex, _]) in pairs.iter().enumerate() {
            ends[vertex as usize] = i + 1;
        }
        // Duplicates have no neighbours.
        for v in 1..ends.len() {
            ends[v] = ends[v].max(ends[v - 1]);
        }
        Self { ends, vertices: pairs.into_iter().map(|[_, neighbour]| neighbour).collect() }
    }

    /// The neighbours of a vertex. They are never empty: every position of an unweighted triangulation is a vertex.
    fn around(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        let start = if vertex == 0 { 0 } else { self.ends[vertex - 1] };
        &self.vertices[start..self.ends[vertex]]
    }
}
