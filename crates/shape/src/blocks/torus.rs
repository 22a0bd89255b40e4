//! The halo of a block of a torus, which is smaller than the halo for α if that is enough to decide the block.

use walpha_base::Monitor;
use walpha_base::monitor::Units;
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::Lattice;
use walpha_regular::internals::{AXES, CellArrays, Predicates, Sites, VECTORS};
use walpha_regular::{SitesError, Torus, TriangulationError};

use super::block::{Block, BlockParams, WORK, triangulate};
use super::classify::Long;
use super::partition::{Partition, Reach};
use super::run::in_space;
use crate::ShapeError;

/// A block with its halo, its triangulation, and the lattice of its points. The halo is as large as the largest empty
/// orthogonal spheres at the block's points require.
pub(super) fn on_torus(
    sites: &Sites<'_>,
    torus: Torus,
    partition: &Partition,
    block: usize,
    params: &BlockParams,
    work: &Units<'_>,
) -> Result<(Block, CellArrays, Lattice), ShapeError> {
    let Some(volume) = torus.volume() else {
        return on_slab(sites, partition, block, params, work);
    };
    for reach in params.reaches(sites, volume) {
        let points = partition.block(sites, reach, block);
        match triangulate(&points, work) {
            Err(TriangulationError::Sites(SitesError::Flat { .. })) => {}
            Ok(made) if !params.decides(reach, &points, &made) => {}
            made => return Ok((points, made?, params.lattice)),
        }
    }
    let points = partition.block(sites, Reach::whole(sites), block);
    let made = triangulate(&points, work)?;
    Ok((points, made, params.lattice))
}

/// All points of a torus, with the halo that decides their triangulation, and that triangulation.
pub(crate) fn whole_on_torus(
    sites: &Sites<'_>,
    torus: Torus,
    params: &BlockParams,
    monitor: &Monitor,
) -> Result<(Block, CellArrays), ShapeError> {
    let work = monitor.units(WORK * sites.input().len() as u64);
    let (points, made, _) = on_torus(sites, torus, &Partition::new(sites, 1), 0, params, &work)?;
    Ok((points, made))
}

/// The same for a torus that does not repeat along all vectors: the points may have an outside, as in space.
fn on_slab(
    sites: &Sites<'_>,
    partition: &Partition,
    block: usize,
    params: &BlockParams,
    work: &Units<'_>,
) -> Result<(Block, CellArrays, Lattice), ShapeError> {
    match params.wanted(sites) {
        Reach::Balls(_) => in_space(sites, partition, block, params, work),
        whole => {
            let points = partition.block(sites, whole, block);
            let made = triangulate(&points, work)?;
            Ok((points, made, params.lattice))
        }
    }
}

/// Squared radii of spheres for which halos are tried, in squares of the mean spacing of points. The largest empty spheres of
/// evenly distributed points have radii of at most about twice the spacing, so the first halo is usually enough, and it is much
/// smaller than the halo for a large α.
const SQUARED_RADII: [f64; 3] = [4.0, 16.0, 64.0];

impl BlockParams {
    /// The halos to try, in this order, before that of the whole triangulation.
    fn reaches(&self, sites: &Sites<'_>, volume: f64) -> Vec<Reach> {
        let heaviest = heaviest(sites);
        let wanted = if self.exterior { f64::INFINITY } else { self.alpha };
        let spacing = (volume / sites.input().len() as f64).cbrt();
        let squares = SQUARED_RADII.map(|times| times * spacing * spacing);
        let fewer = squares.into_iter().filter(|square| 4.0 * square <= wanted + heaviest);
        let fewer = fewer.map(|square| Reach::at(sites, square - heaviest, heaviest));
        fewer.chain([self.wanted(sites)]).collect()
    }

    /// The halo that decides what is asked for, whatever the points.
    fn wanted(&self, sites: &Sites<'_>) -> Reach {
        let alpha = if self.exterior { f64::INFINITY } else { self.alpha };
        Reach::at(sites, alpha, heaviest(sites))
    }

    /// Whether the triangulation of a block with a halo decides the block. A halo for a smaller α does if no
    /// orthogonal sphere at the block's points is larger: then all of these spheres are empty.
    fn decides(&self, reach: Reach, points: &Block, made: &CellArrays) -> bool {
        let Reach::Balls(alpha) = reach else { return true };
        if alpha >= self.alpha && !self.exterior {
            return true;
        }
        let spheres = Predicates::on(self.lattice, &points.positions, &points.weights);
        made.cells().par_iter().all(|&cell| {
            !cell.iter().any(|&v| v < points.own)
                || (!cell.contains(&made.infinite_vertex()) && spheres.fits(cell, alpha))
        })
    }
}

