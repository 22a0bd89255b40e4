//! The solid inside an isosurface: tetrahedra whose boundary has its vertices where the edges of a grid of samples cross a value. It is not an
//! α-shape: the samples say which cells of a triangulation belong, and no α does.
//!
//! A sample is *inside* if it is at least the value. An edge of the grid between a sample inside and one outside has a *crossing*, where linear interpolation
//! takes the value, as marching cubes has it. All this is in *index space*, in which samples are integers and cubes of the grid have side 1. Crossings are rounded
//! to 1/1024 of an edge, so that they too are integers, in steps of 1/1024, and kept 1/128 away from its ends, so that no edge of the boundary is so short that
//! single precision would lose it.
//!
//! A cube of the grid is *mixed* if it has corners inside and outside. The points are the corners of mixed cubes, the crossings, and the samples inside
//! at the border of the grid. Their Delaunay triangulation has four properties, which make the solid.
//!
//! **1. Cells respect cubes.** Let a face of a cube have all four corners among the points. Take a triangle of the Delaunay triangulation of the points in the
//! face, in its plane. Its circle has no corner of the face inside. Then its centre is in the face: if it were beyond an edge, the circle would enter
//! across that edge by a chord of length 1 at most, thus by 1/2 at most, and its three points would all be on that edge. So its radius is √½ at most, and
//! it leaves the face only by caps between two points of an edge, less than 1 deep. The sphere about the same centre with the same radius has
//! no other point inside or on it: points of other faces are on edges at the corners of this one, at right angles to it, so further from
//! the centre than that corner, or 1 or more away from its plane. So the triangle is a Delaunay triangle in space, too, and the face is a
//! union of such. Every mixed cube, having all of its faces so, is a union of cells.
//!
//! **2. No cell has both a sample inside and one outside.** Let an edge of a cell join two corners of a cube. There is a sphere through both with no point inside. If
//! they are ends of an edge of the cube, there is no crossing between them. If they are opposite in a face, both other corners
//! are on that sphere, as the squared distances of a point from opposite corners of a rectangle have equal sums; if they are opposite in the cube, all others are. All edges of
//! this face or cube are chords then, whose insides are inside the sphere, so they have no crossings: all its corners are inside, or all outside.
//!
//! **3. What is not mixed is decided by its samples.** Cubes with all corners inside touch neither those with all corners outside nor the rest of space
//! but by faces of mixed cubes and by faces at the border of the grid, all of whose corners are points. So cells fill them, and have corners inside.
//!
//! So a cell belongs to the solid if it has a sample inside; it does not if it has one outside. Cells between crossings alone lie in one mixed cube, and
//! belong if the trilinear interpolant at their centroid is at least the value. Hence
//!
//! **4. The boundary is the isosurface.** A facet between a cell of the solid and another one has three crossings as corners, since a sample would decide
//! for both cells alike. Where the solid meets the border of the grid it ends there, and the border closes it. Every sample inside is inside of the solid, or on that
//! border, and no sample outside is in it: a gap one sample wide stays open.
//!
//! A **closed** solid has the largest part of the samples inside, of those that edges of the grid join, and its cavities are filled: samples outside that such edges do not join to the
//! border of the grid count as inside. No edge of the grid joins two parts, or a cavity and what is open, so crossings are where they were. Edges of the
//! grid without a crossing are edges of cells (their smallest spheres are empty), so the solid is in one piece. Cells between crossings alone
//! that it shuts in are added, so that there is no void.
//!
//! At last points get their positions in the world, each coordinate rounded. That is an affine map up to rounding; the orientation of every cell after it is verified exactly.

#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use walpha_base::advice::{Advice, Advise};
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;
use walpha_base::shown::number;
use walpha_base::{Coordinates, Monitor, UnionFind};
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};
use walpha_regular::predicates::orientation;
use walpha_regular::{Triangulation, triangulate};

use super::alpha_shape::Assembled;
use super::bits::Bits;
use super::topology::{components, sheet_betti};
use super::{
    Alpha, AlphaShape, Class, Complex, Engine, ShapeError, ShapeOptions, Sheets, Simplices,
    WeightedPoints,
};

