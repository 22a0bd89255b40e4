//! Sets of voxels, of their corners or of samples, a bit each.

use walpha_base::memory::{NoMemory, try_reserve, try_with_capacity};
use walpha_base::parallel::prelude::*;
use walpha_complex::Voxels;

use super::voxels::VoxelsError;
use crate::ShapeError;

/// A set of places (x, y, z) of a box, with a bit for each, in rows along x of whole words.
#[derive(Debug)]
pub(super) struct Bits {
    pub(super) size: [usize; 3],
    /// Words of a row.
    words: usize,
    bits: Vec<u64>,
}

impl Bits {
    fn new(size: [usize; 3]) -> Result<Self, NoMemory> {
        let words = size[0].div_ceil(64);
        let all = words.saturating_mul(size[1]).saturating_mul(size[2]);
        let mut bits = try_with_capacity(all, || "the voxels of a region".into())?;
        bits.resize(all, 0);
        Ok(Self { size, words, bits })
    }

    /// The places of a box that belong to a set.
    pub(super) fn filled(
        size: [usize; 3],
        belongs: impl Fn([usize; 3]) -> bool + Sync,
    ) -> Result<Self, NoMemory> {
        let mut set = Self::new(size)?;
        let (words, rows) = (set.words.max(1), size[1].max(1));
        set.bits.par_chunks_mut(words).enumerate().for_each(|(row, out)| {
            for x in (0..size[0]).filter(|&x| belongs([x, row % rows, row / rows])) {
                out[x / 64] |= 1 << (x % 64);
            }
        });
        Ok(set)
    }

    /// The voxels of a region in the smallest box around it, and the indices of that box's first voxel.
    pub(super) fn of(voxels: &Voxels) -> Result<(Self, [u32; 3]), ShapeError> {
        let (mut first, mut last) = ([u32::MAX; 3], [0; 3]);
        for_each_row(voxels, |from, to| {
            for k in 0..3 {
                first[k] = first[k].min(from[k]);
                last[k] = last[k].max(if k == 0 { to } else { from[k] });
            }
        });
        if first[0] == u32::MAX {
            return Err(VoxelsError::Empty.into());
        }
        let size = [0, 1, 2].map(|k| (last[k] - first[k]) as usize + 1);
        let mut set = Self::new(size)?;
        for_each_row(voxels, |from, to| {
            let [x, y, z] = [0, 1, 2].map(|k| (from[k] - first[k]) as usize);
            let row = set.row_mut(y, z);
            for i in x..=x + (to - from[0]) as usize {
                row[i / 64] |= 1 << (i % 64);
            }
        });
        Ok((set, first))
    }

    fn row_mut(&mut self, y: usize, z: usize) -> &mut [u64] {
        let first = self.words * (y + self.size[1] * z);
        &mut self.bits[first..first + self.words]
    }

    /// A row; none outside of the box.
    fn row(&self, y: i64, z: i64) -> Option<&[u64]> {
        let inside = |i: i64, n: usize| usize::try_from(i).ok().filter(|&i| i < n);
        let (y, z) = (inside(y, self.size[1])?, inside(z, self.size[2])?);
        let first = self.words * (y + self.size[1] * z);
        Some(&self.bits[first..first + self.words])
    }

    /// Whether a place is in the set; `false` outside of the box.
    pub(super) fn has(&self, [x, y, z]: [i64; 3]) -> bool {
        let inside = usize::try_from(x).ok().filter(|&x| x < self.size[0]);
        inside.is_some_and(|x| self.row(y, z).is_some_and(|row| row[x / 64] >> (x % 64) & 1 == 1))
    }

