use serde::{Deserialize, Serialize};

use walpha_complex::schema::BoxVectors;
use walpha_points::Cell;
use walpha_shape::{Torus, TorusError};

use super::PipelineError;

/// The box in which points repeat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub enum PeriodicBox {
    /// This box.
    Given(Torus),
    /// The unit cell that the input states, as it states.
    Stated,
    /// The unit cell that the input states, along these of its vectors.
    StatedAlong([bool; 3]),
}

#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "three sides, three vectors, \"cell\", or directions such as \"xy\", are expected"
)]
enum Written {
    Vectors(BoxVectors),
    Stated(Stated),
}

/// The names of directions, one for each vector.
const DIRECTIONS: [char; 3] = ['x', 'y', 'z'];

/// The vectors along which points repeat, by the names of directions: x, y and z stand for the first, the second and the third vector. `None` for another
/// character, a direction twice, or none.
pub(crate) fn directions(text: &str) -> Option<[bool; 3]> {
    let mut repeats = [false; 3];
    for name in text.chars() {
        let k = DIRECTIONS.iter().position(|direction| *direction == name)?;
        if std::mem::replace(&mut repeats[k], true) {
            return None;
        }
    }
    (repeats != [false; 3]).then_some(repeats)
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
enum Stated {
    Cell,
    Along([bool; 3]),
}

impl From<Stated> for String {
    fn from(stated: Stated) -> Self {
        match stated {
            Stated::Cell => "cell".into(),
            Stated::Along(repeats) => DIRECTIONS
                .into_iter()
                .zip(repeats)
                .filter(|(_, repeats)| *repeats)
                .map(|(name, _)| name)
                .collect(),
        }
    }
}

impl TryFrom<String> for Stated {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        if text == "cell" {
            return Ok(Self::Cell);
        }
        directions(&text).map(Self::Along).ok_or(text)
    }
}

impl PeriodicBox {
    /// The box, if it is given.
    pub fn given(self) -> Option<Torus> {
        match self {
            Self::Given(torus) => Some(torus),
            Self::Stated | Self::StatedAlong(_) => None,
        }
    }

    /// The box of points of an input that states this cell, or none.
    pub(super) fn of(self, stated: Option<Cell>) -> Result<Torus, PipelineError> {
        match (self, stated) {
            (Self::Given(torus), _) => Ok(torus),
            (Self::Stated, Some(Cell { vectors, repeats }))
            | (Self::StatedAlong(repeats), Some(Cell { vectors, .. })) => {
                Ok(Torus::repeating(vectors, repeats)?)
            }
            (_, None) => Err(PipelineError::NoCell),
        }
    }
}

impl From<PeriodicBox> for Written {
    fn from(periodic: PeriodicBox) -> Self {
        match periodic {
            PeriodicBox::Given(torus) => Self::Vectors(BoxVectors(torus.vectors())),
            PeriodicBox::Stated => Self::Stated(Stated::Cell),
            PeriodicBox::StatedAlong(repeats) => Self::Stated(Stated::Along(repeats)),
        }
    }
}

impl TryFrom<BoxVectors> for PeriodicBox {
    type Error = TorusError;

    /// The box of these vectors. It does not repeat along those that are 0.
    fn try_from(vectors: BoxVectors) -> Result<Self, TorusError> {
        let repeats = vectors.0.map(|vector| vector != [0.0; 3]);
        let torus = match vectors.sides() {
            Some(sides) if repeats == [true; 3] => Torus::new(sides),
            _ => Torus::repeating(vectors.0, repeats),
        };
        torus.map(Self::Given)
    }
}

impl TryFrom<Written> for PeriodicBox {
    type Error = TorusError;

    fn try_from(written: Written) -> Result<Self, TorusError> {
        match written {
            Written::Stated(Stated::Cell) => Ok(Self::Stated),
            Written::Stated(Stated::Along(repeats)) => Ok(Self::StatedAlong(repeats)),
            Written::Vectors(vectors) => vectors.try_into(),
        }
    }
}
