use serde::Serialize;

use super::Simplex;
use crate::Class;
use crate::exact::Exact;

/// What is wrong with a complex: the rule that is broken, the simplex that breaks it, and the exact
/// values that show it.
///
/// Serialized with the rule as `"rule"`, exact values as text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "rule", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// A row names a point that does not exist.
    Index {
        /// The row.
        simplex: Simplex,
        /// How many input points there are.
        points: usize,
    },
    /// A row names a point twice.
    RepeatedVertex {
        /// The row.
        simplex: Simplex,
    },
    /// A simplex is listed twice.
    RepeatedSimplex {
        /// The simplex.
        simplex: Simplex,
    },
    /// A face of a listed simplex is not listed.
    MissingFace {
        /// The face.
        face: Simplex,
        /// A simplex that has it.
        of: Simplex,
    },
    /// A simplex is the face of no cell, and the complex claims to be a triangulation.
    Stray {
        /// The simplex.
        simplex: Simplex,
    },
    /// A whole triangulation has no cells.
    NoCells,
    /// A cell is not positively oriented, or flat.
    Orientation {
        /// The cell.
        cell: Simplex,
        /// det(b−a, c−a, d−a), which must be positive.
        six_volumes: Exact,
    },
    /// On a torus: an edge spans half of the box, so that the copies it joins are not clear.
    LongEdge {
        /// The edge.
        edge: Simplex,
    },
    /// A facet lies between more than two cells.
    Crowded {
        /// The facet.
        facet: Simplex,
        /// The cells that have it.
        cells: Vec<Simplex>,
    },
    /// Two cells lie on the same side of the facet they share.
    Overlap {
        /// The facet.
        facet: Simplex,
        /// The cells.
        cells: [Simplex; 2],
    },
    /// A point refutes a cell: it is inside the cell's orthogonal sphere.
    NotRegular {
        /// The cell.
        cell: Simplex,
        /// The point.
        point: u32,
        /// |point − centre|² − R² − ω of the point; zero when the perturbation decides.
        power: Exact,
    },
    /// An edge of the hull is not between two facets of the hull.
    HullEdge {
        /// The edge.
        edge: Simplex,
        /// How many facets with only one cell it has.
        facets: usize,
    },
    /// The hull bends inwards between two of its facets.
    HullBends {
        /// A facet of the hull, counter-clockwise seen from outside.
        facet: Simplex,
        /// The vertex of the neighbouring facet that is outside it.
        point: u32,
        /// Six times the volume between facet and point, which must not be positive.
        six_volumes: Exact,
    },
    /// The hull does not go around the first cell exactly once.
    HullWraps {
        /// The first facet of the hull.
        first: Simplex,
        /// A facet that does not see the first cell's centroid from outside, or that lies in the same direction
        /// from it as the first facet.
        facet: Simplex,
    },
    /// The volumes of the cells do not add up to the volume that the hull encloses.
    Volume {
        /// Six times the cells' volume.
        cells: Exact,
        /// Six times the hull's volume.
        hull: Exact,
    },
    /// A class is not what the definition says.
    Class {
        /// The simplex.
        simplex: Simplex,
        /// The class it was given.
        given: Class,
        /// The class it has.
        expected: Class,
        /// The squared radius of its smallest orthogonal sphere; none for a flat simplex.
        radius_squared: Option<Exact>,
        /// A point strictly inside that sphere, if this is what keeps the simplex out, and its
        /// |point − centre|² − R² − ω.
        refuted_by: Option<(u32, Exact)>,
    },
    /// A facet on the boundary turns clockwise seen from outside the shape.
    Winding {
        /// The facet.
        facet: Simplex,
        /// The vertex of the shape's cell beside it, which must lie behind the facet.
        behind: u32,
    },
    /// A point that is not a vertex is not hidden: it refutes the cell it lies in.
    NotHidden {
        /// The point.
        point: u32,
        /// The cell.
        cell: Simplex,
        /// |point − centre|² − R² − ω of the point; zero when the perturbation decides.
        power: Exact,
    },
    /// A point that is not a vertex lies outside the hull.
    OutsideHull {
        /// The point.
        point: u32,
        /// The facet of the hull that it is outside of.
        facet: Simplex,
        /// Six times the volume between them.
        six_volumes: Exact,
    },
    /// All faces of a cell are listed, and the definition has it, but it is not listed. It is
    /// judged as if it were, and what follows from its absence is not reported.
    MissingCell {
        /// The cell, positively oriented.
        cell: Simplex,
        /// The class it has.
        class: Class,
        /// The squared radius of its orthogonal sphere.
        radius_squared: Exact,
    },
    /// A point is in the shape by itself, with no other point inside or on its sphere, but it is
    /// not listed as a vertex.
    MissingVertex {
        /// The point.
        point: u32,
        /// The squared radius of its sphere, at most α.
        radius_squared: Exact,
    },
    /// A point is neither vertex nor listed as hidden or duplicate.
    Unaccounted {
        /// The point.
        point: u32,
    },
    /// A point is listed as hidden, and also as a vertex or a duplicate, or it does not exist.
    NotOnlyHidden {
        /// The point.
        point: u32,
    },
    /// A point at the place of another is accounted for wrongly.
    Duplicate {
        /// The point.
        point: u32,
        /// The point listed as staying in its place, if any.
        given: Option<u32>,
        /// The point that stays: the heaviest, of equal weights the first; none if the point
        /// itself does.
        expected: Option<u32>,
    },
    /// A point that gives way to a heavier or earlier one at its place is a vertex.
    DuplicateVertex {
        /// The vertex.
        point: u32,
        /// The point that stays in its place.
        stays: u32,
    },
}

