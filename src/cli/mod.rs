//! The command line: it parses arguments, calls the library, prints results, and chooses an exit code.

mod commands;
mod options;
mod process;
mod report;

use std::ffi::OsString;

use clap::error::ErrorKind;
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use tracing::level_filters::LevelFilter;
use tracing_subscriber::Layer;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

use crate::export::Target;

#[cfg(feature = "zarr")]
use commands::convert;
#[cfg(feature = "paper")]
use commands::reproduce;
#[cfg(feature = "render")]
use commands::view;
use commands::{
    balls, blocks, check, compare, completions, filtration, haar, info, interpolate, ladder, man,
    points, pores, shape, shape_in_blocks,
};
use options::global::{Global, INTERRUPTED, SUCCESS, USAGE};
use options::{config, formats, help, typed};
use process::errors::{self, ErrorForm, Result};
use process::output::{self, print, print_with};
use process::ranks::Ranks;
use process::{progress, signals, threads, usage};

/// Volume modelling of scattered data with wavelet-weighted alpha shapes.
#[derive(Parser)]
#[command(name = "walpha", version = VERSION, long_about = formats::about(), max_term_width = 100, arg_required_else_help = true, after_help = FIRST)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Command,
}

/// Commands for new users to try first.
const FIRST: &str = "\
To begin:
  walpha info sample:ct                what a built-in CT contains
  walpha shape sample:ct -o bone.ply   a mesh of its bone; put your own file in its place
  walpha shape --help                  all options of a command; -h, the common ones";

const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\nlicence GPL-3.0-or-later (it contains CGAL's triangulations and alpha shapes, under the GPL)"
);

#[derive(Subcommand)]
enum Command {
    Info(info::Info),
    Shape(shape::Shape),
    #[cfg(feature = "render")]
    View(view::View),
    Ladder(ladder::Ladder),
    Filtration(filtration::Filtration),
    Balls(balls::Balls),
    Pores(pores::Pores),
    Interpolate(interpolate::Interpolate),
    Check(check::Check),
    Compare(compare::Compare),
    Points(points::Points),
    Haar(haar::Haar),
    Blocks(blocks::Blocks),
    #[cfg(feature = "zarr")]
    Convert(convert::Convert),
    #[cfg(feature = "paper")]
    Reproduce(reproduce::Reproduce),
    Completions(completions::Completions),
    Man(man::Man),
}

/// The command with all its options.
fn build_command() -> clap::Command {
    let mut command = help::arranged(Cli::command().args(config::config_options()));
    command.build();
    command
}

/// Runs a command line, which begins with the name of the program, and returns the exit code. Handles signals from then on: it
/// is for processes that do nothing else.
pub fn run(typed: Vec<OsString>) -> u8 {
    signals::prepare();
    let command = build_command();
    let (_, name) = usage::named(&command, &typed);
    let ranks = Ranks::find(&name);
    ranks.run(
        &name,
        || lead(command, &name, typed, &ranks),
        || shape_in_blocks::serve(ranks.team()),
    )
}

/// Runs a command line. The error is the exit code after a failure, which has been reported.
fn lead(
    mut command: clap::Command,
    name: &str,
    typed: Vec<OsString>,
    ranks: &Ranks,
) -> Result<u8, u8> {
    let args = match config::with_settings(&command, typed.clone()) {
        Ok(args) => args,
        Err(error) => {
            errors::print_error(name, &error, error_form(&command, &typed));
            return Err(USAGE);
        }
    };
    let form = error_form(&command, &args);
    if typed.iter().any(|arg| arg == "--print-config") {
        // Positional arguments are not options, and need not be given to print these.
        command = command.mut_subcommands(|sub| {
            sub.mut_args(|arg| if arg.is_positional() { arg.required(false) } else { arg })
        });
    }
    let mut kept = Ok(());
    let parsed = command.clone().try_get_matches_from(&args).and_then(|matches| {
        if matches.get_flag(config::PRINT) {
            return Ok(Err(matches));
        }
        kept = typed::protect_inputs(&command, &matches);
        Cli::from_arg_matches(&matches).map(|cli| Ok((cli, is_piped(&matches))))
    });
    let done = match parsed {
        Ok(Ok((Cli { global, command }, piped))) => {
            kept.and_then(|()| execute(Global { piped, ..global }, command, ranks))
        }
        Ok(Err(matches)) => print_config(&command, &matches),
        // Help and version are not errors.
        Err(error) if !error.use_stderr() => {
            let printed = print_with(|_| error.print());
            printed.map(|()| SUCCESS)
        }
        Err(error) => {
            if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
                // A failure to print help cannot be told of either.
                let _ = error.print();
            } else {
                let configured = args.len() > typed.len();
                usage::wrong(&command, &args, &error, configured).print(form, USAGE);
            }
            return Err(USAGE);
        }
    };
    let code = match done {
        Ok(code) => code,
        Err(error) => {
            progress::clear();
            if progress::is_cancelled() {
                return Err(INTERRUPTED as u8);
            }
            errors::print_error(name, &error, form);
            return Err(errors::exit_code(&error));
        }
    };
    shape_in_blocks::dismiss(ranks.team());
    Ok(code)
}

