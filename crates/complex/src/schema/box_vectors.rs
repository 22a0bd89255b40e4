use serde::{Deserialize, Serialize};

/// The three vectors along which a periodic box repeats. In files, a box along the axes is its sides along x, y and z, and
/// any other is its three vectors, as rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Written", into = "Written")]
pub struct BoxVectors(pub [[f64; 3]; 3]);

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "the sides of a box, or three vectors, are expected")]
enum Written {
    Sides([f64; 3]),
    Vectors([[f64; 3]; 3]),
}

impl BoxVectors {
    /// A box along the axes.
    pub fn of_sides([x, y, z]: [f64; 3]) -> Self {
        Self([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
    }

    /// The sides along x, y and z, if the vectors are along these axes, in this order.
    pub fn sides(&self) -> Option<[f64; 3]> {
        let [[x, a, b], [c, y, d], [e, f, z]] = self.0;
        ([a, b, c, d, e, f] == [0.0; 6]).then_some([x, y, z])
    }

    /// Three sides or nine components, by rows; `None` for any other number of them.
    pub fn of_numbers(numbers: &[f64]) -> Option<Self> {
        match *numbers {
            [x, y, z] => Some(Self::of_sides([x, y, z])),
            [ax, ay, az, bx, by, bz, cx, cy, cz] => {
                Some(Self([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]))
            }
            _ => None,
        }
    }
}

impl From<Written> for BoxVectors {
    fn from(written: Written) -> Self {
        match written {
            Written::Sides(sides) => Self::of_sides(sides),
            Written::Vectors(vectors) => Self(vectors),
        }
    }
}

impl From<BoxVectors> for Written {
    fn from(vectors: BoxVectors) -> Self {
        vectors.sides().map_or(Self::Vectors(vectors.0), Self::Sides)
    }
}
