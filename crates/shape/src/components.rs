//! The components of a shape.

use walpha_regular::Torus;

use super::sums::{ByNumber, ComponentSums, SheetSums, by_number, components_of_sums};
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
        let complex = self.complex();
        let of_cells = by_number(complex.cells.len(), |row, sums: &mut ByNumber<ComponentSums>| {
            if complex.cells.classes()[row] == Class::Interior {
                let cell = complex.cells.rows()[row];
                sums.of(numbers[cell[0] as usize]).add_cell(self.corners(cell));
            }
        });
        let of_facets =
            by_number(complex.facets.len(), |row, sums: &mut ByNumber<ComponentSums>| {
                // The vertices of exterior facets may be in no component.
                if let class @ (Class::Regular | Class::Singular) = complex.facets.classes()[row] {
                    let facet = complex.facets.rows()[row];
                    sums.of(numbers[facet[0] as usize]).add_facet(self.corners(facet), class);
                }
            });
        for (number, sums) in of_cells.iter().chain(&of_facets).flatten() {
            components[*number as usize].join(sums);
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
        // Sides of regular facets, then both of singular ones.
        let regular: Vec<[u32; 3]> = complex.facets.of(Class::Regular).copied().collect();
        let singular: Vec<[u32; 3]> = complex.facets.of(Class::Singular).copied().collect();
        let add = |sums: &mut ByNumber<SheetSums>, sheet: u32, side: [u32; 3]| {
            sums.of(sheet).add(positions[0], side.map(|v| positions[v as usize]));
        };
        let of_regular = by_number(regular.len(), |row, sums| {
            add(sums, sheets.regular[row], regular[row]);
        });
        let of_singular = by_number(singular.len(), |row, sums| {
            let ([clockwise, counter], [a, b, c]) = (sheets.singular[row], singular[row]);
            add(sums, clockwise, [a, c, b]);
            add(sums, counter, [a, b, c]);
        });
        let mut found: Vec<Option<(usize, SheetSums)>> = vec![None; sheets.count as usize];
        let of_row = |row: [u32; 3]| numbers[row[0] as usize] as usize;
        let component = |sheet: u32, row: [u32; 3]| (sheet as usize, of_row(row));
        let rows = sheets.regular.iter().zip(&regular).map(|(&sheet, &row)| component(sheet, row));
        let others = sheets.singular.iter().zip(&singular);
        let others = others.flat_map(|(sheets, &row)| sheets.map(|sheet| component(sheet, row)));
        for (sheet, component) in rows.chain(others) {
            found[sheet].get_or_insert_with(|| (component, SheetSums::default()));
        }
        for (sheet, sums) in of_regular.iter().chain(&of_singular).flatten() {
            if let Some((_, all)) = &mut found[*sheet as usize] {
                all.join(sums);
            }
        }
        let numbered = (0..).zip(found);
        numbered.filter_map(|(sheet, found)| found.map(|(c, sums)| (sheet, c, sums))).collect()
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::Sum;
    use walpha_base::random::Random;

    use super::*;
    use crate::measure::{facet_area, six_volumes};
    use crate::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};

    /// Sums over ranges of rows, joined, against one sum over all rows, for components within a range and across them.
    #[test]
    fn sums_of_ranges_are_those_of_all_rows() {
        let mut random = Random::new(7);
        let positions: Vec<[f64; 3]> =
            (0..12_000).map(|_| [random.unit(), random.unit(), random.unit()]).collect();
        let points = WeightedPoints::unweighted(positions);
        let mut across = 0;
        for alpha in [4e-4, 1e-2] {
            let shape = alpha_shape(
                points.clone(),
                &ShapeOptions::new(Alpha::from_squared(alpha).unwrap()),
            )
            .unwrap();
            let (numbers, positions) = (shape.component_numbers(), &shape.points().positions);
            let complex = shape.complex();
            let components = shape.components();
            assert!(!components.is_empty());
            let mut expected: Vec<_> = components
                .iter()
                .map(|_| {
                    (Sum::default(), [Sum::default(), Sum::default()], [f64::MAX; 3], [f64::MIN; 3])
                })
                .collect();
            for cell in complex.cells.of(Class::Interior) {
                let corners = cell.map(|v| positions[v as usize]);
                expected[numbers[cell[0] as usize] as usize].0.add(six_volumes(corners));
            }
            for (facet, class) in complex.facets.iter() {
                let corners = facet.map(|v| positions[v as usize]);
                let areas = &mut expected[numbers[facet[0] as usize] as usize].1;
                match class {
                    Class::Regular => areas[0].add(facet_area(corners)),
                    Class::Singular => areas[1].add(facet_area(corners)),
                    _ => {}
                }
            }
            for &[v] in complex.vertices.rows() {
                let (.., low, high) = &mut expected[numbers[v as usize] as usize];
                for k in 0..3 {
                    low[k] = low[k].min(positions[v as usize][k]);
                    high[k] = high[k].max(positions[v as usize][k]);
                }
            }
            across += usize::from(complex.facets.len() > 1 << 16);
            for (component, (volumes, [area, singular], low, high)) in
                components.iter().zip(expected)
            {
                assert_eq!(component.volume, volumes.value() / 6.0);
                assert_eq!(
                    [component.area, component.singular_area],
                    [area.value(), singular.value()]
                );
                assert_eq!((component.low, component.high), (low, high));
            }
        }
        assert_eq!(across, 1, "one shape has rows in several ranges");
    }
}
