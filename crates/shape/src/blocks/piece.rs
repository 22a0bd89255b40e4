//! A block alone: what it owns of a shape whose other blocks are elsewhere.

use walpha_base::Monitor;
use walpha_base::UnionFind;
use walpha_regular::Lattice;
use walpha_regular::Sites;

use super::classify::{Dimension, Owned, Shelves, classify};
use super::partition::Neighbourhood;
use super::spanning::spanning;
use super::{Block, Question};
use crate::{Class, Complex, ShapeError, Simplices};

/// Points around a block, in the order of their indices in the whole set, with weights.
#[derive(Clone, Copy)]
pub struct Own<'a> {
    /// Where they are.
    pub positions: &'a [[f64; 3]],
    /// Power weights.
    pub weights: &'a [f64],
    /// Which of them are the block's own; the others are all that may be in its halo, and perhaps more.
    pub own: &'a [bool],
}

/// What a block owns, in canonical order, and what others need to know of it. Points are numbered by their
/// place among those given; sheets and components from 0 within the block.
#[derive(Default)]
pub struct BlockShape {
    /// The simplices that the block owns.
    pub complex: Complex,
    /// The sheet of each regular facet and the two of each singular one, in the order of the facets.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge, in their order.
    pub edge_sheets: Vec<u32>,
    /// How many sheets there are.
    pub sheets: u32,
    /// Sides of facets, and singular edges, that touch points of other blocks, too.
    pub shared: Vec<Side>,
    /// For each point the smallest of its component, as far as it is known here.
    pub components: Vec<u32>,
    /// The ends of the edges between points of this block and of others, ascending.
    pub border: Vec<u32>,
    /// How many points were in the halo.
    pub halo: u64,
}

pub use super::classify::Side;

/// Finds what a block owns of the α-complex. `alpha` is what power weights are judged by.
///
/// # Errors
/// Numbers that are none, two points at one place, no memory.
pub fn block_shape(points: Own<'_>, alpha: f64) -> Result<BlockShape, ShapeError> {
    let Own { positions, weights, own } = points;
    if !own.contains(&true) {
        return Ok(BlockShape::default());
    }
    let mut block = block(points, alpha)?;
    let halo = block.input.len() as u64 - u64::from(block.own);
    let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Any α below −max ω asks for the empty shape, and doubles hold one.
    let alpha = alpha.max(-2.0 * largest.abs() - 1.0);
    let made = spanning(&mut block, alpha, positions.len() as u32, &Monitor::silent().units(1))?;
    let lattice = Lattice::of(&block.positions, &block.weights);
    let question = Question { alpha, lattice, exterior: false };
    let owned = classify(&block, made, &question, Shelves::new(&[], 1));
    Ok(BlockShape { halo, ..ordered(owned, &block, positions.len()) })
}

/// The block's own points, then its halo, each along the curve.
fn block(points: Own<'_>, alpha: f64) -> Result<Block, ShapeError> {
    let Own { positions, weights, own } = points;
    let at = |i: usize| (positions[i], weights[i]);
    let owned = (0..own.len()).filter(|&i| own[i]).map(at);
    let around = Neighbourhood::of(owned, alpha);
    let is_near =
        |&i: &u32| own[i as usize] || around.holds(positions[i as usize], weights[i as usize]);
    let near: Vec<u32> = (0..positions.len() as u32).filter(is_near).collect();
    let positions: Vec<_> = near.iter().map(|&i| positions[i as usize]).collect();
    let weights: Vec<_> = near.iter().map(|&i| weights[i as usize]).collect();
    let sites = Sites::any(&positions, &weights)?;
    if let Some(&[a, b]) = sites.duplicates().first() {
        let at = sites.positions()[b.min(a) as usize];
        return Err(ShapeError::Coincident { at });
    }
    let is_own = |&&site: &&u32| own[near[site as usize] as usize];
    let (owned, halo): (Vec<u32>, Vec<u32>) = sites.curve().iter().partition(is_own);
    let all = || owned.iter().chain(&halo).map(|&site| site as usize);
    Ok(Block {
        positions: all().map(|site| positions[site]).collect(),
        weights: all().map(|site| weights[site]).collect(),
        input: all().map(|site| near[site]).collect(),
        own: owned.len() as u32,
        copies: None,
    })
}

/// Rows in the order of their smallest points; `points` are given.
fn ordered(owned: Owned, block: &Block, points: usize) -> BlockShape {
    let Owned { mut shelves, sheets, shared, joined, mut border, .. } = owned;
    let shelf = shelves.pop().expect("there is one");
    let mut order: Vec<u32> = (0..block.own).collect();
    order.sort_unstable_by_key(|&v| block.input[v as usize]);
    let mut piece = BlockShape { sheets, shared, ..BlockShape::default() };
    let (mut cells, mut facets, mut edges, mut vertices) = (
        Simplices::<4>::default(),
        Simplices::<3>::default(),
        Simplices::<2>::default(),
        Simplices::<1>::default(),
    );
    for v in order {
        let a = block.input[v as usize];
        let rows = |dimension: Dimension| {
            let start = |v: usize| shelf.starts[v][dimension as usize] as usize;
            start(v as usize)..start(v as usize + 1)
        };
        for i in rows(Dimension::Cells) {
            let [b, c, d] = shelf.cells.vertices[i];
            cells.push([a, b, c, d], shelf.cells.classes[i]);
        }
        for i in rows(Dimension::Facets) {
            let [b, c] = shelf.facets.vertices[i];
            facets.push([a, b, c], shelf.facets.classes[i]);
        }
        for i in rows(Dimension::Edges) {
            edges.push([a, shelf.edges.vertices[i][0]], shelf.edges.classes[i]);
        }
        piece.facet_sheets.extend(&shelf.facet_sheets[rows(Dimension::FacetSheets)]);
        piece.edge_sheets.extend(&shelf.edge_sheets[rows(Dimension::EdgeSheets)]);
        match shelf.vertices[v as usize] {
            None | Some(Class::Exterior) => {}
            Some(class) => vertices.push([a], class),
        }
    }
    piece.complex = Complex { cells, facets, edges, vertices };
    // The places beside that may have been added are in no component of others.
    let mut sets = UnionFind::new(points + 3);
    joined.into_iter().for_each(|[a, b]| _ = sets.unite(a, b));
    piece.components = (0..points as u32).map(|i| sets.find(i)).collect();
    border.sort_unstable();
    border.dedup();
    piece.border = border;
    piece
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squared lengths may be below zero; below all weights there is nothing.
    #[test]
    fn nothing_is_in_the_shape_below_all_weights() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for (alpha, weight, vertices) in [
            (f64::NEG_INFINITY, 0.0, 0),
            (f64::NEG_INFINITY, -3.0, 0),
            (-0.25, 0.0, 0),
            (-0.25, 0.25, 4),
            (3.0, -3.0, 4),
        ] {
            let points = Own { positions: &positions, weights: &[weight; 4], own: &[true; 4] };
            let found = block_shape(points, alpha).unwrap();
            assert_eq!(found.complex.vertices.len(), vertices, "{alpha} {weight}");
            assert!(found.complex.cells.is_empty());
        }
    }
}
