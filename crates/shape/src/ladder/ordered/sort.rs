//! Simplices in order of their ranks.

use rayon::prelude::*;

/// How many parts of the ranks are put in order each by itself: few enough to write to all at once.
const PARTS: usize = 256;
/// How many numbers are handed out to parts at once.
const CHUNK: usize = 1 << 20;

/// The numbers from 0 on by rank, and of one rank as they are. There are so many ranks; each number has
/// one below.
///
/// Counted twice: to parts of successive ranks, and within each, where counters fit a cache. O(n).
pub(super) fn by_rank(all: usize, ranks: usize, rank: impl Fn(u32) -> u32 + Sync) -> Vec<u32> {
    let shift = ranks.div_ceil(PARTS).next_power_of_two().ilog2();
    let hand_out = |from: usize| {
        let to = all.min(from + CHUNK);
        let room = (to - from) / PARTS;
        let mut parts: Vec<_> = (0..PARTS).map(|_| Vec::with_capacity(room)).collect();
        for simplex in from as u32..to as u32 {
            let rank = rank(simplex);
            parts[(rank >> shift) as usize].push([rank, simplex]);
        }
        parts
    };
    let chunks: Vec<usize> = (0..all).step_by(CHUNK).collect();
    let chunks: Vec<Vec<Vec<[u32; 2]>>> = chunks.into_par_iter().map(hand_out).collect();
    let mut order = vec![0; all];
    let mut rest = &mut order[..];
    let mut parts = Vec::with_capacity(PARTS);
    for part in 0..PARTS {
        let size = chunks.iter().map(|chunk| chunk[part].len()).sum();
        let (here, after) = std::mem::take(&mut rest).split_at_mut(size);
        parts.push(here);
        rest = after;
    }
    parts.into_par_iter().enumerate().for_each(|(part, order)| {
        let members = || chunks.iter().flat_map(|chunk| &chunk[part]);
        let place = |rank: u32| rank as usize - (part << shift);
        let mut next = vec![0_usize; (1 << shift) + 1];
        members().for_each(|&[rank, _]| next[place(rank) + 1] += 1);
        for rank in 1..next.len() {
            next[rank] += next[rank - 1];
        }
        for &[rank, simplex] in members() {
            let next = &mut next[place(rank)];
            order[*next] = simplex;
            *next += 1;
        }
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_a_stable_sort_has_it() {
        for (all, ranks) in
            [(0, 0), (1, 1), (1000, 3), (1000, 256), (5000, 1000), (CHUNK + 9, 70_000)]
        {
            let rank = |simplex: u32| (simplex.wrapping_mul(2_654_435_761) >> 7) % ranks as u32;
            let mut wanted: Vec<u32> = (0..all as u32).collect();
            wanted.sort_by_key(|&simplex| rank(simplex));
            assert!(by_rank(all, ranks, rank) == wanted, "{all} numbers of {ranks} ranks");
        }
    }
}
