//! The whole triangulation of points that span a volume: all simplices, with their classes at α = ∞, and which are faces of
//! which.
//!
//! A vertex has two numbers here: its place along the curve, by which the mesh names it and threads visit it, and its input
//! index, by which rows are ordered. A simplex belongs to its vertex with the smallest input index, whose simplices are
//! consecutive rows. So the simplices are grouped by that vertex, and the few of each group are sorted; nothing is searched for
//! faces: a facet is found from both of its cells, which learn its row, and the edges at a vertex from the facets there.

use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use walpha_base::parallel::prelude::*;
use walpha_base::{Monitor, memory};
use walpha_regular::internals::{CellArrays, Sites};

use super::Filtration;
use super::build::Incidence;
use crate::along::{Along, Table};
use crate::blocks::mesh;
use crate::groups::{Groups, first_rows};
use crate::make::{Found, shape_by};
use crate::{
    AlphaShape, Class, Complex, ShapeError, ShapeOptions, Sheets, Simplices, WeightedPoints,
};

/// A whole triangulation.
struct Whole {
    complex: Complex,
    incidence: Incidence,
    along: Along,
    /// The points that are not vertices, ascending, by input index.
    hidden: Vec<u32>,
}

/// The shape in space at α = ∞. Also returns the incidences of its simplices, and its vertices along the curve, unless points span
/// no volume.
pub(super) fn in_space(
    points: WeightedPoints,
    options: &ShapeOptions,
    monitor: &Monitor,
) -> Result<(AlphaShape, Option<(Incidence, Along)>), ShapeError> {
    let count = points.len();
    let listed = Cell::new(None);
    let find = |sites: &Sites<'_>, _: &ShapeOptions| {
        let (mesh, input) = mesh(sites, monitor)?;
        memory::afford(bytes(&mesh), || format!("the filtration of {} cells", mesh.cells().len()))?;
        let Whole { complex, incidence, along, hidden } = Whole::new(mesh, input, count);
        monitor.check()?;
        listed.set(Some((incidence, along)));
        // The hull is one sheet around one component.
        let regular = vec![0; complex.facets.counts().regular];
        let sheets = Sheets { regular, count: 1, ..Sheets::default() };
        let duplicates = sites.duplicates().to_vec();
        let (boundary, hidden) = (Some((1, sheets, 0)), Some(hidden));
        Ok(Found { complex, boundary, hidden, duplicates, betti: None })
    };
    let whole = shape_by(points, *options, &find, monitor)?;
    Ok((whole, listed.into_inner()))
}

/// The bytes that a filtration takes in addition to its mesh.
fn bytes(mesh: &CellArrays) -> usize {
    let (cells, vertices) = (mesh.cells().len(), mesh.infinite_vertex() as usize);
    // With the infinite vertex, each facet has two cells, and Euler's formula gives the edges.
    let counts = [cells, 2 * cells, cells + vertices, vertices];
    let rows =
        [size_of::<[u32; 4]>(), size_of::<[u32; 3]>(), size_of::<[u32; 2]>(), size_of::<u32>()];
    let listed = counts.iter().zip(rows);
    let listed = listed.map(|(count, row)| count.saturating_mul(row + size_of::<Class>()));
    // Facets take most while they are grouped: each with its vertex, then sorted.
    let grouped = counts[1].saturating_mul(3 * size_of::<u32>());
    let all = listed.chain([grouped, Filtration::bytes(counts)]);
    all.fold(0, usize::saturating_add)
}

/// The corners of a cell in ascending order of their input indices, and whether that is an odd permutation; in 16 bits.
#[derive(Clone, Copy)]
struct Order(u16);

impl Order {
    /// Stands for the order of an infinite cell.
    const INFINITE: Self = Self(u16::MAX);
    /// The bit of odd permutations.
    const ODD: u16 = 1 << 8;

