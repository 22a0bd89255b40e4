//! Many α at once: volume and area along a filtration.

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_shape::ladder::{ByLevel, Filtration, LevelRows, Span};
use walpha_shape::{Alpha, FacetSides};

use crate::points::Points;
use crate::real::{Bounded, Double, Real, Single};
use crate::scatter::{Records, scatter};
use crate::simplex::{Cell, Circle, Edge, Limits, Open, Triangle};
use crate::union::zeros;
use crate::{BallUnion, BallsError};

/// The union of balls at one α.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnionLevel {
    /// α.
    pub alpha: Alpha,
    /// The volume, in cubed units of the points; on a torus, of one box.
    pub volume: Bounded,
    /// The area of the boundary, in squared units of the points.
    pub area: Bounded,
    /// The Euler characteristic. Exact.
    pub euler_characteristic: i64,
}

/// The volume and the area of the union of the balls of squared radius α + ω at each α, ascending, duplicates left out.
///
/// The angles of a cell are computed once, when it enters the dual complex. What is computed at each α is what changes there: the
/// simplices of the complex that are not interior. Values and bounds are as of [`BallUnion`](crate::BallUnion), which also has the parts of
/// each ball.
///
/// ```
/// use walpha_balls::union_curve;
/// use walpha_shape::Alpha;
/// use walpha_shape::ladder::Filtration;
///
/// // Two points 1 apart. Balls of radius 1/2 touch.
/// let filtration = Filtration::new(&[[0.0; 3], [1.0, 0.0, 0.0]])?;
/// let curve = union_curve(&filtration, &[0.25, 1.0].map(|alpha| Alpha::from_squared(alpha).unwrap()))?;
/// assert!(curve[0].volume.contains(std::f64::consts::PI / 3.0));
/// assert!(curve[1].area.contains(6.0 * std::f64::consts::PI));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An infinite α; out of memory; cancelled by a [`Monitor`] that watches.
pub fn union_curve(
    filtration: &Filtration,
    alphas: &[Alpha],
) -> Result<Vec<UnionLevel>, BallsError> {
    let monitor = &*Monitor::current();
    if alphas.contains(&Alpha::INFINITE) {
        return Err(BallsError::Infinite);
    }
    let levels = filtration.levels(alphas);
    // In a box so small that balls meet their own copies, angles are shared in ways that rows do not tell.
    if !filtration.whole().copies().is_empty() {
        let level = |&alpha: &Alpha| {
            let shape = filtration.shape(alpha);
            let union = monitor.watch(|| BallUnion::new(&shape))?;
            Ok(UnionLevel {
                alpha,
                volume: union.volume(),
                area: union.area(),
                euler_characteristic: union.euler_characteristic(),
            })
        };
        return levels.alphas().iter().map(level).collect();
    }
    let points = Points::of(filtration.whole());
    let mut climb = Climb::new(levels.rows(), levels.len(), points.len())?;
    let steps = monitor.units(levels.len() as u64);
    let level = |(level, &alpha): (usize, &Alpha)| {
        steps.add(1)?;
        Ok(climb.level(level, alpha, &points.at(alpha.squared())))
    };
    levels.alphas().iter().enumerate().map(level).collect()
}

/// What changes from level to level.
struct Climb<'a> {
    rows: LevelRows<'a>,
    cells: ByLevel,
    facets: Boundary<'a>,
    edges: Boundary<'a>,
    vertices: Boundary<'a>,
    /// The edges by the level from which they are interior.
    interior_edges: ByLevel,
    /// For each edge, the angles of the cells, and those of tetrahedra with a point of the boundary as apex; for each point, the solid angles of those.
    closed: Vec<Single>,
    open: Vec<Single>,
    solids: Vec<Single>,
    /// For each point, the number of its cells, and of its interior edges.
    cells_at: Vec<u32>,
    interior_edges_at: Vec<u32>,
    /// Over the edges at each point, the angles of the cells, and the caps times the angles that no ball covers.
    rims: Vec<[Single; 2]>,
    six_volumes: Double,
    euler: i64,
}

/// The simplices of a dimension that are in the shape and not interior.
struct Boundary<'a> {
    spans: &'a [Span],
    entering: ByLevel,
    rows: Vec<u32>,
}

