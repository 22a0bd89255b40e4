//! In a shape alone: whether simplices of the shape are missing.
//!
//! A simplex can be missing only between points that the listed cells do not surround. For any missing simplex, one of the
//! following belongs to the shape and is not listed: a point; a pair of listed points; three points whose edges are listed; or
//! four points whose facets are listed. For each of these the smallest empty sphere decides. Theorem 3 in docs/certifying.md
//! proves that the search is complete, and that everything it finds is missing.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::sorted;

use super::cover::Polytope;
use super::emptiness::layers;
use super::finding::Finding;
use super::grid::Grid;
use super::spheres::{Corners, Spheres};
use super::structure::{Points, Structure};
use super::torus::Torus;
use crate::Alpha;
use crate::exact::radius_value;
use crate::flat::{Flat, flat_simplices};
use crate::index::{for_each_bucket, in_buckets, of_bucket};
use crate::parallel::of_each;

/// The reason why missing simplices were not searched for: too many pairs of points are so near each other that an edge may join
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Declined {
    /// The approximate number of pairs.
    pub pairs: u64,
    /// The maximum number of pairs for a search.
    pub most: u64,
    /// The α beyond which the search is declined for these simplices.
    pub alpha: Alpha,
}

/// More pairs of points than this are not searched: they would take an hour.
pub(super) const MOST_PAIRS: u64 = 1 << 32;
/// Number of points whose neighbours are counted.
const SAMPLE: usize = 1 << 10;

/// The data of the search.
pub(super) struct Search<'a> {
    pub structure: &'a Structure<'a>,
    pub spheres: Spheres<'a>,
    pub torus: Option<Torus>,
    /// The lowest dimension in which simplices count as missing.
    pub lowest: usize,
    /// More pairs of points than this are not searched.
    pub most_pairs: u64,
}

/// Points on an empty sphere whose hull is not covered by listed simplices, and corners that have this sphere.
type Found = (Vec<u32>, Corners);

