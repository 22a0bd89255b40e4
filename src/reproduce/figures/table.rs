use super::super::{Finding, Item, ReproduceError, Table, Verdict, text};
use super::Bench;
use crate::haar::Unnormalised;
use crate::points::difference_row;

/// The paper's row of gray levels.
const ROW: [f64; 4] = [9.0, 7.0, 3.0, 5.0];

/// Table 1: the Haar coefficients of a row, what remains when details go, and its weights.
pub(super) fn table_1(_: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let whole = Unnormalised::of(&ROW).expect("four is a power of two");
    let mut one = whole.clone();
    one.details[0][1] = 0.0;
    let mut both = one.clone();
    both.details[0][0] = 0.0;
    let row: Vec<f32> = both.row().iter().map(|&v| v as f32).collect();
    let weights = difference_row(&row, 2.0);

    let coefficients = Table {
        caption: "Averages (p + q)/2 and half-differences (p − q)/2, as the paper has them".into(),
        head: ["resolution", "average", "detail coefficient"].map(String::from).into(),
        rows: vec![
            vec!["4".into(), list(&ROW), String::new()],
            vec!["2".into(), list(&whole.averages[0]), list(&whole.details[0])],
            vec!["1".into(), list(&whole.averages[1]), list(&whole.details[1])],
        ],
    };
    let (one, both) = (one.row(), both.row());
    let truncations = Table {
        caption: "The row restored without some details, and the weights".into(),
        head: ["step", "result"].map(String::from).into(),
        rows: vec![
            vec!["without [−1]".into(), list(&one)],
            vec!["without [1, −1]".into(), list(&both)],
            vec!["|differences| to both sides, halved".into(), list(&weights)],
        ],
    };
    let compare = |claim: &str, pairs: &[(&[f64], &[f64])]| Finding {
        claim: claim.into(),
        verdict: Verdict::of(pairs.iter().all(|(ours, paper)| ours == paper)),
        reason: pairs
            .iter()
            .map(|(ours, paper)| format!("computed {}, printed {}", list(ours), list(paper)))
            .collect::<Vec<_>>()
            .join("; "),
    };
    let findings = vec![
        compare(
            "Averages and detail coefficients of [9, 7, 3, 5].",
            &[
                (&whole.averages[0], &[8.0, 4.0]),
                (&whole.details[0], &[1.0, -1.0]),
                (&whole.averages[1], &[6.0]),
                (&whole.details[1], &[2.0]),
            ],
        ),
        compare("Without [−1] the row is [9, 7, 4, 4].", &[(&one, &[9.0, 7.0, 4.0, 4.0])]),
        compare("Without [1, −1] the row is [8, 8, 4, 4].", &[(&both, &[8.0, 8.0, 4.0, 4.0])]),
        compare("The weights are 0, 2, 2 and 0.", &[(&weights, &[0.0, 2.0, 2.0, 0.0])]),
    ];
    Ok(Item {
        id: "table-1",
        title: "Table 1. Wavelet coefficients of a row of four".into(),
        paper: "The row [9, 7, 3, 5] decomposed into averages and half-differences; details are \
                removed, and each value that is left weighs as much as it differs from its \
                neighbours."
            .into(),
        ours: "The same numbers. They are unnormalised; our thresholds are applied to orthonormal \
               coefficients, for which alone equation 3.3 holds."
            .into(),
        tables: vec![coefficients, truncations],
        findings,
        ..Item::default()
    })
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|&v| text::number(v)).collect();
    format!("[{}]", values.join(", "))
}