    /// The order of corners with these input indices.
    #[inline(always)]
    fn of(input: [u32; 4]) -> Self {
        let mut order = [0u16, 1, 2, 3];
        let mut odd = 0;
        for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            let (a, b) = (order[i], order[j]);
            let swapped = input[usize::from(a)] > input[usize::from(b)];
            (order[i], order[j]) = if swapped { (b, a) } else { (a, b) };
            odd ^= u16::from(swapped);
        }
        let [a, b, c, d] = order;
        Self(a | b << 2 | c << 4 | d << 6 | odd << 8)
    }

    /// The corner with this rank.
    #[inline(always)]
    fn corner(self, rank: usize) -> usize {
        usize::from(self.0 >> (2 * rank) & 3)
    }

    #[inline(always)]
    fn corners(self) -> [usize; 4] {
        [0, 1, 2, 3].map(|rank| self.corner(rank))
    }

    /// The rank of a corner.
    #[inline(always)]
    fn rank(self, corner: usize) -> usize {
        usize::from(self.corner(1) == corner)
            + 2 * usize::from(self.corner(2) == corner)
            + 3 * usize::from(self.corner(3) == corner)
    }

    fn is_odd(self) -> bool {
        self.0 & Self::ODD != 0
    }

    /// The place of the corner with this rank in the cell's row. A row is positively oriented: the last two are exchanged if the
    /// order is odd.
    #[inline(always)]
    fn place(self, rank: usize) -> usize {
        if self.is_odd() && rank >= 2 { 5 - rank } else { rank }
    }

    fn is_infinite(self) -> bool {
        self.0 == Self::INFINITE.0
    }
}

/// The mesh, and the order of the corners of its cells.
struct Mesh<'a> {
    cells: &'a [[u32; 4]],
    adjacency: &'a [[u32; 4]],
    /// The input index of each vertex.
    input: &'a [u32],
    orders: Vec<Order>,
}

/// The vertices whose simplices one thread lists at a time.
const VERTICES: usize = 1 << 9;

impl<'a> Mesh<'a> {
    fn new(mesh: &'a CellArrays, input: &'a [u32]) -> Self {
        let (cells, at_infinity) = (mesh.cells(), mesh.infinite_vertex());
        let order = |cell: &[u32; 4]| {
            if cell.contains(&at_infinity) {
                Order::INFINITE
            } else {
                Order::of(cell.map(|v| input[v as usize]))
            }
        };
        let orders = cells.par_iter().coarse().map(order).collect();
        Self { cells, adjacency: mesh.adjacency(), input, orders }
    }

    /// Visits all vertices along the curve, on all threads, with memory of their own.
    fn each<M: Send>(
        &self,
        memory: impl Fn() -> M + Sync + Send,
        visit: impl Fn(&mut M, u32) + Sync,
    ) {
        let vertices = self.input.len() as u32;
        (0..vertices).into_par_iter().with_min_len(VERTICES).for_each_init(memory, |memory, v| {
            visit(memory, v);
        });
    }

    /// 4·cell + corner opposite on the other side of a facet.
    fn beyond(&self, side: u32) -> u32 {
        self.adjacency[side as usize / 4][side as usize % 4]
    }

    /// The vertex with the smallest input index of a finite cell.
    fn first_of_cell(&self, cell: u32) -> Option<u32> {
        let order = self.orders[cell as usize];
        (!order.is_infinite()).then(|| self.cells[cell as usize][order.corner(0)])
    }

    /// The vertex with the smallest input index of the facet 4·cell + corner opposite, if it is listed from this cell: it is from
    /// the first of two finite cells.
    fn first_of_facet(&self, side: u32) -> Option<u32> {
        let (cell, corner) = (side as usize / 4, side as usize % 4);
        let order = self.orders[cell];
        let beyond = self.beyond(side);
        if order.is_infinite() || (beyond < side && !self.orders[beyond as usize / 4].is_infinite())
        {
            return None;
        }
        Some(self.cells[cell][order.corner(usize::from(order.corner(0) == corner))])
    }

    /// The other two vertices of a facet by input index, ascending, then the first of these, and the facet.
    fn key_of_facet(&self, side: u32) -> u128 {
        let (corners, order) = (self.cells[side as usize / 4], self.orders[side as usize / 4]);
        let [low, high] = match order.rank(side as usize % 4) {
            0 | 1 => [2, 3],
            2 => [1, 3],
            _ => [1, 2],
        };
        let [low, high] = [low, high].map(|rank| corners[order.corner(rank)]);
        key([self.input[low as usize], self.input[high as usize], low], side)
    }

    /// Whether a facet of a finite cell is on the hull.
    fn is_on_hull(&self, side: u32) -> bool {
        self.orders[self.beyond(side) as usize / 4].is_infinite()
    }

