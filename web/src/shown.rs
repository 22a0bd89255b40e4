//! The simplices that the page draws.

use walpha_shape::ladder::{Drawn, Filtration, Span};
use walpha_shape::{Alpha, AlphaShape, Betti, Class, WeightedPoints};

use crate::answer::Array;
use crate::failure::Failure;

/// The simplices that are drawn at some of these α, and all cells, with the levels at which they change.
pub(crate) struct Shown {
    pub alphas: Vec<Alpha>,
    pub facets: Vec<([u32; 3], Span)>,
    pub edges: Vec<([u32; 2], Span)>,
    pub vertices: Vec<(u32, Span)>,
    pub cells: Vec<([u32; 4], u32)>,
    pub betti: Vec<Betti>,
    /// In a periodic box, what is laid out in space.
    pub copies: Option<Copies>,
}

/// The points of a periodic box followed by copies of them, which the page draws beyond the box.
pub(crate) struct Copies {
    pub positions: Vec<[f64; 3]>,
    /// The point that each copy is of.
    pub of: Vec<u32>,
}

impl Shown {
    /// Decided exactly at each α.
    pub(crate) fn at(filtration: &Filtration, alphas: &[Alpha]) -> Self {
        let levels = filtration.levels(alphas);
        let Drawn { points, copies, facets, edges, vertices, .. } = levels.drawn(0);
        let copies = filtration.torus().map(|_| Copies::new(&points, copies));
        let (cells, betti) = (levels.cells(), levels.betti());
        Self { facets, edges, vertices, copies, cells, betti, alphas: levels.alphas().to_vec() }
    }

    /// All simplices of a shape, at α = 0.
    pub(crate) fn of(shape: &AlphaShape) -> Result<Self, Failure> {
        let complex = shape.complex();
        let span = |class: Class| {
            let from = |least: Class| u32::from(number(class) < number(least));
            Span {
                first: from(Class::Singular),
                regular: from(Class::Regular),
                interior: from(Class::Interior),
            }
        };
        Ok(Self {
            alphas: vec![Alpha::from_squared(0.0)?],
            facets: complex.facets.iter().map(|(&row, class)| (row, span(class))).collect(),
            edges: complex.edges.iter().map(|(&row, class)| (row, span(class))).collect(),
            vertices: complex.vertices.iter().map(|(row, class)| (row[0], span(class))).collect(),
            cells: complex.cells.rows().iter().map(|&row| (row, 0)).collect(),
            betti: vec![
                shape.betti().ok_or_else(|| Failure::new("its Betti numbers are not known"))?,
            ],
            copies: None,
        })
    }
}

impl Copies {
    pub(crate) fn new(points: &WeightedPoints, of: Vec<u32>) -> Self {
        Self { positions: points.positions().to_vec(), of }
    }
}

/// The simplices of a stop, or of another α.
pub(crate) enum Lent<'a> {
    Stop(&'a Shown),
    Made(Shown),
}

impl std::ops::Deref for Lent<'_> {
    type Target = Shown;

    fn deref(&self) -> &Shown {
        match self {
            Self::Stop(shown) => shown,
            Self::Made(shown) => shown,
        }
    }
}

/// The simplices of a shape that are drawn.
pub(crate) fn drawn(shape: &AlphaShape) -> Vec<Array> {
    let complex = shape.complex();
    let of = |class| complex.facets.of(class).flatten().copied().collect();
    let edges = complex.edges.of(Class::Singular).flatten().copied().collect();
    // Which of the others are hidden is not known.
    let mut classes = vec![number(Class::Exterior); shape.points().len()];
    complex.vertices.iter().for_each(|(row, class)| classes[row[0] as usize] = number(class));
    vec![
        Array::U32("regular", of(Class::Regular)),
        Array::U32("singular", of(Class::Singular)),
        Array::U32("edges", edges),
        Array::U8("classes", classes),
    ]
}

/// The class of hidden points, after those of vertices.
pub(crate) const HIDDEN: u8 = 4;

/// The class of a vertex, in the encoding of the page.
pub(crate) fn number(class: Class) -> u8 {
    match class {
        Class::Exterior => 0,
        Class::Singular => 1,
        Class::Regular => 2,
        Class::Interior => 3,
    }
}
