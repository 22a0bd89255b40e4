use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cut::{Bin, Budget, Cut, Dropped, EXPONENT, INFINITY, Spent, magnitude};

/// Finds the cut of [`Cut::new`] for values that are never in memory together. It takes rounds of [counting](Self::count), piece
/// by piece; the joined counts go to [`Search::learn`].
///
/// Values are ordered by their magnitude, equal ones by descending index, as one number of 63 + 64 bits. A round counts the
/// values that agree with the known digits by the next digit; when few are left they are listed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Search {
    spent: Spent,
    /// Fewer values than this are listed and not counted.
    list_below: u64,
    state: State,
}

/// The digits of the cut found so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum State {
    /// The bits of the magnitude at the cut, above `shift`, are known.
    Magnitude {
        prefix: u64,
        shift: u32,
    },
    /// The magnitude is known, and so is the number of its values that stay; of the first index that is dropped, the bits above
    /// `shift` are known.
    Index {
        magnitude: u64,
        stay: u64,
        prefix: u64,
        shift: u32,
    },
    /// Few values are left that agree with these bits of the magnitude.
    List {
        prefix: u64,
        shift: u32,
    },
    Found(Cut),
}

/// The number of bits decided in one round.
const DIGIT: u32 = 18;
/// The number of bits of a magnitude.
const MAGNITUDE: u32 = 63;

/// The counts of a part of the values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// The bins by digit.
    bins: BTreeMap<u64, Bin>,
    /// The magnitude and index of each value, if few are left.
    list: Vec<(u64, u64)>,
}

impl Counts {
    /// The number of values counted.
    pub fn total(&self) -> u64 {
        self.bins.values().map(|bin| bin.count).sum::<u64>() + self.list.len() as u64
    }

    /// In a first round, the number of values of magnitude 0, or so small that they are subnormal.
    pub fn zeros(&self) -> u64 {
        self.bins.get(&0).map_or(0, |bin| bin.count)
    }

    /// Adds the counts of another part.
    pub fn join(&mut self, other: Self) {
        for (digit, bin) in other.bins {
            self.bins.entry(digit).or_default().join(&bin);
        }
        self.list.extend(other.list);
    }
}

impl Search {
    /// Starts the search for the cut that drops as many values as the budget allows. If at most `list_below` values are left,
    /// they are listed, with 16 bytes each.
    pub fn new(budget: Budget, list_below: u64) -> Self {
        let state = State::Magnitude { prefix: 0, shift: MAGNITUDE };
        Self { spent: Spent::of(budget), list_below, state }
    }

    /// Finds the cut, and returns it with what it drops. `round` counts all values.
    ///
    /// # Errors
    /// Errors of `round`.
    pub fn find<E>(
        mut self,
        mut round: impl FnMut(&Self) -> Result<Counts, E>,
    ) -> Result<(Cut, Dropped), E> {
        loop {
            if let Some(found) = self.found() {
                return Ok(found);
            }
            let counts = round(&self)?;
            self.learn(counts);
        }
    }

    /// The cut and what it drops, once it is found.
    pub fn found(&self) -> Option<(Cut, Dropped)> {
        match self.state {
            State::Found(cut) => Some((cut, self.spent.dropped())),
            _ => None,
        }
    }

    /// Counts values, each with its index, for the current round. NaN is ignored. O(n).
    pub fn count(&self, values: impl Iterator<Item = (f64, u64)>) -> Counts {
        let mut counts = Counts::default();
        let values = values.map(|(value, index)| (magnitude(value), index));
        let values = values.filter(|&(bits, _)| bits < INFINITY);
        match self.state {
            State::Magnitude { prefix, shift } => {
                let next = shift.saturating_sub(DIGIT);
                let mut dense = vec![Bin::default(); 1 << (shift - next)];
                let mask = dense.len() as u64 - 1;
                for (bits, _) in values.filter(|(bits, _)| agrees(*bits, prefix, shift)) {
                    dense[(bits >> next & mask) as usize].add(bits);
                }
                let there = (0..).zip(dense).filter(|(_, bin)| bin.count > 0);
                counts.bins = there.collect();
            }
            State::Index { magnitude, prefix, shift, .. } => {
                let next = shift.saturating_sub(DIGIT);
                for (_, index) in values
                    .filter(|&(bits, index)| bits == magnitude && agrees(index, prefix, shift))
                {
                    let digit = index >> next & ((1 << (shift - next)) - 1);
                    counts.bins.entry(digit).or_default().count += 1;
                }
            }
            State::List { prefix, shift } => {
                counts.list = values.filter(|(bits, _)| agrees(*bits, prefix, shift)).collect();
            }
            State::Found(_) => {}
        }
        counts
    }

    /// Continues with the next round, given the joined counts of all pieces.
    pub fn learn(&mut self, counts: Counts) {
        self.state = match self.state {
            State::Magnitude { prefix, shift } => self.by_magnitude(counts, prefix, shift),
            State::Index { magnitude, stay, prefix, shift } => {
                by_index(counts, magnitude, stay, prefix, shift)
            }
            State::List { prefix, shift } => self.by_list(counts.list, prefix, shift),
            found @ State::Found(_) => found,
        }
    }

