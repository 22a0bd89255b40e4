//! Representative cycles of persistence pairs.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap, HashMap, HashSet};
use std::sync::OnceLock;

use walpha_base::Monitor;
use walpha_base::vector::{length, sub};

use super::Ordered;
use super::loops::{PRIME, Reduced, plus_mod};
use crate::ShapeError;
use crate::copies::Copied;
use crate::ladder::build::Incidence;
use crate::winding::{minus, plus};

/// Finds representative cycles. What several cycles need is computed once.
#[derive(Debug)]
pub struct Cycles<'a> {
    ordered: &'a Ordered<'a>,
    graph: OnceLock<Graph>,
    forest: OnceLock<Forest>,
    reduced: OnceLock<Reduced>,
    parts: OnceLock<Parts>,
}

/// A loop, represented by cycles of edges.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LoopCycle {
    /// The vertices along a short closed walk, by input index, without the return to the first: it begins along the edge that creates the loop, and returns
    /// on a shortest path through edges that are there before. So it is born with that edge. It is of the class of `chain`, up to classes
    /// that are older; these need not end with it.
    pub walk: Vec<u32>,
    /// The positions of these vertices, and that of the first at the end. On a torus the walk is laid out in space. A loop that never ends winds round, and
    /// ends at another copy of its first vertex. Others return to the first, but for the few whose `chain` has several parts that wind round against
    /// each other, of which the walk is one, and those that are not found within two boxes or a million copies of vertices.
    pub path: Vec<[f64; 3]>,
    /// The edges of the cycle that bounds from the end of the pair on, and not before, by number, each with its coefficient in the direction of
    /// its row. Coefficients are those modulo 2³¹ − 1 that are nearest to 0; with few exceptions they are 1 and −1. For a loop that never ends it is
    /// the walk.
    pub chain: Vec<(u32, i32)>,
}

/// A void at its birth, represented by its boundary.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct VoidCycle {
    /// The cells that fill the void, by number, ascending. The last to enter is the end of the pair.
    pub cells: Vec<u32>,
    /// The facets of its boundary, by input index, counter-clockwise seen from outside the void.
    pub facets: Vec<[u32; 3]>,
    /// The positions of their corners. On a torus the void is laid out in space.
    pub corners: Vec<[[f64; 3]; 3]>,
}

/// The edges at each vertex, by row.
#[derive(Debug)]
struct Graph {
    /// The other end and the row of each edge, grouped by vertex.
    edges: Vec<[u32; 2]>,
    starts: Vec<usize>,
    /// The place of each edge in the order.
    places: Vec<u32>,
}

/// The edges that end components. They are the minimum spanning forest: on the way between the ends of any other edge, all come before it.
#[derive(Debug)]
struct Forest {
    /// For each vertex the edge to its parent, or `NONE`, …
    up: Vec<u32>,
    /// … and the number of edges to the root.
    depths: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// The cells of each void at its birth.
#[derive(Debug)]
struct Parts {
    /// The next cell of each, by row. Those of a void at its birth follow the cell that ends it.
    next: Vec<u32>,
    /// How many these are.
    sizes: Vec<u32>,
    /// The number of the cell of each row.
    numbers: Vec<u32>,
}

impl Ordered<'_> {
    /// Finds representative cycles of persistence pairs.
    pub fn cycles(&self) -> Cycles<'_> {
        Cycles {
            ordered: self,
            graph: OnceLock::new(),
            forest: OnceLock::new(),
            reduced: OnceLock::new(),
            parts: OnceLock::new(),
        }
    }
}

