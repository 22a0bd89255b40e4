//! Voids and pockets: what the balls leave of the cells that are not in the dual complex.
//!
//! Within a cell of the triangulation that is not in the complex, the balls have the volume of the sectors at its corners, less the parts of the
//! lenses at its edges, and the parts at its facets, of those faces that are in the complex (Edelsbrunner, Facello and Liang 1998,
//! doi:10.1016/S0166-218X(98)00067-5). For a void the sum over its cells is its volume exactly.

use walpha_base::parallel::prelude::*;
use walpha_base::sort::sort_by;
use walpha_base::{Monitor, UnionFind};
use walpha_regular::internals::Predicates;
use walpha_shape::{Alpha, Class, Complex, FacetSides};

use crate::points::Points;
use crate::real::{Bounded, Double, Real, Single};
use crate::simplex::{Ball, Cell, Circle, Edge, Limits, Open, Triangle};
use crate::union::in_shape;
use crate::{BallUnion, BallsError};

/// A void or a pocket, as the balls leave it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Cavity {
    /// Number of its cells.
    pub cells: usize,
    /// The volume that the balls leave of its cells, in cubed units of the points.
    pub volume: Bounded,
    /// The area of the balls in its cells, in squared units of the points.
    pub area: Bounded,
    /// The balls at its cells, by input index, ascending.
    pub lining: Vec<u32>,
    /// The α that fills it: the largest squared radius of the orthogonal spheres of its cells, rounded up to a double.
    pub filling_alpha: Alpha,
}

/// A pocket: a part of the space outside the union that is wider than its mouths.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pocket {
    /// Its cells, as the balls leave them.
    pub cavity: Cavity,
    /// Its mouths: the facets between its cells and the outside, grouped by their common edges that are not in the dual complex. None
    /// for a void.
    pub mouths: Vec<Vec<[u32; 3]>>,
    /// Its depth: the α at which its last mouth closes, so that it is a void; rounded up to a double. `None` for a void.
    pub closing_alpha: Option<Alpha>,
}

impl BallUnion<'_> {
    /// The voids of the union, in the order of [`AlphaShape::voids`](walpha_shape::AlphaShape::voids), each as the balls leave it. Linear in the number of their cells, after
    /// O(n log n) to find them.
    ///
    /// # Errors
    /// [`BallsError::NoExterior`] unless the shape lists its [exterior](walpha_shape::ShapeOptions::exterior) simplices.
    pub fn voids(&self) -> Result<Vec<Cavity>, BallsError> {
        self.refuse_small_box("voids")?;
        let voids = self.shape.voids_and_cells().ok_or(BallsError::NoExterior { what: "voids" })?;
        let rest = Rest::of(self)?;
        let cavity =
            |(void, cells): (walpha_shape::Void, Vec<u32>)| rest.cavity(&cells, void.filling_alpha);
        Ok(voids.into_par_iter().map(cavity).collect())
    }

    /// The pockets of the union, largest first, voids included: by the discrete flow of Edelsbrunner, Facello and Liang, in which a cell outside
    /// the dual complex flows across each facet beyond which the centre of its orthogonal sphere lies. Cells from which nothing flows to
    /// infinity are pockets. Which they are is decided exactly; a centre that lies in the plane of a facet does not flow across it.
    ///
    /// The balls of other cells may reach through the mouths of a pocket, and those of its own through them outwards: by convention, volume
    /// and area are the sums over its own cells. O(n log n).
    ///
    /// # Errors
    /// [`BallsError::NoExterior`] unless the shape lists its [exterior](walpha_shape::ShapeOptions::exterior) simplices;
    /// [`BallsError::NoOutside`] on a torus; cancelled by a [`Monitor`] that watches.
    pub fn pockets(&self) -> Result<Vec<Pocket>, BallsError> {
        let shape = self.shape;
        if !shape.options().exterior {
            return Err(BallsError::NoExterior { what: "pockets" });
        }
        if shape.options().periodic.is_some() {
            return Err(BallsError::NoOutside);
        }
        let monitor = &*Monitor::current();
        let flow = Flow::of(self);
        monitor.check()?;
        let found = flow.pockets(&flow.outside());
        monitor.check()?;
        let rest = Rest::of(self)?;
        let pocket = |cells: &Vec<u32>| {
            let cavity = rest.cavity(cells, flow.filling_alpha(cells));
            let mouths = flow.mouths(cells);
            let closing_alpha = mouths.iter().flatten().map(|&row| flow.entry(row)).max();
            let facets =
                |mouth: Vec<usize>| mouth.into_iter().map(|row| flow.sides.facets()[row]).collect();
            Pocket { cavity, mouths: mouths.into_iter().map(facets).collect(), closing_alpha }
        };
        let mut pockets: Vec<Pocket> = found.par_iter().map(pocket).collect();
        // Stable: of equal ones, that of the smallest cell is first.
        sort_by(&mut pockets, |a, b| b.cavity.volume.value.total_cmp(&a.cavity.volume.value));
        Ok(pockets)
    }
}