/// How errors of this command line are printed, which may be one that cannot be parsed.
fn error_form(command: &clap::Command, args: &[OsString]) -> ErrorForm {
    if !args.iter().any(|arg| arg == "--json") {
        return ErrorForm::Text;
    }
    let lenient = command.clone().ignore_errors(true).try_get_matches_from(args);
    ErrorForm::Json { piped: lenient.is_ok_and(|matches| is_piped(&matches)) }
}

/// Whether a file goes to standard output.
fn is_piped(matches: &ArgMatches) -> bool {
    let Some((_, matches)) = matches.subcommand() else { return false };
    let output = matches.try_get_raw("output").ok().flatten();
    output.is_some_and(|mut paths| paths.any(|path| path == Target::STDOUT))
}

fn print_config(command: &clap::Command, matches: &ArgMatches) -> Result<u8> {
    if let Some((name, matches)) = matches.subcommand()
        && let Some(command) = command.find_subcommand(name)
    {
        print(&config::print(command, matches))?;
    }
    Ok(SUCCESS)
}

fn execute(global: Global, command: Command, ranks: &Ranks) -> Result<u8> {
    let level = match global {
        Global { quiet: true, .. } => LevelFilter::ERROR,
        Global { verbose: true, .. } => LevelFilter::DEBUG,
        _ => LevelFilter::INFO,
    };
    let log = tracing_subscriber::fmt::layer().with_ansi(errors::coloured());
    let log = log.event_format(output::Labelled);
    // A message that cannot be logged must not end the command.
    let log = log.log_internal_errors(false);
    let log = log.with_writer(std::io::stderr).with_filter(level);
    let warnings = output::WarningCollector.with_filter(LevelFilter::INFO);
    tracing_subscriber::registry().with(warnings).with(log).init();
    let alone = ranks.team().size() == 1;
    threads::start(global.threads.or((!alone).then_some(1)))?;
    match command {
        #[cfg(feature = "paper")]
        Command::Reproduce(reproduce) => reproduce.run(global)?,
        Command::Shape(shape) => shape.run(global, ranks.team())?,
        Command::Points(points) => points.run(global)?,
        Command::Haar(haar) => haar.run(global)?,
        Command::Balls(balls) => balls.run(global)?,
        Command::Pores(pores) => pores.run(global)?,
        Command::Interpolate(interpolate) => interpolate.run(global)?,
        #[cfg(feature = "zarr")]
        Command::Convert(convert) => convert.run(global)?,
        Command::Info(info) => info.run(global)?,
        Command::Completions(completions) => completions.run(global)?,
        Command::Man(man) => man.run(global)?,
        Command::Blocks(blocks) => return blocks.run(global),
        Command::Check(check) => return check.run(global),
        Command::Compare(compare) => return compare.run(global),
        Command::Ladder(ladder) => ladder.run(global)?,
        Command::Filtration(filtration) => filtration.run(global)?,
        #[cfg(feature = "render")]
        Command::View(view) => view.run(global)?,
    }
    Ok(SUCCESS)
}
