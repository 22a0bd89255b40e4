use std::borrow::Cow;
use std::cmp::Ordering;
use std::sync::OnceLock;

use walpha_base::parallel::prelude::*;
use walpha_regular::internals::BitRange;

use super::barycentric::coordinates;
use super::least_squares::PiecewiseLinear;
use super::{Grid, InterpolateError};
use walpha_shape::{AlphaShape, Class, Simplices};

/// The minimum number of positions in one parallel task.
const CHUNK: usize = 256;

/// The function F on a shape: on each simplex, it is linear in the values at the vertices.
///
/// The simplices are the interior cells, followed by the singular facets, edges and vertices: those that are not a face of a
/// higher simplex of the shape. A position on several belongs to the first of them, in that order and in the canonical order of
/// [`Complex`](walpha_shape::Complex). Whether a simplex contains a position is decided exactly for the given doubles, so no
/// position on the shape is missed between two cells, and the value does not jump across faces.
///
/// Values are rounded, by about 1e-13 of the largest value at the vertices; at a vertex they are its value bit for bit. If
/// coordinates are small multiples of a power of two, like those of voxels, the value does not depend at all on which of several
/// simplices a position belongs to.
///
/// If all points are samples of a volume, the samples of a grid over it are located by their indices in the volume, which are
/// exact in any frame, and not by the rounded coordinates of the world.
///
/// If several points coincide, the value of the one that was kept is used. Hidden points are ignored.
#[derive(Clone, Debug)]
pub struct Interpolant<'a> {
    positions: Cow<'a, [[f64; 3]]>,
    values: &'a [f64],
    simplices: Vec<SupportSimplex>,
    bit_range: BitRange,
    /// The search tree, built when a single position is queried; grids do not need it.
    tree: OnceLock<Tree>,
}

/// A simplex with a function on it: its vertices, of which the first `count` are used.
#[derive(Clone, Copy, Debug)]
struct SupportSimplex {
    vertices: [u32; 4],
    count: u8,
}

/// The location of a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location<'a> {
    /// The simplex that it belongs to: the input indices of one to four vertices.
    pub simplex: &'a [u32],
    /// Its barycentric coordinates there, one for each vertex, followed by zeros.
    pub coordinates: [f64; 4],
}

impl<'a> Interpolant<'a> {
    /// Creates the interpolant of the values of a shape's points. O(n).
    ///
    /// # Errors
    /// The points have no values, or one that is not finite.
    pub fn new(shape: &'a AlphaShape) -> Result<Self, InterpolateError> {
        let values = shape.points().values().ok_or(InterpolateError::NoValues)?;
        Self::with_values(shape, values)
    }

    /// Creates the interpolant of other values, one for each point of a shape. O(n).
    ///
    /// # Errors
    /// A value is not finite, or the shape is on a torus.
    ///
    /// # Panics
    /// The number of values differs from that of points.
    pub fn with_values(shape: &'a AlphaShape, values: &'a [f64]) -> Result<Self, InterpolateError> {
        assert_eq!(values.len(), shape.points().len(), "a value for each point");
        if shape.options().periodic.is_some() {
            return Err(InterpolateError::Periodic);
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(InterpolateError::Value { index, value: values[index] });
        }
        let complex = shape.complex();
        let mut simplices = Vec::with_capacity(complex.cells.len());
        add(&mut simplices, &complex.cells, Class::Interior);
        add(&mut simplices, &complex.facets, Class::Singular);
        add(&mut simplices, &complex.edges, Class::Singular);
        add(&mut simplices, &complex.vertices, Class::Singular);
        let positions = shape.points().positions();
        let bit_range = BitRange::of(positions);
        Ok(Self {
            positions: positions.into(),
            values,
            simplices,
            bit_range,
            tree: OnceLock::new(),
        })
    }

