//! Scenes and cameras.

mod camera;

pub(crate) use camera::Lens;
pub use camera::{Camera, Projection, View};

use crate::colour::Rgb;
use crate::error::RenderError;
use crate::pixels::Size;

/// A scene, independent of the camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Surfaces.
    pub meshes: Vec<Mesh>,
    /// Points, drawn as balls.
    pub balls: Vec<Ball>,
    /// Edges, drawn as round-ended tubes.
    pub tubes: Vec<Tube>,
}

/// Triangles with a common appearance.
///
/// # Example
/// One triangle that turns counter-clockwise for an eye at z > 0, seen from both sides:
/// ```
/// use walpha_render::{Colours, Mesh, Rgb, Shading};
///
/// let mesh = Mesh {
///     two_sided: true,
///     shading: Shading::Flat,
///     colours: Colours::Uniform(Rgb::BONE),
///     ..Mesh::new(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]])
/// };
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Vertices, (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Outward normals of the vertices, of any length, for smooth shading; `None` weighs each
    /// vertex's triangles by their angles (Thürmer and Wüthrich 1998,
    /// doi:10.1080/10867651.1998.10487487).
    pub normals: Option<Vec<[f64; 3]>>,
    /// One colour, or one for each vertex.
    pub colours: Colours,
    /// Whether triangles are seen from behind as well, and hide light from behind. A closed surface needs only its outside.
    pub two_sided: bool,
    /// Flat or smooth.
    pub shading: Shading,
    /// 1 for a solid surface; less is translucent.
    pub opacity: f64,
}

impl Mesh {
    /// Opaque one-sided triangles in the colour of bone, shaded smoothly by their own normals.
    pub fn new(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            positions,
            triangles,
            normals: None,
            colours: Colours::Uniform(Rgb::BONE),
            two_sided: false,
            shading: Shading::Smooth,
            opacity: 1.0,
        }
    }
}

/// The colour of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// One colour everywhere.
    Uniform(Rgb),
    /// One for each vertex, blended over the triangles.
    Vertex(Vec<Rgb>),
}

/// Flat or smooth shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shading {
    /// Each triangle is visible as a plane.
    Flat,
    /// Normals are blended over the triangles: right for curved surfaces in small steps.
    Smooth,
}

/// A point drawn as a shaded ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre, (x, y, z).
    pub centre: [f64; 3],
    /// The radius in the units of the scene.
    pub radius: f64,
    /// Its colour.
    pub colour: Rgb,
}

/// An edge drawn as a tube with round ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    /// Both ends, (x, y, z).
    pub ends: [[f64; 3]; 2],
    /// The radius in the units of the scene.
    pub radius: f64,
    /// Its colour.
    pub colour: Rgb,
}

/// The background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Background {
    /// White, for paper.
    #[default]
    White,
    /// No background: opacity 0.
    Transparent,
}

impl Scene {
    /// Balls that contain all: the corners of the triangles, the balls, and the ends of the tubes.
    fn parts(&self) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
        let corners = self.meshes.iter().flat_map(|mesh| {
            let corners = mesh.triangles.as_flattened().iter();
            corners.filter_map(|&v| mesh.positions.get(v as usize)).map(|&p| (p, 0.0))
        });
        let balls = self.balls.iter().map(|ball| (ball.centre, ball.radius));
        let ends = self.tubes.iter().flat_map(|tube| tube.ends.map(|end| (end, tube.radius)));
        corners.chain(balls).chain(ends)
    }

    /// The box around all vertices, balls and tubes: its smallest and largest corner. `None` for
    /// an empty scene.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.parts().fold(None, |bounds, (p, radius)| {
            let [low, high] = bounds.unwrap_or([p, p]);
            Some([
                [0, 1, 2].map(|k| low[k].min(p[k] - radius)),
                [0, 1, 2].map(|k| high[k].max(p[k] + radius)),
            ])
        })
    }

    /// The camera that sees the scene from the direction of a view so that all of it just fits into a picture of this size, in
    /// the middle. O(n).
    ///
    /// # Errors
    /// [`RenderError`] if a place or radius is not finite.
    pub fn camera(
        &self,
        view: View,
        projection: Projection,
        size: Size,
    ) -> Result<Camera, RenderError> {
        self.check()?;
        Ok(Camera::fit(self.parts(), view, projection, size))
    }

    /// Adds the twelve edges of a box, given by its smallest and largest corner.
    pub fn add_box(&mut self, bounds: [[f64; 3]; 2], radius: f64, colour: Rgb) {
        let corner = |bits: usize| [0, 1, 2].map(|k| bounds[bits >> k & 1][k]);
        for from in 0..8_usize {
            for axis in (0..3).filter(|axis| from >> axis & 1 == 0) {
                let ends = [corner(from), corner(from | 1 << axis)];
                self.tubes.push(Tube { ends, radius, colour });
            }
        }
    }

    /// This scene with other units of length.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let place = |p: [f64; 3]| p.map(|x| x * factor);
        let mut scaled = self.clone();
        for mesh in &mut scaled.meshes {
            mesh.positions.iter_mut().for_each(|p| *p = place(*p));
        }
        for ball in &mut scaled.balls {
            (ball.centre, ball.radius) = (place(ball.centre), ball.radius * factor);
        }
        for tube in &mut scaled.tubes {
            (tube.ends, tube.radius) = (tube.ends.map(place), tube.radius * factor);
        }
        scaled
    }

    /// Checks that the scene is consistent.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let place = |p: &[f64; 3]| p.iter().all(|c| c.abs() < 1e100);
        let radius = |r: f64| (0.0..1e100).contains(&r);
        for (index, mesh) in self.meshes.iter().enumerate() {
            mesh.check(index)?;
        }
        let ball = self.balls.iter().position(|b| !(place(&b.centre) && radius(b.radius)));
        let tube = self.tubes.iter().position(|t| !(t.ends.iter().all(place) && radius(t.radius)));
        match (ball, tube) {
            (Some(index), _) => Err(RenderError::OutOfRange { what: "ball", index }),
            (_, Some(index)) => Err(RenderError::OutOfRange { what: "tube", index }),
            _ => Ok(()),
        }
    }
}

impl Mesh {
    fn check(&self, mesh: usize) -> Result<(), RenderError> {
        let vertices = self.positions.len();
        let attribute = |what, got| match got {
            Some(got) if got != vertices => {
                Err(RenderError::Attribute { mesh, what, got, vertices })
            }
            _ => Ok(()),
        };
        attribute("normals", self.normals.as_ref().map(Vec::len))?;
        attribute(
            "colours",
            match &self.colours {
                Colours::Uniform(_) => None,
                Colours::Vertex(each) => Some(each.len()),
            },
        )?;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(RenderError::Index { mesh, triangle, vertex, vertices });
            }
        }
        let finite = |all: &[[f64; 3]]| all.as_flattened().iter().all(|c| c.abs() < 1e100);
        if finite(&self.positions)
            && self.normals.as_deref().is_none_or(finite)
            && (0.0..=1.0).contains(&self.opacity)
        {
            Ok(())
        } else {
            Err(RenderError::OutOfRange { what: "mesh", index: mesh })
        }
    }
}
