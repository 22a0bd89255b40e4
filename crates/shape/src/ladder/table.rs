use serde::Serialize;
use walpha_base::parallel::join;
use walpha_base::parallel::prelude::*;

use super::levels::{ByLevel, Span};
use super::topology::UpperBetti;
use super::{Filtration, Levels};
use crate::{Alpha, Betti, ByClass, Class, Measures, Void, facet_area, six_volumes};

/// Measurements of each level of a filtration, by ascending α.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Ladder {
    /// A row for each α.
    pub levels: Vec<Level>,
}

/// The measurements of a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Level {
    /// α, a squared length; the string "inf" where it is infinite.
    pub alpha: Alpha,
    /// Cells of the shape.
    pub cells: usize,
    /// Its facets, and those of the triangulation outside it.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub facets: ByClass<usize>,
    /// Its edges, and those of the triangulation outside it.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub edges: ByClass<usize>,
    /// Its vertices, and those of the triangulation outside it.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub vertices: ByClass<usize>,
    /// Components, tunnels, voids.
    pub betti: Betti,
    /// Components of the cells, joined through facets; see [`Levels::solid_components`].
    pub solid_components: u64,
    /// Volume and areas, in units of the points.
    #[serde(flatten)]
    pub measures: Measures,
    /// The share of the volume of the domain that the cells fill; 0 for a flat domain.
    pub coverage: f64,
    /// The voids, largest first.
    pub voids: Vec<Void>,
}

impl Level {
    /// The volume of all voids.
    pub fn void_volume(&self) -> f64 {
        self.voids.iter().fold(0.0, |sum, void| sum + void.volume)
    }
}

impl Filtration {
    /// The ladder at several α. Coverage is a share of the volume `domain`, such as that of the box around the samples of a grid.
    ///
    /// Near-linear in the simplices for all α together, and the length of the lists of voids.
    /// Volumes and areas are sums in double precision in a fixed order; on a lattice, volumes are
    /// exact.
    pub fn ladder(&self, alphas: &[Alpha], domain: f64) -> Ladder {
        self.levels(alphas).ladder(domain)
    }
}

impl Levels<'_> {
    /// The measurements of each level; see [`Filtration::ladder`].
    pub fn ladder(&self, domain: f64) -> Ladder {
        let ((voids, betti), (solid, measures)) = join(
            self.cells.len(),
            || {
                let mut voids = vec![Vec::new(); self.len()];
                let mut closed = vec![UpperBetti::default(); self.len()];
                self.descend(|level, complement| {
                    (voids[level], closed[level]) = (complement.voids(), complement.closed());
                });
                (voids, self.betti_with(&closed))
            },
            || (self.solid_components(), self.measures()),
        );
        let facets = by_class(&self.facets, self.len());
        let edges = by_class(&self.edges, self.len());
        let vertices = by_class(&self.vertices, self.len());
        let cells = ByLevel::new(self.len(), self.cells.iter().copied());
        let mut cell_count = 0;
        let rows = voids.into_iter().enumerate().map(|(k, voids)| {
            cell_count += cells.at(k).len();
            Level {
                alpha: self.alphas[k],
                cells: cell_count,
                facets: facets[k],
                edges: edges[k],
                vertices: vertices[k],
                betti: betti[k],
                solid_components: solid[k],
                measures: measures[k],
                coverage: if domain > 0.0 { measures[k].volume / domain } else { 0.0 },
                voids,
            }
        });
        Ladder { levels: rows.collect() }
    }

    /// Volume and areas of each level.
    fn measures(&self) -> Vec<Measures> {
        let whole = &self.filtration.whole;
        let cells = whole.complex().cells.rows();
        let volumes = self.fixed_order_sums(&self.cells, |row, &first, sums| {
            // Accumulated over levels below.
            if let Some(sum) = sums.get_mut(first as usize) {
                sum[0] += six_volumes(whole.corners(cells[row]));
            }
        });
        let areas = self.fixed_order_sums(&self.facets, |row, span, sums| {
            if span.first < span.interior {
                let area = facet_area(whole.corners(self.filtration.incidence.facets[row]));
                let [first, regular, last] =
                    [span.first, span.regular, span.interior].map(|level| level as usize);
                sums[first..regular].iter_mut().for_each(|sum| sum[1] += area);
                sums[regular..last].iter_mut().for_each(|sum| sum[0] += area);
            }
        });
        let mut six = 0.0;
        let level = |(volume, &[regular_area, singular_area]): (&[f64; 2], &[f64; 2])| {
            six += volume[0];
            let area = regular_area + singular_area;
            Measures { volume: six / 6.0, area, regular_area, singular_area }
        };
        volumes.iter().zip(&areas).map(level).collect()
    }

    /// Two sums for each level, by chunks whose size does not depend on the number of threads.
    fn fixed_order_sums<T: Sync>(
        &self,
        rows: &[T],
        add: impl Fn(usize, &T, &mut [[f64; 2]]) + Sync,
    ) -> Vec<[f64; 2]> {
        const CHUNK: usize = 1 << 14;
        let of_chunk = |(chunk, rows): (usize, &[T])| {
            let mut sums = vec![[0.0; 2]; self.len()];
            for (i, row) in rows.iter().enumerate() {
                add(chunk * CHUNK + i, row, &mut sums);
            }
            sums
        };
        let chunks: Vec<_> = rows.par_chunks(CHUNK).enumerate().map(of_chunk).collect();
        let mut sums = vec![[0.0; 2]; self.len()];
        for (sum, part) in chunks.iter().flat_map(|chunk| chunk.iter().enumerate()) {
            sums[sum][0] += part[0];
            sums[sum][1] += part[1];
        }
        sums
    }
}

/// The number of simplices of each class at each level.
fn by_class(spans: &[Span], levels: usize) -> Vec<ByClass<usize>> {
    let mut change = vec![ByClass::<i64>::default(); levels + 1];
    for span in spans {
        let mut class = Class::Exterior;
        for level in [span.first, span.regular, span.interior] {
            let next = span.class(level);
            change[level as usize][class] -= 1;
            change[level as usize][next] += 1;
            class = next;
        }
    }
    let mut now = ByClass { exterior: spans.len(), ..ByClass::default() };
    let level = |change: &ByClass<i64>| {
        for (class, change) in change.iter() {
            now[class] = now[class].checked_add_signed(*change as isize).expect("a count");
        }
        now
    };
    change[..levels].iter().map(level).collect()
}
