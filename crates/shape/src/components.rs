//! The components of a shape.

use walpha_base::parallel::prelude::*;
use walpha_regular::Torus;

use super::sums::{ByNumber, ComponentSums, SheetSums, by_number, components_of_sums};
use super::topology::{connected, connected_on_torus};
use super::winding::WindingSets;
use super::{AlphaShape, Class, Component, Measures, Sheets};

/// Stands in [`AlphaShape::component_numbers`] for points that are not vertices of the shape.
pub const NO_COMPONENT: u32 = u32::MAX;

impl AlphaShape {
    /// For each input point the number of its component, [`NO_COMPONENT`] if it is not in the shape.
    /// Components are numbered in the order of their smallest vertices. O(n).
    pub fn component_numbers(&self) -> Vec<u32> {
        let sets = connected(self.complex(), self.points().len());
        // Copies of a point are in its component.
        for (copy, &of) in (self.own_points() as u32..).zip(&self.copies) {
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
        for (copy, &of) in (self.own_points()..).zip(&self.copies) {
            numbers[copy] = numbers[of as usize];
        }
        numbers
    }

    /// The sums over each component, and those over all, given the component of each point.
    pub(crate) fn summed(&self, numbers: &[u32]) -> (Vec<ComponentSums>, Measures) {
        let positions = &self.points().positions;
        let torus = self.options().periodic;
        let mut windings = torus.map(|torus| (torus, self.connected_on_torus()));
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
        let measures = ComponentSums::measures(components.iter());
        (components, measures)
    }

    /// The components of the shape by their numbers, as many as b0. Sums are exact, and rounded once. O(n).
    pub fn components(&self) -> Vec<Component> {
        let numbers = self.component_numbers();
        let (sums, _) = self.sums.get(|| self.summed(&numbers));
        let torus = self.options().periodic;
        // On a torus, a sheet need not enclose anything.
        let sheets = self.sheets().filter(|_| torus.is_none());
        let sheets = sheets.map(|sheets| self.sheet_sums(sheets, &numbers));
        let mut components = components_of_sums(sums, sheets);
        if let Some(torus) = torus {
            self.set_rounds(&mut components, &numbers, torus);
        }
        components
    }

    fn connected_on_torus(&self) -> WindingSets {
        connected_on_torus(self.complex(), |edge| self.shifted(edge))
    }

    /// Sets `rounds` and the boxes of components that wind round a torus.
    fn set_rounds(&self, components: &mut [Component], numbers: &[u32], torus: Torus) {
        let mut windings = self.connected_on_torus();
        components.iter_mut().for_each(|component| component.rounds = Some(0));
        for &[v] in self.complex().vertices.rows() {
            let (root, _) = windings.find(v);
            let Some(directions) = windings.rounds(root).filter(|_| root == v) else { continue };
            let component = &mut components[numbers[v as usize] as usize];
            component.rounds = Some(directions.rank());
            let [low, high] = torus.extent();
            for axis in (0..3).filter(|&axis| directions.have(axis, torus)) {
                let (lowest, highest) = (&mut component.low[axis], &mut component.high[axis]);
                // Where the box does not repeat, points may lie beyond it.
                (*lowest, *highest) = if torus.dimension() == 3 {
                    (low[axis], high[axis])
                } else {
                    (low[axis].min(*lowest), high[axis].max(*highest))
                };
            }
        }
    }

    /// Each sheet with facets: its number, its component, and its sums.
    fn sheet_sums(&self, sheets: &Sheets, numbers: &[u32]) -> Vec<(u32, usize, SheetSums)> {
        let positions = &self.points().positions;
        let facets = &self.complex().facets;
        let regular = sheets.regular.iter().copied().zip(facets.of(Class::Regular).copied());
        let singular = sheets.singular.iter().zip(facets.of(Class::Singular));
        let both = singular.flat_map(|(&[clockwise, counter], &[a, b, c])| {
            [(clockwise, [a, c, b]), (counter, [a, b, c])]
        });
        // The sides are sorted by sheet, so that sums are exchanged only once for each sheet.
        let mut sides: Vec<(u32, [u32; 3])> = regular.chain(both).collect();
        sides.par_sort_unstable_by_key(|&(sheet, _)| sheet);
        let sums = by_number(sides.len(), |row, sums: &mut ByNumber<SheetSums>| {
            let (sheet, side) = sides[row];
            sums.of(sheet).add(positions[0], side.map(|v| positions[v as usize]));
        });
        let of_one = sides.chunk_by(|(sheet, _), (next, _)| sheet == next);
        let mut found: Vec<(u32, usize, SheetSums)> = of_one
            .map(|sides| {
                let (sheet, [v, ..]) = sides[0];
                (sheet, numbers[v as usize] as usize, SheetSums::default())
            })
            .collect();
        for (sheet, sums) in sums.iter().flatten() {
            let of_sheet = found.binary_search_by_key(sheet, |(sheet, ..)| *sheet);
            found[of_sheet.expect("a sheet of a side")].2.join(sums);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::Sum;
    use walpha_base::random::Random;

    use super::*;
    use crate::measure::{facet_area, six_volumes};
    use crate::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};

    /// Compares joined sums over ranges of rows with one sum over all rows, for components within a range and across ranges.
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
            let of_all = |terms: &mut dyn Iterator<Item = f64>| terms.collect::<Sum>().value();
            let corners = |facet: &[u32; 3]| facet.map(|v| positions[v as usize]);
            let areas = [Class::Regular, Class::Singular].map(|class| {
                of_all(&mut complex.facets.of(class).map(|facet| facet_area(corners(facet))))
            });
            let cells = complex.cells.of(Class::Interior);
            let mut volumes = cells.map(|cell| six_volumes(cell.map(|v| positions[v as usize])));
            let volume = of_all(&mut volumes) / 6.0;
            let [regular_area, singular_area] = areas;
            let facets = complex.facets.iter().filter(|(_, class)| *class != Class::Interior);
            let area = of_all(&mut facets.map(|(facet, _)| facet_area(corners(facet))));
            let measures = Measures { volume, area, regular_area, singular_area };
            assert_eq!(shape.measures(), measures);

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
                    [component.regular_area, component.singular_area],
                    [area.value(), singular.value()]
                );
                assert_eq!((component.low, component.high), (low, high));
            }
        }
        assert_eq!(across, 1, "one shape has rows in several ranges");
    }

    /// The voids that the sheets of a single component enclose are those of the complement, between regular and singular facets.
    #[test]
    fn sheets_enclose_the_voids() {
        let mut random = Random::new(3);
        let (mut voids, mut between_singular) = (0, 0);
        for _ in 0..60 {
            let positions = (0..80).map(|_| [0; 3].map(|_| random.unit())).collect();
            let points = WeightedPoints::unweighted(positions);
            for alpha in [0.02, 0.03, 0.05] {
                let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
                let shape = alpha_shape(points.clone(), &options).unwrap();
                let components = shape.components();
                let [component] = &components[..] else { continue };
                let whole = alpha_shape(points.clone(), &options.exterior(true)).unwrap();
                let expected = whole.voids().unwrap();
                let found = component.voids.as_ref().unwrap();
                assert_eq!(found.len(), expected.len());
                for (found, expected) in found.iter().zip(&expected) {
                    assert!((found.volume - expected.volume).abs() < 1e-12);
                    assert_eq!((found.low, found.high), (expected.low, expected.high));
                }
                voids += found.len();
                let sides = &shape.sheets().unwrap().singular;
                between_singular += usize::from(!found.is_empty() && !sides.is_empty());
            }
        }
        assert!(voids > 30 && between_singular > 10, "{voids} {between_singular}");
    }
}
