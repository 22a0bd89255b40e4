//! Commands as one types them into a shell.

/// An argument with its value quoted, if it has one that needs quotes.
pub(crate) fn argument(argument: &str) -> String {
    let Some((name, value)) = argument.split_once('=') else { return argument.to_owned() };
    // After the sign of equality nothing is an option.
    let word = quoted(&format!("={value}"));
    match word.strip_prefix("'=") {
        Some(rest) => format!("{name}='{rest}"),
        None => format!("{name}{word}"),
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
