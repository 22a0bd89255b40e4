//! What a picture of all levels shows, laid out in space.

use std::borrow::Cow;

use walpha_base::vector::{along, dot, scale, unit};

use super::{Filtration, Levels, Span};
use crate::copies::Copier;
use crate::{Torus, WeightedPoints};

/// What a picture of all [levels](Levels) shows. On a torus each simplex is laid out in space as by
/// [`AlphaShape::unwrapped`](crate::AlphaShape::unwrapped), with copies of points beyond the upper sides of the box.
#[doc(hidden)]
#[derive(Debug)]
pub struct Drawn<'a> {
    /// The points, then copies of them.
    pub points: Cow<'a, WeightedPoints>,
    /// The point that each copy is of.
    pub copies: Vec<u32>,
    /// As [`Levels::facets`].
    pub facets: Vec<([u32; 3], Span)>,
    /// As [`Levels::singular_edges`].
    pub edges: Vec<([u32; 2], Span)>,
    /// As [`Levels::vertices`], then the copies that are vertices.
    pub vertices: Vec<(u32, Span)>,
    /// The facets around the first [voids](Levels::voids) of each level, corners counter-clockwise seen from outside the void. A facet with
    /// the void on both sides hangs into it, and is not listed.
    pub voids: Vec<Vec<Vec<[u32; 3]>>>,
}

impl Levels<'_> {
    /// What a picture shows, with this many voids of each level at most. O(n α(n)), the number of cells of the voids, and on a torus O(n log n).
    #[doc(hidden)]
    pub fn drawn(&self, most_voids: usize) -> Drawn<'_> {
        let (points, mut facets) = (Cow::Borrowed(self.points()), self.facets());
        let (mut edges, mut vertices) = (self.singular_edges(), self.vertices());
        let mut voids = self.void_facets(most_voids);
        let Some(torus) = self.filtration.torus() else {
            return Drawn { points, copies: Vec::new(), facets, edges, vertices, voids };
        };
        let whole = &self.filtration.whole;
        let own = whole.own_points();
        let mut copier = Copier::new(own);
        facets.iter_mut().for_each(|(row, _)| *row = copier.lay_out(whole, *row));
        edges.iter_mut().for_each(|(row, _)| *row = copier.lay_out(whole, *row));
        let of_voids = voids.iter_mut().flatten().flatten();
        of_voids.for_each(|row| *row = copier.lay_out(whole, *row));
        let mut points = points.into_owned();
        points.set_copies(own, torus, &copier.copied);
        let copies: Vec<u32> = copier.copied.iter().map(|(v, _)| *v).collect();
        let mut spans = vec![None; own];
        vertices.iter().for_each(|&(v, span)| spans[v as usize] = Some(span));
        let copied = (own as u32..).zip(&copies);
        vertices.extend(copied.filter_map(|(copy, &v)| Some((copy, spans[v as usize]?))));
        Drawn { points: Cow::Owned(points), copies, facets, edges, vertices, voids }
    }
}

impl Filtration {
    /// The corners of a simplex as [`Drawn`] lays it out.
    #[doc(hidden)]
    pub fn places<const N: usize>(&self, row: [u32; N]) -> [[f64; 3]; N] {
        let positions = self.points().positions();
        let Some(torus) = self.torus() else { return row.map(|v| positions[v as usize]) };
        self.whole.laid_out(row).map(|(v, way)| torus.moved(positions[v as usize], way))
    }
}

