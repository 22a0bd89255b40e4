//! The boundary of a shape as a closed, oriented manifold, which other programs accept as the boundary of a solid.

mod apart;
mod boxes;
mod crossing;
mod direction;
mod tiling;

use std::collections::{BTreeMap, HashMap, HashSet};

use serde::Serialize;
use walpha_base::UnionFind;

use super::surface::Side;
use super::{AlphaShape, Class, Complex, Surface};
use apart::Apart;
use tiling::{Place, Tiling};

/// The cuts that made a boundary a manifold, and the distances by which its vertices moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Cuts {
    /// Edges on more than two facets, along which parts of the shape touch.
    pub edges: usize,
    /// Number of copies of vertices that were added.
    pub vertices: usize,
    /// Vertices inserted at midpoints of edges, to separate facets along an edge whose both ends are in one fan.
    pub midpoints: usize,
    /// Vertices that were moved away from others at the same place.
    pub moved: usize,
    /// The largest distance by which a vertex was moved, in the unit of the coordinates.
    pub largest_move: f64,
    /// The number of vertices that are still at the place of another one, because no step was found that keeps the boundary from
    /// crossing itself.
    pub together: usize,
}

/// A corner of a facet: 3·row + corner.
type Corner = u32;

/// A vertex inserted at the midpoint of an edge between two facets.
struct Middle {
    vertex: u32,
    ends: [u32; 2],
    /// The third corners of the two facets.
    thirds: [u32; 2],
}

/// A boundary that is cut apart, before vertices move.
struct Cut {
    solid: Surface,
    cuts: Cuts,
    middles: Vec<Middle>,
    /// The vertices to move, if there are any, and the cells there.
    around: Option<(Tiling, Vec<Place>)>,
}

impl Cut {
    fn of(shape: &AlphaShape) -> Self {
        let complex = &shape.complex;
        let whole = Surface::of_complex(complex);
        let fans = UnionFind::new(3 * whole.regular.len());
        let mut touching = Vec::new();
        whole.each_edge(|sides| match sides {
            [(_, a), (_, b)] => join(&fans, *a, *b),
            _ => touching.push(sides.to_vec()),
        });
        let pairs = pairs(complex, &whole, &touching);
        for [a, b] in &pairs {
            join(&fans, *a, *b);
        }
        // Fans are numbered in the order of their vertices; each gets a vertex.
        let mut solid = Surface { regular: whole.regular.clone(), ..Surface::default() };
        let mut cuts = Cuts { edges: touching.len(), ..Cuts::default() };
        let (starts, corners) = whole.corners_by_vertex();
        for (v, around) in starts.windows(2).enumerate() {
            let mut roots: Vec<Corner> = Vec::new();
            let first = solid.vertices.len();
            for &corner in &corners[around[0] as usize..around[1] as usize] {
                let root = fans.find(corner);
                let fan = roots.iter().position(|&other| other == root).unwrap_or(roots.len());
                if fan == roots.len() {
                    roots.push(root);
                    solid.vertices.push(whole.vertices[v]);
                }
                solid.regular.as_flattened_mut()[corner as usize] = (first + fan) as u32;
            }
            cuts.vertices += roots.len().saturating_sub(1);
        }
        let facets = solid.regular.clone();
        let middles = solid.insert_midpoints(&pairs);
        cuts.midpoints = middles.len();
        // Where a torus is cut open, its cells are not adjacent in space.
        let in_space = shape.options.periodic.is_none() && shape.copies.is_empty();
        let around = (in_space && cuts.vertices + cuts.midpoints > 0).then(|| {
            let corners = (&whole, &starts[..], &corners[..]);
            Tiling::new(complex, corners, &solid, &middles, &facets)
        });
        Self { solid, cuts, middles, around }
    }
}

impl Surface {
    /// See [`AlphaShape::solid`](crate::AlphaShape::solid).
    pub(super) fn solid(shape: &AlphaShape) -> (Self, Cuts) {
        let Cut { mut solid, mut cuts, middles, around } = Cut::of(shape);
        if let Some((tiling, places)) = around {
            let of_input = &shape.points.positions;
            let found = Apart::new(&solid, of_input, tiling).separate(&middles, &places);
            cuts.moved = found.moved.len();
            cuts.largest_move = found.largest;
            cuts.together = found.together;
            solid.moved = found.moved;
        }
        (solid, cuts)
    }

    /// The corners of regular facets at each vertex: the start of those of each vertex, and all corners.
    fn corners_by_vertex(&self) -> (Vec<u32>, Vec<Corner>) {
        let all = self.regular.as_flattened();
        let mut starts = vec![0; self.vertices.len() + 1];
        all.iter().for_each(|&v| starts[v as usize + 1] += 1);
        (1..starts.len()).for_each(|v| starts[v] += starts[v - 1]);
        let (mut next, mut corners) = (starts.clone(), vec![0; all.len()]);
        for (&v, corner) in all.iter().zip(0..) {
            corners[next[v as usize] as usize] = corner;
            next[v as usize] += 1;
        }
        (starts, corners)
    }

