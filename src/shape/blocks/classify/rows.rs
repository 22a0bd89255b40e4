//! What a block gives out.

use super::State;
use crate::shape::Class;

/// The simplices that a block owns, around one of its points after the other. That point, the smallest
/// vertex of each, is left out of the rows: a quarter to a half of the memory that they take while
/// blocks wait for each other.
#[derive(Default)]
pub(in super::super) struct Owned {
    pub cells: Rows<3>,
    pub facets: Rows<2>,
    pub edges: Rows<1>,
    /// The class of each point, `None` for those that are no vertices.
    pub vertices: Vec<Option<Class>>,
    /// Where the rows and sheets of each point begin, see [`Dimension`], and where the last ones end.
    pub starts: Vec<[u32; 5]>,
    /// The sheet of each regular facet, and the two of each singular facet: first that on the side where
    /// the facet's sorted row turns clockwise. Numbered from 0 within the block.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge.
    pub edge_sheets: Vec<u32>,
    /// How many sheets there are.
    pub sheets: u32,
    /// Sides of facets, and singular edges, that touch points of this block and of others.
    pub shared: Vec<Side>,
    /// Points, each with another one of its component.
    pub joined: Vec<[u32; 2]>,
}

/// Columns of [`Owned::starts`].
#[derive(Clone, Copy)]
pub(in super::super) enum Dimension {
    Cells,
    Facets,
    Edges,
    FacetSheets,
    EdgeSheets,
}

/// Simplices of `M` + 1 vertices, by input index.
pub(in super::super) struct Rows<const M: usize> {
    pub vertices: Vec<[u32; M]>,
    pub classes: Vec<Class>,
}

impl<const M: usize> Default for Rows<M> {
    fn default() -> Self {
        Self { vertices: Vec::new(), classes: Vec::new() }
    }
}

impl<const M: usize> Rows<M> {
    /// Makes room for so many rows at the most, so that growing copies nothing.
    pub fn reserve(&mut self, most: usize) {
        self.vertices.reserve_exact(most);
        self.classes.reserve_exact(most);
    }

    pub fn push(&mut self, row: [u32; M], class: Class) {
        self.vertices.push(row);
        self.classes.push(class);
    }
}

/// One side of a facet, or a singular edge, that several blocks know.
pub(in super::super) struct Side {
    /// Sorted input indices; an edge repeats its last.
    pub simplex: [u32; 3],
    pub side: u32,
    /// Its sheet within the block.
    pub sheet: u32,
}

impl Owned {
    /// Makes room for the rows of a block with these classes, some of them other blocks'.
    pub(super) fn reserve(&mut self, states: &[State], points: usize) {
        let (mut cells, mut facets) = (0, 0);
        for state in states {
            cells += usize::from(state.is_inside());
            facets += state.given();
        }
        self.cells.reserve(cells);
        self.facets.reserve(facets);
        // In a triangulated ball there is an edge for each cell and for each point, less a few.
        self.edges.reserve(cells + points);
        self.starts.reserve_exact(points + 1);
        self.vertices.reserve_exact(points);
    }

    /// Notes that the rows of the next point begin here.
    pub fn begin(&mut self) {
        self.starts.push(
            [
                self.cells.classes.len(),
                self.facets.classes.len(),
                self.edges.classes.len(),
                self.facet_sheets.len(),
                self.edge_sheets.len(),
            ]
            .map(|len| len as u32),
        );
    }
}
