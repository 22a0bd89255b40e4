//! Findings: the rules that can be broken, each with the simplices and exact values that show it.

use std::fmt;
use std::slice::from_ref;

use serde::Serialize;

use crate::Class;
use crate::exact::Exact;

/// A simplex by the input indices of its vertices.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Simplex(Vec<u32>);

impl Simplex {
    /// The vertices, as the judged complex lists them.
    pub fn vertices(&self) -> &[u32] {
        &self.0
    }
}

impl<const N: usize> From<[u32; N]> for Simplex {
    fn from(row: [u32; N]) -> Self {
        Self(row.to_vec())
    }
}

impl fmt::Display for Simplex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = ["vertex", "edge", "facet", "cell"][self.0.len().clamp(1, 4) - 1];
        write!(f, "{name} {:?}", self.0)
    }
}

impl Simplex {
    /// Drops the vertices from this number on.
    pub(super) fn drop_from(&mut self, first: u32) {
        self.0.retain(|&v| v < first);
    }

    /// Replaces each vertex `v` by `numbers[v]`.
    pub(super) fn renumber(&mut self, numbers: &[u32]) {
        self.0.iter_mut().for_each(|v| *v = numbers[*v as usize]);
    }

    /// Replaces copies by the `count` points that they are copies of. Returns whether any vertex is not a
    /// copy.
    pub(super) fn fold(&mut self, count: u32) -> bool {
        let is_at_box = self.0.iter().any(|&v| v < count);
        self.0.iter_mut().for_each(|v| *v %= count);
        is_at_box
    }
}

/// A fault of a complex: the rule that is broken, the simplex that breaks it, and the exact values that show it.
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
        /// Number of input points.
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
    /// A simplex is not the face of a cell, but the complex claims to be a triangulation.
    Stray {
        /// The simplex.
        simplex: Simplex,
    },
    /// A whole triangulation has no cells, or, if points span no volume, none of the largest simplices.
    NoCells,
    /// A cell is not positively oriented, or flat.
    Orientation {
        /// The cell.
        cell: Simplex,
        /// det(b−a, c−a, d−a), which must be positive.
        six_volumes: Exact,
    },
    /// On a torus: an edge spans half of the box or more, so it is ambiguous which copies it joins.
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
        /// Number of its facets with only one cell.
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
        /// A facet that does not face away from the first cell's centroid, or that lies in the same direction
        /// from it as the first facet.
        facet: Simplex,
    },
    /// In a whole triangulation of a torus: a facet has a cell on only one side.
    OpenFacet {
        /// The facet, counter-clockwise seen from the other side.
        facet: Simplex,
    },
    /// The volumes of the cells do not add up to the volume that the hull encloses.
    Volume {
        /// Six times the cells' volume.
        cells: Exact,
        /// Six times the hull's volume.
        hull: Exact,
    },
    /// A class differs from the definition.
    Class {
        /// The simplex.
        simplex: Simplex,
        /// The given class.
        given: Class,
        /// The class by the definition.
        expected: Class,
        /// The squared radius of its smallest orthogonal sphere; `None` for a flat simplex.
        radius_squared: Option<Exact>,
        /// A point strictly inside that sphere, if it excludes the simplex from the shape, and its |point − centre|² − R² − ω.
        refuted_by: Option<(u32, Exact)>,
    },
    /// A boundary facet turns clockwise, as seen from outside the shape.
    Winding {
        /// The facet.
        facet: Simplex,
        /// The vertex opposite the facet in the shape's cell at it, which must lie behind the facet.
        behind: u32,
    },
    /// A point that is not a vertex is not hidden: it refutes the cell that contains it.
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
        /// The facet of the hull that it lies beyond.
        facet: Simplex,
        /// Six times the volume between them.
        six_volumes: Exact,
    },
    /// A cell is not listed although all its faces are listed and the definition contains it. The complex is judged as if the
    /// cell were listed, and the consequences of its absence are not reported.
    MissingCell {
        /// The cell, positively oriented.
        cell: Simplex,
        /// The class it has.
        class: Class,
        /// The squared radius of its orthogonal sphere.
        radius_squared: Exact,
    },
    /// Points lie on an empty sphere of squared radius at most α, but the listed simplices do not cover their hull, which is in
    /// the shape.
    MissingSimplex {
        /// A simplex whose smallest orthogonal sphere it is; the missing one, if there are no further points on it.
        simplex: Simplex,
        /// All points on the sphere, ascending.
        points: Vec<u32>,
        /// The squared radius of the sphere.
        radius_squared: Exact,
    },
    /// A point is in the shape by itself, with no other point inside or on its sphere, but it is not listed as a vertex.
    MissingVertex {
        /// The point.
        point: u32,
        /// The squared radius of its sphere, at most α.
        radius_squared: Exact,
    },
    /// A point is neither a vertex nor listed as hidden or duplicate.
    Unaccounted {
        /// The point.
        point: u32,
    },
    /// A point is listed as hidden but is also a vertex or a duplicate, or does not exist.
    NotOnlyHidden {
        /// The point.
        point: u32,
    },
    /// The list of duplicates is wrong about a point.
    Duplicate {
        /// The point.
        point: u32,
        /// The point that is listed as kept at its position, if any.
        given: Option<u32>,
        /// The point that should be kept: the heaviest, and of equal weights the first; `None` if it is the point itself.
        expected: Option<u32>,
    },
    /// Of several points with equal positions and weights, a point other than the first, which the rule selects, is kept: a
    /// choice among ties.
    EqualPoint {
        /// The kept point.
        point: u32,
        /// The first of its equals.
        first: u32,
    },
    /// In a shape alone: the simplices that are listed on one empty sphere with further points do not triangulate all its points,
    /// so they do not follow from any choice among ties.
    TiedSphere {
        /// A simplex whose smallest orthogonal sphere it is.
        simplex: Simplex,
        /// All points on the sphere.
        points: Vec<u32>,
        /// Number of simplices of this dimension listed on it.
        listed: usize,
    },
    /// In a shape alone: on a flat part of a tied sphere, facets have cells on different sides, so they do not fit together.
    TiedFacets {
        /// A facet.
        facet: Simplex,
        /// Another facet in the same plane, on the same sphere, with cells on another side.
        other: Simplex,
    },
    /// In a shape alone: a simplex that is not a face of another one has further points on its smallest orthogonal sphere that
    /// span more than it does, so a larger simplex is missing.
    SpannedSphere {
        /// The simplex.
        simplex: Simplex,
        /// Another point on its sphere.
        point: u32,
    },
    /// A point is a vertex although a heavier or earlier one is kept at its position.
    DuplicateVertex {
        /// The vertex.
        point: u32,
        /// The point kept at its position.
        kept: u32,
    },
    /// For labels: a point is not at a corner of a voxel, or another point is at the same corner.
    NotACorner {
        /// The point.
        point: u32,
    },
    /// For labels: a facet with one cell is not half of a face between a voxel of the region, where the cell is, and a voxel
    /// outside; or it is not one of two that cover this face.
    NotABorder {
        /// The facet.
        facet: Simplex,
    },
    /// For labels: a face between a voxel of the region and a voxel outside is not a boundary of cells.
    Unfilled {
        /// The voxel of the region.
        voxel: [u32; 3],
        /// Its face: from −3 to 3, the axis across it, counted from 1, negative on the side of smaller indices.
        side: i8,
    },
}

