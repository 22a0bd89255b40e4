//! The α-complex, block by block.
//!
//! The α-complex is local. A simplex of the shape has an orthogonal sphere of squared radius at most α, so each
//! of its vertices v lies within √(α + ω(v)) of the sphere's centre, and a point q that could refute
//! it, by lying inside, within √(α + ω(q)). The points of a block and those within
//! √(α + ω(q)) + √(α + max ω of the block) of its box, its *halo*, therefore decide every simplex that
//! has a vertex in the block. Ties too: a face of the lower hull of all lifted points is one of any
//! subset that has its vertices, and ties are broken by raising lifted points in an order of their
//! coordinates, which does not depend on what other points there are.
//!
//! With `Balls::Radius` the weights are (α + ω)² and α is 0; the same bound is then the sum of the two
//! radii.
//!
//! A block owns the simplices whose smallest vertex (by input index) lies in it. [`partition`] cuts sites into blocks,
//! [`plan`] decides into how many, [`classify`] finds the simplices that a block owns, and [`merge`] merges them.

mod block;
mod block_shape;
mod classify;
mod gather;
mod merge;
mod partition;
mod plan;
mod run;
mod spanning;
mod torus;

pub(super) use block::{Block, BlockParams};
pub use block_shape::{BlockShape, Own, Side, block_shape};
pub(crate) use classify::Long;
pub(crate) use partition::{Partition, Reach};
pub use plan::AT_WORK;
pub(super) use plan::{Limits, Plan};
pub(super) use run::{mesh, run};
pub(crate) use torus::{too_long, whole_on_torus};
