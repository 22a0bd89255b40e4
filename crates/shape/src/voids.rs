use std::cmp::Ordering;

use serde::{Deserialize, Serialize};
use walpha_base::sort::sort_by;
use walpha_regular::Torus;
use walpha_regular::internals::{Interval, Predicates};

use super::complement::{Complement, complement_on};
use super::measure::six_volumes;
use super::winding::{Winding, WindingSets};
use super::{Alpha, AlphaShape, Class};

/// A void of a shape: a bounded component of its complement, which consists of exterior cells.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Void {
    /// Number of its cells.
    pub cells: usize,
    /// Its volume, in cubed units of the points.
    pub volume: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
    /// The α that fills it, a squared length: the first double that is not below the squared radius
    /// of the largest orthogonal sphere of its cells, exactly. Before, it may split into several voids. With
    /// [`Balls::Radius`](super::Balls::Radius), where weights follow α, it is the parameter of the
    /// power weights instead, as [`AlphaShape::power_alpha`].
    pub filling_alpha: Alpha,
}

impl Void {
    /// The order by descending volume, then by box.
    pub fn order(&self, other: &Self) -> Ordering {
        let boxes = || self.low.partial_cmp(&other.low).unwrap_or(Ordering::Equal);
        other.volume.total_cmp(&self.volume).then_with(boxes)
    }
}

/// A component of the complement: sums over its cells.
#[derive(Clone, Copy, Debug)]
pub struct Hollow {
    cells: usize,
    /// Divided last: on a lattice, determinants and their sums are integers.
    six_volumes: f64,
    low: [f64; 3],
    high: [f64; 3],
    /// Encloses the largest squared radius of the cells.
    radius: Interval,
}

impl Hollow {
    /// The sums of one cell, with its squared radius.
    pub fn of(radius: Interval, corners: [[f64; 3]; 4]) -> Self {
        let end = |choose: fn(f64, f64) -> f64| {
            [0, 1, 2]
                .map(|k| corners[1..].iter().fold(corners[0][k], |so_far, p| choose(so_far, p[k])))
        };
        let six_volumes = six_volumes(corners);
        Self { cells: 1, six_volumes, low: end(f64::min), high: end(f64::max), radius }
    }

    /// Moves it to another of its copies on a torus.
    pub fn moved(&mut self, torus: Torus, way: Winding) {
        (self.low, self.high) = (torus.moved(self.low, way), torus.moved(self.high, way));
    }

    /// Adds another one.
    pub fn join(&mut self, other: &Self) {
        self.cells += other.cells;
        self.six_volumes += other.six_volumes;
        for k in 0..3 {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
        }
        self.radius.low = self.radius.low.max(other.radius.low);
        self.radius.high = self.radius.high.max(other.radius.high);
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Raises α to the least double at which this one of its cells fits.
    pub fn raise(
        &self,
        alpha: &mut f64,
        spheres: &Predicates<'_>,
        cell: [u32; 4],
        radius: Interval,
    ) {
        // A cell that certainly fits earlier than another one does not matter.
        if radius.high >= self.radius.low && !spheres.fits_by(cell, radius, *alpha) {
            *alpha = spheres.first_alpha(cell);
        }
    }

    /// The component as a void that is filled at this α.
    pub(crate) fn void(&self, filling_alpha: f64) -> Void {
        let Self { cells, six_volumes, low, high, .. } = *self;
        let filling_alpha = Alpha::from_squared(filling_alpha).expect("radii are numbers");
        Void { cells, volume: six_volumes / 6.0, low, high, filling_alpha }
    }
}

impl AlphaShape {
    /// The voids of the shape, as many as its second Betti number: largest first, ties by box. Of a torus those
    /// components of the complement that do not go round it, so that they are bounded in space, too; each lies
    /// where one of its copies does. Components that go round it are not voids, so there the second Betti number differs.
    /// `None` unless the shape was made with its exterior simplices
    /// ([`ShapeOptions::exterior`](super::ShapeOptions::exterior)): voids are made of them.
    ///
    /// Volumes are rounded sums in a fixed order. O(n log n).
    pub fn voids(&self) -> Option<Vec<Void>> {
        Some(self.voids_and_cells()?.into_iter().map(|(void, _)| void).collect())
    }

