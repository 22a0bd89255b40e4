//! The meaning of stored numbers, by the conventions for climate and forecast data (CF) that xarray and netCDF follow.

use std::io::Read;
use std::path::Path;

use serde_json::{Map, Value};
use walpha_base::shown::shown;
use zarrs::array::{Array, ArrayMetadata};
use zarrs::filesystem::FilesystemStore;

use super::samples::dtype;
use crate::error::format_error;
use crate::read::vtk::Base64;
use crate::rounding::Rounding;
use crate::{Dtype, Reason, Sample, VolumeError};

/// Converts the numbers that an array stores to its samples.
#[derive(Debug)]
pub(super) struct Packing {
    /// The type of stored numbers.
    pub(super) stored: Dtype,
    /// Whether signed whole numbers stand for unsigned ones (`_Unsigned`).
    unsigned: bool,
    /// The stored numbers that stand for a missing sample (`_FillValue`, `missing_value`).
    missing: Vec<f64>,
    /// `scale_factor` and `add_offset`.
    scaling: Option<(f64, f64)>,
    /// Records whether whole numbers were rounded.
    pub(super) rounding: Rounding,
}

/// The bounds outside of which samples are missing for CF, but not for xarray.
const BOUNDS: [&str; 3] = ["valid_min", "valid_max", "valid_range"];

impl Packing {
    /// The packing that the attributes of an array state.
    pub(super) fn of(path: &Path, array: &Array<FilesystemStore>) -> Result<Self, VolumeError> {
        let stored = dtype(path, array.data_type())?;
        let packing = Self::stated(path, array.attributes(), stored)?;
        // Zarr itself fills with 0.
        if let ArrayMetadata::V2(metadata) = array.metadata()
            && metadata.attributes.contains_key("_ARRAY_DIMENSIONS")
            && let Some(fill) = serde_json::json!(metadata.fill_value).as_f64()
            && fill != 0.0
            && !packing.missing.contains(&fill)
        {
            tracing::warn!(
                "{}: its fill_value {fill} is read as a sample; xarray treats it as missing",
                shown(path)
            );
        }
        Ok(packing)
    }

    fn stated(
        path: &Path,
        attributes: &Map<String, Value>,
        stored: Dtype,
    ) -> Result<Self, VolumeError> {
        let numbers = |name: &str| -> Result<Vec<f64>, VolumeError> {
            let Some(value) = attributes.get(name) else { return Ok(Vec::new()) };
            let all = match value {
                Value::Array(all) => all.as_slice(),
                one => std::slice::from_ref(one),
            };
            let number = |value: &Value| match value.as_str() {
                Some(text) => text.trim().parse().ok().or_else(|| double(text)),
                None => value.as_f64(),
            };
            all.iter().map(number).collect::<Option<_>>().ok_or_else(|| {
                let what = format!("has the attribute {name} = {value}, which is not a number");
                format_error(path, Reason::header(what))
            })
        };
        let number = |name: &str, default: f64| match numbers(name)?.as_slice() {
            [] => Ok(default),
            &[number] if number.is_finite() => Ok(number),
            other => {
                let what = format!("has the attribute {name} = {other:?}, which is not one number");
                Err(format_error(path, Reason::header(what)))
            }
        };
        let scaling = (number("scale_factor", 1.0)?, number("add_offset", 0.0)?);
        let mut missing = [numbers("_FillValue")?, numbers("missing_value")?].concat();
        if stored == Dtype::F32 {
            missing.iter_mut().for_each(|number| *number = f64::from(*number as f32));
        }
        if let Some(bound) = BOUNDS.into_iter().find(|name| attributes.contains_key(*name)) {
            tracing::warn!(
                "{}: its {bound} is passed over: samples outside are read as they are",
                shown(path)
            );
        }
        let unsigned = attributes.get("_Unsigned").is_some_and(|value| {
            value.as_bool() == Some(true)
                || value.as_str().is_some_and(|text| text.eq_ignore_ascii_case("true"))
        });
        let scaling = (scaling != (1.0, 0.0)).then_some(scaling);
        let rounding = Rounding::default();
        Ok(Self { stored, unsigned, missing, scaling, rounding })
    }

