//! Gmsh's `.msh`, versions 2.2 and 4.1, as text and in binary (Gmsh's manual, "File formats").
//!
//! Nodes have tags in any order, by which elements name them. Points, lines and surfaces are elements, too, and are
//! left out.

use super::scan::{Form, Scan, shown};
use super::{Mesh, MeshError, not_tetrahedra};

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut scan = Scan::new(bytes);
    let Some(b"$MeshFormat") = scan.word() else {
        let error = MeshError::new(
            "the file does not begin with $MeshFormat: it is not a mesh of Gmsh from version 2 on",
        );
        return Err(error.with_advice("save it with Gmsh as version 4.1 or 2.2"));
    };
    let (version, numbers) = format(&mut scan)?;
    let mut nodes = Nodes::default();
    let mut elements = Elements::default();
    while let Some(section) = scan.word() {
        if !section.starts_with(b"$") {
            return Err(
                scan.fault(format!("{:?} stands where a section should begin", shown(section)))
            );
        }
        match (section, version) {
            (b"$Nodes", _) => {
                nodes = section_of(&mut scan, numbers, |scan| match version {
                    Version::Two => Nodes::of_two(scan, numbers),
                    Version::Four => Nodes::of_four(scan, numbers),
                })?;
            }
            (b"$Elements", _) => {
                section_of(&mut scan, numbers, |scan| match version {
                    Version::Two => elements.read_two(scan, numbers, &nodes),
                    Version::Four => elements.read_four(scan, numbers, &nodes),
                })?;
            }
            _ => {
                let end = [b"$End", &section[1..]].concat();
                scan.skip_past(&end)?;
                continue;
            }
        }
        let end = scan.expect("the end of a section")?;
        if !end.starts_with(b"$End") {
            let section = shown(section);
            return Err(scan.fault(format!(
                "{:?} stands where {section} should end: its counts are wrong",
                shown(end)
            )));
        }
    }
    let first = nodes.tags.first().copied().unwrap_or(0);
    let mesh = Mesh::of_cells(nodes.points, elements.cells)?;
    let mesh = if numbers == Form::Text { mesh.with_decimal_note() } else { mesh };
    Ok(mesh.with_numbering_note(first).with_ignored(&elements.ignored))
}

#[derive(Clone, Copy)]
enum Version {
    Two,
    Four,
}

/// The version, and how numbers are written.
fn format(scan: &mut Scan) -> Result<(Version, Form), MeshError> {
    let version = match scan.expect("the version")? {
        b"2" | b"2.1" | b"2.2" => Version::Two,
        b"4.1" => Version::Four,
        other => {
            let error =
                scan.fault(format!("the version is {:?}, and 2.2 and 4.1 are read", shown(other)));
            return Err(error.with_advice("save it with Gmsh as version 4.1 or 2.2"));
        }
    };
    let binary = scan.int("the kind of file, 0 or 1")? == 1;
    let bytes = scan.int("the size of a number")?;
    if bytes != 8 {
        return Err(scan.fault(format!("numbers have {bytes} bytes, and 8 are read")));
    }
    scan.skip_line();
    let mut form = Form::Text;
    if binary {
        form = match scan.take(4, "the order of bytes")? {
            [1, 0, 0, 0] => Form::Little,
            [0, 0, 0, 1] => Form::Big,
            _ => return Err(scan.fault("the order of bytes is not stated by a 1")),
        };
    }
    scan.skip_past(b"$EndMeshFormat")?;
    Ok((version, form))
}

/// Reads the content of a section, from the line after its name on.
fn section_of<'a, T>(
    scan: &mut Scan<'a>,
    numbers: Form,
    read: impl FnOnce(&mut Scan<'a>) -> Result<T, MeshError>,
) -> Result<T, MeshError> {
    scan.skip_line();
    scan.form = numbers;
    let read = read(scan)?;
    scan.form = Form::Text;
    Ok(read)
}

/// The number of things in a section of version 2, which is text even in binary files.
fn count_of_two(scan: &mut Scan, numbers: Form, what: &str) -> Result<u64, MeshError> {
    scan.form = Form::Text;
    let count = scan.size(what)?;
    scan.skip_line();
    scan.form = numbers;
    Ok(count)
}

/// The minimum number of bytes of some integers and doubles, each with its separator.
fn least(numbers: Form, in_text: u64, in_binary: u64) -> u64 {
    if numbers == Form::Text { 2 * in_text - 1 } else { in_binary }
}

