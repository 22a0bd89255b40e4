//! `Alpha_shape_3` in both modes: our filtration has the same values, and the same classes at every α.

use std::collections::HashMap;

use walpha::cgal::{AlphaShape3, Critical, Intervals, Mode};
use walpha::ladder::{Filtration, Ordered};
use walpha::{Alpha, Class, Complex, WeightedPoints};

use super::on_all_sets;

fn general(points: &WeightedPoints) -> Option<AlphaShape3> {
    AlphaShape3::new(points.positions(), Some(points.weights()), Mode::General).ok()
}

/// Every double that may be the first at or above a critical value, those below them, and both infinities; of many values some.
fn alphas(shapes: &AlphaShape3, most: usize) -> Vec<Alpha> {
    let values = shapes.values();
    let step = values.len().div_ceil(most);
    let near = values.iter().step_by(step).flat_map(|x| [x.next_down(), *x, x.next_up()]);
    let mut alphas: Vec<_> = near.chain([f64::NEG_INFINITY, f64::INFINITY]).collect();
    alphas.sort_by(f64::total_cmp);
    alphas.dedup();
    alphas.into_iter().map(|alpha| Alpha::from_squared(alpha).unwrap()).collect()
}

/// The values from which on simplices of one dimension are singular (if they ever are), regular and interior: by vertices.
fn by_vertices<const N: usize>(
    intervals: &Intervals<N>,
) -> HashMap<Vec<u32>, (u32, f64, f64, f64)> {
    let values = intervals.rows.iter().zip(&intervals.spans).map(|(row, span)| {
        // A simplex that is singular from a value on at which it is regular is never singular. With a point on its sphere,
        // CGAL may say that it is Gabriel or not.
        let first = span.min.unwrap_or(span.mid);
        assert!(first.rank <= span.mid.rank);
        assert!(span.max.is_none_or(|max| span.mid.rank <= max.rank));
        let interior = span.max.map_or(f64::INFINITY, |max| max.nearest);
        (row.to_vec(), (first.rank, first.nearest, span.mid.nearest, interior))
    });
    values.collect()
}

fn assert_same_values(ours: &Ordered<'_>, theirs: &AlphaShape3) {
    let values: Vec<f64> = ours.values().iter().map(|value| value.squared()).collect();
    assert_eq!(values, theirs.values());
    let mut wanted = by_vertices(theirs.facets());
    wanted.extend(by_vertices(theirs.edges()));
    wanted.extend(by_vertices(theirs.vertices()));
    let (rows, firsts) = theirs.cells();
    let cell = |(row, &Critical { rank, nearest, .. }): (&[u32; 4], &Critical)| {
        // The values of a cell, which is never regular.
        (row.to_vec(), (rank, nearest, f64::INFINITY, nearest))
    };
    wanted.extend(rows.iter().zip(firsts).map(cell));
    assert_eq!(ours.len(), wanted.len());
    for entry in ours.iter() {
        let found = (entry.rank, entry.value, entry.regular, entry.interior);
        assert_eq!(Some(&found), wanted.get(entry.vertices), "{:?}", entry.vertices);
    }
}

#[test]
fn values_and_classes_are_those_of_the_filtration() {
    let compared = on_all_sets(900, |points| {
        let Some(theirs) = general(points) else { return false };
        let filtration = Filtration::new(points.clone()).unwrap();
        assert_same_values(&filtration.simplices().unwrap(), &theirs);
        let levels = filtration.levels(&alphas(&theirs, 40));
        for (level, betti) in levels.betti().into_iter().enumerate() {
            let ours = levels.shape(level, true, betti);
            assert_eq!(*ours.complex(), theirs.complex(levels.alphas()[level]).unwrap());
        }
        true
    });
    assert!(compared > 400, "{compared}");
}

/// The regularized shape by its definition: the interior cells and their faces. Cells are those of the general one.
fn regularized(general: &Complex) -> Complex {
    let mut cells_at = HashMap::<Vec<u32>, usize>::new();
    for (&cell, class) in general.cells.iter() {
        if class == Class::Interior {
            for faces in 1_u32..15 {
                let mut face: Vec<u32> =
                    (0..4).filter(|i| faces >> i & 1 == 1).map(|i| cell[i]).collect();
                face.sort_unstable();
                *cells_at.entry(face).or_insert(0) += 1;
            }
        }
    }
    fn faces<const N: usize>(
        simplices: &walpha::Simplices<N>,
        cells_at: &HashMap<Vec<u32>, usize>,
    ) -> walpha::Simplices<N> {
        let class = |(&row, class): (&[u32; N], Class)| {
            let mut sorted = row;
            sorted.sort_unstable();
            match class {
                _ if !cells_at.contains_key(&sorted[..]) => (sorted, Class::Exterior),
                Class::Interior => (row, Class::Interior),
                // A simplex at a cell of the shape is no longer singular.
                _ => (row, Class::Regular),
            }
        };
        let mut rows: Vec<_> = simplices.iter().map(class).collect();
        rows.sort_unstable();
        rows.into_iter().collect()
    }
    Complex {
        cells: general.cells.clone(),
        facets: faces(&general.facets, &cells_at),
        edges: faces(&general.edges, &cells_at),
        vertices: faces(&general.vertices, &cells_at),
    }
}

#[test]
fn regularized_shapes_are_the_cells_and_their_faces() {
    let compared = on_all_sets(300, |points| {
        let Some(general) = general(points) else { return false };
        let theirs =
            AlphaShape3::new(points.positions(), Some(points.weights()), Mode::Regularized);
        let theirs = theirs.unwrap();
        assert!(theirs.edges().spans.iter().all(|span| span.min.is_none()));
        // Its values are values of cells.
        let mut of_cells: Vec<u32> = theirs.cells().1.iter().map(|first| first.rank).collect();
        of_cells.sort_unstable();
        of_cells.dedup();
        assert!(of_cells.into_iter().eq(0..theirs.values().len() as u32));
        for alpha in alphas(&general, 20) {
            let wanted = regularized(&general.complex(alpha).unwrap());
            assert_eq!(theirs.complex(alpha).unwrap(), wanted, "{alpha:?}");
        }
        true
    });
    assert!(compared > 150, "{compared}");
}
