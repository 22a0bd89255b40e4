use super::State;

/// The cells around each owned vertex, as 4·cell + the vertex's place in it.
pub(super) struct Stars {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Stars {
    /// Looks for the vertices below `own`. O(cells).
    pub(super) fn new(cells: &[[u32; 4]], own: u32, states: &[State]) -> Self {
        let near = || {
            let all = (0u32..).step_by(4).zip(cells).zip(states);
            all.filter(|(_, state)| !state.is_far()).map(|(cell, _)| cell)
        };
        // Where the star of a vertex ends, kept one further on; then, as stars fill, where it begins.
        let mut starts = vec![0; own as usize + 2];
        for v in near().flat_map(|(_, cell)| cell).filter(|&&v| v < own) {
            starts[*v as usize + 2] += 1;
        }
        for v in 2..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut corners = vec![0; starts[own as usize + 1] as usize];
        for (first, cell) in near() {
            for (corner, &v) in (first..).zip(cell) {
                if v < own {
                    let at = &mut starts[v as usize + 1];
                    corners[*at as usize] = corner;
                    *at += 1;
                }
            }
        }
        Self { starts, corners }
    }

    /// The star of a vertex, ascending; empty if the point is hidden.
    pub(super) fn of(&self, v: u32) -> &[u32] {
        let v = v as usize;
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}
