use serde::{Deserialize, Serialize};

use super::topology::Complement;
use super::{AlphaShape, Class};

/// A void of a shape: a bounded component of its complement, made of exterior cells.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Void {
    /// Cells of the triangulation that fill it.
    pub cells: usize,
    /// Its volume, in cubed units of the points.
    pub volume: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
}

impl AlphaShape {
    /// The voids of the shape, as many as its second Betti number: largest first, ties by box.
    /// `None` unless the shape was made with its exterior simplices
    /// ([`ShapeOptions::exterior`](super::ShapeOptions::exterior)): voids are made of them.
    ///
    /// Volumes are rounded sums in a fixed order. O(n log n).
    pub fn voids(&self) -> Option<Vec<Void>> {
        self.options().exterior.then(|| voids(self))
    }
}

fn voids(shape: &AlphaShape) -> Vec<Void> {
    let cells = &shape.complex().cells;
    let positions = &shape.points().positions;
    let mut complement = Complement::of(shape.complex());
    let outside = complement.outside();
    // By the component's number, which is its first cell's.
    let mut found: Vec<Option<Void>> = vec![None; cells.len() + 1];
    for (id, (cell, class)) in cells.iter().enumerate() {
        let component = complement.component(id as u32);
        if class != Class::Exterior || component == outside {
            continue;
        }
        let corners = cell.map(|v| positions[v as usize]);
        let void = found[component as usize].get_or_insert(Void {
            cells: 0,
            volume: 0.0,
            low: corners[0],
            high: corners[0],
        });
        void.cells += 1;
        void.volume += determinant(corners);
        for k in 0..3 {
            for corner in corners {
                void.low[k] = void.low[k].min(corner[k]);
                void.high[k] = void.high[k].max(corner[k]);
            }
        }
    }
    let mut voids: Vec<Void> = found.into_iter().flatten().collect();
    // Divided last: sums of determinants on a lattice are whole numbers.
    voids.iter_mut().for_each(|void| void.volume /= 6.0);
    voids.sort_by(|a, b| {
        let boxes = || a.low.partial_cmp(&b.low).unwrap_or(std::cmp::Ordering::Equal);
        b.volume.total_cmp(&a.volume).then_with(boxes)
    });
    voids
}

/// Six times the volume of a positively oriented cell.
fn determinant([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

#[cfg(test)]
mod tests {
    use super::super::{Alpha, Engine, ShapeOptions, alpha_shape};
    use super::*;
    use crate::points::WeightedPoints;

    /// A 7³ lattice without its inner 3³ and without one more point far from them.
    fn hollow(engine: Engine, alpha: f64, exterior: bool) -> AlphaShape {
        let mut positions = Vec::new();
        for i in 0..12 * 7 * 7 {
            let p = [i % 12, i / 12 % 7, i / 84];
            let inner = p.iter().all(|k| (2..5).contains(k));
            if !inner && p != [9, 3, 3] {
                positions.push(p.map(f64::from));
            }
        }
        let weights = vec![0.0; positions.len()];
        let points = WeightedPoints { positions, weights, values: None };
        let alpha = Alpha::from_squared(alpha).unwrap();
        let options = ShapeOptions { exterior, engine, ..ShapeOptions::new(alpha) };
        alpha_shape(points, &options).unwrap()
    }

    #[test]
    fn hollows_of_a_lattice_are_found_with_their_sizes() {
        for engine in [Engine::Reference, Engine::Slabs] {
            let shape = hollow(engine, 0.75, true);
            let voids = shape.voids().unwrap();
            assert_eq!(voids.len() as u64, shape.betti().unwrap().b2);
            let [large, small] = voids[..] else { panic!("{voids:?}") };
            assert_eq!((large.low, large.high), ([1.0; 3], [5.0; 3]));
            // One missing point leaves the octahedron of its neighbours.
            assert_eq!((small.low, small.high), ([8.0, 2.0, 2.0], [10.0, 4.0, 4.0]));
            assert!((small.volume - 4.0 / 3.0).abs() < 1e-12, "{small:?}");
            let whole = 11.0 * 6.0 * 6.0;
            let filled = shape.measures().volume + large.volume + small.volume;
            assert!((filled - whole).abs() < 1e-9, "{filled} of {whole}");
        }
    }

    #[test]
    fn a_filled_shape_has_no_void_and_a_partial_one_does_not_know() {
        assert_eq!(hollow(Engine::Slabs, 100.0, true).voids(), Some(Vec::new()));
        assert_eq!(hollow(Engine::Slabs, 0.75, false).voids(), None);
    }

    #[test]
    fn an_empty_shape_has_no_void() {
        assert_eq!(hollow(Engine::Slabs, -1.0, true).voids(), Some(Vec::new()));
    }
}
