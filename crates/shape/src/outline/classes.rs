//! The classes of simplices in their plane, and the length of the boundary.

use walpha_base::Sum;
use walpha_base::vector::{length, sub};

use super::rings::Triangles;
use crate::{Class, Complex, Simplices};

/// A complex of a plane with the classes of the plane, its triangles turned as given and regular edges oriented. Exterior
/// simplices stay exterior.
pub(super) fn in_plane(complex: &Complex, triangles: &Triangles) -> Complex {
    let mut turned = triangles.rows().iter();
    let facets = complex.facets.iter().map(|(&row, class)| match class {
        Class::Exterior => (row, class),
        _ => (*turned.next().expect("a triangle for each row in the shape"), Class::Interior),
    });
    let facets: Simplices<3> = facets.collect();
    let edges = complex.edges.iter().map(|(&row, class)| match (class, triangles.side(row)) {
        (Class::Exterior, _) => (row, class),
        (_, None) => (row, Class::Singular),
        (_, Some(side)) if triangles.is_boundary(side) => (triangles.ends(side), Class::Regular),
        (_, Some(_)) => (row, Class::Interior),
    });
    let edges: Simplices<2> = edges.collect();
    // The simplices that a vertex may be on take precedence in this order.
    let largest = complex.vertices.rows().iter().map(|&[v]| v).max();
    let mut classes = vec![Class::Singular; largest.map_or(0, |v| v as usize + 1)];
    triangles.rows().as_flattened().iter().for_each(|&v| classes[v as usize] = Class::Interior);
    for (ends, class) in edges.iter() {
        if let Class::Regular | Class::Singular = class {
            ends.iter().for_each(|&v| classes[v as usize] = Class::Regular);
        }
    }
    let vertices = complex.vertices.iter().map(|(&[v], class)| match class {
        Class::Exterior => ([v], class),
        _ => ([v], classes[v as usize]),
    });
    let vertices = vertices.collect();
    Complex { cells: Simplices::default(), facets, edges, vertices }
}

/// The length of the regular edges, summed exactly and rounded once.
pub(super) fn perimeter(complex: &Complex, positions: &[[f64; 3]]) -> f64 {
    let mut sum = Sum::default();
    for ends in complex.edges.of(Class::Regular) {
        let [from, to] = ends.map(|v| positions[v as usize]);
        sum.add(length(sub(to, from)));
    }
    sum.value()
}