/// What the balls leave of exterior cells.
struct Rest<'a> {
    points: &'a Points<'a>,
    whole: &'a Complex,
    complex: &'a Complex,
    sides: &'a FacetSides,
    in_shape: Vec<bool>,
}

impl<'a> Rest<'a> {
    fn of(union: &'a BallUnion<'_>) -> Result<Self, BallsError> {
        let BallUnion { shape, complex, points, sides, .. } = union;
        let in_shape = in_shape(complex, points.len(), "voids")?;
        Ok(Self { points, whole: shape.complex(), complex, sides, in_shape })
    }

    fn cavity(&self, cells: &[u32], filling_alpha: Alpha) -> Cavity {
        let (mut six_volumes, mut area) = (Double::default(), Double::default());
        let mut lining: Vec<u32> = Vec::new();
        for &row in cells {
            let cell = self.whole.cells.rows()[row as usize];
            self.add(cell, &mut six_volumes, &mut area);
            lining.extend(cell.iter().filter(|&&v| self.in_shape[v as usize]));
        }
        lining.sort_unstable();
        lining.dedup();
        let volume = six_volumes.sixth();
        Cavity {
            cells: cells.len(),
            volume: self.points.bounded(volume, 3),
            area: self.points.bounded(area.rounded(), 2),
            lining,
            filling_alpha,
        }
    }

    /// Adds what the balls leave of a cell to six times a volume, and their area in it to an area.
    fn add(&self, cell: [u32; 4], six_volumes: &mut Double, area: &mut Double) {
        let balls = self.points.balls(cell);
        let alpha = self.points.alpha;
        let Cell { det, angles } = Cell::measured(balls, alpha);
        *six_volumes += det;
        let radius = |corner: usize| self.points.squared_radius::<Single>(cell[corner]).sqrt();
        for corner in (0..4).filter(|&corner| self.in_shape[cell[corner] as usize]) {
            let [a, b, c] = Cell::AT[corner].map(|edge| angles[edge]);
            take_sector(radius(corner), a + b + c - Single::pi(), six_volumes, area);
        }
        let sorted = |corners: &[usize; 2]| {
            let [a, b] = corners.map(|corner| cell[corner]);
            [a.min(b), a.max(b)]
        };
        for (corners, angle) in Cell::EDGES.iter().zip(angles) {
            if self.sides.find_edge(self.complex, sorted(corners)).is_some() {
                let lens = Lens::of(corners.map(|corner| balls[corner]), alpha);
                lens.take(angle, six_volumes, area);
            }
        }
        for corners in Cell::FACETS {
            let mut facet = corners.map(|corner| cell[corner]);
            facet.sort_unstable();
            if self.sides.find_facet(facet).is_none() {
                continue;
            }
            // Half of what three balls share is the tetrahedron to the point on this side, less sectors, and with parts of lenses.
            let balls = corners.map(|corner| balls[corner]);
            let limits = Limits::of(&balls, alpha);
            let (open, _) = Open::measured(&Triangle::of(balls), balls, alpha, limits);
            *six_volumes += -open.det;
            for k in 0..3 {
                take_sector(radius(corners[k]), -open.corners[k], six_volumes, area);
                let lens = Lens::of([balls[(k + 1) % 3], balls[(k + 2) % 3]], alpha);
                lens.take(-open.angles[k], six_volumes, area);
            }
        }
    }
}

