//! Point clouds (PCD).

use walpha::points::read_points;

use super::files::save;
use crate::common::told::Told;

/// A PCD of the fields x, y, z, a normal of three numbers, and intensity.
fn pcd(data: &str, bytes: &[u8]) -> Vec<u8> {
    let head = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal intensity\nSIZE 4 4 8 4 2\nTYPE F F F F U\n\
         COUNT 1 1 1 3 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA {data}\n"
    );
    [head.as_bytes(), bytes].concat()
}

/// Two points with values 7 and 8, and one without a place between them.
fn pcd_examples() -> [(&'static str, Vec<u8>); 4] {
    let nan = f32::NAN;
    let rows = [(1f32, 2f32, 3f64, 7u16), (nan, nan, f64::NAN, 9), (4.0, 5.0, 6.0, 8)];
    let text: String = rows.iter().map(|(x, y, z, i)| format!("{x} {y} {z} 0 0 1 {i}\n")).collect();
    let normal = [0f32, 0.0, 1.0].map(f32::to_le_bytes).concat();
    let side_by_side: Vec<u8> = rows
        .iter()
        .flat_map(|(x, y, z, i)| {
            [&x.to_le_bytes()[..], &y.to_le_bytes(), &z.to_le_bytes(), &normal, &i.to_le_bytes()]
                .concat()
        })
        .collect();
    let by_field = [
        rows.iter().flat_map(|row| row.0.to_le_bytes()).collect::<Vec<u8>>(),
        rows.iter().flat_map(|row| row.1.to_le_bytes()).collect(),
        rows.iter().flat_map(|row| row.2.to_le_bytes()).collect(),
        normal.repeat(3),
        rows.iter().flat_map(|row| row.3.to_le_bytes()).collect(),
    ]
    .concat();
    let packed = |pieces: Vec<u8>| {
        let sizes = [pieces.len(), by_field.len()].map(|n| (n as u32).to_le_bytes()).concat();
        [sizes, pieces].concat()
    };
    // As they are; and with the second and third normals as copies of what stands 12 bytes before, too.
    let literal = |bytes: &[u8]| {
        bytes.chunks(32).flat_map(|c| [&[c.len() as u8 - 1], c].concat()).collect::<Vec<u8>>()
    };
    let (before, after) = (3 * (4 + 4 + 8) + 12, 3 * (4 + 4 + 8) + 36);
    let copied = [
        // The zeros of z = 3 as copies of the first of them.
        literal(&by_field[..25]),
        vec![3 << 5, 0],
        literal(&by_field[30..before]),
        vec![7 << 5, 24 - 9, 11],
        literal(&by_field[after..]),
    ]
    .concat();
    [
        ("text.pcd", pcd("ascii", text.as_bytes())),
        ("binary.pcd", pcd("binary", &side_by_side)),
        ("literal.pcd", pcd("binary_compressed", &packed(literal(&by_field)))),
        ("copied.pcd", pcd("binary_compressed", &packed(copied))),
    ]
}

#[test]
fn point_clouds_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in pcd_examples() {
        let points = read_points(&save(folder.path(), name, bytes), None).unwrap();
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.values, Some(vec![7.0, 8.0]), "{name}");
    }
    let [text, binary, packed, _] = pcd_examples();
    let refuses = |name: &str, bytes: &[u8], part: &str| {
        let error = read_points(&save(folder.path(), name, bytes), None).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let cut = |bytes: &[u8]| bytes[..bytes.len() - 5].to_vec();
    refuses("a.pcd", &binary.1[..60], "truncated");
    refuses("b.pcd", &cut(&binary.1), "claims 3 points of 30 bytes");
    refuses("c.pcd", &cut(&packed.1), "compressed data");
    let text = String::from_utf8(text.1).unwrap();
    refuses("d.pcd", text.replace("POINTS 3", "POINTS 4").as_bytes(), "claims 4 points");
    refuses("e.pcd", text.replace("FIELDS x", "FIELDS q").as_bytes(), "without x, y or z");
    refuses("f.pcd", text.replace("SIZE 4", "SIZE 8 4").as_bytes(), "different lengths");
    refuses("g.pcd", text.replace("ascii", "utf-8").as_bytes(), "ascii, binary");
    refuses("h.pcd", text.replace("POINTS 3", "POINTS 999999999999").as_bytes(), "cannot hold");
    // Found by fuzzing: a field without numbers, looked for beyond the last one.
    let none = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\nPOINTS 1\nDATA ascii\n1 2\n";
    refuses("i.pcd", none.as_bytes(), "no bytes or numbers");
}
