//! An interactive page: a ladder of shapes in three dimensions, in any browser, without a network.

mod pack;
mod plot;
mod subject;

use std::fmt::Write;

use plotly::Plot;
use serde_json::json;
use walpha_shape::ladder::Level;

use crate::colour::PALETTE;
use crate::error::RenderError;
use pack::{Arrays, Packed};
use plot::plot;
pub use subject::{Detail, Differences, Original, Subject};

/// A self-contained HTML page.
#[derive(Clone, Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// What was simplified for display, if anything.
    pub simplified: Option<String>,
}

impl Page {
    /// A level of detail with more facets than this, those of all levels of α counted, is drawn simplified: as many take a
    /// few megabytes, and a phone turns smoothly what of them one level shows.
    pub const MOST_FACETS: usize = 300_000;
    /// The most levels of a page, as levels are stored in bytes.
    pub const MOST_LEVELS: usize = 250;

    /// Makes the page. The same subject gives the same bytes.
    ///
    /// Regular facets (the boundary), singular facets, singular edges and the points of each class are traces of their own,
    /// listed in the legend where there are some, and points are sized by weight. A
    /// slider chooses α, a list the level of detail, and a click or touch shows index, F, ω and
    /// class of a point. The page includes plotly.js, which draws it.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`] for an isovalue that is not a finite number.
    ///
    /// # Panics
    /// If there is no level of detail, or one of them has no α or more than [`Page::MOST_LEVELS`].
    pub fn new(subject: &Subject<'_>) -> Result<Self, RenderError> {
        assert!(!subject.details.is_empty(), "nothing to show");
        let surface = subject.original.as_ref().map(pack::surface).transpose()?;
        let pack = |detail: &Detail<'_>| {
            let levels = detail.levels.len();
            assert!((1..=Self::MOST_LEVELS).contains(&levels), "{levels} levels");
            Packed::of(detail, Self::MOST_FACETS)
        };
        let packed: Vec<_> = subject.details.iter().map(pack).collect();
        let html = page(subject, &packed, surface.as_ref());
        Ok(Self { html, simplified: simplified(subject, &packed) })
    }
}

