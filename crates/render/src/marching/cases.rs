//! The triangles in a cell for each of the 256 patterns of high corners, derived from one rule instead of copied from a table.
//!
//! Walk around each face of the cell, counter-clockwise as seen from outside. Every run of high corners is cut off by a segment
//! from the edge where the walk enters it to the edge where it leaves. The neighbour walks in the opposite direction and gets the
//! same segments reversed: no cracks. In one cell, every crossed edge is entered on one of its two faces and left on the other,
//! so the segments form loops. Each loop is cut into triangles by diagonals through the inside of the cell; a diagonal in a face
//! could coincide with one of the neighbour, and four triangles would share an edge.

use std::sync::LazyLock;

/// Corner k of a cell is at (k & 1, k >> 1 & 1, k >> 2 & 1).
pub(super) const CORNERS: usize = 8;

/// Edges 4·axis .. 4·axis + 4 run along `axis`.
pub(super) const EDGES: usize = 12;

/// A corner's position in the cell, (x, y, z).
pub(super) fn offset(corner: usize) -> [usize; 3] {
    [corner & 1, corner >> 1 & 1, corner >> 2 & 1]
}

/// The axis of an edge, and the position of its lower end in the cell.
pub(super) fn edge(edge: usize) -> (usize, [usize; 3]) {
    let axis = edge / 4;
    let mut place = [0; 3];
    place[(axis + 1) % 3] = edge & 1;
    place[(axis + 2) % 3] = edge >> 1 & 1;
    (axis, place)
}

/// The triangles of every case, each as three edges that carry its vertices.
pub(super) struct Cases {
    triangles: Vec<Vec<[u8; 3]>>,
}

/// Worked out at first use.
pub(super) static CASES: LazyLock<Cases> = LazyLock::new(Cases::new);

impl Cases {
    fn new() -> Self {
        let faces = faces();
        let triangles = (0..1 << CORNERS)
            .map(|case| {
                let mut triangles = Vec::new();
                for ring in loops(&faces, case) {
                    let cut = cut(&faces, &ring, 0, ring.len() - 1);
                    triangles.extend(cut.expect("every loop can be cut inside the cell"));
                }
                triangles
            })
            .collect();
        Self { triangles }
    }

    /// The triangles of the case whose bit k says whether corner k is high.
    pub(super) fn triangles(&self, case: usize) -> &[[u8; 3]] {
        &self.triangles[case]
    }
}

/// The corners of each face, counter-clockwise seen from outside the cell.
fn faces() -> [[usize; 4]; 6] {
    std::array::from_fn(|face| {
        let (axis, side) = (face / 2, face % 2);
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let ring = if side == 1 { [0, u, u | v, v] } else { [0, v, u | v, u] };
        ring.map(|corner| corner | side << axis)
    })
}

/// The edge between two corners.
fn between(a: usize, b: usize) -> u8 {
    let same = |k: usize| {
        let (axis, [x, y, z]) = edge(k);
        let low = x | y << 1 | z << 2;
        low == a.min(b) && low | 1 << axis == a.max(b)
    };
    (0..EDGES).position(same).expect("neighbouring corners") as u8
}

/// The loops of segments in a cell.
fn loops(faces: &[[usize; 4]; 6], case: usize) -> Vec<Vec<u8>> {
    let high = |corner: usize| case >> corner & 1 == 1;
    let mut next = [None; EDGES];
    for ring in faces {
        for start in (0..4).filter(|&k| !high(ring[k]) && high(ring[(k + 1) % 4])) {
            let leave = (start + 1..start + 4)
                .find(|&k| high(ring[k % 4]) && !high(ring[(k + 1) % 4]))
                .expect("a walk that enters leaves again");
            let side = |k: usize| between(ring[k % 4], ring[(k + 1) % 4]);
            next[side(start) as usize] = Some(side(leave));
        }
    }
    let mut rings = Vec::new();
    for start in 0..EDGES {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = next[at].take() {
            ring.push(at as u8);
            at = to as usize;
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// Triangles that fill a ring from vertex `first` to vertex `last`, without a diagonal in a face.
fn cut(faces: &[[usize; 4]; 6], ring: &[u8], first: usize, last: usize) -> Option<Vec<[u8; 3]>> {
    if last - first < 2 {
        return Some(Vec::new());
    }
    let joined = |a: usize, b: usize| b - a == 1 || !share_a_face(faces, ring[a], ring[b]);
    (first + 1..last).filter(|&k| joined(first, k) && joined(k, last)).find_map(|k| {
        let mut triangles = cut(faces, ring, first, k)?;
        triangles.extend(cut(faces, ring, k, last)?);
        triangles.push([ring[first], ring[k], ring[last]]);
        Some(triangles)
    })
}

fn share_a_face(faces: &[[usize; 4]; 6], a: u8, b: u8) -> bool {
    let on = |ring: &[usize; 4], e| (0..4).any(|k| between(ring[k], ring[(k + 1) % 4]) == e);
    faces.iter().any(|ring| on(ring, a) && on(ring, b))
}
