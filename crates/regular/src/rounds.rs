//! In what order points are inserted, whoever inserts them: a biased randomized insertion order
//! (Amenta, Choi and Rote 2003, doi:10.1145/777792.777824).

/// The numbers 0..n in rounds, each a few times as large as all before it, ascending within each.
pub(super) fn rounds(n: u32) -> impl Iterator<Item = u32> {
    // Below this many points a round is not worth its walks.
    let last = n.checked_ilog2().unwrap_or(0).saturating_sub(10) / ROUND;
    (0..=last).rev().flat_map(move |round| (0..n).filter(move |&v| late(v).min(last) == round))
}

/// The logarithm of how many times as many points there are after a round as before it.
const ROUND: u32 = 2;

/// A round for a point, the last being 0, each more probable than the one before by this factor: zeros that its
/// scrambled number ends with.
fn late(v: u32) -> u32 {
    let v = (v ^ v >> 16).wrapping_mul(0x45d9_f3b5);
    let v = (v ^ v >> 16).wrapping_mul(0x45d9_f3b5);
    (v ^ v >> 16).trailing_zeros() / ROUND
}