    fn by_magnitude(&mut self, counts: Counts, prefix: u64, shift: u32) -> State {
        let next = shift.saturating_sub(DIGIT);
        for (digit, bin) in counts.bins {
            let here = prefix | digit << next;
            if next == 0 {
                if let Some(state) = self.ties(here, bin.count) {
                    return state;
                }
            } else if !self.spent.take(&bin, here >> EXPONENT) {
                let list_below = bin.count <= self.list_below;
                return if list_below {
                    State::List { prefix: here, shift: next }
                } else {
                    State::Magnitude { prefix: here, shift: next }
                };
            }
        }
        above(prefix, shift)
    }

    fn by_list(&mut self, mut list: Vec<(u64, u64)>, prefix: u64, shift: u32) -> State {
        list.sort_unstable();
        for equal in list.chunk_by(|a, b| a.0 == b.0) {
            let (magnitude, count) = (equal[0].0, equal.len() as u64);
            let stay = count - self.spent.equal(magnitude, count);
            if stay > 0 {
                let ties_end = if stay == count { u64::MAX } else { equal[stay as usize].1 };
                return State::Found(Cut { magnitude, ties_end });
            }
        }
        above(prefix, shift)
    }

    /// Drops as many of the values of equal magnitude as possible; `None` if all are dropped.
    fn ties(&mut self, magnitude: u64, count: u64) -> Option<State> {
        let stay = count - self.spent.equal(magnitude, count);
        match stay {
            0 => None,
            _ if stay == count => Some(State::Found(Cut { magnitude, ties_end: u64::MAX })),
            _ => Some(State::Index { magnitude, stay, prefix: 0, shift: 64 }),
        }
    }
}

/// The cut above all values that agree with these bits.
fn above(prefix: u64, shift: u32) -> State {
    State::Found(Cut { magnitude: prefix | ((1 << shift) - 1), ties_end: 0 })
}

fn by_index(counts: Counts, magnitude: u64, mut stay: u64, prefix: u64, shift: u32) -> State {
    let next = shift.saturating_sub(DIGIT);
    for (digit, bin) in counts.bins {
        // The first dropped value is the one behind those that stay.
        if stay < bin.count {
            let prefix = prefix | digit << next;
            return match next {
                0 => State::Found(Cut { magnitude, ties_end: prefix }),
                shift => State::Index { magnitude, stay, prefix, shift },
            };
        }
        stay -= bin.count;
    }
    unreachable!("fewer stay than there are")
}

/// Whether the bits from `shift` on equal those of `prefix`.
#[inline(always)]
fn agrees(bits: u64, prefix: u64, shift: u32) -> bool {
    shift >= 63 && prefix == 0 || (bits ^ prefix) >> shift == 0
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    /// Searches over pieces of the values, in as many rounds as necessary.
    fn searched(values: &[f64], budget: Budget, list_below: u64) -> (Cut, Dropped) {
        let mut search = Search::new(budget, list_below);
        for _ in 0..20 {
            if let Some(found) = search.found() {
                return found;
            }
            let mut counts = Counts::default();
            let indexed: Vec<(f64, u64)> = values.iter().copied().zip(0..).collect();
            for piece in indexed.chunks(7) {
                let text = serde_json::to_string(&search.count(piece.iter().copied())).unwrap();
                counts.join(serde_json::from_str(&text).unwrap());
            }
            search.learn(counts);
        }
        panic!("no end")
    }

    #[test]
    fn pieces_are_cut_as_the_whole_is() {
        let mut random = Random::new(7);
        let reals: Vec<f64> = (0..200).map(|_| random.below(1 << 30) as f64 / 7.0).collect();
        let ties: Vec<f64> = (0..200).map(|_| random.below(5) as f64 - 2.0).collect();
        let masked: Vec<f64> = reals.iter().map(|&v| if v < 5e7 { f64::NAN } else { -v }).collect();
        for values in [&reals, &ties, &masked, &vec![0.1; 60], &vec![0.0; 9], &vec![]] {
            let all = values.iter().filter(|v| !v.is_nan());
            let energy: f64 = all.clone().map(|v| v * v).sum();
            let count = all.count() as u64;
            let counts = [0, 1, count / 3, count.saturating_sub(1), count].map(Budget::Count);
            let energies = [0.0, 1e-9, 0.3, 0.9, 1.0, 2.0].map(|k| Budget::Energy(k * energy));
            for budget in counts.into_iter().chain(energies) {
                let (whole, dropped) = Cut::new(values, budget);
                for list_below in [0, 10, 1000] {
                    let (cut, also_dropped) = searched(values, budget, list_below);
                    let kept = |cut: Cut| -> Vec<bool> {
                        values.iter().zip(0..).map(|(&v, i)| cut.keeps(v, i)).collect()
                    };
                    assert_eq!(kept(cut), kept(whole), "{budget:?} {list_below}");
                    assert_eq!(also_dropped, dropped, "{budget:?} {list_below}");
                }
            }
        }
    }
}