impl Search<'_> {
    /// Findings about missing simplices, or the reason why they are not known.
    pub(super) fn findings(
        &self,
        kept: &[u32],
        monitor: &Monitor,
    ) -> Result<Result<Vec<Finding>, Declined>, Cancelled> {
        let mut found = BTreeMap::new();
        let points = self.points_alone(kept, &monitor.part(0, 2, 20))?;
        let mut open = self.open();
        for (_, corners) in &points {
            self.copies(corners.numbers()[..1].to_vec()).for_each(|v| open[v[0] as usize] = true);
        }
        let mut known = Known::new(self.structure, &open, &monitor.part(2, 3, 20))?;
        let pairs = match self.pairs(&known, &open, &monitor.part(3, 15, 20))? {
            Ok(pairs) => pairs,
            Err(declined) => return Ok(Err(declined)),
        };
        let triples = self.triples(&known, &open, &monitor.part(15, 20, 20))?;
        self.add(points.into_iter().chain(pairs), &mut known, &mut found);
        self.add(triples, &mut known, &mut found);
        // From here on, found simplices are treated as listed, so that the simplices they bound are found, too.
        let rest = monitor.unreported();
        let further = self.further_triples(&known, &rest)?;
        self.add(further, &mut known, &mut found);
        let further = self.further_quadruples(&known, &rest)?;
        self.add(further, &mut known, &mut found);
        Ok(Ok(self.told(&found)))
    }

    /// The number of points whose simplices are judged: on a torus, those of the box, which come first.
    fn judged(&self) -> usize {
        self.torus.map_or(self.spheres.points.len(), |torus| torus.points as usize)
    }

    /// A row and, on a torus, its copies.
    fn copies(&self, row: Vec<u32>) -> impl Iterator<Item = Vec<u32>> {
        match self.torus {
            Some(torus) => torus.copies(&row),
            None => vec![row],
        }
        .into_iter()
    }

    /// The points on the smallest empty sphere of some corners, and corners that have this sphere.
    fn polytope(&self, corners: Corners, near: &mut Vec<u32>) -> Option<Found> {
        let corners = self.spheres.smallest_empty(corners, near)?;
        Some((self.spheres.on(corners), corners))
    }

    fn is_covered(&self, on: &[u32]) -> bool {
        Polytope::new(self.spheres.points, on).is_covered(self.structure)
    }

    /// Like [`polytope`](Self::polytope); `None` also if the listed simplices cover the hull of the points.
    fn uncovered(&self, corners: Corners, near: &mut Vec<u32>) -> Option<Found> {
        self.polytope(corners, near).filter(|(on, _)| !self.is_covered(on))
    }

    /// Points of the shape that are not listed.
    fn points_alone(&self, kept: &[u32], monitor: &Monitor) -> Result<Vec<Found>, Cancelled> {
        let mut listed = vec![false; kept.len()];
        let vertices = self.structure.complex.vertices.rows();
        vertices.iter().for_each(|[v]| listed[*v as usize] = true);
        of_each(self.judged(), monitor, |i| {
            let is_unlisted = kept[i] == i as u32 && !listed[i];
            is_unlisted.then(|| self.uncovered([i as u32].into(), &mut Vec::new())).flatten()
        })
    }

    /// Marks the points that are listed and not surrounded by cells.
    fn open(&self) -> Vec<bool> {
        let surrounded = self.structure.surrounded(self.spheres.points.len());
        let mut open = vec![false; surrounded.len()];
        for &[v] in self.structure.complex.vertices.rows() {
            // The cells around copies are not all there.
            open[v as usize] = !surrounded[v as usize % self.judged()];
        }
        open
    }

    /// Edges of the shape that are not listed, or the simplices that they are faces of.
    fn pairs(
        &self,
        known: &Known,
        open: &[bool],
        monitor: &Monitor,
    ) -> Result<Result<Vec<Found>, Declined>, Cancelled> {
        let points = self.spheres.points;
        let numbers = (0..open.len() as u32).filter(|&v| open[v as usize]).collect();
        let layers: Vec<Layer> = (layers(points, numbers).into_iter())
            .map(|numbers| Layer::new(points, numbers))
            .collect();
        let pairs = Pairs { search: self, layers };
        if let Some(declined) = pairs.declined() {
            return Ok(Err(declined));
        }
        let mut rank = vec![0u8; open.len()];
        for (i, layer) in pairs.layers.iter().enumerate() {
            layer.grid.points().iter().for_each(|&v| rank[v as usize] = i as u8);
        }
        let firsts: Vec<u32> = (0..self.judged() as u32).filter(|&v| open[v as usize]).collect();
        let found = of_each(firsts.len(), monitor, |i| {
            let v = firsts[i];
            let listed = known.listed(v);
            // Points that may be inside, points with which this point is in a covered polytope, and the polytopes that are not
            // covered.
            let state = RefCell::new((listed.to_vec(), Vec::new(), Vec::new()));
            let own = rank[v as usize] as usize;
            for (rank, layer) in (own..).zip(&pairs.layers[own..]) {
                layer.grid.within(points.position(v), pairs.reach(v, layer), |q| {
                    // Of each pair in one layer, one point is the first.
                    let (is_first, pair) = (rank > own || q > v, [v, q].into());
                    if is_first && self.spheres.fits(pair) && listed.binary_search(&q).is_err() {
                        let (near, settled, found) = &mut *state.borrow_mut();
                        if !settled.contains(&q)
                            && let Some((on, corners)) = self.polytope(pair, near)
                        {
                            if self.is_covered(&on) {
                                settled.extend(on);
                            } else {
                                found.push((on, corners));
                            }
                        }
                    }
                    None::<()>
                });
            }
            state.into_inner().2
        })?;
        Ok(Ok(found))
    }

    /// Facets of the shape whose edges are listed and that are not listed, or the simplices that they are faces of.
    fn triples(
        &self,
        known: &Known,
        open: &[bool],
        monitor: &Monitor,
    ) -> Result<Vec<Found>, Cancelled> {
        of_each(self.judged(), monitor, |i| {
            let a = i as u32;
            let mut found = Vec::new();
            if !open[i] {
                return found;
            }
            let mut near = known.listed(a).to_vec();
            let is_open = |v: &&u32| open[**v as usize];
            let after = |v: u32, first: u32| {
                let listed = known.listed(v);
                &listed[listed.partition_point(|&other| other <= first)..]
            };
            let mut facets = self.structure.facets.with_smallest(a).map(sorted).peekable();
            for &b in after(a, a).iter().filter(is_open) {
                for c in common(after(a, b), after(b, b)).filter(|&c| open[c as usize]) {
                    let row = [a, b, c];
                    while facets.next_if(|facet| *facet < row).is_some() {}
                    if facets.peek() != Some(&row) {
                        found.extend(self.uncovered(row.into(), &mut near));
                    }
                }
            }
            found
        })
    }

    /// Unlisted facets of the shape that contain an edge that was found.
    fn further_triples(&self, known: &Known, monitor: &Monitor) -> Result<Vec<Found>, Cancelled> {
        let edges: Vec<[u32; 2]> = known.edges().collect();
        of_each(edges.len(), monitor, |i| {
            let [a, b] = edges[i];
            let (of_a, of_b) = (known.neighbours(a), known.neighbours(b));
            let rows = common(&of_a, &of_b).map(|c| sorted([a, b, c]));
            rows.filter(|row| self.is_judged(row[0]) && !known.has_facet(*row))
                .filter_map(|row| self.uncovered(row.into(), &mut known.listed(a).to_vec()))
                .collect::<Vec<_>>()
        })
    }

    /// Cells with a facet that was found.
    fn further_quadruples(
        &self,
        known: &Known,
        monitor: &Monitor,
    ) -> Result<Vec<Found>, Cancelled> {
        let facets: Vec<[u32; 3]> = known.facets.iter().copied().collect();
        of_each(facets.len(), monitor, |i| {
            let [a, b, c] = facets[i];
            let [of_a, of_b, of_c] = [a, b, c].map(|v| known.neighbours(v));
            let of_both: Vec<u32> = common(&of_a, &of_b).collect();
            let rows = common(&of_both, &of_c)
                .filter(|&d| {
                    [[a, b, d], [a, c, d], [b, c, d]]
                        .iter()
                        .all(|row| known.has_facet(sorted(*row)))
                })
                .map(|d| sorted([a, b, c, d]));
            rows.filter(|row| self.is_judged(row[0]) && !self.structure.cells.contains(*row))
                .filter_map(|row| self.uncovered(self.spheres.independent(row)?, &mut Vec::new()))
                .collect::<Vec<_>>()
        })
    }

    fn is_judged(&self, smallest: u32) -> bool {
        (smallest as usize) < self.judged()
    }

    /// Records the found polytopes, and simplices that cover them.
    fn add(
        &self,
        all: impl IntoIterator<Item = Found>,
        known: &mut Known,
        found: &mut BTreeMap<Vec<u32>, Corners>,
    ) {
        let points = self.spheres.points;
        for (on, corners) in all {
            let before = found.get(&on).copied();
            found.insert(on.clone(), before.map_or(corners, |before| before.min(corners)));
            if before.is_some() {
                continue;
            }
            let flat = match (&on[..], Polytope::new(points, &on).dimension()) {
                (&[a, b, c, d], 3) => Flat {
                    facets: vec![[a, b, c], [a, b, d], [a, c, d], [b, c, d]],
                    ..Flat::default()
                },
                (_, 3) => continue,
                _ => flat_simplices(points.sites, &on),
            };
            for row in flat.facets.iter().flat_map(|row| self.copies(row.to_vec())) {
                known.add_facet([row[0], row[1], row[2]]);
            }
            for row in flat.edges.iter().flat_map(|row| self.copies(row.to_vec())) {
                known.add_edge([row[0], row[1]]);
            }
        }
    }

    /// The findings: the found polytopes that are not faces of others.
    fn told(&self, found: &BTreeMap<Vec<u32>, Corners>) -> Vec<Finding> {
        let points = self.spheres.points;
        let mut at = BTreeMap::<u32, Vec<&Vec<u32>>>::new();
        for on in found.keys() {
            on.iter().for_each(|&v| at.entry(v).or_default().push(on));
        }
        let is_within = |on: &[u32], other: &[u32]| {
            other.len() > on.len() && on.iter().all(|v| other.binary_search(v).is_ok())
        };
        let is_told = |(on, _): &(&Vec<u32>, &Corners)| {
            Polytope::new(points, on).dimension() >= self.lowest
                && !at[&on[0]].iter().any(|other| is_within(on, other))
        };
        let finding = |(on, corners): (&Vec<u32>, &Corners)| match on[..] {
            [point] => {
                Finding::MissingVertex { point, radius_squared: radius_value([&points.get(point)]) }
            }
            _ => Finding::MissingSimplex {
                simplex: corners.simplex(),
                points: on.clone(),
                radius_squared: corners.radius_squared(points),
            },
        };
        found.iter().filter(is_told).map(finding).collect()
    }
}

