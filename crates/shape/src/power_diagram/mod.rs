//! The power diagram of points in a periodic box.

mod walls;

use walpha_base::Monitor;
use walpha_base::vector::sub;
use walpha_regular::internals::{
    Lattice, Sides, Sites, cell_volumes, check_numbers, check_span, dual_facets, is_listed, lattice,
};
use walpha_regular::{Torus, TriangulationError};

use crate::ShapeError;
use crate::blocks::{self, BlockParams};

/// The power diagram of weighted points in a periodic box: volumes of cells, and the facets between cells with their areas.
///
/// The power cell of a point is the set where no other point, and no copy of any, has a smaller power distance; without weights it is the Voronoi cell. As
/// in [`PowerDiagram`](walpha_regular::PowerDiagram), it is decided exactly which facets there are, none degenerates and none is one of a cell without
/// volume, and areas and volumes are rounded. Where the box does not repeat, cells may be unbounded, or end at [walls](Self::between).
///
/// ```
/// use walpha_shape::{PeriodicPowerDiagram, Torus};
///
/// // The cell of a lone point of a face-centred lattice is a rhombic dodecahedron, which meets its own copies.
/// let torus = Torus::of_vectors([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]])?;
/// let diagram = PeriodicPowerDiagram::of(torus, &[[0.0; 3]], None)?;
/// assert_eq!(diagram.facets(), [[0, 0]; 6]);
/// assert!((diagram.volumes()[0] - 2.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// F. Aurenhammer, Power diagrams: properties, algorithms and applications, SIAM Journal on Computing 16 (1987), doi:10.1137/0216006.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicPowerDiagram {
    torus: Torus,
    volumes: Vec<f64>,
    facets: Vec<[u32; 2]>,
    shifts: Vec<[i32; 3]>,
    areas: Vec<f64>,
    /// The areas of each cell on the lower and the upper wall across each axis.
    walls: Option<Vec<[[f64; 3]; 2]>>,
}

impl PeriodicPowerDiagram {
    /// The power diagram of points in a box that repeats; without weights, these are 0. Positions are moved into the box, and rounded as described at
    /// [`Torus`].
    ///
    /// O(n log n), expected, for evenly distributed points; the points of the halo are triangulated, too.
    ///
    /// # Errors
    /// The numbers of weights and points differ; a number that is not finite or is too large; no points; where the box does not repeat along all three
    /// vectors, points in one plane. Out of memory.
    pub fn of(
        torus: Torus,
        positions: &[[f64; 3]],
        weights: Option<&[f64]>,
    ) -> Result<Self, ShapeError> {
        let monitor = &*Monitor::current();
        let zeros = if weights.is_none() { vec![0.0; positions.len()] } else { Vec::new() };
        let weights = weights.unwrap_or(&zeros);
        check_numbers(positions, weights)?;
        let torus = torus.holding(positions)?;
        let wrapped: Vec<_> = positions.iter().map(|&place| torus.wrap(place)).collect();
        let sites = Sites::on_torus(&wrapped, weights, torus)?;
        if torus.dimension() < 3 {
            check_span(&sites).map_err(TriangulationError::from)?;
        }
        let lattice: Lattice = lattice(sites.positions(), sites.weights(), sites.torus());
        let params = BlockParams { alpha: f64::INFINITY, lattice, exterior: true };
        let (block, made) = blocks::whole_on_torus(&sites, torus, &params, &monitor.part(0, 2, 3))?;

        let found = dual_facets(&made, &block.positions, &block.weights, &monitor.part(2, 3, 3))?;
        let mut facets = Vec::with_capacity(found.len());
        for ([p, q], area) in found {
            // Facets between a point and a copy are found at both ends, between points at one.
            for (from, to) in [(p, q), (q, p)].into_iter().filter(|(from, _)| *from < block.own) {
                let shift = block.windings(to);
                let ends = [from, to].map(|v| block.input[v as usize]);
                if is_listed(ends[0], ends[1], shift) {
                    facets.push(((ends, shift), area));
                }
            }
        }
        facets.sort_unstable_by_key(|&(facet, _)| facet);
        let sides = Sides::of(&facets, positions.len())?;
        let facets = sides.of_solid_cells(facets);
        let way = |([p, q], shift): ([u32; 2], [i32; 3])| {
            sub(torus.moved(wrapped[q as usize], shift), wrapped[p as usize])
        };
        let mut volumes = cell_volumes(&facets, weights, way)?;
        let open = made.cells().iter().filter(|cell| cell.contains(&made.infinite_vertex()));
        for &v in open.flatten().filter(|v| **v < block.own) {
            let input = block.input[v as usize];
            if sides.is_solid(input) {
                volumes[input as usize] = f64::INFINITY;
            }
        }
        let (facets, areas): (Vec<([u32; 2], [i32; 3])>, _) = facets.into_iter().unzip();
        let (facets, shifts) = facets.into_iter().unzip();
        Ok(Self { torus, volumes, facets, shifts, areas, walls: None })
    }

