//! Components of a shape, and the sheets of its boundary.

use serde::{Deserialize, Serialize};

use super::blocks::Answer;
use super::union_find::UnionFind;
use super::{AlphaShape, Class, Complex, Measures, facet_area, six_volumes};
use crate::math::Sum;

/// The sheets of a shape's boundary: the connected pieces of its outside seen closely. A component
/// has one around it and one for each of its voids. They are numbered from 0 in the order in which
/// they appear along the boundary facets, then the singular edges; isolated points, each a sheet of
/// its own, have no number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheets {
    /// For each regular facet, in their order, the sheet it is part of.
    pub regular: Vec<u32>,
    /// For each singular facet, in their order, the sheet seen from which its sorted row turns
    /// clockwise, and that on the other side.
    pub singular: Vec<[u32; 2]>,
    /// For each singular edge, in their order, the sheet around it.
    pub edges: Vec<u32>,
    /// How many there are.
    pub count: u32,
}

impl Sheets {
    /// Gives the sheets of blocks numbers that do not depend on the blocks. O(n).
    pub(super) fn of(answer: &Answer) -> Self {
        const NONE: u32 = u32::MAX;
        let raw = answer.facet_sheets.iter().chain(&answer.edge_sheets);
        let mut numbers = vec![NONE; raw.clone().max().map_or(0, |&most| most as usize + 1)];
        let mut count = 0;
        let mut names = raw.map(|&name| {
            let number = &mut numbers[name as usize];
            if *number == NONE {
                *number = count;
                count += 1;
            }
            *number
        });
        let mut next = || names.next().expect("a name for each side of the boundary");
        let (mut regular, mut singular) = (Vec::new(), Vec::new());
        for class in answer.complex.facets.classes() {
            match class {
                Class::Regular => regular.push(next()),
                Class::Singular => singular.push([next(), next()]),
                _ => {}
            }
        }
        let edges = names.collect();
        Self { regular, singular, edges, count }
    }
}

impl Sheets {
    /// The number that files have where there is no sheet.
    pub const NONE: i32 = -1;

    /// For each regular and then each singular facet the sheet in front of it, seen from which its
    /// row turns counter-clockwise, and that behind it: [`Sheets::NONE`] where the shape is solid.
    pub fn sides(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        let regular = self.regular.iter().map(|&front| [front as i32, Self::NONE]);
        regular.chain(self.singular.iter().map(|&[behind, front]| [front as i32, behind as i32]))
    }
}

/// A connected component of a shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Component {
    /// Its vertices.
    pub vertices: usize,
    /// Its cells; 0 for one that is nowhere solid.
    pub cells: usize,
    /// The volume of its cells, in cubed units of the points.
    pub volume: f64,
    /// The area of its regular facets, the boundary of its solid part.
    pub area: f64,
    /// The area of its singular facets, one side of each.
    pub singular_area: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
    /// What its boundary encloses, largest first; `None` where sheets are not known.
    pub voids: Option<Vec<Enclosed>>,
}

/// A void by the sheet around it. Another component may float in it: its volume counts here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Enclosed {
    /// The number of the sheet.
    pub sheet: u32,
    /// What the sheet encloses, in cubed units of the points.
    pub volume: f64,
    /// The smallest coordinates of its box, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates of its box, (x, y, z).
    pub high: [f64; 3],
}

/// What [`AlphaShape::component_numbers`] says of points that are not vertices of the shape.
pub const NO_COMPONENT: u32 = u32::MAX;

impl AlphaShape {
    /// For each input point the number of its component, [`NO_COMPONENT`] if it is not in the shape.
    /// Components are numbered in the order of their smallest vertices. O(n).
    pub fn component_numbers(&self) -> Vec<u32> {
        let mut sets = connected(self.complex());
        let mut numbers = vec![NO_COMPONENT; self.points().len()];
        let mut count = 0;
        for (&[v], class) in self.complex().vertices.iter() {
            if class == Class::Exterior {
                continue;
            }
            let root = sets.find(v);
            if root == v {
                numbers[v as usize] = count;
                count += 1;
            } else {
                numbers[v as usize] = numbers[root as usize];
            }
        }
        numbers
    }

