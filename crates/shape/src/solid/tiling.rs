//! The cells of a shape at the places where its boundary is cut apart.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use walpha_base::UnionFind;

use super::{Middle, Surface};
use crate::{Class, Complex};

/// The copies of a vertex, and the groups into which the cells around it join them.
pub(super) struct Place {
    pub copies: Range<u32>,
    /// Copies between which there are the same cells, joined by facets. Most groups are single copies: there are more copies
    /// where cavities of the shape touch at a vertex.
    pub groups: Vec<Vec<u32>>,
}

/// Cells by vertices of the solid. Each cell has as a corner the copy in whose fan it is, or the first of its group. Corners that
/// are not on the boundary are numbered after the vertices of the solid, by input index.
pub(super) struct Tiling {
    pub cells: Vec<[u32; 4]>,
    /// The cells at each vertex that may move.
    at: HashMap<u32, Vec<u32>>,
    /// The first copy of its group, for each copy that is not the first.
    firsts: HashMap<u32, u32>,
    /// The number of vertices of the solid, midpoints included.
    pub vertices: u32,
}

impl Tiling {
    /// Creates the tiling of a solid before its edges get midpoints: `whole` is the surface before it was cut, with corners by
    /// vertex, and `ends` are further vertices whose cells are needed.
    pub(super) fn new(
        complex: &Complex,
        (whole, starts, corners): (&Surface, &[u32], &[u32]),
        solid: &Surface,
        middles: &[Middle],
        cut: &[[u32; 3]],
    ) -> (Self, Vec<Place>) {
        let vertices = solid.vertex_count() as u32;
        let first = |v: u32| {
            let id = solid.vertices.partition_point(|&used| used < v);
            if solid.vertices.get(id) == Some(&v) { id as u32 } else { vertices + v }
        };
        let touched = touched(solid, middles);
        let (cells, at, firsts) = (Vec::new(), HashMap::new(), HashMap::new());
        let mut tiling = Self { cells, at, firsts, vertices };
        let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut rows: Vec<[u32; 4]> = Vec::new();
        for &row in complex.cells.of(Class::Interior) {
            if row.iter().any(|v| touched.contains_key(v)) {
                let cell = tiling.cells.len() as u32;
                let several = |v: &&u32| touched.get(v) == Some(&true);
                row.iter().filter(several).for_each(|&v| around.entry(v).or_default().push(cell));
                rows.push(row);
                tiling.cells.push(row.map(first));
            }
        }
        let mut places = Vec::new();
        for (v, cells) in around {
            let from = first(v);
            let number = whole.vertices.partition_point(|&used| used < v);
            let mut fans: HashMap<[u32; 2], u32> = HashMap::new();
            for &corner in &corners[starts[number] as usize..starts[number + 1] as usize] {
                let (facet, at) = (corner as usize / 3, corner as usize % 3);
                let row = whole.regular[facet].map(|w| whole.vertices[w as usize]);
                fans.insert(sorted(row[(at + 1) % 3], row[(at + 2) % 3]), cut[facet][at]);
            }
            let groups = groups(v, &cells, &rows, &fans);
            for (cells, copies) in &groups {
                tiling.firsts.extend(copies[1..].iter().map(|&copy| (copy, copies[0])));
                for &cell in cells {
                    let corner = tiling.cells[cell as usize].iter_mut().find(|w| **w == from);
                    *corner.expect("a corner there") = copies[0];
                }
            }
            let count = solid.vertices[from as usize..].iter().take_while(|&&w| w == v).count();
            places.push(Place {
                copies: from..from + count as u32,
                groups: groups.into_iter().map(|(_, copies)| copies).collect(),
            });
        }
        for cell in 0..tiling.cells.len() as u32 {
            tiling.enter(cell);
        }
        (tiling, places)
    }

    /// The vertex that stands for a vertex in cells.
    pub(super) fn corner(&self, v: u32) -> u32 {
        self.firsts.get(&v).copied().unwrap_or(v)
    }

    fn enter(&mut self, cell: u32) {
        for v in self.cells[cell as usize] {
            if v < self.vertices {
                self.at.entry(v).or_default().push(cell);
            }
        }
    }

    pub(super) fn push(&mut self, cell: [u32; 4]) {
        self.cells.push(cell);
        self.enter(self.cells.len() as u32 - 1);
    }

