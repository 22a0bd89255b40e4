//! The report as a page: self-contained, without scripts, for screens of any width and for paper.

use std::fmt::Write;

use super::text::number;
use super::{File, Finding, Item, Report, ShapeNumbers, Table, Verdict};
use crate::shape::ByClass;
use base64::prelude::{BASE64_STANDARD, Engine};

const STYLE: &str = include_str!("page.css");

/// `report.html`: the report as a page, with the pictures among `files` embedded. The same report
/// and files give the same bytes; times are left out.
pub fn page(report: &Report, files: &[File]) -> String {
    let mut html =
        String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    let title = format!("{}, reproduced", report.paper);
    let _ = write!(
        html,
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n",
        escape(&title)
    );
    html.push_str("<main>\n");
    head(&mut html, report);
    contents(&mut html, report);
    summary(&mut html, report);
    volume(&mut html, report);
    for item in &report.items {
        section(&mut html, item, files);
    }
    html.push_str(
        "<section><p class=\"soft\">All numbers of this page are in report.json beside it, with \
         more digits; times too, which are all that differs between two runs.</p></section>\n\
         </main>\n</body>\n</html>\n",
    );
    html
}

/// Links to the sections.
fn contents(html: &mut String, report: &Report) {
    html.push_str("<nav aria-label=\"Contents\">\n<ul>\n");
    let fixed = [("claims", "Claims and verdicts"), ("volume", "The volume")];
    let items = report.items.iter().map(|item| (item.id, item.title.as_str()));
    for (id, title) in fixed.into_iter().chain(items) {
        let _ = writeln!(html, "<li><a href=\"#{id}\">{}</a></li>", escape(title));
    }
    html.push_str("</ul>\n</nav>\n");
}

fn head(html: &mut String, report: &Report) {
    let input = &report.input;
    let [x, y, z] = input.dims;
    let [low, high] = input.gray_range;
    let _ = write!(
        html,
        "<h1>{}, reproduced</h1>\n\
         <p class=\"soft\">The paper: {}. This report: walpha {}, {}.</p>\n{}\
         <p>Table 1 and the figures, reproduced on <b>{}</b> ({x}×{y}×{z} samples, values {} to {} \
         taken as gray levels 0 to 255). Each claim of the paper is compared with our numbers, and nothing is tuned \
         to agree.</p>\n\
         <p>{} of {} points ({} %) are selected after the Haar transform kept {} of {} coefficients, \
         ε = {}, RMS {} gray levels. <b>α and ω are squared lengths</b>, in voxels: at α = 10 with \
         ω = 0 the balls have radius √10.</p>\n",
        escape(report.paper),
        report.source,
        report.version,
        escape(&report.date),
        conclusion(report),
        escape(&input.name),
        number(low),
        number(high),
        input.points,
        input.samples,
        number(input.percent),
        input.haar.kept,
        input.haar.total,
        number(input.haar.epsilon),
        number(input.haar.rms),
    );
}

/// The conclusion of a complete report; for others, a note on what is missing.
fn conclusion(report: &Report) -> String {
    if report.complete {
        return in_plain_words(report);
    }
    let names: Vec<&str> = report.items.iter().map(|item| item.id).collect();
    format!(
        "<p><b>Not all of it.</b> Only {} was asked for, with <code>--only</code>. All items, and the \
         conclusion drawn from them, are made with:</p>\n<pre>{}</pre>\n",
        names.join(", "),
        escape(&report.command)
    )
}

/// The conclusion, in plain words.
fn in_plain_words(report: &Report) -> String {
    let verdict = |part: &str| {
        let mut findings = report.items.iter().flat_map(|item| &item.findings);
        findings.find(|finding| finding.claim.contains(part)).map(|finding| finding.verdict)
    };
    let filled = match verdict("the hole is filled") {
        Some(Verdict::Reproduced) => "With them the hole in its last figures is filled here.",
        _ => "So the hole that its last figures should show filled stays open.",
    };
    let weights = match verdict("Barycentric weights give another shape") {
        Some(Verdict::Reproduced) => {
            "Its weights, proportional to gray differences, change the shape a little."
        }
        _ => {
            "Its main claim about weights does not hold: weights proportional to gray differences, \
             computed by its equation, are so small that the weighted shape equals the unweighted one."
        }
    };
    format!(
        "<p><b>In plain words.</b> The method works: a small share of the samples, those where the volume \
         changes most, forms a shape of tetrahedra that shows the object, and the shape grows and \
         shrinks with α as the paper says. {weights} {filled} Some claims cannot be decided, because the \
         paper does not say how it arrived at them.</p>\n"
    )
}