    /// The components of the shape by their numbers, as many as b0. Sums are exact, and rounded once. O(n).
    pub fn components(&self) -> Vec<Component> {
        let numbers = self.component_numbers();
        let positions = &self.points().positions;
        let at = |v: u32| positions[v as usize];
        let number = |v: u32| numbers[v as usize] as usize;
        let mut components: Vec<ComponentSums> = Vec::new();
        for &[v] in self.complex().vertices.rows() {
            match number(v) {
                n if n == NO_COMPONENT as usize => {}
                n if n == components.len() => components.push(ComponentSums::at(at(v))),
                n => components[n].reach(at(v)),
            }
        }
        for cell in self.complex().cells.of(Class::Interior) {
            components[number(cell[0])].add_cell(cell.map(at));
        }
        for (facet, class) in self.complex().facets.iter() {
            components[number(facet[0])].add_facet(facet.map(at), class);
        }
        let sheets = self.sheets().map(|sheets| self.sheet_sums(sheets, &numbers));
        told(components, sheets)
    }

    /// Each sheet that has facets, with its component.
    fn sheet_sums(&self, sheets: &Sheets, numbers: &[u32]) -> Vec<(u32, usize, SheetSums)> {
        let positions = &self.points().positions;
        let complex = self.complex();
        let mut found: Vec<Option<(usize, SheetSums)>> = vec![None; sheets.count as usize];
        let mut add = |sheet: u32, side: [u32; 3]| {
            let corners = side.map(|v| positions[v as usize]);
            let (_, sums) = found[sheet as usize].get_or_insert_with(|| {
                (numbers[side[0] as usize] as usize, SheetSums::default())
            });
            sums.add(positions[0], corners);
        };
        for (&sheet, &side) in sheets.regular.iter().zip(complex.facets.of(Class::Regular)) {
            add(sheet, side);
        }
        for (&[clockwise, counter], &[a, b, c]) in
            sheets.singular.iter().zip(complex.facets.of(Class::Singular))
        {
            add(clockwise, [a, c, b]);
            add(counter, [a, b, c]);
        }
        let numbered = (0..).zip(found);
        numbered.filter_map(|(sheet, found)| found.map(|(c, sums)| (sheet, c, sums))).collect()
    }
}

/// What is summed over a component, or over a part of one: parts [join](Self::join) in any order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ComponentSums {
    pub vertices: usize,
    pub cells: usize,
    six_volumes: Sum,
    area: Sum,
    singular_area: Sum,
    low: [f64; 3],
    high: [f64; 3],
}

impl ComponentSums {
    /// One of its vertices.
    pub fn at(point: [f64; 3]) -> Self {
        Self {
            vertices: 1,
            cells: 0,
            six_volumes: Sum::default(),
            area: Sum::default(),
            singular_area: Sum::default(),
            low: point,
            high: point,
        }
    }

    /// Another vertex.
    pub fn reach(&mut self, point: [f64; 3]) {
        self.vertices += 1;
        widen(&mut self.low, &mut self.high, point);
    }

    /// A cell that is in the shape.
    pub fn add_cell(&mut self, corners: [[f64; 3]; 4]) {
        self.cells += 1;
        self.six_volumes.add(six_volumes(corners));
    }

    /// A facet of some class.
    pub fn add_facet(&mut self, corners: [[f64; 3]; 3], class: Class) {
        match class {
            Class::Regular => self.area.add(facet_area(corners)),
            Class::Singular => self.singular_area.add(facet_area(corners)),
            _ => {}
        }
    }

