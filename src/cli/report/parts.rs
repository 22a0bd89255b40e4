//! The parts of a report: input, wavelet stage, points, weights, shape.

use std::fmt::{self, Display};

use serde::Serialize;
use walpha_base::shown::{grouped, rounded, six_digits};

use super::measure;
use super::plane::PlaneReport;
use crate::balls::{BallUnion, BallsError};
use crate::cli::process::output::name;
use crate::outofcore::Merged;
use crate::pipeline::{Model, Weighed};
use crate::points::WeightSummary;
use crate::shape::{Betti, ByClass, Component, Void};
use crate::{AlphaShape, GrayRange, LengthUnit, Truncation, Weighting};

#[derive(Serialize)]
pub(super) struct InputReport {
    pub(super) name: String,
    /// The number of samples along x, y and z; null for points.
    pub(super) dims: Option<[usize; 3]>,
    /// The values that became gray 0 and 255; null for points.
    pub(super) gray_range: Option<[f64; 2]>,
}

#[derive(Serialize)]
pub(in crate::cli) struct HaarReport {
    pub(super) kept: u64,
    pub(super) total: u64,
    /// The error in gray levels.
    pub(super) epsilon: f64,
    pub(super) rms: f64,
    /// The error in values of the input; null if these are gray levels.
    pub(super) rms_in_values: Option<f64>,
}

#[derive(Serialize)]
pub(super) struct PointsReport {
    pub(super) selected: usize,
    pub(super) duplicates: Option<usize>,
    /// The number of points outside the periodic box that were moved into it; absent without a box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) folded: Option<usize>,
    pub(super) hidden: Option<usize>,
    pub(super) in_shape: Option<usize>,
    /// Set if adaptive selection needed fewer points than requested.
    pub(super) ended_early: Option<EndedEarly>,
}

impl PointsReport {
    /// The report on a number of points of which nothing else is known.
    pub(super) fn new(selected: usize) -> Self {
        Self {
            selected,
            duplicates: None,
            folded: None,
            hidden: None,
            in_shape: None,
            ended_early: None,
        }
    }
}

/// The reason why there are fewer points than requested.
#[derive(Clone, Copy, Serialize)]
pub(super) struct EndedEarly {
    pub(super) asked: u64,
    /// The RMSE that was sufficient; 0 if only a perfect interpolant is.
    pub(super) rmse: f64,
    /// The bound on the largest error, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max_error: Option<f64>,
}

impl Display for EndedEarly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { asked, rmse, max_error } = self;
        write!(f, "fewer than {asked}: ")?;
        if let Some(bound) = max_error {
            return write!(
                f,
                "no sample is further than {bound} gray levels from the interpolant of these"
            );
        }
        match *rmse {
            0.0 => write!(f, "no sample differs from the interpolant of these any more"),
            rmse => write!(f, "these reach an RMSE of {rmse} gray levels"),
        }
    }
}

/// The kind and range of the weights.
#[derive(Serialize)]
pub(in crate::cli) struct WeightsReport {
    pub(super) kind: String,
    /// Whether the weights are squares of radii, which the input has instead of weights.
    pub(super) of_radii: bool,
    pub(super) min: f64,
    pub(super) mean: f64,
    pub(super) max: f64,
    /// The unit of length; weights are in its square.
    pub(super) unit: LengthUnit,
}

impl WeightsReport {
    /// The kind and range of the weights of points.
    pub(in crate::cli) fn of(weighed: &Weighed) -> Self {
        let WeightSummary { min, mean, max } = weighed.points.summary();
        let origin = weighed.origin;
        let (kind, unit) = (origin.weighting.to_string(), origin.coordinates.unit);
        let of_radii = origin.of_radii && origin.weighting == Weighting::Column;
        Self { kind, of_radii, min, mean, max, unit }
    }
}

impl WeightsReport {
    /// Whether any weight differs from 0.
    pub(super) fn are_there(&self) -> bool {
        self.min != 0.0 || self.max != 0.0
    }
}

