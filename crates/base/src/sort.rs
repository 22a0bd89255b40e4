//! Sorting by code that is compiled once.
//!
//! The standard library's is compiled for each type and each order anew, ten thousand bytes of machine code each time: a fifth of a crate that
//! sorts in many places. What is sorted here comes in hundreds or thousands rather than millions.

use std::cmp::Ordering;

/// Sorts items by what a comparison says. Equal items stay in their order.
///
/// As `slice::sort_by`, but the comparison is behind a pointer, so it takes a few times longer.
pub fn sort_by<T>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let order = order(items.len(), &|i, j| compare(&items[i], &items[j]));
    arrange(items, order);
}

/// Sorts items by a key. Equal items stay in their order. As `slice::sort_by_key`; see [`sort_by`].
pub fn sort_by_key<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    sort_by(items, |a, b| key(a).cmp(&key(b)));
}

/// Sorts a handful of items by what a comparison says: puts one after the other in its place. Equal items stay in their order. O(n²).
#[inline]
pub fn sort_handful_by<T>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    for end in 1..items.len() {
        let mut at = end;
        while at > 0 && compare(&items[at - 1], &items[at]).is_gt() {
            items.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// The places of `count` items in the order that a comparison of two places gives.
fn order(count: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| compare(i, j));
    order
}

/// Moves the item at the place `order[i]` to the place `i`, for each `i`.
fn arrange<T>(items: &mut [T], mut order: Vec<usize>) {
    for start in 0..items.len() {
        let mut at = start;
        while order[at] != start {
            let from = order[at];
            items.swap(at, from);
            order[at] = at;
            at = from;
        }
        order[at] = at;
    }
}

#[cfg(test)]
mod tests {
    use std::cmp::Reverse;

    use super::*;
    use crate::random::Random;

    #[test]
    fn orders_are_those_of_the_standard_library() {
        let mut random = Random::new(7);
        for count in (0..20).chain([100, 1000]) {
            let items: Vec<(usize, String)> =
                (0..count).map(|i| (random.below(count / 2 + 1), i.to_string())).collect();
            let mut expected = items.clone();
            expected.sort_by_key(|item| Reverse(item.0));
            let mut sorted = items.clone();
            sort_by_key(&mut sorted, |item| Reverse(item.0));
            assert_eq!(sorted, expected);
            let mut sorted = items;
            sort_handful_by(&mut sorted, |a, b| b.0.cmp(&a.0));
            assert_eq!(sorted, expected);
        }
    }
}
