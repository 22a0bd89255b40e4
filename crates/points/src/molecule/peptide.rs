//! A small molecule of our own: an ideal α-helix of alanines.

use std::path::Path;

use walpha_base::vector;

use super::{Atom, Element, Found};
use crate::{ModelMetadata, PointOptions, Points, PointsError};

/// Its name.
pub(crate) const PEPTIDE: &str = "sample:peptide";
/// The number of residues.
const RESIDUES: i32 = 12;
/// Torsion angles φ, ψ and ω of an α-helix, in degrees.
const PHI: f64 = -57.0;
const PSI: f64 = -47.0;
const OMEGA: f64 = 180.0;

/// An atom that is placed: its name, element, and place.
type Placed = (&'static str, &'static str, [f64; 3]);

/// An α-helix of twelve alanines in chain A, with hydrogens, in ångströms, rounded to three decimals as in PDB files.
/// Bond lengths and angles of heavy atoms are those of Engh & Huber (1991, doi:10.1107/S0108767391001071).
pub(crate) fn peptide(options: &PointOptions) -> Result<(Points, ModelMetadata), PointsError> {
    let mut found = Found::default();
    let (residue, chain) = (found.name("ALA"), found.name("A"));
    for (number, atoms) in (1..).zip(helix()) {
        for (name, element, place) in atoms {
            let atom = Atom {
                name: found.name(name),
                element: Element::named(element),
                residue: residue.clone(),
                number: Some(number),
                chain: chain.clone(),
                model: 1,
                occupancy: Some(1.0),
                ..Atom::default()
            };
            // Decimals are the same where sines differ by an ulp.
            found.push(place.map(|x| (x * 1000.0).round() / 1000.0 + 0.0), atom)?;
        }
    }
    found.select(Path::new(PEPTIDE), &options.atoms, options)
}

/// The atoms of each residue.
fn helix() -> Vec<Vec<Placed>> {
    let n = [0.0; 3];
    let ca = [1.458, 0.0, 0.0];
    // The third atom is in the plane z = 0.
    let mut backbone = [n, ca, place([[0.0, 1.0, 0.0], n, ca], 1.525, 111.2, 0.0)];
    let mut before: Option<[[f64; 3]; 3]> = None;
    let mut residues = Vec::new();
    for number in 1..=RESIDUES {
        let [n, ca, c] = backbone;
        let cb = place([c, n, ca], 1.521, 110.4, -122.6);
        let mut atoms = vec![
            ("N", "N", n),
            ("CA", "C", ca),
            ("C", "C", c),
            ("O", "O", place([n, ca, c], 1.231, 120.8, PSI + 180.0)),
            ("CB", "C", cb),
        ];
        if number == RESIDUES {
            atoms.push(("OXT", "O", place([n, ca, c], 1.231, 117.0, PSI)));
        }
        let of_three = |names: [&'static str; 3], of: [[f64; 3]; 3], length| {
            let turns = names.into_iter().zip([60.0, 180.0, -60.0]);
            turns.map(move |(name, turn)| (name, "H", place(of, length, 109.5, turn)))
        };
        match before {
            None => atoms.extend(of_three(["H1", "H2", "H3"], [c, ca, n], 1.01)),
            Some([_, ca, c]) => atoms.push(("H", "H", place([ca, c, n], 1.01, 119.2, 0.0))),
        }
        atoms.push(("HA", "H", place([c, n, ca], 1.09, 109.5, 118.7)));
        atoms.extend(of_three(["HB1", "HB2", "HB3"], [n, ca, cb], 1.09));
        residues.push(atoms);
        let next_n = place([n, ca, c], 1.329, 116.2, PSI);
        let next_ca = place([ca, c, next_n], 1.458, 121.7, OMEGA);
        before = Some(backbone);
        backbone = [next_n, next_ca, place([c, next_n, next_ca], 1.525, 111.2, PHI)];
    }
    residues
}

/// The place at a distance from `c`, with an angle at `c` to `b`, and a torsion angle about the line from `b` to `c`, seen from
/// which `a` is at 0; in degrees.
fn place([a, b, c]: [[f64; 3]; 3], length: f64, angle: f64, torsion: f64) -> [f64; 3] {
    let along = unit(vector::sub(c, b));
    let normal = unit(vector::cross(vector::sub(b, a), along));
    let across = vector::cross(normal, along);
    let (angle, torsion) = (angle.to_radians(), torsion.to_radians());
    let part = [
        -length * angle.cos(),
        length * angle.sin() * torsion.cos(),
        length * angle.sin() * torsion.sin(),
    ];
    [0, 1, 2].map(|k| c[k] + part[0] * along[k] + part[1] * across[k] + part[2] * normal[k])
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = vector::dot(v, v).sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AtomSelection;

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        let d = vector::sub(a, b);
        vector::dot(d, d).sqrt()
    }

    fn place_of(points: &Points, name: &str, number: i32) -> [f64; 3] {
        let atoms = &points.molecule.as_ref().unwrap().atoms;
        let is_it = |atom: &Atom| &*atom.name == name && atom.number == Some(number);
        points.positions[atoms.iter().position(is_it).unwrap()]
    }

    #[test]
    fn the_peptide_is_a_helix_of_l_alanines() {
        let (points, _) = peptide(&PointOptions::default()).unwrap();
        assert_eq!(points.len(), 61);
        let of = |name, number| place_of(&points, name, number);
        for k in 1..12 {
            // The peptide bond, a trans one, and the rise of 1.5 Å a residue over a turn of 3.6.
            assert!((distance(of("C", k), of("N", k + 1)) - 1.329).abs() < 2e-3);
            assert!((distance(of("CA", k), of("CA", k + 1)) - 3.8).abs() < 0.03);
            if k < 9 {
                assert!((distance(of("O", k), of("N", k + 4)) - 2.9).abs() < 0.3, "{k}");
            }
        }
        // Left-handed amino acids, a right-handed helix.
        let [n, ca, c, cb] = ["N", "CA", "C", "CB"].map(|name| of(name, 3));
        let side = vector::cross(vector::sub(n, ca), vector::sub(c, ca));
        assert!(vector::dot(side, vector::sub(cb, ca)) > 0.0);
        let [a, b, c, d] = [1, 2, 3, 4].map(|k| of("CA", k));
        let turn = vector::cross(vector::sub(b, a), vector::sub(c, b));
        assert!(vector::dot(turn, vector::sub(d, c)) > 0.0);
    }

    #[test]
    fn no_two_atoms_clash_but_bonded_ones() {
        let all = PointOptions::default().atoms(AtomSelection::default().hydrogens(true));
        let (points, _) = peptide(&all).unwrap();
        assert_eq!(points.len(), 61 + 62);
        let places = &points.positions;
        let mut bonds = 0;
        for (k, &a) in places.iter().enumerate() {
            for &b in &places[..k] {
                let d = distance(a, b);
                assert!(d > 1.0, "{a:?} {b:?}");
                bonds += usize::from(d < 1.57);
            }
        }
        // A tree of bonds.
        assert_eq!(bonds, places.len() - 1);
    }
}
