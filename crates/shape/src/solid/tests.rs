//! Solids as a reader sees them who takes equal coordinates for one vertex.

use std::collections::BTreeMap;

use walpha_base::random::Random;
use walpha_complex::Voxels;

use super::boxes::{Boxes, bounds};
use super::crossing::cross;
use super::*;
use crate::{Alpha, ShapeOptions, alpha_shape, voxel_shape};

type Point = [f64; 3];

/// The facets of a solid, by vertices that are numbered by their coordinates.
fn merged(facets: &[[u32; 3]], places: &[Point]) -> Surface {
    let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut number = |v: u32| {
        // Adding 0 turns −0 into 0.
        let key = places[v as usize].map(|x| (x + 0.0).to_bits());
        let next = numbers.len() as u32;
        *numbers.entry(key).or_insert(next)
    };
    let regular: Vec<[u32; 3]> = facets.iter().map(|row| row.map(&mut number)).collect();
    Surface { vertices: (0..numbers.len() as u32).collect(), regular, ..Surface::default() }
}

/// Each edge is on two facets, which go along it in opposite directions, and around each vertex is one fan.
fn is_manifold(surface: &Surface) -> bool {
    let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for [a, b, c] in &surface.regular {
        for edge in [[*a, *b], [*b, *c], [*c, *a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    let paired = edges.iter().all(|([a, b], n)| *n == 1 && edges.get(&[*b, *a]) == Some(&1));
    paired && surface.manifold_defects().is_empty()
}

/// Pairs of facets that cross each other.
fn crossings(facets: &[[u32; 3]], places: &[Point]) -> usize {
    let corners = |row: &[u32; 3]| row.map(|v| places[v as usize]);
    let boxes: Vec<_> = facets.iter().map(|row| bounds(corners(row))).collect();
    let tree = Boxes::new(boxes.iter().copied());
    let of_facet = |(i, row): (usize, &[u32; 3])| {
        let after = tree.near(boxes[i]).into_iter().filter(|&j| j as usize > i);
        after.filter(|&j| cross(corners(row), corners(&facets[j as usize]))).count()
    };
    facets.iter().enumerate().map(of_facet).sum()
}

fn volume(facets: &[[u32; 3]], places: &[Point]) -> f64 {
    let of_facet = |row: &[u32; 3]| {
        let [a, b, c] = row.map(|v| places[v as usize]);
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        (a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)) / 6.0
    };
    facets.iter().map(of_facet).sum()
}

fn points(points: &[Point], alpha: f64) -> AlphaShape {
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(alpha).unwrap())).unwrap()
}

#[test]
fn statistics() {
    let mut random = Random::new(1);
    let mut sum = Cuts::default();
    for i in 0..60 {
        let kind = i % 3;
        let shape = match kind {
            0 => {
                let places: Vec<Point> = (0..300).map(|_| [0; 3].map(|_| random.unit())).collect();
                points(&places, 0.002 + 0.001 * (i / 3) as f64)
            }
            1 => {
                let share = 0.2 + 0.03 * (i / 3) as f64;
                let grid = (0..729).map(|i| [i % 9, i / 9 % 9, i / 81].map(f64::from));
                let chosen: Vec<Point> = grid.filter(|_| random.unit() < share).collect();
                points(&chosen, random.pick(&[0.75, 0.8, 1.0, 1.5]))
            }
            _ => {
                let share = 0.05 + 0.045 * (i / 3) as f64;
                let runs = (0..512).filter(|_| random.unit() < share).map(|v| [v, 1]).collect();
                let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                let voxels = Voxels { dims: [8; 3], origin: [0.5; 3], axes, runs };
                voxel_shape(voxels, |_| 0.0).unwrap()
            }
        };
        let (solid, cuts) = shape.solid();
        let places: Vec<Point> = solid.positions(shape.points().positions()).collect();
        let before: Vec<Point> = solid.unmoved(shape.points().positions()).collect();
        let merged = merged(&solid.regular, &places);
        let [old, new] = [&before, &places].map(|places| volume(&solid.regular, places));
        println!(
            "{kind} {cuts:?} manifold {} crossings {} -> {} volume {:.5}%",
            is_manifold(&merged),
            crossings(&solid.regular, &before),
            crossings(&solid.regular, &places),
            100.0 * (new / old - 1.0)
        );
        sum.vertices += cuts.vertices;
        sum.together += cuts.together;
        sum.midpoints += cuts.midpoints;
    }
    println!("{sum:?}");
}
