//! The rules that findings are counted by.

use walpha_check::{FiltrationFinding, Finding, count_by_rule};

/// The name of a rule equals its name in JSON, regardless of the other content of the finding.
#[test]
fn rules_are_named_as_in_json() {
    let findings = [
        Finding::NoCells,
        Finding::Unaccounted { point: 3 },
        Finding::RepeatedSimplex { simplex: [0, 1].into() },
        Finding::EqualPoint { point: 1, first: 0 },
        Finding::Overlap {
            facet: [0, 1, 2].into(),
            cells: [[0, 1, 2, 3].into(), [0, 1, 2, 4].into()],
        },
    ];
    for finding in findings {
        assert_eq!(serde_json::to_value(&finding).unwrap()["rule"], finding.rule());
        let within = FiltrationFinding::Triangulation(finding);
        assert_eq!(serde_json::to_value(&within).unwrap()["rule"], within.rule());
    }
    let absent = FiltrationFinding::Absent { number: 1 };
    assert_eq!(serde_json::to_value(&absent).unwrap()["rule"], absent.rule());
}

#[test]
fn the_most_frequent_comes_first() {
    let counts = count_by_rule(["volume", "overlap", "class", "overlap"]);
    assert_eq!(counts, [("overlap", 2), ("class", 1), ("volume", 1)]);
}
