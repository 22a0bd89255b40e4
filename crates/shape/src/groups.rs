//! Items grouped by the vertices that they belong to, on all threads.

use walpha_base::parallel::FEW;
use walpha_base::parallel::prelude::*;

/// The number of vertices whose items one thread sorts at a time: they fit its cache.
pub(crate) const RANGE: usize = 1 << 12;

/// The maximum number of chunks of items that are distributed in parallel.
const CHUNKS: usize = 64;

/// The number of items in a chunk, if there are so many in all.
pub(crate) fn chunk_length(items: usize) -> usize {
    items.div_ceil(CHUNKS).max(FEW)
}

/// Sorts the items of all chunks, each with the number of its range, by range, and in the order in which they come within a
/// range. Also returns the start of each range, and the end of the last one. `of` is called up to twice for each chunk.
pub(crate) fn by_range<T: Copy + Default + Send, I: Iterator<Item = (T, usize)>>(
    chunks: usize,
    ranges: usize,
    of: impl Fn(usize) -> I + Sync,
) -> (Vec<T>, Vec<usize>) {
    if (chunks, ranges) == (1, 1) {
        let items: Vec<T> = of(0).map(|(item, _)| item).collect();
        let starts = vec![0, items.len()];
        return (items, starts);
    }
    let count = |chunk| {
        let mut counts = vec![0; ranges];
        of(chunk).for_each(|(_, range)| counts[range] += 1);
        counts
    };
    let counts: Vec<Vec<usize>> = (0..chunks).into_par_iter().map(count).collect();
    let mut starts = vec![0; ranges + 1];
    for range in 0..ranges {
        let count: usize = counts.iter().map(|counts| counts[range]).sum();
        starts[range + 1] = starts[range] + count;
    }
    let mut items = vec![T::default(); starts[ranges]];
    let mut rest = &mut items[..];
    let mut parts: Vec<Vec<_>> = (0..chunks).map(|_| Vec::with_capacity(ranges)).collect();
    for range in 0..ranges {
        for (parts, counts) in parts.iter_mut().zip(&counts) {
            let part = rest.split_off_mut(..counts[range]).expect("as many as were counted");
            parts.push(part.iter_mut());
        }
    }
    parts.into_par_iter().enumerate().for_each(|(chunk, mut parts)| {
        for (item, range) in of(chunk) {
            *parts[range].next().expect("as many as were counted") = item;
        }
    });
    (items, starts)
}

/// Items, each of which belongs to a vertex or to none, grouped by vertex.
pub(crate) struct Groups {
    items: Vec<u32>,
    /// The start of the items of each vertex, and the end.
    starts: Vec<u32>,
}

impl Groups {
    /// Groups the items from 0 to `items`, given the vertex of each. O(items).
    pub(crate) fn new(
        items: usize,
        vertices: usize,
        vertex: impl Fn(u32) -> Option<u32> + Sync,
    ) -> Self {
        let length = chunk_length(items);
        let near = |chunk: usize| {
            let items = chunk * length..((chunk + 1) * length).min(items);
            let pair = |item: u32| {
                let vertex = vertex(item)?;
                Some(([vertex, item], vertex as usize / RANGE))
            };
            items.filter_map(move |item| pair(item as u32))
        };
        let ranges = vertices.div_ceil(RANGE);
        let (pairs, of_ranges) = by_range(items.div_ceil(length), ranges, near);
        let mut items = vec![0; pairs.len()];
        let mut starts = vec![pairs.len() as u32; vertices + 1];
        let mut rest = &mut items[..];
        let parts: Vec<_> = (of_ranges.windows(2).zip(starts[..vertices].chunks_mut(RANGE)))
            .map(|(ends, starts)| {
                let part = rest.split_off_mut(..ends[1] - ends[0]).expect("as many as pairs");
                (ends[0], &pairs[ends[0]..ends[1]], part, starts)
            })
            .collect();
        parts.into_par_iter().enumerate().for_each(|(range, (start, pairs, items, starts))| {
            let of = |vertex: u32| vertex as usize - range * RANGE;
            starts.fill(0);
            pairs.iter().for_each(|&[vertex, _]| starts[of(vertex)] += 1);
            let mut end = start as u32;
            for start in &mut *starts {
                end += *start;
                *start = end;
            }
            // From the last to the first, the ends become starts.
            for &[vertex, item] in pairs.iter().rev() {
                let at = &mut starts[of(vertex)];
                *at -= 1;
                items[*at as usize - start] = item;
            }
        });
        Self { items, starts }
    }

    /// The number of items that belong to a vertex.
    pub(crate) fn len(&self) -> usize {
        self.items.len()
    }

    /// The items of a vertex, ascending.
    #[inline]
    pub(crate) fn of(&self, vertex: u32) -> &[u32] {
        let at = vertex as usize;
        &self.items[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// The start of the items of each point, and the end, if they are in the order of points; `input` has the point of each vertex.
    pub(crate) fn rows(&self, input: &[u32], points: usize) -> Vec<u32> {
        first_rows(input, points, self.starts.windows(2).map(|ends| ends[1] - ends[0]))
    }
}

/// The start of the rows of each point, and the end, given the numbers of rows of its vertices, the points of which are `input`.
pub(crate) fn first_rows(
    input: &[u32],
    points: usize,
    counts: impl Iterator<Item = u32>,
) -> Vec<u32> {
    let mut rows = vec![0; points + 1];
    for (&point, count) in input.iter().zip(counts) {
        rows[point as usize + 1] = count;
    }
    for point in 0..points {
        rows[point + 1] += rows[point];
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_grouped() {
        let vertices = 2 * RANGE + 17;
        let vertex = |item: u32| {
            let hash = item.wrapping_mul(0x9e37_79b1) >> 8;
            (!hash.is_multiple_of(5)).then_some(hash % vertices as u32)
        };
        for items in [0, 3, 5 * FEW, 70 * FEW + 1] {
            let groups = Groups::new(items, vertices, vertex);
            let mut expected = vec![Vec::new(); vertices];
            for item in 0..items as u32 {
                expected[vertex(item).map_or(0, |v| v as usize)].extend(vertex(item).map(|_| item));
            }
            assert_eq!(groups.len(), expected.iter().map(Vec::len).sum::<usize>());
            for (v, expected) in (0..).zip(&expected) {
                assert_eq!(groups.of(v), expected);
            }
            // Vertices from the last point to the first, every other point being none.
            let input: Vec<u32> = (0..vertices as u32).rev().map(|v| 2 * v + 1).collect();
            let rows = groups.rows(&input, 2 * vertices);
            for (v, &point) in input.iter().enumerate() {
                let [before, start, end] = [-1, 0, 1].map(|k| rows[(point as i32 + k) as usize]);
                assert_eq!([start - before, end - start], [0, expected[v].len() as u32]);
            }
        }
    }
}