/// The frame of a periodic box around these places: its origin and its three vectors. Across a slab or a rod, it is as large as
/// the places need it.
#[doc(hidden)]
pub fn frame_of<'a>(
    torus: Torus,
    places: impl Iterator<Item = &'a [f64; 3]> + Clone,
) -> [[f64; 3]; 4] {
    let mut vectors = torus.vectors();
    let mut origin = [0.0; 3];
    for k in 0..3 {
        if torus.repeats()[k] {
            continue;
        }
        // Perpendicular to the vectors that are there, and near an axis: the longest of what is left of the axes.
        let rest = |axis: usize| {
            let mut rest = [0.0; 3];
            rest[axis] = 1.0;
            // Twice, since vectors may be far from perpendicular to each other.
            for _ in 0..2 {
                for vector in vectors {
                    let share = dot(rest, vector) / dot(vector, vector).max(f64::MIN_POSITIVE);
                    rest = along(rest, -share, vector);
                }
            }
            rest
        };
        let longest =
            [0, 1, 2].map(rest).into_iter().max_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
        let Some(direction) = longest.and_then(unit) else { continue };
        let heights = places.clone().map(|p| dot(*p, direction));
        let (low, high) = heights
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (h.min(low), h.max(high)));
        if low <= high {
            origin = along(origin, low, direction);
            vectors[k] = scale(direction, high - low);
        }
    }
    [origin, vectors[0], vectors[1], vectors[2]]
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;
    use crate::ladder::{Filtration, random_points};
    use crate::{Alpha, Class};

    /// The corners of a row, in order: what is drawn, whatever the numbers of copies.
    fn placed<const N: usize>(points: &WeightedPoints, row: [u32; N]) -> [[u64; 3]; N] {
        let mut places = row.map(|v| points.positions()[v as usize].map(f64::to_bits));
        places.sort_unstable();
        places
    }

    /// At each level facets, edges and vertices are laid out as the shape itself is, in large boxes and in small ones, in slabs and in space.
    #[test]
    fn each_level_is_drawn_as_its_shape() {
        let (mut crossing, mut hollow) = (0, 0);
        for (seed, count, size) in [(1, 1, 1.0), (2, 5, 2.0), (3, 120, 4.0)] {
            for repeats in [[true; 3], [true, true, false], [false; 3]] {
                let vectors = [[size, 0.0, 0.0], [0.25, size, 0.0], [0.0, -0.25, size]];
                let torus = repeats.contains(&true);
                let torus = torus.then(|| Torus::repeating(vectors, repeats).unwrap());
                let points = random_points(seed, count, 0.5);
                let filtration = Filtration::on(torus, points).unwrap();
                let alphas = [0.05, 0.2, 0.4, 1.0, f64::INFINITY];
                let levels = filtration.levels(&alphas.map(|a| Alpha::from_squared(a).unwrap()));
                let drawn = levels.drawn(usize::MAX);
                assert_eq!(drawn.points.len(), levels.own_points() + drawn.copies.len());
                crossing += drawn.copies.len();
                for level in 0..levels.len() as u32 {
                    let shape = filtration.shape(levels.alphas()[level as usize]).unwrapped();
                    for class in [Class::Regular, Class::Singular] {
                        let rows =
                            drawn.facets.iter().filter(|(_, span)| span.class(level) == class);
                        let rows: Vec<_> =
                            rows.map(|(row, _)| placed(&drawn.points, *row)).collect();
                        let expected = (shape.complex().facets.of(class))
                            .map(|row| placed(shape.points(), *row));
                        let expected: BTreeSet<_> = expected.collect();
                        assert_eq!(rows.len(), expected.len());
                        assert_eq!(rows.into_iter().collect::<BTreeSet<_>>(), expected);
                    }
                    let rows =
                        drawn.edges.iter().filter(|(_, span)| span.class(level) == Class::Singular);
                    let rows: BTreeSet<_> =
                        rows.map(|(row, _)| placed(&drawn.points, *row)).collect();
                    let expected = shape.complex().edges.of(Class::Singular);
                    let expected: BTreeSet<_> =
                        expected.map(|row| placed(shape.points(), *row)).collect();
                    assert_eq!(rows, expected);
                    let facets: BTreeSet<_> = (shape.complex().facets.rows().iter())
                        .map(|row| placed(shape.points(), *row))
                        .collect();
                    for (&row, _) in
                        filtration.shape(levels.alphas()[level as usize]).complex().facets.iter()
                    {
                        let mut places = filtration.places(row).map(|p| p.map(f64::to_bits));
                        places.sort_unstable();
                        assert!(facets.contains(&places));
                    }
                    for row in drawn.voids[level as usize].iter().flatten() {
                        assert!(facets.contains(&placed(&drawn.points, *row)));
                        hollow += 1;
                    }
                    // A copy has the class of its point.
                    let own = levels.own_points();
                    let classes: BTreeMap<u32, Class> =
                        shape.complex().vertices.iter().map(|(&[v], class)| (v, class)).collect();
                    for &(v, span) in &drawn.vertices {
                        let of = (v as usize).checked_sub(own).map_or(v, |copy| drawn.copies[copy]);
                        let class = classes.get(&of).copied().unwrap_or(Class::Exterior);
                        assert_eq!(span.class(level), class);
                    }
                }
            }
        }
        assert!(crossing > 100 && hollow > 20, "{crossing} {hollow}");
    }
}
