//! The power diagram, dual to the regular triangulation.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use walpha_base::parallel::prelude::*;
use walpha_base::vector::{add, cross, dot, length, sub, unit};
use walpha_base::{Monitor, UnionFind};

use crate::kernel::Predicates;
use crate::sites::check;
use crate::{CellArrays, Triangulation, TriangulationError, facets, filled, with_capacity};

/// The power diagram of weighted points: its vertices, the volumes of its cells, the areas of the facets between them.
///
/// The power cell of a point is the set where no other point has a smaller power distance; without weights it is the Voronoi
/// cell. Cells of points on the convex hull are unbounded, and hidden points and duplicates have none. A point that is only just
/// not hidden, because its power distance is nowhere smaller than all others, has a cell without volume: a polygon, a segment or
/// a place where cells of other points meet, which are then neighbours across it.
///
/// The vertices and facets are decided exactly: cells of the triangulation with one orthogonal sphere are one vertex, however
/// ties were broken. A facet that degenerates to a point, a segment or a ray is not listed, and neither is a facet of a cell
/// without volume. Hence a point of a cubic lattice has six facets, and one of a face-centred lattice has twelve. Coordinates,
/// areas and volumes are rounded; areas and volumes are computed from distances to points nearby. If lengths are so large or
/// small that a double does not hold a product of two or three of them, which it does from 10⁻¹⁰⁰ to 10¹⁰⁰, areas and volumes are
/// not known, and NaN; a coordinate beyond the largest double is infinite.
///
/// ```
/// use walpha_regular::{PowerDiagram, triangulate};
///
/// // Of 3³ points of a lattice, the one in the middle has a bounded cell, a unit cube.
/// let points: Vec<[f64; 3]> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from)).collect();
/// let voronoi = PowerDiagram::of(&triangulate(&points, None)?, None)?;
/// assert_eq!(voronoi.vertices().len(), 8);
/// assert_eq!(voronoi.volumes()[13], 1.0);
/// assert_eq!(voronoi.facets().iter().filter(|facet| facet.contains(&13)).count(), 6);
/// # Ok::<(), walpha_regular::TriangulationError>(())
/// ```
///
/// F. Aurenhammer, Power diagrams: properties, algorithms and applications, SIAM Journal on Computing 16 (1987),
/// doi:10.1137/0216006.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerDiagram {
    vertices: Vec<[f64; 3]>,
    same_sphere: Vec<u32>,
    volumes: Vec<f64>,
    facets: Vec<[u32; 2]>,
    areas: Vec<f64>,
}

impl PowerDiagram {
    /// The power diagram dual to a triangulation with these weights; with other weights it is meaningless.
    ///
    /// O(cells) and about 96 bytes for each cell, on all threads of the current rayon pool; the result does not depend on their
    /// number.
    ///
    /// # Errors
    /// The numbers of weights and points differ; a weight that is not finite or is too large. Out of memory.
    pub fn of(
        triangulation: &Triangulation,
        weights: Option<&[f64]>,
    ) -> Result<Self, TriangulationError> {
        let monitor = &*Monitor::current();
        let positions = triangulation.positions();
        let zeros = if weights.is_none() { filled(positions.len(), 0.0)? } else { Vec::new() };
        let weights = weights.unwrap_or(&zeros);
        check(positions, weights)?;
        let DualFacets { spheres, centres, facets } =
            DualFacets::of(&triangulation.arrays, positions, weights, monitor)?;
        let sides = Sides::of(&facets, positions.len())?;
        let facets = sides.of_solid_cells(facets);

        let way = |[p, q]: [u32; 2]| sub(positions[q as usize], positions[p as usize]);
        let mut volumes = cell_volumes(&facets, weights, way)?;
        for v in triangulation.hull_facets().flatten().filter(|&v| sides.is_solid(v)) {
            volumes[v as usize] = f64::INFINITY;
        }
        let vertices =
            centres.iter().map(|centre| add(positions[centre.near as usize], centre.offset));
        let vertices = vertices.collect();
        let same_sphere = triangulation.finite_cells().map(|(cell, _)| spheres.of[cell as usize]);
        let same_sphere = same_sphere.collect();
        let (facets, areas) = facets.into_iter().unzip();
        Ok(Self { vertices, same_sphere, volumes, facets, areas })
    }

