//! The complex of the solid: its simplices with their classes in canonical order, corner by corner, without sorting them all.

use std::collections::BTreeMap;

use walpha_base::Monitor;
use walpha_base::memory::{NoMemory, try_with_capacity};
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};
use walpha_regular::triangulate;

use super::cells::{Filling, Lattice, written};
use crate::bits::Bits;
use crate::{Class, Complex, ShapeError, Simplices};

/// The complex of a region: each corner lists the simplices whose smallest vertex it is. A facet of one cell is regular, and so
/// are its edges and vertices; all other simplices are interior. The cells are positively oriented if the axes of the grid are
/// right-handed, and turned over if `mirrored`.
pub(super) fn complex(
    lattice: &Lattice,
    region: &Bits,
    mirrored: bool,
    monitor: &Monitor,
) -> Result<Complex, ShapeError> {
    let filling = lattice.filling(mirrored, &monitor.part(0, 5, 10))?;
    let patterns = Patterns::new(mirrored)?;
    let count = lattice.corners.planes();
    let work = monitor.part(5, 10, 10);
    let steps = work.units(2 * count as u64);
    let planes = || (0..count).into_par_iter();
    let each = |plane, visit: &mut dyn FnMut(&Found)| {
        steps.add(1)?;
        let mut found = Found::default();
        lattice.corners.each_of(plane, |corner| {
            patterns.find(lattice, region, &filling, corner, &mut found);
            visit(&found);
        });
        Ok::<_, ShapeError>(())
    };
    // The first pass counts, so that nothing larger than the result is ever needed.
    let counted = planes().map(|plane| {
        let mut counts = [0; 4];
        each(plane, &mut |found| {
            let more = [found.cells.len(), found.facets.len(), found.edges.len(), 1];
            (0..4).for_each(|k| counts[k] += more[k]);
        })?;
        Ok(counts)
    });
    let counts = counted.collect::<Result<Vec<[usize; 4]>, ShapeError>>()?;
    let of = |k: usize| counts.iter().map(|counts| counts[k]).collect::<Vec<_>>();
    let mut cells = Rows::<4>::new(&of(0))?;
    let mut facets = Rows::<3>::new(&of(1))?;
    let mut edges = Rows::<2>::new(&of(2))?;
    let mut vertices = Rows::<1>::new(&of(3))?;
    let parts = (cells.parts(&of(0)).into_par_iter())
        .zip(facets.parts(&of(1)))
        .zip(edges.parts(&of(2)))
        .zip(vertices.parts(&of(3)));
    let filled = parts.zip(planes()).map(|((((cells, facets), edges), vertices), plane)| {
        let (mut cells, mut facets) = (Place::new(cells), Place::new(facets));
        let (mut edges, mut vertices) = (Place::new(edges), Place::new(vertices));
        each(plane, &mut |found| {
            cells.write(&found.cells);
            facets.write(&found.facets);
            edges.write(&found.edges);
            vertices.write(&[found.vertex]);
        })
    });
    filled.collect::<Result<(), ShapeError>>()?;
    let (cells, facets) = (cells.simplices(), facets.simplices());
    Ok(Complex { cells, facets, edges: edges.simplices(), vertices: vertices.simplices() })
}

