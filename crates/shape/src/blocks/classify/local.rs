use walpha_regular::internals::Predicates;

use crate::blocks::block::Block;

/// A block with its triangulation and the parameters of the shape. Vertices are numbers of the block's points.
pub(super) struct Local<'a> {
    pub block: &'a Block,
    pub cells: &'a [[u32; 4]],
    pub at_infinity: u32,
    pub predicates: Predicates<'a>,
    pub alpha: f64,
    pub exterior: bool,
}

impl Local<'_> {
    /// Whether a vertex is one of the block's own points. The infinite vertex belongs to no block.
    #[inline(always)]
    pub(super) fn owned(&self, v: u32) -> bool {
        v < self.block.own
    }

    /// The input index of a point, which orders the vertices of simplices.
    #[inline(always)]
    pub(super) fn input(&self, v: u32) -> u32 {
        self.block.input[v as usize]
    }

    /// Whether the smallest orthogonal sphere has a squared radius of at most α. Exact.
    pub(super) fn fits<const N: usize>(&self, simplex: [u32; N]) -> bool {
        self.alpha == f64::INFINITY || self.predicates.fits(simplex, self.alpha)
    }

    /// Whether an edge spans half of the box of a torus or more, along one of its vectors at least. Exact.
    pub(super) fn is_long(&self, [v, u]: [u32; 2]) -> bool {
        self.block.copies.as_ref().is_some_and(|copies| {
            let [p, q] = [v, u].map(|v| self.block.positions[v as usize]);
            !copies.torus.are_near(p, q)
        })
    }
}

/// Whether the permutation of 0..4 that starts with a, b, c is even.
#[inline(always)]
pub(super) fn even(a: usize, b: usize, c: usize) -> bool {
    let d = 6 - a - b - c;
    let inversions = u8::from(a > b)
        + u8::from(a > c)
        + u8::from(a > d)
        + u8::from(b > c)
        + u8::from(b > d)
        + u8::from(c > d);
    inversions % 2 == 0
}
