//! A right answer with all classes, to be damaged.

use std::sync::LazyLock;

use walpha_check::{Extent, Finding, Verdict};

use crate::common::{Answer, Case, definition, grid};

/// A hidden point of the base.
pub(crate) const HIDDEN: u32 = 28;
/// A duplicate in the base: it lies at the position of point 0.
pub(crate) const DUPLICATE: u32 = 29;

/// A 3×3×3 grid at its critical α, a far point, a hidden point and a lighter duplicate of point 0:
/// all classes occur.
pub(crate) fn base() -> (Case, Answer) {
    static BASE: LazyLock<(Case, Answer)> = LazyLock::new(make_base);
    BASE.clone()
}

fn make_base() -> (Case, Answer) {
    let mut positions = grid(3);
    positions.extend([[9.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]]);
    let mut weights = vec![0.0; 30];
    weights[HIDDEN as usize] = -2.0;
    weights[DUPLICATE as usize] = -1.0;
    let case = Case { positions, weights, alpha: 0.75 };
    let answer = definition(&case).unwrap();
    assert_eq!(answer.hidden, [HIDDEN]);
    assert_eq!(answer.duplicates, [[DUPLICATE, 0]]);
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    (case, answer)
}

/// The findings for an answer; all ways of asking give the same.
pub(crate) fn findings(case: &Case, answer: &Answer, extent: Extent) -> Vec<Finding> {
    let claim = case.claim(answer, extent);
    let (findings, certificate) = claim.findings().unwrap();
    assert_eq!(certificate.findings, findings.len());
    let ties = findings.iter().filter(|finding| finding.is_tie()).count();
    assert_eq!(certificate.ties, ties);
    assert_eq!(claim.verdict().unwrap(), certificate.verdict);
    assert_eq!(certificate.verdict == Verdict::Exact, findings.is_empty());
    assert_eq!(certificate.verdict == Verdict::Wrong, ties < findings.len());
    assert_eq!(claim.first_finding().unwrap().as_ref(), findings.first());
    for finding in &findings {
        let line = finding.to_string();
        assert!(line.len() > 20 && !line.contains('\n'), "{line}");
    }
    findings
}
