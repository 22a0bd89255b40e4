//! Findings in words.

use std::fmt;

use super::Finding;
use crate::exact::Exact;

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { simplex, points } => {
                write!(f, "{simplex} names a point that does not exist: there are {points}")
            }
            Self::RepeatedVertex { simplex } => write!(f, "{simplex} names a point twice"),
            Self::RepeatedSimplex { simplex } => write!(f, "{simplex} is listed twice"),
            Self::MissingFace { face, of } => write!(f, "{face} is missing: {of} has it as a face"),
            Self::Stray { simplex } => {
                write!(f, "{simplex} is the face of no higher simplex of the triangulation")
            }
            Self::NoCells => write!(f, "there are no cells, so this is no triangulation"),
            Self::Orientation { cell, six_volumes } => write!(
                f,
                "{cell} must be positively oriented, but six times its volume is {six_volumes}"
            ),
            Self::Crowded { facet, cells } => {
                write!(f, "{facet} is shared by {} cells, not by at most two:", cells.len())?;
                cells.iter().try_for_each(|cell| write!(f, " {:?}", cell.vertices()))
            }
            Self::Overlap { facet, cells: [a, b] } => {
                write!(f, "{a} and {b} overlap: both are on the same side of {facet}")
            }
            Self::NotRegular { cell, point, power } => {
                write!(f, "{cell} is not regular: point {point} is inside its orthogonal sphere")?;
                write_power(f, power)
            }
            Self::HullEdge { edge, facets } => {
                write!(f, "{edge} of the hull lies between {facets} facets with one cell, not two")
            }
            Self::HullBends { facet, point, six_volumes } => write!(
                f,
                "the hull is not convex: point {point} is outside {facet} (six volumes {six_volumes})"
            ),
            Self::HullWraps { first, facet } => write!(
                f,
                "the hull does not go around the first cell once: {facet} does not face away from it, or lies behind {first}"
            ),
            Self::Volume { cells, hull } => write!(
                f,
                "the cells do not fill the hull: six times their volume is {cells}, six times the hull's {hull}"
            ),
            Self::Class { simplex, given, expected, radius_squared, refuted_by } => {
                write!(f, "{simplex} is {expected}, not {given}")?;
                match radius_squared {
                    Some(radius) => write!(f, " (squared radius {radius})")?,
                    None => write!(f, " (its corners are in one place or on one line or plane)")?,
                }
                match refuted_by {
                    Some((point, power)) => {
                        write!(f, "; point {point} is inside its sphere (power {power})")
                    }
                    None => Ok(()),
                }
            }
            Self::Winding { facet, behind } => write!(
                f,
                "{facet} must turn counter-clockwise seen from outside, but point {behind} of the shape is before it"
            ),
            Self::NotHidden { point, cell, power } => {
                write!(
                    f,
                    "point {point} is not hidden: it is inside the orthogonal sphere of {cell}, in which it lies"
                )?;
                write_power(f, power)
            }
            Self::OutsideHull { point, facet, six_volumes } => write!(
                f,
                "point {point} lies outside the hull, beyond {facet} (six volumes {six_volumes})"
            ),
            Self::MissingCell { cell, class, radius_squared } => write!(
                f,
                "{cell} is missing: all its faces are listed, and it is {class} (squared radius {radius_squared})"
            ),
            Self::MissingVertex { point, radius_squared } => write!(
                f,
                "point {point} is missing: it is a vertex of the shape (squared radius {radius_squared}, and no other point inside)"
            ),
            Self::Unaccounted { point } => {
                write!(f, "point {point} is neither vertex nor hidden nor a duplicate")
            }
            Self::NotOnlyHidden { point } => {
                write!(
                    f,
                    "point {point} is listed as hidden, but it is a vertex, a duplicate, listed before or no point"
                )
            }
            Self::Duplicate { point, given, expected } => {
                let stays = |who: &Option<u32>| match who {
                    Some(other) => format!("gives way to point {other}"),
                    None => "stays".into(),
                };
                write!(f, "point {point} {}, but as listed it {}", stays(expected), stays(given))
            }
            Self::DuplicateVertex { point, stays } => {
                write!(f, "point {point} is a vertex, but gives way to point {stays} at its place")
            }
        }
    }
}

fn write_power(f: &mut fmt::Formatter<'_>, power: &Exact) -> fmt::Result {
    if power.is_zero() {
        write!(f, " (on it, and inside by the perturbation)")
    } else {
        write!(f, " (power {power})")
    }
}
