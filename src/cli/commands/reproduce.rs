//! `walpha reproduce`: reproduces the paper.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use walpha_base::shown::shown;

use crate::progress::Stage;
use crate::reproduce::{
    File, ItemName, Report, Subject, markdown, page, reproduce, reproduce_only,
};
use crate::volume::{ReadOptions, open};
use crate::{Gray, Volume, VolumeError};

use crate::cli::commands::folder::Folder;
use crate::cli::commands::pipeline::with_points;
use crate::cli::options::global::Global;
use crate::cli::process::errors::{CommandError, Result};
use crate::cli::process::output::{json, print};
use crate::cli::process::progress::Progress;

/// Reproduce the paper: Table 1, the figures, and a report on its claims.
///
/// Writes PNG, SVG, PLY and OFF files, report.html (self-contained), report.json and reproduction.md (claims,
/// verdicts and commands) into a folder. With --only, the named items are made exactly as in a full run; the reports
/// then contain only these, and replace earlier ones in the folder.
///
/// Examples:
///
/// walpha reproduce   # all of it
///
/// walpha reproduce --input ct.nii.gz --out paper   # with a volume of your own
///
/// walpha reproduce --only figure-06,table-1   # two of the figures
#[derive(Args)]
pub(crate) struct Reproduce {
    /// Volume or sample [default: sample:skull, or sample:phantom where CGAL's data is not
    /// installed].
    #[arg(long, value_name = "INPUT")]
    input: Option<String>,
    /// Items to make; may be repeated [default: all].
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = item_names())]
    only: Vec<ItemName>,
    /// Folder to write to, created if needed; existing files in it are replaced, all at the end.
    #[arg(
        short,
        long,
        visible_alias = "output",
        value_name = "DIR",
        default_value = "reproduction"
    )]
    out: PathBuf,
}

fn item_names() -> impl TypedValueParser<Value = ItemName> {
    PossibleValuesParser::new(ItemName::all().map(ItemName::as_str))
        .map(|name| ItemName::find(&name).expect("one of the possible values"))
}

/// A volume like the paper's, and one that is always available.
const SKULL: &str = "sample:skull";
const PHANTOM: &str = "sample:phantom";

impl Reproduce {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        let mut progress = Progress::new(global);
        // The folder is opened before the long work.
        let mut folder =
            Folder::open(&self.out, "--out", &["report.html", "report.json", "reproduction.md"])?;
        let (name, volume) = progress.stage(Stage::Read, || self.volume())?;
        let (volume, range) = volume.into_gray(Gray::Automatic)?;
        let date = today();
        let subject = Subject { volume: &volume, range, name: &name, date: &date };
        let made = progress.watch(|| {
            if self.only.is_empty() {
                reproduce(&subject)
            } else {
                reproduce_only(&subject, &self.only)
            }
        })?;
        let mut files = made.files;
        files.push(File {
            name: "report.html".into(),
            bytes: page(&made.report, &files).into_bytes(),
        });
        files.push(File {
            name: "reproduction.md".into(),
            bytes: markdown(&made.report).into_bytes(),
        });
        let json = json(&made.report)?;
        files.push(File { name: "report.json".into(), bytes: json.clone().into_bytes() });
        progress.stage(Stage::Write, || -> Result<()> {
            for file in &files {
                folder.write(&file.name, |out| out.write_all(&file.bytes))?;
            }
            folder.finish()
        })?;
        progress.finish();
        if global.json {
            print(&json)?;
        } else if !global.quiet {
            print(&text(&made.report, &self.out, files.len()))?;
        }
        Ok(())
    }

    fn volume(&self) -> Result<(String, Volume)> {
        if let Some(name) = &self.input {
            return Ok((name.clone(), open(name, &ReadOptions::default()).map_err(unusable)?));
        }
        match open(SKULL, &ReadOptions::default()) {
            Err(VolumeError::NoSkull { .. }) => {
                tracing::info!(
                    "{SKULL} is not installed (on Debian and Ubuntu, `apt-get install libcgal-demo` installs it); \
                     continuing with {PHANTOM}"
                );
                Ok((PHANTOM.into(), open(PHANTOM, &ReadOptions::default())?))
            }
            other => Ok((SKULL.into(), other?)),
        }
    }
}

/// The error for a volume that cannot be read. There are no options for reading, as errors about contents advise.
fn unusable(error: VolumeError) -> CommandError {
    let is_of_content = matches!(error, VolumeError::Format { .. } | VolumeError::InFile { .. });
    let said = with_points(error);
    if is_of_content {
        let next = "name a volume of finite samples, in a file that states its sizes";
        return CommandError { next: Some(next.into()), ..said };
    }
    said
}

/// The current day in UTC, or that of `SOURCE_DATE_EPOCH` (<https://reproducible-builds.org/specs/source-date-epoch/>).
fn today() -> String {
    let asked = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|seconds| seconds.parse().ok());
    // Times beyond the year 9999 are taken for mistakes.
    let asked = asked.filter(|&seconds: &u64| seconds < 253_402_300_800);
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    date(asked.unwrap_or_else(now) / 86_400)
}

/// The date `days` days after 1970-01-01.
fn date(mut days: u64) -> String {
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year:04}-{month:02}-{:02}", days + 1)
}

/// The text to print: the verdicts, and the path of the page.
fn text(report: &Report, out: &Path, files: usize) -> String {
    let mut text = String::new();
    let input = &report.input;
    text += &format!(
        "input     {}, {} points of {} samples\n",
        shown(input.name.as_ref()),
        input.points,
        input.samples
    );
    for item in &report.items {
        let name = item.title.split('.').next().unwrap_or_default();
        for finding in &item.findings {
            text += &format!("{name:<10}{:<18} {}\n", finding.verdict.words(), finding.claim);
        }
    }
    let seconds = report.seconds.get("total").copied().unwrap_or_default();
    let page = out.join("report.html");
    text += &format!("wrote     {files} files; open {} ({seconds:.1} s)\n", shown(&page));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_dates() {
        let days = [0, 58, 59, 11_016, 20_453, 20_454];
        let dates =
            ["1970-01-01", "1970-02-28", "1970-03-01", "2000-02-29", "2025-12-31", "2026-01-01"];
        assert_eq!(days.map(date), dates);
    }
}
