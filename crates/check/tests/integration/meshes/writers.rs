//! The least writer of each format, for tests.

use std::fmt::Write;

/// A file by its name.
pub(super) type File = (&'static str, Vec<u8>);

/// The form of numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Text,
    Little,
    Big,
}

/// A file in the making.
struct Out {
    bytes: Vec<u8>,
    form: Form,
}

impl Out {
    fn new(form: Form) -> Self {
        Self { bytes: Vec::new(), form }
    }

    fn text(&mut self, text: &str) {
        self.bytes.extend(text.as_bytes());
    }

    fn number<const N: usize>(&mut self, text: String, mut little: [u8; N]) {
        match self.form {
            Form::Text => return self.text(&(text + " ")),
            Form::Little => {}
            Form::Big => little.reverse(),
        }
        self.bytes.extend(little);
    }

    fn int(&mut self, x: i32) {
        self.number(x.to_string(), x.to_le_bytes());
    }

    fn size(&mut self, x: u64) {
        self.number(x.to_string(), x.to_le_bytes());
    }

    fn double(&mut self, x: f64) {
        self.number(format!("{x:?}"), x.to_le_bytes());
    }

    fn point(&mut self, point: [f64; 3]) {
        point.into_iter().for_each(|x| self.double(x));
    }

    fn end(&mut self) {
        self.text("\n");
    }
}

pub(super) fn tetgen(points: &[[f64; 3]], cells: &[[u32; 4]], first: u32) -> Vec<File> {
    let (mut node, mut ele) =
        (format!("{} 3 0 0\n", points.len()), format!("{} 4 0\n", cells.len()));
    for (number, [x, y, z]) in (first..).zip(points) {
        writeln!(node, "{number} {x:?} {y:?} {z:?}").unwrap();
    }
    for (number, cell) in (first..).zip(cells) {
        let [a, b, c, d] = cell.map(|corner| corner + first);
        writeln!(ele, "{number} {a} {b} {c} {d}").unwrap();
    }
    vec![("t.node", node.into_bytes()), ("t.ele", ele.into_bytes())]
}

pub(super) fn medit(points: &[[f64; 3]], cells: &[[u32; 4]]) -> Vec<File> {
    let mut text = format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", points.len());
    for [x, y, z] in points {
        writeln!(text, "{x:?} {y:?} {z:?} 0").unwrap();
    }
    writeln!(text, "Tetrahedra\n{}", cells.len()).unwrap();
    for cell in cells {
        let [a, b, c, d] = cell.map(|corner| corner + 1);
        writeln!(text, "{a} {b} {c} {d} 0").unwrap();
    }
    vec![("t.mesh", (text + "End\n").into_bytes())]
}

fn mesh_format(form: Form, version: &str) -> Out {
    let mut out = Out::new(form);
    out.text(&format!("$MeshFormat\n{version} {} 8\n", i32::from(form != Form::Text)));
    if form != Form::Text {
        out.int(1);
        out.end();
    }
    out.text("$EndMeshFormat\n");
    out
}

/// The tag of a point: descending with gaps, so that nothing rests on their order.
fn tag(points: &[[f64; 3]], point: u32) -> u64 {
    3 * (points.len() as u64 - u64::from(point)) + 2
}

pub(super) fn gmsh_2(points: &[[f64; 3]], cells: &[[u32; 4]], form: Form) -> Vec<File> {
    let mut out = mesh_format(form, "2.2");
    let is_text = form == Form::Text;
    out.text(&format!("$Nodes\n{}\n", points.len()));
    for (number, &point) in (0..).zip(points) {
        out.int(tag(points, number) as i32);
        out.point(point);
        if is_text {
            out.end();
        }
    }
    out.text(&format!("\n$EndNodes\n$Elements\n{}\n", cells.len() + 1));
    // A point as an element, and then cells.
    if is_text {
        out.text("1 15 2 0 0 ");
    } else {
        [15, 1, 2, 1, 0, 0].into_iter().for_each(|x| out.int(x));
    }
    out.int(tag(points, 0) as i32);
    if !is_text {
        [4, cells.len() as i32, 1].into_iter().for_each(|x| out.int(x));
    }
    for (number, cell) in (2..).zip(cells) {
        if is_text {
            out.text(&format!("\n{number} 4 1 "));
        } else {
            out.int(number);
        }
        out.int(7);
        cell.iter().for_each(|&corner| out.int(tag(points, corner) as i32));
    }
    out.text("\n$EndElements\n");
    vec![("t.msh", out.bytes)]
}