    /// The [voids](Self::voids), each with its cells by row, which ascend.
    #[doc(hidden)]
    pub fn voids_and_cells(&self) -> Option<Vec<(Void, Vec<u32>)>> {
        // A flat shape encloses nothing.
        let flat = self.complex().cells.is_empty();
        self.options().exterior.then(|| if flat { Vec::new() } else { voids(self) })
    }
}

/// The components of the complement, of which voids are the bounded ones.
enum Bounded {
    InSpace(Complement),
    OnTorus(Box<Torus>, WindingSets),
}

impl Bounded {
    fn of(shape: &AlphaShape) -> Self {
        match shape.options().periodic {
            None => Self::InSpace(Complement::of(shape.complex())),
            Some(torus) => Self::OnTorus(Box::new(torus), complement_on(torus, shape)),
        }
    }

    /// The component of an exterior cell, if it is bounded, by its smallest cell; and the cell's corners, on a torus in
    /// the copy that is connected with the component's other cells.
    fn locate(&mut self, cell: u32, corners: [[f64; 3]; 4]) -> Option<(u32, [[f64; 3]; 4])> {
        match self {
            Self::InSpace(complement) => {
                let component = complement.component(cell);
                (component != complement.outside()).then_some((component, corners))
            }
            Self::OnTorus(torus, sets) => {
                let (component, way) = sets.find(cell);
                let bounded = sets.rounds(component).is_none();
                bounded.then(|| (component, corners.map(|corner| torus.moved(corner, way))))
            }
        }
    }
}

fn voids(shape: &AlphaShape) -> Vec<(Void, Vec<u32>)> {
    let cells = &shape.complex().cells;
    let mut bounded = Bounded::of(shape);
    let (positions, weights) = (&shape.points().positions, shape.power_weights());
    let spheres = Predicates::on_torus(positions, weights, shape.nearest());
    // Indexed by component, whose number is that of its smallest cell.
    let mut found: Vec<Option<Hollow>> = vec![None; cells.len() + 1];
    let mut inside = Vec::new();
    for (id, (&cell, class)) in cells.iter().enumerate() {
        if class != Class::Exterior {
            continue;
        }
        let Some((component, corners)) = bounded.locate(id as u32, shape.corners(cell)) else {
            continue;
        };
        let radius = spheres.squared_radius(cell);
        let hollow = Hollow::of(radius, corners);
        match &mut found[component as usize] {
            Some(found) => found.join(&hollow),
            empty => *empty = Some(hollow),
        }
        inside.push((component as usize, id as u32, radius));
    }
    let mut filling = vec![f64::NEG_INFINITY; found.len()];
    for &(component, id, radius) in &inside {
        let hollow = found[component].expect("it has this cell");
        hollow.raise(&mut filling[component], &spheres, cells.rows()[id as usize], radius);
    }
    // Stable: cells ascend within each component.
    inside.sort_by_key(|&(component, ..)| component);
    let mut voids: Vec<(Void, Vec<u32>)> = inside
        .chunk_by(|a, b| a.0 == b.0)
        .map(|of| {
            let component = of[0].0;
            let hollow = found[component].expect("it has these cells");
            (hollow.void(filling[component]), of.iter().map(|&(_, id, _)| id).collect())
        })
        .collect();
    sort_by(&mut voids, |(a, _), (b, _)| a.order(b));
    voids
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ShapeOptions, WeightedPoints, alpha_shape};

    /// A 7³ lattice without its inner 3³ and without one more point far from them.
    fn hollow(alpha: f64, exterior: bool) -> AlphaShape {
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
        let options = ShapeOptions { exterior, ..ShapeOptions::new(alpha) };
        alpha_shape(points, &options).unwrap()
    }

    #[test]
    fn hollows_of_a_lattice_are_found_with_their_sizes() {
        let shape = hollow(0.75, true);
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
        // The octahedron's sphere; and one that touches what remains around the large hollow.
        assert_eq!(small.filling_alpha.squared(), 1.0);
        for void in [large, small] {
            let left = |alpha| hollow(alpha, true).voids().unwrap();
            let inside = |other: &Void| {
                (0..3).all(|k| other.low[k] >= void.low[k] && other.high[k] <= void.high[k])
            };
            assert!(!left(void.filling_alpha.squared()).iter().any(inside));
            assert!(left(void.filling_alpha.squared().next_down()).iter().any(inside));
        }
    }

    #[test]
    fn a_filled_shape_has_no_voids_and_without_exterior_cells_they_are_unknown() {
        assert_eq!(hollow(100.0, true).voids(), Some(Vec::new()));
        assert_eq!(hollow(0.75, false).voids(), None);
    }

    #[test]
    fn an_empty_shape_has_no_void() {
        assert_eq!(hollow(-1.0, true).voids(), Some(Vec::new()));
    }
}