/// Where the samples of a grid lie.
///
/// The fields are open, so that any program can make one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLattice {
    /// Samples along the grid's x, y and z.
    pub dims: [usize; 3],
    /// The position of the first sample.
    pub origin: [f64; 3],
    /// The steps from a sample to the next along the grid's x, y and z.
    pub axes: [[f64; 3]; 3],
}

impl SampleLattice {
    /// The position of a place given by indices, which need not be whole.
    fn place(&self, at: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|r| self.origin[r] + (0..3).map(|k| at[k] * self.axes[k][r]).sum::<f64>())
    }

    fn is_mirrored(&self) -> bool {
        let [a, b, c] = self.axes;
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1) < 0.0
    }
}

/// Which part of what is at least a value a solid is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Extent {
    /// All of it.
    #[default]
    Whole,
    /// Its largest part, with cavities filled: one piece without a void. Samples are of one part if edges of the grid join them.
    Closed,
}

/// Why there is no solid inside an isosurface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IsosurfaceError {
    /// A grid without cubes.
    #[error("{0}×{1}×{2} samples have no isosurface: that takes two or more along each axis", dims[0], dims[1], dims[2])]
    Flat {
        /// The samples along x, y and z.
        dims: [usize; 3],
    },
    /// No sample is inside.
    #[error("no sample reaches the value {}: the largest is {}", number(*value), number(*largest))]
    Empty {
        /// The value asked for.
        value: f64,
        /// The largest sample.
        largest: f64,
    },
    /// Doubles cannot tell points apart.
    #[error(
        "coordinates of up to {} are too large for this grid: doubles turn cells over",
        number(*far)
    )]
    Rounded {
        /// The largest coordinate.
        far: f64,
    },
}

impl Advise for IsosurfaceError {
    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Flat { .. } => {
                "take a volume of several samples along each axis, or downsample it less"
            }
            Self::Empty { .. } => "give a smaller value",
            Self::Rounded { .. } => "use voxels as units",
        };
        Some(advice.into())
    }
}

/// The solid of what is at least `value` in a field of samples, by its isosurface: the vertices of its boundary are where edges of the grid take the
/// value, by linear interpolation, and where the grid ends. Its points are these, the samples inside that have a neighbour outside, among the 26 around
/// them, and those at the border of the grid; it has no others deep within. `sample` gives the value of sample i + X·(j + Y·k); where it is not a number there is no sample,
/// and the surface cuts edges to it in the middle. The values of points are `value` and those of samples.
///
/// With [`Extent::Closed`] it is one piece without a void.
///
/// The cells are those of the Delaunay triangulation in index space that are inside by their samples: the result is not an α-shape, and its
/// options say α = ∞ ([`AlphaShape::isovalue`]). Every simplex is a face of a cell, so nothing is singular. Time and memory
/// grow with the surface, but for one bit for each sample.
///
/// ```
/// use walpha_shape::{Extent, SampleLattice, isosurface_shape};
///
/// let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let lattice = SampleLattice { dims: [3; 3], origin: [0.0; 3], axes };
/// // One sample of 1 among zeros: an octahedron about it.
/// let shape = isosurface_shape(&lattice, |i| if i == 13 { 1.0 } else { 0.0 }, 0.5, Extent::Whole)?;
/// assert_eq!(shape.points().len(), 7);
/// assert_eq!(shape.measures().volume, 1.0 / 6.0);
/// # Ok::<(), walpha_shape::ShapeError>(())
/// ```
///
/// # Errors
/// [`ShapeError::Isosurface`], out of memory, and [`ShapeError::Cancelled`].
pub fn isosurface_shape(
    lattice: &SampleLattice,
    sample: impl Fn(usize) -> f64 + Sync,
    value: f64,
    extent: Extent,
) -> Result<AlphaShape, ShapeError> {
    let monitor = &*Monitor::current();
    let field = Field { dims: lattice.dims, sample, value };
    let Points { places, values, inside } = field.points(extent)?;
    monitor.part(0, 1, 10).report(1, 1)?;
    let mesh = monitor.part(1, 7, 10).watch(|| triangulate(&places, None))?;
    let kept = Kept { field: &field, places: &places, inside, mesh: &mesh };
    let (complex, sheets) = kept.complex(extent, lattice.is_mirrored())?;
    drop(mesh);
    monitor.part(7, 9, 10).report(1, 1)?;
    let mut positions = try_with_capacity(inside, || WHAT.into())?;
    let in_world = |place: &[f64; 3]| lattice.place(place.map(|x| x / STEPS));
    positions.par_extend(places[..inside].par_iter().map(in_world));
    drop(places);
    verify(&complex, &positions)?;
    let betti = sheet_betti(&complex, components(&complex), &sheets);
    monitor.report(10, 10)?;
    let shape = AlphaShape::assembled(Assembled {
        points: WeightedPoints { positions, weights: vec![0.0; inside], values: Some(values) },
        coordinates: Coordinates::default(),
        options: ShapeOptions::new(Alpha::INFINITE).engine(Engine::Native),
        complex,
        hidden: None,
        betti,
        sheets: Some(sheets),
    })?;
    Ok(AlphaShape { isovalue: Some(value), ..shape })
}

