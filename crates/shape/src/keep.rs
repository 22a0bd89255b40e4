//! Some of the components of a shape, without the others.

use std::cmp::Reverse;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::advice::{Advice, Advise};
use walpha_base::setters;
use walpha_base::shown::counted;
use walpha_base::sort::sort_by_key;
use walpha_complex::canonical::{ByRow as _, sorted};

use super::components::NO_COMPONENT;
use super::topology::{direct_betti, flat_betti, sheet_betti};
use super::{AlphaShape, Class, Complex, Component, Sheets, Simplices};

/// Which components of a shape to keep. By default all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Keep {
    /// This many of the largest, as `--keep` names them. Components are compared by their volumes; those of equal volume, by the area of their
    /// facets, regular and singular, then by their numbers of vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest: Option<Largest>,
    /// Those of at least this volume, in cubed units of the points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_volume: Option<f64>,
}

impl Keep {
    setters! { largest: Option<Largest>, min_volume: Option<f64> }

    /// Whether all components are kept.
    pub fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// For each component whether it is kept.
    fn choose(&self, components: &[Component]) -> Vec<bool> {
        let least = self.min_volume.unwrap_or(f64::NEG_INFINITY);
        let mut chosen: Vec<usize> =
            (0..components.len()).filter(|&n| components[n].volume >= least).collect();
        if let Some(Largest(count)) = self.largest {
            // No size is NaN or −0, so their bits are in the order of the numbers.
            let size = |n: &usize| {
                let Component { volume, area, vertices, .. } = components[*n];
                Reverse((volume.to_bits(), area.to_bits(), vertices))
            };
            // Stable: of equal components the one with the smallest vertex comes first.
            sort_by_key(&mut chosen, size);
            chosen.truncate(count as usize);
        }
        let mut kept = vec![false; components.len()];
        chosen.into_iter().for_each(|n| kept[n] = true);
        kept
    }
}

/// A number of components, at least 1. As text a number, or `largest` for 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub struct Largest(u32);

/// A number of components that is not one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a number of components")]
pub struct KeepError(String);

impl Advise for KeepError {
    fn advice(&self) -> Option<Advice> {
        Some("give largest, or how many of the largest to keep, as in 3".into())
    }
}

impl TryFrom<u32> for Largest {
    type Error = KeepError;

    fn try_from(count: u32) -> Result<Self, KeepError> {
        if count == 0 { Err(KeepError(count.to_string())) } else { Ok(Self(count)) }
    }
}

impl From<Largest> for u32 {
    fn from(largest: Largest) -> Self {
        largest.0
    }
}

impl FromStr for Largest {
    type Err = KeepError;

    fn from_str(text: &str) -> Result<Self, KeepError> {
        if text == "largest" {
            return Ok(Self(1));
        }
        text.parse()
            .ok()
            .and_then(|count: u32| count.try_into().ok())
            .ok_or_else(|| KeepError(text.to_owned()))
    }
}

/// What was kept of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Kept {
    /// Number of components before.
    pub of: usize,
    /// Number of components kept.
    pub components: usize,
    /// The volume before, in cubed units of the points.
    pub of_volume: f64,
    /// The volume of the largest component before.
    pub largest_volume: f64,
}

/// As in "1 of 21 components".
impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.components, counted(self.of as u64, "component"))
    }
}

impl AlphaShape {
    /// The shape without the components that are not to be kept; [`AlphaShape::kept`] says how many there were. Points, their indices and the classes
    /// of the simplices that stay are unchanged, and [exterior](super::ShapeOptions::exterior) simplices are dropped. Without some of its components it is
    /// not the α-shape of its points any more. O(n log n).
    ///
    /// Betti numbers are not counted of a shape of a torus, nor of one of a [`Filtration`](super::ladder::Filtration) without exterior
    /// simplices.
    #[must_use]
    pub fn keep(&self, keep: &Keep) -> Self {
        let components = self.components();
        let is_kept = keep.choose(&components);
        let kept = Kept {
            of: components.len(),
            components: is_kept.iter().filter(|&&kept| kept).count(),
            of_volume: self.measures().volume,
            largest_volume: components.iter().map(|component| component.volume).fold(0.0, f64::max),
        };
        let of_point: Vec<bool> = self
            .component_numbers()
            .into_iter()
            .map(|number| number != NO_COMPONENT && is_kept[number as usize])
            .collect();
        let all = self.complex();
        let complex = Complex {
            cells: of_points(&all.cells, &of_point),
            facets: of_points(&all.facets, &of_point),
            edges: of_points(&all.edges, &of_point),
            vertices: of_points(&all.vertices, &of_point),
        };
        let sheets = self.sheets().map(|sheets| sheets.of_points(all, &complex, &of_point));
        let betti = match &sheets {
            _ if self.options().periodic.is_some() => None,
            Some(sheets) => Some(sheet_betti(&complex, kept.components as u64, sheets)),
            None if self.dimension() < 3 => Some(flat_betti(&complex)),
            None if self.options().exterior => Some(direct_betti(&within(all, &of_point))),
            None => None,
        };
        let mut shape = self.clone();
        (shape.complex, shape.sheets, shape.betti, shape.voxels) = (complex, sheets, betti, None);
        (shape.options.exterior, shape.kept) = (false, Some(kept));
        (shape.sums, shape.solid, shape.outline) = Default::default();
        shape
    }
}