/// Takes the sector of a ball in a solid angle from a volume, and adds its area.
fn take_sector(radius: Single, solid: Single, six_volumes: &mut Double, area: &mut Double) {
    let patch = radius.square() * solid;
    *area += patch;
    *six_volumes += -(patch * radius).times(2.0);
}

/// What two balls share, for each radian around their axis.
struct Lens {
    area: Single,
    six_volumes: Single,
}

impl Lens {
    fn of(balls: [Ball; 2], alpha: f64) -> Self {
        let edge = Edge::measured(balls, alpha);
        let circle = Circle::measured(balls, alpha);
        let radii = balls.map(|ball| Single::sum(alpha, ball.weight).sqrt());
        let [a, b] = [0, 1].map(|k| radii[k] * circle.caps[k]);
        // Sectors, less the cone over the disc from either side.
        let sectors = (a * radii[0] + b * radii[1]).times(2.0);
        Self { area: a + b, six_volumes: sectors - circle.squared * edge.distance }
    }

    /// Gives a part of the lens back to a volume, and takes its area: it was in the sectors of both balls.
    fn take(&self, angle: Single, six_volumes: &mut Double, area: &mut Double) {
        *area += -(self.area * angle);
        *six_volumes += self.six_volumes * angle;
    }
}

/// The flow between the exterior cells of a whole triangulation.
struct Flow<'a> {
    whole: &'a Complex,
    /// The cells on both sides of each facet, by row.
    sides: FacetSides,
    complex: &'a Complex,
    /// The facets of the dual complex.
    dual: &'a FacetSides,
    spheres: Predicates<'a>,
    /// Of each exterior cell, across which facets it flows.
    across: Vec<[bool; 4]>,
}

impl<'a> Flow<'a> {
    fn of(union: &'a BallUnion<'_>) -> Self {
        let shape = union.shape;
        let (whole, positions) = (shape.complex(), shape.points().positions());
        let spheres = Predicates::new(positions, shape.power_weights());
        let across = (whole.cells.rows().par_iter().zip(whole.cells.classes()))
            .map(|(&cell, &class)| match class {
                Class::Exterior => spheres.inside_opposite(cell),
                _ => [false; 4],
            })
            .collect();
        let sides = FacetSides::cells(whole, positions);
        Self { whole, sides, complex: &union.complex, dual: &union.sides, spheres, across }
    }

    /// The facets of a cell by row, in the order of the corners opposite them.
    fn facets(&self, cell: u32) -> [usize; 4] {
        let corners = self.whole.cells.rows()[cell as usize];
        Cell::FACETS.map(|facet| {
            let mut facet = facet.map(|corner| corners[corner]);
            facet.sort_unstable();
            self.sides.find_facet(facet).expect("each face of a cell is listed")
        })
    }

    /// The cell beyond a facet; [`FacetSides::OPEN`] beyond the hull.
    fn beyond(&self, facet: usize, cell: u32) -> u32 {
        let [a, b] = self.sides.sides(facet);
        if a == cell { b } else { a }
    }

    fn is_exterior(&self, cell: u32) -> bool {
        self.whole.cells.classes()[cell as usize] == Class::Exterior
    }

    /// Whether a cell flows across one of its facets.
    fn flows(&self, cell: u32, facet: usize) -> bool {
        let at = self.facets(cell).iter().position(|&other| other == facet);
        at.is_some_and(|at| self.across[cell as usize][at])
    }

    /// Whether something flows from each cell to infinity.
    fn outside(&self) -> Vec<bool> {
        let cells = self.across.len() as u32;
        let mut outside = vec![false; cells as usize];
        let leaves = |cell: &u32| {
            let mut facets = self.facets(*cell).into_iter().zip(self.across[*cell as usize]);
            facets.any(|(facet, flows)| flows && self.beyond(facet, *cell) == FacetSides::OPEN)
        };
        let mut next: Vec<u32> = (0..cells).into_par_iter().filter(leaves).collect();
        next.iter().for_each(|&cell| outside[cell as usize] = true);
        while let Some(cell) = next.pop() {
            for facet in self.facets(cell) {
                let from = self.beyond(facet, cell);
                if from != FacetSides::OPEN && !outside[from as usize] && self.flows(from, facet) {
                    outside[from as usize] = true;
                    next.push(from);
                }
            }
        }
        outside
    }

