//! The kinds of weights, one table entry each.

use std::fmt;
use std::mem::discriminant;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use walpha_base::Sum;
use walpha_base::advice::{Advice, Advise};

/// The source of the weights ω of points. Weights are **squared** lengths, as α is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weighting {
    /// ω = C for all points: the shape at α is the unweighted one at α + C.
    Common(f64),
    /// ω = α·(L − Lmin)/(Lmax − Lmin), all 0 where Lmax = Lmin (equation 4.1).
    MinMax,
    /// ω = α·L/ΣL, all 0 where ΣL = 0 (equation 4.2, literally). The mean weight is α/N, too
    /// little to change a shape of many points.
    Barycentric,
    /// N times the barycentric weights, so that the mean weight is α. Not in the paper.
    BarycentricN,
    /// The weights are a column of the input.
    Column,
}

impl Weighting {
    /// Whether weights come from the differences L.
    pub fn needs_differences(self) -> bool {
        matches!(self.kind().rule, Rule::Proportional(_))
    }
}

/// Statistics of the differences, which weights proportional to them need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Differences {
    /// The number of points.
    pub count: u64,
    /// The smallest difference.
    pub min: f64,
    /// The largest difference.
    pub max: f64,
    /// The sum of the differences, which does not depend on the order of summation.
    pub sum: Sum,
}

impl Default for Differences {
    fn default() -> Self {
        Self { count: 0, min: f64::INFINITY, max: f64::NEG_INFINITY, sum: Sum::default() }
    }
}

impl Differences {
    /// The statistics of some differences. O(n).
    pub fn of(differences: &[f64]) -> Self {
        let (min, max) = range(differences);
        let sum = differences.iter().copied().collect();
        Self { count: differences.len() as u64, min, max, sum }
    }

    /// Adds the differences of other points.
    pub fn join(&mut self, other: &Self) {
        self.count += other.count;
        (self.min, self.max) = (self.min.min(other.min), self.max.max(other.max));
        self.sum.join(&other.sum);
    }
}

/// The formula of weights factor·((L − base)/divisor), or all 0 if the divisor is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    factor: f64,
    base: f64,
    divisor: f64,
}

impl Shares {
    /// The weight of a difference.
    pub fn of(self, l: f64) -> f64 {
        let Self { factor, base, divisor } = self;
        if divisor == 0.0 { 0.0 } else { factor * ((l - base) / divisor) }
    }
}

fn range(numbers: &[f64]) -> (f64, f64) {
    let ends = |(low, high): (f64, f64), &v: &f64| (low.min(v), high.max(v));
    numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends)
}

/// The rule by which weights of a kind are computed.
pub(super) enum Rule {
    /// All points have the same weight.
    Common,
    /// The weights are taken from the input.
    Column,
    /// The weights are computed from the differences L and α.
    Proportional(fn(&Differences, f64) -> Shares),
}

/// A kind of weights.
pub(super) struct WeightKind {
    weighting: Weighting,
    /// The name on the command line.
    name: &'static str,
    /// The placeholder of the parameter that follows the name and a `=`.
    parameter: Option<&'static str>,
    /// A short explanation.
    about: &'static str,
    pub(super) rule: Rule,
}

/// All kinds.
const KINDS: [WeightKind; 5] = [
    WeightKind {
        weighting: Weighting::Common(0.0),
        name: "common",
        parameter: Some("C"),
        about: "",
        rule: Rule::Common,
    },
    WeightKind {
        weighting: Weighting::MinMax,
        name: "min-max",
        parameter: None,
        about: "eq. 4.1",
        rule: Rule::Proportional(|differences, alpha| {
            let Differences { min, max, .. } = *differences;
            Shares { factor: alpha, base: min, divisor: max - min }
        }),
    },
    WeightKind {
        weighting: Weighting::Barycentric,
        name: "barycentric",
        parameter: None,
        about: "eq. 4.2",
        rule: Rule::Proportional(barycentric),
    },
    WeightKind {
        weighting: Weighting::BarycentricN,
        name: "barycentric-n",
        parameter: None,
        about: "N times that",
        rule: Rule::Proportional(|differences, alpha| {
            barycentric(differences, alpha * differences.count as f64)
        }),
    },
    WeightKind {
        weighting: Weighting::Column,
        name: "column",
        parameter: None,
        about: "from the input",
        rule: Rule::Column,
    },
];

fn barycentric(differences: &Differences, factor: f64) -> Shares {
    Shares { factor, base: 0.0, divisor: differences.sum.value() }
}

impl Weighting {
    pub(super) fn kind(&self) -> &'static WeightKind {
        let own = |kind: &&WeightKind| discriminant(&kind.weighting) == discriminant(self);
        KINDS.iter().find(own).expect("each kind is in the table")
    }

    /// Lists the kinds as a user writes them, each with an explanation: `common=C, min-max (eq. 4.1), … or column (from the
    /// input)`.
    pub fn known() -> String {
        let names = KINDS.map(|WeightKind { name, parameter, about, .. }| {
            let parameter = parameter.map(|p| format!("={p}")).unwrap_or_default();
            let about = if about.is_empty() { String::new() } else { format!(" ({about})") };
            format!("{name}{parameter}{about}")
        });
        let [all @ .., last] = &names;
        format!("{} or {last}", all.join(", "))
    }
}

impl fmt::Display for Weighting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind().name)?;
        match self {
            Self::Common(weight) => write!(f, "={weight}"),
            _ => Ok(()),
        }
    }
}

/// The error for a text that names no weighting.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a kind of weights")]
pub struct UnknownWeighting(String);

impl Advise for UnknownWeighting {
    fn advice(&self) -> Option<Advice> {
        Some(format!("give {}; C is a squared length", Weighting::known()).into())
    }
}

impl FromStr for Weighting {
    type Err = UnknownWeighting;

    fn from_str(text: &str) -> Result<Self, UnknownWeighting> {
        let unknown = || UnknownWeighting(text.into());
        let (name, parameter) = match text.split_once('=') {
            Some((name, parameter)) => (name, Some(parameter)),
            None => (text, None),
        };
        let kind = KINDS.iter().find(|kind| kind.name == name).ok_or_else(unknown)?;
        match (kind.weighting, parameter) {
            (Self::Common(_), Some(weight)) => match weight.parse() {
                Ok(weight) if f64::is_finite(weight) => Ok(Self::Common(weight)),
                _ => Err(unknown()),
            },
            (weighting, None) if kind.parameter.is_none() => Ok(weighting),
            _ => Err(unknown()),
        }
    }
}