impl Cycles<'_> {
    /// A loop at its birth, by the number of the edge that creates it; `None` if none begins with that simplex. The first call takes the time of
    /// [`Ordered::loops`]; then a shortest path is searched for.
    ///
    /// # Errors
    /// Out of memory.
    pub fn of_loop(&self, edge: u32) -> Result<Option<LoopCycle>, ShapeError> {
        if !self.begins_loop(edge) {
            return Ok(None);
        }
        let reduced = self.reduced()?;
        let steps = self.shortest(edge);
        let (walk, path) = self.laid_out(&steps);
        let chain = if let Some(column) = reduced.column(edge) {
            self.closed(column)
        } else {
            let sign = |&(step, forward): &(u32, bool)| (step, if forward { 1 } else { -1 });
            let mut chain: Vec<(u32, i32)> = steps.iter().map(sign).collect();
            chain.sort_unstable();
            chain
        };
        Ok(Some(LoopCycle { walk, path, chain }))
    }

    /// The [path](LoopCycle::path) of a loop alone, which needs no reduction: the first call takes O(n log n).
    pub fn path_of_loop(&self, edge: u32) -> Option<Vec<[f64; 3]>> {
        self.begins_loop(edge).then(|| self.laid_out(&self.shortest(edge)).1)
    }

    /// Whether a simplex is an edge that creates a loop.
    fn begins_loop(&self, edge: u32) -> bool {
        let [_, edges, facets, _] = self.ordered.numbers.first;
        (edges..facets).contains(&edge) && !self.forest().is_in(self.ordered, edge)
    }

    /// The vertices of a walk, without the return to the first, and their positions with it.
    fn laid_out(&self, steps: &[(u32, bool)]) -> (Vec<u32>, Vec<[f64; 3]>) {
        let ordered = self.ordered;
        let edges = ordered.numbers.first[1];
        let whole = ordered.filtration().whole();
        let torus = ordered.filtration().torus();
        let place = |(v, shift): Copied| {
            let place = whole.points().positions()[v as usize];
            torus.map_or(place, |torus| torus.moved(place, shift))
        };
        let (mut walk, mut path) = (Vec::with_capacity(steps.len()), Vec::new());
        let mut so_far = [0; 3];
        for &(step, forward) in steps {
            let [(a, _), (b, shift)] = whole.shifted(ordered.edges()[(step - edges) as usize]);
            let (from, to, way) =
                if forward { (a, b, shift) } else { (b, a, minus([0; 3], shift)) };
            if path.is_empty() {
                path.push(place((from, so_far)));
            }
            so_far = plus(so_far, way);
            walk.push(from);
            path.push(place((to, so_far)));
        }
        (walk, path)
    }

    /// A void at its birth, by the number of the cell that ends it; `None` if none ends with that simplex. The first call takes O(n α(n)), each the
    /// number of the void's cells.
    pub fn of_void(&self, cell: u32) -> Option<VoidCycle> {
        let ordered = self.ordered;
        let cells = ordered.numbers.first[3];
        let first = *ordered.cell_rows.get(cell.checked_sub(cells)? as usize)?;
        let Parts { next, sizes, numbers } = self.parts.get_or_init(|| Parts::of(ordered));
        let size = Some(sizes[first as usize]).filter(|&size| size > 0)?;
        let mut rows = Vec::with_capacity(size as usize);
        let mut at = first;
        for _ in 0..size {
            rows.push(at);
            at = next[at as usize];
        }
        let (facets, corners) = self.boundary(&rows);
        let mut cells: Vec<u32> = rows.iter().map(|&row| numbers[row as usize]).collect();
        cells.sort_unstable();
        Some(VoidCycle { cells, facets, corners })
    }

    /// The facets of some connected cells, by row, that have only one of these beside them.
    fn boundary(&self, rows: &[u32]) -> (Vec<[u32; 3]>, Vec<[[f64; 3]; 3]>) {
        let filtration = self.ordered.filtration();
        let (whole, incidence) = (filtration.whole(), &filtration.incidence);
        let torus = filtration.torus();
        let mut shifts: HashMap<u32, [i32; 3]> = rows.iter().map(|&row| (row, [0; 3])).collect();
        if let Some(torus) = torus {
            // Each cell where it is connected with those before.
            let (mut placed, mut left) = (HashSet::from([rows[0]]), vec![rows[0]]);
            while let Some(cell) = left.pop() {
                for facet in incidence.cell_facets[cell as usize] {
                    let sides = incidence.facet_cells[facet as usize];
                    let other = if sides[0] == cell { sides[1] } else { sides[0] };
                    if shifts.contains_key(&other) && placed.insert(other) {
                        let way = filtration.way_across(torus, facet as usize);
                        let shift = shifts[&cell];
                        let there =
                            if sides[0] == cell { plus(shift, way) } else { minus(shift, way) };
                        shifts.insert(other, there);
                        left.push(other);
                    }
                }
            }
        }
        let (mut facets, mut corners) = (Vec::new(), Vec::new());
        for &row in rows {
            let cell = whole.complex().cells.rows()[row as usize];
            let places = whole.corners(cell);
            for (opposite, facet) in incidence.cell_facets[row as usize].into_iter().enumerate() {
                let sides = incidence.facet_cells[facet as usize];
                let other = if sides[0] == row { sides[1] } else { sides[0] };
                if other != Incidence::OUTSIDE && shifts.contains_key(&other) {
                    continue;
                }
                let order = Incidence::outward(opposite);
                facets.push(order.map(|k| whole.copied(cell[k]).0));
                let shift = shifts[&row];
                let place =
                    |k: usize| torus.map_or(places[k], |torus| torus.moved(places[k], shift));
                corners.push(order.map(place));
            }
        }
        (facets, corners)
    }

    fn reduced(&self) -> Result<&Reduced, ShapeError> {
        let monitor = &*Monitor::current();
        if let Some(reduced) = self.reduced.get() {
            return Ok(reduced);
        }
        let (_, reduced) = self.ordered.reduce(monitor)?;
        Ok(self.reduced.get_or_init(|| reduced))
    }

    fn graph(&self) -> &Graph {
        self.graph.get_or_init(|| Graph::of(self.ordered))
    }

    fn forest(&self) -> &Forest {
        self.forest.get_or_init(|| Forest::of(self.ordered, self.graph()))
    }

    /// The edges of a shortest closed walk along an edge through edges that come before it, each with whether it is walked in the direction of its row.
    /// On a torus the walk that ends where it began, if there is one. Others wind round.
    fn shortest(&self, edge: u32) -> Vec<(u32, bool)> {
        let closed = match self.ordered.filtration().torus() {
            None => None,
            Some(_) => self.way_back(edge, true),
        };
        closed.or_else(|| self.way_back(edge, false)).expect("both ends are in one component")
    }

    /// Like [`shortest`](Self::shortest), on a torus only through places that are a few boxes away at most where copies of a vertex `differ`;
    /// `None` if there is no such walk.
    fn way_back(&self, edge: u32, differ: bool) -> Option<Vec<(u32, bool)>> {
        let ordered = self.ordered;
        let of_edges = ordered.numbers.first[1];
        let whole = ordered.filtration().whole();
        let torus = ordered.filtration().torus();
        let vertex_rows = &ordered.filtration().incidence.vertex_rows;
        let graph = self.graph();
        // The ends of an edge by row, and by how many boxes the second is away from the first.
        let ends = |row: u32| {
            let row = ordered.edges()[row as usize];
            let [a, b] = row.map(|v| vertex_rows[v as usize]);
            let shift = if differ { whole.shifted(row)[1].1 } else { [0; 3] };
            (a, b, shift)
        };
        let last = graph.places[(edge - of_edges) as usize];
        let place = |(vertex, shift): Copied| {
            let [v] = ordered.vertices()[vertex as usize];
            let place = whole.points().positions()[v as usize];
            torus.map_or(place, |torus| torus.moved(place, shift))
        };
        let (target, start, shift) = ends(edge - of_edges);
        let (target, start) = ((target, [0; 3]), (start, shift));
        // No way is shorter than the straight one; on a torus another copy may be nearer.
        let straight = |at: Copied| match torus {
            Some(_) if !differ => 0.0,
            _ => length(sub(place(at), place(target))),
        };
        let mut best: HashMap<Copied, (f64, u32, bool)> =
            HashMap::from([(start, (0.0, NONE, true))]);
        let mut done = HashSet::new();
        let mut heap = BinaryHeap::from([Reached { bound: straight(start), at: start }]);
        while let Some(Reached { at, .. }) = heap.pop() {
            if at == target {
                break;
            }
            if !done.insert(at) {
                continue;
            }
            if differ && done.len() > MOST_COPIES {
                return None;
            }
            let (vertex, so_far) = (at.0, best[&at].0);
            for &[other, by] in graph.at(vertex) {
                if graph.places[by as usize] >= last {
                    continue;
                }
                let (a, b, shift) = ends(by);
                let [from, to] = whole.corners(ordered.edges()[by as usize]);
                let distance = so_far + length(sub(to, from));
                for forward in [true, false] {
                    if [a, b] != if forward { [vertex, other] } else { [other, vertex] } {
                        continue;
                    }
                    let shift = if forward { plus(at.1, shift) } else { minus(at.1, shift) };
                    let next = (other, shift);
                    if shift.iter().any(|boxes| boxes.abs() > FURTHEST) || done.contains(&next) {
                        continue;
                    }
                    if best.get(&next).is_none_or(|&(known, ..)| distance < known) {
                        best.insert(next, (distance, by, forward));
                        heap.push(Reached { bound: distance + straight(next), at: next });
                    }
                }
            }
        }
        // From the target back to the start, so along the path against the search.
        let mut back = Vec::new();
        let mut at = target;
        while at != start {
            let &(_, by, forward) = best.get(&at)?;
            back.push((of_edges + by, forward));
            let (a, b, shift) = ends(by);
            at = if forward { (a, minus(at.1, shift)) } else { (b, plus(at.1, shift)) };
        }
        back.push((edge, true));
        back.reverse();
        Some(back)
    }

    /// The cycle with these coefficients of edges outside the forest: those of the forest follow.
    fn closed(&self, column: Vec<(u32, u32)>) -> Vec<(u32, i32)> {
        let ordered = self.ordered;
        let of_edges = ordered.numbers.first[1];
        let vertex_rows = &ordered.filtration().incidence.vertex_rows;
        let Forest { up, depths } = self.forest();
        let ends = |edge: u32| ordered.edges()[edge as usize].map(|v| vertex_rows[v as usize]);
        // What the edges so far leave at each vertex, deepest first.
        let mut left = BTreeMap::<(u32, u32), u32>::new();
        let mut leave = |vertex: u32, amount: u32| {
            let at = left.entry((depths[vertex as usize], vertex)).or_default();
            *at = plus_mod(*at, amount);
        };
        for &(edge, value) in &column {
            let [a, b] = ends(edge - of_edges);
            leave(a, PRIME - value);
            leave(b, value);
        }
        let mut chain = column;
        while let Some(((_, vertex), amount)) = left.pop_last() {
            if amount == 0 {
                continue;
            }
            let by = up[vertex as usize];
            let [a, b] = ends(by);
            let (parent, value) = if b == vertex { (a, PRIME - amount) } else { (b, amount) };
            chain.push((of_edges + by, value));
            let at = left.entry((depths[parent as usize], parent)).or_default();
            *at = plus_mod(*at, amount);
        }
        chain.sort_unstable();
        let signed = |(edge, value): (u32, u32)| {
            (edge, if value > PRIME / 2 { value as i32 - PRIME as i32 } else { value as i32 })
        };
        chain.into_iter().map(signed).collect()
    }
}

