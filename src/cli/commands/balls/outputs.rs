//! The files of `walpha balls`: tables, surfaces and pictures.

use std::io::{self, Write};
use std::path::Path;

use super::Subject;
use super::tables::Table;
use crate::balls::BallSurface;
use crate::cli::options::picture::{PictureArgs, SightArgs};
use crate::export::LabelledMesh;
use crate::volume::UnknownFormat;

/// What a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Output {
    Table(Table),
    /// The surface of the union, in the format of this extension.
    Surface(&'static str),
    /// The balls, coloured by element.
    Picture,
}

/// What files other than tables are made of.
pub(super) struct Looks<'a> {
    /// The surface, if a file has it, and its tolerance.
    pub surface: Option<(BallSurface, f64)>,
    pub sight: SightArgs,
    pub input: &'a str,
}

impl Output {
    /// What a name asks for; `path` is the name as it was given.
    pub(super) fn of(name: &Path, path: &Path) -> Result<Self, UnknownFormat> {
        let extension = name.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let mesh = LabelledMesh::EXTENSIONS.into_iter().find(|known| *known == extension);
        let picture = || PictureArgs::wanted(name).then_some(Self::Picture);
        let found = Table::of(name).map(Self::Table).or(mesh.map(Self::Surface)).or_else(picture);
        found.ok_or_else(|| {
            let known = Table::EXTENSIONS.into_iter().chain(LabelledMesh::EXTENSIONS);
            let known = known.chain(PictureArgs::EXTENSIONS);
            UnknownFormat::new(path, "the measures of balls", known)
        })
    }

    pub(super) fn is_surface(self) -> bool {
        matches!(self, Self::Surface(_))
    }

    /// Whether it is of pockets.
    pub(super) fn needs_pockets(self) -> bool {
        matches!(self, Self::Table(table) if table.needs_pockets())
    }

    /// Writes the file.
    ///
    /// # Errors
    /// Whatever `out` returns; a picture that cannot be drawn.
    pub(super) fn write(
        self,
        of: &Subject<'_>,
        looks: &Looks<'_>,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        match (self, &looks.surface) {
            (Self::Table(table), _) => table.write(of, out),
            (Self::Surface(extension), Some((surface, tolerance))) => {
                mesh(of, surface, *tolerance, looks.input).write(extension, out)
            }
            (Self::Surface(_), None) => {
                unreachable!("a surface is made for the files that have it")
            }
            (Self::Picture, _) => {
                let positions = &of.shape.points().positions()[..of.shape.own_points()];
                let positions = positions.iter().zip(of.radii).enumerate();
                let ball = |(v, (&centre, &radius))| (centre, radius, colour(of, v));
                let png = looks.sight.draw_balls(positions.map(ball)).map_err(io::Error::other)?;
                out.write_all(&png)
            }
        }
    }
}

/// The colour of an atom whose element is known.
fn colour(of: &Subject<'_>, v: usize) -> Option<[u8; 3]> {
    of.molecule?.atoms[v].element.map(crate::points::Element::colour)
}

fn mesh<'a>(
    of: &Subject<'_>,
    surface: &'a BallSurface,
    tolerance: f64,
    input: &'a str,
) -> LabelledMesh<'a> {
    /// Of atoms whose element is not known.
    const UNKNOWN: [u8; 3] = [222, 212, 194];
    let colours = of.molecule.map(|_| {
        surface.balls.iter().map(|&v| colour(of, v as usize).unwrap_or(UNKNOWN)).collect()
    });
    LabelledMesh {
        positions: &surface.positions,
        triangles: &surface.triangles,
        label: "ball",
        labels: &surface.balls,
        colours,
        about: format!("surface of balls, off by at most {tolerance} of the radius"),
        input,
        coordinates: of.shape.coordinates(),
    }
}