/// Claims and verdicts at a glance.
fn summary(html: &mut String, report: &Report) {
    let counts: Vec<String> = report
        .verdicts
        .iter()
        .map(|(verdict, count)| format!("{count} {}", verdict.words()))
        .collect();
    let _ = write!(
        html,
        "<p id=\"claims\">Claims: {}.</p>\n<div class=\"wide\" tabindex=\"0\"><table class=\"summary\"><thead><tr><th>item</th>\
         <th>claim</th><th>verdict</th></tr></thead><tbody>\n",
        counts.join(", ")
    );
    for item in &report.items {
        for (k, finding) in item.findings.iter().enumerate() {
            let name = item.title.split('.').next().unwrap_or_default();
            let link =
                if k == 0 { format!("<a href=\"#{}\">{name}</a>", item.id) } else { String::new() };
            let _ = writeln!(
                html,
                "<tr><td>{link}</td><td>{}</td><td>{}</td></tr>",
                escape(&finding.claim),
                badge(finding.verdict)
            );
        }
    }
    html.push_str("</tbody></table></div>\n");
}

/// The origin of the volume.
fn volume(html: &mut String, report: &Report) {
    let origin = &report.input.origin;
    let _ = writeln!(
        html,
        "<section id=\"volume\"><h2>The volume</h2>\n<p><b>Where it comes from.</b> {}</p>",
        escape(&origin.source)
    );
    if let Some(sum) = &origin.sha256 {
        let _ = writeln!(
            html,
            "<div class=\"wide\" tabindex=\"0\"><table class=\"facts\"><caption>SHA-256</caption><tbody><tr><td>of the file read</td><td>{}</td></tr>\
             <tr><td>expected</td><td>{}</td></tr></tbody></table></div>",
            sum.read, sum.expected
        );
    }
    let _ = writeln!(
        html,
        "<p><b>Can it be the paper's?</b> {}</p>\n</section>",
        escape(&origin.judgement)
    );
}

fn section(html: &mut String, item: &Item, files: &[File]) {
    let _ = write!(
        html,
        "<section id=\"{}\"><h2>{}</h2>\n<p><b>The paper.</b> {}</p>\n<p><b>Ours.</b> {}</p>\n",
        item.id,
        escape(&item.title),
        escape(&item.paper),
        escape(&item.ours)
    );
    let picture = item.picture.as_ref();
    if let Some(file) = picture.and_then(|name| files.iter().find(|file| file.name == *name)) {
        let _ = writeln!(
            html,
            "<figure><a href=\"{}\"><img alt=\"{}\" src=\"data:image/png;base64,{}\"></a>\
             <figcaption>The figure opens in full size.</figcaption></figure>",
            escape(&file.name),
            escape(&item.title),
            BASE64_STANDARD.encode(&file.bytes)
        );
    }
    html.push_str("<div class=\"findings\">\n");
    item.findings.iter().for_each(|finding| judgement(html, finding));
    html.push_str("</div>\n<div class=\"tables\">\n");
    item.tables.iter().for_each(|table| rows(html, table));
    shapes(html, &item.shapes);
    if !item.facts.is_empty() {
        html.push_str(
            "<div class=\"wide\" tabindex=\"0\"><table class=\"facts\"><caption>Numbers</caption><tbody>\n",
        );
        for fact in &item.facts {
            let _ = writeln!(
                html,
                "<tr><td>{}</td><td>{}</td></tr>",
                escape(&fact.label),
                number(fact.value)
            );
        }
        html.push_str("</tbody></table></div>\n");
    }
    html.push_str("</div>\n");
    let _ = writeln!(html, "<h3>Make it with</h3>\n<pre>{}</pre>", escape(&item.command));
    if !item.commands.is_empty() {
        let _ = writeln!(
            html,
            "<h3>Its parts by hand</h3>\n<pre>{}</pre>",
            escape(&item.commands.join("\n"))
        );
    }
    if !item.files.is_empty() {
        let link = |name: &String| format!("<a href=\"{0}\">{0}</a>", escape(name));
        let links: Vec<String> = item.files.iter().map(link).collect();
        let _ = writeln!(html, "<p class=\"soft\">Files: {}</p>", links.join(", "));
    }
    html.push_str("</section>\n");
}

