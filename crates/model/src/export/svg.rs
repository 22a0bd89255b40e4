use std::fmt::Write as _;
use std::io::{self, Write};

use super::exporter::{check_range, stated_offset};
use super::{Exporter, Needs};
use walpha_shape::{AlphaShape, Class, Outline, SinglePrecision};
use walpha_volume::annotation;

/// Writes SVG: the polygons of an [outline](AlphaShape::outline), each a path that is filled by the even-odd rule, singular edges
/// as lines and singular vertices as dots. They are drawn in the two coordinates in which the plane is seen. The second one
/// points up and is therefore negated; otherwise coordinates are those of the points. Programs may draw SVG in single precision
/// (SVG 2, "Real number precision"), so that far from the origin a round number is subtracted first ([`SinglePrecision`]), which the description
/// states: `OFFSET=434000,5412000,0`.
#[derive(Clone, Copy, Debug)]
pub struct Svg;

impl Exporter for Svg {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let outline = shape.outline().map_err(io::Error::other)?;
        let [u, v] = outline.axes;
        let single = single(outline, shape.points().positions());
        check_range(&single)?;
        let place = |point: u32| {
            let position = shape.points().positions()[point as usize];
            let [x, y] = [u, v].map(|axis| position[axis] - single.offset[axis]);
            // Subtracting from 0 avoids −0.
            [x, 0.0 - y]
        };
        let Frame { low: [x, y], size: [width, height], pen } = Frame::around(outline, place);
        writeln!(
            out,
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="{x} {y} {width} {height}">"#
        )?;
        let note = annotation::comment(shape.coordinates());
        writeln!(out, "<title>walpha: {}</title>", annotation::alpha(shape.options().alpha))?;
        let note = stated_offset(&single).unwrap_or_default() + &note;
        if !note.is_empty() {
            writeln!(out, "<desc>{}</desc>", note.trim_start())?;
        }
        writeln!(
            out,
            r##"<g fill="#c9d7e3" fill-rule="evenodd" stroke="#2b4a66" stroke-width="{pen}" stroke-linejoin="round">"##
        )?;
        for polygon in &outline.polygons {
            let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
            let rings: String = rings.map(|ring| path(ring, place) + "Z").collect();
            writeln!(out, r#"<path d="{rings}"/>"#)?;
        }
        writeln!(out, "</g>")?;
        if !outline.edges.is_empty() {
            let edges: String = outline.edges.iter().map(|edge| path(edge, place)).collect();
            writeln!(
                out,
                r##"<path fill="none" stroke="#e6822c" stroke-width="{pen}" stroke-linecap="round" d="{edges}"/>"##
            )?;
        }
        if !outline.points.is_empty() {
            writeln!(out, r##"<g fill="#e6822c">"##)?;
            for &point in &outline.points {
                let [x, y] = place(point);
                writeln!(out, r#"<circle cx="{x}" cy="{y}" r="{}"/>"#, 1.5 * pen)?;
            }
            writeln!(out, "</g>")?;
        }
        writeln!(out, "</svg>")
    }

    fn needs(&self) -> Needs {
        Needs::Facet
    }

    fn single_precision(&self, shape: &AlphaShape) -> Option<SinglePrecision> {
        let outline = shape.outline().ok()?;
        Some(single(outline, shape.points().positions()))
    }
}

/// How the two coordinates that are drawn are converted to single precision.
fn single(outline: &Outline, positions: &[[f64; 3]]) -> SinglePrecision {
    let rings = outline
        .polygons
        .iter()
        .flat_map(|polygon| [&polygon.outer].into_iter().chain(&polygon.holes));
    let (mut places, mut sides) = (Vec::new(), Vec::new());
    let lines = rings.map(|ring| &ring[..]).chain(outline.edges.iter().map(|edge| &edge[..]));
    for line in lines.chain(outline.points.chunks(1)) {
        let first = places.len() as u32;
        places.extend(line.iter().map(|&point| {
            let mut place = [0.0; 3];
            outline.axes.iter().for_each(|&axis| place[axis] = positions[point as usize][axis]);
            place
        }));
        sides.extend((first + 1..places.len() as u32).map(|k| [k - 1, k]));
    }
    SinglePrecision::of(&places, sides.into_iter())
}

/// A line from point to point.
fn path(points: &[u32], place: impl Fn(u32) -> [f64; 2]) -> String {
    let mut path = String::new();
    for (k, &point) in points.iter().enumerate() {
        let [x, y] = place(point);
        let step = if k == 0 { 'M' } else { 'L' };
        write!(path, "{step}{x} {y}").expect("writing to a string cannot fail");
    }
    path
}

/// The part of the plane that is shown.
struct Frame {
    low: [f64; 2],
    size: [f64; 2],
    /// The width of lines.
    pen: f64,
}

impl Frame {
    /// The box of the vertices with a margin; the unit square for an empty shape.
    fn around(outline: &Outline, place: impl Fn(u32) -> [f64; 2]) -> Self {
        let vertices = outline.complex.vertices.iter();
        let places =
            vertices.filter(|vertex| vertex.1 != Class::Exterior).map(|(&[v], _)| place(v));
        let ends = places.map(|place| [place, place]).reduce(|[low, high], [place, _]| {
            [[0, 1].map(|k| low[k].min(place[k])), [0, 1].map(|k| high[k].max(place[k]))]
        });
        let [low, high] = ends.unwrap_or([[0.0; 2], [1.0; 2]]);
        let extent = [0, 1].map(|k| high[k] - low[k]);
        // A single vertex has no extent.
        let largest = Some(extent[0].max(extent[1])).filter(|&size| size > 0.0).unwrap_or(1.0);
        let margin = largest / 50.0;
        Self {
            low: low.map(|x| x - margin),
            size: extent.map(|size| size + 2.0 * margin),
            pen: largest / 400.0,
        }
    }
}
