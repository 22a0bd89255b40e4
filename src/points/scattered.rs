use walpha_regular::{Sites, Triangulation, TriangulationError, triangulate};

use super::{Points, PointsError};

/// The difference L of each scattered point: the mean of |F(point) − F(neighbour)| over its
/// neighbours in the Delaunay triangulation of the places.
///
/// Of several points at one place the first is in the triangulation; each differs from the
/// neighbours of that place by its own value. On a regular grid, where neighbours on one sphere are
/// many, the symbolic perturbation chooses among them. Sums in f64 in ascending order of the
/// neighbours. The time and memory of a
/// triangulation.
///
/// # Errors
/// Points without values, and what [`Sites`] refuses: numbers that are not finite, fewer than four
/// places, or places in one plane.
pub fn scattered_difference(points: &Points) -> Result<Vec<f64>, PointsError> {
    let values = points.values.as_deref().ok_or(PointsError::NoValues)?;
    let unweighted = vec![0.0; points.len()];
    let sites = Sites::new(&points.positions, &unweighted).map_err(TriangulationError::from)?;
    let neighbours = Neighbours::of(&triangulate(&sites)?);

    let mut place: Vec<u32> = vec![0; points.len()];
    for (site, &point) in sites.input().iter().enumerate() {
        place[point as usize] = site as u32;
    }
    for &[went, stayed] in sites.duplicates() {
        place[went as usize] = place[stayed as usize];
    }
    let difference = |(&value, &site): (&f64, &u32)| {
        let around = neighbours.around(site);
        let from = |&other: &u32| (value - values[sites.input()[other as usize] as usize]).abs();
        around.iter().map(from).sum::<f64>() / around.len() as f64
    };
    Ok(values.iter().zip(&place).map(difference).collect())
}

/// The neighbours of each site, ascending, in one row.
struct Neighbours {
    ends: Vec<usize>,
    sites: Vec<u32>,
}

impl Neighbours {
    fn of(delaunay: &Triangulation) -> Self {
        let ghost = delaunay.ghost();
        let beside = |cell: &[u32; 4]| {
            let [a, b, c, d] = *cell;
            [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]
        };
        let edges = delaunay.cells().iter().flat_map(beside).filter(|edge| !edge.contains(&ghost));
        let mut pairs: Vec<[u32; 2]> = edges.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut ends = vec![0; ghost as usize];
        for (i, &[site, _]) in pairs.iter().enumerate() {
            ends[site as usize] = i + 1;
        }
        Self { ends, sites: pairs.into_iter().map(|[_, neighbour]| neighbour).collect() }
    }

    /// Every site of an unweighted triangulation is a vertex, and has neighbours.
    fn around(&self, site: u32) -> &[u32] {
        let site = site as usize;
        let start = if site == 0 { 0 } else { self.ends[site - 1] };
        &self.sites[start..self.ends[site]]
    }
}
