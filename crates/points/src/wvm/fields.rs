//! Encoding of the fields of a header.

use walpha_complex::Alpha;

use walpha_volume::{Coordinates, Frame, LengthUnit, Reason, Space};

const SPACES: [Space; 4] = [Space::Unknown, Space::Lps, Space::Ras, Space::Las];

const UNITS: [LengthUnit; 10] = [
    LengthUnit::Unstated,
    LengthUnit::Voxel,
    LengthUnit::Metre,
    LengthUnit::Centimetre,
    LengthUnit::Millimetre,
    LengthUnit::Micrometre,
    LengthUnit::Nanometre,
    LengthUnit::Angstrom,
    LengthUnit::Foot,
    LengthUnit::SurveyFoot,
];

/// The code of an item: its index in the list.
fn code<T: PartialEq>(all: &[T], one: T) -> u8 {
    all.iter().position(|other| *other == one).expect("all are in the list") as u8
}

/// Appends fields to bytes.
pub(super) struct FieldWriter(pub Vec<u8>);

impl FieldWriter {
    /// A whole number: seven bits to a byte, the lowest first, the eighth bit set on all but the last.
    pub(super) fn whole(&mut self, mut number: u64) {
        while number >= 128 {
            self.0.push(number as u8 | 128);
            number >>= 7;
        }
        self.0.push(number as u8);
    }

    pub(super) fn doubles(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|number| self.0.extend(number.to_le_bytes()));
    }

    pub(super) fn coordinates(&mut self, Coordinates { space, unit }: Coordinates) {
        self.0.extend([code(&SPACES, space), code(&UNITS, unit)]);
    }

    pub(super) fn frame(&mut self, frame: &Frame) {
        self.coordinates(frame.coordinates);
        self.doubles(&frame.origin);
        self.doubles(&frame.spacing);
        self.doubles(frame.direction.as_flattened());
    }
}

/// Reads fields from bytes.
pub(super) struct FieldReader<'a> {
    /// The bytes not yet read.
    pub rest: &'a [u8],
}

impl FieldReader<'_> {
    pub(super) fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let Some((first, rest)) = self.rest.split_first_chunk::<N>() else {
            return Err(Reason::truncated("is truncated: it ends within its header"));
        };
        self.rest = rest;
        Ok(*first)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Reason> {
        Ok(self.bytes::<1>()?[0])
    }

    pub(super) fn whole(&mut self) -> Result<u64, Reason> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(number);
            }
        }
        Err(Reason::header("its header has a whole number of more than 64 bits"))
    }

    pub(super) fn double(&mut self) -> Result<f64, Reason> {
        let number = f64::from_le_bytes(self.bytes()?);
        if number.is_finite() {
            return Ok(number);
        }
        Err(Reason::header(format!("its header has the number {number}, which must be finite")))
    }

    pub(super) fn alpha(&mut self) -> Result<Alpha, Reason> {
        let number = f64::from_le_bytes(self.bytes()?);
        Alpha::from_squared(number).map_err(|error| Reason::header(error.to_string()))
    }

    fn one_of<T: Copy>(&mut self, all: &[T], what: &str) -> Result<T, Reason> {
        let code = self.byte()?;
        let unknown =
            || Reason::header(format!("its header names the {what} {code}, which is unknown"));
        all.get(usize::from(code)).copied().ok_or_else(unknown)
    }

    pub(super) fn coordinates(&mut self) -> Result<Coordinates, Reason> {
        let space = self.one_of(&SPACES, "space")?;
        Ok(Coordinates { space, unit: self.one_of(&UNITS, "unit of length")? })
    }

    pub(super) fn frame(&mut self) -> Result<Frame, Reason> {
        let coordinates = self.coordinates()?;
        let mut three = || Ok([self.double()?, self.double()?, self.double()?]);
        let (origin, spacing) = (three()?, three()?);
        let direction = [three()?, three()?, three()?];
        Ok(Frame { origin, spacing, direction, coordinates })
    }
}
