//! An interactive page: a ladder of shapes in three dimensions, in any browser, without a network.
//!
//! `page.html` is made by `web/page/build.mjs` from the scripts, the style and the markup that it shares with the page which
//! computes; it draws with three.js. This module inserts its data.

mod pack;
mod subject;

use serde_json::{Map, Value, json};
use walpha_shape::SinglePrecision;
use walpha_shape::ladder::{Drawn, Level, frame_of};

use crate::error::RenderError;
use pack::Packed;
pub use subject::{Detail, Differences, Kinds, Original, Subject};

/// A self-contained HTML page.
#[derive(Clone, Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// Tells what was simplified for display, if anything.
    pub simplified: Option<String>,
}

impl Page {
    /// A level of detail with more facets than this, counted over all levels of α, is simplified for drawing: this many facets
    /// take about ten megabytes.
    pub const MOST_FACETS: usize = 1_000_000;
    /// The maximum number of levels of a page, because levels are stored in bytes.
    pub const MOST_LEVELS: usize = 250;

    /// Makes the page. The same subject gives the same bytes.
    ///
    /// A slider sets α, colours are by class, F, weight or difference, and singular facets and edges, points, balls, hidden
    /// points and the isosurface are shown on request. A list selects the level of detail, and a click or touch tells index, F, ω
    /// and class of a point. The page includes three.js, which draws it.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`] for an isovalue that is not a finite number.
    ///
    /// # Panics
    /// If there is no level of detail, or one of them has no α or more than [`Page::MOST_LEVELS`].
    pub fn new(subject: &Subject<'_>) -> Result<Self, RenderError> {
        assert!(!subject.details.is_empty(), "nothing to show");
        let drawn = subject.details.iter().map(|detail| {
            let levels = detail.levels.len();
            assert!((1..=Self::MOST_LEVELS).contains(&levels), "{levels} levels");
            detail.levels.drawn(MOST_VOIDS)
        });
        let drawn: Vec<Drawn<'_>> = drawn.collect();
        let centre = centre(&drawn);
        let whole = whole(subject, &drawn, centre);
        let pack = |(detail, drawn)| Packed::of(detail, drawn, centre, Self::MOST_FACETS);
        let packed: Vec<_> = subject.details.iter().zip(drawn).map(pack).collect();
        let simplified = simplified(subject, &packed);
        let original = subject.original.as_ref();
        let surface = original.map(|original| pack::surface(original, centre)).transpose()?;
        let mut elements = element("page", &surface.unwrap_or_default().packed(whole));
        for (k, (of, packed)) in subject.details.iter().zip(packed).enumerate() {
            let content = detail(subject, of, packed.simplified.as_deref());
            elements += &element(&format!("detail-{k}"), &packed.arrays.packed(content));
        }
        let html = PAGE.replacen("<!--title-->", &escape(subject.title), 2).replacen(
            "<!--data-->",
            &elements,
            1,
        );
        Ok(Self { html, simplified })
    }
}

/// Tells what was simplified at each level of detail.
fn simplified(subject: &Subject<'_>, packed: &[Packed]) -> Option<String> {
    let of = |(detail, packed): (&Detail<'_>, &Packed)| {
        let points = detail.levels.own_points();
        Some(format!("{points} points are {}", packed.simplified.as_ref()?))
    };
    let texts: Vec<String> = subject.details.iter().zip(packed).filter_map(of).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}

/// The page without its title and its data.
const PAGE: &str = include_str!("page.html");

/// The number of voids of a level that the page lists.
const MOST_VOIDS: usize = 200;

/// The content that does not depend on the level of detail.
fn whole(subject: &Subject<'_>, drawn: &[Drawn<'_>], centre: [f64; 3]) -> Value {
    let difference = format!(
        "difference to the original (root mean square of F, filled in, around each point), in {}",
        subject.difference
    );
    let torus = subject.details.iter().find_map(|detail| detail.levels.torus());
    let cell = torus.map(|torus| {
        let places = drawn.iter().flat_map(|drawn| drawn.points.positions());
        let [mut origin, a, b, c] = frame_of(torus, places);
        (0..3).for_each(|k| origin[k] -= centre[k]);
        [origin, a, b, c]
    });
    let domain = match (cell, subject.original) {
        (Some(_), _) => "the periodic box",
        (None, Some(_)) => "the volume",
        (None, None) => "the box",
    };
    json!({
        "facts": facts(subject, drawn, centre),
        "cell": cell,
        "unit": subject.coordinates.unit.symbol(),
        "space": subject.coordinates.space,
        "centre": centre,
        "domain": domain,
        "titles": { "value": format!("F ({})", subject.value), "difference": difference },
        "isovalue": subject.original.map(|original| original.isovalue),
        "points": subject.details.iter().map(|detail| detail.levels.own_points()).collect::<Vec<_>>(),
    })
}

