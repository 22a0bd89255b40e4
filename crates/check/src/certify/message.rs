//! Findings as text, one line each. Exact numbers are rounded to six digits; the alternate form (`{:#}`) has them as fractions.

use std::fmt::{self, Formatter};

use super::finding::{Finding, Simplex};
use crate::Class;
use crate::exact::Exact;

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { simplex, points } => {
                write!(f, "{simplex} names a point that does not exist: there are {points}")
            }
            Self::RepeatedVertex { simplex } => write!(f, "{simplex} names a point twice"),
            Self::RepeatedSimplex { simplex } => write!(f, "{simplex} is listed twice"),
            Self::MissingFace { face, of } => write!(f, "{face} is missing: {of} has it as a face"),
            Self::Stray { simplex } => write!(f, "{simplex} is not a face of any higher simplex"),
            Self::NoCells => write!(
                f,
                "a whole triangulation needs cells (facets if all points are in one plane, edges on one line), and there are none"
            ),
            Self::Orientation { cell, six_volumes } => orientation(f, cell, six_volumes),
            Self::LongEdge { edge } => {
                write!(
                    f,
                    "{edge} spans half of the periodic box or more: which copies it joins is ambiguous"
                )
            }
            Self::Crowded { facet, cells } => crowded(f, facet, cells),
            Self::Overlap { facet, cells: [a, b] } => {
                write!(f, "{a} and {b} overlap: both are on the same side of {facet}")
            }
            Self::NotRegular { cell, point, power } => not_regular(f, cell, *point, power),
            Self::HullEdge { edge, facets } => {
                write!(f, "{edge} of the hull lies between {facets} facets with one cell, not two")
            }
            Self::HullBends { facet, point, six_volumes } => {
                write!(f, "the hull is not convex: point {point} lies")?;
                beyond(f, facet, six_volumes)
            }
            Self::HullWraps { first, facet } => wraps(f, first, facet),
            Self::OpenFacet { facet } => write!(
                f,
                "{facet} has a cell on one side only, and a whole triangulation of a torus has no boundary there"
            ),
            Self::Volume { cells, hull } => volume(f, cells, hull),
            Self::Class { simplex, given, expected, radius_squared, refuted_by } => {
                write!(f, "{simplex} is {expected}, not {given}")?;
                reason(f, radius_squared.as_ref(), refuted_by.as_ref())
            }
            Self::Winding { facet, behind } => winding(f, facet, *behind),
            Self::NotHidden { point, cell, power } => not_hidden(f, *point, cell, power),
            Self::OutsideHull { point, facet, six_volumes } => {
                write!(f, "point {point} lies outside the hull,")?;
                beyond(f, facet, six_volumes)
            }
            Self::MissingCell { cell, class, radius_squared } => {
                missing_cell(f, cell, *class, radius_squared)
            }
            Self::MissingSimplex { simplex, points, radius_squared } => {
                missing_simplex(f, simplex, points, radius_squared)
            }
            Self::MissingVertex { point, radius_squared } => {
                missing_vertex(f, *point, radius_squared)
            }
            Self::Unaccounted { point } => {
                write!(f, "point {point} is neither a vertex, nor hidden, nor a duplicate")
            }
            Self::NotOnlyHidden { point } => not_only_hidden(f, *point),
            Self::Duplicate { point, given, expected } => duplicate(f, *point, *given, *expected),
            Self::EqualPoint { point, first } => write!(
                f,
                "point {point} is kept at its position, where point {first} with the same weight comes first"
            ),
            Self::TiedSphere { simplex, points, listed } => write!(
                f,
                "{} points lie on the sphere of {simplex}, and the {listed} simplices of its dimension that are listed there do not triangulate them",
                points.len()
            ),
            Self::TiedFacets { facet, other } => write!(
                f,
                "{facet} and {other} lie in one plane and on one sphere, but have cells on different sides: they cross"
            ),
            Self::SpannedSphere { simplex, point } => write!(
                f,
                "{simplex} is not a face of any listed simplex, but point {point} lies on its sphere, too: the simplex that they span is missing"
            ),
            Self::NotACorner { point } => {
                write!(f, "point {point} is not at a corner of a voxel, or not alone there")
            }
            Self::NotABorder { facet } => write!(
                f,
                "{facet} has one cell, but is not half of a face between a voxel of the region and one outside of it"
            ),
            Self::Unfilled { voxel, side } => write!(
                f,
                "voxel {voxel:?} is in the region and its neighbour {} along axis {} is not, but no cells end at the face between them",
                if *side < 0 { "before it" } else { "behind it" },
                ["x", "y", "z"][usize::from(side.unsigned_abs().clamp(1, 3)) - 1]
            ),
            Self::DuplicateVertex { point, kept } => {
                write!(f, "point {point} is a vertex, but point {kept} is kept at its position")
            }
        }
    }
}

/// A number in the form that is asked for.
pub(super) fn number(exact: &Exact, f: &Formatter<'_>) -> String {
    if f.alternate() { format!("{exact:#}") } else { exact.to_string() }
}

