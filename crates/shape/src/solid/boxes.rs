//! The triangles near a place.

type Box3 = [[f64; 3]; 2];

/// A tree of boxes: the two halves of a range of items have the boxes at 2·node + 1 and 2·node + 2.
pub(super) struct Boxes {
    items: Vec<(Box3, u32)>,
    nodes: Vec<Box3>,
}

/// Items of a leaf.
const LEAF: usize = 8;

impl Boxes {
    /// O(n log n).
    pub(super) fn new(boxes: impl Iterator<Item = Box3>) -> Self {
        let items = boxes.zip(0..).collect();
        let mut tree = Self { items, nodes: Vec::new() };
        tree.build(0, 0, tree.items.len());
        tree
    }

    fn build(&mut self, node: usize, first: usize, end: usize) {
        let whole = self.items[first..end].iter().fold(EMPTY, |all, item| union(all, item.0));
        if self.nodes.len() <= node {
            self.nodes.resize(node + 1, EMPTY);
        }
        self.nodes[node] = whole;
        if end - first > LEAF {
            let extent = [0, 1, 2].map(|k| whole[1][k] - whole[0][k]);
            let axis = (0..3).max_by(|&i, &j| extent[i].total_cmp(&extent[j])).unwrap_or(0);
            let middle = (end - first) / 2;
            self.items[first..end].select_nth_unstable_by(middle, |a, b| {
                a.0[0][axis].total_cmp(&b.0[0][axis]).then(a.1.cmp(&b.1))
            });
            self.build(2 * node + 1, first, first + middle);
            self.build(2 * node + 2, first + middle, end);
        }
    }

    /// The items whose boxes meet a box, ascending.
    pub(super) fn near(&self, place: Box3) -> Vec<u32> {
        let mut found = Vec::new();
        let mut open = vec![(0, 0, self.items.len())];
        while let Some((node, first, end)) = open.pop() {
            if !meet(self.nodes[node], place) {
                continue;
            }
            if end - first > LEAF {
                let middle = first + (end - first) / 2;
                open.extend([(2 * node + 1, first, middle), (2 * node + 2, middle, end)]);
            } else {
                let items = self.items[first..end].iter();
                found.extend(items.filter(|item| meet(item.0, place)).map(|item| item.1));
            }
        }
        found.sort_unstable();
        found
    }
}

const EMPTY: Box3 = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// The box of some points.
pub(super) fn bounds(points: impl IntoIterator<Item = [f64; 3]>) -> Box3 {
    points.into_iter().fold(EMPTY, |all, point| union(all, [point; 2]))
}

fn union(a: Box3, b: Box3) -> Box3 {
    [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
}

fn meet(a: Box3, b: Box3) -> bool {
    (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_is_found() {
        let at = |i: u32| [i % 10, i / 10 % 10, i / 100].map(f64::from);
        let boxes: Vec<Box3> = (0..1000).map(|i| [at(i), at(i).map(|x| x + 0.5)]).collect();
        let tree = Boxes::new(boxes.iter().copied());
        for place in [[[2.2; 3], [4.4; 3]], [[-1.0; 3], [0.0; 3]], [[0.6; 3], [0.9; 3]]] {
            let wanted: Vec<u32> = (0..1000).filter(|&i| meet(boxes[i as usize], place)).collect();
            assert_eq!(tree.near(place), wanted);
        }
        assert!(Boxes::new(std::iter::empty()).near([[0.0; 3], [1.0; 3]]).is_empty());
    }
}