/// The facts that the page lists: those of the subject, and the centre of the picture if single precision would not suffice
/// otherwise.
fn facts(subject: &Subject<'_>, drawn: &[Drawn<'_>], centre: [f64; 3]) -> Vec<(String, String)> {
    let mut facts = subject.facts.to_vec();
    let single = |at: [f64; 3]| drawn.iter().map(move |drawn| single(drawn, at));
    if single([0.0; 3]).any(|single| single.remark().is_some()) {
        let [x, y, z] = centre.map(walpha_base::shown::number);
        let mut text = format!(
            "positions are drawn in single precision, after {x}, {y}, {z} is subtracted; what is read out is in the \
             coordinates of the input"
        );
        if single(centre).any(|single| single.is_lossy) {
            text += "; even so the picture is not exact";
        }
        facts.push(("offset".into(), text));
    }
    facts
}

/// The conversion of the positions of a level of detail, as seen from a place, to single precision.
fn single(drawn: &Drawn<'_>, from: [f64; 3]) -> SinglePrecision {
    let seen = |place: &[f64; 3]| [0, 1, 2].map(|k| place[k] - from[k]);
    let places: Vec<[f64; 3]> = drawn.points.positions().iter().map(seen).collect();
    let sides = drawn.facets.iter().flat_map(|&([a, b, c], _)| [[a, b], [b, c], [c, a]]);
    SinglePrecision::of(&places, sides.chain(drawn.edges.iter().map(|(edge, _)| *edge)))
}

/// A level of detail, without its arrays.
fn detail(subject: &Subject<'_>, detail: &Detail<'_>, simplified: Option<&str>) -> Value {
    let mut rows = vec![["points".to_owned(), detail.levels.own_points().to_string()]];
    if let Some(differences) = detail.differences {
        let rmse = significant(differences.rmse);
        let text = format!("{rmse} {} (root mean square, on all samples)", subject.difference);
        rows.push(["error of F".to_owned(), text]);
    }
    json!({
        "elements": known(detail.atoms),
        "classNames": known(detail.classes),
        "levels": detail.ladder.levels.iter().map(level).collect::<Vec<_>>(),
        "first": detail.first,
        "rows": rows,
        "simplified": simplified,
    })
}

/// Kinds by their numbers.
fn known(kinds: Option<&Kinds>) -> Map<String, Value> {
    let known = kinds.into_iter().flat_map(|kinds| &kinds.known);
    let kind = |(number, name, colour): &(u8, &str, [u8; 3])| {
        (number.to_string(), json!({ "name": name, "colour": colour }))
    };
    known.map(kind).collect()
}

/// The numbers of a level, with as many voids as are listed.
fn level(level: &Level) -> Value {
    let mut level = level.clone();
    level.voids.truncate(MOST_VOIDS);
    serde_json::to_value(level).expect("numbers and lists of them")
}

/// The centre of the box of what is drawn: positions are relative to it.
fn centre(drawn: &[Drawn<'_>]) -> [f64; 3] {
    let points = || drawn.iter().flat_map(|drawn| drawn.points.positions());
    [0, 1, 2].map(|k| {
        let (low, high) = points().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (p[k].min(low), p[k].max(high))
        });
        if low <= high { f64::midpoint(low, high) } else { 0.0 }
    })
}

/// An element that the script unpacks.
fn element(id: &str, packed: &str) -> String {
    format!("<script id=\"{id}\" type=\"application/octet-stream\">{packed}</script>\n")
}

/// A number with four significant digits at most.
fn significant(number: f64) -> String {
    if number.is_infinite() {
        return if number > 0.0 { "∞".into() } else { "−∞".into() };
    }
    // Rounded through a text with an exponent; parsing gives the nearest double.
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    walpha_base::shown::number(rounded)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
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