pub(super) fn gmsh_4(points: &[[f64; 3]], cells: &[[u32; 4]], form: Form) -> Vec<File> {
    let mut out = mesh_format(form, "4.1");
    out.text("$Nodes\n");
    // The first point is a separate block, on a curve and with its parameter there.
    let count = points.len() as u64;
    [2, count, 5, 3 * count + 2].into_iter().for_each(|x| out.size(x));
    for (block, dimension) in [(0..1, 1), (1..points.len() as u32, 3)] {
        [dimension, 1, i32::from(dimension == 1)].into_iter().for_each(|x| out.int(x));
        out.size(block.len() as u64);
        block.clone().for_each(|point| out.size(tag(points, point)));
        for point in block {
            out.point(points[point as usize]);
            if dimension == 1 {
                out.double(0.5);
            }
        }
    }
    out.text("\n$EndNodes\n$Elements\n");
    [2, cells.len() as u64 + 1, 1, cells.len() as u64 + 1].into_iter().for_each(|x| out.size(x));
    [0, 1, 15].into_iter().for_each(|x| out.int(x));
    [1, 1, tag(points, 0)].into_iter().for_each(|x| out.size(x));
    [3, 1, 4].into_iter().for_each(|x| out.int(x));
    out.size(cells.len() as u64);
    for (number, cell) in (2..).zip(cells) {
        out.size(number);
        cell.iter().for_each(|&corner| out.size(tag(points, corner)));
    }
    out.text("\n$EndElements\n");
    vec![("t.msh", out.bytes)]
}

pub(super) fn vtk(points: &[[f64; 3]], cells: &[[u32; 4]], form: Form, version: &str) -> Vec<File> {
    let mut out = Out::new(form);
    let word = if form == Form::Text { "ASCII" } else { "BINARY" };
    out.text(&format!(
        "# vtk DataFile Version {version}\na test\n{word}\nDATASET UNSTRUCTURED_GRID\n"
    ));
    if form == Form::Big {
        // A text with its length, as VTK keeps it.
        out.text("FIELD FieldData 1\nby 1 1 string\n\u{0}");
        *out.bytes.last_mut().unwrap() = 0xc0 | 4;
        out.text("test\n");
    }
    out.text(&format!("POINTS {} double\n", points.len()));
    points.iter().for_each(|&point| out.point(point));
    let (count, corners) = (cells.len(), 4 * cells.len());
    if version == "5.1" {
        out.text(&format!("\nCELLS {} {corners}\nOFFSETS vtktypeint64\n", count + 1));
        (0..=count).for_each(|cell| out.size(4 * cell as u64));
        out.text("\nCONNECTIVITY vtktypeint64\n");
        cells.iter().flatten().for_each(|&corner| out.size(corner.into()));
    } else {
        out.text(&format!("\nCELLS {count} {}\n", corners + count));
        for cell in cells {
            out.int(4);
            cell.iter().for_each(|&corner| out.int(corner as i32));
        }
    }
    out.text(&format!("\nCELL_TYPES {count}\n"));
    (0..count).for_each(|_| out.int(10));
    out.text(&format!(
        "\nPOINT_DATA {}\nSCALARS weight double 1\nLOOKUP_TABLE default\n",
        points.len()
    ));
    (0..points.len()).for_each(|_| out.double(0.0));
    out.end();
    vec![("t.vtk", out.bytes)]
}

/// The files of a mesh in every form.
pub(super) fn all(points: &[[f64; 3]], cells: &[[u32; 4]]) -> Vec<Vec<File>> {
    let mut files = vec![medit(points, cells)];
    files.extend([0, 1].map(|first| tetgen(points, cells, first)));
    for form in [Form::Text, Form::Little, Form::Big] {
        files.push(gmsh_2(points, cells, form));
        files.push(gmsh_4(points, cells, form));
    }
    for form in [Form::Text, Form::Big] {
        files.extend(["4.2", "5.1"].map(|version| vtk(points, cells, form, version)));
    }
    files
}
