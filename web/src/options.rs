//! The options of the page: a recipe, and the command that has the same one.

use std::num::NonZeroUsize;

use serde::Deserialize;
use walpha_model::pipeline::{AlphaRule, Choice};
use walpha_model::{LabelChoice, Recipe};
use walpha_points::haar::{HaarOptions, Tolerance};
use walpha_points::{Columns, Selection, SelectionRule, Weighting};
use walpha_volume::{GrayRange, ReadOptions};

/// What a user chose. Absent options have the defaults of the command.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields, rename_all = "camelCase")]
pub(crate) struct Options {
    /// The volume of a file of several.
    pub frame: Option<u64>,
    /// The series of a folder of several.
    pub series: Option<String>,
    /// How many samples along each axis become one.
    pub downsample: Option<NonZeroUsize>,
    /// The columns of a table.
    pub columns: Option<String>,
    /// The labels whose solid the shape is, as the command names them.
    pub labels: Option<String>,
    /// The values that become gray 0 and 255.
    pub gray: Option<[f64; 2]>,
    /// Samples below this value are left out.
    pub value_min: Option<f64>,
    /// Samples below this gray level are left out.
    pub gray_min: Option<f64>,
    /// Samples that differ from their neighbours by at least so many gray levels.
    pub threshold: Option<f64>,
    /// So many samples.
    pub count: Option<u64>,
    /// This share of all samples.
    pub ratio: Option<f64>,
    /// The error of the wavelet stage, in gray levels.
    pub rms: Option<f64>,
    /// The kind of weights, as the command names it.
    pub weights: Option<String>,
    /// The α that weights are proportional to, or the rule that finds it.
    pub alpha: Option<String>,
}

impl Options {
    /// How the file is read.
    pub(crate) fn reading(&self) -> ReadOptions {
        ReadOptions::default()
            .frame(self.frame)
            .series(self.series.clone())
            .downsample(self.downsample)
    }

    /// The recipe of all stages.
    pub(crate) fn recipe(&self) -> Result<Recipe, String> {
        let columns = self.columns.as_deref().map(str::parse::<Columns>).transpose();
        let weighting = self.weights.as_deref().map(str::parse::<Weighting>).transpose();
        let rules = [
            self.count.map(SelectionRule::Count),
            self.ratio.map(SelectionRule::Ratio),
            self.threshold.map(SelectionRule::Threshold),
        ];
        let mut rules = rules.into_iter().flatten();
        let selection =
            Selection::default().rule(rules.next().unwrap_or_default()).gray_min(self.gray_min);
        if rules.next().is_some() {
            return Err("a number of samples, a share and a threshold exclude each other".into());
        }
        let labels = self.labels.as_deref().map(str::parse::<LabelChoice>).transpose();
        let alpha = self.alpha.as_deref().map(str::parse::<AlphaRule>).transpose();
        let alpha = alpha.map_err(|error| error.to_string())?.unwrap_or_default();
        if matches!(alpha, AlphaRule::Given(alpha) if alpha.squared().is_infinite()) {
            return Err("α of the weights has to be finite here".into());
        }
        let haar = match self.rms {
            Some(rms) => HaarOptions::default().tolerance(Tolerance::Rms(rms)),
            None => HaarOptions::default(),
        };
        Ok(Recipe::new()
            .read(self.reading())
            .columns(columns.map_err(|error| error.to_string())?)
            .labels(labels.map_err(|error| error.to_string())?)
            .gray(self.gray.map(|[low, high]| GrayRange { low, high }))
            .value_min(self.value_min)
            .choice(Choice::Difference(selection))
            .haar(haar)
            .weighting(weighting.map_err(|error| error.to_string())?)
            .alpha(alpha))
    }

    /// The same options by their long names, as on the command line and in a file for `--config`; all but α.
    pub(crate) fn settings(&self) -> Vec<Setting> {
        let mut settings = Vec::new();
        let mut add = |name, value: Option<Written>| {
            settings.extend(value.map(|value| Setting { name, value }));
        };
        add("frame", self.frame.map(Written::number));
        add("series", self.series.clone().map(Written::Text));
        add("downsample", self.downsample.map(Written::number));
        add("columns", self.columns.clone().map(Written::Text));
        add("label", self.labels.clone().map(Written::Text));
        add("gray", self.gray.map(|[low, high]| Written::Text(format!("{low}..{high}"))));
        add("value-min", self.value_min.map(Written::number));
        add("gray-min", self.gray_min.map(Written::number));
        add("count", self.count.map(Written::number));
        add("ratio", self.ratio.map(Written::number));
        add("threshold", self.threshold.map(Written::number));
        add("rms", self.rms.map(Written::number));
        add("weights", self.weights.clone().map(Written::Text));
        settings
    }
}

/// An option and its value.
pub(crate) struct Setting {
    pub name: &'static str,
    pub value: Written,
}

/// A value as it is written.
pub(crate) enum Written {
    Number(String),
    Text(String),
}

impl Written {
    pub(crate) fn number(number: impl ToString) -> Self {
        Self::Number(number.to_string())
    }
}

impl Setting {
    /// As an argument of the command, quoted for a shell where needed.
    pub(crate) fn argument(&self) -> String {
        let (Written::Number(value) | Written::Text(value)) = &self.value;
        // After the sign of equality nothing is an option.
        let word = quoted(&format!("={value}"));
        match word.strip_prefix("'=") {
            Some(rest) => format!("--{}='{rest}", self.name),
            None => format!("--{}{word}", self.name),
        }
    }

    /// As a line of TOML.
    pub(crate) fn line(&self) -> String {
        match &self.value {
            Written::Number(number) => format!("{} = {number}", self.name),
            // JSON's escapes are among TOML's.
            Written::Text(text) => {
                format!("{} = {}", self.name, serde_json::Value::from(&text[..]))
            }
        }
    }
}

/// A word for a shell, which no command takes for an option.
pub(crate) fn quoted(word: &str) -> String {
    if word.starts_with('-') {
        return quoted(&format!("./{word}"));
    }
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./:=,@%+-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
