use crate::Class;

/// Where a cell is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// None of its corners is the block's own, so that the block needs nothing of it.
    Foreign,
    /// One of its corners is the ghost.
    Infinite,
    Outside,
    Inside,
}

/// The state of a cell in 16 bits: the class of the facet opposite each corner (bits 2·corner and 2·corner + 1),
/// three flags, and whether each facet is emitted from this cell (bits 12 + corner).
#[derive(Clone, Copy)]
pub(super) struct State(u16);

impl State {
    /// The lower bits of the classes of all facets.
    const LOW_BITS: u16 = 0b0101_0101;
    const INSIDE: u16 = 0x100;
    const INFINITE: u16 = 0x200;
    const FOREIGN: u16 = 0x400;
    const EMITS: usize = 12;

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
        Class::ALL[usize::from(self.0 >> (2 * opposite) & 3)]
    }

    /// Bits 2·opposite for the facets that are in the shape.
    #[inline(always)]
    pub(super) fn covered(self) -> u16 {
        (self.0 | self.0 >> 1) & Self::LOW_BITS
    }

    /// Bits 2·opposite for the facets that are not interior.
    #[inline(always)]
    pub(super) fn open(self) -> u16 {
        (self.0 >> 1 | !self.0) & Self::LOW_BITS
    }

    /// Whether a facet is emitted from this one of its two cells.
    #[inline(always)]
    pub(super) fn emits(self, opposite: usize) -> bool {
        self.0 >> (Self::EMITS + opposite) & 1 != 0
    }

    pub(super) fn set_facet(&mut self, opposite: usize, class: Class) {
        self.0 |= (class as u16) << (2 * opposite);
    }

    pub(super) fn set_emits(&mut self, opposite: usize) {
        self.0 |= 1 << (Self::EMITS + opposite);
    }
}