    /// Separates pairs of facets at an edge whose ends they share, by vertices at its midpoint.
    fn insert_midpoints(&mut self, pairs: &[[[Corner; 2]; 2]]) -> Vec<Middle> {
        let mut sheets: BTreeMap<[u32; 2], Vec<[Corner; 2]>> = BTreeMap::new();
        for [[a, other], [b, _]] in pairs {
            let ends = [a, other].map(|&corner| self.regular.as_flattened()[corner as usize]);
            let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            sheets.entry(key).or_default().push([a / 3, b / 3]);
        }
        // The rows into which a facet was divided.
        let mut rows: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut middles = Vec::new();
        for (ends, sheets) in sheets {
            for facets in &sheets[1..] {
                let vertex = (self.vertices.len() + self.midpoints.len()) as u32;
                self.midpoints.push(ends);
                let thirds = facets.map(|facet| {
                    let rows = rows.entry(facet).or_insert_with(|| vec![facet]);
                    self.divide(rows, ends, vertex)
                });
                middles.push(Middle { vertex, ends, thirds });
            }
        }
        middles
    }

    /// Divides the row that has an edge at a vertex on the edge; returns the third corner.
    fn divide(&mut self, rows: &mut Vec<u32>, ends: [u32; 2], vertex: u32) -> u32 {
        let has_edge = |row: &&u32| {
            let row = &self.regular[**row as usize];
            ends.iter().all(|end| row.contains(end))
        };
        let at = *rows.iter().find(has_edge).expect("one has the edge");
        let row = self.regular[at as usize];
        let with = |end: u32| row.map(|v| if v == end { vertex } else { v });
        self.regular[at as usize] = with(ends[1]);
        rows.push(self.regular.len() as u32);
        self.regular.push(with(ends[0]));
        *row.iter().find(|v| !ends.contains(v)).expect("a third corner")
    }
}

/// Joins two facets at the ends of an edge.
pub(super) fn join(fans: &UnionFind, a: [Corner; 2], b: [Corner; 2]) {
    fans.unite(a[0], b[0]);
    fans.unite(a[1], b[1]);
}

/// Pairs of facets that stay joined along one of these edges because they bound the same cells there. They are given by their
/// corners at the ends of the edge, in the same order.
fn pairs(complex: &Complex, surface: &Surface, edges: &[Vec<Side>]) -> Vec<[[Corner; 2]; 2]> {
    let number = |end: u32| surface.vertices[end as usize];
    let wedges = wedges(complex, edges.iter().map(|sides| sides[0].0.map(number)).collect());
    let mut pairs = Vec::new();
    for sides in edges {
        // The key is the third corner of each facet, which is also a corner of the first or last cell between two facets.
        let third = |corners: &[Corner; 2]| {
            let row = surface.regular[corners[0] as usize / 3];
            let ends = sides[0].0;
            number(*row.iter().find(|v| !ends.contains(v)).expect("a third corner"))
        };
        let by_third: HashMap<u32, [Corner; 2]> =
            sides.iter().map(|(_, corners)| (third(corners), *corners)).collect();
        let links = &wedges[&sides[0].0.map(number)];
        for (&from, &corners_from) in &by_third {
            let to = last(links, from);
            if from < to {
                pairs.push([corners_from, by_third[&to]]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// For each edge, the third and fourth corners of the cells of the shape around it: the link of the edge in the shape.
fn wedges(complex: &Complex, edges: HashSet<[u32; 2]>) -> HashMap<[u32; 2], Vec<[u32; 2]>> {
    let mut wedges: HashMap<[u32; 2], Vec<[u32; 2]>> = HashMap::new();
    if edges.is_empty() {
        return wedges;
    }
    for cell in complex.cells.of(Class::Interior) {
        for (i, j, k, l) in
            [(0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)]
        {
            let edge = [cell[i].min(cell[j]), cell[i].max(cell[j])];
            if edges.contains(&edge) {
                wedges.entry(edge).or_default().push([cell[k], cell[l]]);
            }
        }
    }
    wedges
}

/// The other end of the chain of cells around an edge that starts at the facet with this third corner.
fn last(links: &[[u32; 2]], from: u32) -> u32 {
    let (mut at, mut before) = (from, None);
    loop {
        let next =
            links.iter().enumerate().find(|&(k, link)| Some(k) != before && link.contains(&at));
        let Some((k, link)) = next else { return at };
        at = if link[0] == at { link[1] } else { link[0] };
        before = Some(k);
    }
}

#[cfg(test)]
mod tests;
