//! Point sets, and what the definition makes of them.
#![allow(unreachable_pub, reason = "the tests of walpha have this module too")]

use std::collections::BTreeSet;

use walpha_check::{
    Alpha, Claim, Class, Complex, EnumerateError, Extent, Finding, Placed, Simplices, enumerate,
};

/// A small set of weighted points and a parameter.
#[derive(Clone, Debug)]
pub struct Case {
    pub positions: Vec<[f64; 3]>,
    pub weights: Vec<f64>,
    pub alpha: f64,
}

impl Case {
    pub fn alpha(&self) -> Alpha {
        Alpha::from_squared(self.alpha).expect("α is not NaN")
    }

    /// A complex over the points.
    pub fn placed<'a>(&'a self, complex: &'a Complex) -> Placed<'a> {
        Placed::new(&self.positions, &self.weights, self.alpha(), complex)
    }

    /// The claim of an answer.
    pub fn claim<'a>(&'a self, answer: &'a Answer, extent: Extent) -> Claim<'a> {
        Claim::new(self.placed(&answer.complex))
            .with_extent(extent)
            .with_hidden(&answer.hidden[..])
            .with_duplicates(&answer.duplicates[..])
    }

    /// The findings for an answer.
    pub fn findings(&self, answer: &Answer, extent: Extent) -> Vec<Finding> {
        self.claim(answer, extent).findings().unwrap().0
    }
}

/// The result of an engine for a case, or of the definition.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub complex: Complex,
    pub hidden: Vec<u32>,
    pub duplicates: Vec<[u32; 2]>,
}

impl Answer {
    /// An answer without hidden points and duplicates.
    pub fn of(complex: Complex) -> Self {
        Self { complex, hidden: Vec::new(), duplicates: Vec::new() }
    }

    /// Another complex with the same hidden points and duplicates.
    pub fn with(&self, complex: Complex) -> Self {
        Self { complex, ..self.clone() }
    }
}

/// The whole triangulation from its definition.
pub fn definition(case: &Case) -> Result<Answer, EnumerateError> {
    let made = enumerate(&case.positions, &case.weights, case.alpha())?;
    Ok(Answer { complex: made.complex, hidden: made.hidden, duplicates: made.duplicates })
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
    let mut shape = answer.clone();
    shape.complex.retain_shape();
    shape
}

/// The complex of cells and all their faces, every class exterior.
pub fn closed(cells: &[[u32; 4]]) -> Complex {
    fn exterior<const N: usize>(rows: impl IntoIterator<Item = Vec<u32>>) -> Simplices<N> {
        let rows = rows.into_iter().map(|row| sorted(&row).try_into().expect("N vertices"));
        rows.collect::<BTreeSet<_>>().into_iter().map(|row| (row, Class::Exterior)).collect()
    }
    let faces = |size: u32| {
        cells.iter().flat_map(move |cell| {
            (0u32..16).filter(move |mask| mask.count_ones() == size).map(move |mask| {
                (0..4).filter(|k| mask >> k & 1 == 1).map(|k: usize| cell[k]).collect::<Vec<u32>>()
            })
        })
    };
    Complex {
        cells: cells.iter().map(|&cell| (cell, Class::Exterior)).collect(),
        facets: exterior(faces(3)),
        edges: exterior(faces(2)),
        vertices: exterior(faces(1)),
    }
}

/// Removes a row, if it exists, and returns its vertices in ascending order.
pub fn drop_row<const N: usize>(simplices: &mut Simplices<N>, row: usize) -> Option<Vec<u32>> {
    let dropped = sorted(simplices.rows().get(row)?);
    let rest = std::mem::take(simplices).into_iter().enumerate();
    *simplices = rest.filter(|&(i, _)| i != row).map(|(_, pair)| pair).collect();
    Some(dropped)
}

pub fn sorted(row: &[u32]) -> Vec<u32> {
    let mut row = row.to_vec();
    row.sort_unstable();
    row
}