    /// Takes in another part.
    pub fn join(&mut self, other: &Self) {
        self.vertices += other.vertices;
        self.cells += other.cells;
        self.six_volumes.join(&other.six_volumes);
        self.area.join(&other.area);
        self.singular_area.join(&other.singular_area);
        widen(&mut self.low, &mut self.high, other.low);
        widen(&mut self.low, &mut self.high, other.high);
    }

    /// What all of these have, which is what the shape has.
    pub fn measures<'a>(all: impl Iterator<Item = &'a Self> + Clone) -> Measures {
        let sum = |of: fn(&Self) -> &Sum| {
            let mut sum = Sum::default();
            all.clone().for_each(|sums| sum.join(of(sums)));
            sum.value()
        };
        Measures {
            volume: sum(|sums| &sums.six_volumes) / 6.0,
            area: sum(|sums| &sums.area),
            singular_area: sum(|sums| &sums.singular_area),
        }
    }

    fn told(self) -> Component {
        let Self { vertices, cells, low, high, .. } = self;
        Component {
            vertices,
            cells,
            // Divided last: sums of determinants on a lattice are whole numbers.
            volume: self.six_volumes.value() / 6.0,
            area: self.area.value(),
            singular_area: self.singular_area.value(),
            low,
            high,
            voids: None,
        }
    }
}

/// What is summed over the sides of facets that are on one sheet, or over some of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SheetSums {
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
    /// A side of a facet, whose corners turn counter-clockwise seen from outside the shape. `apex` is one
    /// place for all: of the cones over the sides of a sheet from it, signed, the sheet's inside remains.
    pub fn add(&mut self, apex: [f64; 3], corners: [[f64; 3]; 3]) {
        let [a, b, c] = corners;
        self.six_volumes.add(-six_volumes([apex, a, b, c]));
        corners.iter().for_each(|&corner| widen(&mut self.low, &mut self.high, corner));
    }

    /// Takes in other sides.
    pub fn join(&mut self, other: &Self) {
        self.six_volumes.join(&other.six_volumes);
        widen(&mut self.low, &mut self.high, other.low);
        widen(&mut self.low, &mut self.high, other.high);
    }

    fn told(self, sheet: u32) -> Enclosed {
        let Self { six_volumes, low, high } = self;
        Enclosed { sheet, volume: six_volumes.value() / 6.0, low, high }
    }
}

/// Components by their numbers, with the voids that their sheets enclose; sheets ascend by number, each
/// with its component.
pub(crate) fn told(
    components: Vec<ComponentSums>,
    sheets: Option<Vec<(u32, usize, SheetSums)>>,
) -> Vec<Component> {
    let mut components: Vec<Component> =
        components.into_iter().map(ComponentSums::told).collect();
    let Some(sheets) = sheets else { return components };
    components.iter_mut().for_each(|component| component.voids = Some(Vec::new()));
    let told = |(sheet, component, sums): (u32, usize, SheetSums)| (component, sums.told(sheet));
    let mut found: Vec<(usize, Enclosed)> = sheets.into_iter().map(told).collect();
    // The sheet around a component has what it encloses behind it: least, and first.
    found.sort_by(|(a, first), (b, second)| {
        a.cmp(b).then(first.volume.total_cmp(&second.volume))
    });
    let voids = found.chunk_by(|a, b| a.0 == b.0).flat_map(|of_one| of_one[1..].iter().rev());
    for &(component, void) in voids {
        components[component].voids.get_or_insert_default().push(void);
    }
    components
}

/// The vertices of a shape, united by its edges.
pub(super) fn connected(complex: &Complex) -> UnionFind {
    let points = complex.vertices.rows().last().map_or(0, |&[v]| v as usize + 1);
    let mut sets = UnionFind::new(points);
    for (&[a, b], class) in complex.edges.iter() {
        if class != Class::Exterior {
            sets.unite(a, b);
        }
    }
    sets
}

fn widen(low: &mut [f64; 3], high: &mut [f64; 3], point: [f64; 3]) {
    for k in 0..3 {
        low[k] = low[k].min(point[k]);
        high[k] = high[k].max(point[k]);
    }
}
