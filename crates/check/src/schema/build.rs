use std::collections::{BTreeMap, BTreeSet};

use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use super::{ComplexFile, PlacedComplex, SchemaError};
use crate::exact::orientation;
use crate::periodic::{moved, nearest_copy};
use crate::{Class, Complex, Simplices};

impl TryFrom<ComplexFile> for PlacedComplex {
    type Error = SchemaError;

    /// Fills in what is missing, turns cells and regular facets the canonical way, and sorts.
    /// Flat cells and repeated rows stay, for the checker to find.
    ///
    /// # Errors
    /// Fields that do not pair up, point numbers out of range, no points or simplices at all.
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
        let given = file.classes;
        let cells =
            rows(Names("cells", "classes.cells"), file.cells.or(Some(Vec::new())), given.cells, n)?;
        let facets = rows(Names("facets", "classes.facets"), file.facets, given.facets, n)?;
        let edges = rows(Names("edges", "classes.edges"), file.edges, given.edges, n)?;
        let vertices = rows(Names("vertices", "classes.vertices"), vertices, given.vertices, n)?;

        let cells = settle(cells, |_| Vec::new(), &Simplices::<4>::default());
        let of_cell = |cell: &[u32; 4]| outward_facets(*cell).to_vec();
        let facets = settle(facets, of_cell, &cells);
        let of_facet = |&[a, b, c]: &[u32; 3]| vec![[a, b], [b, c], [a, c]];
        let edges = settle(edges, of_facet, &facets);
        let vertices = settle(vertices, |&[a, b]: &[u32; 2]| vec![[a], [b]], &edges);
        let mut complex = Complex { cells, facets, edges, vertices };
        turn(&mut complex, &file.points, file.periodic);
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

/// The names of a dimension's fields.
struct Names(&'static str, &'static str);

/// Listed rows with their classes, as far as the file has them.
struct Listed<const N: usize> {
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
}

fn rows<const N: usize>(
    Names(name, of_classes): Names,
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
    points: usize,
) -> Result<Listed<N>, SchemaError> {
    SchemaError::in_range(name, rows.iter().flatten().flatten(), points)?;
    if let Some(classes) = &classes {
        SchemaError::paired(of_classes, classes.len(), name, rows.as_ref().map_or(0, Vec::len))?;
    }
    Ok(Listed { rows, classes })
}

/// What the simplices above say of a face: whether any is in the shape, whether all are interior.
#[derive(Clone, Copy)]
struct Above {
    count: usize,
    in_shape: bool,
    all_interior: bool,
}

/// Rows and classes of a dimension, from the file where it has them, from the one above where not.
fn settle<const N: usize, const M: usize>(
    listed: Listed<M>,
    faces: impl Fn(&[u32; N]) -> Vec<[u32; M]>,
    higher: &Simplices<N>,
) -> Simplices<M> {
    let mut above = BTreeMap::<[u32; M], Above>::new();
    for (row, class) in higher.iter() {
        for face in faces(row) {
            let nothing = Above { count: 0, in_shape: false, all_interior: true };
            let above = above.entry(sorted(face)).or_insert(nothing);
            above.count += 1;
            above.in_shape |= class != Class::Exterior;
            above.all_interior &= class == Class::Interior;
        }
    }
    let derived = listed.rows.is_none();
    let rows = listed
        .rows
        .unwrap_or_else(|| above.keys().copied().collect::<BTreeSet<_>>().into_iter().collect());
    let implied = |row: &[u32; M]| match above.get(&sorted(*row)) {
        // Nothing is above a cell.
        _ if M == 4 => Class::Interior,
        // A facet has two sides; around an edge or vertex all facets or edges must be interior.
        Some(above) if above.in_shape => {
            let closed = above.all_interior && (M < 3 || above.count == 2);
            if closed { Class::Interior } else { Class::Regular }
        }
        _ if derived => Class::Exterior,
        _ => Class::Singular,
    };
    let classes = listed.classes.unwrap_or_else(|| rows.iter().map(implied).collect());
    rows.into_iter().zip(classes).collect()
}

/// Turns cells positive and regular facets outward, and sorts the vertices of other rows.
pub(crate) fn turn(complex: &mut Complex, points: &[[f64; 3]], periodic: Option<[f64; 3]>) {
    for cell in complex.cells.rows_mut() {
        let mut places = cell.map(|v| points[v as usize]);
        if let Some(sides) = periodic {
            let first = places[0];
            places = places.map(|place| moved(sides, place, nearest_copy(sides, first, place)));
        }
        let [a, b, c, d] = places;
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
    let turned = facets.map(|(facet, class)| {
        let key = sorted(facet);
        let regular = class == Class::Regular;
        (outward.get(&key).copied().filter(|_| regular).unwrap_or(key), class)
    });
    complex.facets = turned.collect();
    complex.edges.rows_mut().iter_mut().for_each(|edge| *edge = sorted(*edge));
}

/// Coordinates that are not finite are the checker's to find.
fn finite(places: &[[f64; 3]]) -> bool {
    places.as_flattened().iter().all(|x| x.is_finite())
}
