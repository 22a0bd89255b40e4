//! Components and the voids in them, from sums over components and sheets that are accumulated part by part.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};
use walpha_base::Sum;
use walpha_base::parallel::prelude::*;

use super::measure::{facet_area, six_volumes};
use super::{Class, Measures};

/// A connected component of a shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Component {
    /// Number of its vertices.
    pub vertices: usize,
    /// The number of its cells; 0 for a component without solid parts.
    pub cells: usize,
    /// The volume of its cells, in cubed units of the points.
    pub volume: f64,
    /// The area of its regular and singular facets, in squared units of the points.
    pub area: f64,
    /// The area of its regular facets, the boundary of its solid part.
    pub regular_area: f64,
    /// The area of its singular facets, one side of each.
    pub singular_area: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
    /// The voids that its boundary encloses, largest first; `None` if sheets are not known, and on a torus, where a sheet need
    /// not enclose anything ([`AlphaShape::voids`](crate::AlphaShape::voids)).
    pub voids: Option<Vec<Enclosed>>,
    /// On a torus: the number of independent directions in which it winds round. Its box is the box of one of its copies, but the
    /// whole side along axes along which it winds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounds: Option<usize>,
}

/// A void, described by the sheet around it. The volume includes that of other components inside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Enclosed {
    /// The number of the sheet.
    pub sheet: u32,
    /// The volume enclosed by the sheet, in cubed units of the points.
    pub volume: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
}

/// Sums over a component, or over a part of one. Parts are [joined](Self::join) in any order, with the same result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComponentSums {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of cells.
    pub cells: usize,
    six_volumes: Sum,
    regular_area: Sum,
    singular_area: Sum,
    low: [f64; 3],
    high: [f64; 3],
}

/// The sum of two.
fn joined(a: &Sum, b: &Sum) -> Sum {
    let mut sum = a.clone();
    sum.join(b);
    sum
}

impl ComponentSums {
    /// A component of one vertex.
    pub fn at(point: [f64; 3]) -> Self {
        Self {
            vertices: 1,
            cells: 0,
            six_volumes: Sum::default(),
            regular_area: Sum::default(),
            singular_area: Sum::default(),
            low: point,
            high: point,
        }
    }

    /// Adds a vertex.
    pub fn add_vertex(&mut self, point: [f64; 3]) {
        self.vertices += 1;
        widen(&mut self.low, &mut self.high, point);
    }

    /// Adds a cell of the shape.
    pub fn add_cell(&mut self, corners: [[f64; 3]; 4]) {
        self.cells += 1;
        self.six_volumes.add(six_volumes(corners));
    }

    /// Adds a facet, if it is regular or singular.
    pub fn add_facet(&mut self, corners: [[f64; 3]; 3], class: Class) {
        match class {
            Class::Regular => self.regular_area.add(facet_area(corners)),
            Class::Singular => self.singular_area.add(facet_area(corners)),
            _ => {}
        }
    }

    /// Adds another part.
    pub fn join(&mut self, other: &Self) {
        self.vertices += other.vertices;
        self.cells += other.cells;
        self.six_volumes.join(&other.six_volumes);
        self.regular_area.join(&other.regular_area);
        self.singular_area.join(&other.singular_area);
        enclose(&mut self.low, &mut self.high, other.low, other.high);
    }

    /// The measures of all components together, which are those of the shape.
    pub fn measures<'a>(all: impl Iterator<Item = &'a Self> + Clone) -> Measures {
        let sum = |of: fn(&Self) -> &Sum| {
            let mut sum = Sum::default();
            all.clone().for_each(|sums| sum.join(of(sums)));
            sum
        };
        let (regular, singular) = (sum(|sums| &sums.regular_area), sum(|sums| &sums.singular_area));
        Measures {
            volume: sum(|sums| &sums.six_volumes).value() / 6.0,
            area: joined(&regular, &singular).value(),
            regular_area: regular.value(),
            singular_area: singular.value(),
        }
    }

    fn component(&self) -> Component {
        let &Self { vertices, cells, low, high, .. } = self;
        Component {
            vertices,
            cells,
            // Divided last: on a lattice, determinants and their sums are integers.
            volume: self.six_volumes.value() / 6.0,
            area: joined(&self.regular_area, &self.singular_area).value(),
            regular_area: self.regular_area.value(),
            singular_area: self.singular_area.value(),
            low,
            high,
            voids: None,
            rounds: None,
        }
    }
}

/// A component without vertices.
impl Default for ComponentSums {
    fn default() -> Self {
        Self { vertices: 0, low: [f64::MAX; 3], high: [f64::MIN; 3], ..Self::at([0.0; 3]) }
    }
}