/// The steps into which an edge of the grid is divided.
const STEPS: f64 = 1024.0;

/// The least number of steps from a crossing to a sample.
const MARGIN: f64 = 8.0;

/// What memory is for.
const WHAT: &str = "the solid inside an isosurface";

/// Samples of a grid, and the value at which they are inside.
struct Field<F> {
    dims: [usize; 3],
    sample: F,
    value: f64,
}

/// The points that are triangulated.
struct Points {
    /// Their places in steps: those of the solid, then samples outside.
    places: Vec<[f64; 3]>,
    /// The values of those of the solid.
    values: Vec<f64>,
    /// Number of those of the solid.
    inside: usize,
}

impl<F: Fn(usize) -> f64 + Sync> Field<F> {
    fn at(&self, [x, y, z]: [usize; 3]) -> f64 {
        (self.sample)(x + self.dims[0] * (y + self.dims[1] * z))
    }

    fn points(&self, extent: Extent) -> Result<Points, ShapeError> {
        let dims = self.dims;
        if dims.iter().any(|&n| n < 2) {
            return Err(IsosurfaceError::Flat { dims }.into());
        }
        let inside = Bits::filled(dims, |at| self.at(at) >= self.value)?;
        if inside.count() == 0 {
            let all = (0..dims.iter().product()).into_par_iter().map(&self.sample);
            let largest = all.reduce(|| f64::NEG_INFINITY, f64::max);
            return Err(IsosurfaceError::Empty { value: self.value, largest }.into());
        }
        let inside = match extent {
            Extent::Whole => inside,
            Extent::Closed => inside.largest_part()?.filled_up()?,
        };
        let outside = inside.dilated()?.without(&inside)?;
        let shell = inside.without(&inside.deep()?)?;
        let mut count = shell.count() as usize;
        shell.each(|at| count += self.outside_neighbours(&inside, at).count());
        let what = || WHAT.to_owned();
        let mut places = try_with_capacity(count + outside.count() as usize, what)?;
        let mut values = try_with_capacity(count, what)?;
        let steps = |at: [usize; 3]| at.map(|i| STEPS * i as f64);
        shell.each(|at| {
            places.push(steps(at));
            values.push(self.at(at));
            for (axis, towards) in self.outside_neighbours(&inside, at) {
                let mut place = steps(at);
                let away = self.steps(at, towards);
                place[axis] += if towards[axis] > at[axis] { away } else { -away };
                places.push(place);
                values.push(self.value);
            }
        });
        outside.each(|at| places.push(steps(at)));
        Ok(Points { places, values, inside: count })
    }

    /// The samples outside next to one inside, each with the axis along which it lies.
    fn outside_neighbours(
        &self,
        inside: &Bits,
        at: [usize; 3],
    ) -> impl Iterator<Item = (usize, [usize; 3])> {
        let sides = (0..3).flat_map(move |axis| [(axis, false), (axis, true)]);
        sides.filter_map(move |(axis, up)| {
            let mut towards = at;
            towards[axis] = if up { at[axis] + 1 } else { at[axis].checked_sub(1)? };
            let is_outside =
                towards[axis] < self.dims[axis] && !inside.has(towards.map(|i| i as i64));
            is_outside.then_some((axis, towards))
        })
    }