#[derive(Default)]
struct Nodes {
    points: Vec<[f64; 3]>,
    /// The tag of each point.
    tags: Vec<u64>,
    /// Tags with the numbers of their points, ascending; empty if tags ascend by one.
    sorted: Vec<(u64, u32)>,
}

impl Nodes {
    fn of_two(scan: &mut Scan, numbers: Form) -> Result<Self, MeshError> {
        let count = count_of_two(scan, numbers, "the number of nodes")?;
        let mut nodes = Self::with_room(scan, count, least(numbers, 4, 28))?;
        for _ in 0..count {
            let tag = scan.int("the tag of a node")?;
            nodes.tags.push(natural(scan, tag)?);
            nodes.points.push(scan.position()?);
        }
        nodes.sort(scan)
    }

    fn of_four(scan: &mut Scan, numbers: Form) -> Result<Self, MeshError> {
        let blocks = scan.size("the number of blocks of nodes")?;
        let count = scan.size("the number of nodes")?;
        scan.size("the least tag")?;
        scan.size("the greatest tag")?;
        let mut nodes = Self::with_room(scan, count, least(numbers, 4, 32))?;
        for _ in 0..blocks {
            let dimension = scan.int("the dimension of an entity")?;
            scan.int("the tag of an entity")?;
            let parametric = scan.int("whether nodes have parameters, 0 or 1")? == 1;
            let here = scan.size("the number of nodes of a block")?;
            if here > count - nodes.tags.len() as u64 {
                return Err(scan.fault(format!(
                    "blocks have more nodes than the {count} that the section states"
                )));
            }
            for _ in 0..here {
                nodes.tags.push(scan.size("the tag of a node")?);
            }
            for _ in 0..here {
                nodes.points.push(scan.position()?);
                for _ in 0..if parametric { dimension } else { 0 } {
                    scan.coordinate()?;
                }
            }
        }
        if nodes.tags.len() as u64 != count {
            let found = nodes.tags.len();
            return Err(
                scan.fault(format!("blocks have {found} nodes, and the section states {count}"))
            );
        }
        nodes.sort(scan)
    }

    fn with_room(scan: &Scan, count: u64, bytes: u64) -> Result<Self, MeshError> {
        let (points, tags) = (scan.room(count, bytes, "nodes")?, scan.room(count, bytes, "nodes")?);
        Ok(Self { points, tags, sorted: Vec::new() })
    }

    /// Prepares the search for tags.
    fn sort(mut self, scan: &Scan) -> Result<Self, MeshError> {
        if self.tags.windows(2).all(|pair| pair[1] == pair[0].wrapping_add(1)) {
            return Ok(self);
        }
        self.sorted = self.tags.iter().copied().zip(0..).collect();
        self.sorted.sort_unstable();
        match self.sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(scan.fault(format!("two nodes have the tag {}", pair[0].0))),
            None => Ok(self),
        }
    }

    fn number_of(&self, tag: u64) -> Option<u32> {
        if self.sorted.is_empty() {
            let index = tag.checked_sub(*self.tags.first()?)?;
            return (index < self.tags.len() as u64).then_some(index as u32);
        }
        let at = self.sorted.binary_search_by_key(&tag, |&(tag, _)| tag).ok()?;
        Some(self.sorted[at].1)
    }
}

fn natural(scan: &Scan, number: i64) -> Result<u64, MeshError> {
    u64::try_from(number).map_err(|_| scan.fault(format!("{number} is negative, and must not be")))
}

#[derive(Default)]
struct Elements {
    cells: Vec<[u32; 4]>,
    ignored: Vec<(&'static str, u64)>,
}

impl Elements {
    fn read_two(&mut self, scan: &mut Scan, numbers: Form, nodes: &Nodes) -> Result<(), MeshError> {
        let count = count_of_two(scan, numbers, "the number of elements")?;
        // For a point in text: its tag, its type, the number of its labels and a node; in binary its tag and its node.
        self.cells = scan.room(count, least(numbers, 4, 8), "elements")?;
        let mut left = count;
        while left > 0 {
            // Text has these three numbers for each element, after its tag; binary for elements of a kind.
            let is_text = numbers == Form::Text;
            if is_text {
                scan.int("the tag of an element")?;
            }
            let kind = kind(scan)?;
            let here = if is_text { 1 } else { scan.int("the number of elements")? };
            let here = natural(scan, here)?.min(left);
            let labels = scan.int("the number of labels")?;
            if here == 0 {
                return Err(scan.fault("a block has no elements"));
            }
            for _ in 0..here {
                for _ in 0..labels + i64::from(!is_text) {
                    scan.int("a label")?;
                }
                self.element(scan, &kind, nodes, |scan| {
                    let tag = scan.int("the tag of a node")?;
                    natural(scan, tag)
                })?;
            }
            left -= here;
        }
        Ok(())
    }