    /// The type of samples. If some are missing, they are floats.
    pub(super) fn dtype(&self) -> Dtype {
        match self.stored {
            _ if self.scaling.is_some() || !self.missing.is_empty() => Dtype::F32,
            Dtype::I8 if self.unsigned => Dtype::U8,
            Dtype::I16 if self.unsigned => Dtype::U16,
            Dtype::I32 if self.unsigned => Dtype::U32,
            Dtype::I64 if self.unsigned => Dtype::U64,
            stored => stored,
        }
    }

    /// The value that a stored number stands for; NaN if it is missing.
    pub(super) fn value(&self, stored: f64) -> f64 {
        let is_missing = |number: f64| self.missing.contains(&number);
        let wraps = self.unsigned && stored < 0.0;
        let meant = if wraps { stored + 256f64.powi(self.stored.size() as i32) } else { stored };
        if is_missing(stored) || is_missing(meant) {
            return f64::NAN;
        }
        self.scaling.map_or(meant, |(factor, offset)| meant * factor + offset)
    }

    /// The sample that a stored number stands for; `exact` is the same number as a double.
    pub(super) fn sample(&self, stored: impl Sample, exact: f64) -> f32 {
        if self.is_none() { self.rounding.sample(stored) } else { self.value(exact) as f32 }
    }

    /// Whether some numbers stand for missing samples.
    pub(super) fn states_missing(&self) -> bool {
        !self.missing.is_empty()
    }

    /// Whether stored numbers are the samples.
    fn is_none(&self) -> bool {
        !self.unsigned && self.missing.is_empty() && self.scaling.is_none()
    }
}

/// Decodes a double as xarray writes it in version 3: its bytes in base64.
fn double(text: &str) -> Option<f64> {
    let mut bytes = Vec::new();
    Base64::new(text.as_bytes()).read_to_end(&mut bytes).ok()?;
    Some(f64::from_le_bytes(bytes.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn packing(attributes: Value, stored: Dtype) -> Option<Packing> {
        Packing::stated(Path::new("a"), attributes.as_object().unwrap(), stored).ok()
    }

    #[test]
    fn stored_numbers_become_samples() {
        let packed =
            |attributes, stored, number| packing(attributes, stored).unwrap().value(number);
        let scaled = json!({"scale_factor": [0.5], "add_offset": "-1000"});
        assert_eq!(packed(scaled.clone(), Dtype::I16, 3.0), -998.5);
        assert_eq!(packing(scaled, Dtype::U8).unwrap().dtype(), Dtype::F32);
        // Missing values are stored numbers, before these lose their sign or are scaled.
        let fill = json!({"_FillValue": -1, "missing_value": [7, 254], "_Unsigned": "true"});
        for number in [-1.0, 7.0, -2.0] {
            assert!(packed(fill.clone(), Dtype::I8, number).is_nan(), "{number}");
        }
        assert_eq!(packed(fill, Dtype::I8, -3.0), 253.0);
        assert_eq!(packing(json!({"_Unsigned": true}), Dtype::I8).unwrap().dtype(), Dtype::U8);
        assert_eq!(packed(json!({"_Unsigned": "true"}), Dtype::I16, -1.0), 65535.0);
        // 1e20 is not an `f32`.
        let of_floats = json!({"_FillValue": 1e20});
        assert!(packed(of_floats, Dtype::F32, f64::from(1e20f32)).is_nan());
        assert!(packed(json!({"_FillValue": "AAAAAACHw8A="}), Dtype::F64, -9998.0).is_nan());
        for nan in ["NaN", "AAAAAAAA+H8="] {
            assert_eq!(packed(json!({"_FillValue": nan}), Dtype::F32, 2.0), 2.0, "{nan}");
        }
        for none in [json!({"scale_factor": 1, "_Unsigned": "false"}), json!({"units": "mm"})] {
            assert!(packing(none, Dtype::I8).unwrap().is_none());
        }
        for wrong in [json!({"scale_factor": "a"}), json!({"add_offset": [1, 2]})] {
            assert!(packing(wrong, Dtype::I8).is_none());
        }
    }
}
