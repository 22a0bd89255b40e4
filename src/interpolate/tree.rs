use std::cmp::Ordering;

/// Boxes in a binary tree, to find those that hold a place.
///
/// Nodes are in preorder, each with the node that follows its whole subtree, so that a search
/// needs no stack. Memory: a node for every two boxes or so.
#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The boxes' numbers, those of a leaf side by side.
    order: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    /// The node after this one's subtree.
    next: u32,
    /// The range of its boxes in the order, if it is a leaf.
    leaf: Option<(u32, u32)>,
}

/// Low and high corners.
pub(super) type Bounds = [[f64; 3]; 2];

/// Boxes of a leaf, at most.
const LEAF: usize = 4;

impl Tree {
    /// Halves the boxes by their middles along the axis in which these are farthest apart, again
    /// and again. O(n log n).
    pub(super) fn new(boxes: &[Bounds]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        if !order.is_empty() {
            grow(&mut nodes, boxes, &mut order, 0);
        }
        Self { nodes, order }
    }

    /// The least number for which `holds`, among the boxes that hold a place.
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
