//! Shapes as files that the checker reads.

use std::io::Cursor;

use walpha::check::schema::ComplexFile;
use walpha::export::{Exporter, Json, Npz};
use walpha::shape::ShapeOptions;
use walpha::{Alpha, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::check_common::grid;

fn points() -> WeightedPoints {
    let mut random = Random::new(5);
    let mut positions = grid(4);
    positions.iter_mut().flatten().step_by(7).for_each(|x| *x += random.unit());
    positions.push(positions[3]);
    let weights = (0..65).map(|_| random.unit()).collect();
    WeightedPoints::new(positions, weights).unwrap()
}

/// The two files of a shape say the same, also when `NumPy` has compressed one of them.
#[test]
fn npz_is_json() {
    let points = points();
    for (alpha, exterior) in [(0.9, true), (0.9, false), (f64::INFINITY, false), (-5.0, false)] {
        let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).exterior(exterior);
        let shape = alpha_shape(points.clone(), &options).unwrap();
        let (mut json, mut npz) = (Vec::new(), Vec::new());
        Json.write(&shape, &mut json).unwrap();
        Npz.write(&shape, &mut npz).unwrap();
        let mut json = ComplexFile::read_json(&json[..]).unwrap();
        json.info = None;
        for bytes in [compressed(&npz), npz] {
            assert_eq!(ComplexFile::read_npz(Cursor::new(bytes)).unwrap(), json, "α = {alpha}");
        }
    }
}

fn compressed(archive: &[u8]) -> Vec<u8> {
    let mut stored = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut packed = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated);
    for i in 0..stored.len() {
        let mut member = stored.by_index(i).unwrap();
        packed.start_file(member.name(), options).unwrap();
        std::io::copy(&mut member, &mut packed).unwrap();
    }
    packed.finish().unwrap().into_inner()
}