/// The simplices of the shape over some of the points. All vertices of a simplex are in one component, so the first decides.
fn of_points<const N: usize>(all: &Simplices<N>, is_kept: &[bool]) -> Simplices<N> {
    let stays = |row: &[u32; N], class| class != Class::Exterior && is_kept[row[0] as usize];
    all.iter().filter(|&(row, class)| stays(row, class)).map(|(row, class)| (*row, class)).collect()
}

/// A whole triangulation in which the components over the other points are exterior, in canonical order.
fn within(whole: &Complex, is_kept: &[bool]) -> Complex {
    let class = |v: u32, class| if is_kept[v as usize] { class } else { Class::Exterior };
    let mut facets: Vec<([u32; 3], Class)> = whole
        .facets
        .iter()
        .map(|(&row, given)| match class(row[0], given) {
            // Regular ones alone have an orientation.
            Class::Exterior => (sorted(row), Class::Exterior),
            class => (row, class),
        })
        .collect();
    facets.sort_by_row();
    Complex {
        cells: whole.cells.iter().map(|(&row, given)| (row, class(row[0], given))).collect(),
        facets: facets.into_iter().collect(),
        edges: whole.edges.iter().map(|(&row, given)| (row, class(row[0], given))).collect(),
        vertices: whole.vertices.iter().map(|(&row, given)| (row, class(row[0], given))).collect(),
    }
}

impl Sheets {
    /// The sheets of the components over some of the points, numbered anew: `kept` is what stays of `all`.
    fn of_points(&self, all: &Complex, kept: &Complex, is_kept: &[bool]) -> Self {
        let (mut regular, mut singular) = (self.regular.iter(), self.singular.iter());
        let mut facets = Vec::new();
        for (row, class) in all.facets.iter() {
            let names: &[u32] = match class {
                Class::Regular => regular.next().map_or(&[], std::slice::from_ref),
                Class::Singular => singular.next().map_or(&[], |sides| sides),
                _ => continue,
            };
            if is_kept[row[0] as usize] {
                facets.extend(names);
            }
        }
        let edges = all.edges.of(Class::Singular).zip(&self.edges);
        let edges: Vec<u32> =
            edges.filter(|(row, _)| is_kept[row[0] as usize]).map(|(_, &sheet)| sheet).collect();
        Self::numbered(kept, &facets, &edges)
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::ladder::Filtration;
    use crate::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};

    /// Clusters of random points on a lattice, apart from each other.
    fn clusters(random: &mut Random) -> Vec<[f64; 3]> {
        let mut points = Vec::new();
        for cluster in 0..=random.below(5) {
            for _ in 0..=random.below(60) {
                let at = |side: usize, random: &mut Random| random.below(side) as f64;
                let x = 40.0 * cluster as f64 + at(5, random);
                points.push([x, at(4, random), at(4, random)]);
            }
        }
        points
    }