/// The numbers that two ascending lists have in common.
fn common<'a>(mut one: &'a [u32], mut other: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
    std::iter::from_fn(move || {
        while let (&[a, ref after_a @ ..], &[b, ref after_b @ ..]) = (one, other) {
            if a <= b {
                one = after_a;
            }
            if b <= a {
                other = after_b;
            }
            if a == b {
                return Some(a);
            }
        }
        None
    })
}

/// Points of similar weight.
struct Layer {
    grid: Grid,
    heaviest: f64,
}

impl Layer {
    fn new(points: Points, numbers: Vec<u32>) -> Self {
        let weights = numbers.iter().map(|&v| points.weight(v));
        let heaviest = weights.fold(f64::NEG_INFINITY, f64::max);
        Self { grid: Grid::new(points, numbers), heaviest }
    }
}

/// Points that are not surrounded by cells, the lighter layers first.
struct Pairs<'a> {
    search: &'a Search<'a>,
    layers: Vec<Layer>,
}

impl Pairs<'_> {
    /// The maximum distance from a point to others of a layer with which it may have an edge.
    fn reach(&self, point: u32, layer: &Layer) -> f64 {
        let Spheres { points, alpha, .. } = self.search.spheres;
        self.reach_at(alpha.squared(), points.weight(point), layer)
    }

    fn reach_at(&self, alpha: f64, weight: f64, layer: &Layer) -> f64 {
        let reach = |weight: f64| (alpha + weight).next_up().max(0.0).sqrt().next_up();
        let largest = self.search.torus.map_or(f64::INFINITY, |torus| 2.0 * torus.largest_empty);
        (reach(weight) + reach(layer.heaviest)).next_up().min(largest)
    }

    /// The approximate number of pairs that are near enough to each other at some α; grows with it.
    fn count(&self, alpha: f64) -> u64 {
        let points = self.search.spheres.points;
        let mut count = 0.0;
        for (rank, layer) in self.layers.iter().enumerate() {
            let numbers = layer.grid.points();
            let step = numbers.len() / SAMPLE + 1;
            let near = |&v: &u32| {
                let of = |other: &Layer| {
                    let reach = self.reach_at(alpha, points.weight(v), other);
                    other.grid.count(points.position(v), reach)
                };
                let heavier = self.layers[rank + 1..].iter().map(of).sum::<usize>();
                // A pair within a layer is counted from both ends.
                (of(layer) - 1) as f64 / 2.0 + heavier as f64
            };
            count += numbers.iter().step_by(step).map(near).sum::<f64>() * step as f64;
        }
        count as u64
    }

    /// Whether there are too many.
    fn declined(&self) -> Option<Declined> {
        let pairs = self.count(self.search.spheres.alpha.squared());
        let most = self.search.most_pairs;
        (pairs > most).then(|| {
            let is_searched = |alpha: f64| self.count(alpha) <= most;
            let alpha = Alpha::from_squared(last(is_searched)).expect("never NaN");
            Declined { pairs, most, alpha }
        })
    }
}

