use crate::Class;

/// The location of a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// None of its corners is the block's own, so the block does not need it.
    Foreign,
    /// One of its corners is the infinite vertex.
    Infinite,
    Outside,
    Inside,
}

/// The state of a cell in 32 bits: the class of the facet opposite each corner (bits 2·corner and 2·corner + 1),
/// three flags, and what is emitted from this cell at each corner (bits 16 + 4·corner on): the facet opposite each
/// other corner, and, in place of that opposite itself, the cell.
#[derive(Clone, Copy)]
pub(super) struct State(u32);

impl State {
    /// The lower bits of the classes of all facets.
    const LOW_BITS: u32 = 0b0101_0101;
    const INSIDE: u32 = 0x100;
    const INFINITE: u32 = 0x200;
    const FOREIGN: u32 = 0x400;
    const EMITTED: usize = 16;

    /// The state of a cell all of whose facets are exterior.
    pub(super) fn new(kind: Kind) -> Self {
        Self(match kind {
            Kind::Foreign => Self::FOREIGN,
            Kind::Infinite => Self::INFINITE,
            Kind::Outside => 0,
            Kind::Inside => Self::INSIDE,
        })
    }

    #[inline(always)]
    pub(super) fn is_inside(self) -> bool {
        self.0 & Self::INSIDE != 0
    }

    #[inline(always)]
    pub(super) fn is_infinite(self) -> bool {
        self.0 & Self::INFINITE != 0
    }

    #[inline(always)]
    pub(super) fn is_foreign(self) -> bool {
        self.0 & Self::FOREIGN != 0
    }

    /// The class of the facet opposite a corner.
    #[inline(always)]
    pub(super) fn facet(self, opposite: usize) -> Class {
        Class::ALL[(self.0 >> (2 * opposite) & 3) as usize]
    }

    /// Bits 2·opposite for the facets that are in the shape.
    #[inline(always)]
    pub(super) fn covered(self) -> u32 {
        (self.0 | self.0 >> 1) & Self::LOW_BITS
    }

    /// Bits 2·opposite for the facets that are not interior.
    #[inline(always)]
    pub(super) fn open(self) -> u32 {
        (self.0 >> 1 | !self.0) & Self::LOW_BITS
    }

    /// The simplices that are emitted at a corner: a bit for each facet opposite another corner, and the bit of the corner itself
    /// for the cell.
    #[inline(always)]
    pub(super) fn emitted(self, corner: usize) -> u32 {
        self.0 >> (Self::EMITTED + 4 * corner) & 0xf
    }

    pub(super) fn set_facet(&mut self, opposite: usize, class: Class) {
        self.0 |= (class as u32) << (2 * opposite);
    }

    /// Emits facets (bits by the opposite corners) and perhaps the cell, each at its first vertex: `first` is the
    /// corner of the cell's first vertex, `second` that of its next one.
    pub(super) fn emit(&mut self, facets: u32, cell: bool, [first, second]: [usize; 2]) {
        let opposite_first = facets & 1 << first;
        let at_first = facets ^ opposite_first | u32::from(cell) << first;
        self.0 |= at_first << (Self::EMITTED + 4 * first);
        self.0 |= opposite_first << (Self::EMITTED + 4 * second);
    }
}
