//! Components of a shape, and the sheets of its boundary.

use serde::{Deserialize, Serialize};

use super::blocks::Answer;
use super::sums::{ComponentSums, SheetSums, told};
use super::union_find::UnionFind;
use super::{AlphaShape, Class, Complex};

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
            if matches!(class, Class::Regular | Class::Singular) {
                components[number(facet[0])].add_facet(facet.map(at), class);
            }
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
            let (_, sums) = found[sheet as usize]
                .get_or_insert_with(|| (numbers[side[0] as usize] as usize, SheetSums::default()));
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
