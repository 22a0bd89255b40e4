//! Files that hold anything but a complex: findings or errors, never a panic.

use std::io::Cursor;

use walpha_base::random::Random;
use walpha_check::schema::{ComplexFile, PlacedComplex};
use walpha_check::{Extent, Finding};
use zip::CompressionMethod;

use crate::archive::{archive, npy};
use crate::common::{definition, grid};

/// Reads a file and judges what it holds, as the commands do; also a fuzz target.
fn judge(bytes: &[u8]) -> Result<Vec<Finding>, String> {
    let file = if bytes.starts_with(b"PK") {
        ComplexFile::read_npz(Cursor::new(bytes))
    } else {
        ComplexFile::read_json(bytes)
    };
    let placed = file.and_then(PlacedComplex::try_from).map_err(|error| error.to_string())?;
    let (findings, _) = placed.claim().findings().map_err(|error| error.to_string())?;
    findings.iter().for_each(|finding| assert!(!finding.to_string().is_empty()));
    Ok(findings)
}

#[test]
fn corners_in_one_place_are_a_finding() {
    let points = r#""points":[[0,0,0],[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"alpha":1"#;
    for rows in [r#""facets":[[0,1,2]]"#, r#""cells":[[0,1,2,3]]"#] {
        assert_ne!(judge(format!("{{{points},{rows}}}").as_bytes()).unwrap(), [], "{rows}");
    }
    let findings = judge(format!(r#"{{{points},"edges":[[0,1]]}}"#).as_bytes()).unwrap();
    let lines: Vec<String> = findings.iter().map(Finding::to_string).collect();
    assert!(lines.iter().any(|line| line.contains("corners are at one position")), "{lines:?}");
}

/// Three cells on one facet are named.
#[test]
fn a_crowded_facet_names_its_cells() {
    let points = r#""points":[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,2],[0,0,-1]],"alpha":9"#;
    let cells = r#""cells":[[0,1,2,3],[0,1,2,4],[0,2,1,5]]"#;
    let findings = judge(format!("{{{points},{cells}}}").as_bytes()).unwrap();
    let crowded = findings.iter().find_map(|finding| match finding {
        Finding::Crowded { facet, cells } => Some((facet.vertices().to_vec(), cells.len())),
        _ => None,
    });
    let (mut facet, cells) = crowded.unwrap();
    facet.sort_unstable();
    assert_eq!((facet, cells), (vec![0, 1, 2], 3));
}

/// Random rows over points that coincide, lie on lines and in planes, with random classes.
#[test]
fn nonsense_is_judged() {
    let mut random = Random::new(1313);
    let (mut judged, mut found) = (0, 0);
    for round in 0..600 {
        let n = 4 + random.below(6);
        let side = 1 + random.below(3);
        let points: Vec<_> =
            (0..n).map(|_| [0; 3].map(|_| random.below(side + 1) as f64)).collect();
        let mut rows = |size: usize| -> Option<Vec<Vec<usize>>> {
            let count = random.below(7);
            (random.below(3) > 0).then(|| {
                let mut numbers: Vec<usize> = (0..n).collect();
                let row = |_| {
                    random.shuffle(&mut numbers);
                    numbers[..size].to_vec()
                };
                (0..count).map(row).collect()
            })
        };
        let (cells, facets, edges) = (rows(4), rows(3), rows(2));
        let vertices = rows(1).map(|rows| rows.concat());
        let classes = |rows: Option<usize>, random: &mut Random| {
            let names = ["exterior", "interior", "regular", "singular"];
            rows.filter(|_| random.below(2) == 0)
                .map(|count| (0..count).map(|_| random.pick(&names)).collect::<Vec<_>>())
        };
        let mut file = serde_json::json!({
            "points": points,
            "weights": (0..n).map(|_| random.below(4) as f64 / 2.0).collect::<Vec<_>>(),
            "alpha": random.pick(&[-1.0, 0.0, 0.5, 0.75, 1.0, 3.0]),
            "hidden": [random.below(n)],
            "classes": {
                "cells": classes(cells.as_ref().map(Vec::len), &mut random),
                "facets": classes(facets.as_ref().map(Vec::len), &mut random),
                "edges": classes(edges.as_ref().map(Vec::len), &mut random),
                "vertices": classes(vertices.as_ref().map(Vec::len), &mut random),
            },
        });
        for (name, rows) in [("cells", cells), ("facets", facets), ("edges", edges)] {
            file[name] = serde_json::json!(rows);
        }
        file["vertices"] = serde_json::json!(vertices);
        if random.below(8) == 0 {
            file["alpha"] = "inf".into();
        }
        match judge(file.to_string().as_bytes()) {
            Ok(findings) => {
                judged += 1;
                found += usize::from(!findings.is_empty());
            }
            Err(error) => assert!(error.contains("no simplices"), "{round}: {error}\n{file}"),
        }
    }
    assert!(judged > 500 && found > 450, "{judged} judged, {found} wrong");
}

/// A right answer, as a file of either kind.
fn files() -> [Vec<u8>; 2] {
    let mut positions = grid(2);
    positions.extend([[0.5, 0.5, 0.5], [3.0, 0.0, 0.0]]);
    let weights = vec![0.0, 0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, -1.0, 0.0];
    let case = crate::common::Case { positions, weights, alpha: 1.0 };
    let answer = definition(&case).unwrap();
    let file = ComplexFile::from(case.claim(&answer, Extent::Whole));
    let mut json = Vec::new();
    file.write_json(&mut json).unwrap();
    let ints = |rows: &[u32]| rows.iter().flat_map(|i| i.to_le_bytes()).collect::<Vec<u8>>();
    let doubles = |rows: &[f64]| rows.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let c = &answer.complex;
    let arrays = [
        (
            "points",
            npy(
                "<f8",
                &format!("({}, 3)", case.positions.len()),
                &doubles(case.positions.as_flattened()),
            ),
        ),
        ("weights", npy("<f8", &format!("({},)", case.weights.len()), &doubles(&case.weights))),
        ("alpha", npy("<f8", "()", &doubles(&[case.alpha]))),
        (
            "cells",
            npy("<u4", &format!("({}, 4)", c.cells.len()), &ints(c.cells.rows().as_flattened())),
        ),
        (
            "facets",
            npy("<u4", &format!("({}, 3)", c.facets.len()), &ints(c.facets.rows().as_flattened())),
        ),
        ("hidden", npy("<u4", &format!("({},)", answer.hidden.len()), &ints(&answer.hidden))),
    ];
    let npz = archive(&arrays, CompressionMethod::Stored);
    assert!(judge(&json).is_ok() && judge(&npz).is_ok());
    [json, npz]
}

/// Bytes changed anywhere, and files cut anywhere.
#[test]
fn damage_makes_errors_or_findings() {
    let mut random = Random::new(77);
    let (mut judged, mut refused) = (0, 0);
    for file in files() {
        for _ in 0..1500 {
            let mut bytes = file.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(bytes.len());
                let digit = b'0' + random.below(10) as u8;
                bytes[at] = random.pick(&[digit, digit, 0, 0xff, b'-', b',']);
            }
            if random.below(8) == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            match judge(&bytes) {
                Ok(_) => judged += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(judged > 100 && refused > 1000, "{judged} judged, {refused} refused");
}