    /// The centre of each orthogonal sphere, in the order of the first cell that has it. A coordinate beyond the largest double is
    /// infinite.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// The vertex dual to each finite cell, in the order of [`Triangulation::finite_cells`]. Cells with the same number have
    /// exactly the same orthogonal sphere: together they are a polytope, which ties divide.
    pub fn same_sphere(&self) -> &[u32] {
        &self.same_sphere
    }

    /// The volume of the power cell of each point: ∞ if it is unbounded, 0 for points that have no cell or one without volume,
    /// NaN if it is not known because doubles do not hold products of lengths. If weights make a cell tiny, rounding may leave 0
    /// or less.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// The two points of each facet, ascending: points whose power cells share the facet and have a volume.
    pub fn facets(&self) -> &[[u32; 2]] {
        &self.facets
    }

    /// The area of each facet: ∞ if it is unbounded, NaN if it is not known because doubles do not hold products of lengths.
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }
}

/// The vertices and facets of the diagram that is dual to cells.
struct DualFacets {
    spheres: Spheres,
    centres: Vec<Centre>,
    facets: Vec<([u32; 2], f64)>,
}

impl DualFacets {
    fn of(
        arrays: &CellArrays,
        positions: &[[f64; 3]],
        weights: &[f64],
        monitor: &Monitor,
    ) -> Result<Self, TriangulationError> {
        // The threads allocate this memory piece by piece.
        with_capacity::<u8>(arrays.cells.len().saturating_mul(BYTES_OF_A_CELL))?;
        let predicates = Predicates::new(positions, weights);
        let spheres = Spheres::of(arrays, &predicates, &monitor.part(0, 1, 3))?;
        let centre = |&cell: &u32| {
            let corners = arrays.cells[cell as usize];
            Centre { near: corners[0], offset: predicates.centre(corners) }
        };
        let centres: Vec<Centre> = spheres.first.par_iter().map(centre).collect();
        let dual = Dual { arrays, positions, spheres: &spheres, centres: &centres };
        let facets = dual.facets(&monitor.part(1, 3, 3))?;
        Ok(Self { spheres, centres, facets })
    }
}

/// The facets of the power diagram that is dual to cells, between their two points in ascending order, with their areas: infinite ones, too, and
/// those of cells without volume, but none that degenerate. Sorted.
///
/// # Errors
/// Out of memory.
pub fn dual_facets(
    arrays: &CellArrays,
    positions: &[[f64; 3]],
    weights: &[f64],
    monitor: &Monitor,
) -> Result<Vec<([u32; 2], f64)>, TriangulationError> {
    Ok(DualFacets::of(arrays, positions, weights, monitor)?.facets)
}

/// The volumes of cells as far as their facets are finite, given the way between the two points of each facet; NaN where doubles do not hold products of
/// lengths.
///
/// # Errors
/// Out of memory.
pub fn cell_volumes<F: Facet>(
    facets: &[(F, f64)],
    weights: &[f64],
    way: impl Fn(F) -> [f64; 3],
) -> Result<Vec<f64>, TriangulationError> {
    let mut volumes: Vec<f64> = filled(weights.len(), 0.0)?;
    for &(facet, area) in facets.iter().filter(|(_, area)| *area != f64::INFINITY) {
        let [p, q] = facet.ends().map(|v| v as usize);
        let distance = length(way(facet));
        // Six times the pyramids with this base and one of the two points as apex: twice the height is the distance, and more
        // for the heavier point.
        let more = (weights[p] - weights[q]) / distance;
        let is_held = area == 0.0 || area * distance >= f64::MIN_POSITIVE;
        let area = if is_held { area } else { f64::NAN };
        volumes[p] += area * (distance + more);
        volumes[q] += area * (distance - more);
    }
    for volume in &mut volumes {
        *volume = if volume.is_finite() { *volume / 6.0 } else { f64::NAN };
    }
    Ok(volumes)
}