impl Finding {
    /// The simplices and points that it is about, each by its vertices, the one at fault first. Indices may be out of range, if
    /// that is the finding.
    pub fn parts(&self) -> Vec<&[u32]> {
        match self {
            Self::Index { simplex: s, .. }
            | Self::RepeatedVertex { simplex: s }
            | Self::RepeatedSimplex { simplex: s }
            | Self::Stray { simplex: s }
            | Self::Orientation { cell: s, .. }
            | Self::LongEdge { edge: s }
            | Self::HullEdge { edge: s, .. }
            | Self::OpenFacet { facet: s }
            | Self::NotABorder { facet: s }
            | Self::MissingCell { cell: s, .. } => vec![s.vertices()],
            Self::MissingFace { face: s, of: t }
            | Self::HullWraps { facet: s, first: t }
            | Self::TiedFacets { facet: s, other: t } => vec![s.vertices(), t.vertices()],
            Self::Crowded { facet, cells } => {
                [facet].into_iter().chain(cells).map(Simplex::vertices).collect()
            }
            Self::Overlap { facet, cells: [a, b] } => {
                vec![a.vertices(), b.vertices(), facet.vertices()]
            }
            Self::NotRegular { cell: s, point, .. }
            | Self::HullBends { facet: s, point, .. }
            | Self::Winding { facet: s, behind: point }
            | Self::SpannedSphere { simplex: s, point } => vec![s.vertices(), from_ref(point)],
            Self::Class { simplex, refuted_by, .. } => {
                let point = refuted_by.iter().map(|(point, _)| from_ref(point));
                [simplex.vertices()].into_iter().chain(point).collect()
            }
            Self::NotHidden { point, cell: s, .. } | Self::OutsideHull { point, facet: s, .. } => {
                vec![from_ref(point), s.vertices()]
            }
            Self::MissingVertex { point, .. }
            | Self::Unaccounted { point }
            | Self::NotACorner { point }
            | Self::NotOnlyHidden { point }
            | Self::Duplicate { point, .. } => vec![from_ref(point)],
            Self::EqualPoint { point, first: other }
            | Self::DuplicateVertex { point, kept: other } => {
                vec![from_ref(point), from_ref(other)]
            }
            Self::TiedSphere { simplex, points, .. }
            | Self::MissingSimplex { simplex, points, .. } => {
                let points = points.iter().map(from_ref);
                [simplex.vertices()].into_iter().chain(points).collect()
            }
            Self::NoCells | Self::Unfilled { .. } | Self::Volume { .. } => Vec::new(),
        }
    }