    /// The facets of cells opposite a vertex, as seen from it.
    pub(super) fn opposite(&self, v: u32) -> impl Iterator<Item = [u32; 3]> {
        let cells = self.at.get(&v).into_iter().flatten();
        cells.map(move |&cell| opposite(self.cells[cell as usize], v))
    }

    /// Makes one copy the corner of the cells of another.
    pub(super) fn rename(&mut self, from: u32, to: u32) {
        let cells = self.at.remove(&from).unwrap_or_default();
        for &cell in &cells {
            let corners = self.cells[cell as usize].iter_mut();
            corners.filter(|v| **v == from).for_each(|v| *v = to);
        }
        self.at.entry(to).or_default().extend(cells);
    }

    /// The cells around an edge, from the facet with one third corner to that with another.
    pub(super) fn between(&self, [u, v]: [u32; 2], [from, to]: [u32; 2]) -> Vec<u32> {
        let all = self.at.get(&u).into_iter().flatten().copied();
        let mut left: Vec<u32> =
            all.filter(|&cell| self.cells[cell as usize].contains(&v)).collect();
        let (mut chain, mut at) = (Vec::new(), from);
        while at != to {
            let next = left.iter().position(|&cell| self.cells[cell as usize].contains(&at));
            let Some(next) = next else { return Vec::new() };
            let cell = left.swap_remove(next);
            let others = self.cells[cell as usize].into_iter().find(|w| ![u, v, at].contains(w));
            at = others.expect("a fourth corner");
            chain.push(cell);
        }
        chain
    }

    /// Divides cells at the edge u–v by a vertex on it.
    pub(super) fn divide(&mut self, cells: &[u32], [u, v]: [u32; 2], middle: u32) {
        for &cell in cells {
            let row = self.cells[cell as usize];
            let with = |end: u32| row.map(|w| if w == end { middle } else { w });
            self.cells[cell as usize] = with(v);
            if let Some(cells) = self.at.get_mut(&v) {
                cells.retain(|&other| other != cell);
            }
            self.at.entry(middle).or_default().push(cell);
            self.push(with(u));
        }
    }
}

/// Input indices of vertices that have several copies (true) or an edge that gets a midpoint.
fn touched(solid: &Surface, middles: &[Middle]) -> HashMap<u32, bool> {
    let ends = middles.iter().flat_map(|middle| middle.ends);
    let mut touched: HashMap<u32, bool> =
        ends.map(|end| (solid.vertices[end as usize], false)).collect();
    let twice = solid.vertices.windows(2).filter(|pair| pair[0] == pair[1]);
    touched.extend(twice.map(|pair| (pair[0], true)));
    touched
}

/// The cells around a vertex that are joined by facets there, with the copies of the vertex in whose fans these end: `fans` has the copy of each
/// facet of the boundary, by its other corners.
fn groups(
    v: u32,
    cells: &[u32],
    rows: &[[u32; 4]],
    fans: &HashMap<[u32; 2], u32>,
) -> Vec<(Vec<u32>, Vec<u32>)> {
    let sets = UnionFind::new(cells.len());
    let mut open: HashMap<[u32; 2], u32> = HashMap::new();
    let facets = |cell: u32| {
        let row = rows[cell as usize];
        let [a, b, c] = opposite(row, v);
        [sorted(a, b), sorted(b, c), sorted(c, a)]
    };
    for (&cell, i) in cells.iter().zip(0..) {
        for facet in facets(cell) {
            match open.remove(&facet) {
                Some(other) => {
                    sets.unite(other, i);
                }
                None => {
                    open.insert(facet, i);
                }
            }
        }
    }
    let mut groups: BTreeMap<u32, (Vec<u32>, BTreeSet<u32>)> = BTreeMap::new();
    for (&cell, i) in cells.iter().zip(0..) {
        let group = groups.entry(sets.find(i)).or_default();
        group.0.push(cell);
        group.1.extend(facets(cell).iter().filter_map(|facet| fans.get(facet)));
    }
    groups.into_values().map(|(cells, copies)| (cells, copies.into_iter().collect())).collect()
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The facet of a cell opposite a corner; as seen from it counter-clockwise if the cell is positively oriented.
pub(super) fn opposite([a, b, c, d]: [u32; 4], corner: u32) -> [u32; 3] {
    match corner {
        _ if corner == a => [b, d, c],
        _ if corner == b => [a, c, d],
        _ if corner == c => [a, d, b],
        _ => [a, b, c],
    }
}
