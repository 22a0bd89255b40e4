//! Numbers and names as the report writes them.

/// Writes at most three decimals, eight for magnitudes below 0.1, without trailing zeros.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if value == f64::INFINITY {
        return "∞".into();
    }
    let decimals = if value.abs() < 0.1 { 8 } else { 3 };
    let text = format!("{value:.decimals$}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
}

/// A count with its noun.
pub(super) fn count(n: u64, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// An argument as a shell reads it back.
pub(super) fn shell(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./:@=,+".contains(c);
    if !argument.is_empty() && argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let pairs = [
            (10.0, "10"),
            (1.0 / 3.0, "0.333"),
            (-0.0, "0"),
            (0.000_626_723, "0.00062672"),
            (f64::INFINITY, "∞"),
            (24_531.833_333, "24531.833"),
            (-2.5, "−2.5"),
        ];
        for (value, text) in pairs {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_shell_reads_names_back() {
        assert_eq!(shell("sample:phantom@24"), "sample:phantom@24");
        assert_eq!(shell("my scan's.inr"), r"'my scan'\''s.inr'");
    }
}