    /// The exterior cells that are not outside, in components that are joined across facets outside the complex; each ascends, and they are in
    /// the order of their smallest cells.
    fn pockets(&self, outside: &[bool]) -> Vec<Vec<u32>> {
        let cells = self.across.len();
        let inside = |cell: u32| !outside[cell as usize] && self.is_exterior(cell);
        let sets = UnionFind::new(cells);
        for cell in (0..cells as u32).filter(|&cell| inside(cell)) {
            for facet in self.facets(cell) {
                let other = self.beyond(facet, cell);
                if other != FacetSides::OPEN && inside(other) && self.is_free(facet) {
                    sets.unite(cell, other);
                }
            }
        }
        let mut of: Vec<(u32, u32)> = (0..cells as u32)
            .filter(|&cell| inside(cell))
            .map(|cell| (sets.find(cell), cell))
            .collect();
        of.sort_unstable();
        let cells = |of: &[(u32, u32)]| of.iter().map(|&(_, cell)| cell).collect();
        of.chunk_by(|a, b| a.0 == b.0).map(cells).collect()
    }

    /// Whether a facet is not in the dual complex.
    fn is_free(&self, facet: usize) -> bool {
        self.dual.find_facet(self.sides.facets()[facet]).is_none()
    }

    /// The free facets between cells, which ascend, and the outside, grouped by common edges that are not in the dual complex.
    fn mouths(&self, cells: &[u32]) -> Vec<Vec<usize>> {
        let mut facets: Vec<usize> = Vec::new();
        for &cell in cells {
            let open = self.facets(cell).into_iter().filter(|&facet| {
                cells.binary_search(&self.beyond(facet, cell)).is_err() && self.is_free(facet)
            });
            facets.extend(open);
        }
        facets.sort_unstable();
        let mut edges: Vec<([u32; 2], u32)> = Vec::new();
        for (at, &facet) in facets.iter().enumerate() {
            let [a, b, c] = self.sides.facets()[facet];
            edges.extend([[a, b], [a, c], [b, c]].map(|edge| (edge, at as u32)));
        }
        edges.retain(|&(edge, _)| self.dual.find_edge(self.complex, edge).is_none());
        edges.sort_unstable();
        let sets = UnionFind::new(facets.len());
        for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            sets.unite(pair[0].1, pair[1].1);
        }
        let mut of: Vec<(u32, usize)> =
            (0..).zip(&facets).map(|(at, &facet)| (sets.find(at), facet)).collect();
        of.sort_unstable();
        let facets = |of: &[(u32, usize)]| of.iter().map(|&(_, facet)| facet).collect();
        of.chunk_by(|a, b| a.0 == b.0).map(facets).collect()
    }

    /// The α at which a free facet enters the dual complex, rounded up to a double: that of its own sphere, if that is empty, or else that of the
    /// first of its cells.
    fn entry(&self, facet: usize) -> Alpha {
        let cells = self.sides.sides(facet).into_iter().filter(|&cell| cell != FacetSides::OPEN);
        let alpha = if cells.clone().any(|cell| self.flows(cell, facet)) {
            let first =
                |cell: u32| self.spheres.first_alpha(self.whole.cells.rows()[cell as usize]);
            cells.map(first).fold(f64::INFINITY, f64::min)
        } else {
            self.spheres.first_alpha(self.sides.facets()[facet])
        };
        Alpha::from_squared(alpha).expect("radii are numbers")
    }

    /// The largest squared radius of the orthogonal spheres of cells, rounded up to a double.
    fn filling_alpha(&self, cells: &[u32]) -> Alpha {
        let corners = |&cell: &u32| self.whole.cells.rows()[cell as usize];
        let radii: Vec<_> =
            cells.iter().map(|cell| self.spheres.squared_radius(corners(cell))).collect();
        let least = radii.iter().map(|radius| radius.low).fold(f64::NEG_INFINITY, f64::max);
        let mut alpha = f64::NEG_INFINITY;
        for (cell, &radius) in cells.iter().map(corners).zip(&radii) {
            // A cell that certainly fits earlier than another one does not matter.
            if radius.high >= least && !self.spheres.fits_by(cell, radius, alpha) {
                alpha = self.spheres.first_alpha(cell);
            }
        }
        Alpha::from_squared(alpha).expect("radii are numbers")
    }
}
