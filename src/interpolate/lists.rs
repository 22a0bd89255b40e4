//! Lists of numbers side by side.

use walpha_base::memory::{NoMemory, try_with_capacity};

use super::raster::NOTHING;
use crate::volume::Volume;

/// The samples of each of so many simplices, ascending, by the simplex of each sample; missing ones are
/// left out.
pub(super) fn samples_of(
    simplices: usize,
    owners: &[u32],
    volume: &Volume,
) -> Result<Lists, NoMemory> {
    Lists::new(simplices, |add| {
        for (sample, &owner) in owners.iter().enumerate() {
            if owner != NOTHING && !volume.is_missing(sample) {
                add(owner, sample as u32);
            }
        }
    })
}

/// Lists of numbers, one for each of so many keys, side by side.
pub(super) struct Lists {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// `visit` names all pairs of a key and an item, in the same order each time it is called.
    pub(super) fn new(
        keys: usize,
        visit: impl Fn(&mut dyn FnMut(u32, u32)),
    ) -> Result<Self, NoMemory> {
        let mut starts = try_with_capacity(keys + 2, || "lists of samples".into())?;
        starts.resize(keys + 2, 0u32);
        visit(&mut |key, _| starts[key as usize + 2] += 1);
        for key in 2..starts.len() {
            starts[key] += starts[key - 1];
        }
        let count = starts[keys + 1] as usize;
        let mut items = try_with_capacity(count, || "lists of samples".into())?;
        items.resize(count, 0);
        visit(&mut |key, item| {
            let place = &mut starts[key as usize + 1];
            items[*place as usize] = item;
            *place += 1;
        });
        Ok(Self { starts, items })
    }

    /// The items of a key, in the order in which they were named.
    pub(super) fn of(&self, key: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|k| self.starts[key as usize + k] as usize);
        &self.items[start..end]
    }
}
