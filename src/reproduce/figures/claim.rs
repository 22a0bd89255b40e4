use crate::reproduce::{Finding, Verdict};

/// A claim of the paper, and how what was measured decides it.
pub(super) struct Claim<Evidence> {
    /// What the paper claims.
    pub text: &'static str,
    /// The verdict, and the numbers that lead to it.
    pub decide: fn(&Evidence) -> (Verdict, String),
}

/// Judges the claims of a table, in its order.
pub(super) fn judge<Evidence>(claims: &[Claim<Evidence>], evidence: &Evidence) -> Vec<Finding> {
    let finding = |claim: &Claim<Evidence>| {
        let (verdict, reason) = (claim.decide)(evidence);
        Finding { claim: claim.text.into(), verdict, reason }
    };
    claims.iter().map(finding).collect()
}
