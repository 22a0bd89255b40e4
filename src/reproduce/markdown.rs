//! The report in brief, as Markdown: claims, verdicts, files and commands.

use std::fmt::Write;

use super::{Item, Report, Verdict};

/// `reproduction.md`: each item with the paper's claims, the verdicts, its files and its command. Nothing in it depends on the
/// day, the machine or the version, so that two of them differ only in verdicts or commands.
pub fn markdown(report: &Report) -> String {
    let [x, y, z] = report.input.dims;
    let mut text = format!(
        "# {}, reproduced\n\nMade by\n\n```sh\n{}\n```\n\nfrom {x}×{y}×{z} samples. It writes this page, the \
         figures, and `report.html`, which shows them with the numbers behind each verdict. The command below an item \
         makes its files alone, as the whole run does. Nothing is tuned to agree.\n\nThe paper: {}.\n\n",
        escape(report.paper),
        report.command,
        escape(report.source),
    );
    if !report.complete {
        text += "Not all items were asked for.\n\n";
    }
    let counts: Vec<String> = Verdict::ALL
        .iter()
        .map(|verdict| format!("{} {}", report.verdicts[verdict], verdict.words()))
        .collect();
    let _ = writeln!(text, "Claims: {}.\n", counts.join(", "));
    volume(&mut text, report);
    report.items.iter().for_each(|item| section(&mut text, item));
    text
}

fn volume(text: &mut String, report: &Report) {
    let origin = &report.input.origin;
    let _ = writeln!(text, "## The volume\n\n{}\n", escape(&origin.source));
    if let Some(sum) = &origin.sha256 {
        let _ = writeln!(text, "SHA-256: `{}`, expected `{}`.\n", sum.read, sum.expected);
    }
    let _ = writeln!(text, "Can it be the paper's? {}", escape(&origin.judgement));
}

fn section(text: &mut String, item: &Item) {
    let _ = writeln!(text, "\n## {}\n\nThe paper: {}\n", escape(&item.title), escape(&item.paper));
    if !item.findings.is_empty() {
        text.push_str("| claim | verdict |\n|---|---|\n");
        for finding in &item.findings {
            let _ = writeln!(text, "| {} | {} |", escape(&finding.claim), finding.verdict.words());
        }
        text.push('\n');
    }
    let files: Vec<String> =
        item.picture.iter().chain(&item.files).map(|name| format!("`{name}`")).collect();
    if !files.is_empty() {
        let _ = writeln!(text, "Files: {}\n", files.join(", "));
    }
    let _ = writeln!(text, "```sh\n{}\n```", item.command);
}

/// Escapes text so that no character is taken for markup.
fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for sign in text.chars() {
        if matches!(sign, '\\' | '`' | '*' | '_' | '<' | '|') {
            escaped.push('\\');
        }
        escaped.push(sign);
    }
    escaped
}
