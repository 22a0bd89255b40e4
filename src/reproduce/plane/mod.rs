//! Alpha shapes in the plane, as in Figures 2 to 4 of the paper.
//!
//! Two families share the name. Those of Edelsbrunner, Kirkpatrick and Seidel (1983) are made of
//! *generalised discs* whose α is a signed curvature, [`Curvature`]: [`eks_shape`]. The weighted
//! ones (Edelsbrunner 1992) are made of discs of squared radius α + ω, [`Alpha`](crate::Alpha):
//! [`weighted_plane_shape`]. What belongs to a shape is decided exactly; curves drawn around it
//! ([`OutlinePiece`]) are rounded.
//!
//! Points are (x, y), in any one unit; results name them by input index. One point is enough, and points
//! may be collinear. Of several points at the same position the heaviest is kept, of equally heavy ones
//! the first.
//!
//! ```
//! use walpha::Alpha;
//! use walpha::reproduce::plane::{Curvature, eks_shape, weighted_plane_shape};
//!
//! let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]];
//! // α = 0 makes half-planes of the discs, and the convex hull of the shape.
//! assert_eq!(eks_shape(&square, Curvature::new(0.0)?)?.edges().len(), 4);
//! // Discs of squared radius 1/4 about corners and middle cover the square; small ones do not meet.
//! let betti = |alpha| -> Result<_, Box<dyn std::error::Error>> {
//!     let shape = weighted_plane_shape(&square, &[0.0; 5], Alpha::from_squared(alpha)?)?;
//!     Ok(shape.complex().betti())
//! };
//! assert_eq!(betti(0.25)?, [1, 0]);
//! assert_eq!(betti(0.1)?, [5, 0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod contact;
pub(in crate::reproduce) mod curve;
mod eks;
mod exact;
mod hull;
mod mesh;
mod power_cell;
mod sample;
mod weighted;

pub use curve::{Arc, OutlinePiece};
pub use eks::{Curvature, NotACurvature};
pub use eks::{EksShape, NoDisc, eks_shape};
pub use hull::AlphaHull;
pub use mesh::PlaneError;
pub use power_cell::PowerCell;
pub use sample::{sample_discs, sample_points};
pub use weighted::{PlaneComplex, WeightedPlaneShape, weighted_plane_shape};