/// Memory for a cell: its sphere, its part of about 1.2 edges, and the memory for collecting both.
const BYTES_OF_A_CELL: usize = 96;
/// The number of cells that one thread handles in one piece.
const CHUNK: usize = 1 << 12;

/// The cells that have the same orthogonal sphere. Infinite cells have the same sphere if their facets of the hull lie in one
/// plane.
struct Spheres {
    /// The number of the sphere of each cell; those of finite cells come first.
    of: Vec<u32>,
    /// The first cell of each sphere of finite cells.
    first: Vec<u32>,
}

impl Spheres {
    /// Cells that share a sphere form a convex polytope, so a path across facets between two of them leads from any cell to any
    /// other.
    fn of(
        arrays: &CellArrays,
        predicates: &Predicates,
        monitor: &Monitor,
    ) -> Result<Self, TriangulationError> {
        let is_finite = |corners: &[u32; 4]| !corners.contains(&arrays.at_infinity);
        let sets = UnionFind::new(arrays.cells.len());
        let done = monitor.units(arrays.cells.len() as u64);
        arrays.cells.par_chunks(CHUNK).enumerate().try_for_each(|(chunk, cells)| {
            for (cell, corners) in ((chunk * CHUNK) as u32..).zip(cells) {
                for side in
                    arrays.adjacency[cell as usize].into_iter().filter(|side| cell < side / 4)
                {
                    let next = arrays.cells[side as usize / 4];
                    let across = next[side as usize % 4];
                    let same = match [is_finite(corners), is_finite(&next)] {
                        [true, true] => predicates.power(*corners, across).is_eq(),
                        [false, false] => {
                            let beyond = corners.iter().position(|&v| v == arrays.at_infinity);
                            let [a, b, c] = facets(*corners)[beyond.unwrap_or_default()];
                            predicates.orientation([a, b, c, across]).is_eq()
                        }
                        _ => false,
                    };
                    if same {
                        sets.unite(cell, side / 4);
                    }
                }
            }
            done.add(cells.len() as u64)
        })?;
        let mut of = filled(arrays.cells.len(), 0)?;
        let mut first = Vec::new();
        let mut count = 0;
        for finite in [true, false] {
            for (cell, corners) in (0..).zip(&arrays.cells) {
                if is_finite(corners) != finite {
                    continue;
                }
                // The root is the smallest of its set, so it has a number.
                let root = sets.find(cell);
                of[cell as usize] = if root == cell { count } else { of[root as usize] };
                if root == cell {
                    count += 1;
                    if finite {
                        first.push(cell);
                    }
                }
            }
        }
        Ok(Self { of, first })
    }
}

/// The edges of a cell by their corners, each with the other two.
const EDGES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 0, 2], [2, 3, 0, 1]];

/// The centre of a sphere, by its offset from a corner of one of its cells.
struct Centre {
    near: u32,
    offset: [f64; 3],
}

struct Dual<'a> {
    arrays: &'a CellArrays,
    positions: &'a [[f64; 3]],
    spheres: &'a Spheres,
    centres: &'a [Centre],
}

