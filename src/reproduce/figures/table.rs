use super::bench::Bench;
use super::bench::{Claim, judge};
use crate::haar::Unnormalised;
use crate::reproduce::{Item, ReproduceError, Table, Verdict, text};
use walpha_points::internal::difference_row;

/// The paper's row of gray levels.
const ROW: [f64; 4] = [9.0, 7.0, 3.0, 5.0];

/// The coefficients of the row, and the row restored without some of them.
struct Evidence {
    whole: Unnormalised,
    /// The row restored without the detail −1.
    one: Vec<f64>,
    /// The row restored without both details of the first level.
    both: Vec<f64>,
    /// The weights of the row restored without both.
    weights: Vec<f64>,
}

impl Evidence {
    fn new() -> Self {
        let whole = Unnormalised::of(&ROW).expect("four is a power of two");
        let mut one = whole.clone();
        one.details[0][1] = 0.0;
        let mut both = one.clone();
        both.details[0][0] = 0.0;
        let (one, both) = (one.row(), both.row());
        let row: Vec<f32> = both.iter().map(|&v| v as f32).collect();
        Self { whole, one, both, weights: difference_row(&row, 2.0) }
    }

    fn coefficients(&self) -> Table {
        let Unnormalised { averages, details, .. } = &self.whole;
        Table {
            caption: "Averages (p + q)/2 and half-differences (p − q)/2, as the paper has them"
                .into(),
            head: ["resolution", "average", "detail coefficient"].map(String::from).into(),
            rows: vec![
                vec!["4".into(), list(&ROW), String::new()],
                vec!["2".into(), list(&averages[0]), list(&details[0])],
                vec!["1".into(), list(&averages[1]), list(&details[1])],
            ],
        }
    }

    fn truncations(&self) -> Table {
        Table {
            caption: "The row restored without some details, and the weights".into(),
            head: ["step", "result"].map(String::from).into(),
            rows: vec![
                vec!["without [−1]".into(), list(&self.one)],
                vec!["without [1, −1]".into(), list(&self.both)],
                vec!["|differences| to both sides, halved".into(), list(&self.weights)],
            ],
        }
    }
}

const CLAIMS: [Claim<Evidence>; 4] = [
    Claim {
        text: "Averages and detail coefficients of [9, 7, 3, 5].",
        decide: |Evidence { whole, .. }| {
            agree(&[
                (&whole.averages[0], &[8.0, 4.0]),
                (&whole.details[0], &[1.0, -1.0]),
                (&whole.averages[1], &[6.0]),
                (&whole.details[1], &[2.0]),
            ])
        },
    },
    Claim {
        text: "Without [−1] the row is [9, 7, 4, 4].",
        decide: |e| agree(&[(&e.one, &[9.0, 7.0, 4.0, 4.0])]),
    },
    Claim {
        text: "Without [1, −1] the row is [8, 8, 4, 4].",
        decide: |e| agree(&[(&e.both, &[8.0, 8.0, 4.0, 4.0])]),
    },
    Claim {
        text: "The weights are 0, 2, 2 and 0.",
        decide: |e| agree(&[(&e.weights, &[0.0, 2.0, 2.0, 0.0])]),
    },
];

/// Whether the computed numbers are those printed in the paper.
fn agree(pairs: &[(&[f64], &[f64])]) -> (Verdict, String) {
    let reason = |(computed, printed): &(&[f64], &[f64])| {
        format!("computed {}, printed {}", list(computed), list(printed))
    };
    let reasons: Vec<String> = pairs.iter().map(reason).collect();
    (Verdict::of(pairs.iter().all(|(ours, paper)| ours == paper)), reasons.join("; "))
}

/// Table 1: the Haar coefficients of a row, what remains when details go, and its weights.
#[expect(clippy::unnecessary_wraps, reason = "all items have this signature")]
pub(super) fn table_1(_: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let evidence = Evidence::new();
    Ok(Item {
        title: "Table 1. Wavelet coefficients of a row of four".into(),
        paper: "The row [9, 7, 3, 5] decomposed into averages and half-differences; details are \
                removed, and each value that is left weighs as much as it differs from its \
                neighbours."
            .into(),
        ours: "The same numbers. They are unnormalised; our thresholds are applied to orthonormal \
               coefficients, for which alone equation 3.3 holds."
            .into(),
        tables: vec![evidence.coefficients(), evidence.truncations()],
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|&v| text::number(v)).collect();
    format!("[{}]", values.join(", "))
}