/// The corners of a cube.
const CUBE: [[u32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];

/// The place of a corner in the 3 × 3 × 3 around it. These places, in the order of z, y and x, are in the order of the numbers of corners.
const HERE: u32 = 13;

/// A simplex whose smallest vertex is the corner, as it is contained in the cubes around the corner.
#[derive(Clone, Debug)]
struct Pattern<const N: usize> {
    /// The cubes that the simplex is in, a bit for each octant.
    around: u8,
    /// For each cube, as a bit, the places of the vertices; those of a facet as seen from outside of the cube.
    seen: Vec<(u8, [u32; N])>,
    /// Its places if no side of it is outside: ascending, except that a cell keeps its orientation.
    inner: [u32; N],
}

impl<const N: usize> Pattern<N> {
    /// The places and the class of the simplex, if it is in the solid of these octants.
    fn of(&self, octants: &Octants) -> Option<([u32; N], Class)> {
        if self.around & octants.shell == 0 {
            return None;
        }
        if self.around & !octants.region == 0 {
            return Some((self.inner, Class::Interior));
        }
        let inside = self.seen.iter().find(|(cube, _)| cube & octants.region != 0);
        Some((inside.expect("a cube of the shell is in the region").1, Class::Regular))
    }
}

/// The octants around a corner that are in a set, a bit for each; bit k of an octant's number says that it is after the corner
/// along axis k.
struct Octants {
    shell: u8,
    region: u8,
}

/// The simplices of all cubes around a corner whose smallest vertex it is.
struct Patterns {
    cells: Vec<Pattern<4>>,
    facets: Vec<Pattern<3>>,
    edges: Vec<Pattern<2>>,
}

impl Patterns {
    fn new(mirrored: bool) -> Result<Self, ShapeError> {
        let cube = triangulate(&CUBE.map(|corner| corner.map(f64::from)), None)?;
        let (mut cells, mut facets, mut edges) = Default::default();
        for octant in 0..8 {
            for (_, cell) in cube.finite_cells() {
                let cell = written(cell.map(|v| place(octant, CUBE[v as usize])), mirrored);
                add(&mut cells, octant, cell);
                for facet in outward_facets(cell).map(smallest_even) {
                    add(&mut facets, octant, facet);
                    let [a, b, c] = facet;
                    for edge in [[a, b], [b, c], [a, c]] {
                        add(&mut edges, octant, sorted(edge));
                    }
                }
            }
        }
        let (cells, facets) = (only(cells), only(facets));
        Ok(Self { cells, facets, edges: only(edges) })
    }

    /// Finds the simplices whose smallest vertex is a corner, in canonical order.
    fn find(
        &self,
        lattice: &Lattice,
        region: &Bits,
        filling: &Filling,
        (number, corner): (u32, [usize; 3]),
        found: &mut Found,
    ) {
        let at =
            |octant: u32| [0, 1, 2].map(|k| corner[k] as i64 - i64::from(octant >> k & 1 == 0));
        let bits = |set: &Bits| (0..8).map(|o| u8::from(set.has(at(o))) << o).sum();
        let octants = Octants { shell: bits(&lattice.shell), region: bits(region) };
        let mut numbers = [0; 27];
        for octant in (0..8).filter(|o| octants.shell >> o & 1 == 1) {
            let first = at(octant).map(|i| i as usize);
            for step in CUBE {
                let number = &mut numbers[place(octant, step) as usize];
                if *number == 0 {
                    *number =
                        lattice.corners.number([0, 1, 2].map(|k| first[k] + step[k] as usize));
                }
            }
        }
        found.cells.clear();
        found.cells.extend(present(&self.cells, &octants, &numbers));
        found.facets.clear();
        found.facets.extend(present(&self.facets, &octants, &numbers));
        found.edges.clear();
        found.edges.extend(present(&self.edges, &octants, &numbers));
        found.cells.extend(starting(&filling.cells, number).map(|&cell| (cell, Class::Interior)));
        found.cells.sort_unstable();
        found.facets.extend(starting(&filling.facets, number).map(|&row| (row, Class::Interior)));
        found.facets.sort_unstable();
        for &edge in starting(&filling.edges, number) {
            // An edge of a cube exists already, with the class that the cubes around it give it.
            if !found.edges.iter().any(|(there, _)| *there == edge) {
                found.edges.push((edge, Class::Interior));
            }
        }
        found.edges.sort_unstable();
        let class = if octants.region == u8::MAX { Class::Interior } else { Class::Regular };
        found.vertex = ([number], class);
    }
}

/// The place of a corner of the cube in an octant.
fn place(octant: u32, step: [u32; 3]) -> u32 {
    let along = |k: usize| (octant >> k & 1) + step[k];
    along(0) + 3 * along(1) + 9 * along(2)
}

/// Patterns during their collection, by their places.
type Gathered<const N: usize> = BTreeMap<[u32; N], Vec<(u8, [u32; N])>>;

fn add<const N: usize>(to: &mut Gathered<N>, octant: u32, row: [u32; N]) {
    let seen = to.entry(sorted(row)).or_default();
    if !seen.contains(&(1 << octant, row)) {
        seen.push((1 << octant, row));
    }
}

/// The patterns whose smallest vertex is the corner [`HERE`].
fn only<const N: usize>(gathered: Gathered<N>) -> Vec<Pattern<N>> {
    let smallest = gathered.into_iter().filter(|(row, _)| row[0] == HERE);
    let pattern = |(sorted, seen): ([u32; N], Vec<(u8, [u32; N])>)| Pattern {
        around: seen.iter().fold(0, |around, (cube, _)| around | cube),
        inner: if N == 4 { seen[0].1 } else { sorted },
        seen,
    };
    smallest.map(pattern).collect()
}

/// The simplices of patterns that are in the solid, by the numbers of corners.
fn present<'a, const N: usize>(
    patterns: &'a [Pattern<N>],
    octants: &'a Octants,
    numbers: &'a [u32; 27],
) -> impl Iterator<Item = ([u32; N], Class)> + 'a {
    let there = patterns.iter().filter_map(|pattern| pattern.of(octants));
    there.map(|(row, class)| (row.map(|place| numbers[place as usize]), class))
}

