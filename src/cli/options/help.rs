//! The help: the order of options, and the few that `-h` shows.

use clap::builder::StyledStr;
use clap::{Arg, Command};
use walpha_base::sort::sort_by_key;

use super::preset;
use crate::cli::options::global::EVERY_COMMAND;

/// The heading of outputs, and the options of commands that belong there.
const OUTPUT: &str = "Output";
const OUTPUTS: [&str; 4] = ["output", "ascii", "solid", "groups"];
/// The headings in the order of use. Others come after these, and the options of every command are last.
const HEADINGS: [&str; 7] =
    ["Input", "Weights and α", OUTPUT, "Points", "Wavelet stage", "Shape", "Coordinates"];
/// The headings of advanced options, which come last before those of every command.
const ADVANCED: [&str; 4] = ["Parts of a volume", "Raw volumes", "Pictures (.png)", "Packing"];
/// The options with a heading that `-h` shows.
const COMMON: [&str; 13] = [
    "preset",
    "gray",
    "columns",
    "alpha",
    "alpha_radius",
    "alpha_ref",
    "weights",
    "output",
    "solid",
    "count",
    "threshold",
    "value_min",
    "json",
];

/// Sorts the options of a command in the order of use, and hides all but the common ones in `-h`.
pub(crate) fn arranged(command: Command) -> Command {
    let mut args = Vec::new();
    // All are taken and put back at once: to change one by its name moves all that follow it.
    let command = command.mut_subcommands(arranged).mut_args(|arg| {
        args.push(arg);
        Arg::default()
    });
    sort_by_key(&mut args, |arg| {
        let option = (!arg.is_positional()).then(|| rank(heading(arg)));
        (option, arg.get_id() != preset::OPTION)
    });
    let mut args = args
        .into_iter()
        .map(|arg| if arg.is_positional() { arg } else { with_negative(shown(arg)) });
    with_example(command.mut_args(|_| args.next().expect("as many as were taken")))
}

/// An option that takes a negative number for its value, not for another option, so that the error is that of the value.
fn with_negative(arg: Arg) -> Arg {
    let takes_one =
        arg.get_action().takes_values() && arg.get_num_args().is_none_or(|n| n.max_values() == 1);
    if takes_one { arg.allow_negative_numbers(true) } else { arg }
}

/// An option as the help shows it.
fn shown(arg: Arg) -> Arg {
    let hidden = heading(&arg).is_some() && !COMMON.contains(&arg.get_id().as_str());
    let arg = if is_output(&arg) { arg.help_heading(OUTPUT) } else { arg };
    shortened(arg).hide_short_help(hidden)
}

/// Adds the first example of `--help` to `-h`.
fn with_example(command: Command) -> Command {
    let about = command.get_long_about().map(plain).unwrap_or_default();
    let example = about.lines().find(|line| line.starts_with("walpha "));
    match (example, command.get_after_help()) {
        (Some(example), None) => {
            command.after_help(format!("Example: {example}")).after_long_help("")
        }
        _ => command,
    }
}

/// Shortens the help of an option to its first clause for `-h`, unless it has a separate short help.
fn shortened(arg: Arg) -> Arg {
    let (Some(help), None) = (arg.get_help(), arg.get_long_help()) else { return arg };
    let help = plain(help);
    let ends = ["; ", ". ", ": ", " [default"];
    let end = ends.iter().filter_map(|end| help.find(end)).min().unwrap_or(help.len());
    arg.help(help[..end].to_owned()).long_help(help)
}

/// The text of a help. Ours have no colours; to search all of them for colours would double the time that the program takes to start.
pub(crate) fn plain(help: &StyledStr) -> String {
    help.ansi().to_string()
}

fn heading(arg: &Arg) -> Option<&str> {
    if is_output(arg) { Some(OUTPUT) } else { arg.get_help_heading() }
}

fn is_output(arg: &Arg) -> bool {
    OUTPUTS.contains(&arg.get_id().as_str())
}

fn rank(heading: Option<&str>) -> usize {
    let Some(heading) = heading else { return 0 };
    let among = |headings: &[&str]| headings.iter().position(|known| *known == heading);
    if heading == EVERY_COMMAND {
        return usize::MAX;
    }
    let others = HEADINGS.len() + 1;
    among(&HEADINGS)
        .map(|at| at + 1)
        .or(among(&ADVANCED).map(|at| others + 1 + at))
        .unwrap_or(others)
}