fn heaviest(sites: &Sites<'_>) -> f64 {
    sites.weights().iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The error for an edge that spans half of the box.
pub(crate) fn too_long(torus: Torus, Long { edge, ends }: Long) -> ShapeError {
    let parts = torus.parts([0, 1, 2].map(|k| ends[1][k] - ends[0][k]));
    let longest = (0..3).max_by(|&a, &b| parts[a].abs().total_cmp(&parts[b].abs())).unwrap_or(0);
    let [x, y, z] = torus.vectors()[longest];
    let side = x.hypot(y).hypot(z);
    let axis = if torus.sides().is_some() { AXES[longest] } else { VECTORS[longest] };
    ShapeError::Wraps { edge, axis, span: parts[longest].abs() * side, side }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params(alpha: f64, exterior: bool, sites: &Sites<'_>) -> BlockParams {
        let lattice = Lattice::of(sites.positions(), sites.weights());
        BlockParams { alpha, lattice, exterior }
    }

    /// Points of even density in a box of 8: one point in each cube of side 1, away from its centre.
    fn even() -> Vec<[f64; 3]> {
        let cube = |i: u32| [i % 8, i / 8 % 8, i / 64].map(f64::from);
        let within = |i: u32| [i * 7 % 13, i * 11 % 17, i * 5 % 19].map(|k| f64::from(k) / 32.0);
        (0..512).map(|i| std::array::from_fn(|k| cube(i)[k] + within(i)[k])).collect()
    }

    /// The same number of points, all in one corner of an eighth of the box.
    fn corner() -> Vec<[f64; 3]> {
        even().into_iter().map(|point| point.map(|x| x / 2.0)).collect()
    }

    /// One point for each unit of volume, the heaviest with weight ½; half of a diagonal is 6.93.
    #[test]
    fn small_halos_come_first_and_what_is_asked_last() {
        let weights: Vec<f64> = (0..512).map(|i| f64::from(i % 4) / 6.0).collect();
        let (positions, torus) = (even(), Torus::new([8.0; 3]).unwrap());
        let sites = Sites::on_torus(&positions, &weights, torus).unwrap();
        let all = Reach::whole(&sites);
        let (one, two) = (Reach::Balls(3.5), Reach::Balls(15.5));
        for (alpha, exterior, expected) in [
            (1.0, false, vec![Reach::Balls(1.0)]),
            (15.49, false, vec![Reach::Balls(15.49)]),
            (15.5, false, vec![one, two]),
            (f64::INFINITY, false, vec![one, two, all, all]),
            (1.0, true, vec![one, two, all, all]),
        ] {
            assert_eq!(params(alpha, exterior, &sites).reaches(&sites, 512.0), expected);
        }
    }

    /// The largest empty sphere next to the corner has a squared radius of about 12.
    #[test]
    fn a_block_looks_as_far_as_empty_spheres_are_large() {
        let torus = Torus::new([8.0; 3]).unwrap();
        for (positions, decided) in [(even(), true), (corner(), false)] {
            let sites = Sites::on_torus(&positions, &[0.0; 512], torus).unwrap();
            let partition = Partition::new(&sites, 8);
            let one = Reach::Balls(4.0);
            let points = partition.block(&sites, one, 3);
            let made = triangulate(&points, &Monitor::noop().units(1)).unwrap();
            for (alpha, exterior, expected) in [
                (4.0, false, true),
                (16.0, false, decided),
                (f64::INFINITY, false, decided),
                (4.0, true, decided),
            ] {
                let asked = params(alpha, exterior, &sites);
                assert_eq!(asked.decides(one, &points, &made), expected, "{alpha} {exterior}");
                assert!(asked.decides(Reach::whole(&sites), &points, &made));
            }
            let asked = params(4.0, true, &sites);
            let (looked, ..) =
                on_torus(&sites, torus, &partition, 3, &asked, &Monitor::noop().units(1)).unwrap();
            let reach = if decided { one } else { Reach::Balls(16.0) };
            assert_eq!(looked.positions.len(), partition.block(&sites, reach, 3).positions.len());
        }
    }
}
