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
    /// The unit cell that the input states.
    Stated,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "three sides, three vectors, or \"cell\", are expected")]
enum Written {
    Vectors(BoxVectors),
    Stated(Stated),
}

#[derive(Serialize, Deserialize)]
enum Stated {
    #[serde(rename = "cell")]
    Cell,
}

impl PeriodicBox {
    /// The box, if it is given.
    pub fn given(self) -> Option<Torus> {
        match self {
            Self::Given(torus) => Some(torus),
            Self::Stated => None,
        }
    }

    /// The box of points of an input that states this cell, or none.
    pub(super) fn of(self, stated: Option<Cell>) -> Result<Torus, PipelineError> {
        match (self, stated) {
            (Self::Given(torus), _) => Ok(torus),
            (Self::Stated, Some(Cell { vectors, repeats: [true, true, true] })) => {
                Ok(Torus::of_vectors(vectors)?)
            }
            (Self::Stated, Some(_)) => Err(PipelineError::PartlyPeriodic),
            (Self::Stated, None) => Err(PipelineError::NoCell),
        }
    }
}

impl From<PeriodicBox> for Written {
    fn from(periodic: PeriodicBox) -> Self {
        periodic
            .given()
            .map_or(Self::Stated(Stated::Cell), |torus| Self::Vectors(BoxVectors(torus.vectors())))
    }
}

impl TryFrom<BoxVectors> for PeriodicBox {
    type Error = TorusError;

    /// The box of these vectors.
    fn try_from(vectors: BoxVectors) -> Result<Self, TorusError> {
        let torus = match vectors.sides() {
            Some(sides) => Torus::new(sides),
            None => Torus::of_vectors(vectors.0),
        };
        torus.map(Self::Given)
    }
}

impl TryFrom<Written> for PeriodicBox {
    type Error = TorusError;

    fn try_from(written: Written) -> Result<Self, TorusError> {
        match written {
            Written::Stated(Stated::Cell) => Ok(Self::Stated),
            Written::Vectors(vectors) => vectors.try_into(),
        }
    }
}
