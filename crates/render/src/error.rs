use walpha_base::advice::{Advise, wrapped};
use walpha_base::memory::NoMemory;

/// Pixels along each side of a picture, at most.
pub(super) const MOST_PIXELS: u32 = 1 << 14;

/// Why a picture, figure or page cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A camera without a definite view.
    #[error("the camera cannot see: {0}")]
    Camera(&'static str),
    /// A picture without pixels, or with too many.
    #[error(
        "a picture of {width}×{height} pixels is impossible: each side must be 1 to {}",
        MOST_PIXELS
    )]
    Size {
        /// The requested number of pixels along the rows.
        width: u32,
        /// The requested number of pixels along the columns.
        height: u32,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error("mesh {mesh}: triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    Index {
        /// The index of the mesh in the scene.
        mesh: usize,
        /// The index of the triangle.
        triangle: usize,
        /// The vertex that the triangle names.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of normals or colours is not that of the vertices.
    #[error("mesh {mesh} has {got} {what} for {vertices} vertices: give one each, or none")]
    Attribute {
        /// The index of the mesh in the scene.
        mesh: usize,
        /// `normals` or `colours`.
        what: &'static str,
        /// Number of entries given.
        got: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate that is NaN, or a radius or an opacity out of its range.
    #[error(
        "{what} {index} of the scene is out of range: coordinates must be finite and below 1e100 \
         in size, radii not negative, opacities from 0 to 1"
    )]
    OutOfRange {
        /// `mesh`, `ball` or `tube`.
        what: &'static str,
        /// The index of the item.
        index: usize,
    },
    /// A field that has no isosurface.
    #[error("no isosurface: {0}")]
    Isosurface(&'static str),
    /// The number of values is not that of the points.
    #[error("{got} values were given to colour {points} points: give one each")]
    Values {
        /// Values given.
        got: usize,
        /// Points to colour.
        points: usize,
    },
    /// A shape has a vertex that is not among the given points.
    #[error("the shape has vertex {vertex}, but {points} points were given: give all input points")]
    Point {
        /// The vertex, an input index.
        vertex: u32,
        /// Points given.
        points: usize,
    },
    /// There is not enough memory for the pixels.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// PNG encoding failed.
    #[error("cannot encode the picture as PNG: {0}")]
    Png(#[from] image::ImageError),
    /// A drawing that the rasteriser refuses.
    #[error("cannot rasterise the figure: {0}")]
    Svg(#[from] resvg::usvg::Error),
}

impl Advise for RenderError {
    wrapped!(Memory);
}