/// What was simplified at each level of detail.
fn simplified(subject: &Subject<'_>, packed: &[Packed]) -> Option<String> {
    let of = |(detail, packed): (&Detail<'_>, &Packed)| {
        let points = detail.levels.points().len();
        Some(format!("{points} points are {}", packed.simplified.as_ref()?))
    };
    let texts: Vec<String> = subject.details.iter().zip(packed).filter_map(of).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// All is in the page: nothing is loaded, from wherever, whatever plotly.js is able to. Saved pictures are made as `data:` and `blob:`.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// The page. Every string from outside is escaped, in markup and in data.
fn page(subject: &Subject<'_>, packed: &[Packed], surface: Option<&Arrays>) -> String {
    let title = escape(subject.title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
    );
    let simplified = packed.iter().any(|packed| packed.simplified.is_some());
    let _ = write!(
        html,
        "<p>α and ω are squared lengths, in {unit} squared: at a level, a point of weight ω is a ball \
         of squared radius α + ω. Weights are the same at all levels, so each shape contains the one \
         before.</p>\n\
         <form>{}<label for=\"level\">level <output id=\"name\"></output></label>\n\
         <input id=\"level\" type=\"range\" min=\"0\" value=\"0\">\n\
         <button id=\"play\" type=\"button\">Play</button>\n\
         <label for=\"colour\">colour <select id=\"colour\">{}\
         <option value=\"class\">class</option>{}</select></label>\n\
         <button id=\"reset\" type=\"button\">Reset view</button>\n\
         <button id=\"save\" type=\"button\">Save picture</button></form>\n\
         <div id=\"scene\" role=\"img\" aria-label=\"The shape in three dimensions\"></div>\n\
         <p class=\"soft\">Drag to turn, pinch or scroll to zoom; tap a point for its index, {}ω and \
         class; tap a name above the scene to show or hide it. \
         Regular facets bound the solid part; points are sized by weight.{}</p>\n\
         <div class=\"tables\">\n<table id=\"numbers\"></table>\n<table>\n",
        choice_of_detail(subject),
        if subject.is_valued() { "<option value=\"value\">F</option>" } else { "" },
        if subject.is_compared() {
            "<option value=\"difference\">difference to the original</option>"
        } else {
            ""
        },
        explained(subject),
        if simplified { " <b id=\"simplified\"></b>" } else { "" },
        unit = escape(subject.unit),
    );
    for (name, value) in subject.facts {
        let _ = writeln!(html, "<tr><th>{}</th><td>{}</td></tr>", escape(name), escape(value));
    }
    // For interior, regular and singular.
    let colours = [2, 1, 0].map(|k| PALETTE[k].hex());
    let details = subject.details.iter().zip(packed);
    let data = json!({
        "details": details.map(|(of, packed)| detail(subject, of, packed)).collect::<Vec<_>>(),
        "isosurface": surface,
        "colours": colours,
        "bars": bars(subject),
    });
    // The library comes last, so that the text is there before it.
    let _ = write!(
        html,
        "</table>\n</div>\n{}\n<script id=\"plot\" type=\"application/json\">{}</script>\n\
         <script id=\"data\" type=\"application/json\">{}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        library(),
        inert(&plot(subject).to_json()),
        inert(&data.to_string()),
    );
    html
}

/// The control that chooses a level of detail, where there are several.
fn choice_of_detail(subject: &Subject<'_>) -> String {
    let last = subject.details.len() - 1;
    if last == 0 {
        return String::new();
    }
    let mut html = "<label for=\"detail\">detail <select id=\"detail\">".to_owned();
    for (k, detail) in subject.details.iter().enumerate() {
        let selected = if k == last { " selected" } else { "" };
        let points = detail.levels.points().len();
        let _ = write!(html, "<option value=\"{k}\"{selected}>{points} points</option>");
    }
    html + "</select></label>\n"
}

/// The data of a level of detail.
fn detail(subject: &Subject<'_>, detail: &Detail<'_>, packed: &Packed) -> serde_json::Value {
    let mut rows = vec![["points".to_owned(), detail.levels.points().len().to_string()]];
    if let Some(differences) = detail.differences {
        let rmse = significant(differences.rmse);
        let text = format!("{rmse} {} (root mean square, on all samples)", subject.difference);
        rows.push(["error of F".to_owned(), text]);
    }
    json!({
        "arrays": packed.arrays,
        "rows": rows,
        "levels": detail.ladder.levels.iter().map(level).collect::<Vec<_>>(),
        "first": detail.first,
        "simplified": packed.simplified,
    })
}

/// The titles of the colour scales.
fn bars(subject: &Subject<'_>) -> serde_json::Value {
    let difference = subject
        .is_compared()
        .then(|| format!("difference to the original, in {}", subject.difference));
    json!({ "value": format!("F: {}", subject.value), "difference": difference })
}

/// The explanation of the numbers of a point.
fn explained(subject: &Subject<'_>) -> String {
    let mut text = String::new();
    if subject.is_valued() {
        let _ = write!(text, "F ({}), ", escape(subject.value));
    }
    if subject.is_compared() {
        let _ = write!(
            text,
            "difference (root mean square of F, filled in, against the samples around it, in {}), ",
            escape(subject.difference)
        );
    }
    text
}

/// plotly.js, without the bundled typesetter of formulas.
fn library() -> String {
    let scripts = Plot::offline_js_sources();
    let end = scripts.find("</script>").expect("a script of plotly.js");
    scripts[..end].to_owned() + "</script>"
}

/// The rows of a level on the page.
fn level(level: &Level) -> serde_json::Value {
    let by_class = |c: walpha_shape::ByClass<usize>| {
        format!("{} interior, {} regular, {} singular", c.interior, c.regular, c.singular)
    };
    let alpha = significant(level.alpha.squared());
    let radius = match level.alpha.radius() {
        Some(radius) => format!("√α = {}", significant(radius)),
        None => "negative, so no radius".into(),
    };
    json!({
        "name": format!("α = {alpha}"),
        "alpha": level.alpha.squared().clamp(f64::MIN, f64::MAX),
        "rows": [
            ["α", format!("{alpha} ({radius})")],
            ["cells", level.cells.to_string()],
            ["facets", by_class(level.facets)],
            ["edges", by_class(level.edges)],
            ["vertices", by_class(level.vertices)],
            ["topology", level.betti.to_string()],
            ["volume", format!("{}, coverage {:.2} %", significant(level.measures.volume), 100.0 * level.coverage)],
            ["voids", format!("{} in all", significant(level.void_volume()))],
        ],
    })
}

/// A number with four significant digits at most.
fn significant(number: f64) -> String {
    if number.is_infinite() {
        return if number > 0.0 { "∞".into() } else { "−∞".into() };
    }
    // Rounded by way of a text with an exponent; parsing gives the nearest double.
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    walpha_base::shown::number(rounded)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// JSON that cannot end the script element around it.
fn inert(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_enough() {
        let numbers = [9.5, 0.016_074_782_699_769_346, 12_345.678, 2e-13, 0.0, f64::INFINITY];
        assert_eq!(numbers.map(significant), ["9.5", "0.01607", "12350", "2e-13", "0", "∞"]);
    }
}
