use std::borrow::{Borrow, Cow};
use std::io::{self, Write};
use std::sync::Arc;

use walpha_base::advice::Advice;
use walpha_base::setters;
use walpha_base::shown::number;

use super::Needs;
use walpha_points::{Column, Crs};
use walpha_shape::{AlphaShape, SinglePrecision, Surface};

/// Refuses coordinates that are beyond the range of single precision.
pub(super) fn check_range(single: &SinglePrecision) -> io::Result<()> {
    if single.is_in_range() {
        return Ok(());
    }
    Err(io::Error::other(
        "programs read its coordinates in single precision, which ends at 3.4·10³⁸: scale the points, or write a format that holds doubles, as .ply",
    ))
}

/// The offset of a file that states it in words, if it has one: `OFFSET=434000,5412000,0`.
pub(super) fn stated_offset(single: &SinglePrecision) -> Option<String> {
    let [x, y, z] = single.offset.map(number);
    single.has_offset().then(|| format!("OFFSET={x},{y},{z}"))
}

/// A writer of shapes in one format.
pub trait Exporter {
    /// Writes the whole file. The same shape gives the same bytes. A shape on a torus is
    /// [unwrapped](AlphaShape::unwrapped) first if the format cannot represent a torus.
    ///
    /// # Errors
    /// Errors of `out`.
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        match shape.options().periodic {
            Some(_) if !self.knows_torus() => self.encode(&shape.unwrapped(), out),
            _ => self.encode(shape, out),
        }
    }

    /// Writes the bytes of the format, for [`Exporter::write`]. The shape is on a torus only if the format
    /// [supports](Exporter::knows_torus) that.
    ///
    /// # Errors
    /// Errors of `out`.
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()>;

    /// Whether the format can represent a periodic box.
    fn knows_torus(&self) -> bool {
        false
    }

    /// What a shape must have for the file not to be empty.
    fn needs(&self) -> Needs {
        Needs::Simplex
    }

    /// How coordinates are converted, if the file stores them in single precision.
    fn single_precision(&self, _shape: &AlphaShape) -> Option<SinglePrecision> {
        None
    }

    /// A remark for users of the file, if this shape needs one.
    fn remark(&self, _shape: &AlphaShape) -> Option<Advice> {
        None
    }
}

/// Options of the writers.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ExportOptions {
    /// Writes text, if the format also has a binary form: PLY.
    pub ascii: bool,
    /// Writes the boundary of a [solid](AlphaShape::solid): only regular facets, closed, oriented and cut apart into a manifold.
    /// For formats that store the boundary.
    pub solid: bool,
    /// Separates regular and singular facets in ways that some programs do not expect: by groups (OBJ, also edges
    /// and points), colours (OFF) or properties (PLY, also components and sheets).
    pub groups: bool,
    /// The input of the shape, recorded in VTP and VTU files.
    pub input: Option<String>,
    /// The coordinate reference system of the points, from which `GeoJSON` is converted to longitude and latitude.
    pub crs: Option<Crs>,
    /// Further columns of the points, written beside their weights and values: PLY, VTU and VTP.
    pub columns: Arc<[Column]>,
    /// What is subtracted from coordinates in single precision, so that meshes which belong together have one offset; without it each mesh has
    /// its own, if it needs one.
    pub offset: Option<[f64; 3]>,
}

impl ExportOptions {
    setters! { ascii: bool, solid: bool, groups: bool, input: Option<String>, crs: Option<Crs>, columns: Arc<[Column]>, offset: Option<[f64; 3]> }

    /// The further columns of a shape's points, each with a name that is none of `taken` and has no blanks, quotes or brackets. An
    /// unwrapped shape has the numbers of the originals at its copies.
    pub(super) fn columns_of(
        &self,
        shape: &AlphaShape,
        taken: &[&str],
    ) -> Vec<(String, Cow<'_, [f64]>)> {
        let copies = shape.copies();
        let originals = shape.own_points();
        let mut names: Vec<String> = taken.iter().map(|&name| name.to_owned()).collect();
        let mut columns = Vec::new();
        for Column { name, values } in
            self.columns.iter().filter(|column| column.values.len() == originals)
        {
            let kept = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
            let mut name: String = name.chars().map(kept).collect();
            while names.contains(&name) {
                name.insert_str(0, "file_");
            }
            names.push(name.clone());
            let numbers = if copies.is_empty() {
                Cow::Borrowed(&values[..])
            } else {
                let of_copies = copies.iter().map(|&original| values[original as usize]);
                Cow::Owned(values.iter().copied().chain(of_copies).collect())
            };
            columns.push((name, numbers));
        }
        columns
    }

    /// The boundary to write.
    pub(super) fn surface<'a>(&self, shape: &'a AlphaShape) -> Cow<'a, Surface> {
        if self.solid { Cow::Borrowed(shape.solid().0) } else { Cow::Owned(Surface::of(shape)) }
    }

    /// What a shape must have for a file of its boundary, or of the boundary of its solid, not to be empty.
    pub(super) fn needs(&self, boundary: Needs) -> Needs {
        if self.solid { Needs::RegularFacet } else { boundary }
    }

    /// How the coordinates of the boundary are converted to single precision.
    pub(super) fn single_precision(&self, shape: &AlphaShape) -> SinglePrecision {
        match shape.options().periodic {
            Some(_) => self.single_precision(&shape.unwrapped()),
            None => self.single(&self.surface(shape), shape.points().positions()),
        }
    }

    /// How the coordinates of a surface are converted, which has the positions of its input.
    pub(super) fn single(&self, surface: &Surface, of_input: &[[f64; 3]]) -> SinglePrecision {
        match self.offset {
            Some(offset) => SinglePrecision::with_offset(offset, surface, of_input),
            None => SinglePrecision::of_surface(surface, of_input),
        }
    }

    /// These options with one offset for all of some shapes in space. O(n log n) for all of their vertices.
    #[must_use]
    pub fn with_common_offset(self, shapes: impl Iterator<Item = impl Borrow<AlphaShape>>) -> Self {
        let (mut places, mut sides) = (Vec::new(), Vec::new());
        for shape in shapes {
            let shape = shape.borrow();
            let surface = self.surface(shape);
            let first = places.len() as u32;
            places.extend(surface.positions(shape.points().positions()));
            sides.extend(surface.sides().map(|side| side.map(|v| first + v)));
        }
        let single = SinglePrecision::of(&places, sides.into_iter());
        self.offset(Some(single.offset))
    }
}
