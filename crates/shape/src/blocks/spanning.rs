//! Triangulation of blocks whose points may span no volume; along a line of points, most do not.

use walpha_base::monitor::Units;
use walpha_regular::internals::{CellArrays, auxiliary_positions};
use walpha_regular::{SitesError, TriangulationError};

use super::block::{Block, triangulate};

/// Triangulates a block. If its points span no volume, auxiliary points are added, with input indices from `next` on. Their balls
/// at α are empty, so they are in no simplex of the shape and refute none.
pub(super) fn spanning(
    block: &mut Block,
    alpha: f64,
    next: u32,
    work: &Units<'_>,
) -> Result<CellArrays, TriangulationError> {
    match triangulate(block, work) {
        Err(TriangulationError::Sites(SitesError::Flat { .. } | SitesError::TooFew { .. })) => {
            let auxiliary = auxiliary_positions(&block.positions);
            // Weights below −α make the balls empty; the factor 2 allows for roundings.
            block.weights.extend(auxiliary.iter().map(|_| -(2.0 * alpha.max(0.0) + 1.0).ceil()));
            block.input.extend((next..).take(auxiliary.len()));
            if let Some(copies) = &mut block.copies {
                copies.windings.extend(auxiliary.iter().map(|_| [0; 3]));
            }
            block.positions.extend(auxiliary);
            triangulate(block, work)
        }
        made => made,
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::Monitor;
    use walpha_regular::internals::Lattice;
    use walpha_regular::internals::Sites;

    use crate::blocks::block::BlockParams;
    use crate::blocks::partition::Partition;
    use crate::blocks::run::in_space;

    /// Blocks of a line once took all points with them: quadratic in the number of blocks.
    #[test]
    fn a_block_of_a_line_stays_small() {
        let line = (0..800).map(|i| [i, 0, 0]).chain([[5, 1, 0], [5, 0, 1]]);
        let positions: Vec<_> = line.map(|point| point.map(|x| f64::from(1024 * x))).collect();
        let weights = vec![0.0; positions.len()];
        let sites = Sites::new(&positions, &weights).unwrap();
        let partition = Partition::new(&sites, 8);
        let lattice = Lattice::of(&positions, &weights);
        let params = BlockParams { alpha: 1024.0 * 1024.0, lattice, exterior: false };
        let mut flat = 0;
        for block in 0..partition.len() {
            let monitor = Monitor::noop();
            let work = monitor.units(1);
            let (points, made, lattice_of_block) =
                in_space(&sites, &partition, block, &params, &work).unwrap();
            assert!(points.positions.len() < 110, "{}", points.positions.len());
            assert_eq!(made.infinite_vertex() as usize, points.input.len());
            // Auxiliary points have a lattice of their own.
            let own = Lattice::of(&points.positions, &points.weights);
            let is_flat = points.weights.iter().any(|&weight| weight < 0.0);
            flat += usize::from(is_flat);
            assert_eq!(lattice_of_block, if is_flat { own } else { lattice });
        }
        assert!(flat > 4 && flat < partition.len(), "{flat}");
    }
}
