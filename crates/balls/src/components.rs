//! The union's components.

use walpha_shape::NO_COMPONENT;

use crate::real::{Bounded, Double, Real, Single};
use crate::{BallUnion, Measured};

/// A connected component of a union of balls.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BallComponent {
    /// The number of its balls that are not covered by others.
    pub balls: usize,
    /// Its volume, in cubed units of the points.
    pub volume: Bounded,
    /// The area of its boundary, in squared units of the points; that around its voids included.
    pub area: Bounded,
}

impl BallUnion<'_> {
    /// The components of the union, in the order of [`AlphaShape::component_numbers`](walpha_shape::AlphaShape::component_numbers), which
    /// says for each ball the number of its component. O(n).
    pub fn components(&self) -> Vec<BallComponent> {
        let mut numbers = self.shape.component_numbers();
        numbers.truncate(self.volumes().len());
        let mut sums: Vec<(usize, Double, Double)> = Vec::new();
        let in_shape = numbers.iter().enumerate().filter(|&(_, &number)| number != NO_COMPONENT);
        for (v, &number) in in_shape {
            let number = number as usize;
            if number >= sums.len() {
                sums.resize(number + 1, Default::default());
            }
            let (balls, volume, area) = &mut sums[number];
            *balls += 1;
            *volume += term(self.volumes(), v);
            *area += term(self.areas(), v);
        }
        let component = |(balls, volume, area): (usize, Double, Double)| BallComponent {
            balls,
            volume: volume.rounded().bounded(),
            area: area.rounded().bounded(),
        };
        sums.into_iter().map(component).collect()
    }
}

fn term(column: &Measured, row: usize) -> Single {
    let Bounded { value, bound } = column.get(row);
    Single { value, error: bound }
}
