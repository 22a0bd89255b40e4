//! `walpha reproduce`: the paper, made again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use walpha::export::Target;
use walpha::reproduce::{File, Report, Subject, page, reproduce};
use walpha::volume::{ReadOptions, open};
use walpha::{Gray, Volume, VolumeError};

use super::Global;
use super::output::{print, print_json};
use super::progress::Progress;

/// Reproduce the paper: Table 1, the figures, and a report on its claims.
///
/// Writes PNG, SVG and OFF files, report.html (self-contained) and report.json into a folder.
///
/// Example: walpha reproduce --out paper
#[derive(Args)]
pub struct Reproduce {
    /// Volume or sample [default: sample:skull, or sample:phantom where CGAL's data is not
    /// installed].
    #[arg(long, value_name = "INPUT")]
    input: Option<String>,
    /// Folder to write to; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "reproduction")]
    out: PathBuf,
}

/// The paper's own kind of volume, and what always is at hand.
const SKULL: &str = "sample:skull";
const PHANTOM: &str = "sample:phantom";

impl Reproduce {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        let mut progress = Progress::new(global);
        let (name, volume) = progress.stage("read", || self.volume(global))?;
        let (volume, range) = volume.into_gray(Gray::Automatic)?;
        let folder = Folder::open(&self.out)?;
        let subject = Subject { volume: &volume, range, name: &name };
        let made = reproduce(&subject, &mut |stage| progress.show(stage))?;
        let mut files = made.files;
        files.push(File {
            name: "report.html".into(),
            bytes: page(&made.report, &files).into_bytes(),
        });
        files.push(File {
            name: "report.json".into(),
            bytes: (serde_json::to_string_pretty(&made.report)? + "\n").into_bytes(),
        });
        progress.stage("write", || folder.write(&files))?;
        progress.finish();
        if global.json {
            print_json(&made.report)?;
        } else if !global.quiet {
            print(&text(&made.report, &self.out, files.len()))?;
        }
        Ok(())
    }

    fn volume(&self, global: Global) -> anyhow::Result<(String, Volume)> {
        if let Some(name) = &self.input {
            return Ok((name.clone(), open(name, &ReadOptions::default())?));
        }
        match open(SKULL, &ReadOptions::default()) {
            Err(VolumeError::Sample(_)) => {
                if !global.quiet {
                    eprintln!(
                        "walpha: {SKULL} is not installed (on Debian and Ubuntu, `apt-get install \
                         libcgal-demo` brings it); going on with {PHANTOM}"
                    );
                }
                Ok((PHANTOM.into(), open(PHANTOM, &ReadOptions::default())?))
            }
            other => Ok((SKULL.into(), other?)),
        }
    }
}

/// The folder results go to: found writable before the long work.
struct Folder<'a> {
    path: &'a Path,
    /// Whether it is ours, to be taken away again if nothing comes of it.
    made: bool,
    written: bool,
}

impl<'a> Folder<'a> {
    fn open(path: &'a Path) -> anyhow::Result<Self> {
        let made = match fs::create_dir(path) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => false,
            Err(error) => {
                let path = path.display();
                return Err(anyhow!(
                    "cannot make the folder {path}: {error}; choose another with --out"
                ));
            }
        };
        let folder = Self { path, made, written: false };
        Target::open(&path.join("report.html"))?;
        Ok(folder)
    }

    /// Writes all files, each complete or not at all.
    fn write(mut self, files: &[File]) -> anyhow::Result<()> {
        for file in files {
            let target = Target::open(&self.path.join(&file.name))?;
            target.write(|out| out.write_all(&file.bytes))?;
        }
        self.written = true;
        Ok(())
    }
}

impl Drop for Folder<'_> {
    fn drop(&mut self) {
        if self.made && !self.written {
            // Only if it is empty; what was written stays.
            let _ = fs::remove_dir(self.path);
        }
    }
}

/// What the terminal is told: the verdicts, and where to look.
fn text(report: &Report, out: &Path, files: usize) -> String {
    let mut text = String::new();
    let input = &report.input;
    text += &format!(
        "input     {}, {} points of {} samples\n",
        input.name, input.points, input.samples
    );
    for item in &report.items {
        let name = item.title.split('.').next().unwrap_or_default();
        for finding in &item.findings {
            text += &format!("{name:<10}{:<18} {}\n", finding.verdict.words(), finding.claim);
        }
    }
    let seconds = report.seconds.get("total").copied().unwrap_or_default();
    let page = out.join("report.html");
    text += &format!("wrote     {files} files; open {} ({seconds:.1} s)\n", page.display());
    text
}
