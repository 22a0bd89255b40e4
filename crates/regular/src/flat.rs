//! Regular triangulations of points that span no volume: in one plane, on one line, or a single point.
//!
//! Auxiliary points are added until all points span a volume: one for a plane, two for a line, three for a point.
//! The plane (line, point) then supports the convex hull. Over a supporting hyperplane, the lower hull of the lifted
//! points is the lower hull of the lifted points in it, so the triangulation of space restricted to the plane is the
//! regular triangulation of the points there. Infinitesimal raises of heights do not change this, so ties are broken
//! in the order of (x, y, z) as in space. Each maximal simplex of the flat triangulation is in exactly one finite
//! cell, together with all auxiliary points.

use super::{Predicates, Sites, SitesError, TriangulationError, insert_all};
use walpha_base::Cancelled;

/// The maximal simplices of a flat triangulation, all of one dimension; site indices ascend within each.
#[derive(Debug, Default)]
pub struct Flat {
    /// The triangles of points in a plane.
    pub triangles: Vec<[u32; 3]>,
    /// The edges of points on a line.
    pub edges: Vec<[u32; 2]>,
    /// A point alone.
    pub vertices: Vec<[u32; 1]>,
}

/// The triangulation of sites that span no volume. `inserted` is called from time to time with the number of points inserted
/// since the last call. Expected O(n log n).
///
/// # Errors
/// Out of memory.
pub fn triangulate_flat(
    sites: &Sites<'_>,
    inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<Flat, TriangulationError> {
    let near = moved_to_first(sites.positions());
    let places = near.as_deref().unwrap_or(sites.positions());
    let auxiliary = auxiliary_positions(places);
    let along = sites.curve();
    let extra = auxiliary.len() as u32;
    let mut positions = auxiliary;
    positions.extend(along.iter().map(|&i| places[i as usize]));
    // With any weights, they are vertices, because they are extreme points of the hull.
    let mut weights = vec![0.0; extra as usize];
    weights.extend(along.iter().map(|&i| sites.weights()[i as usize]));
    let made = insert_all(&positions, &weights, inserted)?;
    let mut flat = Flat::default();
    for cell in made.cells().iter().filter(|cell| !cell.contains(&made.infinite_vertex())) {
        let mut rest: Vec<u32> =
            cell.iter().filter(|&&v| v >= extra).map(|&v| along[(v - extra) as usize]).collect();
        rest.sort_unstable();
        match (extra, &rest[..]) {
            (1, &[a, b, c]) => flat.triangles.push([a, b, c]),
            (2, &[a, b]) => flat.edges.push([a, b]),
            (3, &[a]) => flat.vertices.push([a]),
            // Cells without one of the auxiliary points hold no maximal simplex.
            _ => {}
        }
    }
    flat.triangles.sort_unstable();
    flat.edges.sort_unstable();
    Ok(flat)
}

/// All positions, moved so that the first is the origin, if that is exact and makes coordinates smaller. Moving changes no triangulation, but auxiliary points
/// are nearer then, so that doubles decide more predicates: of points on a map, far from its origin, nearly all instead of hardly any.
fn moved_to_first(all: &[[f64; 3]]) -> Option<Vec<[f64; 3]>> {
    let first = all.first()?;
    let moved = |place: &[f64; 3]| {
        let near = [0, 1, 2].map(|k| place[k] - first[k]);
        // The error of a difference, by Knuth's two-sum.
        let is_exact = (0..3).all(|k| {
            let virtual_first = place[k] - near[k];
            let virtual_place = near[k] + virtual_first;
            (place[k] - virtual_place) + (virtual_first - first[k]) == 0.0
        });
        is_exact.then_some(near)
    };
    let near: Vec<_> = all.iter().map(moved).collect::<Option<_>>()?;
    let largest =
        |of: &[[f64; 3]]| of.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    (largest(&near) < largest(all)).then_some(near)
}

/// Checks that sites, on a torus with their copies, span a volume. O(n) if they do not, usually less if they do.
///
/// # Errors
/// [`SitesError::Flat`].
pub fn check_span(sites: &Sites<'_>) -> Result<(), SitesError> {
    let copies = sites
        .torus()
        .zip(sites.positions().first())
        .map(|(torus, &place)| [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|by| torus.moved(place, by)));
    match spanning_of(sites.positions().iter().chain(copies.as_slice().as_flattened())).len() {
        4 => Ok(()),
        count => Err(SitesError::flat(sites.positions().len(), count as i32 - 1)),
    }
}

/// At most four of the positions, affinely independent, with the same affine hull as all: four if they span a volume, three in a
/// plane, two on a line. Exact. O(n) if they span no volume, usually less if they do.
pub fn spanning(all: &[[f64; 3]]) -> Vec<[f64; 3]> {
    spanning_of(all.iter())
}

fn spanning_of<'a>(all: impl Iterator<Item = &'a [f64; 3]>) -> Vec<[f64; 3]> {
    let mut spanning = Vec::new();
    for &position in all {
        if spanning.len() == 4 {
            break;
        }
        if is_independent(&spanning, position) {
            spanning.push(position);
        }
    }
    spanning
}

