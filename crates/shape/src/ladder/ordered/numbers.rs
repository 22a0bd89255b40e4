use crate::Complex;

/// The numbering of simplices of all dimensions: vertices first, then edges, facets, cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers {
    /// The first number of each dimension.
    pub first: [u32; 4],
    all: u32,
}

impl Numbers {
    /// The numbers of the simplices of a complex; `None` if there are more than 32-bit numbers below `u32::MAX`.
    pub(crate) fn of(complex: &Complex) -> Option<Self> {
        let counts = [
            complex.vertices.len(),
            complex.edges.len(),
            complex.facets.len(),
            complex.cells.len(),
        ];
        let mut first = [0; 4];
        let mut all: u32 = 0;
        for (first, count) in first.iter_mut().zip(counts) {
            *first = all;
            all = u32::try_from(count).ok().and_then(|count| all.checked_add(count))?;
        }
        (all < u32::MAX).then_some(Self { first, all })
    }

    /// The number of simplices.
    pub(crate) fn all(self) -> usize {
        self.all as usize
    }

    /// The number of simplices of a dimension.
    pub(crate) fn count(self, dimension: usize) -> usize {
        let end = self.first.get(dimension + 1).copied().unwrap_or(self.all);
        (end - self.first[dimension]) as usize
    }

    /// The dimension of a simplex, and its row among those.
    #[inline]
    pub(crate) fn row(self, simplex: u32) -> (usize, usize) {
        let [_, edges, facets, cells] = self.first;
        let dimension = usize::from(simplex >= edges)
            + usize::from(simplex >= facets)
            + usize::from(simplex >= cells);
        (dimension, (simplex - self.first[dimension]) as usize)
    }
}