    /// A finding for copies, in terms of the `count` points of the box; `None` if it concerns only copies outside the box.
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
            | Self::OpenFacet { facet: s }
            | Self::NotABorder { facet: s }
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
            | Self::NotACorner { point }
            | Self::NotOnlyHidden { point } => point_at_box(point),
            Self::Duplicate { point, given, expected } => {
                given.iter_mut().chain(expected).for_each(|other| *other %= count);
                point_at_box(point)
            }
            Self::DuplicateVertex { point, kept: other }
            | Self::EqualPoint { point, first: other } => {
                *other %= count;
                point_at_box(point)
            }
            Self::MissingSimplex { simplex, points, .. } => {
                points.iter_mut().for_each(|point| *point %= count);
                points.sort_unstable();
                let is_at_box = simplex.fold(count);
                simplex.0.sort_unstable();
                is_at_box
            }
            Self::TiedSphere { simplex, points, .. } => {
                points.iter_mut().for_each(|point| _ = point_at_box(point));
                simplex.fold(count)
            }
            Self::TiedFacets { facet, other } => {
                let is_other_at_box = other.fold(count);
                facet.fold(count) || is_other_at_box
            }
            Self::SpannedSphere { simplex, point } => {
                point_at_box(point);
                simplex.fold(count)
            }
            Self::NoCells | Self::Unfilled { .. } | Self::Volume { .. } => true,
        };
        is_at_box.then_some(self)
    }

    /// Whether this is not an error but another choice where the definition leaves one: among points on one empty sphere, or with
    /// equal positions and weights.
    pub fn is_tie(&self) -> bool {
        match self {
            Self::NotRegular { power, .. } | Self::NotHidden { power, .. } => power.is_zero(),
            Self::EqualPoint { .. } => true,
            _ => false,
        }
    }

    /// The simplices named, so that their vertices can be renumbered.
    fn simplices_mut(&mut self) -> Vec<&mut Simplex> {
        match self {
            Self::Index { simplex, .. }
            | Self::RepeatedVertex { simplex }
            | Self::RepeatedSimplex { simplex }
            | Self::Stray { simplex }
            | Self::Orientation { cell: simplex, .. }
            | Self::LongEdge { edge: simplex }
            | Self::HullEdge { edge: simplex, .. }
            | Self::NotABorder { facet: simplex }
            | Self::OpenFacet { facet: simplex }
            | Self::MissingCell { cell: simplex, .. }
            | Self::NotRegular { cell: simplex, .. }
            | Self::NotHidden { cell: simplex, .. }
            | Self::HullBends { facet: simplex, .. }
            | Self::OutsideHull { facet: simplex, .. }
            | Self::Winding { facet: simplex, .. }
            | Self::Class { simplex, .. }
            | Self::TiedSphere { simplex, .. }
            | Self::MissingSimplex { simplex, .. }
            | Self::SpannedSphere { simplex, .. } => vec![simplex],
            Self::MissingFace { face: one, of: other }
            | Self::HullWraps { first: one, facet: other }
            | Self::TiedFacets { facet: one, other } => vec![one, other],
            Self::Crowded { facet, cells } => std::iter::once(facet).chain(cells).collect(),
            Self::Overlap { facet, cells } => std::iter::once(facet).chain(cells).collect(),
            Self::NoCells
            | Self::NotACorner { .. }
            | Self::Unfilled { .. }
            | Self::Volume { .. }
            | Self::MissingVertex { .. }
            | Self::Unaccounted { .. }
            | Self::NotOnlyHidden { .. }
            | Self::Duplicate { .. }
            | Self::EqualPoint { .. }
            | Self::DuplicateVertex { .. } => Vec::new(),
        }
    }

    /// Removes the vertices from this number on.
    pub(super) fn without(mut self, first: u32) -> Self {
        self.simplices_mut().into_iter().for_each(|simplex| simplex.drop_from(first));
        self
    }

    /// A tie, with each vertex `v` replaced by `numbers[v]`.
    pub(super) fn renumbered(mut self, numbers: &[u32]) -> Self {
        self.simplices_mut().into_iter().for_each(|simplex| simplex.renumber(numbers));
        if let Self::NotRegular { point, .. } | Self::NotHidden { point, .. } = &mut self {
            *point = numbers[*point as usize];
        }
        self
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
        let vertex = |point, kept| Finding::DuplicateVertex { point, kept };
        assert_eq!(vertex(0, 9).at_box(5), Some(vertex(0, 4)));
        assert_eq!(Finding::NoCells.at_box(5), Some(Finding::NoCells));
    }
}