    /// The box, whose vectors are reduced.
    pub fn torus(&self) -> Torus {
        self.torus
    }

    /// The volume of the power cell of each point: 0 for points that have no cell or one without volume; ∞ if it is unbounded, as it may be
    /// where the box does not repeat.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// The two points of each facet, in ascending order, both of which have cells with a volume. The same points may share several facets, and a
    /// cell may meet copies of itself: such a facet is listed once, although the cell has it twice.
    pub fn facets(&self) -> &[[u32; 2]] {
        &self.facets
    }

    /// For each facet, the multiples of the three [vectors](Torus::vectors) by which the second point, in the box, is moved to lie across the facet from
    /// the first.
    pub fn shifts(&self) -> &[[i32; 3]] {
        &self.shifts
    }

    /// The area of each facet: ∞ if it is unbounded.
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// For each point the areas that its cell has on the lower and on the upper wall across x, y and z, 0 where there is none; `None` of a diagram
    /// without [walls](Self::between).
    pub fn walls(&self) -> Option<&[[[f64; 3]; 2]]> {
        self.walls.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use walpha_regular::{PowerDiagram, triangulate};

    use super::*;
    use crate::ladder::random_points;

    const SLANTED: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.375, 0.875, 0.0], [-0.25, 0.125, 1.25]];
    const FCC: [[f64; 3]; 3] = [[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
    const CUBE: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// A point, its neighbour, and the shift of the neighbour.
    type Key = (u32, u32, [i32; 3]);

    /// The cells of the points among copies of them in space.
    fn in_space(
        torus: Torus,
        positions: &[[f64; 3]],
        weights: &[f64],
    ) -> (Vec<f64>, BTreeMap<Key, f64>) {
        let repeats = torus.repeats();
        let along = |k: usize| if repeats[k] { -3..=3 } else { 0..=0 };
        let mut shifts = vec![[0; 3]];
        for i in along(0) {
            for j in along(1) {
                shifts.extend(along(2).map(|k| [i, j, k]).filter(|by| *by != [0; 3]));
            }
        }
        let moved = |&by: &[i32; 3]| positions.iter().map(move |&p| torus.moved(p, by));
        let copies: Vec<_> = shifts.iter().flat_map(moved).collect();
        let weights = weights.repeat(shifts.len());
        let whole = triangulate(&copies, Some(&weights)).unwrap();
        let diagram = PowerDiagram::of(&whole, Some(&weights)).unwrap();
        let count = positions.len() as u32;
        let mut facets = BTreeMap::new();
        for (&[p, q], &area) in diagram.facets().iter().zip(diagram.areas()) {
            for (from, to) in [(p, q), (q, p)].into_iter().filter(|(from, _)| *from < count) {
                let (to, shift) = (to % count, shifts[(to / count) as usize]);
                if is_listed(from, to, shift) {
                    facets.insert((from, to, shift), area);
                }
            }
        }
        (diagram.volumes()[..positions.len()].to_vec(), facets)
    }

    fn is_near(a: f64, b: f64) -> bool {
        a == b || (a - b).abs() <= 1e-10 * (1.0 + a.abs())
    }

    /// Random points, points on grids of the box, whose cells touch in many ways, and lone ones; hidden ones and cells without volume, too.
    #[test]
    fn cells_are_those_among_copies_in_space() {
        let (mut unbounded, mut hidden, mut own, mut several) = (0, 0, 0, 0);
        for (seed, vectors) in [(1, CUBE), (2, SLANTED), (3, FCC)] {
            for repeats in [[true; 3], [true, true, false], [false, true, false]] {
                for (is_random, count, size) in [
                    (true, 1, 1.0),
                    (true, 6, 2.0),
                    (true, 30, 3.0),
                    (false, 1, 1.0),
                    (false, 12, 2.0),
                ] {
                    let scaled = vectors.map(|vector| vector.map(|x| size * x));
                    let torus = Torus::repeating(scaled, repeats).unwrap();
                    let random = random_points(100 * seed + count as u64, count, 1.0);
                    let mut positions = random.positions().to_vec();
                    let mut weights = random.weights().to_vec();
                    if !is_random {
                        let round = |p: &[f64; 3]| p.map(|x| (2.0 * x).round() / 2.0);
                        positions = positions.iter().map(round).collect();
                        weights = weights.iter().map(|w| (4.0 * w).round() / 4.0).collect();
                    }
                    let made = PeriodicPowerDiagram::of(torus, &positions, Some(&weights));
                    if repeats != [true; 3] && count == 1 {
                        assert!(made.unwrap_err().is_flat());
                        continue;
                    }
                    let made = made.unwrap();
                    let placed: Vec<_> = positions.iter().map(|&p| made.torus().wrap(p)).collect();
                    let (volumes, facets) = in_space(made.torus(), &placed, &weights);
                    for (volume, expected) in made.volumes().iter().zip(&volumes) {
                        assert!(is_near(*volume, *expected), "{volume} {expected}");
                    }
                    let rows = made.facets().iter().zip(made.shifts()).zip(made.areas());
                    let rows: BTreeMap<Key, f64> =
                        rows.map(|((&[p, q], &shift), &area)| ((p, q, shift), area)).collect();
                    assert_eq!(rows.len(), made.facets().len(), "each facet once");
                    assert!(rows.keys().eq(facets.keys()), "{seed} {repeats:?} {count}");
                    assert!(rows.values().zip(facets.values()).all(|(a, b)| is_near(*a, *b)));
                    if let Some(volume) = made.torus().volume() {
                        assert!(is_near(made.volumes().iter().sum(), volume));
                    }
                    unbounded += volumes.iter().filter(|volume| volume.is_infinite()).count();
                    hidden += volumes.iter().filter(|volume| **volume == 0.0).count();
                    own += rows.keys().filter(|(p, q, _)| p == q).count();
                    several += made.facets().windows(2).filter(|pair| pair[0] == pair[1]).count();
                }
            }
        }
        let counts = [unbounded, hidden, own, several];
        assert!(unbounded > 50 && hidden > 5 && own > 20 && several > 50, "{counts:?}");
    }

    /// A point in the middle between two others of a box that is only just not hidden has a cell that is a polygon; its facet is one between the
    /// others, across the side of the box as well.
    #[test]
    fn facets_of_polygons_belong_to_the_cells_beyond() {
        let torus = Torus::new([2.0, 2.0, 4.0]).unwrap();
        // Copies of the first are 4 apart along z; the second is halfway, and its weight the least that leaves it a polygon.
        let positions = [[0.5, 0.5, 0.0], [0.5, 0.5, 2.0]];
        let made = PeriodicPowerDiagram::of(torus, &positions, Some(&[4.0, 0.0])).unwrap();
        assert_eq!(made.volumes(), [16.0, 0.0]);
        let rows: Vec<_> = made.facets().iter().zip(made.shifts()).collect();
        assert_eq!(rows, [(&[0, 0], &[0, 0, 1]), (&[0, 0], &[0, 1, 0]), (&[0, 0], &[1, 0, 0])]);
        assert_eq!(made.areas(), [4.0, 8.0, 8.0]);
    }

    #[test]
    fn duplicates_have_no_cell() {
        let torus = Torus::new([2.0; 3]).unwrap();
        let positions = [[0.5; 3], [2.5, 0.5, 0.5], [1.5; 3]];
        let made = PeriodicPowerDiagram::of(torus, &positions, None).unwrap();
        assert_eq!(made.volumes()[1], 0.0);
        assert!(is_near(made.volumes()[0], 4.0) && is_near(made.volumes()[2], 4.0));
        assert!(made.facets().as_flattened().iter().all(|&v| v != 1));
        assert!(PeriodicPowerDiagram::of(torus, &positions, Some(&[0.0])).is_err());
        assert!(PeriodicPowerDiagram::of(torus, &[], None).is_err());
    }
}
