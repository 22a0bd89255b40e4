//! Points that span no volume, from the definition: by hand, at α on both sides of each radius.

use crate::common::{Case, definition};

/// The numbers of vertices, edges, facets and cells in the shape.
fn sizes(positions: &[[f64; 3]], weights: &[f64], alpha: f64) -> [usize; 4] {
    let case = Case { positions: positions.to_vec(), weights: weights.to_vec(), alpha };
    let complex = definition(&case).unwrap().complex;
    [
        complex.vertices.counts().in_shape(),
        complex.edges.counts().in_shape(),
        complex.facets.counts().in_shape(),
        complex.cells.counts().in_shape(),
    ]
}

/// A point of weight ω enters at α = −ω.
#[test]
fn a_point_enters_at_minus_its_weight() {
    for (alpha, count) in [(-2.0, 1), ((-2.0f64).next_down(), 0), (0.0, 1), (-3.0, 0)] {
        assert_eq!(sizes(&[[1.0, 2.0, 3.0]], &[2.0], alpha), [count, 0, 0, 0], "{alpha}");
    }
}

/// The smallest orthogonal sphere of weights 1 and 0 at a distance of 4: 225/64.
#[test]
fn an_edge_enters_with_its_orthogonal_sphere() {
    let (positions, weights) = ([[0.0; 3], [0.0, 4.0, 0.0]], [1.0, 0.0]);
    let radius: f64 = 225.0 / 64.0;
    assert_eq!(sizes(&positions, &weights, radius), [2, 1, 0, 0]);
    assert_eq!(sizes(&positions, &weights, radius.next_down()), [2, 0, 0, 0]);
}

#[test]
fn points_on_a_line_have_edges() {
    let positions = [[0.0; 3], [3.0, 3.0, 0.0], [1.0, 1.0, 0.0]];
    for (alpha, edges) in [(0.0, 0), (0.5, 1), (1.9, 1), (2.0, 2)] {
        assert_eq!(sizes(&positions, &[0.0; 3], alpha), [3, edges, 0, 0], "{alpha}");
    }
}

#[test]
fn points_in_a_plane_have_facets() {
    // A right angle, and a square whose diagonal the perturbation chooses.
    let square = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], [2.0, 0.0, 2.0]];
    for (alpha, edges, facets) in [(0.9, 0, 0), (1.0, 4, 0), (2.0, 5, 2)] {
        assert_eq!(sizes(&square, &[0.0; 4], alpha), [4, edges, facets, 0], "{alpha}");
    }
    for (alpha, edges, facets) in [(1.0, 2, 0), (2.0, 3, 1)] {
        assert_eq!(sizes(&square[..3], &[0.0; 3], alpha), [3, edges, facets, 0], "{alpha}");
    }
}
