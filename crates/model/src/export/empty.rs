use walpha_base::Monitor;
use walpha_base::advice::{Advice, Advise, Setting, advice};
use walpha_base::shown::number;

use crate::pipeline::Parameter;
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, AlphaShape, Balls, Class, Complex, ShapeOptions, alpha_shape};
use walpha_volume::annotation;

/// What a shape must have for its file not to be empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Needs {
    /// Any simplex: formats of whole complexes.
    Simplex,
    /// A facet, or an edge if all points lie on one line: formats of the boundary that have edges.
    FacetOrLine,
    /// A facet: formats of facets, and of outlines.
    Facet,
    /// A regular facet: solids.
    RegularFacet,
}

impl Needs {
    /// Whether a shape has what is needed.
    pub fn met_by(self, shape: &AlphaShape) -> bool {
        let Complex { vertices, edges, facets, .. } = shape.complex();
        let has_facet = || facets.classes().iter().any(|&class| class != Class::Exterior);
        match self {
            // If exterior simplices are listed, the file is that of the triangulation.
            Self::Simplex => !vertices.is_empty(),
            Self::FacetOrLine => {
                let has_edge = || edges.classes().iter().any(|&class| class != Class::Exterior);
                has_facet() || has_edge() && Extent::of(shape) == Extent::Line
            }
            Self::Facet => has_facet(),
            Self::RegularFacet => facets.of(Class::Regular).next().is_some(),
        }
    }

    fn name(self, extent: Extent) -> &'static str {
        match self {
            Self::Simplex => "simplex",
            Self::FacetOrLine if extent == Extent::Line => "edge",
            Self::FacetOrLine | Self::Facet => "facet",
            Self::RegularFacet => "regular facet",
        }
    }
}

/// The error for a shape whose file would be empty.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the shape has no {} {}", needs.name(*extent), self.cause())]
#[non_exhaustive]
pub struct EmptyShape {
    /// What the file needs.
    pub needs: Needs,
    /// The α of the shape.
    pub alpha: Alpha,
    /// The parameter at which a shape of the same points has what is needed, rounded up: √α, or α with [`Balls::Radius`]. `None`
    /// if no such parameter is known.
    pub suggested: Option<f64>,
    balls: Balls,
    extent: Extent,
}

/// The extent of the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extent {
    Place,
    Line,
    Plane,
    Space,
}

impl Extent {
    fn of(shape: &AlphaShape) -> Self {
        match shape.dimension() {
            0 => Self::Place,
            1 => Self::Line,
            2 => Self::Plane,
            _ => Self::Space,
        }
    }
}

impl EmptyShape {
    /// Refuses a shape that lacks what a file needs. The error suggests a radius at which the shape would have it: the one from
    /// the spacing of the points, if a test shows that it is enough, or else the smallest at which all points are in one solid
    /// component.
    ///
    /// # Errors
    /// [`EmptyShape`].
    pub fn check(shape: &AlphaShape, needs: Needs) -> Result<(), Self> {
        if needs.met_by(shape) {
            return Ok(());
        }
        let ShapeOptions { alpha, balls, .. } = *shape.options();
        let extent = Extent::of(shape);
        let mut empty = Self { needs, alpha, suggested: None, balls, extent };
        if empty.can_have_it() {
            empty.suggested = Monitor::current().unreported().watch(|| suggested(shape, needs));
        }
        Err(empty)
    }

    /// Whether a shape of the same points has what is needed at some α.
    fn can_have_it(&self) -> bool {
        match (self.extent, self.needs) {
            (Extent::Space, _) | (_, Needs::Simplex) => true,
            (Extent::Plane, needs) => needs != Needs::RegularFacet,
            (Extent::Line, needs) => needs == Needs::FacetOrLine,
            (Extent::Place, _) => false,
        }
    }

    fn cause(&self) -> String {
        match self.extent {
            _ if self.can_have_it() => format!("at α = {}", annotation::described(self.alpha)),
            Extent::Place => "at any α, as its points are at one place".into(),
            Extent::Line => "at any α, as its points lie on one line".into(),
            _ => "at any α, as its points lie in one plane, where no facet bounds a volume".into(),
        }
    }
}

impl Advise for EmptyShape {
    fn advice(&self) -> Option<Advice> {
        Some(match self.suggested {
            None if !self.can_have_it() => match self.extent {
                Extent::Place | Extent::Line => {
                    "write a format that has vertices and edges, as VTU does".into()
                }
                _ => "write a format that has singular facets, as PLY does".into(),
            },
            None => "give a larger α".into(),
            Some(suggested) => {
                let setting =
                    if self.balls == Balls::Radius { Setting::Alpha } else { Setting::AlphaRadius };
                advice!["give a larger α, as in ", setting, format!(" {}", number(suggested))]
            }
        })
    }
}