    fn shape_of(points: &[[f64; 3]], alpha: f64) -> AlphaShape {
        let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).exterior(true);
        alpha_shape(WeightedPoints::unweighted(points.to_vec()), &options).unwrap()
    }

    /// What is kept is what the kept points alone have in a shape where components are too far apart to bound common simplices:
    /// sums, sheets and Betti numbers are those of a shape computed from them.
    #[test]
    fn kept_components_are_those_of_their_points_alone() {
        let mut random = Random::new(57);
        let (mut some, mut voids) = (0, 0);
        for _ in 0..200 {
            let points = clusters(&mut random);
            let alpha = [0.25, 0.5, 0.75, 1.0, 2.0][random.below(5)];
            let shape = shape_of(&points, alpha);
            let count = 1 + random.below(4) as u32;
            let kept = shape.keep(&Keep::default().largest(Largest(count)));
            let counts = kept.kept().unwrap();
            assert_eq!(
                (counts.of, counts.of_volume),
                (shape.components().len(), shape.measures().volume)
            );
            assert_eq!(counts.components, counts.of.min(count as usize));
            assert!(!kept.complex().lists_exterior());
            let numbers = kept.component_numbers();
            let mut alone = points.clone();
            let mut at = 0..;
            alone.retain(|_| at.next().is_some_and(|at: usize| numbers[at] != NO_COMPONENT));
            let unlisted: Vec<_> = shape.duplicates().iter().map(|pair| pair[0]).collect();
            assert!(unlisted.iter().all(|&v| numbers[v as usize] == NO_COMPONENT));
            let expected = shape_of(&alone, alpha);
            assert_eq!(kept.betti(), expected.betti());
            assert_eq!(kept.measures(), expected.measures());
            // Points in one plane are not triangulated in space, and have no sheets.
            if expected.dimension() == 3 {
                assert_eq!(kept.betti().unwrap(), direct_betti(expected.complex()));
                assert_eq!(kept.sheets(), expected.sheets());
                assert_eq!(kept.components(), expected.components());
            }
            // Shapes of a filtration have no sheets.
            let filtration = Filtration::new(shape.points().clone()).unwrap();
            for exterior in [false, true] {
                let levels = filtration.levels(&[shape.options().alpha]);
                let at = levels.shape(0, exterior, levels.betti()[0]);
                let taken = at.keep(&Keep::default().largest(Largest(count)));
                assert_eq!(taken.complex(), kept.complex());
                let is_counted = exterior || at.dimension() < 3;
                assert_eq!(taken.betti(), kept.betti().filter(|_| is_counted));
            }
            some += usize::from(counts.components < counts.of);
            voids += kept.betti().unwrap().b2;
        }
        assert!(some > 50 && voids > 0, "{some}, {voids}");
    }

    #[test]
    fn components_are_chosen_by_volume_then_area_then_vertices() {
        // A cube, two triangles of different areas, three points in a row, and a point.
        let mut points: Vec<[f64; 3]> =
            (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
        points.extend([[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0]]);
        points.extend([[19.0, 0.0, 0.0], [20.0, 0.0, 0.0], [19.0, 0.5, 0.0]]);
        points.extend([[29.0, 0.0, 0.0], [30.0, 0.0, 0.0], [31.0, 0.0, 0.0], [40.0, 0.0, 0.0]]);
        let shape = shape_of(&points, 0.75);
        let first = |keep: Keep| {
            let shape = shape.keep(&keep);
            let boxes: Vec<f64> =
                shape.components().iter().map(|component| component.low[0]).collect();
            assert_eq!(shape.kept().map(|kept| kept.components), Some(boxes.len()));
            boxes
        };
        let largest = |count| first(Keep::default().largest(Largest(count)));
        assert_eq!(largest(1), [0.0]);
        assert_eq!(largest(2), [0.0, 9.0]);
        assert_eq!(largest(3), [0.0, 9.0, 19.0]);
        assert_eq!(largest(4), [0.0, 9.0, 19.0, 29.0]);
        assert_eq!(largest(9), [0.0, 9.0, 19.0, 29.0, 40.0]);
        assert_eq!(first(Keep::default()).len(), 5);
        assert_eq!(first(Keep::default().min_volume(1.0)), [0.0]);
        assert_eq!(first(Keep::default().min_volume(0.0)).len(), 5);
        assert_eq!(first(Keep::default().min_volume(1.0 + f64::EPSILON)), [0.0; 0]);
        let both = Keep::default().min_volume(0.5).largest(Largest(2));
        assert_eq!(first(both), [0.0]);
    }

    /// A triangulation of flat points has no sheets.
    #[test]
    fn flat_shapes_have_components() {
        let plane: Vec<[f64; 3]> = [0.0, 1.0, 9.0, 10.0]
            .into_iter()
            .flat_map(|x| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 2.0, 0.0]])
            .take(9)
            .collect();
        let kept = shape_of(&plane, 0.5).keep(&Keep::default().largest(Largest(1)));
        let counts = kept.kept().unwrap();
        assert_eq!((counts.of, counts.components), (2, 1));
        assert_eq!(kept.betti(), Some(flat_betti(kept.complex())));
        assert_eq!(kept.complex().facets.len(), 4);
    }

    #[test]
    fn numbers_of_components_are_text() {
        for (text, count) in [("largest", 1), ("1", 1), ("3", 3)] {
            assert_eq!(text.parse(), Ok(Largest(count)));
        }
        for text in ["0", "-1", "all", "", "1.5"] {
            let error = text.parse::<Largest>().unwrap_err();
            assert_eq!(error.to_string(), format!("{text:?} is not a number of components"));
        }
    }
}
