use std::fmt;

use serde::Serialize;

/// A simplex by the input indices of its vertices.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Simplex(Vec<u32>);

impl Simplex {
    /// The vertices, as the judged complex lists them.
    pub fn vertices(&self) -> &[u32] {
        &self.0
    }
}

impl<const N: usize> From<[u32; N]> for Simplex {
    fn from(row: [u32; N]) -> Self {
        Self(row.to_vec())
    }
}

impl fmt::Display for Simplex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = ["vertex", "edge", "facet", "cell"][self.0.len().clamp(1, 4) - 1];
        write!(f, "{name} {:?}", self.0)
    }
}

impl Simplex {
    /// Drops the vertices from this number on.
    pub(super) fn drop_from(&mut self, first: u32) {
        self.0.retain(|&v| v < first);
    }

    /// Replaces each vertex `v` by `numbers[v]`.
    pub(super) fn renumber(&mut self, numbers: &[u32]) {
        self.0.iter_mut().for_each(|v| *v = numbers[*v as usize]);
    }

    /// Replaces copies by the `count` points that they are copies of. Returns whether any vertex is not a
    /// copy.
    pub(super) fn fold(&mut self, count: u32) -> bool {
        let is_at_box = self.0.iter().any(|&v| v < count);
        self.0.iter_mut().for_each(|v| *v %= count);
        is_at_box
    }
}