impl Display for WeightsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, of_radii, min, mean, max, unit } = self;
        let squares = if *of_radii { ", squares of its radii" } else { "" };
        let [min, mean, max] = [min, mean, max].map(|weight| rounded(*weight));
        let unit = unit.symbol();
        write!(f, "{kind}{squares}: {min} to {max} {unit}², mean {mean} {unit}²")
    }
}

impl HaarReport {
    /// The report on a truncation; the values `range` became gray 0..255.
    pub(in crate::cli) fn new(t: &Truncation, range: &GrayRange) -> Self {
        let rms_in_values = (!range.is_identity()).then(|| t.rms * range.step());
        Self { kept: t.kept, total: t.total, epsilon: t.epsilon, rms: t.rms, rms_in_values }
    }
}

impl Display for HaarReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kept, total, epsilon, rms, rms_in_values } = self;
        let [epsilon, rms] = [epsilon, rms].map(|error| rounded(*error));
        write!(f, "{kept} of {total} coefficients kept, ε = {epsilon}, rms {rms} gray levels")?;
        match rms_in_values {
            Some(rms) => write!(f, " ({} in values)", rounded(*rms)),
            None => Ok(()),
        }
    }
}

impl Display for InputReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", name(&self.name))?;
        if let Some([x, y, z]) = self.dims {
            write!(f, ", {x}×{y}×{z} samples")?;
        }
        if let (Some(_), Some([low, high]), true) = (self.dims, self.gray_range, f.alternate()) {
            let (low, high) = (rounded(low), rounded(high));
            write!(f, ", values {low}..{high} are gray 0..255")?;
        }
        Ok(())
    }
}

impl Display for PointsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} selected", grouped(self.selected as u64))?;
        let in_shape = self.in_shape.filter(|&count| count < self.selected || f.alternate());
        // Without `-v`, what there is none of is left out.
        let some = |count: Option<usize>| count.filter(|&count| count > 0 || f.alternate());
        let counts = [
            (some(self.duplicates), "duplicates"),
            (some(self.hidden), "hidden"),
            (in_shape, "in the shape"),
        ];
        for (count, what) in counts {
            if let Some(count) = count {
                write!(f, ", {} {what}", grouped(count as u64))?;
            }
        }
        MovedIntoBox(self.folded).fmt(f)
    }
}

/// Displays the number of points moved into a periodic box, as text after other counts; empty if none were moved.
pub(in crate::cli) struct MovedIntoBox(pub Option<usize>);

impl Display for MovedIntoBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            None | Some(0) => Ok(()),
            Some(count) => write!(f, ", {count} outside of the periodic box, moved into it"),
        }
    }
}

#[derive(Serialize)]
pub(super) struct ShapeReport {
    pub(super) cells: Cells,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) facets: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) edges: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) vertices: ByClass<usize>,
    pub(super) betti: Option<Betti>,
    pub(super) volume: f64,
    pub(super) area: f64,
    pub(super) regular_area: f64,
    pub(super) singular_area: f64,
    /// The number of points of the shape outside its largest component, by points.
    pub(super) apart: usize,
    /// Absent unless the points lie in one plane; all other fields have the classes and sizes in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) plane: Option<PlaneReport>,
    /// The largest components by volume, each with the voids that its boundary encloses.
    pub(super) components: Vec<Component>,
    /// Null unless exterior simplices are kept.
    pub(super) voids: Option<Vec<Void>>,
}

#[derive(Serialize)]
pub(super) struct Cells {
    pub(super) interior: usize,
}

/// Displays the counts of the simplices of one dimension, as a line.
pub(super) struct Line<'a>(pub &'a ByClass<usize>);

impl Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ByClass { interior, regular, singular, .. } = self.0;
        write!(f, "{interior:>9} interior {regular:>9} regular {singular:>9} singular")
    }
}

impl ShapeReport {
    /// The report on a shape.
    pub(super) fn of(shape: &AlphaShape) -> Self {
        let complex = shape.complex();
        let components = shape.components();
        Self {
            apart: apart(&components),
            cells: Cells { interior: complex.cells.counts().interior },
            facets: complex.facets.counts(),
            edges: complex.edges.counts(),
            vertices: complex.vertices.counts(),
            betti: shape.betti(),
            volume: shape.measures().volume,
            area: shape.measures().area,
            regular_area: shape.measures().regular_area,
            singular_area: shape.measures().singular_area,
            plane: PlaneReport::of(shape),
            components: largest(components),
            voids: shape.voids(),
        }
    }

