//! Drawings of points, lines and text in the plane, and their SVG.

use std::fmt::Write;

use super::svg::{escape, num, text_width};
use super::ticks::Scale;
use crate::colour::Rgb;

/// A plane drawing of points, lines, discs and text, y up. It does not depend on
/// pixels; a [`Figure`](super::Figure) gives it a panel.
///
/// Later shapes cover earlier ones. Thicknesses and sizes of dots and letters are shares of the
/// panel's height in thousandths, so they look alike in panels of any scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) bounds: [[f64; 2]; 2],
    pub(super) axes: Option<[Axis; 2]>,
    pub(super) shapes: Vec<(Shape, Pen)>,
}

/// An axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    label: String,
    scale: Scale,
    /// The last coordinate that has a tick.
    last: f64,
}

/// The look of a line or an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// The colour of the line; `None` for an area without outline.
    pub stroke: Option<Rgb>,
    /// Thickness of the line, in thousandths of the panel's height.
    pub width: f64,
    /// Whether the line is dashed.
    pub dashed: bool,
    /// The colour of the area, or of text; `None` for a line.
    pub fill: Option<Rgb>,
    /// The opacity of the area, 0 to 1.
    pub fill_opacity: f64,
}

impl Pen {
    /// A line.
    pub fn line(colour: Rgb, width: f64) -> Self {
        Self { stroke: Some(colour), width, dashed: false, fill: None, fill_opacity: 1.0 }
    }

    /// An area without outline.
    pub fn area(colour: Rgb, opacity: f64) -> Self {
        let fill = Some(colour);
        Self { stroke: None, width: 0.0, dashed: false, fill, fill_opacity: opacity }
    }

    /// Returns this pen with a dashed line.
    #[must_use]
    pub fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// One step along an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Straight to a point.
    Line([f64; 2]),
    /// Along a circle to a point.
    Arc {
        /// The end of the arc.
        to: [f64; 2],
        /// The radius of the circle.
        radius: f64,
        /// Whether the arc turns counter-clockwise.
        counter_clockwise: bool,
        /// Whether the arc is more than half of the circle.
        large: bool,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Path { start: [f64; 2], steps: Vec<Step>, closed: bool },
    Disc { centre: [f64; 2], radius: f64 },
    Dot { at: [f64; 2], size: f64 },
    Text { at: [f64; 2], size: f64, text: String },
}

impl Drawing {
    /// A drawing of the part of the plane between two corners, which keeps its proportions.
    pub fn plane(bounds: [[f64; 2]; 2]) -> Self {
        Self { bounds, axes: None, shapes: Vec::new() }
    }

    /// A chart: x and y are stretched to fill the panel, inside a frame with ticks and these labels
    /// along the axes.
    pub fn chart(bounds: [[f64; 2]; 2], x_label: &str, y_label: &str) -> Self {
        let axis =
            |label: &str| Axis { label: label.into(), scale: Scale::Linear, last: f64::INFINITY };
        Self { bounds, axes: Some([axis(x_label), axis(y_label)]), shapes: Vec::new() }
    }

    /// This chart with ticks of other scales along x and y. Its coordinates, bounds included, are those of the
    /// [scales](Scale::place).
    #[must_use]
    pub fn scales(mut self, scales: [Scale; 2]) -> Self {
        for (axis, scale) in self.axes.iter_mut().flatten().zip(scales) {
            axis.scale = scale;
        }
        self
    }

    /// This chart without ticks of y above a coordinate.
    #[must_use]
    pub(crate) fn last_tick(mut self, y: f64) -> Self {
        if let Some([_, axis]) = &mut self.axes {
            axis.last = y;
        }
        self
    }

    /// A straight line between two points.
    pub fn segment(&mut self, ends: [[f64; 2]; 2], pen: Pen) {
        self.outline(ends[0], vec![Step::Line(ends[1])], false, pen);
    }

    /// Straight lines through points. Fewer than two draw nothing.
    pub fn polyline(&mut self, points: &[[f64; 2]], pen: Pen) {
        self.points(points, false, pen);
    }

    /// The polygon of these corners.
    pub fn polygon(&mut self, corners: &[[f64; 2]], pen: Pen) {
        self.points(corners, true, pen);
    }

