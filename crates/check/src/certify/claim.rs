use crate::{Alpha, Complex, Placed};

/// The part of the triangulation that a complex claims to list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The whole regular triangulation, with the simplices that are not in the shape.
    Whole,
    /// The shape alone.
    Shape,
}

impl Extent {
    /// Whole if there is an exterior simplex, or if α = ∞, for which all of the triangulation is in the shape.
    pub fn of(complex: &Complex, alpha: Alpha) -> Self {
        let whole = complex.lists_exterior() || alpha == Alpha::INFINITE;
        if whole { Self::Whole } else { Self::Shape }
    }
}

/// A complex and what it claims to be: the α-complex of weighted points.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Claim<'a> {
    /// The complex with its points.
    pub placed: Placed<'a>,
    /// The part of the triangulation that the complex lists.
    pub extent: Extent,
    /// The points listed as hidden, if they are listed.
    pub hidden: Option<&'a [u32]>,
    /// Pairs (removed, kept) of points at one position, if they are listed.
    pub duplicates: Option<&'a [[u32; 2]]>,
    /// The lowest dimension of which it claims to list all simplices: below it, only faces are listed.
    pub lowest: usize,
}

impl<'a> Claim<'a> {
    /// The claim of a complex without lists of hidden points and duplicates; its extent is that of [`Extent::of`].
    pub fn new(placed: Placed<'a>) -> Self {
        let extent = Extent::of(placed.complex, placed.alpha);
        Self { placed, extent, hidden: None, duplicates: None, lowest: 0 }
    }

    /// Returns this claim with another extent.
    #[must_use]
    pub fn with_extent(self, extent: Extent) -> Self {
        Self { extent, ..self }
    }

    /// Returns this claim with these points listed as hidden.
    #[must_use]
    pub fn with_hidden(self, hidden: impl Into<Option<&'a [u32]>>) -> Self {
        Self { hidden: hidden.into(), ..self }
    }

    /// Returns this claim for a shape that lists, of the simplices below this dimension, only the faces of others: further
    /// missing ones are not a finding.
    #[must_use]
    pub fn with_lowest(self, lowest: usize) -> Self {
        Self { lowest, ..self }
    }

    /// Returns this claim with these pairs (removed, kept) listed as duplicates.
    #[must_use]
    pub fn with_duplicates(self, duplicates: impl Into<Option<&'a [[u32; 2]]>>) -> Self {
        Self { duplicates: duplicates.into(), ..self }
    }
}