impl Finding {
    /// What is found of copies, by the numbers of the points, of which there are `count`; none if it is
    /// about copies alone.
    pub(super) fn at_box(mut self, count: u32) -> Option<Self> {
        let point_at_box = |point: &mut u32| {
            let is_at_box = *point < count;
            *point %= count;
            is_at_box
        };
        let is_at_box = match &mut self {
            Self::Index { simplex: s, .. }
            | Self::RepeatedVertex { simplex: s }
            | Self::RepeatedSimplex { simplex: s }
            | Self::Stray { simplex: s }
            | Self::Orientation { cell: s, .. }
            | Self::LongEdge { edge: s }
            | Self::HullEdge { edge: s, .. }
            | Self::MissingCell { cell: s, .. } => s.fold(count),
            Self::MissingFace { face, of } => {
                of.fold(count);
                face.fold(count)
            }
            Self::Crowded { facet, cells } => {
                cells.iter_mut().for_each(|cell| _ = cell.fold(count));
                facet.fold(count)
            }
            Self::Overlap { facet, cells } => {
                cells.iter_mut().for_each(|cell| _ = cell.fold(count));
                facet.fold(count)
            }
            Self::NotRegular { cell, point, .. } | Self::NotHidden { cell, point, .. } => {
                point_at_box(point);
                cell.fold(count)
            }
            Self::HullBends { facet, point, .. }
            | Self::OutsideHull { facet, point, .. }
            | Self::Winding { facet, behind: point } => {
                point_at_box(point);
                facet.fold(count)
            }
            Self::HullWraps { first, facet } => {
                first.fold(count);
                facet.fold(count)
            }
            Self::Class { simplex, refuted_by, .. } => {
                refuted_by.iter_mut().for_each(|(point, _)| _ = point_at_box(point));
                simplex.fold(count)
            }
            Self::MissingVertex { point, .. }
            | Self::Unaccounted { point }
            | Self::NotOnlyHidden { point } => point_at_box(point),
            Self::Duplicate { point, given, expected } => {
                given.iter_mut().chain(expected).for_each(|other| *other %= count);
                point_at_box(point)
            }
            Self::DuplicateVertex { point, stays } => {
                *stays %= count;
                point_at_box(point)
            }
            Self::NoCells | Self::Volume { .. } => true,
        };
        is_at_box.then_some(self)
    }

    /// The simplex whose class or winding is wrong.
    pub(super) fn judged_class(&self) -> Option<&Simplex> {
        match self {
            Self::Class { simplex, .. } | Self::Winding { facet: simplex, .. } => Some(simplex),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_of_copies_name_points_of_the_box() {
        let power = Exact::default();
        let not_hidden = |cell: [u32; 4], point| Finding::NotHidden {
            cell: cell.into(),
            point,
            power: power.clone(),
        };
        assert_eq!(not_hidden([4, 7, 8, 11], 13).at_box(5), Some(not_hidden([4, 2, 3, 1], 3)));
        assert_eq!(not_hidden([5, 7, 8, 11], 1).at_box(5), None);
        let duplicate = |point, given, expected| Finding::Duplicate { point, given, expected };
        let folded = Some(duplicate(4, Some(3), Some(2)));
        assert_eq!(duplicate(4, Some(13), Some(7)).at_box(5), folded);
        assert_eq!(duplicate(5, Some(3), None).at_box(5), None);
        let vertex = |point, stays| Finding::DuplicateVertex { point, stays };
        assert_eq!(vertex(0, 9).at_box(5), Some(vertex(0, 4)));
        assert_eq!(Finding::NoCells.at_box(5), Some(Finding::NoCells));
    }
}