    /// Lines and arcs from a starting point, back to it if `closed`.
    pub fn outline(&mut self, start: [f64; 2], steps: Vec<Step>, closed: bool, pen: Pen) {
        self.shapes.push((Shape::Path { start, steps, closed }, pen));
    }

    /// The arc of a circle, counter-clockwise from the direction of one point to that of another,
    /// both on the circle.
    pub fn arc(&mut self, centre: [f64; 2], ends: [[f64; 2]; 2], pen: Pen) {
        let [a, b] = ends.map(|p| [p[0] - centre[0], p[1] - centre[1]]);
        let radius = (a[0] * a[0] + a[1] * a[1]).sqrt();
        let large = a[0] * b[1] - a[1] * b[0] < 0.0;
        let step = Step::Arc { to: ends[1], radius, counter_clockwise: true, large };
        self.outline(ends[0], vec![step], false, pen);
    }

    /// A disc, its radius in the units of the plane.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, pen: Pen) {
        self.shapes.push((Shape::Disc { centre, radius }, pen));
    }

    /// A point, drawn as a dot whose radius is in thousandths of the panel's height.
    pub fn dot(&mut self, at: [f64; 2], size: f64, colour: Rgb) {
        self.shapes.push((Shape::Dot { at, size }, Pen::area(colour, 1.0)));
    }

    /// Text centred on a point; `size` is in thousandths of the panel's height.
    pub fn text(&mut self, at: [f64; 2], size: f64, text: &str, colour: Rgb) {
        self.shapes.push((Shape::Text { at, size, text: text.into() }, Pen::area(colour, 1.0)));
    }

    fn points(&mut self, points: &[[f64; 2]], closed: bool, pen: Pen) {
        if let [start, rest @ ..] = points
            && !rest.is_empty()
        {
            let steps = rest.iter().map(|&p| Step::Line(p)).collect();
            self.outline(*start, steps, closed, pen);
        }
    }
}

impl Drawing {
    /// The ticks of a chart in a panel of this size, and the room that numbers need on its left and right; `None` for a plane. Letters
    /// along axes are no larger than `most_letters`.
    pub(super) fn layout(&self, size: [f64; 2], most_letters: f64) -> Option<Layout> {
        let [x_axis, y_axis] = self.axes.as_ref()?;
        let letters = most_letters.min(size[1] * LETTERS);
        let height = size[1] - (TOP + BOTTOM) * letters;
        let widest = |ticks: &[(f64, String)]| {
            ticks.iter().map(|(_, text)| text_width(text, letters)).fold(0.0, f64::max)
        };
        let y_ticks = y_axis.ticks(self.bounds, 1, (height / (letters * 3.0)) as usize);
        // Numbers, and the label beside them.
        let left = (widest(&y_ticks) + 2.2 * letters).max(4.6 * letters);
        let right = 0.8 * letters;
        let width = size[0] - left - right;
        let columns = |apart: f64| x_axis.ticks(self.bounds, 0, (width / apart) as usize);
        let mut x_ticks = columns(letters * 6.0);
        x_ticks = columns((widest(&x_ticks) + 2.0 * letters).max(letters * 6.0));
        // A part of a number at the end of the axis may be beyond it.
        let [low, high] = self.bounds.map(|corner| corner[0]);
        let beyond = |(at, text): &(f64, String)| {
            text_width(text, letters) / 2.0 - (high - at) / (high - low) * width
        };
        let right = x_ticks.iter().map(beyond).fold(right, f64::max);
        Some(Layout { sides: [left, right], letters, ticks: [x_ticks, y_ticks] })
    }

