//! Passes over a volume, tile by tile.

use rayon::prelude::*;
use walpha_base::Monitor;

use super::{BlocksError, SampleBox, Team};

/// Passes over all tiles.
pub(super) struct Passes<'a> {
    pub team: &'a dyn Team,
    monitor: &'a Monitor,
    /// Those of this process.
    tiles: Vec<SampleBox>,
    done: u64,
}

impl<'a> Passes<'a> {
    /// Those of a process of a team, none of them done.
    pub(super) fn new(team: &'a dyn Team, tiles: &[SampleBox], monitor: &'a Monitor) -> Self {
        let tiles = team.own(tiles.len()).map(|tile| tiles[tile]).collect();
        Self { team, monitor, tiles, done: 0 }
    }

    /// How many are usual.
    const USUAL: u64 = 5;

    /// Works on each tile of this process, several at a time, and joins what they give in their order.
    pub(super) fn each<T: Send>(
        &mut self,
        work: impl Fn(&SampleBox) -> Result<T, BlocksError> + Sync,
        mut join: impl FnMut(T),
    ) -> Result<(), BlocksError> {
        let all = self.tiles.len() as u64;
        let total = Self::USUAL.max(self.done + 1) * all;
        let mut tiles_done = 0;
        for batch in self.tiles.chunks(rayon::current_num_threads()) {
            let results: Result<Vec<T>, _> = batch.par_iter().map(&work).collect();
            results?.into_iter().for_each(&mut join);
            tiles_done += batch.len() as u64;
            self.monitor.report(self.done * all + tiles_done, total)?;
        }
        self.done += 1;
        Ok(())
    }

    /// Works on pieces of the volume one after the other, in this process alone.
    pub(super) fn serial(
        &mut self,
        pieces: &[SampleBox],
        mut work: impl FnMut(&SampleBox) -> Result<(), BlocksError>,
    ) -> Result<(), BlocksError> {
        let all = pieces.len() as u64;
        let total = Self::USUAL.max(self.done + 1) * all;
        for (piece, done) in pieces.iter().zip(1..) {
            work(piece)?;
            self.monitor.report(self.done * all + done, total)?;
        }
        self.done += 1;
        Ok(())
    }
}