    /// Whether the ascending vertices of a facet of the hull turn clockwise, as seen from outside.
    fn turns_clockwise(&self, side: u32) -> bool {
        // They and the corner opposite are the ascending corners after one exchange for each rank above that of this corner.
        let order = self.orders[side as usize / 4];
        self.is_on_hull(side) && order.is_odd() == order.rank(side as usize % 4).is_multiple_of(2)
    }

    /// The classes of the vertices, exterior for hidden points.
    fn classes_of_vertices(&self) -> Vec<Class> {
        let classes = Classes::new(self.input.len(), Class::Exterior);
        let mark = |infinite: bool, class: Class| {
            let cells = self.cells.par_iter().zip(&self.orders).coarse();
            cells.filter(|(_, order)| order.is_infinite() == infinite).for_each(|(cell, _)| {
                // The infinite vertex follows the last one.
                for &v in cell.iter().filter(|&&v| (v as usize) < self.input.len()) {
                    classes.set(v as usize, class);
                }
            });
        };
        mark(false, Class::Interior);
        mark(true, Class::Regular);
        classes.finished()
    }
}

/// Classes that threads write in any order.
struct Classes(Vec<AtomicU8>);

impl Classes {
    fn new(count: usize, class: Class) -> Self {
        let all = (0..count).into_par_iter().coarse();
        Self(all.map(|_| AtomicU8::new(class as u8)).collect())
    }

    fn set(&self, at: usize, class: Class) {
        self.0[at].store(class as u8, Relaxed);
    }

    /// The classes, in the same memory.
    fn finished(self) -> Vec<Class> {
        self.0.into_iter().map(|class| Class::ALL[usize::from(class.into_inner())]).collect()
    }
}

/// The cells by row.
struct Cells {
    rows: Vec<[u32; 4]>,
    /// The first row of each vertex by input index, and the end.
    starts: Vec<u32>,
    /// The row of each finite cell of the mesh.
    of_mesh: Vec<u32>,
}

impl Cells {
    fn list(mesh: &Mesh<'_>, points: usize) -> Self {
        let groups =
            Groups::new(mesh.cells.len(), mesh.input.len(), |cell| mesh.first_of_cell(cell));
        let starts = groups.rows(mesh.input, points);
        let rows = Table::new(groups.len(), 0);
        let of_mesh = Table::new(mesh.cells.len(), Incidence::OUTSIDE);
        mesh.each(Vec::new, |keys: &mut Vec<u128>, v| {
            let first = mesh.input[v as usize];
            keys.clear();
            keys.extend(groups.of(v).iter().map(|&cell| {
                let (corners, order) = (mesh.cells[cell as usize], mesh.orders[cell as usize]);
                let [_, b, c, d] = order.corners().map(|k| mesh.input[corners[k] as usize]);
                let (c, d) = if order.is_odd() { (d, c) } else { (c, d) };
                key([b, c, d], cell)
            }));
            keys.sort_unstable();
            for (row, &key) in (starts[first as usize]..).zip(&*keys) {
                let [b, c, d, cell] = words(key);
                rows.write(row as usize, [first, b, c, d]);
                of_mesh.write(cell as usize, [row]);
            }
        });
        Self { rows: rows.finished(), starts, of_mesh: of_mesh.finished().into_flattened() }
    }
}

/// Numbers that are compared as a row of four, the first one first.
#[inline(always)]
fn key([a, b, c]: [u32; 3], d: u32) -> u128 {
    u128::from(a) << 96 | u128::from(b) << 64 | u128::from(c) << 32 | u128::from(d)
}

#[inline(always)]
fn words(key: u128) -> [u32; 4] {
    [96, 64, 32, 0].map(|shift| (key >> shift) as u32)
}

/// The facets by row, and their cells.
struct Facets {
    /// With ascending vertices, in lexicographic order.
    rows: Vec<[u32; 3]>,
    /// Those of the hull counter-clockwise as seen from outside, in lexicographic order, with their classes.
    listed: Vec<[u32; 3]>,
    classes: Vec<Class>,
    starts: Vec<u32>,
    /// The second vertex of each, by its place along the curve.
    seconds: Vec<u32>,
    cell_facets: Vec<[u32; 4]>,
    facet_cells: Vec<[u32; 2]>,
}

