//! Connected sets on a torus, and the directions in which they wind round it.

use std::collections::BTreeMap;

use walpha_regular::Torus;

/// A translation by multiples of the vectors of the box.
pub(crate) type Winding = [i32; 3];

/// Linearly independent directions, at most three.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directions(Vec<Winding>);

impl Directions {
    /// The number of directions.
    pub fn rank(&self) -> usize {
        self.0.len()
    }

    /// Adds a direction if it is independent of the others; returns whether it is.
    pub fn add(&mut self, way: Winding) -> bool {
        let independent = match self.0[..] {
            [] => way != [0; 3],
            [a] => cross(a, way) != [0; 3],
            [a, b] => {
                let normal = cross(a, b);
                (0..3).map(|k| normal[k] * i128::from(way[k])).sum::<i128>() != 0
            }
            _ => false,
        };
        if independent {
            self.0.push(way);
        }
        independent
    }

    /// Adds the independent ones of other directions.
    pub fn extend(&mut self, others: &Self) {
        others.0.iter().for_each(|&way| _ = self.add(way));
    }

    /// For each vector of the box, whether one of them leads along it.
    pub fn along(&self) -> [bool; 3] {
        [0, 1, 2].map(|k| self.0.iter().any(|way| way[k] != 0))
    }

    /// Whether one of them leads along an axis of space.
    pub fn have(&self, axis: usize, torus: Torus) -> bool {
        self.0.iter().any(|&way| torus.moved([0.0; 3], way)[axis] != 0.0)
    }
}

fn cross(a: Winding, b: Winding) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A union-find over objects on a torus, which are united at given copies. If the members of a set can be laid out in
/// space so that all unions hold, the set is as in space. Otherwise some closed paths through the set end at
/// another copy of their start: the set winds round the torus.
#[derive(Debug)]
pub struct WindingSets {
    /// For each member, its parent, and its winding relative to the parent.
    parents: Vec<(u32, Winding)>,
    /// For each root, the directions in which its set winds round, if it does.
    rounds: BTreeMap<u32, Directions>,
}

impl WindingSets {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        Self { parents: (0..n as u32).map(|v| (v, [0; 3])).collect(), rounds: BTreeMap::new() }
    }

    /// Sets of one member each, and one more for what is outside of the points of a torus that does not repeat along all vectors. Around such
    /// points there is room: they lie in a torus that repeats along three, with vectors of any length in place of those along which they do
    /// not repeat, and what is outside is the gap between their copies. Around a slab the gap winds round along its two vectors, around a rod
    /// or a body along all three. Where there is no gap, nothing is united with the last set.
    pub(crate) fn with_outside(members: usize, torus: Torus) -> Self {
        let mut sets = Self::new(members + 1);
        let outside = members as u32;
        for (k, repeats) in torus.repeats().into_iter().enumerate() {
            let winds = match torus.dimension() {
                3 => false,
                2 => repeats,
                _ => true,
            };
            if winds {
                let mut way = [0; 3];
                way[k] = 1;
                sets.unite(outside, outside, way);
            }
        }
        sets
    }

    /// The smallest member of the set of `member`, and the winding of `member` relative to it.
    pub fn find(&mut self, member: u32) -> (u32, Winding) {
        let mut at = member;
        let mut moved = [0; 3];
        loop {
            let (parent, way) = self.parents[at as usize];
            if parent == at {
                return (at, moved);
            }
            let (grandparent, further) = self.parents[parent as usize];
            let both = plus(way, further);
            self.parents[at as usize] = (grandparent, both);
            moved = plus(moved, both);
            at = grandparent;
        }
    }

    /// Unites the sets of `a` and `b`, where `b`, moved by `moved`, meets `a`. Returns whether they were two sets, or otherwise
    /// the new direction in which their set winds round, if there is one.
    pub fn unite(&mut self, a: u32, b: u32, moved: Winding) -> United {
        let ((root, to_a), (other, to_b)) = (self.find(a), self.find(b));
        // The winding of the root of b relative to that of a.
        let way = minus(plus(to_a, moved), to_b);
        if root == other {
            let is_new = way != [0; 3] && self.rounds.entry(root).or_default().add(way);
            return if is_new { United::Round(way) } else { United::Already };
        }
        let (low, high) = (root.min(other), root.max(other));
        let way = if low == root { way } else { minus([0; 3], way) };
        self.parents[high as usize] = (low, way);
        if let Some(directions) = self.rounds.remove(&high) {
            self.rounds.entry(low).or_default().extend(&directions);
        }
        United::Two
    }

    /// The directions in which the set of a root winds round, if it does.
    pub fn rounds(&self, root: u32) -> Option<&Directions> {
        self.rounds.get(&root)
    }

    /// The number of sets that wind round.
    pub fn winding_sets(&self) -> usize {
        self.rounds.len()
    }

    /// The directions in which all sets together wind round.
    pub fn directions(&self) -> Directions {
        let mut all = Directions::default();
        self.rounds.values().for_each(|directions| all.extend(directions));
        all
    }
}

/// The result of uniting two members of [`WindingSets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum United {
    /// They were in two sets, which are now one.
    Two,
    /// They were in one set, which is now known to wind round in a new direction.
    Round(Winding),
    /// They were in one set, and the union adds nothing.
    Already,
}

pub(crate) fn plus(a: Winding, b: Winding) -> Winding {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub(crate) fn minus(a: Winding, b: Winding) -> Winding {
    [0, 1, 2].map(|k| a[k] - b[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_add_up() {
        let mut sets = WindingSets::new(4);
        assert_eq!(sets.unite(2, 3, [1, 0, 0]), United::Two);
        assert_eq!(sets.unite(1, 3, [0, 2, 0]), United::Two);
        assert_eq!(sets.unite(0, 2, [0, 0, -1]), United::Two);
        // 0 at 0, 2 at (0, 0, −1), 3 at (1, 0, −1), 1 at (1, −2, −1).
        assert_eq!(sets.find(1), (0, [1, -2, -1]));
        assert_eq!(sets.find(3), (0, [1, 0, -1]));
        assert_eq!(sets.unite(1, 0, [-1, 2, 1]), United::Already);
        assert_eq!(sets.unite(1, 0, [-1, 2, 0]), United::Round([0, 0, -1]));
        assert_eq!(sets.unite(0, 1, [1, -2, 5]), United::Already);
        assert_eq!(sets.directions().rank(), 1);
    }

    #[test]
    fn directions_are_counted_up_to_three() {
        let mut directions = Directions::default();
        assert!(
            !directions.add([0; 3]) && directions.add([2, 0, 2]) && !directions.add([-1, 0, -1])
        );
        assert!(
            directions.add([0, 1, 0]) && !directions.add([3, 5, 3]) && directions.add([0, 0, 1])
        );
        assert!(!directions.add([7, 8, 9]));
        assert_eq!(directions.rank(), 3);
    }

    #[test]
    fn sets_keep_their_rounds_when_united() {
        let mut sets = WindingSets::new(3);
        sets.unite(1, 1, [1, 0, 0]);
        sets.unite(2, 2, [0, 1, 0]);
        sets.unite(1, 2, [0; 3]);
        sets.unite(0, 2, [0, 0, 4]);
        assert_eq!(sets.rounds(0).map(Directions::rank), Some(2));
        assert!(sets.rounds(1).is_none());
    }
}
