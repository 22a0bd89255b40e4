//! Polygons from triangles: walks along the boundary, cut into simple rings.
//!
//! A *side* is an edge of a triangle, as 3·triangle + corner: from this corner to the next one, with the triangle on its left. A
//! walk follows sides without a triangle on the right. At a vertex it turns through the triangles on its left to the last of
//! them, whose side comes next: so it never crosses itself or another walk, and does not leave the triangles that are joined
//! through edges.
//!
//! A walk that comes to a vertex again has closed a ring. As nothing crosses, the ring that is cut off there touches the rest
//! only at that vertex, and neither crosses the other. Of the rings of one polygon, only one turns counter-clockwise: the
//! polygon, which is connected, would lie inside each such ring, and so would the other ring.

use std::collections::BTreeMap;

use walpha_base::UnionFind;
use walpha_base::sort::sort_by;

use super::view::Seen;

/// A region of a plane without its holes; rings are lists of input indices, not closed by repeating the first.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub struct Polygon {
    /// The ring around it, counter-clockwise. It begins with its smallest index.
    pub outer: Vec<u32>,
    /// The rings around its holes, clockwise, each from its smallest index on, in lexicographic order.
    pub holes: Vec<Vec<u32>>,
}

/// An edge of a triangle: 3·triangle + corner.
type Side = u32;

/// Stands for a missing triangle on the other side of a side of the boundary, or for a missing vertex.
const NONE: u32 = u32::MAX;

/// Triangles of a plane that turn counter-clockwise, and their neighbours.
pub(super) struct Triangles {
    rows: Vec<[u32; 3]>,
    /// For each side, the same edge as a side of the neighbouring triangle, or [`NONE`].
    across: Vec<Side>,
    /// Each side by the ends of its edge, smaller end first. Sorted.
    sides: Vec<([u32; 2], Side)>,
}

impl Triangles {
    pub(super) fn new(rows: Vec<[u32; 3]>) -> Self {
        let mut sides = Vec::with_capacity(3 * rows.len());
        for (&[a, b, c], first) in rows.iter().zip((0..).step_by(3)) {
            let ends = [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)]);
            sides.extend(ends.into_iter().zip(first..));
        }
        sides.sort_unstable();
        let mut across = vec![NONE; sides.len()];
        for edge in sides.chunk_by(|a, b| a.0 == b.0) {
            if let &[(_, left), (_, right)] = edge {
                across[left as usize] = right;
                across[right as usize] = left;
            }
        }
        Self { rows, across, sides }
    }

    pub(super) fn rows(&self) -> &[[u32; 3]] {
        &self.rows
    }

    /// The first of the sides on an edge, given by its smaller end and its other one.
    pub(super) fn side(&self, ends: [u32; 2]) -> Option<Side> {
        let at = self.sides.partition_point(|side| side.0 < ends);
        self.sides.get(at).filter(|side| side.0 == ends).map(|side| side.1)
    }

    /// The ends of a side, with its triangle on the left.
    pub(super) fn ends(&self, side: Side) -> [u32; 2] {
        [side, next(side)].map(|corner| self.rows.as_flattened()[corner as usize])
    }

    /// Whether there is no triangle on the right of a side.
    pub(super) fn is_boundary(&self, side: Side) -> bool {
        self.across[side as usize] == NONE
    }

    /// The sides of the boundary.
    pub(super) fn boundary(&self) -> impl Iterator<Item = Side> + '_ {
        (0..self.across.len() as Side).filter(|&side| self.is_boundary(side))
    }

    /// The polygons that the triangles make, in order.
    pub(super) fn polygons(&self, seen: &Seen<'_>) -> Vec<Polygon> {
        let pieces = self.pieces();
        let mut polygons: BTreeMap<u32, Polygon> = BTreeMap::new();
        let mut walked = vec![false; self.across.len()];
        let mut cutter = Cutter::up_to(self.rows.as_flattened().iter().copied().max());
        for start in self.boundary() {
            if walked[start as usize] {
                continue;
            }
            let polygon = polygons.entry(pieces.find(start / 3)).or_default();
            let mut take = |ring: Vec<u32>| {
                if seen.winds_counter_clockwise(&ring) {
                    polygon.outer = ring;
                } else {
                    polygon.holes.push(ring);
                }
            };
            let mut side = start;
            while !walked[side as usize] {
                walked[side as usize] = true;
                cutter.pass(self.ends(side)[0]).into_iter().for_each(&mut take);
                side = self.following(side);
            }
            take(cutter.rest());
        }
        let mut polygons: Vec<Polygon> = polygons.into_values().collect();
        polygons.iter_mut().for_each(|polygon| polygon.holes.sort_unstable());
        sort_by(&mut polygons, Ord::cmp);
        polygons
    }

    /// The triangles, united through their edges.
    fn pieces(&self) -> UnionFind {
        let pieces = UnionFind::new(self.rows.len());
        for (side, &other) in (0..).zip(&self.across) {
            if other != NONE {
                pieces.unite(side / 3, other / 3);
            }
        }
        pieces
    }

    /// The side of the boundary after this one.
    fn following(&self, side: Side) -> Side {
        let mut following = next(side);
        while !self.is_boundary(following) {
            following = next(self.across[following as usize]);
        }
        following
    }
}

/// The next side of the same triangle.
fn next(side: Side) -> Side {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// Cuts a walk into rings that pass each vertex once.
struct Cutter {
    /// The vertices passed that are in no ring yet.
    path: Vec<u32>,
    /// The place of each vertex in the path, or [`NONE`].
    place: Vec<u32>,
}

impl Cutter {
    fn up_to(largest: Option<u32>) -> Self {
        let vertices = largest.map_or(0, |v| v as usize + 1);
        Self { path: Vec::new(), place: vec![NONE; vertices] }
    }

    /// Passes a vertex, and returns the ring that this closes, if any.
    fn pass(&mut self, v: u32) -> Option<Vec<u32>> {
        let place = self.place[v as usize];
        let ring = (place != NONE).then(|| self.cut(place as usize));
        self.place[v as usize] = self.path.len() as u32;
        self.path.push(v);
        ring
    }

    /// The rest of the walk at its end, as a ring.
    fn rest(&mut self) -> Vec<u32> {
        self.cut(0)
    }

    /// Cuts off the path from a place on. The ring begins with its smallest index.
    fn cut(&mut self, from: usize) -> Vec<u32> {
        let mut ring = self.path.split_off(from);
        ring.iter().for_each(|&v| self.place[v as usize] = NONE);
        let smallest = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or(0);
        ring.rotate_left(smallest);
        ring
    }
}