impl Facets {
    fn list(mesh: &Mesh<'_>, cells: &Cells, points: usize) -> Self {
        let groups =
            Groups::new(4 * mesh.cells.len(), mesh.input.len(), |side| mesh.first_of_facet(side));
        let starts = groups.rows(mesh.input, points);
        let count = groups.len();
        let (rows, listed) = (Table::new(count, 0), Table::new(count, 0));
        let classes = Classes::new(count, Class::Interior);
        let seconds = Table::new(count, 0);
        let cell_facets = Table::new(cells.rows.len(), 0);
        let facet_cells = Table::new(count, 0);
        let memory = || (Vec::new(), Vec::new());
        mesh.each(memory, |(keys, oriented): &mut (Vec<u128>, Vec<(u64, Class)>), v| {
            let first = mesh.input[v as usize];
            let start = starts[first as usize] as usize;
            let sides = groups.of(v);
            keys.clear();
            keys.extend(sides.iter().map(|&side| mesh.key_of_facet(side)));
            keys.sort_unstable();
            for (row, &key) in (start..).zip(&*keys) {
                let [b, c, second, side] = words(key);
                rows.write(row, [first, b, c]);
                seconds.write(row, [second]);
                let [near, far] = [side, mesh.beyond(side)].map(|side| {
                    let order = mesh.orders[side as usize / 4];
                    if order.is_infinite() {
                        return Incidence::OUTSIDE;
                    }
                    let cell = cells.of_mesh[side as usize / 4];
                    let place = order.place(order.rank(side as usize % 4));
                    cell_facets.write_at(cell as usize, place, row as u32);
                    cell
                });
                facet_cells.write(row, [near.min(far), near.max(far)]);
            }
            if !sides.iter().any(|&side| mesh.is_on_hull(side)) {
                for (row, &key) in (start..).zip(&*keys) {
                    let [b, c, ..] = words(key);
                    listed.write(row, [first, b, c]);
                }
                return;
            }
            oriented.clear();
            oriented.extend(keys.iter().map(|&key| {
                let [b, c, _, side] = words(key);
                let [b, c] = if mesh.turns_clockwise(side) { [c, b] } else { [b, c] };
                let class = if mesh.is_on_hull(side) { Class::Regular } else { Class::Interior };
                (u64::from(b) << 32 | u64::from(c), class)
            }));
            oriented.sort_unstable_by_key(|&(others, _)| others);
            for (row, &(others, class)) in (start..).zip(&*oriented) {
                listed.write(row, [first, (others >> 32) as u32, others as u32]);
                classes.set(row, class);
            }
        });
        Self {
            rows: rows.finished(),
            listed: listed.finished(),
            classes: classes.finished(),
            starts,
            seconds: seconds.finished().into_flattened(),
            cell_facets: cell_facets.finished(),
            facet_cells: facet_cells.finished(),
        }
    }
}

/// The edges by row.
struct Edges {
    rows: Vec<[u32; 2]>,
    classes: Vec<Class>,
    starts: Vec<u32>,
    facet_edges: Vec<[u32; 3]>,
}

/// The facets at each vertex from which edges are found: of each edge, those at its smaller end.
struct AtVertices<'a> {
    /// Those of which a vertex is the first are rows.
    facets: &'a Facets,
    /// Those of which it is the second.
    seconds: Groups,
    /// The edge opposite each vertex of each facet, numbered from the first edge of its smaller end.
    facet_edges: Table<3>,
}

/// The larger ends of the edges of consecutive vertices, ascending for each, and how many each vertex has.
#[derive(Default)]
struct Ends {
    all: Vec<u32>,
    counts: Vec<u32>,
}

/// Stands for the number of a point that has not been met.
const NOT_YET: u32 = u32::MAX;