/// The rows that start with a number.
fn starting<const N: usize>(rows: &[[u32; N]], number: u32) -> impl Iterator<Item = &[u32; N]> {
    let first = rows.partition_point(|row| row[0] < number);
    rows[first..].iter().take_while(move |row| row[0] == number)
}

/// The simplices whose smallest vertex is one corner.
struct Found {
    cells: Vec<([u32; 4], Class)>,
    facets: Vec<([u32; 3], Class)>,
    edges: Vec<([u32; 2], Class)>,
    vertex: ([u32; 1], Class),
}

impl Default for Found {
    fn default() -> Self {
        let (cells, facets, edges) = Default::default();
        Self { cells, facets, edges, vertex: ([0], Class::Interior) }
    }
}

/// Simplices to be written part by part.
struct Rows<const N: usize> {
    rows: Vec<[u32; N]>,
    classes: Vec<Class>,
}

impl<const N: usize> Rows<N> {
    /// Room for parts of these sizes.
    fn new(sizes: &[usize]) -> Result<Self, NoMemory> {
        let all = sizes.iter().sum();
        let what = || "the simplices of voxels".to_owned();
        let (mut rows, mut classes) =
            (try_with_capacity(all, what)?, try_with_capacity(all, what)?);
        rows.resize(all, [0; N]);
        classes.resize(all, Class::Interior);
        Ok(Self { rows, classes })
    }

    fn parts(&mut self, sizes: &[usize]) -> Vec<(&mut [[u32; N]], &mut [Class])> {
        let (mut rows, mut classes) = (&mut self.rows[..], &mut self.classes[..]);
        let part = |&size: &usize| {
            (
                rows.split_off_mut(..size).expect("as many"),
                classes.split_off_mut(..size).expect("as many"),
            )
        };
        sizes.iter().map(part).collect()
    }

    fn simplices(self) -> Simplices<N> {
        Simplices::new(self.rows, self.classes).expect("a class for each")
    }
}

/// The part of the rows that has not been written.
struct Place<'a, const N: usize> {
    rows: std::slice::IterMut<'a, [u32; N]>,
    classes: std::slice::IterMut<'a, Class>,
}

impl<'a, const N: usize> Place<'a, N> {
    fn new((rows, classes): (&'a mut [[u32; N]], &'a mut [Class])) -> Self {
        Self { rows: rows.iter_mut(), classes: classes.iter_mut() }
    }

    fn write(&mut self, simplices: &[([u32; N], Class)]) {
        let places = self.rows.by_ref().zip(self.classes.by_ref());
        // The simplices come first, so that a place is taken only for one of them.
        for (&(row, class), (to_row, to_class)) in simplices.iter().zip(places) {
            (*to_row, *to_class) = (row, class);
        }
    }
}