    /// The distance of the crossing from a sample inside, towards one outside, in steps.
    fn steps(&self, inside: [usize; 3], outside: [usize; 3]) -> f64 {
        let (high, low) = (self.at(inside), self.at(outside));
        let share = (high - self.value) / (high - low);
        // Of two infinite samples, or towards none, the share is not a number.
        let share = if share.is_nan() { 0.5 } else { share };
        (STEPS * share).round().clamp(MARGIN, STEPS - MARGIN)
    }

    /// Whether the trilinear interpolant in the cube that a place is in, in steps, is at least the value.
    fn reaches(&self, place: [f64; 3]) -> bool {
        let at = place.map(|x| x / STEPS);
        let first = at.map(f64::floor);
        let above: f64 = (0..8)
            .map(|corner| {
                let (mut share, mut of) = (1.0, [0; 3]);
                for k in 0..3 {
                    let up = corner >> k & 1;
                    of[k] = first[k] as usize + up;
                    let along = at[k] - first[k];
                    share *= if up == 1 { along } else { 1.0 - along };
                }
                share * (self.at(of) - self.value)
            })
            .sum();
        above >= 0.0
    }
}

/// The triangulation and the cells of it that are kept.
struct Kept<'a, F> {
    field: &'a Field<F>,
    places: &'a [[f64; 3]],
    /// Number of points of the solid, the first ones.
    inside: usize,
    mesh: &'a Triangulation,
}

/// Stands for the sheet of a facet that has none.
const INNER: u32 = u32::MAX;

