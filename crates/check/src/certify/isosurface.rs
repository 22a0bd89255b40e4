//! Judging the solid inside an isosurface, as far as a file without the samples of the volume allows: that its cells are positively oriented and meet face to
//! face, and that classes follow from it.
//!
//! Not judged is which cells belong, and so whether cells overlap that share no facet.

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::smallest_even;

use super::certificate::{Certificate, CertifyError, NotJudged, Verdict};
use super::finding::Finding;
use super::geometry::{orientations, six_volumes};
use super::structure::{self, Points, Structure};
use super::voxels::{accounts, faces, wrong_class};
use crate::Class;
use crate::exact::Exact;
use crate::schema::PlacedComplex;

/// All broken rules, and the certificate.
pub(super) fn findings(
    placed: &PlacedComplex,
    monitor: &Monitor,
) -> Result<(Vec<Finding>, Certificate), CertifyError> {
    placed.claim().check()?;
    let complex = &placed.complex;
    let sites = structure::sites(&placed.positions, &placed.weights);
    let points = Points { sites: &sites };
    let mut found = structure::rows(complex, points.len());
    let mut six_volumes_of_cells = Exact::default();
    let mut not_judged = vec![NotJudged::Samples];
    if found.is_empty() {
        let (structure, broken) = Structure::new(complex, points, &monitor.part(0, 5, 10))?;
        found.extend(broken);
        found.extend(orientations(complex.cells.rows(), points, &monitor.part(5, 7, 10))?);
        found.extend(accounts(placed));
        let classes = complex.cells.rows().iter().zip(complex.cells.classes());
        found.extend(classes.filter_map(|(row, class)| wrong_class(*row, *class, Class::Interior)));
        if found.is_empty() {
            let (six, shift) = six_volumes(complex.cells.rows(), points, &monitor.part(7, 9, 10))?;
            six_volumes_of_cells = Exact::integer(six, shift);
            found.extend(facets(&structure));
            found.extend(faces(&structure));
        }
    }
    if !found.is_empty() {
        not_judged.push(NotJudged::AfterFindings);
    }
    monitor.report(10, 10)?;
    let mut certificate = Certificate {
        verdict: Verdict::of(found.len(), 0),
        findings: found.len(),
        ties: 0,
        six_volumes: six_volumes_of_cells,
        not_judged,
    };
    certificate.conclude();
    Ok((found, certificate))
}

/// Judges facets: each has one cell, and is on the boundary and turns outwards, or two on different sides.
fn facets(structure: &Structure) -> Vec<Finding> {
    let facets = &structure.complex.facets;
    let judge = |row: usize| {
        let (facet, class) = (facets.rows()[row], facets.classes()[row]);
        let mut halves = structure.halves(row);
        match (halves.next(), halves.next()) {
            (None, _) => Some(Finding::Stray { simplex: facet.into() }),
            (Some(one), Some(other)) => {
                let [a, b] = [one, other].map(|half| smallest_even(structure.outward(half)));
                if a == b {
                    let cells = structure.complex.cells.rows();
                    let cells = [cells[one.cell].into(), cells[other.cell].into()];
                    return Some(Finding::Overlap { facet: facet.into(), cells });
                }
                wrong_class(facet, class, Class::Interior)
            }
            (Some(half), None) => {
                let behind = structure.apex(half);
                let winding = (facet != smallest_even(structure.outward(half)))
                    .then(|| Finding::Winding { facet: facet.into(), behind });
                wrong_class(facet, class, Class::Regular).or(winding)
            }
        }
    };
    (0..facets.len()).into_par_iter().filter_map(judge).collect()
}