fn judgement(html: &mut String, finding: &Finding) {
    let _ = writeln!(
        html,
        "<div class=\"finding {}\"><p><b>Claim.</b> {}</p><p>{}: {}.</p></div>",
        class(finding.verdict),
        escape(&finding.claim),
        badge(finding.verdict),
        escape(&finding.reason)
    );
}

fn rows(html: &mut String, table: &Table) {
    let cells = |tag: &str, row: &[String]| -> String {
        let cell = |text: &String| {
            // Nothing is no heading.
            let tag = if text.is_empty() { "td" } else { tag };
            format!("<{tag}>{}</{tag}>", escape(text))
        };
        row.iter().map(cell).collect()
    };
    let _ = writeln!(
        html,
        "<div class=\"wide\" tabindex=\"0\"><table><caption>{}</caption><thead><tr>{}</tr></thead><tbody>",
        escape(&table.caption),
        cells("th", &table.head)
    );
    for row in &table.rows {
        let _ = writeln!(html, "<tr>{}</tr>", cells("td", row));
    }
    html.push_str("</tbody></table></div>\n");
}

/// The numbers of shapes side by side.
fn shapes(html: &mut String, shapes: &[ShapeNumbers]) {
    if shapes.is_empty() {
        return;
    }
    html.push_str(
        "<div class=\"wide\" tabindex=\"0\"><table class=\"shapes\"><caption>Shapes</caption><thead><tr><td></td>",
    );
    for shape in shapes {
        let _ = write!(html, "<th>{}</th>", escape(&shape.label));
    }
    html.push_str("</tr></thead><tbody>\n");
    let mut row = |label: &str, value: &dyn Fn(&ShapeNumbers) -> String| {
        let cells: String = shapes.iter().map(|s| format!("<td>{}</td>", value(s))).collect();
        let _ = writeln!(html, "<tr><td>{label}</td>{cells}</tr>");
    };
    let classes = |c: &ByClass<usize>| format!("{} · {} · {}", c.interior, c.regular, c.singular);
    row("α, and √α", &|s| {
        format!("{}, {}", number(s.alpha.squared()), number(s.alpha.squared().sqrt()))
    });
    row("ω: least, mean, largest", &|s| {
        let w = s.weights;
        format!("{}, {}, {}", number(w.min), number(w.mean), number(w.max))
    });
    row("points", &|s| s.points.to_string());
    row("hidden points", &|s| s.hidden.to_string());
    row("points in the shape", &|s| s.points_in_shape.to_string());
    row("cells", &|s| s.cells.to_string());
    row("facets: interior · regular · singular", &|s| classes(&s.facets));
    row("edges", &|s| classes(&s.edges));
    row("vertices", &|s| classes(&s.vertices));
    row("components b₀", &|s| s.betti.b0.to_string());
    row("tunnels b₁", &|s| s.betti.b1.to_string());
    row("voids b₂", &|s| s.betti.b2.to_string());
    row("volume of the voids", &|s| number(s.void_volume));
    row("largest void", &|s| s.largest_voids.first().map_or("–".into(), |v| number(v.volume)));
    row("volume (voxels³)", &|s| number(s.volume));
    row("area of regular facets (voxels²)", &|s| number(s.regular_area));
    row("area of singular facets", &|s| number(s.singular_area));
    html.push_str("</tbody></table></div>\n");
}

fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "yes",
        Verdict::NotReproduced => "no",
        Verdict::Undecided => "open",
    }
}

fn badge(verdict: Verdict) -> String {
    let sign = match verdict {
        Verdict::Reproduced => "✓",
        Verdict::NotReproduced => "✗",
        Verdict::Undecided => "?",
    };
    format!("<span class=\"verdict {}\">{sign} {}</span>", class(verdict), verdict.words())
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
