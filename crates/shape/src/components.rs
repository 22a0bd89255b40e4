//! The components of a shape.

use walpha_regular::Torus;

use super::sums::{ComponentSums, SheetSums, components_of_sums};
use super::topology::{connected, connected_on_torus};
use super::winding::WindingSets;
use super::{AlphaShape, Class, Component, Sheets};

/// Stands in [`AlphaShape::component_numbers`] for points that are no vertices of the shape.
pub const NO_COMPONENT: u32 = u32::MAX;

impl AlphaShape {
    /// For each input point the number of its component, [`NO_COMPONENT`] if it is not in the shape.
    /// Components are numbered in the order of their smallest vertices. O(n).
    pub fn component_numbers(&self) -> Vec<u32> {
        let sets = connected(self.complex());
        // Copies of a point are in its component.
        let first_copy = (self.points().len() - self.copies.len()) as u32;
        for (copy, &of) in (first_copy..).zip(&self.copies) {
            sets.unite(copy, of);
        }
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
        let torus = self.options().periodic;
        let mut windings =
            torus.map(|torus| (torus, connected_on_torus(self.complex(), positions, torus)));
        let number = |v: u32| numbers[v as usize] as usize;
        let mut components: Vec<ComponentSums> = Vec::new();
        for &[v] in self.complex().vertices.rows() {
            let mut point = positions[v as usize];
            if let Some((torus, windings)) = &mut windings {
                point = torus.moved(point, windings.find(v).1);
            }
            match number(v) {
                n if n == NO_COMPONENT as usize => {}
                n if n == components.len() => components.push(ComponentSums::at(point)),
                n => components[n].add_vertex(point),
            }
        }
        for cell in self.complex().cells.of(Class::Interior) {
            components[number(cell[0])].add_cell(self.corners(*cell));
        }
        for (facet, class) in self.complex().facets.iter() {
            // The vertices of exterior facets may be in no component.
            if let Class::Regular | Class::Singular = class {
                components[number(facet[0])].add_facet(self.corners(*facet), class);
            }
        }
        // On a torus, a sheet need not enclose anything.
        let sheets = self.sheets().filter(|_| torus.is_none());
        let sheets = sheets.map(|sheets| self.sheet_sums(sheets, &numbers));
        let mut components = components_of_sums(components, sheets);
        if let Some((torus, windings)) = windings {
            self.set_rounds(&mut components, &numbers, torus, windings);
        }
        components
    }

    /// Sets `rounds` and the boxes of components that wind round a torus.
    fn set_rounds(
        &self,
        components: &mut [Component],
        numbers: &[u32],
        torus: Torus,
        mut windings: WindingSets,
    ) {
        components.iter_mut().for_each(|component| component.rounds = Some(0));
        for &[v] in self.complex().vertices.rows() {
            let (root, _) = windings.find(v);
            let Some(directions) = windings.rounds(root).filter(|_| root == v) else { continue };
            let component = &mut components[numbers[v as usize] as usize];
            component.rounds = Some(directions.rank());
            for axis in (0..3).filter(|&axis| directions.has(axis)) {
                (component.low[axis], component.high[axis]) = (0.0, torus.sides()[axis]);
            }
        }
    }

    /// Each sheet with facets: its number, its component, and its sums.
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
