//! Isosurfaces by marching cubes (Lorensen and Cline 1987, doi:10.1145/37402.37422).

mod cases;

use ndarray::{ArrayView2, ArrayView3, s};
use walpha_base::vector::{cross, length, sub};

use self::cases::{CASES, CORNERS, EDGES};
use crate::error::RenderError;
use crate::scene::Mesh;

/// The surface that separates the samples at or above a value from those below it.
///
/// Each sign change between neighbouring samples is one vertex, linearly interpolated and shared by all triangles that meet
/// there. On a face with two high and two low corners at opposite places, the low ones are considered connected, on both sides of
/// the face; so the surface has no cracks and is a manifold, closed except at the border of the grid. A sample equal to the
/// isovalue is high; its vertices coincide, and triangles between them have no area.
#[derive(Clone, Debug, PartialEq)]
pub struct Isosurface {
    /// Vertices, (x, y, z), in voxels: sample `[z, y, x]` is at (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Triangles, counter-clockwise seen from the side of the lower values.
    pub triangles: Vec<[u32; 3]>,
    /// Number of samples that must be read to find it: all of them.
    pub samples_read: usize,
    /// Number of samples that are corners of a cell that the surface crosses: the smallest number that would suffice if the
    /// location of the surface were known.
    pub samples_at_surface: usize,
}

impl Isosurface {
    /// The surface of `field` (`[z, y, x]`) at `isovalue`. Linear time, one thread.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`] when the isovalue or a sample is NaN or infinite, or the
    /// surface has more vertices than a 32-bit index can name.
    pub fn new(field: ArrayView3<'_, f32>, isovalue: f64) -> Result<Self, RenderError> {
        if !isovalue.is_finite() {
            return Err(RenderError::Isosurface("the isovalue must be a finite number"));
        }
        if !field.iter().all(|v| v.is_finite()) {
            return Err(RenderError::Isosurface("every sample must be a finite number"));
        }
        let (depth, rows, columns) = field.dim();
        let mut surface = Self {
            positions: Vec::new(),
            triangles: Vec::new(),
            samples_read: field.len(),
            samples_at_surface: 0,
        };
        let mut below = Layer::new(rows, columns);
        let mut above = Layer::new(rows, columns);
        for z in 0..depth {
            std::mem::swap(&mut below, &mut above);
            surface.cut(&mut above, field, z, isovalue)?;
            if z > 0 {
                let slabs = [field.slice(s![z - 1, .., ..]), field.slice(s![z, .., ..])];
                surface.march(&mut below, &mut above, &slabs, isovalue);
                surface.samples_at_surface += below.count_at_surface();
            }
        }
        surface.samples_at_surface += above.count_at_surface();
        Ok(surface)
    }

    /// The area, in squared voxels. Summed in the order of the triangles.
    pub fn area(&self) -> f64 {
        let double = self.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|k| self.positions[k as usize]);
            length(cross(sub(b, a), sub(c, a)))
        });
        double.sum::<f64>() / 2.0
    }

    /// The surface as a mesh that is visible from both sides, because it may be cut open by the border of the grid.
    pub fn into_mesh(self) -> Mesh {
        Mesh { two_sided: true, ..Mesh::new(self.positions, self.triangles) }
    }

    /// Creates the vertices on the edges in slice z, and on those from it to the next.
    fn cut(
        &mut self,
        layer: &mut Layer,
        field: ArrayView3<'_, f32>,
        z: usize,
        isovalue: f64,
    ) -> Result<(), RenderError> {
        layer.clear();
        for y in 0..layer.rows {
            for x in 0..layer.columns {
                let at = [x, y, z];
                let here = f64::from(field[[z, y, x]]);
                for axis in 0..3 {
                    let mut next = at;
                    next[axis] += 1;
                    let [nx, ny, nz] = next;
                    let Some(&there) = field.get([nz, ny, nx]) else { continue };
                    let there = f64::from(there);
                    if (here >= isovalue) == (there >= isovalue) {
                        continue;
                    }
                    let name = u32::try_from(self.positions.len()).map_err(|_| {
                        RenderError::Isosurface(
                            "it has more than 2³² vertices; crop or downsample the field",
                        )
                    })?;
                    layer.vertices[y * layer.columns + x][axis] = name;
                    let mut position = at.map(|k| k as f64);
                    position[axis] += (isovalue - here) / (there - here);
                    self.positions.push(position);
                }
            }
        }
        Ok(())
    }

    /// Adds the triangles of all cells between two slices.
    fn march(
        &mut self,
        below: &mut Layer,
        above: &mut Layer,
        slabs: &[ArrayView2<'_, f32>; 2],
        isovalue: f64,
    ) {
        for y in 0..below.rows.saturating_sub(1) {
            for x in 0..below.columns.saturating_sub(1) {
                let case = (0..CORNERS).fold(0, |case, corner| {
                    let [dx, dy, dz] = cases::offset(corner);
                    let high = f64::from(slabs[dz][[y + dy, x + dx]]) >= isovalue;
                    case | usize::from(high) << corner
                });
                if case == 0 || case == 255 {
                    continue;
                }
                let mut vertices = [0; EDGES];
                for (edge, vertex) in vertices.iter_mut().enumerate() {
                    let (axis, [dx, dy, dz]) = cases::edge(edge);
                    let layer = if dz == 0 { &*below } else { &*above };
                    *vertex = layer.vertices[(y + dy) * layer.columns + x + dx][axis];
                }
                let triangles = CASES.triangles(case).iter();
                self.triangles.extend(triangles.map(|t| t.map(|e| vertices[e as usize])));
                for layer in [&mut *below, &mut *above] {
                    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                        layer.at_surface[(y + dy) * layer.columns + x + dx] = true;
                    }
                }
            }
        }
    }
}

/// One slice: the vertices on the edges that start at each sample along x, y and z, and whether
/// the sample is a corner of a crossed cell.
struct Layer {
    rows: usize,
    columns: usize,
    vertices: Vec<[u32; 3]>,
    at_surface: Vec<bool>,
}

impl Layer {
    fn new(rows: usize, columns: usize) -> Self {
        let count = rows * columns;
        Self { rows, columns, vertices: vec![[u32::MAX; 3]; count], at_surface: vec![false; count] }
    }

    fn clear(&mut self) {
        self.vertices.fill([u32::MAX; 3]);
        self.at_surface.fill(false);
    }

    fn count_at_surface(&self) -> usize {
        self.at_surface.iter().filter(|&&b| b).count()
    }
}

#[cfg(test)]
mod tests;
