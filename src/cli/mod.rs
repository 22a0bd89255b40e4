//! Floor 7: parse, call the library, print, choose an exit code.

mod args;
mod check;
mod compare;
mod complex_file;
mod folder;
mod haar;
mod info;
mod ladder;
mod output;
mod picture;
mod pipeline;
mod points;
mod progress;
mod report;
mod reproduce;
mod shape;
mod view;

use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use output::is_broken_pipe;

/// Volume modelling of scattered data with wavelet-weighted alpha shapes.
///
/// A volume is Haar-transformed, small coefficients are dropped, the samples of largest gray
/// difference become weighted points, and CGAL's regular triangulation and alpha shape turn these
/// into cells, facets, edges and vertices.
///
/// INPUT is a volume (NRRD, NIfTI, MetaImage, VTK, VTI, TIFF, INRIMAGE, NPY, NPZ, a folder of PNG, JPEG
/// or TIFF slices, raw with --dims), a point file (CSV, TSV, XYZ, PLY, VTU, VTP, NPY), or one of
/// sample:skull, sample:phantom, sample:phantom@N. α and weights are squared lengths.
#[derive(Parser)]
#[command(name = "walpha", version = VERSION, max_term_width = 100, arg_required_else_help = true)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Command,
}

const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\nlicence GPL-3.0-or-later (it contains CGAL's triangulations and alpha shapes, under the GPL)"
);

/// Options of every command.
#[derive(Args, Clone, Copy)]
struct Global {
    /// Print one JSON object instead of text.
    #[arg(long, global = true)]
    json: bool,
    /// Print nothing but errors (and JSON, if asked for).
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Say on standard error what is being done, and how the work is cut.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// Threads to compute with; the result is the same for any number [default: all].
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

#[derive(Subcommand)]
enum Command {
    Reproduce(reproduce::Reproduce),
    Shape(shape::Shape),
    Points(points::Points),
    Haar(haar::Haar),
    Info(info::Info),
    Check(check::Check),
    Compare(compare::Compare),
    Ladder(ladder::Ladder),
    View(view::View),
}

/// The exit code of a check or comparison that found something.
const DIFFERENT: u8 = 3;

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    let Cli { global, command } = Cli::parse();
    match execute(global, command) {
        Ok(code) => code,
        // Whoever reads our output has enough of it.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // Messages of the library tell their causes themselves; a context names the file.
            eprintln!("walpha: {}", with_contexts(&error));
            ExitCode::FAILURE
        }
    }
}

/// An error with the contexts it was given, but without causes that its text has already.
fn with_contexts(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

fn execute(global: Global, command: Command) -> anyhow::Result<ExitCode> {
    if global.verbose {
        let log = tracing_subscriber::fmt().with_max_level(tracing::Level::DEBUG);
        log.with_writer(std::io::stderr).without_time().init();
    }
    if let Some(threads) = global.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    match command {
        Command::Reproduce(reproduce) => reproduce.run(global)?,
        Command::Shape(shape) => shape.run(global)?,
        Command::Points(points) => points.run(global)?,
        Command::Haar(haar) => haar.run(global)?,
        Command::Info(info) => info.run(global)?,
        Command::Check(check) => return check.run(global),
        Command::Compare(compare) => return compare.run(global),
        Command::Ladder(ladder) => ladder.run(global)?,
        Command::View(view) => view.run(global)?,
    }
    Ok(ExitCode::SUCCESS)
}