impl Dual<'_> {
    /// The facets by their two points, with their areas.
    fn facets(&self, monitor: &Monitor) -> Result<Vec<([u32; 2], f64)>, TriangulationError> {
        let cells = &self.arrays.cells;
        let done = monitor.units(cells.len() as u64);
        let chunks = cells.par_chunks(CHUNK).enumerate().map(|(chunk, cells)| {
            let (mut found, mut around) = (Vec::new(), Vec::new());
            for (cell, corners) in ((chunk * CHUNK) as u32..).zip(cells) {
                for [p, q, r, s] in EDGES {
                    let [p, q] = [corners[p].min(corners[q]), corners[p].max(corners[q])];
                    if q == self.arrays.at_infinity
                        || !self.is_first_around(cell, [r, s], &mut around)
                    {
                        continue;
                    }
                    found.extend(self.area([p, q], &mut around).map(|area| ([p, q], area)));
                }
            }
            done.add(cells.len() as u64)?;
            Ok(found)
        });
        let mut facets = chunks.collect::<Result<Vec<_>, TriangulationError>>()?.concat();
        facets.par_sort_unstable_by_key(|&(edge, _)| edge);
        Ok(facets)
    }

    /// Lists the spheres of the cells around the edge that a cell has besides these two corners, in order. Returns whether no
    /// cell with a smaller number is among them; otherwise the list is not complete.
    fn is_first_around(&self, first: u32, [r, s]: [usize; 2], spheres: &mut Vec<u32>) -> bool {
        let CellArrays { cells, adjacency, .. } = self.arrays;
        spheres.clear();
        let (mut cell, mut away, mut kept) = (first, r, cells[first as usize][s]);
        loop {
            spheres.push(self.spheres.of[cell as usize]);
            let side = adjacency[cell as usize][away];
            cell = side / 4;
            if cell <= first {
                return cell == first;
            }
            let corners = cells[cell as usize];
            away = corners.iter().position(|&v| v == kept).unwrap_or_default();
            kept = corners[side as usize % 4];
        }
    }

    /// The area of the facet between two points, by the spheres around their edge; `None` if it degenerates.
    fn area(&self, [p, q]: [u32; 2], spheres: &mut Vec<u32>) -> Option<f64> {
        spheres.dedup();
        if spheres.len() > 1 && spheres.first() == spheres.last() {
            spheres.pop();
        }
        if spheres.len() < 3 {
            return None;
        }
        let position = |v: u32| self.positions[v as usize];
        let from_p = |&sphere: &u32| {
            let centre = self.centres.get(sphere as usize)?;
            Some(add(sub(position(centre.near), position(p)), centre.offset))
        };
        let Some(corners) = spheres.iter().map(from_p).collect::<Option<Vec<_>>>() else {
            return Some(f64::INFINITY);
        };
        let way = sub(position(q), position(p));
        let rays: Vec<_> = corners[1..].iter().map(|&corner| sub(corner, corners[0])).collect();
        let most = largest(rays.as_flattened());
        if !(SQUARED.contains(&largest(&way)) && (most == 0.0 || SQUARED.contains(&most))) {
            return Some(f64::NAN);
        }
        let normal = unit(way)?;
        let triangle = |side: &[[f64; 3]]| dot(normal, cross(side[0], side[1]));
        Some(rays.windows(2).map(triangle).sum::<f64>().abs() / 2.0)
    }
}

/// Lengths whose squares doubles hold, to the last bit and with room for sums.
const SQUARED: RangeInclusive<f64> = 1e-140..=1e140;

/// The largest magnitude; NaN if a number is NaN.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most: f64, x| if x.is_nan() { *x } else { most.max(x.abs()) })
}

/// The number of facets of the power cell of each point, which shows whether the cell has a volume.
///
/// A cell with a volume has a vertex, because points span a volume, and therefore at least three facets. A cell that is a polygon
/// has two: the polygon from both sides, where the next points are in line with its own. Segments and places have none.
#[derive(Debug)]
pub struct Sides(Vec<u8>);

/// A facet between a point, and a point or a copy of one.
pub trait Facet: Copy + Ord {
    /// The points.
    fn ends(self) -> [u32; 2];

    /// The multiples of the vectors of a periodic box by which the second one is moved.
    fn shift(self) -> [i32; 3];

    /// The facet between these.
    fn between(ends: [u32; 2], shift: [i32; 3]) -> Self;
}

