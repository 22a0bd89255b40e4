//! Where the grid of an NRRD file lies.

use std::path::Path;

use super::Header;
use crate::read::described::{diagonal, frame};
use crate::read::format_error;
use crate::{Coordinates, Frame, LengthUnit, Reason, Space, VolumeError};

impl Header {
    /// Where the grid lies; `kept` are the axes that are read, of `all`, and `dims` their sizes.
    ///
    /// `space directions` and `space origin` say it, or else `spacings` and `axis mins`, or `axis mins`
    /// and `axis maxs`. The ends of an axis are those of its samples, or lie half a spacing beyond
    /// their middles where `centerings` says `cell` or nothing, as teem and ITK take it.
    pub(super) fn frame(
        &self,
        path: &Path,
        all: usize,
        kept: &[usize],
        dims: [usize; 3],
    ) -> Result<Frame, VolumeError> {
        let said = |reason: Reason| format_error(path, reason);
        let mut steps = diagonal([1.0; 3]);
        let mut origin = [0.0; 3];
        if let Some(text) = self.field("space directions") {
            let directions = vectors(text).filter(|rows| rows.len() == all).ok_or_else(|| {
                said(Reason::header(format!(
                    "space directions: {text} are not {all} vectors of numbers"
                )))
            })?;
            for (step, &axis) in steps.iter_mut().zip(kept) {
                if let Some(direction) = directions[axis] {
                    *step = direction;
                }
            }
        } else {
            let [spacings, mins, maxs] = [
                self.numbers(path, &["spacings"], all)?,
                self.numbers(path, &["axis mins", "axismins"], all)?,
                self.numbers(path, &["axis maxs", "axismaxs"], all)?,
            ];
            let centers = self.field("centerings").or(self.field("centers")).unwrap_or_default();
            let centers: Vec<&str> = centers.split_whitespace().collect();
            for (c, &axis) in kept.iter().enumerate() {
                let node = centers.get(axis).is_some_and(|center| *center == "node");
                let parts = if node { dims[c] - 1 } else { dims[c] };
                let ends = mins[axis].zip(maxs[axis]).filter(|_| parts > 0);
                let between = ends.map(|(low, high)| (high - low) / parts as f64);
                if let Some(step) = spacings[axis].or(between) {
                    steps[c][c] = step;
                }
                if let Some(low) = mins[axis] {
                    origin[c] = if node { low } else { low + steps[c][c] / 2.0 };
                }
            }
        }
        if let Some(text) = self.field("space origin") {
            origin = match vectors(text).as_deref() {
                Some([Some(origin)]) => *origin,
                _ => {
                    return Err(said(Reason::header(format!(
                        "space origin: {text} is not a vector of numbers"
                    ))));
                }
            };
        }
        frame(path, origin, steps, self.coordinates(kept))
    }

    /// The space the file names, and its unit: of `space units`, or else of `units`. A patient is
    /// measured in millimetres where neither is there, as ITK and Slicer take it.
    fn coordinates(&self, kept: &[usize]) -> Coordinates {
        let places = ["space directions", "space origin", "spacings", "axis mins", "axismins"];
        if places.iter().all(|name| self.field(name).is_none()) {
            return Coordinates::VOXEL;
        }
        let space = match self.field("space").unwrap_or_default().to_lowercase().as_str() {
            "left-posterior-superior" | "lps" => Space::Lps,
            "right-anterior-superior" | "ras" => Space::Ras,
            "left-anterior-superior" | "las" => Space::Las,
            _ => Space::Unknown,
        };
        let of_axes = || self.field("units").map(|text| (text, kept.first().copied().unwrap_or(0)));
        let named = self.field("space units").map(|text| (text, 0)).or_else(of_axes);
        let named = named.and_then(|(text, axis)| quoted(text).nth(axis));
        let unit = match named.map(LengthUnit::named) {
            Some(unit) if unit != LengthUnit::Unstated => unit,
            _ if space.is_known() => LengthUnit::Millimetre,
            _ => LengthUnit::Unstated,
        };
        Coordinates { space, unit }
    }

    /// A number for each axis; `None` if the field is absent or NaN, which means
    /// "unknown".
    fn numbers(
        &self,
        path: &Path,
        names: &[&str],
        all: usize,
    ) -> Result<Vec<Option<f64>>, VolumeError> {
        let Some(text) = names.iter().find_map(|name| self.field(name)) else {
            return Ok(vec![None; all]);
        };
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(|n| n.parse().ok()).collect();
        let numbers = numbers.filter(|numbers| numbers.len() == all).ok_or_else(|| {
            format_error(
                path,
                Reason::header(format!("{}: {text} are not {all} numbers", names[0])),
            )
        })?;
        Ok(numbers.into_iter().map(|number| (!number.is_nan()).then_some(number)).collect())
    }
}

/// Words such as `"mm" "mm" ""`, without their quotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2)
}

/// Vectors such as `(1,0,0) none (0,0,2)`, of up to three components.
fn vectors(text: &str) -> Option<Vec<Option<[f64; 3]>>> {
    let mut rest = text.trim();
    let mut rows = Vec::new();
    while !rest.is_empty() {
        if let Some(after) = rest.strip_prefix("none") {
            rows.push(None);
            rest = after.trim_start();
            continue;
        }
        let (row, after) = rest.strip_prefix('(')?.split_once(')')?;
        let numbers: Vec<f64> =
            row.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
        let mut vector = [0.0; 3];
        vector.get_mut(..numbers.len())?.copy_from_slice(&numbers);
        rows.push(Some(vector));
        rest = after.trim_start();
    }
    Some(rows)
}
