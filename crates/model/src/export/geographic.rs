//! Coordinates of a projected system as longitude and latitude, which `GeoJSON` wants.

use proj4rs::Proj;
use proj4rs::transform::transform;
use walpha_points::Crs;

/// A conversion of x and y to longitude and latitude in degrees, in WGS 84. Its source is the definition of EPSG's register; shifts
/// of datums that need grids of corrections are not known.
pub(super) struct ToWgs84 {
    from: Proj,
    to: Proj,
}

impl ToWgs84 {
    /// The conversion from a system, or why there is none.
    pub(super) fn of(crs: &Crs) -> Result<Self, String> {
        let label = crs.label();
        let Some(definition) = crs.definition() else {
            return Err(match crs.epsg {
                Some(_) if cfg!(not(feature = "las")) => {
                    format!("the system {label} needs the register of EPSG (feature las)")
                }
                Some(_) => format!("the system {label} is not in the register of EPSG"),
                None => format!("no EPSG code is stated for the system {label}"),
            });
        };
        let unknown = |error: proj4rs::errors::Error| format!("{label} is not supported: {error}");
        Ok(Self {
            from: Proj::from_proj_string(definition).map_err(unknown)?,
            to: Proj::from_proj_string("+proj=longlat +datum=WGS84 +no_defs").map_err(unknown)?,
        })
    }

    /// The longitude and latitude of a position in degrees; `None` outside of the system.
    pub(super) fn place(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        let mut place = (x, y, 0.0);
        transform(&self.from, &self.to, &mut place).ok()?;
        let place = [place.0.to_degrees(), place.1.to_degrees()];
        place.iter().all(|angle| angle.is_finite()).then_some(place)
    }
}

#[cfg(all(test, feature = "las"))]
mod tests {
    use super::*;

    fn utm() -> Crs {
        Crs { epsg: Some(32632), ..Crs::default() }
    }

    /// The central meridian of zone 32 is 9° east; the other place was converted by PROJ 9.
    #[test]
    fn places_are_those_of_proj() {
        let conversion = ToWgs84::of(&utm()).unwrap();
        assert_eq!(conversion.place(500_000.0, 0.0), Some([9.0, 0.0]));
        let [longitude, latitude] = conversion.place(691_875.0, 5_334_000.0).unwrap();
        let wanted = [11.578_800_607_2, 48.130_307_252_5];
        assert!((longitude - wanted[0]).abs() < 1e-9 && (latitude - wanted[1]).abs() < 1e-9);
    }

    #[test]
    fn an_unknown_system_is_said() {
        let unknown = Crs { name: Some("mine".into()), ..Crs::default() };
        let why = ToWgs84::of(&unknown).err().unwrap();
        assert!(why.contains("no EPSG code is stated for the system mine"), "{why}");
        let why = ToWgs84::of(&Crs { epsg: Some(1), ..utm() }).err().unwrap();
        assert!(why.contains("EPSG:1 is not in the register"), "{why}");
    }
}
