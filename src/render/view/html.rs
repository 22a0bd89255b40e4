use std::fmt::Write;

use plotly::Plot;
use serde_json::json;

use super::Subject;
use super::pack::Packed;
use super::plot::plot;
use crate::ladder::Level;
use crate::render::PALETTE;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page. Every string from outside is escaped, in markup and in data.
pub(super) fn page(subject: &Subject<'_>, packed: &Packed) -> String {
    let title = escape(subject.title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n{}\n</head>\n<body>\n<h1>{title}</h1>\n",
        library()
    );
    let last = subject.levels.len() - 1;
    let first = subject.first;
    let _ = write!(
        html,
        "<p>α and ω are squared lengths, in {unit} squared: at a level, a point of weight ω is a ball \
         of squared radius α + ω. Weights are the same at all levels, so each shape contains the one \
         before.</p>\n\
         <form><label for=\"level\">level <output id=\"name\"></output></label>\n\
         <input id=\"level\" type=\"range\" min=\"0\" max=\"{last}\" value=\"{first}\">\n\
         <label for=\"colour\">colour <select id=\"colour\">{}\
         <option value=\"class\">class</option></select></label></form>\n\
         <div id=\"scene\" role=\"img\" aria-label=\"The shape in three dimensions\"></div>\n\
         <p class=\"soft\">Drag to turn, pinch or scroll to zoom; tap a point for its index, F, ω and \
         class; tap a name above the scene to show or hide it.{}</p>\n\
         <table id=\"numbers\"></table>\n<table>\n",
        if subject.levels.points().values.is_some() {
            "<option value=\"value\">F</option>"
        } else {
            ""
        },
        packed
            .simplified
            .as_ref()
            .map_or(String::new(), |told| format!(" <b>This page is {}.</b>", escape(told))),
        unit = escape(subject.unit),
    );
    for (name, value) in subject.facts {
        let _ = writeln!(html, "<tr><th>{}</th><td>{}</td></tr>", escape(name), escape(value));
    }
    // Of what is interior, regular, singular.
    let colours = [2, 1, 0].map(|k| PALETTE[k].hex());
    let data = json!({
        "arrays": packed.arrays,
        "levels": subject.ladder.levels.iter().map(level).collect::<Vec<_>>(),
        "colours": colours,
    });
    let _ = write!(
        html,
        "</table>\n<script id=\"plot\" type=\"application/json\">{}</script>\n\
         <script id=\"data\" type=\"application/json\">{}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        inert(&plot(subject).to_json()),
        inert(&data.to_string()),
    );
    html
}

/// plotly.js, without the typesetter of formulas that comes with it.
fn library() -> String {
    let scripts = Plot::offline_js_sources();
    let end = scripts.find("</script>").expect("a script of plotly.js");
    scripts[..end].to_owned() + "</script>"
}

/// What the page tells of a level, as pairs.
fn level(level: &Level) -> serde_json::Value {
    let [b0, b1, b2] = level.betti.into();
    let by_class = |c: crate::shape::ByClass| {
        format!("{} interior, {} regular, {} singular", c.interior, c.regular, c.singular)
    };
    let radius = if level.alpha >= 0.0 {
        format!("√α = {:.4}", level.alpha.sqrt())
    } else {
        "negative, so no radius".into()
    };
    json!({
        "name": format!("α = {:.6}", level.alpha),
        "rows": [
            ["α", format!("{} ({radius})", level.alpha)],
            ["cells", level.cells.to_string()],
            ["facets", by_class(level.facets)],
            ["edges", by_class(level.edges)],
            ["vertices", by_class(level.vertices)],
            ["topology", format!("{b0} components, {b1} tunnels, {b2} voids")],
            ["volume", format!("{:.3}, coverage {:.2} %", level.measures.volume, 100.0 * level.coverage)],
            ["voids", format!("{:.3} in all", level.void_volume())],
        ],
    })
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// JSON that cannot end the script element it stands in.
fn inert(json: &str) -> String {
    json.replace('<', "\\u003c")
}
