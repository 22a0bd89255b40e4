use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use walpha_base::advice::{Advise, wrapped};
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use crate::exact::{Side, WeightedPoint, in_conflict, orientation, radius, side};
use crate::flat::{Flat, flat_simplices};
use crate::{Alpha, Class, Complex};

/// The result of the definition for a set of weighted points.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Enumeration {
    /// The whole triangulation with its classes, in canonical order.
    pub complex: Complex,
    /// Points that are not vertices although no other point is kept at their position, ascending.
    pub hidden: Vec<u32>,
    /// Pairs (removed, kept) of points at one position, ascending: the heaviest is kept, of equal
    /// weights the first.
    pub duplicates: Vec<[u32; 2]>,
}

/// Why points have no regular triangulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnumerateError {
    /// The numbers of positions and weights differ.
    #[error("{positions} positions but {weights} weights: each point needs one weight")]
    Lengths {
        /// Positions given.
        positions: usize,
        /// Weights given.
        weights: usize,
    },
    /// A coordinate or weight is NaN or infinite.
    #[error("point {0} has a coordinate or weight that is not finite; remove such points")]
    NotFinite(usize),
    /// No points.
    #[error("there are no points: give at least one")]
    Empty,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Advise for EnumerateError {
    wrapped!(Cancelled);
}

/// Computes the regular triangulation of weighted points, its hidden points and the α-complex in it, directly from the
/// definition.
///
/// A cell is every positively oriented quadruple with no other point inside its orthogonal
/// sphere. Ties are decided by a symbolic perturbation (Devillers & Teillaud,
/// doi:10.1016/j.comgeo.2010.09.010): each lifted height |p|² − ω is raised by an infinitesimal, by
/// infinitely more for the later of two points in (x, y, z) order. A simplex of the triangulation
/// is in the α-complex when its smallest orthogonal sphere has squared radius ≤ α and no point
/// strictly inside, not even a hidden one, or when it is a face of one that is. Points in one plane
/// or on one line have the triangulation that they have there, without cells.
///
/// O(n⁴) quadruples, each with an early exit: 60 points take seconds, 200 take minutes.
///
/// # Errors
/// [`EnumerateError`]: coordinates or weights that are not finite, no points at all.
pub fn enumerate(
    positions: &[[f64; 3]],
    weights: &[f64],
    alpha: Alpha,
) -> Result<Enumeration, EnumerateError> {
    let monitor = &*Monitor::current();
    if positions.len() != weights.len() {
        return Err(EnumerateError::Lengths { positions: positions.len(), weights: weights.len() });
    }
    let finite = |i: &usize| positions[*i].iter().chain([&weights[*i]]).all(|x| x.is_finite());
    if let Some(index) = (0..positions.len()).find(|i| !finite(i)) {
        return Err(EnumerateError::NotFinite(index));
    }
    let points: Vec<_> = positions
        .iter()
        .zip(weights)
        .map(|(&position, &weight)| WeightedPoint { position, weight })
        .collect();
    let (sites, duplicates) = heaviest_at_each_position(&points);
    if sites.is_empty() {
        return Err(EnumerateError::Empty);
    }
    let cells = regular_cells(&points, &sites, monitor)?;
    let flat = if cells.is_empty() { flat_simplices(&points, &sites) } else { Flat::default() };
    let complex = Definition { points: &points, sites: &sites, alpha }.classify(&cells, flat);
    let is_vertex = |i: &u32| complex.vertices.rows().binary_search(&[*i]).is_ok();
    let hidden = sites.iter().copied().filter(|i| !is_vertex(i)).collect();
    Ok(Enumeration { complex, hidden, duplicates })
}

/// Points that are kept, and pairs (removed, kept), both ascending.
fn heaviest_at_each_position(points: &[WeightedPoint]) -> (Vec<u32>, Vec<[u32; 2]>) {
    // −0 and 0 are one position.
    let position = |p: &WeightedPoint| p.position.map(|x| (x + 0.0).to_bits());
    let mut best: HashMap<[u64; 3], usize> = HashMap::new();
    for (i, p) in points.iter().enumerate() {
        let kept = best.entry(position(p)).or_insert(i);
        if p.weight > points[*kept].weight {
            *kept = i;
        }
    }
    let kept: Vec<usize> = points.iter().map(|p| best[&position(p)]).collect();
    let sites = (0..points.len()).filter(|&i| kept[i] == i).map(|i| i as u32).collect();
    let duplicates =
        (0..points.len()).filter(|&i| kept[i] != i).map(|i| [i as u32, kept[i] as u32]).collect();
    (sites, duplicates)
}

/// All positively oriented quadruples that are not refuted by another site.
fn regular_cells(
    points: &[WeightedPoint],
    sites: &[u32],
    monitor: &Monitor,
) -> Result<Vec<[u32; 4]>, Cancelled> {
    let point = |i: u32| &points[i as usize];
    let judge = |[a, b, c, d]: [u32; 4]| -> Option<[u32; 4]> {
        let position = |i: u32| point(i).position;
        let cell = match orientation(position(a), position(b), position(c), position(d)) {
            Ordering::Greater => [a, b, c, d],
            Ordering::Less => [a, b, d, c],
            Ordering::Equal => return None,
        };
        let corners = cell.map(point);
        let refuted = sites.iter().any(|q| !cell.contains(q) && in_conflict(corners, point(*q)));
        (!refuted).then_some(cell)
    };
    let n = sites.len();
    let pairs = |count: usize| (count * count.saturating_sub(1) / 2) as u64;
    // Quadruples by the first two of them.
    let quadruples = monitor.units((0..n).map(|j| j as u64 * pairs(n - 1 - j)).sum());
    let cells_from = |i: usize| -> Result<Vec<[u32; 4]>, Cancelled> {
        let mut cells = Vec::new();
        for j in i + 1..n {
            let others = (j + 1..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
            cells.extend(others.filter_map(|(k, l)| judge([i, j, k, l].map(|s| sites[s]))));
            quadruples.add(pairs(n - 1 - j))?;
        }
        Ok(cells)
    };
    let cells: Vec<_> = (0..n).into_par_iter().map(cells_from).collect::<Result<_, Cancelled>>()?;
    Ok(cells.concat())
}

/// The definition of the α-complex over given points.
struct Definition<'a> {
    points: &'a [WeightedPoint],
    sites: &'a [u32],
    alpha: Alpha,
}

