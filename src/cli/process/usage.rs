//! What is wrong with a command line, and what to type instead.

use std::error::Error as _;
use std::ffi::OsString;
use std::path::Path;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};
use walpha_base::shown::shown;
use walpha_volume::near::nearest;

use super::errors::{CommandError, ErrorMessage, help};
use crate::cli::options::help::plain;

/// The innermost command that a command line names, and its name as the user types it: `walpha blocks plan`.
pub(crate) fn named<'a>(root: &'a Command, typed: &[OsString]) -> (&'a Command, String) {
    let (mut command, mut name) = (root, String::from("walpha"));
    for arg in typed.iter().skip(1) {
        if let Some(inner) = arg.to_str().and_then(|arg| command.find_subcommand(arg)) {
            command = inner;
            name = format!("{name} {}", inner.get_name());
        }
    }
    (command, name)
}

/// The message about a command line that clap refuses; `configured` means that some of it comes from a file.
pub(crate) fn wrong(
    root: &Command,
    typed: &[OsString],
    error: &Error,
    configured: bool,
) -> ErrorMessage {
    let (command, name) = named(root, typed);
    let Told { what, mut why, usage } = Told::by(error);
    // Parsers of values return errors of the command, which clap wraps in a trait object.
    let of_parser = || error.source()?.downcast_ref::<CommandError>()?.next.clone();
    let wrong = Wrong { root, command, name: &name, typed, error };
    let hint = wrong.hint();
    if let Some(better) = hint.why {
        why = better;
    } else if why.is_empty() {
        why = usage
            .map_or_else(|| format!("{name} does not take it"), |usage| format!("usage: {usage}"));
    }
    let mut next = hint.next.or_else(of_parser).unwrap_or_else(|| help(&name));
    if configured {
        next += "; note that --config sets options, too";
    }
    ErrorMessage { what, why, next }
}

/// The parts of clap's text.
struct Told {
    what: String,
    why: String,
    usage: Option<String>,
}

impl Told {
    fn by(error: &Error) -> Self {
        let text = error.render().to_string();
        let (mut said, mut usage) = (Vec::new(), None);
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            if let Some(line) = line.strip_prefix("Usage: ") {
                usage = Some(line.to_owned());
            } else if !line.starts_with("tip: ")
                && !line.starts_with("For more information")
                && usage.is_none()
            {
                said.push(line);
            }
        }
        let mut what =
            said.first().map_or("", |line| line.trim_start_matches("error: ")).to_owned();
        let mut why = said.get(1..).unwrap_or_default().join(" ");
        // The form is "invalid value 'x' for '--option <X>': message of its parser".
        if why.is_empty()
            && let Some((head, tail)) = what.split_once("': ")
        {
            (what, why) = (format!("{head}'"), tail.to_owned());
        }
        if what.ends_with(':') {
            what = format!("{what} {why}");
            why = String::new();
        }
        if let Some(values) = why.strip_prefix("[possible values: ") {
            why = format!("it must be one of {}", values.trim_end_matches(']'));
        }
        Self { what, why, usage }
    }
}

/// What clap's error leaves open.
#[derive(Default)]
struct Hint {
    why: Option<String>,
    next: Option<String>,
}

impl Hint {
    fn next(next: impl Into<Option<String>>) -> Self {
        Self { why: None, next: next.into() }
    }

    fn both(why: String, next: impl Into<Option<String>>) -> Self {
        Self { why: Some(why), next: next.into() }
    }
}

/// A command line that clap refuses.
struct Wrong<'a> {
    root: &'a Command,
    /// The innermost command that it names.
    command: &'a Command,
    name: &'a str,
    typed: &'a [OsString],
    error: &'a Error,
}