    pub(super) fn count(&self) -> u64 {
        self.bits.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// Calls `visit` with each place of the set, in the order of z, y and x.
    pub(super) fn each(&self, mut visit: impl FnMut([usize; 3])) {
        (0..self.size[2]).for_each(|z| self.each_of(z, &mut visit));
    }

    /// Calls `visit` with each place of a plane, in the order of y and x.
    fn each_of(&self, z: usize, mut visit: impl FnMut([usize; 3])) {
        let plane = self.words * self.size[1];
        for (at, &word) in self.bits[plane * z..plane * (z + 1)].iter().enumerate() {
            let mut left = word;
            while left != 0 {
                let x = 64 * (at % self.words) + left.trailing_zeros() as usize;
                visit([x, at / self.words, z]);
                left &= left - 1;
            }
        }
    }

    /// A set in a box of this size. `fill` makes its rows from the rows of this set around them.
    fn map(
        &self,
        size: [usize; 3],
        mut fill: impl FnMut(&Self, [i64; 2], &mut [u64]),
    ) -> Result<Self, NoMemory> {
        let mut set = Self::new(size)?;
        let words = set.words.max(1);
        for (row, out) in set.bits.chunks_mut(words).enumerate() {
            fill(self, [(row % size[1]) as i64, (row / size[1]) as i64], out);
        }
        Ok(set)
    }

    /// The places whose 26 neighbours are in the set, too.
    pub(super) fn deep(&self) -> Result<Self, NoMemory> {
        self.map(self.size, |set, at, out| {
            out.fill(u64::MAX);
            for [y, z] in around(at) {
                match set.row(y, z) {
                    Some(row) => out.iter_mut().zip(row).for_each(|(out, word)| *out &= word),
                    None => out.fill(0),
                }
            }
            along(out, |word, before, after| word & before & after);
        })
    }

    /// The places in the set, and their 26 neighbours in the box.
    pub(super) fn dilated(&self) -> Result<Self, NoMemory> {
        self.map(self.size, |set, at, out| {
            for [y, z] in around(at) {
                let row = set.row(y, z).unwrap_or_default();
                out.iter_mut().zip(row).for_each(|(out, word)| *out |= word);
            }
            along(out, |word, before, after| word | before | after);
            // Past the end of the row there are no places.
            if let (Some(last), left @ 1..) = (out.last_mut(), set.size[0] % 64) {
                *last &= (1 << left) - 1;
            }
        })
    }

    /// The places in this set that are in another of the same box.
    pub(super) fn and(&self, other: &Self) -> Result<Self, NoMemory> {
        self.combined(other, |word, other| word & other)
    }

    /// The places in this set that are not in another of the same box.
    pub(super) fn without(&self, other: &Self) -> Result<Self, NoMemory> {
        self.combined(other, |word, other| word & !other)
    }

    fn combined(&self, other: &Self, of: impl Fn(u64, u64) -> u64) -> Result<Self, NoMemory> {
        let mut set = Self::new(self.size)?;
        let both = self.bits.iter().zip(&other.bits);
        set.bits.iter_mut().zip(both).for_each(|(word, (&a, &b))| *word = of(a, b));
        Ok(set)
    }

    /// Its largest part, of those that join across faces; of equally large ones that of the first place. O(n).
    pub(super) fn largest_part(&self) -> Result<Self, NoMemory> {
        let (mut left, mut largest) = (self.combined(self, |word, _| word)?, Self::new(self.size)?);
        let mut most = 0;
        for place in self.places() {
            if left.has(place.map(|i| i as i64)) {
                let part = left.take_part(std::iter::once(place))?;
                let count = part.count();
                if count > most {
                    (largest, most) = (part, count);
                }
            }
        }
        Ok(largest)
    }

    /// The set and the places of the box that it keeps apart from the border of the box, where places join across faces. O(n).
    pub(super) fn filled_up(&self) -> Result<Self, NoMemory> {
        let all = Self::filled(self.size, |_| true)?;
        let mut outside = all.without(self)?;
        let is_at_border =
            |at: &[usize; 3]| (0..3).any(|k| at[k] == 0 || at[k] + 1 == self.size[k]);
        let border = all.places().filter(is_at_border);
        let open = outside.take_part(border)?;
        all.without(&open)
    }

    /// Takes out of the set what joins to some places across faces, these included as far as they are in the set.
    fn take_part(&mut self, from: impl Iterator<Item = [usize; 3]>) -> Result<Self, NoMemory> {
        let mut part = Self::new(self.size)?;
        let mut next: Vec<[usize; 3]> = Vec::new();
        for first in from {
            let mut reached = Some(first);
            while let Some(at) = reached {
                let (word, bit) = (at[0] / 64, 1 << (at[0] % 64));
                if self.row_mut(at[1], at[2])[word] & bit != 0 {
                    self.row_mut(at[1], at[2])[word] &= !bit;
                    part.row_mut(at[1], at[2])[word] |= bit;
                    try_reserve(&mut next, 6, || "the parts of a region".into())?;
                    for k in 0..3 {
                        let along = |i: usize| [0, 1, 2].map(|j| if j == k { i } else { at[j] });
                        next.extend(at[k].checked_sub(1).map(along));
                        next.extend(Some(at[k] + 1).filter(|&i| i < self.size[k]).map(along));
                    }
                }
                reached = next.pop();
            }
        }
        Ok(part)
    }

    /// All places of the box, in the order of z, y and x.
    fn places(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [x, y, z] = self.size;
        (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])))
    }

    /// The corners of the voxels in the set.
    pub(super) fn corners(&self) -> Result<Self, NoMemory> {
        self.map(self.size.map(|n| n + 1), |set, [y, z], out| {
            for [y, z] in [[y, z], [y - 1, z], [y, z - 1], [y - 1, z - 1]] {
                let row = set.row(y, z).unwrap_or_default();
                out.iter_mut().zip(row).for_each(|(out, word)| *out |= word);
            }
            along(out, |word, before, _| word | before);
        })
    }
}

