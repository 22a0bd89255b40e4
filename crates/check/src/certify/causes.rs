//! One mistake that explains many findings: numbers that mean something else than α, or a rule that was left out.

use std::fmt;

use serde::Serialize;
use walpha_base::shown::number;

use super::filtration::{Bound, FiltrationFinding};
use super::finding::{Finding, Simplex};
use super::structure::{self, Points};
use crate::exact::radius_value;
use crate::schema::FiltrationFile;
use crate::{Alpha, Class};

/// A mistake that would explain most findings of a kind, and of how many it does.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LikelyCause {
    /// The mistake.
    #[serde(flatten)]
    pub cause: Cause,
    /// How many findings it explains.
    pub findings: usize,
    /// How many findings there are on what it is about: values, or classes.
    pub of: usize,
}

/// A mistake that explains many findings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "cause", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Cause {
    /// The value of an attached simplex, in whose smallest orthogonal sphere a point lies, is the squared radius of that
    /// sphere, and not the value of a coface.
    AttachedByOwnRadius,
    /// Values are roots of α: radii.
    Radii,
    /// Values are 4 α: squared diameters.
    SquaredDiameters,
    /// Values are 2 √α: diameters.
    Diameters,
    /// An attached simplex has the class that its own sphere alone would give it.
    ClassByOwnRadius,
    /// Cells have the classes of another α.
    OtherAlpha {
        /// The other α: the square of the stated one, or its root.
        alpha: Alpha,
    },
}

impl fmt::Display for LikelyCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { cause, findings, of } = self;
        let share =
            if findings == of { format!("all {of}") } else { format!("{findings} of {of}") };
        match cause {
            Cause::AttachedByOwnRadius => write!(
                f,
                "{share} wrong values are of attached simplices, in whose spheres a point lies, and are the squared radii of these spheres (circumradii); \
                 such a simplex has the smallest value of its cofaces"
            ),
            Cause::Radii => {
                write!(
                    f,
                    "{share} wrong values are radii, the square roots of those expected: α is a squared length"
                )
            }
            Cause::SquaredDiameters => {
                write!(
                    f,
                    "{share} wrong values are squared diameters, 4 times those expected: α is a squared radius"
                )
            }
            Cause::Diameters => {
                write!(f, "{share} wrong values are diameters: α is a squared radius")
            }
            Cause::ClassByOwnRadius => write!(
                f,
                "{share} wrong classes are of attached simplices, in whose spheres a point lies, as if these spheres alone decided; such a simplex is in \
                 the shape with the first of its cofaces"
            ),
            Cause::OtherAlpha { alpha } => write!(
                f,
                "{share} wrong cells have the classes of α = {}: the stated α may be a radius, or a radius may have been taken for α, a squared length",
                number(alpha.squared())
            ),
        }
    }
}

/// The share of findings that a cause must explain, in hundredths.
const MOST: usize = 90;
/// The fewest findings that have a cause in common.
const FEWEST: usize = 3;

/// The cause that explains most findings.
fn best(found: impl IntoIterator<Item = (Cause, usize)>, of: usize) -> Option<LikelyCause> {
    // Of causes that explain equally many the first counts.
    let best = found.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
    let (cause, findings) = best?;
    let explains = findings >= FEWEST && 100 * findings >= MOST * of;
    explains.then_some(LikelyCause { cause, findings, of })
}

/// What most findings on the classes of a complex, which was judged at α, have in common.
pub fn likely_cause(findings: &[Finding], alpha: Alpha) -> Option<LikelyCause> {
    let mut classes = 0;
    let mut attached = 0;
    let mut cells = Vec::new();
    for finding in findings {
        let Finding::Class { simplex, given, radius_squared, refuted_by, .. } = finding else {
            continue;
        };
        classes += 1;
        attached += usize::from(refuted_by.is_some());
        if let (4, Some(radius)) = (simplex.vertices().len(), radius_squared) {
            cells.push((radius.nearest(), *given == Class::Interior));
        }
    }
    let of_attached = best([(Cause::ClassByOwnRadius, attached)], classes);
    let squared = alpha.squared();
    let others = [squared * squared, squared.sqrt()].into_iter().filter_map(|other| {
        let alpha = Alpha::from_squared(other).ok().filter(|alpha| alpha.squared().is_finite())?;
        let fits = cells.iter().filter(|(radius, inside)| (*radius <= other) == *inside).count();
        Some((Cause::OtherAlpha { alpha }, fits))
    });
    best(others, cells.len()).or(of_attached)
}

/// What most findings on the values of a filtration have in common.
pub fn likely_cause_of_values(
    findings: &[FiltrationFinding],
    file: &FiltrationFile,
) -> Option<LikelyCause> {
    let weights = file.weights.clone().unwrap_or_else(|| vec![0.0; file.points.len()]);
    let sites = structure::sites(&file.points, &weights);
    let points = Points { sites: &sites };
    let mut values = 0;
    let causes =
        [Cause::Radii, Cause::SquaredDiameters, Cause::Diameters, Cause::AttachedByOwnRadius];
    let mut explained = [0; 4];
    for finding in findings {
        let FiltrationFinding::When { simplex, bound: Bound::Value, given, expected, .. } = finding
        else {
            continue;
        };
        values += 1;
        let [given, expected] = [given, expected].map(|alpha| alpha.squared());
        let fits = [
            given >= 0.0 && is_near(given * given, expected),
            is_near(given, 4.0 * expected),
            given >= 0.0 && is_near(given * given, 4.0 * expected),
            own_radius(simplex, points).is_some_and(|own| is_near(given, own)),
        ];
        for (count, fits) in explained.iter_mut().zip(fits) {
            *count += usize::from(fits);
        }
    }
    best(causes.into_iter().zip(explained), values)
}

/// The squared radius of the smallest orthogonal sphere of a simplex of dimension 0 to 2.
fn own_radius(simplex: &Simplex, points: Points) -> Option<f64> {
    Some(
        match *simplex.vertices() {
            [a] => radius_value(points.corners([a]).each_ref()),
            [a, b] => radius_value(points.corners([a, b]).each_ref()),
            [a, b, c] => radius_value(points.corners([a, b, c]).each_ref()),
            _ => return None,
        }
        .nearest(),
    )
}

/// Whether two numbers are equal but for what single precision or a few operations round.
fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}