/// Whether a position is outside the affine hull of others. Exact.
fn is_independent(spanning: &[[f64; 3]], position: [f64; 3]) -> bool {
    // Most planes are those of a map or a slice, for which comparing is enough.
    let is_shared = |k: usize| spanning.iter().all(|other| other[k] == position[k]);
    if spanning.len() == 3 && (0..3).any(is_shared) {
        return false;
    }
    let mut positions = spanning.to_vec();
    positions.push(position);
    let weights = vec![0.0; positions.len()];
    let predicates = Predicates::new(&positions, &weights);
    match positions.len() {
        1 => true,
        2 => positions[0] != positions[1],
        3 => !predicates.collinear([0, 1, 2]),
        _ => predicates.orientation([0, 1, 2, 3]).is_ne(),
    }
}

/// Positions of auxiliary points that span a volume with the given ones; empty if the given ones span a volume. Each is displaced
/// from the first position along an axis, through the origin, by more than the largest coordinate.
pub fn auxiliary_positions(all: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut spanning = spanning(all);
    let given = spanning.len();
    let largest = all.as_flattened().iter().fold(0f64, |most, x| most.max(x.abs()));
    // A power of two, so that coordinates stay on their lattice. For points at the origin alone, any distance is suitable.
    let exponent = largest.max(SHORTEST).log2().ceil() as i32;
    let distance = if largest > 0.0 { 2f64.powi(exponent + 1) } else { 1.0 };
    for axis in 0..3 {
        let mut auxiliary = spanning[0];
        auxiliary[axis] -= distance.copysign(auxiliary[axis]);
        if spanning.len() < 4 && is_independent(&spanning, auxiliary) {
            spanning.push(auxiliary);
        }
    }
    spanning.split_off(given)
}

/// Whether the reason for an error is that points span no volume.
pub fn is_flat(error: &TriangulationError) -> bool {
    matches!(
        error,
        TriangulationError::Sites(SitesError::Flat { .. } | SitesError::TooFew { distinct: 1.. })
    )
}

/// The approximate minimum distance of auxiliary points: powers of shorter lengths leave the range of doubles.
const SHORTEST: f64 = 1e-150;

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(positions: &[[f64; 3]]) -> Flat {
        let weights = vec![0.0; positions.len()];
        let sites = Sites::any(positions, &weights).unwrap();
        triangulate_flat(&sites, |_| Ok(())).unwrap()
    }

    /// The triangulation of points far from the origin is that of the same points near it, with their ties.
    #[test]
    fn where_points_lie_changes_nothing() {
        let grid = (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10), 0.0]);
        let tilted: Vec<_> = grid.map(|[x, y, _]| [x, y, x - 2.0 * y]).collect();
        let far: Vec<_> = tilted.iter().map(|p| p.map(|x| x + 2f64.powi(22))).collect();
        assert_eq!(moved_to_first(&far).unwrap()[..], tilted[..]);
        assert_eq!(flat(&far).triangles, flat(&tilted).triangles);
        // Differences that would be rounded, and none that is smaller.
        assert_eq!(moved_to_first(&[[1e-20, 0.0, 0.0], [1.0, 0.0, 0.0]]), None);
        assert_eq!(moved_to_first(&[[0.0; 3], [1.0, 0.0, 0.0]]), None);
        assert_eq!(moved_to_first(&[]), None);
    }

    #[test]
    fn a_square_a_line_and_a_point() {
        let square = [[0.0; 3], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 2.0]];
        assert_eq!(flat(&square).triangles.len(), 2);
        let line = [[0.5; 3], [-1.5; 3], [2.5; 3], [2.0; 3]];
        assert_eq!(flat(&line).edges, [[0, 1], [0, 3], [2, 3]]);
        assert_eq!(flat(&[[0.0; 3]]).vertices, [[0]]);
        assert_eq!(flat(&[[1e300_f64.sqrt(); 3]]).vertices, [[0]]);
        assert_eq!(flat(&[[5e-324, 0.0, 0.0], [0.0; 3]]).edges, [[0, 1]]);
    }
}