/// By how many boxes the copies of vertices on a walk are moved at most, along each vector.
const FURTHEST: i32 = 2;
/// The most copies that are searched for a walk that ends where it began: of the loops that never end, none has one.
const MOST_COPIES: usize = 1 << 20;

/// A vertex that was reached, on a torus with the shift of its copy, by the least length of a way through it.
struct Reached {
    bound: f64,
    at: Copied,
}

impl Ord for Reached {
    /// The nearest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.at.cmp(&self.at))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Reached {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Reached {}

impl Graph {
    fn of(ordered: &Ordered<'_>) -> Self {
        let vertex_rows = &ordered.filtration().incidence.vertex_rows;
        let ends = |edge: &[u32; 2]| edge.map(|v| vertex_rows[v as usize]);
        let mut starts = vec![0; ordered.vertices().len() + 1];
        for edge in ordered.edges() {
            ends(edge).iter().for_each(|&v| starts[v as usize + 1] += 1);
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut edges = vec![[0; 2]; 2 * ordered.edges().len()];
        let mut at = starts.clone();
        for (row, edge) in (0..).zip(ordered.edges()) {
            let [a, b] = ends(edge);
            for (from, to) in [(a, b), (b, a)] {
                edges[at[from as usize]] = [to, row];
                at[from as usize] += 1;
            }
        }
        let [_, of_edges, of_facets, _] = ordered.numbers.first;
        let mut places = vec![0; ordered.edges().len()];
        for (place, &number) in (0..).zip(ordered.order()) {
            if (of_edges..of_facets).contains(&number) {
                places[(number - of_edges) as usize] = place;
            }
        }
        Self { edges, starts, places }
    }

    fn at(&self, vertex: u32) -> &[[u32; 2]] {
        &self.edges[self.starts[vertex as usize]..self.starts[vertex as usize + 1]]
    }
}

impl Forest {
    fn of(ordered: &Ordered<'_>, graph: &Graph) -> Self {
        let of_edges = ordered.numbers.first[1];
        let mut ends_component = vec![false; ordered.edges().len()];
        for &[_, edge] in &ordered.pairs().components {
            ends_component[(edge - of_edges) as usize] = true;
        }
        let vertices = ordered.vertices().len();
        let (mut up, mut depths) = (vec![NONE; vertices], vec![NONE; vertices]);
        for root in 0..vertices as u32 {
            if depths[root as usize] != NONE {
                continue;
            }
            depths[root as usize] = 0;
            let mut left = vec![root];
            while let Some(vertex) = left.pop() {
                for &[other, edge] in graph.at(vertex) {
                    if ends_component[edge as usize] && depths[other as usize] == NONE {
                        depths[other as usize] = depths[vertex as usize] + 1;
                        up[other as usize] = edge;
                        left.push(other);
                    }
                }
            }
        }
        Self { up, depths }
    }