impl AtVertices<'_> {
    /// Finds the edges whose smaller end is a vertex. `numbers` has a number for each point, none of which has been met.
    fn number_edges(&self, v: u32, point: u32, numbers: &mut [u32], ends: &mut Ends) {
        let Self { facets, seconds, facet_edges } = self;
        let [from, to] = [0, 1].map(|k| facets.starts[point as usize + k] as usize);
        let firsts = || (from..to).zip(&facets.rows[from..to]);
        let third = |&row: &u32| (row as usize, facets.rows[row as usize][2]);
        let start = ends.all.len();
        let mut meet = |end: u32| {
            if std::mem::replace(&mut numbers[end as usize], 0) == NOT_YET {
                ends.all.push(end);
            }
        };
        for (_, &[_, b, c]) in firsts() {
            meet(b);
            meet(c);
        }
        seconds.of(v).iter().map(third).for_each(|(_, c)| meet(c));
        let these = &mut ends.all[start..];
        these.sort_unstable();
        (0..).zip(&*these).for_each(|(number, &end)| numbers[end as usize] = number);
        for (row, &[_, b, c]) in firsts() {
            facet_edges.write_at(row, 1, numbers[c as usize]);
            facet_edges.write_at(row, 2, numbers[b as usize]);
        }
        for (row, c) in seconds.of(v).iter().map(third) {
            facet_edges.write_at(row, 0, numbers[c as usize]);
        }
        these.iter().for_each(|&end| numbers[end as usize] = NOT_YET);
        ends.counts.push(these.len() as u32);
    }
}

impl Edges {
    fn list(input: &[u32], facets: &Facets, points: usize) -> Self {
        let at_vertices = AtVertices {
            facets,
            seconds: Groups::new(facets.rows.len(), input.len(), |row| {
                Some(facets.seconds[row as usize])
            }),
            facet_edges: Table::new(facets.rows.len(), 0),
        };
        // Idle tables of numbers. There are as many as threads at work.
        let idle: Mutex<Vec<Vec<u32>>> = Mutex::default();
        let lock = || idle.lock().expect("no thread panics while it holds the lock");
        let of_chunk = |(chunk, vertices): (usize, &[u32])| {
            let mut numbers = lock().pop().unwrap_or_else(|| vec![NOT_YET; points]);
            let mut ends = Ends::default();
            for (v, &point) in ((chunk * VERTICES) as u32..).zip(vertices) {
                at_vertices.number_edges(v, point, &mut numbers, &mut ends);
            }
            lock().push(numbers);
            ends
        };
        let chunks: Vec<Ends> = input.par_chunks(VERTICES).enumerate().map(of_chunk).collect();
        drop(idle);
        let AtVertices { facet_edges, .. } = at_vertices;
        let counts = chunks.iter().flat_map(|ends| ends.counts.iter().copied());
        let starts = first_rows(input, points, counts);
        let rows = Table::new(starts[points] as usize, 0);
        chunks.par_iter().zip(input.par_chunks(VERTICES)).for_each(|(ends, vertices)| {
            let mut all = ends.all.iter();
            for (&point, &count) in vertices.iter().zip(&ends.counts) {
                let row = starts[point as usize] as usize;
                for (row, &end) in (row..).zip(all.by_ref().take(count as usize)) {
                    rows.write(row, [point, end]);
                }
            }
        });
        let rows = rows.finished();
        let mut facet_edges: Vec<[u32; 3]> = facet_edges.finished();
        let classes = Classes::new(rows.len(), Class::Interior);
        let facets = facets.rows.par_iter().zip(&facets.facet_cells);
        facet_edges.par_iter_mut().zip(facets).coarse().for_each(|(edges, (&[a, b, _], cells))| {
            for (edge, first) in edges.iter_mut().zip([b, a, a]) {
                *edge += starts[first as usize];
                if cells[1] == Incidence::OUTSIDE {
                    classes.set(*edge as usize, Class::Regular);
                }
            }
        });
        Self { rows, classes: classes.finished(), starts, facet_edges }
    }
}

