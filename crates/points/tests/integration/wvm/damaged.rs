//! Damaged and forged files.

use proptest::prelude::*;
use walpha_points::{ModelMetadata, Packing, read_points};

use super::{checksum, grid, refused, save, scattered, written};

fn small(recipe: Option<&str>) -> Vec<u8> {
    let points = scattered([6, 6, 6], 5, |chance| chance.below(50) as f64);
    let order: Vec<u32> = (0..points.len() as u32).rev().collect();
    let facts = ModelMetadata::default().order(order).grid(grid([6, 6, 6]));
    let facts = facts.recipe(recipe.map(str::to_owned));
    written(&points, &facts, Packing::default().layers(2))
}

#[test]
fn each_damaged_byte_and_each_early_end_is_told() {
    for bytes in [small(None), small(Some(r#"{"hidden":true}"#))] {
        each_damage_is_told(&bytes);
    }
}

fn each_damage_is_told(bytes: &[u8]) {
    for place in 8..bytes.len() {
        for bit in [1, 16, 128] {
            let mut damaged = bytes.to_vec();
            damaged[place] ^= bit;
            let error = refused(&damaged);
            assert!(
                ["damaged", "version", "truncated", "header", "too long"]
                    .iter()
                    .any(|w| error.contains(w)),
                "byte {place}: {error}"
            );
        }
    }
    for end in 8..bytes.len() {
        let error = refused(&bytes[..end]);
        assert!(error.contains("truncated") || error.contains("ends within"), "{end}: {error}");
    }
    let longer = refused(&[bytes, b"."].concat());
    assert!(longer.contains("too long"), "{longer}");
}

/// A file whose checksums are right: a head with these fields behind its length, then a layer.
fn forged(fields: &[u8], layer: &[u8]) -> Vec<u8> {
    let length = (8 + 1 + 8 + fields.len() + 4) as u64;
    let mut bytes = [b"\x89wvm\r\n\x1a\n", &[1][..], &length.to_le_bytes(), fields].concat();
    bytes.extend(checksum(&bytes));
    bytes.extend(layer);
    bytes.extend(checksum(layer));
    bytes
}

#[test]
fn headers_are_not_believed() {
    let weight = [0; 8];
    let head = |flags: u8, layer: &[u8], rest: &[u8]| {
        [&[flags, 0, 0, 1][..], layer, rest, &weight].concat()
    };
    let side = [0xd9, 0x0c]; // 1625
    let large = [side, side, side].concat();
    let refuses = |fields: &[u8], layer: &[u8], part: &str| {
        let error = refused(&forged(fields, layer));
        assert!(error.contains(part), "{part:?} is missing in: {error}");
    };
    let billion = [0x80, 0x94, 0xeb, 0xdc, 0x03];
    let claims = |count: &[u8], places: u8| [count, &[places, 0, 0]].concat();
    refuses(&head(1, &claims(&billion, 8), &large), &[0; 8], "more points than its bytes");
    refuses(&head(1, &claims(&[9], 8), &[2, 2, 2]), &[0; 8], "more points than samples");
    refuses(&head(1, &claims(&[9], 8), &[0, 2, 2]), &[0; 8], "empty");
    refuses(&head(8, &claims(&[9], 8), &[0; 16]), &[0; 8], "without a grid");
    refuses(&head(24, &claims(&[9], 8), &[0; 16]), &[0; 8], "two ways");
    refuses(&head(0, &claims(&[9], 8), &[]), &[0; 8], "does not hold");
    refuses(&head(1, &[0xff; 10], &large), &[0; 8], "64 bits");
    refuses(&[0, 9, 0, 0], &[], "space 9");
    refuses(&[0, 0, 10, 0], &[], "unit of length 10");
    refuses(&[&[0, 0, 0, 0][..], &f64::NAN.to_le_bytes()].concat(), &[], "NaN");
    let with_recipe = [&head(0, &claims(&[9], 8), &[])[..], b"{\xff}"].concat();
    let error = refused(&forged(&with_recipe, &[0; 8]));
    assert!(error.contains("UTF-8"), "{error}");
    // The maximum number of points that these bytes may claim, on the largest grid: the bytes decide what exists.
    for filler in [0, 0x55, 0xff] {
        let count = [0x80, 0x80, 0x01]; // 64·256
        let layer = [&count[..], &[0x80, 0x02, 0, 0]].concat();
        refuses(&head(1, &layer, &large), &[filler; 256], "does not hold");
    }
}
proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Whatever is in a layer whose checksum is right, nothing panics, and what is read is whole.
    #[test]
    fn forged_layers_are_read_or_refused(
        layer in prop::collection::vec(any::<u8>(), 1..60),
        count in 1u8..120,
        side in 1u8..40,
        steps in any::<bool>(),
    ) {
        let values = if steps { layer.len() as u8 / 2 } else { 0 };
        let lengths = [count, layer.len() as u8 - values, values, 0];
        let numbers = if steps { vec![0; 16] } else { Vec::new() };
        let flags = if steps { 9 } else { 1 };
        let fields =
            [&[flags, 0, 0, 1][..], &lengths, &[side, side, 2], &numbers, &[0; 8]].concat();
        let folder = tempfile::tempdir().unwrap();
        if let Ok(points) = read_points(save(folder.path(), &forged(&fields, &layer)), None) {
            prop_assert_eq!(points.len(), usize::from(count));
            let mut places = points.positions.clone();
            places.dedup();
            prop_assert_eq!(places.len(), points.len());
        }
    }
}