impl Wrong<'_> {
    fn hint(&self) -> Hint {
        match self.error.kind() {
            ErrorKind::InvalidSubcommand => self.of_subcommand(),
            ErrorKind::UnknownArgument => self.of_argument(),
            ErrorKind::InvalidValue => self.of_value(),
            ErrorKind::ArgumentConflict => {
                let args = [ContextKind::InvalidArg, ContextKind::PriorArg];
                let names: Vec<String> =
                    args.iter().flat_map(|kind| self.texts(*kind)).map(|arg| flag(&arg)).collect();
                let why = "each excludes the others".to_owned();
                Hint::both(why, format!("keep one of {}", names.join(" and ")))
            }
            ErrorKind::MissingRequiredArgument => self.of_missing(),
            _ => Hint::default(),
        }
    }

    /// The texts of a part of the error's context.
    fn texts(&self, kind: ContextKind) -> Vec<String> {
        match self.error.get(kind) {
            Some(ContextValue::String(text)) => vec![text.clone()],
            Some(ContextValue::Strings(texts)) => texts.clone(),
            _ => Vec::new(),
        }
    }

    /// The only text of a part of the error's context, or "".
    fn text(&self, kind: ContextKind) -> String {
        self.texts(kind).into_iter().next().unwrap_or_default()
    }

    /// A word where a command is expected: a mistyped one, or a file.
    fn of_subcommand(&self) -> Hint {
        let given = self.text(ContextKind::InvalidSubcommand);
        let path = Path::new(&given);
        let is_sample = given.starts_with("sample:") || given.starts_with("hard:");
        if path.exists() || is_sample || path.extension().is_some() {
            let thing = if is_sample { "a sample" } else { "a file" };
            let page = path.with_extension("html");
            let page = page.file_name().unwrap_or_default().to_string_lossy().replace(':', "-");
            return Hint::both(
                format!("{} is the name of {thing}, and a command comes first", shown(path)),
                format!("walpha view {} -o {}", quoted(&given), quoted(&page)),
            );
        }
        // `walpha help COMMAND` names commands of the command before it.
        let parent = if self.command.get_name() == "help" { self.root } else { self.command };
        let known = parent.get_subcommands().map(Command::get_name);
        let near = nearest(&given, known);
        let why =
            format!("{} has no command of this name", parent.get_bin_name().unwrap_or("walpha"));
        let next = near.map_or_else(
            || "`walpha --help` lists the commands".into(),
            |near| format!("did you mean '{near}'?"),
        );
        Hint::both(why, next)
    }

    /// An option that the command does not have, or one name too many.
    fn of_argument(&self) -> Hint {
        let given = self.text(ContextKind::InvalidArg);
        let output = self.command.get_arguments().find(|arg| arg.get_id() == "output");
        if !given.starts_with('-') {
            let why = format!("{} takes no further name", self.name);
            let is_file = Path::new(&given).extension().is_some();
            return match output.filter(|_| is_file) {
                // What is there is rather a second input, which an output would replace.
                Some(_) if Path::new(&given).exists() => {
                    Hint::both(why, "name one input".to_owned())
                }
                Some(_) => Hint::both(
                    format!("{}: {}", why, "an output follows -o"),
                    format!("-o {}", quoted(&given)),
                ),
                None => Hint::both(why, None),
            };
        }
        let why = format!("{} has no such option", self.name);
        let begins = |arg: &&OsString| arg.as_encoded_bytes().starts_with(given.as_bytes());
        let file = self.typed.iter().filter(begins).find(|arg| Path::new(arg).is_file());
        if let Some(file) = file {
            let path = Path::new(".").join(file);
            return Hint::both(why, format!("the file is {}", quoted(&path.to_string_lossy())));
        }
        let mut letters = given.chars().skip(1);
        if let (Some(letter), None) = (letters.next(), letters.next()) {
            let other = |c: char| {
                if c.is_uppercase() { c.to_ascii_lowercase() } else { c.to_ascii_uppercase() }
            };
            let short = |arg: &&Arg| arg.get_short() == Some(other(letter));
            let value = self.typed.iter().skip_while(|arg| **arg != *given).nth(1);
            let value = value.map(|value| value.to_string_lossy().into_owned());
            return match self.command.get_arguments().find(short) {
                Some(arg) if arg.get_action().takes_values() => {
                    let value = value.map_or_else(|| value_name(arg), |value| quoted(&value));
                    Hint::both(why, format!("did you mean -{} {value}?", other(letter)))
                }
                Some(_) => Hint::both(why, format!("did you mean -{}?", other(letter))),
                None => Hint::both(why, None),
            };
        }
        let near = self.texts(ContextKind::SuggestedArg).into_iter().next();
        Hint::both(why, near.map(|near| format!("did you mean '{}'?", flag(&near))))
    }

    /// A value that is missing, or not among the possible ones.
    fn of_value(&self) -> Hint {
        let given = self.text(ContextKind::InvalidValue);
        let valid = self.texts(ContextKind::ValidValue);
        if given.is_empty() {
            let option = self.text(ContextKind::InvalidArg);
            let long = flag(&option);
            let arg = self
                .command
                .get_arguments()
                .find(|arg| arg.get_long().is_some_and(|name| long == format!("--{name}")));
            if !valid.is_empty() {
                return Hint::next("give one of these".to_owned());
            }
            let Some(arg) = arg else { return Hint::default() };
            let flag = arg.get_short().map_or(long, |short| format!("-{short}"));
            let (what, example) = match value_name(arg).as_str() {
                "FILE" => ("the name of a file", format!("{flag} bone.ply")),
                "DIR" => ("the name of a folder", format!("{flag} folder")),
                value => {
                    let help = arg.get_help().map(plain).unwrap_or_default();
                    ("a value", format!("{flag} {value}: {help}"))
                }
            };
            let next = if arg.get_id() == "output" || value_name(arg) != "FILE" {
                format!("give it, as in {example}")
            } else {
                "give it".into()
            };
            return Hint::both(format!("{flag} needs {what}"), next);
        }
        if valid.is_empty() {
            return Hint::default();
        }
        let containing: Vec<&str> =
            valid.iter().map(String::as_str).filter(|name| name.contains(&*given)).collect();
        let near = nearest(&given, valid.iter().map(String::as_str));
        let next = match (&containing[..], near) {
            ([], None) => "give one of these".into(),
            ([], Some(near)) => format!("did you mean '{near}'?"),
            (names, _) => format!("did you mean {}?", names.join(" or ")),
        };
        Hint::next(next)
    }

    /// Arguments that are missing.
    fn of_missing(&self) -> Hint {
        let missing = self.texts(ContextKind::InvalidArg);
        let is_input = |arg: &String| arg == "<INPUT>";
        let options: Vec<&str> =
            missing.iter().filter(|arg| !is_input(arg)).map(String::as_str).collect();
        let input = missing.iter().any(is_input).then_some("name a file to read, or sample:ct");
        let options = (!options.is_empty()).then(|| format!("add {}", options.join(" ")));
        let parts: Vec<String> = input.map(str::to_owned).into_iter().chain(options).collect();
        Hint::next((!parts.is_empty()).then(|| parts.join("; ")))
    }
}

/// An option without its value: `--count` of `--count <N>`.
fn flag(option: &str) -> String {
    option.split([' ', '=', '[']).next().unwrap_or_default().to_owned()
}

fn value_name(arg: &Arg) -> String {
    let name = arg.get_value_names().and_then(<[_]>::first);
    name.map_or_else(|| "VALUE".into(), ToString::to_string)
}

/// A word as a shell takes it. Words with a zero byte, which no shell can pass, are left as they are.
pub(crate) fn quoted(word: &str) -> String {
    shlex::try_quote(word).map_or_else(|_| word.to_owned(), std::borrow::Cow::into_owned)
}
