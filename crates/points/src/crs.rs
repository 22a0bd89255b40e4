//! What a file states about its coordinate reference system.

use serde::Serialize;
use walpha_volume::LengthUnit;

/// The coordinate reference system of points on the Earth, as far as a file states it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Crs {
    /// The code of EPSG for x and y, if it is stated.
    pub epsg: Option<u16>,
    /// The name, as stated.
    pub name: Option<String>,
    /// Whether x and y are longitude and latitude.
    pub geographic: bool,
    /// The unit of x and y, by its stated name.
    pub unit: Option<String>,
    /// The system of heights.
    pub vertical: Vertical,
    /// The unit of x and y, if it is a known length.
    #[serde(skip)]
    pub length: LengthUnit,
    /// The well-known text, if the file states the system so.
    #[serde(skip)]
    pub text: Option<String>,
}

/// The system of heights.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Vertical {
    /// The code of EPSG, if it is stated.
    pub epsg: Option<u16>,
    /// The name, as stated.
    pub name: Option<String>,
    /// The unit, by its stated name.
    pub unit: Option<String>,
}

impl Crs {
    /// The definition that EPSG's register has for the code, in the form of PROJ; `None` without a code, for one that is not
    /// known, and without the feature `las`.
    pub fn definition(&self) -> Option<&'static str> {
        #[cfg(feature = "las")]
        return self.epsg.and_then(crs_definitions::from_code).map(|known| known.proj4);
        #[cfg(not(feature = "las"))]
        return None;
    }

    /// The system as well-known text: that of the file, or else that of EPSG's register, which is not known without the feature
    /// `las` and in WebAssembly.
    pub fn well_known_text(&self) -> Option<&str> {
        #[cfg(all(feature = "las", not(target_family = "wasm")))]
        let registered = self.epsg.and_then(crs_definitions::from_code).map(|known| known.wkt);
        #[cfg(not(all(feature = "las", not(target_family = "wasm"))))]
        let registered = None;
        self.text.as_deref().or(registered)
    }

    /// The name, and the code of EPSG, as far as they are stated.
    pub fn label(&self) -> String {
        match (&self.name, self.epsg) {
            (Some(name), Some(epsg)) => format!("{name} (EPSG:{epsg})"),
            (Some(name), None) => format!("{name} (no EPSG code stated)"),
            (None, Some(epsg)) => format!("EPSG:{epsg}"),
            (None, None) => "no name stated".to_owned(),
        }
    }
}
