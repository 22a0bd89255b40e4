//! Reads options from a file, and prints them as a file: `--config` and `--print-config`.
//!
//! The settings of a file become command-line arguments after those of the user, so each option is checked once and in one place,
//! and new commands and options need no code here.

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, FromArgMatches};
use toml::{Table, Value};

use walpha_base::shown::shown;
use walpha_volume::near::nearest;

use super::preset;
use super::settings::Given;
use crate::cli::options::global::EVERY_COMMAND;
use crate::cli::process::errors::{CommandError, Result, command_error, fail};
use crate::settings::Settings;

/// The option that names the file.
const FILE: &str = "config";
/// The option that prints a configuration file.
pub(crate) const PRINT: &str = "print-config";
/// The largest size of a settings file in bytes. There are about a hundred options.
const LONGEST: u64 = 1 << 20;
/// The hidden option that lists the options which the file set.
pub(crate) const CONFIGURED: &str = "configured";
/// Options that a file cannot set: they concern the configuration itself, or only this call.
const NOT_CONFIGURED: [&str; 6] = [FILE, PRINT, CONFIGURED, preset::OPTION, "help", "version"];

/// `--config` and `--print-config`, for every command.
pub(crate) fn config_options() -> [Arg; 3] {
    let option = |name| Arg::new(name).long(name).global(true).help_heading(EVERY_COMMAND);
    let configured = option(CONFIGURED).hide(true).action(ArgAction::Append);
    let file = option(FILE).value_name("FILE");
    let print = option(PRINT).action(ArgAction::SetTrue);
    [
        file.value_parser(clap::value_parser!(PathBuf)).help(
            "TOML file with options by their long names, as in alpha = 4; the command line takes precedence",
        ),
        print.help("Print the options in effect as a file for --config, and do nothing else"),
        configured,
    ]
}

/// Returns the arguments, with those from the file that `--config` names.
///
/// Keys are the long names of options. Those at the top level are for every command that has the option; a table named after a
/// command is only for that command, and takes precedence. The command line takes precedence over the file, and settings of the
/// file that conflict with it are ignored.
pub(crate) fn with_settings(command: &Command, mut args: Vec<OsString>) -> Result<Vec<OsString>> {
    let long = format!("--{FILE}");
    if !args.iter().any(|arg| arg.to_string_lossy().starts_with(&long)) {
        return Ok(args);
    }
    // A first, lenient pass finds the options that the file must not set. Errors in the arguments are reported when all of them
    // are parsed.
    let lenient = command.clone().ignore_errors(true).try_get_matches_from(&args);
    let Ok(given) = lenient else { return Ok(args) };
    // `blocks plan` is a subcommand of a command.
    let (mut subcommand, mut of_command, mut name) = (command, &given, "");
    let mut file = path(&given);
    while let Some((inner_name, inner)) = of_command.subcommand()
        && let Some(inner_command) = subcommand.find_subcommand(inner_name)
    {
        if name.is_empty() {
            name = inner_name;
        }
        (subcommand, of_command) = (inner_command, inner);
        file = path(of_command).or(file);
    }
    let Some(file) = file else { return Ok(args) };
    let is_typed = |arg: &Arg| {
        of_command.value_source(arg.get_id().as_str()) == Some(ValueSource::CommandLine)
    };
    let mut more = Vec::new();
    for (key, value) in read(command, &file, name)? {
        let Some(arg) = option(subcommand, &key) else { continue };
        if is_typed(arg) || conflicting(subcommand, arg).into_iter().any(is_typed) {
            continue;
        }
        let text = arguments(arg, &value).map_err(|error| {
            error.context(format!("{}: {key} = {value} is not valid", shown(&file)))
        })?;
        // A default need not be passed, and must not be passed if its option requires another.
        let defaults = arg.get_default_values();
        if matches!((&text[..], defaults), ([one], [default]) if *one == default_text(arg, default))
        {
            continue;
        }
        more.extend(text);
        more.push(format!("--{CONFIGURED}={}", arg.get_id()));
    }
    let end = args.iter().position(|arg| arg == "--").unwrap_or(args.len());
    args.splice(end..end, more.into_iter().map(OsString::from));
    Ok(args)
}