/// The last double in their order that satisfies a condition, which also holds for all doubles before it.
fn last(is_true: impl Fn(f64) -> bool) -> f64 {
    let double = |key: i64| f64::from_bits((key ^ ((key >> 63) as u64 >> 1) as i64) as u64);
    let key = |x: f64| {
        let bits = x.to_bits() as i64;
        bits ^ ((bits >> 63) as u64 >> 1) as i64
    };
    let (mut below, mut above) = (key(f64::NEG_INFINITY), key(f64::INFINITY));
    while below + 1 < above {
        let middle = below.midpoint(above);
        if is_true(double(middle)) {
            below = middle;
        } else {
            above = middle;
        }
    }
    double(below)
}

/// Edges and facets that are listed, and those that were found.
struct Known<'a> {
    structure: &'a Structure<'a>,
    /// The start of the listed neighbours of each open point.
    starts: Vec<u32>,
    listed: Vec<u32>,
    added: BTreeMap<u32, BTreeSet<u32>>,
    facets: BTreeSet<[u32; 3]>,
}

impl<'a> Known<'a> {
    fn new(
        structure: &'a Structure<'a>,
        open: &[bool],
        monitor: &Monitor,
    ) -> Result<Self, Cancelled> {
        let edges = structure.complex.edges.rows();
        let ends = || edges.iter().flat_map(|&[a, b]| [(a, b), (b, a)]);
        let entries = || ends().filter(|&(v, _)| open[v as usize]);
        let (starts, mut listed) = in_buckets(open.len(), rayon::current_num_threads(), &entries);
        monitor.report(1, 2)?;
        for_each_bucket(&mut listed, &starts, &|bucket| bucket.sort_unstable());
        Ok(Self { structure, starts, listed, added: BTreeMap::new(), facets: BTreeSet::new() })
    }

