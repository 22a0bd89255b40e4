//! Figure 6: the shape without weights, and whether at α = ∞ its boundary is the convex hull, by definition.

use walpha_base::vector::{cross, dot, sub};

use super::bench::{Bench, Claim, figure, judge};
use crate::reproduce::study::{ALPHA, Shapes, Shared};
use crate::reproduce::{Fact, Item, ReproduceError, ShapeNumbers, Table, Verdict, text};
use crate::shape::{AlphaShape, Class};

/// The unweighted shapes by ascending α, the last of which is ∞.
struct Evidence {
    ladder: Vec<ShapeNumbers>,
    /// The boundary at α = ∞.
    hull: Hull,
}

impl Evidence {
    fn of(shapes: &Shapes) -> Self {
        let ladder = shapes.by_alpha();
        let hull = Hull::of(&shapes[Shared::Hull].shape);
        Self { hull, ladder: ladder.map(|shaped| shaped.numbers.clone()).into() }
    }

    fn smallest(&self) -> &ShapeNumbers {
        &self.ladder[0]
    }

    fn largest(&self) -> &ShapeNumbers {
        &self.ladder[self.ladder.len() - 1]
    }

    /// The shape with the most voids.
    fn hollow(&self) -> &ShapeNumbers {
        self.ladder.iter().max_by_key(|n| n.betti.b2).expect("a ladder has steps")
    }

    /// Whether no shape has less volume than the one before, and the last has more than the first.
    fn grows(&self) -> bool {
        self.ladder.windows(2).all(|pair| pair[0].volume <= pair[1].volume)
            && self.smallest().volume < self.largest().volume
    }

    fn table(&self) -> Table {
        let rows = self.ladder.iter().map(|n| {
            let cells = [n.cells as u64, n.betti.b0, n.betti.b1, n.betti.b2].map(|v| v.to_string());
            let sizes = [n.volume, n.void_volume].map(text::number);
            [&[text::number(n.alpha.squared())], &cells[..], &sizes].concat()
        });
        Table {
            caption: "The unweighted shape at other α (squared lengths)".into(),
            head: ["α", "cells", "b0", "b1", "b2", "volume", "volume of voids"]
                .map(String::from)
                .into(),
            rows: rows.collect(),
        }
    }
}

const CLAIMS: [Claim<Evidence>; 3] = [
    Claim {
        text: "As α increases the shape expands, as it decreases it shrinks.",
        decide: |e| {
            let (small, large) = (e.smallest(), e.largest());
            let reason = format!(
                "the volume goes from {} at α = {} to {} at α = {}, without a step back",
                text::number(small.volume),
                text::number(small.alpha.squared()),
                text::number(large.volume),
                text::number(large.alpha.squared())
            );
            (Verdict::of(e.grows()), reason)
        },
    },
    Claim {
        text: "As α decreases the shape develops cavities.",
        decide: |e| {
            let (hollow, largest) = (e.hollow(), e.largest());
            let reason = format!(
                "{} at α = ∞, {} at α = {}",
                text::count(largest.betti.b2, "void", "voids"),
                text::count(hollow.betti.b2, "void", "voids"),
                text::number(hollow.alpha.squared())
            );
            (Verdict::of(hollow.betti.b2 > largest.betti.b2), reason)
        },
    },
    Claim {
        text: "For α = ∞ the α-shape is the convex hull of the points.",
        decide: |Evidence { ladder, hull }| {
            let largest = &ladder[ladder.len() - 1];
            // The facets' determinants are whole numbers; so are the cells'.
            let same = (hull.volume - largest.volume).abs() <= 1e-9 * largest.volume;
            let reason = format!(
                "{} of {} points lie beyond one of the {} boundary facets at α = ∞; the facets \
                 enclose {}, the cells fill {}",
                hull.outside,
                largest.points,
                hull.facets,
                text::number(hull.volume),
                text::number(largest.volume)
            );
            (Verdict::of(hull.outside == 0 && same), reason)
        },
    },
];

/// Figure 6: ω = 0, and how the shape depends on α.
pub(super) fn figure_6(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let plain = &bench.shapes[Shared::Plain];
    let evidence = Evidence::of(bench.shapes);
    let title = format!("Figure 6. Common factor 0, α = {ALPHA} (√α = {:.3} voxels)", ALPHA.sqrt());
    let drawn = figure(&title, bench.two_views(plain)?);
    Ok(Item {
        title: "Figure 6. Common factor 0".into(),
        paper: "All points weigh 0: the unweighted α-shape, at α = 10. It shrinks and develops \
                cavities as α decreases, and becomes the convex hull as α grows."
            .into(),
        ours:
            "The boundary of the shape, from two sides. The paper prints no count to compare with; \
               ours are below."
                .into(),
        picture: Some(bench.file("figure-06.png", drawn.to_png()?)),
        commands: vec![plain.makes("figure-06.ply")],
        files: vec![bench.mesh("figure-06.ply", plain)?],
        shapes: vec![plain.numbers.clone()],
        facts: vec![
            Fact::new("volume of the convex hull, by its facets", evidence.hull.volume),
            Fact::count("facets of the convex hull", evidence.hull.facets),
        ],
        tables: vec![evidence.table()],
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

/// A closed surface, and the points whose hull it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hull {
    /// Its facets.
    pub facets: usize,
    /// The number of points on the wrong side of a facet: 0 if the surface is convex and contains all points.
    pub outside: usize,
    /// The volume that the facets enclose (divergence theorem), not the sum of the cells.
    pub volume: f64,
}

impl Hull {
    /// Judges the regular facets of a shape. Each point is tested against each plane; signs are
    /// exact for coordinates that are whole numbers below 10⁵, as those of voxels are.
    pub(super) fn of(shape: &AlphaShape) -> Self {
        let positions = shape.points().positions();
        let mut planes: Vec<([f64; 3], f64)> = Vec::new();
        let mut sixfold = 0.0;
        for facet in shape.complex().facets.of(Class::Regular) {
            let [a, b, c] = facet.map(|v| positions[v as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            sixfold += dot(normal, a);
            planes.push((normal, dot(normal, a)));
        }
        let beyond = |p: &&[f64; 3]| planes.iter().any(|&(normal, at)| dot(normal, **p) > at);
        let outside = positions.iter().filter(beyond).count();
        Self { facets: planes.len(), outside, volume: sixfold / 6.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::WeightedPoints;
    use crate::shape::{Alpha, ShapeOptions, alpha_shape};

    /// Arms two squares wide around a notch of two by two, one cube high.
    #[test]
    fn an_l_is_not_its_hull() {
        let lattice = (0..32).map(|i| [i % 4, i / 4 % 4, i / 16]);
        let positions: Vec<_> =
            lattice.filter(|p| p[0] < 2 || p[1] < 2).map(|p| p.map(f64::from)).collect();
        let points = WeightedPoints::unweighted(positions);
        let at = |alpha| {
            let options = ShapeOptions::new(alpha);
            Hull::of(&alpha_shape(points.clone(), &options).unwrap())
        };
        let hull = at(Alpha::INFINITE);
        assert_eq!((hull.outside, hull.volume), (0, 7.0));
        // Five cubes, and half of the one in the inner corner.
        let shape = at(Alpha::from_squared(0.75).unwrap());
        assert_eq!(shape.volume, 5.5);
        assert!(shape.outside > 0);
    }
}