impl Whole {
    /// Lists the simplices of a mesh. `input` has the input index of each vertex of the mesh, below `points`. O(cells), for
    /// bounded numbers of simplices at a point.
    fn new(made: CellArrays, input: Vec<u32>, points: usize) -> Self {
        let mesh = Mesh::new(&made, &input);
        let of_vertices = mesh.classes_of_vertices();
        let cells = Cells::list(&mesh, points);
        let facets = Facets::list(&mesh, &cells, points);
        drop(mesh);
        drop(made);
        let edges = Edges::list(&input, &facets, points);
        let mut classes = vec![None; points];
        let mut hidden = Vec::new();
        for (&point, class) in input.iter().zip(of_vertices) {
            match class {
                Class::Exterior => hidden.push(point),
                class => classes[point as usize] = Some(class),
            }
        }
        hidden.sort_unstable();
        let mut vertex_rows = Vec::with_capacity(points + 1);
        let (mut vertices, mut of_vertices) = (Vec::new(), Vec::new());
        for (point, class) in (0..).zip(classes) {
            vertex_rows.push(vertices.len() as u32);
            if let Some(class) = class {
                vertices.push([point]);
                of_vertices.push(class);
            }
        }
        vertex_rows.push(vertices.len() as u32);
        let of_cells = vec![Class::Interior; cells.rows.len()];
        let complex = Complex {
            cells: simplices(cells.rows, of_cells),
            facets: simplices(facets.listed, facets.classes),
            edges: simplices(edges.rows, edges.classes),
            vertices: simplices(vertices, of_vertices),
        };
        let incidence = Incidence {
            facets: facets.rows,
            cell_facets: facets.cell_facets,
            facet_cells: facets.facet_cells,
            ways: Vec::new(),
            facet_edges: edges.facet_edges,
            vertex_rows,
        };
        let along =
            Along { order: input, cells: cells.starts, facets: facets.starts, edges: edges.starts };
        Self { complex, incidence, along, hidden }
    }
}

fn simplices<const N: usize>(rows: Vec<[u32; N]>, classes: Vec<Class>) -> Simplices<N> {
    Simplices::new(rows, classes).expect("as many classes as rows")
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::{Alpha, Engine, make::in_large_box};

    /// Holds all that is listed to the classified triangulation, and to faces that are looked for. Returns the number of hidden points
    /// and of facets of the hull.
    fn agree(points: WeightedPoints) -> [usize; 2] {
        let options = ShapeOptions {
            engine: Engine::Native,
            exterior: true,
            ..ShapeOptions::new(Alpha::INFINITE)
        };
        let monitor = Monitor::noop();
        let expected = in_large_box(points.clone(), &options, &monitor).unwrap();
        let (found, listed) = in_space(points, &options, &monitor).unwrap();
        let (incidence, along) = listed.unwrap();
        assert_eq!(found.complex(), expected.complex());
        assert_eq!(found.betti, expected.betti);
        assert_eq!(found.sheets, expected.sheets);
        assert_eq!(found.hidden, expected.hidden);
        assert_eq!(found.duplicates, expected.duplicates);
        let positions = &expected.points().positions;
        let searched = Along::new(expected.complex(), positions);
        assert_eq!(along.cells, searched.cells);
        assert_eq!(along.facets, searched.facets);
        assert_eq!(along.edges, searched.edges);
        let searched = Incidence::new(expected.complex(), positions.len(), &searched);
        assert_eq!(incidence.facets, searched.facets);
        assert_eq!(incidence.cell_facets, searched.cell_facets);
        assert_eq!(incidence.facet_cells, searched.facet_cells);
        assert_eq!(incidence.facet_edges, searched.facet_edges);
        assert_eq!(incidence.vertex_rows, searched.vertex_rows);
        [found.hidden.map_or(0, |hidden| hidden.len()), expected.complex().facets.counts().regular]
    }

    #[test]
    fn listed_simplices_are_those_that_are_classified_and_searched() {
        let mut random = Random::new(11);
        let mut weighted = |count: usize, weight: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]| {
            let positions = (0..count).map(|_| place([0; 3].map(|_| random.unit()))).collect();
            let weights = (0..count).map(|_| weight * random.unit()).collect();
            WeightedPoints { positions, weights, values: None }
        };
        let anywhere = |p: [f64; 3]| p;
        // With hidden points, and more than one range of vertices.
        let [hidden, _] = agree(weighted(9000, 0.002, &anywhere));
        assert!(hidden > 100, "{hidden}");
        // On a lattice, with points that are given twice.
        let on_lattice = |p: [f64; 3]| p.map(|x| (6.0 * x).floor());
        for count in [5, 8, 20, 100, 400] {
            agree(weighted(count, 0.0, &on_lattice));
            agree(weighted(count, 0.5, &on_lattice));
        }
        // All on the hull.
        let on_sphere = |p: [f64; 3]| {
            let [x, y, z] = p.map(|x| x - 0.5);
            let length = (x * x + y * y + z * z).sqrt();
            [x / length, y / length, z / length]
        };
        let [_, on_hull] = agree(weighted(500, 0.0, &on_sphere));
        assert_eq!(on_hull, 2 * 500 - 4);
    }
}