impl<F: Fn(usize) -> f64 + Sync> Kept<'_, F> {
    /// Whether a cell belongs to the solid.
    fn keeps(&self, cell: [u32; 4]) -> bool {
        // The infinite vertex is past all points.
        if cell.iter().any(|&v| v as usize >= self.inside) {
            return false;
        }
        let places = cell.map(|v| self.places[v as usize]);
        let is_sample = |place: &[f64; 3]| place.iter().all(|x| x % STEPS == 0.0);
        let centroid = || [0, 1, 2].map(|k| places.iter().map(|place| place[k]).sum::<f64>() / 4.0);
        places.iter().any(is_sample) || self.field.reaches(centroid())
    }

    /// The complex of the kept cells and its sheets. Cells are turned over where axes are `mirrored`.
    fn complex(&self, extent: Extent, mirrored: bool) -> Result<(Complex, Sheets), ShapeError> {
        let (cells, adjacency) = (self.mesh.cells(), self.mesh.adjacency());
        let mut kept: Vec<bool> = cells.par_iter().map(|&cell| self.keeps(cell)).collect();
        if extent == Extent::Closed {
            self.fill_voids(&mut kept);
        }
        let kept = kept;
        let turned = |mut cell: [u32; 4]| {
            if mirrored {
                cell.swap(2, 3);
            }
            cell
        };
        let numbers = || (0..cells.len()).into_par_iter().filter(|&cell| kept[cell]);
        let corners = self.sectors(&kept);
        // Each facet once, from its first kept cell, with a corner that sees it from outside.
        let facets_of = |number: usize| {
            let cell = cells[number];
            let kept = &kept;
            (0..4).filter_map(move |opposite| {
                let side = adjacency[number][opposite];
                let beyond = side as usize / 4;
                if kept[beyond] {
                    let row = sorted(outward_facets(cell)[opposite]);
                    return (number < beyond).then_some((row, INNER));
                }
                let [a, b, c] = outward_facets(cell)[opposite];
                let row = smallest_even(if mirrored { [a, c, b] } else { [a, b, c] });
                Some((row, (side + 1) % 4 + side / 4 * 4))
            })
        };
        let count: usize = numbers().map(|number| facets_of(number).count()).sum();
        let what = || WHAT.to_owned();
        let mut facets: Vec<([u32; 3], u32)> = try_with_capacity(count, what)?;
        facets.par_extend(numbers().flat_map_iter(facets_of));
        facets.par_sort_unstable();
        let mut edges: Vec<([u32; 2], bool)> = try_with_capacity(3 * count, what)?;
        edges.par_extend(facets.par_iter().flat_map_iter(|&([a, b, c], sheet)| {
            [[a, b], [b, c], [a, c]].map(|edge| (sorted(edge), sheet == INNER))
        }));
        edges.par_sort_unstable();
        // Of equal ones the first stays, which is regular if one of them is.
        edges.dedup_by_key(|(edge, _)| *edge);
        let class = |is_inner: bool| if is_inner { Class::Interior } else { Class::Regular };
        let mut is_inner = vec![true; self.inside];
        for (row, _) in facets.iter().filter(|(_, sheet)| *sheet != INNER) {
            row.iter().for_each(|&v| is_inner[v as usize] = false);
        }
        let mut rows: Vec<[u32; 4]> = try_with_capacity(numbers().count(), what)?;
        rows.par_extend(numbers().map(|number| smallest_even(turned(cells[number]))));
        rows.par_sort_unstable();
        let vertices = (0..).zip(is_inner).map(|(v, is_inner)| ([v], class(is_inner)));
        let complex = Complex {
            cells: rows.into_iter().map(|row| (row, Class::Interior)).collect(),
            facets: facets.iter().map(|&(row, sheet)| (row, class(sheet == INNER))).collect(),
            edges: edges.into_iter().map(|(row, is_inner)| (row, class(is_inner))).collect(),
            vertices: vertices.collect::<Simplices<1>>(),
        };
        let seen = facets.iter().filter(|(_, corner)| *corner != INNER);
        let names: Vec<u32> = seen.map(|&(_, corner)| corners.find(corner)).collect();
        let sheets = Sheets::numbered(&complex, &names, &[]);
        Ok((complex, sheets))
    }

    /// Keeps the cells, all of whose corners are crossings, that others shut in.
    fn fill_voids(&self, kept: &mut [bool]) {
        let (cells, adjacency) = (self.mesh.cells(), self.mesh.adjacency());
        let infinite = cells.iter().position(|cell| cell.contains(&self.mesh.infinite_vertex()));
        let sets = UnionFind::new(cells.len());
        (0..cells.len()).into_par_iter().filter(|&cell| !kept[cell]).for_each(|cell| {
            let beyond = adjacency[cell].iter().map(|side| side / 4);
            beyond.filter(|&next| !kept[next as usize]).for_each(|next| {
                sets.unite(cell as u32, next);
            });
        });
        let open = sets.find(infinite.expect("a hull has outsides") as u32);
        kept.par_iter_mut().enumerate().for_each(|(cell, kept)| {
            *kept |= sets.find(cell as u32) != open;
        });
    }

    /// The corners of cells, 4·cell + corner, those on one sheet united. Around a vertex of the solid, cells outside of it that share a facet
    /// are in one part of the space outside, and so are the three corners that a facet of the boundary has on that side.
    fn sectors(&self, kept: &[bool]) -> UnionFind {
        let (cells, adjacency) = (self.mesh.cells(), self.mesh.adjacency());
        let sets = UnionFind::new(4 * cells.len());
        let others = |opposite: usize| (1..4).map(move |step| (opposite + step) % 4);
        (0..cells.len()).into_par_iter().filter(|&cell| !kept[cell]).for_each(|cell| {
            for (opposite, &side) in adjacency[cell].iter().enumerate() {
                let (beyond, here) = (side as usize / 4, 4 * cell as u32);
                if kept[beyond] {
                    let [a, b, c] = [1, 2, 3].map(|step| here + ((opposite + step) % 4) as u32);
                    sets.unite(a, b);
                    sets.unite(a, c);
                } else if cell < beyond {
                    for k in others(opposite).filter(|&k| (cells[cell][k] as usize) < self.inside) {
                        let there = cells[beyond].iter().position(|v| *v == cells[cell][k]);
                        let there = there.expect("both have the corners of the facet");
                        sets.unite(here + k as u32, 4 * beyond as u32 + there as u32);
                    }
                }
            }
        });
        sets
    }
}

/// Verifies that rounding has turned no cell over.
fn verify(complex: &Complex, positions: &[[f64; 3]]) -> Result<(), IsosurfaceError> {
    let is_positive = |cell: &[u32; 4]| {
        let [a, b, c, d] = cell.map(|v| positions[v as usize]);
        orientation(a, b, c, d) == Ordering::Greater
    };
    let far = positions.iter().flatten().fold(0.0, |far: f64, x| far.max(x.abs()));
    let is_finite = positions.as_flattened().iter().all(|x| x.is_finite());
    if is_finite && complex.cells.rows().par_iter().all(is_positive) {
        return Ok(());
    }
    Err(IsosurfaceError::Rounded { far })
}
