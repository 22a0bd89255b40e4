//! Complexes from files, ready to be judged. The contents and formats of files are those of [`walpha_complex::schema`].

pub use walpha_complex::schema::*;

use std::collections::{BTreeMap, BTreeSet};

use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use crate::exact::orientation;
use crate::{Alpha, Class, Complex, Placed, Simplices};

/// A complex with its points, in canonical order, ready to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedComplex {
    /// x, y, z of each point.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// α.
    pub alpha: Alpha,
    /// The complex.
    pub complex: Complex,
    /// Points listed as hidden, if they are listed.
    pub hidden: Option<Vec<u32>>,
    /// Duplicates, if they are listed.
    pub duplicates: Option<Vec<[u32; 2]>>,
    /// The sides of the periodic box, if there is one.
    pub periodic: Option<[f64; 3]>,
}

impl PlacedComplex {
    /// The complex, borrowed for comparison.
    pub fn placed(&self) -> Placed<'_> {
        Placed::new(&self.positions, &self.weights, self.alpha, &self.complex)
    }

    /// The same complex in a periodic box with these sides, or in space.
    #[must_use]
    pub fn with_periodic(self, periodic: Option<[f64; 3]>) -> Self {
        Self { periodic, ..self }
    }
}

impl TryFrom<ComplexFile> for PlacedComplex {
    type Error = SchemaError;

    /// Derives what is missing, orients cells and regular facets canonically, and sorts.
    /// Flat cells and repeated rows are kept for the checker to find.
    ///
    /// # Errors
    /// Fields of different lengths, point numbers out of range, no points or no simplices.
    fn try_from(file: ComplexFile) -> Result<Self, SchemaError> {
        let n = file.points.len();
        if n == 0 {
            return Err(SchemaError::NoPoints);
        }
        if [
            file.cells.is_none(),
            file.facets.is_none(),
            file.edges.is_none(),
            file.vertices.is_none(),
        ] == [true; 4]
        {
            return Err(SchemaError::NoSimplices);
        }
        if let Some(side) =
            file.periodic.iter().flatten().find(|side| !(side.is_finite() && **side > 0.0))
        {
            return Err(SchemaError::Value {
                name: "periodic",
                value: side.to_string(),
                expected: "the length of a side",
            });
        }
        let weights = file.weights.unwrap_or_else(|| vec![0.0; n]);
        SchemaError::paired("weights", weights.len(), "points", n)?;
        let numbers = file.hidden.iter().flatten();
        SchemaError::in_range("hidden", numbers, n)?;
        SchemaError::in_range("duplicates", file.duplicates.iter().flatten().flatten(), n)?;

        let vertices = file.vertices.map(|list| list.into_iter().map(|v| [v]).collect());
        let classes = file.classes;
        let cells = given_simplices(
            FieldNames("cells", "classes.cells"),
            file.cells.or(Some(Vec::new())),
            classes.cells,
            n,
        )?;
        let facets = given_simplices(
            FieldNames("facets", "classes.facets"),
            file.facets,
            classes.facets,
            n,
        )?;
        let edges =
            given_simplices(FieldNames("edges", "classes.edges"), file.edges, classes.edges, n)?;
        let vertices = given_simplices(
            FieldNames("vertices", "classes.vertices"),
            vertices,
            classes.vertices,
            n,
        )?;

        let cells = complete(cells, |_| Vec::new(), &Simplices::<4>::default());
        let of_cell = |cell: &[u32; 4]| outward_facets(*cell).to_vec();
        let facets = complete(facets, of_cell, &cells);
        let of_facet = |&[a, b, c]: &[u32; 3]| vec![[a, b], [b, c], [a, c]];
        let edges = complete(edges, of_facet, &facets);
        let vertices = complete(vertices, |&[a, b]: &[u32; 2]| vec![[a], [b]], &edges);
        let mut complex = Complex { cells, facets, edges, vertices };
        orient(&mut complex, &file.points, file.periodic);
        sort(&mut complex);
        Ok(Self {
            positions: file.points,
            weights,
            alpha: file.alpha,
            complex,
            hidden: file.hidden,
            duplicates: file.duplicates,
            periodic: file.periodic,
        })
    }
}

/// The names of the fields of a dimension: its simplices and their classes.
struct FieldNames(&'static str, &'static str);

/// The rows and classes of a dimension, as far as the file has them.
struct Given<const N: usize> {
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
}