/// Prints the options in force as a file for `--config`: the given ones and the defaults.
pub(crate) fn print(subcommand: &Command, matches: &ArgMatches) -> String {
    let mut text = format!("# walpha {}\n", subcommand.get_name());
    let of_preset = of_preset(matches);
    let is_default =
        |arg: &Arg| matches.value_source(arg.get_id().as_str()) == Some(ValueSource::DefaultValue);
    let is_given = |arg: &Arg| matches!(matches.value_source(arg.get_id().as_str()), Some(source) if source != ValueSource::DefaultValue);
    for arg in options(subcommand) {
        let id = arg.get_id().as_str();
        if let Some((_, value)) = of_preset.iter().find(|(name, _)| *name == id) {
            text +=
                &format!("{} = {}\n", arg.get_long().unwrap_or_default(), self::value(arg, value));
            continue;
        }
        // A default that conflicts with a given option is not in force.
        let is_excluded = || {
            Settings::excluded_by(id).any(|other| of_preset.iter().any(|(name, _)| *name == other))
                || conflicting(subcommand, arg).into_iter().any(is_given)
        };
        if is_default(arg) && is_excluded() {
            continue;
        }
        let Some(values) = matches.get_raw(arg.get_id().as_str()) else { continue };
        let mut values: Vec<Value> = values.map(|raw| value(arg, &raw.to_string_lossy())).collect();
        let value = if takes_many(arg) { Value::Array(values) } else { values.remove(0) };
        let key = arg.get_long().unwrap_or_default();
        text += &format!("{key} = {value}\n");
    }
    text
}

/// The settings that the preset adds to the given ones.
fn of_preset(matches: &ArgMatches) -> Vec<(&'static str, String)> {
    let all = Given::from_arg_matches(matches).expect("all have parsers");
    let is_given = |name| matches.value_source(name) == Some(ValueSource::CommandLine);
    let added = all.settings.iter().filter(|(name, _)| !is_given(name));
    added.map(|(name, text)| (name, text.to_owned())).collect()
}

fn path(matches: &ArgMatches) -> Option<PathBuf> {
    matches.try_get_one::<PathBuf>(FILE).ok().flatten().cloned()
}

/// The file's settings for this command.
fn read(command: &Command, file: &Path, name: &str) -> Result<Table> {
    let mut text = String::new();
    let read = File::open(file).and_then(|open| open.take(LONGEST + 1).read_to_string(&mut text));
    read.map_err(|error| {
        command_error!("cannot read {}: {error}", shown(file) => "give --config the name of a TOML file")
    })?;
    if text.len() as u64 > LONGEST {
        fail!("{} has more than {LONGEST} bytes, and no configuration is that long", shown(file) => "give --config the name of a TOML file");
    }
    let table: Table = text.parse().map_err(|error: toml::de::Error| {
        let message = error.to_string();
        let lines = message.lines().map(str::trim).filter(|line| !line.is_empty());
        let words: Vec<&str> = lines.collect();
        command_error!("{} is not a TOML file: {}", shown(file), words.join(" ") => "walpha {name} --print-config shows how one looks")
    })?;
    let (mut settings, mut own) = (Table::new(), Table::new());
    for (key, value) in table {
        match (value, command.find_subcommand(&key)) {
            (Value::Table(of_command), Some(subcommand)) => {
                if let Some(key) = of_command.keys().find(|key| option(subcommand, key).is_none()) {
                    let known = options(subcommand).filter_map(Arg::get_long).collect();
                    let name = format!("[{}] {key}", subcommand.get_name());
                    return Err(unknown(file, &name, key, known));
                }
                if key == name {
                    own = of_command;
                }
            }
            (value, _) => {
                if !command.get_subcommands().any(|each| option(each, &key).is_some()) {
                    let names = command.get_subcommands().map(Command::get_name);
                    let options = command.get_subcommands().flat_map(options);
                    let known = options.filter_map(Arg::get_long).chain(names).collect();
                    return Err(unknown(file, &key, &key, known));
                }
                settings.insert(key, value);
            }
        }
    }
    settings.extend(own);
    Ok(settings)
}

