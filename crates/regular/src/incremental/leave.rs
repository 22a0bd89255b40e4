//! How a point leaves: the cells around it go, and what the other points around it would have had
//! without it comes in their place.

use super::Builder;
use super::growing::{GHOST, NONE, State};
use crate::predicates::Screen;
use crate::{Cell, GONE, Triangulation, TriangulationError};

/// What comes in the place of the cells around a point.
pub struct Hole {
    /// The cells around the point.
    pub star: Vec<u32>,
    /// The cells that fill the hole; neighbours are 4·place in this list + corner.
    pub filling: Vec<Cell>,
    /// What lies outside: 4·place + corner, and 4·cell + corner of the triangulation.
    walls: Vec<[u32; 2]>,
}

/// What a look into a hole works with; kept so that the next need not allocate.
pub struct Workspace {
    builder: Builder,
    /// The facets of its cells: corners as [`facets`] has them, the smallest first, and 4·cell + corner.
    facets: Vec<([u32; 3], u32)>,
    /// By 4·cell + corner: what lies beyond, outside the hole, or [`NONE`].
    beyond: Vec<u32>,
    /// The place of each cell in the filling, or [`NONE`].
    places: Vec<u32>,
}

/// Points around a point, by and large.
const AROUND: usize = 32;

impl Workspace {
    /// For points with numbers below one.
    ///
    /// # Errors
    /// No memory.
    pub fn new(below: usize) -> Result<Self, TriangulationError> {
        let builder = Builder::empty(AROUND, below, GHOST)?;
        Ok(Self { builder, facets: Vec::new(), beyond: Vec::new(), places: Vec::new() })
    }

    /// Triangulates the points around a hole; `false` if these span no volume.
    fn triangulate(
        &mut self,
        screen: &Screen<'_>,
        points: &[u32],
    ) -> Result<bool, TriangulationError> {
        match self.builder.begin(screen, points.iter().copied()) {
            Err(TriangulationError::Sites(_)) => return Ok(false),
            begun => begun?,
        }
        for &v in points {
            if !self.builder.first.contains(&v) {
                self.builder.insert(screen, v)?;
            }
        }
        let cells = &mut self.builder.mesh.cells;
        self.builder.free.iter().for_each(|&gone| cells[gone as usize].corners[0] = GONE);
        self.facets.clear();
        for (number, cell) in cells.iter().enumerate().filter(|(_, cell)| cell.corners[0] != GONE) {
            let codes = (4 * number as u32..).zip(facets(cell.corners));
            self.facets.extend(codes.map(|(code, facet)| (smallest_first(facet), code)));
        }
        self.facets.sort_unstable();
        self.beyond.clear();
        self.beyond.resize(4 * cells.len(), NONE);
        self.places.clear();
        self.places.resize(cells.len(), NONE);
        Ok(true)
    }

    /// Collects the cells between the walls, and their neighbours.
    fn fill(&mut self, star: Vec<u32>, walls: &[([u32; 3], u32)]) -> Option<Hole> {
        let mut inside = Vec::new();
        for &(facet, outside) in walls {
            let found = self.facets.binary_search_by_key(&facet, |entry| entry.0).ok()?;
            let code = self.facets[found].1;
            self.beyond[code as usize] = outside;
            self.take(code / 4, &mut inside);
        }
        let (mut filling, mut walls) = (Vec::new(), Vec::new());
        while let Some(&cell) = inside.get(filling.len()) {
            let Cell { corners, mut neighbors } = self.builder.mesh.cells[cell as usize];
            for (corner, side) in (0..).zip(&mut neighbors) {
                let outside = self.beyond[4 * cell as usize + corner as usize];
                if outside == NONE {
                    *side = 4 * self.take(*side / 4, &mut inside) + *side % 4;
                } else {
                    walls.push([4 * filling.len() as u32 + corner, outside]);
                }
            }
            filling.push(Cell { corners, neighbors });
        }
        Some(Hole { star, filling, walls })
    }

    /// The place of a cell in the filling.
    fn take(&mut self, cell: u32, inside: &mut Vec<u32>) -> u32 {
        let place = &mut self.places[cell as usize];
        if *place == NONE {
            *place = inside.len() as u32;
            inside.push(cell);
        }
        *place
    }
}

impl State {
    /// What would come in the place of a vertex; `None` if the points around it span no volume.
    ///
    /// A cell in the hole has no other point in its sphere, so none of those around the hole: it is one of
    /// their own triangulation, of which the part between the walls is taken.
    pub(super) fn hole(
        &self,
        screen: &Screen<'_>,
        v: u32,
        workspace: &mut Workspace,
    ) -> Result<Option<Hole>, TriangulationError> {
        let (star, walls) = self.star(v);
        let corners = walls.iter().flat_map(|wall| wall.0);
        let mut around: Vec<u32> = corners.filter(|&w| w != GHOST).collect();
        around.sort_unstable();
        around.dedup();
        if !workspace.triangulate(screen, &around)? {
            return Ok(None);
        }
        Ok(workspace.fill(star, &walls))
    }

    /// The cells at a vertex, and for each their facet opposite to it with what lies beyond.
    fn star(&self, v: u32) -> (Vec<u32>, Vec<([u32; 3], u32)>) {
        let (mut star, mut walls) = (vec![self.at[v as usize]], Vec::new());
        while let Some(&cell) = star.get(walls.len()) {
            let Cell { corners, neighbors } = self.builder.mesh.cells[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if corners[k] == v {
                    walls.push((smallest_first(facets(corners)[k]), neighbors[k]));
                } else if !star.contains(&next) {
                    star.push(next);
                }
            }
        }
        (star, walls)
    }

    /// Puts the filling of a hole in the place of a vertex.
    pub(super) fn close(&mut self, v: u32, hole: &Hole) -> Result<(), TriangulationError> {
        let Hole { star, filling, walls } = hole;
        let mut places = star.clone();
        let builder = &mut self.builder;
        if places.len() > filling.len() {
            builder.free.extend(places.drain(filling.len()..));
        }
        while places.len() < filling.len() {
            places.push(match builder.free.pop() {
                Some(place) => place,
                None => builder.new_cell()?,
            });
        }
        for (Cell { corners, neighbors }, &place) in filling.iter().zip(&places) {
            let neighbors = neighbors.map(|side| match places.get(side as usize / 4) {
                Some(next) => 4 * next + side % 4,
                // Across a wall, which is joined below.
                None => 0,
            });
            builder.mesh.cells[place as usize] = Cell { corners: *corners, neighbors };
        }
        for &[inside, outside] in walls {
            builder.mesh.join(4 * places[inside as usize / 4] + inside % 4, outside);
        }
        builder.near = places[0];
        self.at[v as usize] = NONE;
        places.into_iter().for_each(|place| self.note(place));
        Ok(())
    }
}

impl Builder {
    fn new_cell(&mut self) -> Result<u32, TriangulationError> {
        let count = self.mesh.cells.len();
        if count == Triangulation::MOST_CELLS {
            return Err(TriangulationError::TooManyCells);
        }
        self.reserve(1)?;
        self.mesh.cells.push(Cell::default());
        self.marks.push(0);
        Ok(count as u32)
    }
}

/// The facets opposite the corners of a cell. With that corner behind them they make the cell, positively
/// oriented; so two cells on one side of a facet have it in one orientation.
fn facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, d, c], [a, c, d], [b, a, d], [a, b, c]]
}

/// The rotation that begins with the smallest.
fn smallest_first(mut facet: [u32; 3]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&k| facet[k]).unwrap_or(0);
    facet.rotate_left(first);
    facet
}