/// The simplices of a dimension in the file, checked.
fn given_simplices<const N: usize>(
    FieldNames(name, of_classes): FieldNames,
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
    points: usize,
) -> Result<Given<N>, SchemaError> {
    SchemaError::in_range(name, rows.iter().flatten().flatten(), points)?;
    if let Some(classes) = &classes {
        SchemaError::paired(of_classes, classes.len(), name, rows.as_ref().map_or(0, Vec::len))?;
    }
    Ok(Given { rows, classes })
}

/// The cofaces of a simplex, one dimension up.
#[derive(Clone, Copy)]
struct Cofaces {
    count: usize,
    in_shape: bool,
    all_interior: bool,
}

/// Rows and classes of a dimension: those of the file where it has them, else derived from the dimension above.
fn complete<const N: usize, const M: usize>(
    given: Given<M>,
    faces: impl Fn(&[u32; N]) -> Vec<[u32; M]>,
    higher: &Simplices<N>,
) -> Simplices<M> {
    let mut cofaces = BTreeMap::<[u32; M], Cofaces>::new();
    for (row, class) in higher.iter() {
        for face in faces(row) {
            let none = Cofaces { count: 0, in_shape: false, all_interior: true };
            let cofaces = cofaces.entry(sorted(face)).or_insert(none);
            cofaces.count += 1;
            cofaces.in_shape |= class != Class::Exterior;
            cofaces.all_interior &= class == Class::Interior;
        }
    }
    let derived = given.rows.is_none();
    let rows = given
        .rows
        .unwrap_or_else(|| cofaces.keys().copied().collect::<BTreeSet<_>>().into_iter().collect());
    let implied = |row: &[u32; M]| match cofaces.get(&sorted(*row)) {
        // A cell has no cofaces.
        _ if M == 4 => Class::Interior,
        // A facet has two sides; of an edge or vertex all cofaces must be interior.
        Some(cofaces) if cofaces.in_shape => {
            let closed = cofaces.all_interior && (M < 3 || cofaces.count == 2);
            if closed { Class::Interior } else { Class::Regular }
        }
        _ if derived => Class::Exterior,
        _ => Class::Singular,
    };
    let classes = given.classes.unwrap_or_else(|| rows.iter().map(implied).collect());
    rows.into_iter().zip(classes).collect()
}

/// Orients cells positively and regular facets outward, and sorts the vertices of other rows.
pub(crate) fn orient(complex: &mut Complex, points: &[[f64; 3]], periodic: Option<[f64; 3]>) {
    for cell in complex.cells.rows_mut() {
        let mut corners = cell.map(|v| points[v as usize]);
        if let Some(sides) = periodic {
            let first = corners[0];
            corners =
                corners.map(|corner| moved(sides, corner, nearest_copy(sides, first, corner)));
        }
        let [a, b, c, d] = corners;
        if finite(&[a, b, c, d]) && orientation(a, b, c, d).is_lt() {
            cell.swap(2, 3);
        }
        *cell = smallest_even(*cell);
    }
    let mut outward = BTreeMap::new();
    for cell in complex.cells.of(Class::Interior) {
        outward.extend(outward_facets(*cell).map(|facet| (sorted(facet), smallest_even(facet))));
    }
    let facets = std::mem::take(&mut complex.facets).into_iter();
    let oriented = facets.map(|(facet, class)| {
        let key = sorted(facet);
        let regular = class == Class::Regular;
        (outward.get(&key).copied().filter(|_| regular).unwrap_or(key), class)
    });
    complex.facets = oriented.collect();
    complex.edges.rows_mut().iter_mut().for_each(|edge| *edge = sorted(*edge));
}

/// Whether coordinates are finite. The checker reports those that are not.
fn finite(positions: &[[f64; 3]]) -> bool {
    positions.as_flattened().iter().all(|x| x.is_finite())
}

/// The multiples of the sides that move `to` to its copy nearest to `from`.
pub(crate) fn nearest_copy(sides: [f64; 3], from: [f64; 3], to: [f64; 3]) -> [i32; 3] {
    [0, 1, 2].map(|k| {
        let (way, half) = (to[k] - from[k], sides[k] / 2.0);
        i32::from(way < -half) - i32::from(way > half)
    })
}

/// A position moved by multiples of the sides.
pub(crate) fn moved(sides: [f64; 3], position: [f64; 3], by: [i32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| position[k] + f64::from(by[k]) * sides[k])
}