fn unknown(file: &Path, name: &str, key: &str, known: Vec<&str>) -> CommandError {
    let next = match nearest(key, known) {
        Some(near) => format!("did you mean {near}?"),
        None => "remove it, or see --print-config".to_owned(),
    };
    command_error!("{}: no option has the name {name}", shown(file) => "{next}")
}

/// The options that a file may set.
fn options(subcommand: &Command) -> impl Iterator<Item = &Arg> {
    subcommand.get_arguments().filter(|arg| {
        arg.get_long().is_some_and(|long| !NOT_CONFIGURED.contains(&long)) && !arg.is_positional()
    })
}

fn option<'a>(subcommand: &'a Command, key: &str) -> Option<&'a Arg> {
    options(subcommand).find(|arg| {
        let is_alias = || arg.get_all_aliases().is_some_and(|aliases| aliases.contains(&key));
        arg.get_long() == Some(key) || is_alias()
    })
}

/// The options that conflict with this one.
fn conflicting<'a>(subcommand: &'a Command, arg: &Arg) -> Vec<&'a Arg> {
    let of_groups = subcommand
        .get_groups()
        .filter(|group| !ArgGroup::clone(group).is_multiple())
        .filter(|group| group.get_args().any(|id| id == arg.get_id()))
        .flat_map(ArgGroup::get_args)
        .filter(|&id| id != arg.get_id());
    let of_groups =
        of_groups.filter_map(|id| subcommand.get_arguments().find(|a| a.get_id() == id));
    let of_arguments = subcommand.get_arguments().filter(|other| {
        let excludes = |one, two: &Arg| {
            let conflicts = subcommand.get_arg_conflicts_with(one);
            conflicts.iter().any(|arg| arg.get_id() == two.get_id())
        };
        !arg.is_global_set()
            && !other.is_global_set()
            && (excludes(arg, other) || excludes(other, arg))
    });
    of_groups.chain(of_arguments).collect()
}

fn takes_many(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|range| range.max_values() > 1)
        || matches!(arg.get_action(), ArgAction::Append)
}

/// The command-line arguments for a key and its value.
fn arguments(arg: &Arg, value: &Value) -> Result<Vec<String>> {
    let long = arg.get_long().unwrap_or_default();
    let one = |value: &Value| match value {
        Value::String(text) => Ok(text.clone()),
        Value::Integer(_) | Value::Float(_) => Ok(value.to_string()),
        _ => fail!("a list or table is not a value" => "give a text or a number"),
    };
    if !arg.get_action().takes_values() {
        return match value {
            Value::Boolean(true) => Ok(vec![format!("--{long}")]),
            Value::Boolean(false) => Ok(Vec::new()),
            _ => fail!("{long} is a switch" => "give true or false"),
        };
    }
    let values = match value {
        Value::Array(values) => values.iter().map(one).collect::<Result<Vec<_>>>()?,
        value => vec![one(value)?],
    };
    if takes_many(arg) && arg.get_value_delimiter().is_none() {
        return Ok(std::iter::once(format!("--{long}")).chain(values).collect());
    }
    // Lists of numbers are comma-separated on the command line.
    Ok(vec![format!("--{long}={}", values.join(","))])
}

fn default_text(arg: &Arg, default: &OsStr) -> String {
    format!("--{}={}", arg.get_long().unwrap_or_default(), default.to_string_lossy())
}

/// A value in TOML: a number if it parses as one, otherwise a string.
fn value(arg: &Arg, raw: &str) -> Value {
    if !arg.get_action().takes_values() {
        return Value::Boolean(raw == "true");
    }
    let number =
        format!("number = {raw}").parse::<Table>().ok().and_then(|mut t| t.remove("number"));
    match number {
        // The text must not change when the number is printed.
        Some(number @ (Value::Integer(_) | Value::Float(_))) if number.to_string() == raw => number,
        _ => Value::String(raw.to_owned()),
    }
}