/// A set whose places are numbered in the order of z, y and x.
pub(super) struct Numbered {
    set: Bits,
    /// The number of places before each word.
    before: Vec<u32>,
    count: u64,
}

impl Numbered {
    pub(super) fn new(set: Bits) -> Result<Self, NoMemory> {
        let mut before = try_with_capacity(set.bits.len(), || "the numbers of corners".into())?;
        let mut count = 0;
        for word in &set.bits {
            before.push(count as u32);
            count += u64::from(word.count_ones());
        }
        Ok(Self { set, before, count })
    }

    pub(super) fn len(&self) -> usize {
        self.count as usize
    }

    /// The number of a place in the set.
    pub(super) fn number(&self, [x, y, z]: [usize; 3]) -> u32 {
        let word = self.set.words * (y + self.set.size[1] * z) + x / 64;
        let below = self.set.bits[word] & ((1 << (x % 64)) - 1);
        self.before[word] + below.count_ones()
    }

    /// Calls `visit` with each place, in the order of numbers.
    pub(super) fn each(&self, visit: impl FnMut([usize; 3])) {
        self.set.each(visit);
    }

    /// The number of planes along z.
    pub(super) fn planes(&self) -> usize {
        self.set.size[2]
    }

    /// Calls `visit` with each place of a plane and its number, in their order.
    pub(super) fn each_of(&self, z: usize, mut visit: impl FnMut((u32, [usize; 3]))) {
        let mut number = self.before[self.set.words * self.set.size[1] * z];
        self.set.each_of(z, |place| {
            visit((number, place));
            number += 1;
        });
    }
}

/// The rows around a row, including the row itself.
fn around([y, z]: [i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    (-1..=1).flat_map(move |dz| (-1..=1).map(move |dy| [y + dy, z + dz]))
}

/// Replaces each word by a function of itself and of the row shifted to both sides: bit i of them is what bits i − 1 and i + 1 were.
fn along(row: &mut [u64], of: impl Fn(u64, u64, u64) -> u64) {
    let mut last = 0;
    for at in 0..row.len() {
        let word = row[at];
        let next = row.get(at + 1).copied().unwrap_or_default();
        row[at] = of(word, word << 1 | last >> 63, word >> 1 | next << 63);
        last = word;
    }
}

/// Calls `visit` with the pieces of runs in each row: the first voxel, and the x of the last.
fn for_each_row(voxels: &Voxels, mut visit: impl FnMut([u32; 3], u32)) {
    let x = u64::from(voxels.dims[0]);
    for &[first, count] in &voxels.runs {
        let (mut at, end) = (first, first + count);
        while at < end {
            let until = end.min((at / x + 1) * x);
            visit(voxels.indices(at), ((until - 1) % x) as u32);
            at = until;
        }
    }
}
