//! One shape in blocks that need not know each other, on one machine in turn or on many.
//!
//! Everything from a volume to its shape is local once a few numbers are known, so the work is three
//! functions on files. [`Plan::make`] surveys the volume, cuts it into boxes and writes a plan into a folder. [`run`]
//! computes one block from its own samples and those around it, with no other block. [`merge`] joins blocks over
//! their borders. What comes out is the shape that [`alpha_shape`](crate::alpha_shape)
//! computes of the points that a [`Recipe`](crate::Recipe) selects, simplex by simplex and number by number:
//! sums are exact, and ties are broken by indices of the volume.
//!
//! Processes that can send each other messages share the survey, the blocks and the writing of pieces as a [`Team`].
//!
//! ```
//! use walpha::outofcore::{Cutting, Job, Plan, merge, run};
//! use walpha::Recipe;
//!
//! let folder = tempfile::tempdir()?;
//! let job = Job::new("sample:phantom@40", Recipe::new())?;
//! let plan = Plan::make(job, Cutting::default().blocks(4), folder.path())?;
//! // In any order, anywhere, as long as all see the folder; again, if one fails.
//! for block in 0..plan.blocks.len() {
//!     run(&plan, block)?;
//! }
//! let merged = merge(&plan)?;
//! assert_eq!(merged.betti.b0, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod check;
mod cut;
mod digest;
mod digested;
mod error;
mod field;
mod file;
mod job;
mod merge;
mod passes;
mod pieces;
mod plan;
mod price;
mod read_digests;
mod rows;
mod run;
mod sample_box;
mod stamp;
mod survey;
mod team;
mod turn;
mod whole;

pub use check::{Checked, Finding};
pub use error::BlocksError;
use field::Field;
pub use job::Job;
pub use merge::{Merged, merge, merge_monitored};
pub use pieces::Pieces;
pub use plan::{BlockPlan, Cutting, Plan};
pub use price::{Price, price};
use run::BlockSummary;
pub use run::run;
pub use sample_box::SampleBox;
pub use survey::Survey;
pub use team::{Alone, Team};
pub use turn::{run_all, run_missing};
pub use whole::whole;