/// Sums over rows by number (of a component, or of a sheet), on all threads. For each range of rows, returns the sums of the
/// numbers that occur in it. The caller joins them; the result does not depend on the ranges. `add` adds a row, given by its
/// index.
pub(crate) fn by_number<S: Default + Send>(
    rows: usize,
    add: impl Fn(usize, &mut ByNumber<S>) + Sync,
) -> Vec<HashMap<u32, S>> {
    /// The number of rows that are worth a task.
    const RANGE: usize = 1 << 15;
    let range = |first: usize| {
        let mut sums = ByNumber { last: None, others: HashMap::new() };
        (first..rows.min(first + RANGE)).for_each(|row| add(row, &mut sums));
        sums.finish()
    };
    (0..rows).into_par_iter().step_by(RANGE).map(range).collect()
}

/// Sums by number. Most rows have the number of the row before, whose sums are kept ready.
pub(crate) struct ByNumber<S> {
    last: Option<(u32, S)>,
    others: HashMap<u32, S>,
}

impl<S: Default + Send> ByNumber<S> {
    /// The sums of a number.
    pub(crate) fn of(&mut self, number: u32) -> &mut S {
        if self.last.as_ref().is_none_or(|(last, _)| *last != number) {
            let next = self.others.remove(&number).unwrap_or_default();
            self.others.extend(self.last.replace((number, next)));
        }
        &mut self.last.as_mut().expect("it was just set").1
    }

    fn finish(mut self) -> HashMap<u32, S> {
        self.others.extend(self.last);
        self.others
    }
}

/// Sums over the sides of facets on one sheet, or over some of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SheetSums {
    six_volumes: Sum,
    low: [f64; 3],
    high: [f64; 3],
}

impl Default for SheetSums {
    fn default() -> Self {
        let (low, high) = ([f64::MAX; 3], [f64::MIN; 3]);
        Self { six_volumes: Sum::default(), low, high }
    }
}

impl SheetSums {
    /// Adds a side of a facet, whose corners turn counter-clockwise seen from outside the shape. `apex` is the same for
    /// all sides: the signed volumes of the cones from it over a closed sheet sum to the volume inside.
    pub fn add(&mut self, apex: [f64; 3], corners: [[f64; 3]; 3]) {
        let [a, b, c] = corners;
        self.six_volumes.add(-six_volumes([apex, a, b, c]));
        corners.iter().for_each(|&corner| widen(&mut self.low, &mut self.high, corner));
    }

    /// Adds other sides of the same sheet.
    pub fn join(&mut self, other: &Self) {
        self.six_volumes.join(&other.six_volumes);
        enclose(&mut self.low, &mut self.high, other.low, other.high);
    }

    fn enclosed(self, sheet: u32) -> Enclosed {
        let Self { six_volumes, low, high } = self;
        Enclosed { sheet, volume: six_volumes.value() / 6.0, low, high }
    }
}

/// Components from their sums, with the voids that their sheets enclose. Each sheet is given with its number, its
/// component and its sums, in ascending order.
pub fn components_of_sums(
    components: &[ComponentSums],
    sheets: Option<Vec<(u32, usize, SheetSums)>>,
) -> Vec<Component> {
    let mut components: Vec<Component> = components.iter().map(ComponentSums::component).collect();
    let Some(sheets) = sheets else { return components };
    components.iter_mut().for_each(|component| component.voids = Some(Vec::new()));
    let enclosed =
        |(sheet, component, sums): (u32, usize, SheetSums)| (component, sums.enclosed(sheet));
    let mut found: Vec<(usize, Enclosed)> = sheets.into_iter().map(enclosed).collect();
    // The outer sheet of a component encloses minus the volume of the component and its voids: the smallest value, so it is the
    // first.
    found.sort_by(|(a, first), (b, second)| a.cmp(b).then(first.volume.total_cmp(&second.volume)));
    let voids = found.chunk_by(|a, b| a.0 == b.0).flat_map(|of_one| of_one[1..].iter().rev());
    for &(component, void) in voids {
        components[component].voids.get_or_insert_default().push(void);
    }
    components
}

/// Widens a box so that it contains a point.
fn widen(low: &mut [f64; 3], high: &mut [f64; 3], point: [f64; 3]) {
    enclose(low, high, point, point);
}

/// Widens a box so that it contains another box, which may be empty: the low corner is then above the high one.
fn enclose(low: &mut [f64; 3], high: &mut [f64; 3], other_low: [f64; 3], other_high: [f64; 3]) {
    for k in 0..3 {
        low[k] = low[k].min(other_low[k]);
        high[k] = high[k].max(other_high[k]);
    }
}
