//! What hangs together on a torus, and how it goes round.

use std::collections::BTreeMap;

/// By how many sides of the box something is moved along each axis.
pub(crate) type Winding = [i32; 3];

/// Directions that are independent of each other: at most three.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directions(Vec<Winding>);

impl Directions {
    /// How many there are.
    pub fn rank(&self) -> usize {
        self.0.len()
    }

    /// Adds a direction if it is independent of those that are there; says whether it was.
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

    /// Adds all of others.
    pub fn extend(&mut self, others: &Self) {
        others.0.iter().for_each(|&way| _ = self.add(way));
    }

    /// Whether one of them has a part along an axis.
    pub fn has(&self, axis: usize) -> bool {
        self.0.iter().any(|way| way[axis] != 0)
    }
}

fn cross(a: Winding, b: Winding) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Disjoint sets of things on a torus, each united with others at some of their copies. A set whose
/// members can be laid out in space so that all meet is like one of space; else there are ways through
/// it that end at another copy of where they began: it goes round.
pub struct WindingSets {
    /// Of each member another one of its set, and by how many sides it is moved against that.
    parents: Vec<(u32, Winding)>,
    /// By root, the directions in which a set goes round, if it does.
    rounds: BTreeMap<u32, Directions>,
}

impl WindingSets {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        Self { parents: (0..n as u32).map(|v| (v, [0; 3])).collect(), rounds: BTreeMap::new() }
    }

    /// The smallest member of the set that holds `member`, and by how many sides `member` is moved
    /// where that is not.
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

    /// Makes one set of two, in which `b` moved by so many sides meets `a`. Says whether they were two, or
    /// else, which new direction this goes round in, if it is one.
    pub fn unite(&mut self, a: u32, b: u32, moved: Winding) -> United {
        let ((root, to_a), (other, to_b)) = (self.find(a), self.find(b));
        // How the root of b is moved where that of a is not.
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

    /// The directions in which the set of a root goes round, if it does.
    pub fn rounds(&self, root: u32) -> Option<&Directions> {
        self.rounds.get(&root)
    }

    /// The directions in which all sets together go round.
    pub fn directions(&self) -> Directions {
        let mut all = Directions::default();
        self.rounds.values().for_each(|directions| all.extend(directions));
        all
    }
}

/// What two members of [`WindingSets`] were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum United {
    /// Members of two sets, which are one now.
    Two,
    /// Of one set, and the way between them shows that it goes round in a new direction.
    Round(Winding),
    /// Of one set, and nothing new is known of it.
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