impl<'a> Boundary<'a> {
    fn new(levels: usize, spans: &'a [Span]) -> Self {
        let entering = ByLevel::new(levels, spans.iter().map(|span| span.first));
        Self { spans, entering, rows: Vec::new() }
    }

    /// Goes to a level; returns how many simplices enter.
    fn climb(&mut self, level: usize) -> i64 {
        let stays = |&row: &u32| self.spans[row as usize].interior > level as u32;
        self.rows.retain(stays);
        let entering = self.entering.at(level);
        self.rows.extend(entering.iter().copied().filter(stays));
        entering.len() as i64
    }
}

/// Simplices that are one piece of work.
const PIECE: usize = 1 << 10;

impl<'a> Climb<'a> {
    fn new(rows: LevelRows<'a>, levels: usize, points: usize) -> Result<Self, BallsError> {
        let what = "the angles of the dual complex";
        let interior = rows.edge_spans.iter().map(|span| span.interior.min(levels as u32));
        Ok(Self {
            rows,
            cells: ByLevel::new(levels, rows.cells.iter().copied()),
            facets: Boundary::new(levels, rows.facet_spans),
            edges: Boundary::new(levels, rows.edge_spans),
            vertices: Boundary::new(levels, rows.vertex_spans),
            interior_edges: ByLevel::new(levels, interior),
            closed: zeros(rows.edge_spans.len(), what)?,
            open: zeros(rows.edge_spans.len(), what)?,
            solids: zeros(points, what)?,
            cells_at: zeros(points, what)?,
            interior_edges_at: zeros(points, what)?,
            rims: zeros(points, what)?,
            six_volumes: Double::default(),
            euler: 0,
        })
    }

    fn level(&mut self, level: usize, alpha: Alpha, points: &Points<'_>) -> UnionLevel {
        self.add_cells(level, points);
        let [facets, edges, vertices] =
            [&mut self.facets, &mut self.edges, &mut self.vertices].map(|of| of.climb(level));
        self.euler += vertices - edges + facets - self.cells.at(level).len() as i64;
        for &row in self.interior_edges.at(level) {
            for v in self.rows.complex.edges.rows()[row as usize] {
                self.interior_edges_at[v as usize] += 1;
            }
        }
        let mut six_volumes = self.six_volumes + self.open_facets(level, points);
        six_volumes += self.open_edges(points);
        let (more, area) = self.spheres(points);
        six_volumes += more;
        let volume = six_volumes.sixth();
        UnionLevel {
            alpha,
            volume: points.bounded(volume, 3),
            area: points.bounded(area.rounded(), 2),
            euler_characteristic: self.euler,
        }
    }

    /// Adds the cells that enter at a level.
    fn add_cells(&mut self, level: usize, points: &Points<'_>) {
        let rows = self.rows;
        let of_cells = |cells: &[u32]| {
            let (mut angles, mut six_volumes) = (Records::new(), Double::default());
            for &row in cells {
                let corners = rows.complex.cells.rows()[row as usize];
                let cell = Cell::measured(points.balls(corners), points.alpha);
                six_volumes += cell.det;
                angles.extend(edges_of_cell(&rows, row).into_iter().zip(cell.angles));
            }
            (angles, six_volumes)
        };
        let entering = self.cells.at(level);
        let found: Vec<_> = entering.par_chunks(PIECE).map(of_cells).collect();
        scatter(&found, |of| &of.0, &mut self.closed, |sum, &more| *sum += more);
        found.iter().for_each(|&(_, more)| self.six_volumes += more);
        for &row in entering {
            for v in rows.complex.cells.rows()[row as usize] {
                self.cells_at[v as usize] += 1;
            }
        }
    }