    /// The points that have a listed edge with an open one, ascending.
    fn listed(&self, v: u32) -> &[u32] {
        &self.listed[of_bucket(&self.starts, v)]
    }

    /// All neighbours, including those that share an edge that was found.
    fn neighbours(&self, v: u32) -> Vec<u32> {
        let added = self.added.get(&v).into_iter().flatten();
        let mut all: Vec<u32> = self.listed(v).iter().chain(added).copied().collect();
        all.sort_unstable();
        all
    }

    /// The edges that were found.
    fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let ends = self.added.iter().flat_map(|(&a, others)| others.iter().map(move |&b| [a, b]));
        ends.filter(|[a, b]| a < b)
    }

    fn has_facet(&self, row: [u32; 3]) -> bool {
        self.facets.contains(&row) || self.structure.facets.contains(row)
    }

    fn add_edge(&mut self, [a, b]: [u32; 2]) {
        if !self.structure.edges.contains([a, b]) {
            self.added.entry(a).or_default().insert(b);
            self.added.entry(b).or_default().insert(a);
        }
    }

    fn add_facet(&mut self, row: [u32; 3]) {
        let [a, b, c] = sorted(row);
        if !self.structure.facets.contains([a, b, c]) {
            self.facets.insert([a, b, c]);
        }
        [[a, b], [a, c], [b, c]].into_iter().for_each(|edge| self.add_edge(edge));
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::certify::emptiness::Emptiness;
    use crate::exact::WeightedPoint;
    use crate::{Class, Complex};

    #[test]
    fn doubles_are_in_order() {
        assert_eq!(last(|x| x <= 2.5), 2.5);
        assert_eq!(last(|x| x < 0.0), 0f64.next_down());
        assert_eq!(last(|x| x < -7.0), (-7f64).next_down());
        assert_eq!(last(|_| true), f64::MAX);
        assert_eq!(last(|_| false), f64::NEG_INFINITY);
    }

    /// The search is declined beyond one α, and up to it everything is found.
    #[test]
    fn a_search_is_declined_beyond_the_alpha_that_is_named() {
        let mut random = Random::new(25);
        let mut draw = |weights: &[f64]| WeightedPoint {
            position: [0; 3].map(|_| random.whole(0, 99)),
            weight: random.pick(weights),
        };
        let sites: Vec<WeightedPoint> = (0..142).map(|_| draw(&[0.0, 3.0])).collect();
        let points = Points { sites: &sites };
        let vertices = (0..142).map(|v| ([v], Class::Singular)).collect();
        let complex = Complex { vertices, ..Complex::default() };
        let noop = Monitor::noop();
        let (structure, _) = Structure::new(&complex, points, &noop).unwrap();
        let kept: Vec<u32> = (0..142).collect();
        let search = |alpha: f64, most_pairs: u64| {
            let alpha = Alpha::from_squared(alpha).unwrap();
            let emptiness = Emptiness::new(points, alpha, f64::INFINITY, kept.clone());
            let spheres = Spheres { points, alpha, emptiness: &emptiness };
            let search =
                Search { structure: &structure, spheres, torus: None, lowest: 0, most_pairs };
            search.findings(&kept, &noop).unwrap()
        };
        let mut alphas = Vec::new();
        for most in [1000, 4000] {
            let declined = search(1e9, most).unwrap_err();
            assert!(declined.pairs > most && declined.most == most, "{declined:?}");
            let alpha = declined.alpha.squared();
            assert!(!search(alpha, most).expect("not declined").is_empty(), "{declined:?}");
            assert_eq!(search(alpha.next_up(), most).unwrap_err().alpha, declined.alpha);
            alphas.push(alpha);
        }
        assert!(alphas[0] < alphas[1] && alphas[1] < 1e4, "{alphas:?}");
    }
}
