use crate::pixels::Rgb;

/// A plane drawing of points, lines, discs and text, y up. It does not depend on
/// pixels; a [`Figure`](super::Figure) gives it a panel.
///
/// Later shapes cover earlier ones. Thicknesses and sizes of dots and letters are shares of the
/// panel's height in thousandths, so they look alike in panels of any scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) bounds: [[f64; 2]; 2],
    pub(super) axes: Option<[String; 2]>,
    pub(super) shapes: Vec<(Shape, Pen)>,
}

/// How a line or an area is drawn.
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

    /// The same pen, with a dashed line.
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
        /// Where the arc ends.
        to: [f64; 2],
        /// The radius of the circle.
        radius: f64,
        /// Whether the way there turns counter-clockwise.
        counter_clockwise: bool,
        /// Whether it is more than half of the circle.
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
        Self { bounds, axes: Some([x_label.into(), y_label.into()]), shapes: Vec::new() }
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

    /// Text centred on a point, their size in thousandths of the panel's height.
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