/// The information about a simplex below cells that its star gives.
#[derive(Default)]
struct Star {
    /// Some incident cell is in the shape.
    touches_inside: bool,
    /// Some incident cell is outside, or the simplex is on the hull.
    touches_outside: bool,
    /// It is a face of a higher simplex of the shape.
    covered: bool,
}

impl Star {
    fn join(&mut self, other: &Self) {
        self.touches_inside |= other.touches_inside;
        self.touches_outside |= other.touches_outside;
        self.covered |= other.covered;
    }
}

impl Definition<'_> {
    fn classify(&self, cells: &[[u32; 4]], flat: Flat) -> Complex {
        let inside = |&cell: &[u32; 4]| self.radius_at_most_alpha(cell);
        let cells: Vec<([u32; 4], bool)> =
            cells.par_iter().map(|cell| (*cell, inside(cell))).collect();
        let mut on_facet: BTreeMap<[u32; 3], Vec<([u32; 3], bool)>> = BTreeMap::new();
        for &(cell, inside) in &cells {
            for facet in outward_facets(cell) {
                on_facet.entry(sorted(facet)).or_default().push((facet, inside));
            }
        }
        on_facet.extend(flat.facets.into_iter().map(|facet| (facet, Vec::new())));
        let mut facets = BTreeMap::<_, Star>::new();
        let mut edges = BTreeMap::<_, Star>::new();
        let mut vertices = BTreeMap::<_, Star>::new();
        for (&facet, sides) in &on_facet {
            let star = Star {
                touches_inside: sides.iter().any(|s| s.1),
                touches_outside: sides.len() < 2 || sides.iter().any(|s| !s.1),
                covered: sides.iter().any(|s| s.1),
            };
            let faces = [[0, 1], [0, 2], [1, 2]].map(|e: [usize; 2]| e.map(|k| facet[k]));
            faces.iter().for_each(|&edge| edges.entry(edge).or_default().join(&star));
            facet.iter().for_each(|&v| vertices.entry([v]).or_default().join(&star));
            facets.insert(facet, star);
        }
        for edge in flat.edges {
            edge.iter().for_each(|&v| _ = vertices.entry([v]).or_default());
            edges.entry(edge).or_default();
        }
        flat.vertices.into_iter().for_each(|vertex| _ = vertices.entry(vertex).or_default());
        let mut complex = Complex::default();
        for &(cell, inside) in &cells {
            let class = if inside { Class::Interior } else { Class::Exterior };
            complex.cells.push(smallest_even(cell), class);
        }
        let facet_classes = self.classes(&facets);
        for (facet, class) in facet_classes {
            if class != Class::Exterior {
                for edge in [[0, 1], [0, 2], [1, 2]] {
                    edges.get_mut(&edge.map(|k: usize| facet[k])).expect("a face").covered = true;
                }
            }
            let regular = on_facet[&facet].iter().find(|s| s.1 && class == Class::Regular);
            complex.facets.push(regular.map_or(facet, |s| smallest_even(s.0)), class);
        }
        for (edge, class) in self.classes(&edges) {
            if class != Class::Exterior {
                for v in edge {
                    vertices.get_mut(&[v]).expect("a face").covered = true;
                }
            }
            complex.edges.push(edge, class);
        }
        for (vertex, class) in self.classes(&vertices) {
            complex.vertices.push(vertex, class);
        }
        sort(&mut complex);
        complex
    }

    fn classes<const N: usize>(&self, stars: &BTreeMap<[u32; N], Star>) -> Vec<([u32; N], Class)> {
        let class = |simplex: [u32; N], star: &Star| {
            if star.touches_inside && !star.touches_outside {
                Class::Interior
            } else if star.covered {
                Class::Regular
            } else if self.radius_at_most_alpha(simplex) && self.is_empty(simplex) {
                Class::Singular
            } else {
                Class::Exterior
            }
        };
        let stars: Vec<_> = stars.iter().collect();
        stars.into_par_iter().map(|(&simplex, star)| (simplex, class(simplex, star))).collect()
    }

    fn radius_at_most_alpha<const N: usize>(&self, simplex: [u32; N]) -> bool {
        radius(simplex.map(|i| &self.points[i as usize]), self.alpha).is_le()
    }

    /// Whether no point, including hidden ones, is strictly inside the smallest orthogonal sphere. Duplicates are no heavier than
    /// the point kept at their position, so they are never the only ones in it.
    fn is_empty<const N: usize>(&self, simplex: [u32; N]) -> bool {
        let corners = simplex.map(|i| &self.points[i as usize]);
        let others = self.sites.iter().filter(|q| !simplex.contains(q));
        others.map(|&q| &self.points[q as usize]).all(|q| side(corners, q) != Side::Inside)
    }
}
