use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Disjoint sets over `0..n`, which several threads may unite at once. A set is a tree, compressed by path halving. Its root is
/// its smallest member, whatever the order of unions (Anderson and Woll 1991, doi:10.1145/103418.103458).
pub struct UnionFind {
    parent: Vec<AtomicU32>,
}

// A member's parent is never larger than the member, and is only ever replaced by another of its ancestors. Only a root gets a
// parent that was not an ancestor, by an exchange that fails if it is no longer a root. No other memory depends on the order in
// which threads see these changes, so all of them are relaxed.
impl UnionFind {
    /// Creates `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).map(AtomicU32::new).collect() }
    }

    /// The number of members of all sets together.
    pub fn members(&self) -> usize {
        self.parent.len()
    }

    fn parent(&self, member: u32) -> u32 {
        self.parent[member as usize].load(Relaxed)
    }

    /// The smallest member of the set that contains `member`.
    pub fn find(&self, mut member: u32) -> u32 {
        let mut parent = self.parent(member);
        while parent != member {
            let grandparent = self.parent(parent);
            if grandparent == parent {
                return parent;
            }
            self.parent[member as usize].store(grandparent, Relaxed);
            member = grandparent;
            parent = self.parent(member);
        }
        member
    }

    /// Unites two sets. Returns whether they were different.
    pub fn unite(&self, a: u32, b: u32) -> bool {
        let (mut a, mut b) = (self.find(a), self.find(b));
        while a != b {
            let (low, high) = (a.min(b), a.max(b));
            if self.parent[high as usize].compare_exchange(high, low, Relaxed, Relaxed).is_ok() {
                return true;
            }
            (a, b) = (self.find(low), self.find(high));
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two threads unite rows of a grid of 64 × 64 members, and columns of it, in opposite orders.
    #[test]
    fn threads_unite_the_same_sets() {
        for _ in 0..50 {
            let sets = UnionFind::new(1 << 12);
            let unite = |members: &mut dyn Iterator<Item = u32>, step: u32| {
                members.filter(|member| sets.unite(*member, member + step)).count()
            };
            let joined = std::thread::scope(|scope| {
                let rows = scope.spawn(|| unite(&mut (0..1 << 12).filter(|i| i % 64 != 63), 1));
                let columns = scope.spawn(|| unite(&mut (0..63 << 6).rev(), 64));
                rows.join().expect("no panic") + columns.join().expect("no panic")
            });
            assert_eq!(joined, (1 << 12) - 1);
            assert!((0..1 << 12).all(|member| sets.find(member) == 0));
        }
    }
}