    fn read_four(
        &mut self,
        scan: &mut Scan,
        numbers: Form,
        nodes: &Nodes,
    ) -> Result<(), MeshError> {
        let blocks = scan.size("the number of blocks of elements")?;
        let count = scan.size("the number of elements")?;
        scan.size("the least tag")?;
        scan.size("the greatest tag")?;
        self.cells = scan.room(count, least(numbers, 2, 16), "elements")?;
        let mut left = count;
        for _ in 0..blocks {
            scan.int("the dimension of an entity")?;
            scan.int("the tag of an entity")?;
            let kind = kind(scan)?;
            let here = scan.size("the number of elements of a block")?;
            if here > left {
                return Err(scan.fault(format!(
                    "blocks have more elements than the {count} that the section states"
                )));
            }
            for _ in 0..here {
                scan.size("the tag of an element")?;
                self.element(scan, &kind, nodes, |scan| scan.size("the tag of a node"))?;
            }
            left -= here;
        }
        if left > 0 {
            let found = count - left;
            return Err(
                scan.fault(format!("blocks have {found} elements, and the section states {count}"))
            );
        }
        Ok(())
    }

    /// Reads the nodes of an element, and keeps it if it is a tetrahedron.
    fn element(
        &mut self,
        scan: &mut Scan,
        kind: &Kind,
        nodes: &Nodes,
        next: impl Fn(&mut Scan) -> Result<u64, MeshError>,
    ) -> Result<(), MeshError> {
        if kind.number != TETRAHEDRON {
            for _ in 0..kind.nodes {
                next(scan)?;
            }
            match self.ignored.iter_mut().find(|(name, _)| *name == kind.name) {
                Some((_, count)) => *count += 1,
                None => self.ignored.push((kind.name, 1)),
            }
            return Ok(());
        }
        let mut cell = [0; 4];
        for corner in &mut cell {
            let tag = next(scan)?;
            *corner = nodes.number_of(tag).ok_or_else(|| {
                let why =
                    format!("corner {tag} of a cell is not the tag of a node that comes before it");
                scan.fault(why).with_advice("save all nodes with their elements")
            })?;
        }
        self.cells.push(cell);
        Ok(())
    }
}

/// A type of elements.
struct Kind {
    number: i64,
    nodes: usize,
    /// The plural name.
    name: &'static str,
}

const TETRAHEDRON: i64 = 4;

/// Reads a type of elements. Cells other than tetrahedra of four nodes are refused.
fn kind(scan: &mut Scan) -> Result<Kind, MeshError> {
    let number = scan.int("a type of elements")?;
    let (nodes, name) = match number {
        TETRAHEDRON => (4, "tetrahedra"),
        15 => (1, "points"),
        1 => (2, "lines"),
        8 => (3, "lines"),
        26 => (4, "lines"),
        27 => (5, "lines"),
        28 => (6, "lines"),
        2 => (3, "triangles"),
        9 => (6, "triangles"),
        20 => (9, "triangles"),
        21 => (10, "triangles"),
        22 => (12, "triangles"),
        23 | 24 => (15, "triangles"),
        25 => (21, "triangles"),
        3 => (4, "quadrangles"),
        16 => (8, "quadrangles"),
        10 => (9, "quadrangles"),
        5 => return Err(not_tetrahedra("hexahedra")),
        6 => return Err(not_tetrahedra("prisms")),
        7 => return Err(not_tetrahedra("pyramids")),
        11 => return Err(not_tetrahedra("tetrahedra of 10 nodes")),
        29 => return Err(not_tetrahedra("tetrahedra of 20 nodes")),
        30 => return Err(not_tetrahedra("tetrahedra of 35 nodes")),
        31 => return Err(not_tetrahedra("tetrahedra of 56 nodes")),
        12 | 17 | 92 | 93 => return Err(not_tetrahedra("hexahedra of higher order")),
        13 | 18 => return Err(not_tetrahedra("prisms of higher order")),
        14 | 19 => return Err(not_tetrahedra("pyramids of higher order")),
        _ => {
            let error =
                scan.fault(format!("elements have the type {number}, which is not known here"));
            return Err(error.with_advice("save tetrahedra of 4 nodes"));
        }
    };
    Ok(Kind { number, nodes, name })
}
