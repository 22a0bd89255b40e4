use super::Builder;
use crate::predicates::Screen;

impl Builder {
    /// The cell that holds a point, or the infinite cell that a line to it leaves the hull by, found
    /// by a walk through facets that have the point beyond them. In a regular triangulation no walk
    /// comes back to a cell (Edelsbrunner 1990, doi:10.1007/BF02122778).
    #[inline(never)]
    pub(super) fn locate(&self, screen: &Screen<'_>, v: u32) -> u32 {
        let mut cell = self.near;
        if let Some(corner) = self.mesh.ghost_corner(cell) {
            cell = self.mesh.cells[cell as usize].neighbors[corner] / 4;
        }
        let mut from = u32::MAX;
        'walk: loop {
            let corners = self.mesh.cells[cell as usize].corners;
            let across = self.mesh.cells[cell as usize].neighbors;
            for corner in 0..4 {
                let next = across[corner] / 4;
                if next == from {
                    continue;
                }
                let mut moved = corners;
                moved[corner] = v;
                if screen.orientation(moved).is_lt() {
                    if self.mesh.ghost_corner(next).is_some() {
                        return next;
                    }
                    from = cell;
                    cell = next;
                    continue 'walk;
                }
            }
            return cell;
        }
    }
}
