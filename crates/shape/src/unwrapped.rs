//! Shapes of a torus unwrapped into space.

use std::collections::BTreeMap;

use super::copies::Copier;
use super::{AlphaShape, Simplices};

fn lay_out<const N: usize>(
    shape: &AlphaShape,
    simplices: &Simplices<N>,
    copier: &mut Copier,
) -> Simplices<N> {
    simplices.iter().map(|(&row, class)| (copier.lay_out(shape, row), class)).collect()
}

impl AlphaShape {
    /// A shape of a torus unwrapped into space, for programs without periodic boxes: a row for each simplex, as in
    /// [`AlphaShape::complex`], except that simplices which cross an upper side of the box have copies of points in place of the
    /// points. Copies come after all points. Along the sides the result is cut open, so it is not the α-complex of its points;
    /// classes, sizes, components and sheets are those of the torus. A shape in space is returned unchanged. O(n log n).
    #[must_use]
    pub fn unwrapped(&self) -> Self {
        let Some(torus) = self.options.periodic else { return self.clone() };
        let mut copier = Copier::new(self.own_points());
        let mut complex = self.complex.clone();
        complex.cells = lay_out(self, &self.complex.cells, &mut copier);
        complex.facets = lay_out(self, &self.complex.facets, &mut copier);
        complex.edges = lay_out(self, &self.complex.edges, &mut copier);
        let classes: BTreeMap<u32, _> =
            self.complex.vertices.iter().map(|(&[v], class)| (v, class)).collect();
        let points = self.own_points() as u32;
        for (copy, (v, _)) in (points..).zip(&copier.copied) {
            complex.vertices.push([copy], classes[v]);
        }
        let mut unwrapped = self.clone();
        unwrapped.complex = complex;
        unwrapped.options.periodic = None;
        (unwrapped.sums, unwrapped.solid, unwrapped.outline) = Default::default();
        unwrapped.set_copies(torus, copier.copied);
        unwrapped
    }
}