/// Two numbers, exact where they differ and six digits do not tell them apart.
pub(super) fn apart(numbers: [&Exact; 2], f: &Formatter<'_>) -> [String; 2] {
    let [a, b] = numbers.map(|exact| number(exact, f));
    if a == b && numbers[0] != numbers[1] {
        numbers.map(|exact| format!("{exact:#}"))
    } else {
        [a, b]
    }
}

fn orientation(f: &mut Formatter<'_>, cell: &Simplex, six_volumes: &Exact) -> fmt::Result {
    let six_volumes = number(six_volumes, f);
    write!(f, "{cell} must be positively oriented, but six times its volume is {six_volumes}")
}

fn crowded(f: &mut Formatter<'_>, facet: &Simplex, cells: &[Simplex]) -> fmt::Result {
    write!(f, "{facet} is shared by {} cells, not by at most two:", cells.len())?;
    cells.iter().try_for_each(|cell| write!(f, " {:?}", cell.vertices()))
}

fn not_regular(f: &mut Formatter<'_>, cell: &Simplex, point: u32, power: &Exact) -> fmt::Result {
    write!(f, "{cell} is not regular: point {point} is inside its orthogonal sphere")?;
    by_power(f, power)
}

fn beyond(f: &mut Formatter<'_>, facet: &Simplex, six_volumes: &Exact) -> fmt::Result {
    let six_volumes = number(six_volumes, f);
    write!(f, " beyond {facet} (six times the volume between them is {six_volumes})")
}

fn wraps(f: &mut Formatter<'_>, first: &Simplex, facet: &Simplex) -> fmt::Result {
    write!(
        f,
        "the hull does not go around the first cell once: {facet} does not face away from it, or lies behind {first}"
    )
}

fn volume(f: &mut Formatter<'_>, cells: &Exact, hull: &Exact) -> fmt::Result {
    let [cells, hull] = apart([cells, hull], f);
    write!(
        f,
        "the cells do not fill the hull: six times their volume is {cells}, six times the hull's {hull}"
    )
}

/// Why the class is not the given one.
fn reason(
    f: &mut Formatter<'_>,
    radius_squared: Option<&Exact>,
    refuted_by: Option<&(u32, Exact)>,
) -> fmt::Result {
    match radius_squared {
        Some(radius) => write!(f, " (squared radius {})", number(radius, f))?,
        None => write!(f, " (its corners are at one position, or on one line or plane)")?,
    }
    match refuted_by {
        Some((point, power)) => {
            write!(f, "; point {point} is inside its sphere (power {})", number(power, f))
        }
        None => Ok(()),
    }
}

fn winding(f: &mut Formatter<'_>, facet: &Simplex, behind: u32) -> fmt::Result {
    write!(
        f,
        "{facet} must turn counter-clockwise seen from outside, but point {behind} of the shape is in front of it"
    )
}

fn not_hidden(f: &mut Formatter<'_>, point: u32, cell: &Simplex, power: &Exact) -> fmt::Result {
    write!(
        f,
        "point {point} is not hidden: it is inside the orthogonal sphere of {cell}, in which it lies"
    )?;
    by_power(f, power)
}

fn missing_cell(
    f: &mut Formatter<'_>,
    cell: &Simplex,
    class: Class,
    radius_squared: &Exact,
) -> fmt::Result {
    let radius_squared = number(radius_squared, f);
    write!(
        f,
        "{cell} is missing: all its faces are listed, and it is {class} (squared radius {radius_squared})"
    )
}

fn missing_simplex(
    f: &mut Formatter<'_>,
    simplex: &Simplex,
    points: &[u32],
    radius: &Exact,
) -> fmt::Result {
    let (more, radius) = (points.len() - simplex.vertices().len(), number(radius, f));
    if more == 0 {
        write!(
            f,
            "{simplex} is missing: it is in the shape (squared radius {radius}, and no point inside)"
        )
    } else {
        write!(
            f,
            "the hull of the {} points on the sphere of {simplex} is in the shape (squared radius {radius}, and no point inside), but no simplices listed cover it",
            points.len()
        )
    }
}

fn missing_vertex(f: &mut Formatter<'_>, point: u32, radius_squared: &Exact) -> fmt::Result {
    let radius_squared = number(radius_squared, f);
    write!(
        f,
        "point {point} is missing: it is a vertex of the shape (squared radius {radius_squared}, and no other point inside)"
    )
}

fn not_only_hidden(f: &mut Formatter<'_>, point: u32) -> fmt::Result {
    write!(
        f,
        "point {point} is listed as hidden, but it is a vertex or a duplicate, is listed twice, or does not exist"
    )
}

fn duplicate(
    f: &mut Formatter<'_>,
    point: u32,
    given: Option<u32>,
    expected: Option<u32>,
) -> fmt::Result {
    let status = |kept: Option<u32>| match kept {
        Some(kept) => format!("a duplicate of point {kept}"),
        None => "no duplicate".into(),
    };
    write!(
        f,
        "point {point} is {}, but the list says that it is {}",
        status(expected),
        status(given)
    )
}

/// By how much a point is inside a sphere.
fn by_power(f: &mut Formatter<'_>, power: &Exact) -> fmt::Result {
    if power.is_zero() {
        write!(f, " (on the sphere, and inside by the perturbation)")
    } else {
        write!(f, " (power {})", number(power, f))
    }
}
