//! Shapes of points that span no volume: in one plane, on one line, or a single point.
//!
//! There are no cells. Classes are those of space: a simplex of the shape is singular if it is not a face of another simplex of
//! the shape, otherwise regular. None is interior, because space is on both sides.

use walpha_base::Monitor;
use walpha_complex::canonical::{ByRow, sorted};
use walpha_regular::internals::{Predicates, Sites, triangulate_flat};

use super::blocks::{Block, Long, Partition, Reach, too_long};
use super::topology::{components, flat_betti};
use super::{Betti, Class, Complex, ShapeError, Simplices, Torus};

/// A flat shape.
pub(super) struct FlatShape {
    /// All simplices of the triangulation with their classes, by input index.
    pub complex: Complex,
    pub betti: Betti,
}

/// The α-complex of sites that span no volume, and the simplices that are not in it.
pub(super) fn flat(
    sites: &Sites<'_>,
    alpha: f64,
    monitor: &Monitor,
) -> Result<FlatShape, ShapeError> {
    let work = monitor.units(sites.input().len() as u64);
    let tops = triangulate_flat(sites, |more| work.add(more as u64))?;
    let plane = Plane { spheres: Predicates::new(sites.positions(), sites.weights()), alpha };
    // The orthogonal sphere of a maximal simplex is always empty.
    let facets = plane.classified(lone(&tops.triangles));
    let mut edges = lone(&tops.edges);
    for (&[a, b, c], class) in facets.iter() {
        let seen = class != Class::Exterior;
        edges.extend([([b, c], a), ([a, c], b), ([a, b], c)].map(|(e, v)| (e, Some((v, seen)))));
    }
    let edges = plane.classified(edges);
    let mut vertices = lone(&tops.vertices);
    for (&[a, b], class) in edges.iter() {
        let seen = class != Class::Exterior;
        vertices.extend([([a], Some((b, seen))), ([b], Some((a, seen)))]);
    }
    let vertices = plane.classified(vertices);
    let input = sites.input();
    let complex = Complex {
        cells: Simplices::default(),
        facets: by_input(facets, input),
        edges: by_input(edges, input),
        vertices: by_input(vertices, input),
    };
    let betti = flat_betti(&complex);
    Ok(FlatShape { complex, betti })
}

/// The same for sites of a torus that repeats along one or two vectors, which span no volume with their copies. Exterior simplices, other than
/// vertices, are listed if they are wanted.
///
/// The simplices at the points of the box are those of their triangulation with the copies that a block of the whole triangulation has.
pub(super) fn flat_on_torus(
    sites: &Sites<'_>,
    torus: Torus,
    alpha: f64,
    exterior: bool,
    monitor: &Monitor,
) -> Result<FlatShape, ShapeError> {
    let block = Partition::new(sites, 1).block(sites, Reach::whole(sites), 0);
    let all = Sites::any(&block.positions, &block.weights)?;
    let FlatShape { complex, .. } = flat(&all, alpha, monitor)?;
    let own = |v: u32| v < block.own;
    let is_listed = |class: Class| exterior || class != Class::Exterior;
    let place = |v: u32| block.positions[v as usize];
    let input = |v: u32| block.input[v as usize];
    let mut long = None;
    for (&edge, class) in complex.edges.iter() {
        let [a, b] = edge;
        if is_listed(class) && (own(a) || own(b)) && !torus.are_near(place(a), place(b)) {
            let [a, b] = if input(a) <= input(b) { [a, b] } else { [b, a] };
            let found = Long { edge: [a, b].map(input), ends: [a, b].map(place) };
            long = long.into_iter().chain([found]).min_by_key(|long: &Long| long.edge);
        }
    }
    if let Some(long) = long {
        return Err(too_long(torus, long));
    }
    let covers = complex
        .facets
        .iter()
        .all(|(row, class)| class != Class::Exterior || !row.iter().any(|&v| own(v)));
    let is_sheet = covers && torus.dimension() == 2 && !complex.facets.is_empty();
    let complex = Complex {
        cells: Simplices::default(),
        facets: of_box(&complex.facets, &block, is_listed),
        edges: of_box(&complex.edges, &block, is_listed),
        vertices: of_box(&complex.vertices, &block, |_| true),
    };
    let b2 = u64::from(is_sheet);
    let betti =
        Betti::with_euler(components(&complex), b2, Some(0), complex.euler_characteristic());
    Ok(FlatShape { complex, betti })
}

/// The simplices whose smallest vertex, by input index, is in the box, by input indices.
fn of_box<const N: usize>(
    simplices: &Simplices<N>,
    block: &Block,
    is_listed: impl Fn(Class) -> bool,
) -> Simplices<N>
where
    [([u32; N], Class)]: ByRow,
{
    let input = |v: &u32| block.input[*v as usize];
    let in_box =
        |row: &[u32; N]| row.iter().min_by_key(|v| input(v)).is_some_and(|&v| v < block.own);
    let mut rows: Vec<([u32; N], Class)> = simplices
        .iter()
        .filter(|&(row, class)| is_listed(class) && in_box(row))
        .map(|(row, class)| (sorted(row.map(|v| input(&v))), class))
        .collect();
    rows.sort_by_row();
    rows.into_iter().collect()
}

/// A simplex, and a coface: its other vertex, and whether it is in the shape.
type Coface<const N: usize> = ([u32; N], Option<(u32, bool)>);

/// Simplices without cofaces.
fn lone<const N: usize>(rows: &[[u32; N]]) -> Vec<Coface<N>> {
    rows.iter().map(|&row| (row, None)).collect()
}

struct Plane<'a> {
    spheres: Predicates<'a>,
    alpha: f64,
}

impl Plane<'_> {
    /// Classifies simplices by their cofaces; a simplex is listed once per coface.
    fn classified<const N: usize>(&self, mut known: Vec<Coface<N>>) -> Simplices<N> {
        known.sort_unstable();
        let mut simplices = Simplices::default();
        for group in known.chunk_by(|a, b| a.0 == b.0) {
            let row = group[0].0;
            let mut cofaces = group.iter().filter_map(|(_, coface)| *coface);
            let class = if cofaces.clone().any(|(_, seen)| seen) {
                Class::Regular
            } else if self.fits(row) && !cofaces.any(|(v, _)| self.spheres.inside(row, v)) {
                Class::Singular
            } else {
                Class::Exterior
            };
            simplices.push(row, class);
        }
        simplices
    }

    /// Whether the smallest orthogonal sphere has a squared radius of at most α. Exact.
    fn fits<const N: usize>(&self, row: [u32; N]) -> bool {
        match self.alpha {
            f64::INFINITY => true,
            f64::NEG_INFINITY => false,
            alpha => self.spheres.fits(row, alpha),
        }
    }
}

/// Replaces site indices by input indices, which are in the same order.
fn by_input<const N: usize>(mut simplices: Simplices<N>, input: &[u32]) -> Simplices<N> {
    for v in simplices.rows_mut().as_flattened_mut() {
        *v = input[*v as usize];
    }
    simplices
}