    /// The report on a shape that was made in blocks.
    pub(super) fn of_blocks(merged: &Merged) -> Self {
        Self {
            apart: apart(&merged.components),
            cells: Cells { interior: merged.cells },
            facets: merged.facets,
            edges: merged.edges,
            vertices: merged.vertices,
            betti: Some(merged.betti),
            volume: merged.measures.volume,
            area: merged.measures.area,
            regular_area: merged.measures.regular_area,
            singular_area: merged.measures.singular_area,
            plane: None,
            components: largest(merged.components.clone()),
            voids: None,
        }
    }

    /// Prints the numbers of simplices by their classes in space.
    fn print_classes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "cells     {:>9} interior", self.cells.interior)?;
        writeln!(f, "facets    {}", Line(&self.facets))?;
        writeln!(f, "edges     {}", Line(&self.edges))?;
        writeln!(f, "vertices  {}", Line(&self.vertices))
    }

    /// Prints the topology and sizes of the shape and of the balls that it is of, and what hangs loose.
    pub(super) fn print(
        &self,
        f: &mut fmt::Formatter<'_>,
        unit: LengthUnit,
        balls: Option<&BallsReport>,
    ) -> fmt::Result {
        let betti = self.betti.map(|betti| format!("{betti}; ")).unwrap_or_default();
        let (loose, whole) = if let Some(plane) = &self.plane {
            writeln!(f, "shape     {betti}in a plane: {}", plane.sizes(unit))?;
            (plane.loose(), "triangle")
        } else {
            let [volume, area] = [measure(self.volume, unit, 3), measure(self.area, unit, 2)];
            let of = if balls.is_some() { " of tetrahedra" } else { "" };
            writeln!(f, "shape     {betti}volume {volume}{of}, surface {area}")?;
            balls.map_or(Ok(()), |balls| balls.print(f, unit))?;
            let area = (self.singular_area > 0.0).then(|| measure(self.singular_area, unit, 2));
            let area = area.map(|area| format!(" ({area})")).unwrap_or_default();
            let singular = [&self.facets, &self.edges, &self.vertices].map(|one| one.singular);
            (loose(singular, &area), "cell")
        };
        if let Some(loose) = loose {
            writeln!(f, "loose     {loose}: part of no {whole}")?;
        }
        self.print_largest(f, unit)
    }

    /// Prints the largest component, if there are several, and the voids, if they are known.
    fn print_largest(&self, f: &mut fmt::Formatter<'_>, unit: LengthUnit) -> fmt::Result {
        if let ([largest, _, ..], None) = (&self.components[..], &self.plane) {
            let Component { vertices, volume, .. } = largest;
            let noun = if *vertices == 1 { "vertex" } else { "vertices" };
            let (vertices, volume) = (grouped(*vertices as u64), measure(*volume, unit, 3));
            writeln!(f, "largest   component: {vertices} {noun}, volume {volume}")?;
        }
        if let Some(voids) = &self.voids
            && let Some(largest) = voids.first()
        {
            let sum = voids.iter().fold(0.0, |sum, void| sum + void.volume);
            let Void { volume, filling_alpha, .. } = largest;
            let [sum, volume] = [sum, *volume].map(|volume| measure(volume, unit, 3));
            let alpha = rounded(filling_alpha.squared());
            writeln!(
                f,
                "voids     {sum} in all, the largest {volume}, filled at α = {alpha} {}²",
                unit.symbol()
            )?;
        }
        Ok(())
    }

    /// Prints all numbers of the shape, and those of the balls that it is of.
    pub(super) fn print_all(
        &self,
        f: &mut fmt::Formatter<'_>,
        unit: LengthUnit,
        balls: Option<&BallsReport>,
    ) -> fmt::Result {
        match &self.plane {
            Some(plane) => plane.print_classes(f)?,
            None => self.print_classes(f)?,
        }
        if let Some(betti) = self.betti {
            writeln!(f, "topology  {betti}")?;
        }
        if let Some(plane) = &self.plane {
            return writeln!(f, "outline   {}", plane.sizes(unit));
        }
        let of = if balls.is_some() { " of tetrahedra" } else { "" };
        writeln!(f, "volume    {} {}³{of}", rounded(self.volume), unit.symbol())?;
        let [area, regular, singular] =
            [self.area, self.regular_area, self.singular_area].map(rounded);
        let squared = format!("{}²", unit.symbol());
        write!(f, "area      {area} {squared}")?;
        if self.singular_area > 0.0 {
            write!(
                f,
                ": regular facets {regular} {squared}, singular facets {singular} {squared}"
            )?;
        }
        writeln!(f)?;
        balls.map_or(Ok(()), |balls| balls.print(f, unit))?;
        self.print_largest(f, unit)
    }
}

