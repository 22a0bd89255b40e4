//! Point sets, and what the CGAL engine makes of them.
#![allow(dead_code, reason = "each test file uses its part")]

use std::collections::BTreeSet;

use walpha::shape::{Engine, ShapeError, ShapeOptions};
use walpha::{Alpha, Class, Complex, Simplices, WeightedPoints, alpha_shape};

/// A small set of weighted points and a parameter.
#[derive(Clone, Debug)]
pub struct Case {
    pub positions: Vec<[f64; 3]>,
    pub weights: Vec<f64>,
    pub alpha: f64,
}

/// What an engine makes of a case.
#[derive(Debug, PartialEq)]
pub struct Answer {
    pub complex: Complex,
    pub hidden: Vec<u32>,
    pub duplicates: Vec<[u32; 2]>,
}

/// CGAL's own answer: the whole triangulation.
pub fn engine(case: &Case) -> Result<Answer, ShapeError> {
    engine_of(case, Engine::Reference)
}

/// An engine's answer: the whole triangulation.
pub fn engine_of(case: &Case, engine: Engine) -> Result<Answer, ShapeError> {
    let Case { positions, weights, alpha } = case.clone();
    let alpha = Alpha::from_squared(alpha).expect("α is no NaN");
    let options = ShapeOptions { exterior: true, engine, ..ShapeOptions::new(alpha) };
    let shape = alpha_shape(WeightedPoints { positions, weights, values: None }, &options)?;
    Ok(Answer {
        complex: shape.complex().clone(),
        hidden: shape.hidden().expect("the whole triangulation was seen").to_vec(),
        duplicates: shape.duplicates().to_vec(),
    })
}

/// SplitMix64: the same numbers everywhere.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// A double in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }

    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }
}

/// The points of an n³ integer grid.
pub fn grid(n: usize) -> Vec<[f64; 3]> {
    let axis = move || 0..n;
    axis()
        .flat_map(|z| axis().flat_map(move |y| axis().map(move |x| [x, y, z])))
        .map(|p| p.map(|i| i as f64))
        .collect()
}

/// The shape alone: what a local engine returns.
pub fn shape_of(answer: &Answer) -> Answer {
    fn members<const N: usize>(all: &Simplices<N>) -> Simplices<N> {
        let rows = all.iter().filter(|(_, class)| *class != Class::Exterior);
        let (vertices, classes) = rows.map(|(row, class)| (*row, class)).unzip();
        Simplices { vertices, classes }
    }
    let complex = Complex {
        cells: members(&answer.complex.cells),
        facets: members(&answer.complex.facets),
        edges: members(&answer.complex.edges),
        vertices: members(&answer.complex.vertices),
    };
    Answer { complex, hidden: answer.hidden.clone(), duplicates: answer.duplicates.clone() }
}

/// The complex of cells and all their faces, every class exterior.
pub fn closed(cells: &[[u32; 4]]) -> Complex {
    fn exterior<const N: usize>(rows: impl IntoIterator<Item = Vec<u32>>) -> Simplices<N> {
        let rows = rows.into_iter().map(|mut row| {
            row.sort_unstable();
            row.try_into().expect("N vertices")
        });
        let vertices: Vec<[u32; N]> = BTreeSet::from_iter(rows).into_iter().collect();
        Simplices { classes: vec![Class::Exterior; vertices.len()], vertices }
    }
    let faces = |size: u32| {
        cells.iter().flat_map(move |cell| {
            (0u32..16).filter(move |mask| mask.count_ones() == size).map(move |mask| {
                (0..4).filter(|k| mask >> k & 1 == 1).map(|k: usize| cell[k]).collect::<Vec<u32>>()
            })
        })
    };
    Complex {
        cells: Simplices { vertices: cells.to_vec(), classes: vec![Class::Exterior; cells.len()] },
        facets: exterior(faces(3)),
        edges: exterior(faces(2)),
        vertices: exterior(faces(1)),
    }
}