    /// Adds the open sides of facets; returns six times their volume.
    fn open_facets(&mut self, level: usize, points: &Points<'_>) -> Double {
        let rows = self.rows;
        let is_open =
            |&&cell: &&u32| cell == FacetSides::OPEN || rows.cells[cell as usize] as usize > level;
        let of_facets = |facets: &[u32]| {
            let (mut angles, mut solids, mut six_volumes) =
                (Records::new(), Records::new(), Double::default());
            for &row in facets {
                let row = row as usize;
                let corners = rows.facets[row];
                let balls = points.balls(corners);
                let limits = Limits::of(&balls, points.alpha);
                let triangle = Triangle::of(balls);
                let (open, _) = Open::measured(&triangle, balls, points.alpha, limits);
                for _ in rows.facet_cells[row].iter().filter(is_open) {
                    angles.extend(rows.facet_edges[row].into_iter().zip(open.angles));
                    solids.extend(corners.into_iter().zip(open.corners));
                    six_volumes += open.det;
                }
            }
            (angles, solids, six_volumes)
        };
        for &row in &self.edges.rows {
            self.open[row as usize] = Single::ZERO;
        }
        for &row in &self.vertices.rows {
            let [v] = rows.complex.vertices.rows()[row as usize];
            self.solids[v as usize] = Single::ZERO;
        }
        let found: Vec<_> = self.facets.rows.par_chunks(PIECE).map(of_facets).collect();
        scatter(&found, |of| &of.0, &mut self.open, |sum, &more| *sum += more);
        scatter(&found, |of| &of.1, &mut self.solids, |sum, &more| *sum += more);
        sum(found.iter().map(|of| of.2))
    }

    /// Adds the arcs; returns six times the volume below their discs.
    fn open_edges(&mut self, points: &Points<'_>) -> Double {
        let Self { rows, closed, open, .. } = self;
        let of_edges = |edges: &[u32]| {
            let (mut rims, mut six_volumes) = (Records::new(), Double::default());
            for &row in edges {
                let ends = rows.complex.edges.rows()[row as usize];
                let closed = closed[row as usize];
                let arc = Single::pi().times(2.0) - closed - open[row as usize];
                let balls = points.balls(ends);
                let edge = Edge::measured(balls, points.alpha);
                let circle = Circle::measured(balls, points.alpha);
                six_volumes += arc * circle.squared * edge.distance;
                let rim = |k: usize| (ends[k], [closed, arc * circle.caps[k]]);
                rims.extend([rim(0), rim(1)]);
            }
            (rims, six_volumes)
        };
        for &row in &self.vertices.rows {
            let [v] = rows.complex.vertices.rows()[row as usize];
            self.rims[v as usize] = [Single::ZERO; 2];
        }
        let found: Vec<_> = self.edges.rows.par_chunks(PIECE).map(of_edges).collect();
        scatter(
            &found,
            |of| &of.0,
            &mut self.rims,
            |sum, more| {
                sum[0] += more[0];
                sum[1] += more[1];
            },
        );
        sum(found.iter().map(|of| of.1))
    }

    /// Six times the volume below the spheres, and their area.
    fn spheres(&self, points: &Points<'_>) -> (Double, Double) {
        let of_vertices = |vertices: &[u32]| {
            let (mut six_volumes, mut area) = (Double::default(), Double::default());
            for &row in vertices {
                let [v] = self.rows.complex.vertices.rows()[row as usize];
                let at = v as usize;
                let cells = i64::from(self.cells_at[at]) + 4;
                let halves = cells - 2 * i64::from(self.interior_edges_at[at]);
                let [closed, caps] = self.rims[at];
                let turns = Single::pi() * Single::exact(halves as f64);
                let solid = turns - closed - self.solids[at];
                let radius = points.squared_radius::<Single>(v).sqrt();
                let patch = radius * (radius * solid - caps);
                area += patch;
                six_volumes += (patch * radius).times(2.0);
            }
            (six_volumes, area)
        };
        let found: Vec<_> = self.vertices.rows.par_chunks(PIECE).map(of_vertices).collect();
        (sum(found.iter().map(|of| of.0)), sum(found.iter().map(|of| of.1)))
    }
}

fn sum(terms: impl Iterator<Item = Double>) -> Double {
    terms.fold(Double::default(), |sum, term| sum + term)
}

/// The edges of a cell by row, in the order of [`Cell::EDGES`].
fn edges_of_cell(rows: &LevelRows<'_>, row: u32) -> [u32; 6] {
    let corners = rows.complex.cells.rows()[row as usize];
    Cell::EDGES.map(|[i, j]| {
        // The edge is in the facets opposite the two other corners, opposite the one in that of the other.
        let mut others = (0..4).filter(|k| ![i, j].contains(k));
        let (k, l) = (others.next().unwrap_or(0), others.next().unwrap_or(0));
        let facet = rows.cell_facets[row as usize][l] as usize;
        let at = rows.facets[facet].iter().position(|&v| v == corners[k]);
        rows.facet_edges[facet][at.expect("a corner of the facet")]
    })
}