    /// The drawing as SVG elements in a panel whose upper left corner is at `corner`. `name` must
    /// differ between the drawings of one file. A chart has a [layout](Self::layout).
    pub(super) fn write(
        &self,
        svg: &mut String,
        corner: [f64; 2],
        size: [f64; 2],
        layout: Option<&Layout>,
        name: &str,
    ) {
        let unit = size[1] / 1000.0;
        let Some((axes, Layout { sides: [left, right], letters, ticks })) =
            self.axes.as_ref().zip(layout)
        else {
            let place = PlaneToPanel::new(self.bounds, corner, size, false);
            self.write_shapes(svg, &place, (corner, size), unit, name);
            return;
        };
        let inside = [size[0] - left - right, size[1] - (TOP + BOTTOM) * letters];
        let corner = [corner[0] + left, corner[1] + TOP * letters];
        let place = PlaneToPanel::new(self.bounds, corner, inside, true);
        self.write_shapes(svg, &place, (corner, inside), unit, name);
        write_axes(svg, axes, ticks, self.bounds, &place, (corner, inside), *letters);
    }

    /// Writes the shapes, cut off at the sides of the panel.
    fn write_shapes(
        &self,
        svg: &mut String,
        place: &PlaneToPanel,
        (corner, size): ([f64; 2], [f64; 2]),
        unit: f64,
        name: &str,
    ) {
        let [x, y] = corner.map(num);
        let [w, h] = size.map(num);
        let _ = writeln!(
            svg,
            r#"<clipPath id="{name}"><rect x="{x}" y="{y}" width="{w}" height="{h}"/></clipPath>"#
        );
        let _ = writeln!(svg, r#"<g clip-path="url(#{name})" stroke-linejoin="round">"#);
        for (shape, pen) in &self.shapes {
            write_shape(svg, shape, pen, place, unit);
        }
        svg.push_str("</g>\n");
    }
}

impl Axis {
    /// The ticks of an axis of a chart with these bounds, about as many as this.
    fn ticks(&self, [low, high]: [[f64; 2]; 2], axis: usize, count: usize) -> Vec<(f64, String)> {
        self.scale.ticks(low[axis], high[axis].min(self.last), count.max(2))
    }
}

fn write_axes(
    svg: &mut String,
    [x_axis, y_axis]: &[Axis; 2],
    [x_ticks, y_ticks]: &[Vec<(f64, String)>; 2],
    [low, _]: [[f64; 2]; 2],
    place: &PlaneToPanel,
    (corner, size): ([f64; 2], [f64; 2]),
    letters: f64,
) {
    let (left, bottom) = (corner[0], corner[1] + size[1]);
    let (mark, thin) = (letters * 0.35, num(letters * 0.07));
    let mut lines = format!("M{} {}", num(left), num(corner[1]));
    let _ = write!(lines, "V{}H{}", num(bottom), num(left + size[0]));
    let mut words = String::new();
    let mut word = |x: f64, y: f64, anchor: &str, text: &str| {
        let (x, y, text) = (num(x), num(y), escape(text));
        let _ = writeln!(words, r#"<text x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#);
    };
    for (value, text) in x_ticks {
        let x = place.at([*value, low[1]])[0];
        let _ = write!(lines, "M{} {}v{}", num(x), num(bottom), num(mark));
        word(x, bottom + letters * 1.25, "middle", text);
    }
    let mut beside = letters * 3.6;
    for (value, text) in y_ticks {
        let y = place.at([low[0], *value])[1];
        let _ = write!(lines, "M{} {}h{}", num(left), num(y), num(-mark));
        word(left - mark * 1.6, y + letters * 0.35, "end", text);
        beside = beside.max(text_width(text, letters) + mark * 1.6 + letters * 0.4);
    }
    word(left + size[0] / 2.0, bottom + letters * 2.5, "middle", &x_axis.label);
    let (x, y) = (num(left - beside), num(corner[1] + size[1] / 2.0));
    let text = escape(&y_axis.label);
    let _ = writeln!(
        words,
        r#"<text transform="translate({x} {y}) rotate(-90)" text-anchor="middle">{text}</text>"#
    );
    let _ =
        writeln!(svg, r##"<path d="{lines}" fill="none" stroke="#333" stroke-width="{thin}"/>"##);
    let _ = writeln!(svg, r##"<g font-size="{}" fill="#222">"##, num(letters));
    svg.push_str(&words);
    svg.push_str("</g>\n");
}

/// The ticks of a chart, along x and y, with their labels, and the room on the left and right of it.
pub(super) struct Layout {
    pub sides: [f64; 2],
    letters: f64,
    ticks: [Vec<(f64, String)>; 2],
}

/// The room above and below a chart, in heights of letters along its axes.
const TOP: f64 = 0.6;
const BOTTOM: f64 = 2.8;

/// The greatest height of letters along axes, as a share of the panel's height.
const LETTERS: f64 = 0.034;

/// The map from the plane to the panel.
struct PlaneToPanel {
    scale: [f64; 2],
    shift: [f64; 2],
}

impl PlaneToPanel {
    fn new([low, high]: [[f64; 2]; 2], corner: [f64; 2], size: [f64; 2], stretch: bool) -> Self {
        let extent = [0, 1].map(|k| if high[k] > low[k] { high[k] - low[k] } else { 1.0 });
        let mut scale = [size[0] / extent[0], size[1] / extent[1]];
        if !stretch {
            scale = [scale[0].min(scale[1]); 2];
        }
        let middle = [0, 1].map(|k| f64::midpoint(low[k], high[k]));
        let shift = [
            corner[0] + size[0] / 2.0 - middle[0] * scale[0],
            corner[1] + size[1] / 2.0 + middle[1] * scale[1],
        ];
        Self { scale, shift }
    }

    fn at(&self, p: [f64; 2]) -> [f64; 2] {
        [self.shift[0] + p[0] * self.scale[0], self.shift[1] - p[1] * self.scale[1]]
    }
}

fn write_shape(svg: &mut String, shape: &Shape, pen: &Pen, place: &PlaneToPanel, unit: f64) {
    let look = look(pen, unit);
    let _ = match shape {
        Shape::Path { start, steps, closed } => {
            let [x, y] = place.at(*start).map(num);
            let mut path = format!("M{x} {y}");
            for step in steps {
                write_step(&mut path, step, place);
            }
            let end = if *closed { "Z" } else { "" };
            writeln!(svg, r#"<path d="{path}{end}" {look}/>"#)
        }
        Shape::Disc { centre, radius } => {
            let [x, y] = place.at(*centre).map(num);
            let [rx, ry] = place.scale.map(|s| num(radius * s));
            writeln!(svg, r#"<ellipse cx="{x}" cy="{y}" rx="{rx}" ry="{ry}" {look}/>"#)
        }
        Shape::Dot { at, size } => {
            let [x, y] = place.at(*at).map(num);
            writeln!(svg, r#"<circle cx="{x}" cy="{y}" r="{}" {look}/>"#, num(size * unit))
        }
        Shape::Text { at, size, text } => {
            let [x, y] = place.at(*at);
            let (letters, text) = (size * unit, escape(text));
            let (x, y, size) = (num(x), num(y + letters * 0.35), num(letters));
            writeln!(
                svg,
                r#"<text x="{x}" y="{y}" font-size="{size}" text-anchor="middle" {look}>{text}</text>"#
            )
        }
    };
}

fn write_step(path: &mut String, step: &Step, place: &PlaneToPanel) {
    let _ = match *step {
        Step::Line(to) => {
            let [x, y] = place.at(to).map(num);
            write!(path, "L{x} {y}")
        }
        Step::Arc { to, radius, counter_clockwise, large } => {
            let [x, y] = place.at(to).map(num);
            let [rx, ry] = place.scale.map(|s| num(radius * s));
            // The panel's y points down, which reverses turns.
            let sweep = u8::from(!counter_clockwise);
            write!(path, "A{rx} {ry} 0 {} {sweep} {x} {y}", u8::from(large))
        }
    };
}

fn look(pen: &Pen, unit: f64) -> String {
    let mut look = match pen.fill {
        Some(colour) => format!(r#"fill="{}""#, colour.hex()),
        None => r#"fill="none""#.into(),
    };
    if pen.fill.is_some() && pen.fill_opacity < 1.0 {
        let _ = write!(look, r#" fill-opacity="{}""#, num(pen.fill_opacity));
    }
    if let Some(colour) = pen.stroke {
        let width = pen.width * unit;
        let _ = write!(look, r#" stroke="{}" stroke-width="{}""#, colour.hex(), num(width));
        if pen.dashed {
            let _ =
                write!(look, r#" stroke-dasharray="{} {}""#, num(width * 4.0), num(width * 3.0));
        }
    }
    look
}