    /// Expresses this function and a grid in indices, if the points are samples of the grid's volume and their coordinates are
    /// those of the world; otherwise returns both unchanged.
    ///
    /// In a tilted or anisotropic frame the coordinates of samples are rounded, so that a sample on the boundary of the shape may
    /// be outside by a rounding error, and each decision near a facet takes big integers. Indices are exact in any frame, and
    /// barycentric coordinates do not depend on it. O(n).
    pub(super) fn by_index<'b>(&'b self, grid: &'b Grid) -> (Cow<'b, Self>, Cow<'b, Grid>) {
        let Some(indices) = grid.indices(&self.positions) else {
            return (Cow::Borrowed(self), Cow::Borrowed(grid));
        };
        let mut simplices = self.simplices.clone();
        if grid.is_mirrored() {
            let cells = simplices.iter_mut().filter(|simplex| simplex.count == 4);
            cells.for_each(|cell| cell.vertices.swap(0, 1));
        }
        let (bit_range, tree) = (BitRange::of(&indices), OnceLock::new());
        let (positions, values) = (indices.into(), self.values);
        let there = Self { positions, values, simplices, bit_range, tree };
        (Cow::Owned(there), Cow::Owned(grid.by_index()))
    }

    /// The value of F at a position (x, y, z) in the units of the points; `None` outside the shape, and for coordinates that are
    /// not finite. O(log n) after the first call.
    pub fn value_at(&self, place: [f64; 3]) -> Option<f64> {
        let simplex = self.simplex_at(place)?;
        Some(self.value(simplex, &self.coordinates(simplex, place)?))
    }

    /// The values of F at many positions, in parallel.
    pub fn values_at(&self, places: &[[f64; 3]]) -> Vec<Option<f64>> {
        places.par_iter().with_min_len(CHUNK).map(|&place| self.value_at(place)).collect()
    }

    /// The simplex that a position belongs to, and its coordinates there.
    pub fn locate(&self, place: [f64; 3]) -> Option<Location<'_>> {
        let number = self.simplex_at(place)?;
        let simplex = self.simplices[number as usize].vertices();
        Some(Location { simplex, coordinates: self.coordinates(number, place)? })
    }

    /// The number of simplices with a function on them.
    pub(super) fn len(&self) -> usize {
        self.simplices.len()
    }

    /// The values of the points.
    pub(super) fn values(&self) -> &[f64] {
        self.values
    }

    /// The common bits of the coordinates of points.
    pub(super) fn bit_range(&self) -> BitRange {
        self.bit_range
    }

    /// The corners of a simplex, and how many of them are used.
    pub(super) fn corners(&self, simplex: u32) -> ([[f64; 3]; 4], usize) {
        let simplex = self.simplices[simplex as usize];
        (simplex.vertices.map(|v| self.positions[v as usize]), usize::from(simplex.count))
    }

    /// The coordinates of a position in a simplex, if it contains the position.
    pub(super) fn coordinates(&self, simplex: u32, place: [f64; 3]) -> Option<[f64; 4]> {
        let (corners, count) = self.corners(simplex);
        coordinates(&corners[..count], place, self.bit_range.is_exact_with(place))
    }

    /// The value of F on a simplex.
    pub(super) fn value(&self, simplex: u32, coordinates: &[f64; 4]) -> f64 {
        let simplex = self.simplices[simplex as usize];
        combine(coordinates, simplex.vertices.map(|v| self.values[v as usize]))
    }

    fn simplex_at(&self, place: [f64; 3]) -> Option<u32> {
        if place.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let tree = self.tree.get_or_init(|| {
            let bounds = |simplex: u32| {
                let (corners, count) = self.corners(simplex);
                let ends = |f: fn(f64, f64) -> f64| {
                    let join = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| f(a[k], b[k]));
                    corners[..count].iter().copied().reduce(join).expect("a vertex at least")
                };
                [ends(f64::min), ends(f64::max)]
            };
            let boxes: Vec<_> = (0..self.len() as u32).into_par_iter().map(bounds).collect();
            Tree::new(&boxes)
        });
        tree.first(place, |simplex| self.coordinates(simplex, place).is_some())
    }
}

/// The sum of values weighted by their shares, in order of size, so that it does not depend on the order of the vertices. At a
/// vertex it is the vertex's value bit for bit.
pub(super) fn combine(shares: &[f64; 4], values: [f64; 4]) -> f64 {
    if let Some(vertex) = shares.iter().position(|&share| share == 1.0) {
        return values[vertex];
    }
    let mut terms = [0, 1, 2, 3].map(|k| shares[k] * values[k]);
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        if terms[i].total_cmp(&terms[j]).is_gt() {
            terms.swap(i, j);
        }
    }
    terms.iter().sum()
}

