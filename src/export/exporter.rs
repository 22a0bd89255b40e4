use std::borrow::Cow;
use std::io::{self, Write};

use walpha_base::advice::Advice;
use walpha_base::setters;

use crate::shape::{AlphaShape, Surface};

/// A writer of shapes in one format.
pub trait Exporter {
    /// Writes the whole file. The same shape gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()>;

    /// Whether what it writes can say that a box repeats.
    fn knows_torus(&self) -> bool {
        false
    }

    /// Writes the whole file, of a shape of a torus as it is [laid out](AlphaShape::unwrapped) where the format
    /// knows no torus.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write_any(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        match shape.options().periodic {
            Some(_) if !self.knows_torus() => self.write(&shape.unwrapped(), out),
            _ => self.write(shape, out),
        }
    }

    /// A remark for readers of the file, if this shape calls for one.
    fn remark(&self, _shape: &AlphaShape) -> Option<Advice> {
        None
    }
}

/// How a shape is written down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ExportOptions {
    /// Text where the format has a binary form too: PLY.
    pub ascii: bool,
    /// The boundary as that of a [solid](AlphaShape::solid): regular facets alone, closed, oriented and
    /// cut apart into a manifold. For formats of boundaries.
    pub solid: bool,
    /// Separate regular and singular facets, where some programs do not expect it: by groups (OBJ, edges
    /// and points too), colours (OFF) or numbers (PLY, components and sheets too).
    pub groups: bool,
    /// The input of the shape, recorded in VTP and VTU files.
    pub input: Option<String>,
}

impl ExportOptions {
    setters! { ascii: bool, solid: bool, groups: bool, input: Option<String> }

    /// The boundary to write.
    pub(super) fn surface<'a>(&self, shape: &'a AlphaShape) -> Cow<'a, Surface> {
        if self.solid { Cow::Borrowed(shape.solid().0) } else { Cow::Owned(Surface::of(shape)) }
    }
}
