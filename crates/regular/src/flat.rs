//! Regular triangulations of points in one plane or on one line, or of one alone.
//!
//! A few points are added so that all together span a volume: one beside a plane, two beside a line,
//! three beside a point. The plane (line, point) then supports the convex hull, so what the
//! triangulation of space has in it is the regular triangulation of the points there: over a
//! supporting hyperplane the lower hull of lifted points is that of the points in it. Heights raised
//! by infinitely little change nothing of this, so ties are broken in the order of (x, y, z) as in space.
//! Each of its largest simplices is in one finite cell, with all the points added.

use super::{Predicates, Sites, SitesError, TriangulationError, insert_all};
use walpha_base::Cancelled;

/// The largest simplices of a flat triangulation, by site index, each ascending: all of one kind.
#[derive(Debug, Default)]
pub struct Flat {
    /// Of points in a plane.
    pub triangles: Vec<[u32; 3]>,
    /// Of points on a line.
    pub edges: Vec<[u32; 2]>,
    /// A point alone.
    pub vertices: Vec<[u32; 1]>,
}

/// The triangulation of sites that span no volume; `inserted` hears now and then how many more are in. Expected O(n log n).
///
/// # Errors
/// No memory.
pub fn triangulate_flat(
    sites: &Sites<'_>,
    inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<Flat, TriangulationError> {
    let added = auxiliary_places(sites.positions());
    let along = sites.curve();
    let extra = added.len() as u32;
    let mut positions = added;
    positions.extend(along.iter().map(|&i| sites.positions()[i as usize]));
    // Of any weight they are vertices, as corners of the hull.
    let mut weights = vec![0.0; extra as usize];
    weights.extend(along.iter().map(|&i| sites.weights()[i as usize]));
    let made = insert_all(&positions, &weights, inserted)?;
    let mut flat = Flat::default();
    for cell in made.cells().iter().filter(|cell| !cell.contains(&made.ghost())) {
        let mut rest: Vec<u32> =
            cell.iter().filter(|&&v| v >= extra).map(|&v| along[(v - extra) as usize]).collect();
        rest.sort_unstable();
        match (extra, &rest[..]) {
            (1, &[a, b, c]) => flat.triangles.push([a, b, c]),
            (2, &[a, b]) => flat.edges.push([a, b]),
            (3, &[a]) => flat.vertices.push([a]),
            // Not all of the points added are among its corners.
            _ => {}
        }
    }
    flat.triangles.sort_unstable();
    flat.edges.sort_unstable();
    Ok(flat)
}

/// Refuses sites that span no volume. O(n) for those, else mostly less.
///
/// # Errors
/// [`SitesError::Flat`].
pub fn check_span(sites: &Sites<'_>) -> Result<(), SitesError> {
    match spanning(sites.positions()).len() {
        4 => Ok(()),
        some => Err(SitesError::flat(sites.positions().len(), some as i32 - 1)),
    }
}

/// As many places as are needed to span what all of them span.
fn spanning(all: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut spanning = vec![all[0]];
    for &place in &all[1..] {
        if spanning.len() == 4 {
            break;
        }
        if is_independent(&spanning, place) {
            spanning.push(place);
        }
    }
    spanning
}

/// Whether a place is in no plane, on no line, at no point that others span. Exact.
fn is_independent(spanning: &[[f64; 3]], place: [f64; 3]) -> bool {
    let mut positions = spanning.to_vec();
    positions.push(place);
    let weights = vec![0.0; positions.len()];
    let predicates = Predicates::new(&positions, &weights);
    match positions.len() {
        2 => positions[0] != positions[1],
        3 => !predicates.collinear([0, 1, 2]),
        _ => predicates.orientation([0, 1, 2, 3]).is_ne(),
    }
}

/// Places beside others that span a volume with them: along the axes from the first, farther away than any
/// other, towards the origin. None if these span one.
pub fn auxiliary_places(all: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut spanning = spanning(all);
    let given = spanning.len();
    let largest = all.as_flattened().iter().fold(0f64, |most, x| most.max(x.abs()));
    // A power of two, so that a lattice stays one. Of points at the origin alone, any will do.
    let digits = largest.max(1e-150).log2().ceil() as i32;
    let far = if largest > 0.0 { 2f64.powi(digits + 1) } else { 1.0 };
    for axis in 0..3 {
        let mut place = spanning[0];
        place[axis] -= far.copysign(place[axis]);
        if spanning.len() < 4 && is_independent(&spanning, place) {
            spanning.push(place);
        }
    }
    spanning.split_off(given)
}

/// Whether an error says that points span no volume.
pub fn is_flat(error: &TriangulationError) -> bool {
    matches!(
        error,
        TriangulationError::Sites(SitesError::Flat { .. } | SitesError::TooFew { distinct: 1.. })
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(positions: &[[f64; 3]]) -> Flat {
        let weights = vec![0.0; positions.len()];
        let sites = Sites::any(positions, &weights).unwrap();
        triangulate_flat(&sites, |_| Ok(())).unwrap()
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