impl PiecewiseLinear for Interpolant<'_> {
    fn count(&self) -> usize {
        self.simplices.len()
    }

    fn vertices(&self, simplex: u32) -> ([u32; 4], usize) {
        let simplex = self.simplices[simplex as usize];
        (simplex.vertices, usize::from(simplex.count))
    }

    fn coordinates(&self, simplex: u32, place: [f64; 3]) -> Option<[f64; 4]> {
        self.coordinates(simplex, place)
    }

    fn value(&self, simplex: u32, shares: &[f64; 4]) -> f64 {
        self.value(simplex, shares)
    }
}

impl SupportSimplex {
    fn vertices(&self) -> &[u32] {
        &self.vertices[..usize::from(self.count)]
    }
}

/// Adds the simplices of a class, in their order.
fn add<const N: usize>(supports: &mut Vec<SupportSimplex>, simplices: &Simplices<N>, class: Class) {
    supports.extend(simplices.of(class).map(|row| {
        let mut vertices = [row[0]; 4];
        vertices[..N].copy_from_slice(row);
        SupportSimplex { vertices, count: N as u8 }
    }));
}

/// A binary tree of boxes, to find those that contain a position.
///
/// Nodes are in preorder, each with the node that follows its whole subtree, so that a search needs no stack. There is about one
/// node for every two boxes.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The numbers of the boxes; those of a leaf are contiguous.
    order: Vec<u32>,
}

#[derive(Clone, Debug)]
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    /// The node after the subtree of this one.
    next: u32,
    /// The range of the node's boxes in the order, if it is a leaf.
    leaf: Option<(u32, u32)>,
}

/// The low and the high corner.
pub(super) type Bounds = [[f64; 3]; 2];

/// The largest number of boxes of a leaf.
const LEAF: usize = 4;

impl Tree {
    /// Halves the boxes repeatedly by their centres, along the axis in which these are farthest apart. O(n log n).
    pub(super) fn new(boxes: &[Bounds]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        if !order.is_empty() {
            grow(&mut nodes, boxes, &mut order, 0);
        }
        Self { nodes, order }
    }

    /// The least number for which `holds` is true, among the boxes that contain a position.
    pub(super) fn first(&self, place: [f64; 3], holds: impl Fn(u32) -> bool) -> Option<u32> {
        let mut first = None;
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if (0..3).any(|k| place[k] < node.low[k] || place[k] > node.high[k]) {
                at = node.next as usize;
                continue;
            }
            if let Some((start, end)) = node.leaf {
                for &number in &self.order[start as usize..end as usize] {
                    if first.is_none_or(|best| number < best) && holds(number) {
                        first = Some(number);
                    }
                }
            }
            at += 1;
        }
        first
    }
}

fn grow(nodes: &mut Vec<Node>, boxes: &[Bounds], order: &mut [u32], start: u32) {
    let node = nodes.len();
    let around = order.iter().map(|&i| boxes[i as usize]).reduce(union).expect("a box at least");
    let leaf = order.len() <= LEAF;
    let range = (start, start + order.len() as u32);
    nodes.push(Node { low: around[0], high: around[1], next: 0, leaf: leaf.then_some(range) });
    if !leaf {
        let middle =
            |i: u32, k: usize| boxes[i as usize][0][k] / 2.0 + boxes[i as usize][1][k] / 2.0;
        let spread = |k: usize| {
            let ends = order.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &i| {
                (low.min(middle(i, k)), high.max(middle(i, k)))
            });
            ends.1 - ends.0
        };
        let spreads = [0, 1, 2].map(spread);
        let axis = (0..3).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b])).unwrap_or(0);
        let half = order.len() / 2;
        let by_middle = |a: &u32, b: &u32| -> Ordering {
            middle(*a, axis).total_cmp(&middle(*b, axis)).then(a.cmp(b))
        };
        order.select_nth_unstable_by(half, by_middle);
        let (low, high) = order.split_at_mut(half);
        grow(nodes, boxes, low, start);
        grow(nodes, boxes, high, start + half as u32);
    }
    nodes[node].next = nodes.len() as u32;
}

fn union(a: Bounds, b: Bounds) -> Bounds {
    let by = |i: usize, f: fn(f64, f64) -> f64| [0, 1, 2].map(|k| f(a[i][k], b[i][k]));
    [by(0, f64::min), by(1, f64::max)]
}
