use std::fmt;

use serde::{Deserialize, Serialize};

/// The directions of the axes of world coordinates in a patient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Space {
    /// x to the left, y to the back, z to the head: DICOM, ITK, `MetaImage`.
    #[serde(rename = "LPS")]
    Lps,
    /// x to the right, y to the front, z to the head: `NIfTI`.
    #[serde(rename = "RAS")]
    Ras,
    /// x to the left, y to the front, z to the head: some NRRD files.
    #[serde(rename = "LAS")]
    Las,
    /// Not stated.
    #[default]
    #[serde(rename = "unknown")]
    Unknown,
}

/// The unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum LengthUnit {
    /// The distance between neighbouring samples: coordinates are indices.
    #[serde(rename = "voxel")]
    Voxel,
    /// A unit that is not stated.
    #[default]
    #[serde(rename = "unit")]
    Unstated,
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetres, the unit of DICOM and ITK.
    #[serde(rename = "mm")]
    Millimetre,
    /// Micrometres.
    #[serde(rename = "µm")]
    Micrometre,
    /// Nanometres.
    #[serde(rename = "nm")]
    Nanometre,
    /// Ångströms.
    #[serde(rename = "Å")]
    Angstrom,
    /// International feet, 0.3048 m.
    #[serde(rename = "ft")]
    Foot,
    /// US survey feet, 1200/3937 m.
    #[serde(rename = "ftUS")]
    SurveyFoot,
}

/// The meaning of coordinates: the directions of their axes and their unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Coordinates {
    /// The directions of the axes.
    pub space: Space,
    /// The unit of length.
    pub unit: LengthUnit,
}

impl Space {
    /// The sign of each axis relative to LPS; `None` if it is not known.
    fn signs(self) -> Option<[f64; 3]> {
        match self {
            Self::Lps => Some([1.0, 1.0, 1.0]),
            Self::Ras => Some([-1.0, -1.0, 1.0]),
            Self::Las => Some([1.0, -1.0, 1.0]),
            Self::Unknown => None,
        }
    }

    /// Whether the directions of the axes are known.
    pub fn is_known(self) -> bool {
        self != Self::Unknown
    }

    /// The three letters, or `unknown`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lps => "LPS",
            Self::Ras => "RAS",
            Self::Las => "LAS",
            Self::Unknown => "unknown",
        }
    }
}

impl LengthUnit {
    const ALL: [Self; 10] = [
        Self::Voxel,
        Self::Unstated,
        Self::Metre,
        Self::Centimetre,
        Self::Millimetre,
        Self::Micrometre,
        Self::Nanometre,
        Self::Angstrom,
        Self::Foot,
        Self::SurveyFoot,
    ];

    /// The unit as a power of ten metres; `None` if it is not one, as feet are not.
    fn exponent(self) -> Option<i32> {
        match self {
            Self::Voxel | Self::Unstated | Self::Foot | Self::SurveyFoot => None,
            Self::Metre => Some(0),
            Self::Centimetre => Some(-2),
            Self::Millimetre => Some(-3),
            Self::Micrometre => Some(-6),
            Self::Nanometre => Some(-9),
            Self::Angstrom => Some(-10),
        }
    }

    /// Whether the unit is a known length.
    pub fn is_known(self) -> bool {
        !matches!(self, Self::Voxel | Self::Unstated)
    }

    /// The unit of this length in metres: one of metres, parts of them, or feet. The two feet differ by 2 in a million.
    pub fn of_metres(metres: f64) -> Self {
        let length = |unit: &Self| match unit {
            Self::Foot => Some(0.3048),
            Self::SurveyFoot => Some(1200.0 / 3937.0),
            other => other.exponent().map(|exponent| 10f64.powi(exponent)),
        };
        let is_it =
            |unit: &Self| length(unit).is_some_and(|length| (metres / length - 1.0).abs() < 1e-7);
        Self::ALL.into_iter().find(is_it).unwrap_or_default()
    }