/// The parameter at which a shape of the same points has what a file needs.
fn suggested(shape: &AlphaShape, needs: Needs) -> Option<f64> {
    let options = *shape.options();
    let points = shape.points();
    let spacing = || {
        let unit = shape.coordinates().unit;
        Some(Parameter::of_spacing(points, options.periodic, unit).ok()?.alpha)
    };
    let connected = || Some(Filtration::on(options.periodic, points.clone()).ok()?.one_region());
    let rules: [&dyn Fn() -> Option<Alpha>; 2] = [&spacing, &connected];
    rules.into_iter().find_map(|rule| {
        let parameter = three_digits_up(rule()?.radius()?);
        let alpha = match options.balls {
            Balls::Power => Alpha::from_radius(parameter),
            Balls::Radius => Alpha::from_squared(parameter),
        };
        let mut larger = options;
        larger.alpha = alpha.ok()?;
        let larger = alpha_shape(points.clone(), &larger).ok()?;
        needs.met_by(&larger).then_some(parameter)
    })
}

/// A number rounded up to three significant digits.
fn three_digits_up(number: f64) -> f64 {
    let rounded = |number: f64| format!("{number:.2e}").parse().unwrap_or(number);
    match rounded(number) {
        up if up >= number => up,
        // This adds a little more than half a unit of the third digit.
        _ => rounded(number + 0.500_01 * 10f64.powf(number.log10().floor() - 2.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(positions: Vec<[f64; 3]>, alpha: f64) -> AlphaShape {
        let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
        alpha_shape(walpha_shape::WeightedPoints::unweighted(positions), &options).unwrap()
    }

    fn refused(shape: &AlphaShape, needs: Needs) -> (String, String) {
        let error = EmptyShape::check(shape, needs).unwrap_err();
        (error.to_string(), error.advice().unwrap().to_string())
    }

    /// At the suggested radius the shape has what is needed, and the radius is not larger than rounding requires.
    #[test]
    fn a_radius_is_suggested_that_does_it() {
        let cube: Vec<[f64; 3]> =
            (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
        // Points along a curve have all neighbours before and behind them, so that the radius from their spacing yields only
        // edges.
        let curve: Vec<[f64; 3]> = (0..60)
            .map(|i| f64::from(i) / 10.0)
            .map(|t| [50.0 * t.cos(), 50.0 * t.sin(), 3.0 * t])
            .collect();
        for points in [cube, curve] {
            for (alpha, needs) in [
                (-3.0, Needs::Simplex),
                (0.001, Needs::FacetOrLine),
                (0.001, Needs::Facet),
                (0.001, Needs::RegularFacet),
            ] {
                let nothing = shape(points.clone(), alpha);
                let error = EmptyShape::check(&nothing, needs).unwrap_err();
                let radius = error.suggested.expect("a radius is known");
                let larger = shape(points.clone(), radius * radius);
                assert!(needs.met_by(&larger), "{needs:?}: {radius}");
                assert!(error.advice().unwrap().to_string().contains("`alpha_radius`"));
            }
        }
    }

    #[test]
    fn flat_points_are_told_of_their_kind() {
        let line: Vec<[f64; 3]> = (0..5).map(|i| [f64::from(i), 1.0, 2.0]).collect();
        let stick = shape(line.clone(), 1.0);
        assert!(Needs::FacetOrLine.met_by(&stick), "edges are all that a line can have");
        let (why, next) = refused(&stick, Needs::Facet);
        assert!(why.contains("no facet at any α, as its points lie on one line"), "{why}");
        assert!(next.contains("VTU"), "{next}");
        let (why, next) = refused(&shape(line, 0.1), Needs::FacetOrLine);
        assert!(why.contains("no edge at α = 0.1"), "{why}");
        assert!(next.contains("`alpha_radius`"), "{next}");
        let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let plane = shape(square, 1.0);
        assert!(Needs::Facet.met_by(&plane));
        let (why, next) = refused(&plane, Needs::RegularFacet);
        assert!(why.contains("lie in one plane"), "{why}");
        assert!(next.contains("singular facets"), "{next}");
    }

    #[test]
    fn numbers_are_rounded_up() {
        let up = [1.0, 1.001, 2.344_9, 9.999, 0.001_231, 1e300, 0.0].map(three_digits_up);
        assert_eq!(up, [1.0, 1.01, 2.35, 10.0, 0.001_24, 1e300, 0.0]);
    }
}