/// The union of the balls of a shape whose points have radii. The true numbers are within the bounds.
#[derive(Serialize)]
pub(super) struct BallsReport {
    volume: f64,
    volume_bound: f64,
    area: f64,
    area_bound: f64,
}

impl BallsReport {
    /// `None` if the points have no radii, lie in one plane, or are only kept in part: then there is no union of balls that belongs to the shape.
    pub(super) fn of(model: &Model) -> Result<Option<Self>, BallsError> {
        let Model { shape, origin, .. } = model;
        let is_of_balls = origin.of_radii && origin.weighting == Weighting::Column;
        let is_whole = shape.kept().is_none() && PlaneReport::of(shape).is_none();
        if !is_of_balls || !is_whole || shape.power_alpha().squared() == f64::INFINITY {
            return Ok(None);
        }
        let union = BallUnion::new(shape)?;
        let [volume, area] = [union.volume(), union.area()];
        Ok(Some(Self {
            volume: volume.value,
            volume_bound: volume.bound,
            area: area.value,
            area_bound: area.bound,
        }))
    }

    fn print(&self, f: &mut fmt::Formatter<'_>, unit: LengthUnit) -> fmt::Result {
        let Self { volume, volume_bound, area, area_bound } = *self;
        let (volume, area) = (certain(volume, volume_bound), certain(area, area_bound));
        let unit = unit.symbol();
        writeln!(f, "balls     volume {volume} {unit}³, area {area} {unit}²")
    }
}

/// A number with six significant digits, or with fewer where its bound leaves these alone certain.
pub(in crate::cli) fn certain(value: f64, bound: f64) -> String {
    if !bound.is_finite() {
        return "not known".into();
    }
    let value = six_digits(value);
    let digits_before = if value == 0.0 { 1 } else { value.abs().log10().floor() as i32 + 1 };
    let certain = if bound > 0.0 { (-(2.0 * bound).log10()).floor() as i32 } else { i32::MAX };
    let decimals = certain.min(6 - digits_before).max(0);
    if digits_before > -3 {
        return format!("{value:.*}", decimals as usize);
    }
    // As many digits, with an exponent.
    match decimals + digits_before {
        ..=0 => "0".into(),
        digits => rounded(format!("{value:.*e}", digits as usize - 1).parse().unwrap_or(value)),
    }
}

/// The facets (of this area), edges and vertices that hang loose, as a list; `None` if there are none.
pub(super) fn loose([facets, edges, vertices]: [usize; 3], area: &str) -> Option<String> {
    let named = |count: usize, one: &str, more: &str| {
        (count > 0)
            .then(|| format!("{} {}", grouped(count as u64), if count == 1 { one } else { more }))
    };
    let facets = named(facets, "triangle", "triangles").map(|facets| facets + area);
    let parts = [facets, named(edges, "edge", "edges"), named(vertices, "point", "points")];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// The number of points outside the largest component, by points.
fn apart(components: &[Component]) -> usize {
    let sizes = components.iter().map(|component| component.vertices);
    sizes.clone().sum::<usize>() - sizes.max().unwrap_or_default()
}

/// The largest number of components listed.
const MAX_LISTED: usize = 20;

fn largest(mut components: Vec<Component>) -> Vec<Component> {
    components.sort_by(|a, b| b.volume.total_cmp(&a.volume).then(b.vertices.cmp(&a.vertices)));
    components.truncate(MAX_LISTED);
    components
}