    /// The symbol that follows a number: `mm`, `voxel`; `unit` if the unit is not known.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Voxel => "voxel",
            Self::Unstated => "unit",
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Micrometre => "µm",
            Self::Nanometre => "nm",
            Self::Angstrom => "Å",
            Self::Foot => "ft",
            Self::SurveyFoot => "ftUS",
        }
    }

    /// The symbol in ASCII: `um` for `µm`.
    pub fn ascii(self) -> &'static str {
        match self {
            Self::Micrometre => "um",
            Self::Angstrom => "angstrom",
            other => other.symbol(),
        }
    }

    /// The unit that a file names, in the spellings of NRRD, `MetaImage`, `ImageJ`, OME-XML and OME-Zarr.
    /// A name that is not understood is [`LengthUnit::Unstated`].
    pub fn named(name: &str) -> Self {
        let name = name.trim().trim_matches('"').trim().to_lowercase();
        let of_symbol = |unit: &Self| unit.symbol().to_lowercase() == name;
        match name.as_str() {
            "voxels" | "pixel" | "pixels" => Self::Voxel,
            "meter" | "metre" | "meters" | "metres" => Self::Metre,
            "centimeter" | "centimetre" | "centimeters" => Self::Centimetre,
            "millimeter" | "millimetre" | "millimeters" => Self::Millimetre,
            // The Greek letter, the sign for "micro", and ImageJ's escape for it.
            "um" | "μm" | "\\u00b5m" | "micron" | "microns" | "micrometer" | "micrometre"
            | "micrometers" => Self::Micrometre,
            "nanometer" | "nanometre" | "nanometers" => Self::Nanometre,
            "angstrom" | "ångström" => Self::Angstrom,
            "foot" | "feet" => Self::Foot,
            "us-ft" | "us survey foot" | "us survey feet" => Self::SurveyFoot,
            _ => Self::ALL.into_iter().find(of_symbol).unwrap_or_default(),
        }
    }
}

impl Coordinates {
    /// Coordinates that are indices of samples.
    pub const VOXEL: Self = Self { space: Space::Unknown, unit: LengthUnit::Voxel };
    /// Coordinates in a patient as in DICOM and ITK: LPS, in millimetres.
    pub const PATIENT: Self = Self { space: Space::Lps, unit: LengthUnit::Millimetre };

    /// The conversion of these coordinates to others, as far as both are known; unknown properties do not
    /// change.
    pub fn to(self, other: Self) -> Conversion {
        let mut to = self;
        let mut signs = [1.0; 3];
        if let (Some(from), Some(into)) = (self.space.signs(), other.space.signs()) {
            signs = [0, 1, 2].map(|k| from[k] * into[k]);
            to.space = other.space;
        }
        let mut power = 0;
        if let (Some(from), Some(into)) = (self.unit.exponent(), other.unit.exponent()) {
            power = from - into;
            to.unit = other.unit;
        }
        Conversion { to, signs, power }
    }
}

impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.unit.symbol())?;
        if self.space.is_known() { write!(f, ", {}", self.space.name()) } else { Ok(()) }
    }
}

/// A conversion of coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// The resulting coordinates.
    pub to: Coordinates,
    signs: [f64; 3],
    /// The exponent of ten.
    power: i32,
}

impl Conversion {
    /// Converts a length. It is rounded only once, as powers of ten are exact doubles and their inverses are not.
    pub fn length(&self, length: f64) -> f64 {
        let factor = 10f64.powi(self.power.abs());
        if self.power < 0 { length / factor } else { length * factor }
    }

    /// Converts a position, or a vector from one to another.
    pub fn position(&self, position: [f64; 3]) -> [f64; 3] {
        self.direction(position).map(|component| self.length(component))
    }

    /// Converts a direction, whose length does not matter.
    pub fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        // Adding 0.0 turns −0 into 0.
        [0, 1, 2].map(|k| self.signs[k] * direction[k] + 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_units_are_understood() {
        for unit in LengthUnit::ALL {
            assert_eq!(LengthUnit::named(unit.symbol()), unit);
            assert_eq!(LengthUnit::named(unit.ascii()), unit);
            assert!(unit.ascii().is_ascii());
        }
        for name in ["um", "\"um\"", "Micron", "micrometer", "µm", "μm", "\\u00B5m"] {
            assert_eq!(LengthUnit::named(name), LengthUnit::Micrometre, "{name}");
        }
        assert_eq!(LengthUnit::named("furlong"), LengthUnit::Unstated);
        for (metres, unit) in [
            (1.0, LengthUnit::Metre),
            (0.01, LengthUnit::Centimetre),
            (0.3048, LengthUnit::Foot),
            (0.3048006096012192, LengthUnit::SurveyFoot),
            (0.9144, LengthUnit::Unstated),
        ] {
            assert_eq!(LengthUnit::of_metres(metres), unit);
        }
    }

    #[test]
    fn only_what_is_known_is_converted() {
        let nifti = Coordinates { space: Space::Ras, unit: LengthUnit::Micrometre };
        let there = nifti.to(Coordinates::PATIENT);
        assert_eq!(there.to, Coordinates::PATIENT);
        assert_eq!(there.position([1.0, -2.0, 3.0]), [-0.001, 0.002, 0.003]);
        assert_eq!(there.to.to(nifti).position([-0.001, 0.002, 0.003]), [1.0, -2.0, 3.0]);
        let las = Coordinates { space: Space::Las, unit: LengthUnit::Millimetre };
        assert_eq!(las.to(Coordinates::PATIENT).position([1.0, 2.0, 3.0]), [1.0, -2.0, 3.0]);
        for unknown in [Coordinates::default(), Coordinates::VOXEL] {
            let there = unknown.to(Coordinates::PATIENT);
            assert_eq!((there.to, there.position([1.0; 3])), (unknown, [1.0; 3]));
        }
    }
}