impl Facet for [u32; 2] {
    fn ends(self) -> [u32; 2] {
        self
    }

    fn shift(self) -> [i32; 3] {
        [0; 3]
    }

    fn between(ends: [u32; 2], _: [i32; 3]) -> Self {
        ends
    }
}

impl Facet for ([u32; 2], [i32; 3]) {
    fn ends(self) -> [u32; 2] {
        self.0
    }

    fn shift(self) -> [i32; 3] {
        self.1
    }

    fn between(ends: [u32; 2], shift: [i32; 3]) -> Self {
        (ends, shift)
    }
}

impl Sides {
    const OF_POLYGON: u8 = 2;

    /// Counts the facets of all cells.
    ///
    /// # Errors
    /// Out of memory.
    pub fn of<F: Facet>(facets: &[(F, f64)], points: usize) -> Result<Self, TriangulationError> {
        let mut sides: Vec<u8> = filled(points, 0)?;
        for v in facets.iter().flat_map(|(facet, _)| facet.ends()) {
            let count = &mut sides[v as usize];
            *count = count.saturating_add(1);
        }
        Ok(Self(sides))
    }

    fn is_polygon(&self, v: u32) -> bool {
        self.0[v as usize] == Self::OF_POLYGON
    }

    /// Whether the cell of a point has a volume.
    pub fn is_solid(&self, v: u32) -> bool {
        self.0[v as usize] > Self::OF_POLYGON
    }

    /// The facets between cells with a volume: the facet of a polygon belongs to the cells on both sides of all polygons there.
    pub fn of_solid_cells<F: Facet + Send>(&self, facets: Vec<(F, f64)>) -> Vec<(F, f64)> {
        if !self.0.contains(&Self::OF_POLYGON) {
            return facets;
        }
        // The neighbours of each polygon, with their shifts against it.
        let mut next: HashMap<u32, Vec<(u32, [i32; 3])>> = HashMap::new();
        for &(facet, _) in &facets {
            let ([p, q], shift) = (facet.ends(), facet.shift());
            for (v, other, way) in [(p, q, shift), (q, p, shift.map(|by| -by))] {
                if self.is_polygon(v) {
                    next.entry(v).or_default().push((other, way));
                }
            }
        }
        // From a point to a polygon and on, to the first cell with a volume, and its shift against the point.
        let beyond = |from: u32, polygon: u32, shift: [i32; 3]| {
            let (mut last, mut at) = ((from, [0; 3]), (polygon, shift));
            for _ in 0..next.len() {
                let neighbours = next.get(&at.0)?.iter();
                let placed = neighbours.map(|&(v, way)| (v, [0, 1, 2].map(|k| at.1[k] + way[k])));
                let onwards = placed.into_iter().find(|neighbour| *neighbour != last)?;
                (last, at) = (at, onwards);
                if !self.is_polygon(at.0) {
                    return Some(at);
                }
            }
            None
        };
        let between = |(facet, area): (F, f64)| {
            let ([p, q], shift) = (facet.ends(), facet.shift());
            let (from, (to, shift)) = match [p, q].map(|v| self.is_polygon(v)) {
                [false, false] => return Some((facet, area)),
                [true, true] => return None,
                [false, true] => (p, beyond(p, q, shift)?),
                [true, false] => (q, beyond(q, p, shift.map(|by| -by))?),
            };
            // Only once, because it is reached from both ends.
            is_listed(from, to, shift).then(|| (F::between([from, to], shift), area))
        };
        let mut solid: Vec<_> = facets.into_iter().filter_map(between).collect();
        solid.par_sort_unstable_by_key(|&(facet, _)| facet);
        solid
    }
}

/// Whether a facet is listed from this point to the other, which is moved by this shift, and not the other way round.
pub fn is_listed(from: u32, to: u32, shift: [i32; 3]) -> bool {
    (from, [0; 3]) < (to, shift)
}

#[cfg(test)]
mod tests;
