//! INPUT: its name, and the options for reading it.

use std::ffi::OsString;
use std::fmt::{self, Display};
use std::ops::Deref;
use std::path::{Path, PathBuf};

use clap::Args;

use super::settings::{Declared, Given, Groups};
use super::typed::TypedOptions;
use crate::cli::process::errors::Result;
use crate::export::Target;
use crate::points::PointOptions;
use crate::settings::{Group, Settings};
use crate::volume::ReadOptions;
use crate::{Dims, Recipe, shape};

/// What to read.
#[derive(Args, Clone)]
#[command(next_help_heading = "Input")]
pub(crate) struct InputArgs {
    /// Options typed on the command line.
    #[command(flatten)]
    pub typed: TypedOptions,
    /// All settings that the command was given.
    #[command(flatten)]
    pub given: Given,
    /// Volume or point file, - (standard input), or a sample (sample:ct, sample:phantom, …).
    #[arg(value_name = "INPUT", help_heading = None::<&str>)]
    pub input: InputName,
    #[command(flatten)]
    reading: Declared<Reading>,
}

/// The options for reading INPUT.
struct Reading;

impl Groups for Reading {
    const GROUPS: &[(Group, &str)] = &[
        (Group::Input, "Input"),
        (Group::Molecule, "Molecules"),
        (Group::Part, "Parts of a volume"),
        (Group::Raw, "Raw volumes"),
    ];
}

impl InputArgs {
    /// The given settings.
    pub(crate) fn settings(&self) -> &Settings {
        &self.given.settings
    }

    /// The options for reading a volume.
    pub(crate) fn options(&self) -> ReadOptions {
        self.settings().reading()
    }

    /// The grid that `--dims` requests, if it does not describe a raw file.
    pub(crate) fn grid(&self) -> Option<Dims> {
        self.settings().dims().copied().filter(|_| self.settings().dtype().is_none())
    }

    /// The extension of a file in the format of `--input-format`, with its dot; empty without that option.
    pub(crate) fn extension(&self) -> String {
        self.settings().input_format().map(|format| format!(".{format}")).unwrap_or_default()
    }

    /// The recipe with the given settings.
    pub(crate) fn recipe(&self) -> Result<Recipe> {
        Ok(self.settings().recipe()?.classifier(shape::CGAL))
    }

    /// The options for reading points.
    pub(crate) fn point_options(&self) -> Result<PointOptions> {
        Ok(self.recipe()?.of_points())
    }

    /// Refuses `--input-format` for a sample or a folder.
    pub(crate) fn check_format(&self) -> Result<()> {
        if self.input.starts_with("sample:") {
            self.typed.refuse(&["input_format"], "a sample is not a file")?;
        } else if self.input.path().is_dir() {
            self.typed.refuse(&["input_format"], "a folder says what it holds")?;
        }
        Ok(())
    }
}

/// The name of a sample or a file: the path in the form of the system, which need not be UTF-8, and the text shown to users and
/// in reports.
#[derive(Clone, Debug)]
pub(crate) struct InputName {
    path: PathBuf,
    text: String,
}

impl InputName {
    /// The path to open.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is standard input.
    pub(crate) fn is_stdin(&self) -> bool {
        self.path == Path::new(Target::STDOUT)
    }
}

impl From<OsString> for InputName {
    fn from(name: OsString) -> Self {
        Self { text: name.to_string_lossy().into_owned(), path: name.into() }
    }
}

/// Dereferences to the text.
impl Deref for InputName {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

impl Display for InputName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
