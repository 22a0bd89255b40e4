//! The rule that a finding is about, and the number of findings by rule.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use walpha_base::sort::sort_by_key;

use crate::{Certificate, FiltrationFinding, Finding};

impl Finding {
    /// The broken rule, by its name in JSON.
    pub fn rule(&self) -> &'static str {
        match self {
            Self::Index { .. } => "index",
            Self::RepeatedVertex { .. } => "repeated_vertex",
            Self::RepeatedSimplex { .. } => "repeated_simplex",
            Self::MissingFace { .. } => "missing_face",
            Self::Stray { .. } => "stray",
            Self::NoCells => "no_cells",
            Self::Orientation { .. } => "orientation",
            Self::LongEdge { .. } => "long_edge",
            Self::Crowded { .. } => "crowded",
            Self::Overlap { .. } => "overlap",
            Self::NotRegular { .. } => "not_regular",
            Self::HullEdge { .. } => "hull_edge",
            Self::HullBends { .. } => "hull_bends",
            Self::HullWraps { .. } => "hull_wraps",
            Self::OpenFacet { .. } => "open_facet",
            Self::Volume { .. } => "volume",
            Self::Class { .. } => "class",
            Self::Winding { .. } => "winding",
            Self::NotHidden { .. } => "not_hidden",
            Self::OutsideHull { .. } => "outside_hull",
            Self::MissingCell { .. } => "missing_cell",
            Self::MissingSimplex { .. } => "missing_simplex",
            Self::MissingVertex { .. } => "missing_vertex",
            Self::Unaccounted { .. } => "unaccounted",
            Self::NotOnlyHidden { .. } => "not_only_hidden",
            Self::Duplicate { .. } => "duplicate",
            Self::EqualPoint { .. } => "equal_point",
            Self::TiedSphere { .. } => "tied_sphere",
            Self::TiedFacets { .. } => "tied_facets",
            Self::SpannedSphere { .. } => "spanned_sphere",
            Self::DuplicateVertex { .. } => "duplicate_vertex",
            Self::NotACorner { .. } => "not_a_corner",
            Self::NotABorder { .. } => "not_a_border",
            Self::Unfilled { .. } => "unfilled",
        }
    }
}

impl FiltrationFinding {
    /// The broken rule, by its name in JSON.
    pub fn rule(&self) -> &'static str {
        match self {
            Self::When { .. } => "when",
            Self::Gabriel { .. } => "gabriel",
            Self::Number { .. } => "number",
            Self::Absent { .. } => "absent",
            Self::Order { .. } => "order",
            Self::Pair { .. } => "pair",
            Self::Lasting { .. } => "lasting",
            Self::Triangulation(finding) => finding.rule(),
        }
    }
}

/// For a triangulation that is [given by its cells alone](crate::schema::ComplexFile::is_cells_alone): leaves out the findings on
/// classes and windings if there are others. Its faces and their classes were derived from the cells, so they are wrong where the
/// cells are.
pub fn keep_causes(findings: &mut Vec<Finding>, certificate: &mut Certificate) {
    let is_derived =
        |finding: &Finding| matches!(finding, Finding::Class { .. } | Finding::Winding { .. });
    if findings.iter().any(|finding| !is_derived(finding) && !finding.is_tie()) {
        let all = findings.len();
        findings.retain(|finding| !is_derived(finding));
        certificate.findings -= all - findings.len();
    }
}

/// The number of findings by each rule, the most frequent first, then by name.
pub fn count_by_rule(rules: impl IntoIterator<Item = &'static str>) -> Vec<(&'static str, usize)> {
    let mut counts = BTreeMap::new();
    rules.into_iter().for_each(|rule| *counts.entry(rule).or_insert(0) += 1);
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    sort_by_key(&mut counts, |&(_, count)| Reverse(count));
    counts
}