    /// Whether an edge, by number, is one of them.
    fn is_in(&self, ordered: &Ordered<'_>, edge: u32) -> bool {
        let row = edge - ordered.numbers.first[1];
        let rows = &ordered.filtration().incidence.vertex_rows;
        let ends = ordered.edges()[row as usize].map(|v| rows[v as usize]);
        ends.iter().any(|&end| self.up[end as usize] == row)
    }
}

impl Parts {
    /// The components of the complement as they are when they are merged with older ones, backwards.
    fn of(ordered: &Ordered<'_>) -> Self {
        let cells = ordered.cell_rows.len();
        let mut next: Vec<u32> = (0..=cells as u32).collect();
        // Each component is a list from its eldest cell; the younger one is added at the end of the older one.
        let mut ends = next.clone();
        let mut counts = vec![1_u32; cells + 1];
        let mut sizes = vec![0; cells];
        ordered.merge_complement(|older, younger| {
            sizes[younger as usize] = counts[younger as usize];
            next[ends[older as usize] as usize] = younger;
            ends[older as usize] = ends[younger as usize];
            counts[older as usize] += counts[younger as usize];
        });
        let mut numbers = vec![0; cells];
        (ordered.numbers.first[3]..)
            .zip(&ordered.cell_rows)
            .for_each(|(number, &row)| numbers[row as usize] = number);
        Self { next, sizes, numbers }
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;
    use walpha_regular::Torus;

    use super::*;
    use crate::WeightedPoints;
    use crate::ladder::Filtration;

    /// A chain of simplices of one dimension, by number.
    type Chain = BTreeMap<u32, i64>;

    const MODULUS: i64 = PRIME as i64;

    fn add_to(chain: &mut Chain, number: u32, value: i64) {
        let sum = chain.entry(number).or_default();
        *sum = (*sum + value).rem_euclid(MODULUS);
        if *sum == 0 {
            chain.remove(&number);
        }
    }

    fn boundary_of_facet(ordered: &Ordered<'_>, facet: u32) -> Chain {
        let [_, edges, facets, _] = ordered.numbers.first;
        let mut chain = Chain::new();
        let sides = ordered.filtration().incidence.facet_edges[(facet - facets) as usize];
        for (edge, sign) in sides.into_iter().zip([1, -1, 1]) {
            add_to(&mut chain, edges + edge, sign);
        }
        chain
    }

    fn boundary_of_edges(ordered: &Ordered<'_>, chain: &Chain) -> Chain {
        let edges = ordered.numbers.first[1];
        let whole = ordered.filtration().whole();
        let mut ends = Chain::new();
        for (&edge, &value) in chain {
            let [a, b] = ordered.edges()[(edge - edges) as usize].map(|v| whole.copied(v).0);
            add_to(&mut ends, b, value);
            add_to(&mut ends, a, -value);
        }
        ends
    }

    /// A basis of chains, by their last members.
    #[derive(Default)]
    struct Basis(BTreeMap<u32, Chain>);

    impl Basis {
        /// What is left of a chain after all multiples of the basis are subtracted.
        fn rest(&self, mut chain: Chain) -> Chain {
            let mut rest = Chain::new();
            while let Some((last, value)) = chain.pop_last() {
                match self.0.get(&last) {
                    None => _ = rest.insert(last, value),
                    Some(of_basis) => {
                        for (&number, &by) in of_basis.iter().filter(|&(&number, _)| number != last)
                        {
                            add_to(&mut chain, number, -(value * by % MODULUS));
                        }
                    }
                }
            }
            rest
        }

        fn insert(&mut self, chain: Chain) {
            let mut rest = self.rest(chain);
            let Some((&last, &value)) = rest.last_key_value() else { return };
            let inverse = i64::from(super::super::loops::inverse(value as u32));
            rest.values_mut().for_each(|by| *by = *by * inverse % MODULUS);
            self.0.insert(last, rest);
        }
    }

    fn random_filtration(random: &mut Random, k: usize) -> Filtration {
        let count = 4 + random.below(12);
        // On a grid or not.
        let step = if k.is_multiple_of(2) { 16.0 } else { 15.3 };
        let mut number = || random.below(61) as f64 / step;
        let flat = k % 5 == 4;
        let positions: Vec<[f64; 3]> =
            (0..count).map(|_| [number(), number(), if flat { 0.0 } else { number() }]).collect();
        let weights = (0..count).map(|_| number() / 8.0).collect();
        let torus = match k % 3 {
            0 => None,
            1 => Some(Torus::new([4.0, 4.5, 5.0]).unwrap()),
            _ => Some(
                Torus::of_vectors([[4.0, 0.0, 0.0], [1.5, 3.5, 0.0], [-1.0, 0.5, 5.0]]).unwrap(),
            ),
        };
        Filtration::on(torus, WeightedPoints::new(positions, weights).unwrap()).unwrap()
    }

    /// Each loop has a cycle that is closed, born with its edge, and a boundary from the facet on that ends it, but not before; and a walk that is born
    /// with its edge.
    #[test]
    fn cycles_of_loops_are_born_and_end_when_they_say() {
        let mut random = Random::new(17);
        let (mut compared, mut large, mut wound) = (0, 0, 0);
        for k in 0..300 {
            let filtration = random_filtration(&mut random, k);
            let ordered = filtration.simplices().unwrap();
            let cycles = ordered.cycles();
            let mut places = vec![0; ordered.len()];
            (0..).zip(ordered.order()).for_each(|(place, &n)| places[n as usize] = place);
            let loops = ordered.loops().unwrap();
            let mut ended: BTreeMap<u32, u32> = loops.pairs.iter().map(|&[e, f]| (f, e)).collect();
            let facets = ordered.numbers.first[2]..ordered.numbers.first[3];
            let mut basis = Basis::default();
            let mut check = |edge: u32, ends: Option<(&Basis, Chain)>| {
                let LoopCycle { walk, path, chain } = cycles.of_loop(edge).unwrap().unwrap();
                let chain: Chain = chain
                    .iter()
                    .map(|&(edge, by)| (edge, i64::from(by).rem_euclid(MODULUS)))
                    .collect();
                assert!(boundary_of_edges(&ordered, &chain).is_empty());
                let youngest = chain.keys().max_by_key(|&&edge| places[edge as usize]);
                assert_eq!(youngest, Some(&edge));
                assert_eq!(cycles.path_of_loop(edge).as_ref(), Some(&path));
                // Walks are measured by their edges: each pair of consecutive places is one that is there.
                assert_eq!(path.len(), walk.len() + 1);
                large += usize::from(walk.len() > 4);
                let sides: Vec<f64> =
                    path.windows(2).map(|way| length(sub(way[1], way[0]))).collect();
                assert!(sides.iter().all(|&side| side > 0.0));
                match ordered.filtration().torus() {
                    None => assert_eq!(path.first(), path.last()),
                    Some(torus) => {
                        assert_eq!(torus.wrap(path[0]), torus.wrap(*path.last().unwrap()));
                        // What ends does not wind round, unless its cycle has other parts, which wind back.
                        let closes = path.first() == path.last();
                        assert!(ends.is_some() || !closes);
                        wound += usize::from(ends.is_some() && !closes);
                    }
                }
                if let Some((basis, last)) = ends {
                    let rest = basis.rest(chain);
                    assert!(!rest.is_empty(), "a boundary before its end");
                    let mut more = Basis(basis.0.clone());
                    more.insert(last);
                    assert!(more.rest(rest).is_empty(), "no boundary at its end");
                }
                compared += 1;
            };
            for &number in ordered.order().iter().filter(|&number| facets.contains(number)) {
                let boundary = boundary_of_facet(&ordered, number);
                if let Some(edge) = ended.remove(&number) {
                    check(edge, Some((&basis, boundary.clone())));
                }
                basis.insert(boundary);
            }
            loops.lasting.iter().for_each(|&edge| check(edge, None));
            // No loop begins with an edge that ends a component.
            if let Some(&[vertex, edge]) = ordered.pairs().components.first() {
                assert_eq!(cycles.of_loop(edge).unwrap(), None);
                assert_eq!(cycles.of_loop(vertex).unwrap(), None);
                assert_eq!([edge, vertex].map(|number| cycles.path_of_loop(number)), [None, None]);
            }
        }
        assert!(compared > 5000 && large > 100 && wound < 5, "{compared} {large} {wound}");
    }

    /// The walk along an edge is the shortest one, as all simple walks say.
    #[test]
    fn walks_are_shortest() {
        // A hexagon of points, and one beside it that leaves a longer way.
        let at = |k: f64| [k.cos(), k.sin(), 0.0];
        let mut points: Vec<[f64; 3]> =
            (0..6).map(|k| at(f64::from(k) * std::f64::consts::FRAC_PI_3)).collect();
        points.push([1.6, 0.9, 0.0]);
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let longest = ordered
            .persistence(1)
            .unwrap()
            .into_iter()
            .max_by(|a, b| (a.death - a.birth).total_cmp(&(b.death - b.birth)))
            .unwrap();
        let cycle = ordered.cycles().of_loop(longest.begins).unwrap().unwrap();
        let mut walk = cycle.walk.clone();
        walk.sort_unstable();
        assert_eq!(walk, [0, 1, 2, 3, 4, 5]);
        assert!(cycle.chain.iter().all(|&(_, by)| by.abs() == 1));
    }

    /// The boundary of each void is closed and born with its facet, and encloses the cells that fill it, the last of which ends it.
    #[test]
    fn voids_are_enclosed_by_their_boundaries() {
        let mut random = Random::new(23);
        let (mut compared, mut large) = (0, 0);
        for k in 0..150 {
            let filtration = random_filtration(&mut random, k);
            let ordered = filtration.simplices().unwrap();
            let cycles = ordered.cycles();
            let whole = filtration.whole();
            let mut places = vec![0; ordered.len()];
            (0..).zip(ordered.order()).for_each(|(place, &n)| places[n as usize] = place);
            let [_, _, of_facets, of_cells] = ordered.numbers.first;
            for &[facet, cell] in &ordered.pairs().voids {
                let VoidCycle { cells, facets, corners } = cycles.of_void(cell).unwrap();
                assert_eq!(cells.iter().max_by_key(|&&n| places[n as usize]), Some(&cell));
                // By the incidences of the cells, each facet with as many of them beside it.
                let mut beside = BTreeMap::<u32, u32>::new();
                for &cell in &cells {
                    let row = ordered.cell_rows[(cell - of_cells) as usize];
                    for facet in filtration.incidence.cell_facets[row as usize] {
                        *beside.entry(of_facets + facet).or_default() += 1;
                    }
                }
                let border: Vec<u32> =
                    beside.iter().filter(|&(_, &count)| count == 1).map(|(&n, _)| n).collect();
                assert_eq!(facets.len(), border.len());
                let youngest = border.iter().max_by_key(|&&n| places[n as usize]);
                assert_eq!(youngest, Some(&facet));
                // Cones from any point have the volume of the cells, also of what is laid out.
                let volume =
                    corners.iter().map(|&[a, b, c]| crate::six_volumes([corners[0][0], a, b, c]));
                let expected: f64 = (cells.iter())
                    .map(|&n| ordered.cell_rows[(n - of_cells) as usize] as usize)
                    .map(|row| crate::six_volumes(whole.corners(whole.complex().cells.rows()[row])))
                    .sum();
                if is_closed(&corners) {
                    assert!((volume.sum::<f64>() - expected).abs() < 1e-9);
                    compared += 1;
                    large += usize::from(cells.len() > 3);
                }
            }
            assert_eq!(cycles.of_void(of_facets), None);
        }
        assert!(compared > 2000 && large > 100, "{compared} {large}");
    }

    /// Whether each side of a triangle is one of another in the opposite direction. Voids that wind round a torus are cut open.
    fn is_closed(corners: &[[[f64; 3]; 3]]) -> bool {
        let mut sides = BTreeMap::<[[u64; 3]; 2], i32>::new();
        for &[a, b, c] in corners {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let [from, to] = [from, to].map(|p| p.map(|x| (x + 0.0).to_bits()));
                *sides.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        sides.values().all(|&sum| sum == 0)
    }
}
