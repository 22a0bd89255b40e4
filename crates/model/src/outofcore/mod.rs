//! Computes one shape in independent blocks, on one machine or on many.
//!
//! Once a few numbers are known, every step from a volume to its shape is local, so the work consists of three functions on
//! files. [`Plan::make`] surveys the volume, cuts it into boxes and writes a plan into a folder. [`run`] computes one block from
//! its own samples and those around it, without any other block. [`merge`] joins blocks across their borders. The result is the
//! shape that [`alpha_shape`](walpha_shape::alpha_shape) computes from the points that a [`Recipe`](crate::Recipe) selects,
//! simplex by simplex and number by number: sums are exact, and ties are broken by indices in the volume.
//!
//! Processes that can exchange messages share the survey, the blocks and the writing of pieces as a [`Team`].
//!
//! # Step by step
//! - *Reading*: `volume::Source` reads any box of a volume without the rest (rows of uncompressed files, chunks of
//!   Zarr, the phantom).
//! - *Wavelets*: the levels below 2ᵏ stay within *bricks* of 2ᵏ samples a side (k = 3, or 4 for large volumes); the
//!   levels above are a transform of the bricks' sums alone, an 8ᵏ-th of the samples, which the plan holds
//!   (`haar::Bricks`). The standard decomposition has functions as long as the volume: the first process transforms
//!   it in a file, planes along x and y, then walls along z (`haar::Slabs`, `truncate.rs`), and leaves the
//!   truncated volume in the folder of the plan.
//! - *Global numbers* (`survey.rs`): the gray range; which coefficients stay and which samples become points, each
//!   found by `select::Search` in rounds of counting digits of (magnitude, index) until few enough are left to be
//!   listed; min, max and ΣL; the number of points of each brick, by which the volume is cut into boxes of bricks
//!   with about equally many points (`plan.rs`).
//! - *A block* (`run.rs`) selects its own points and those within the margin again from the samples there: it needs
//!   the plan, the input and no other block. `shape::block_shape` classifies them with the code of the engines.
//!   Where a block and its halo are flat, four places are added whose balls are empty: they are in no simplex of
//!   the shape and refute none.
//! - *Names*: points are named by their index in the volume, 64 bits, in files and keys, and by their rank within
//!   the block, 32 bits, at work. Both orders are that of the input indices of one piece, so rows, owners and ties
//!   are the same.
//! - *Trust* (`bytes.rs`, `block_file.rs`, `plan_files.rs`): each file has digests over all of its bytes, and
//!   is verified where it is read: `plan.json` ends with its own, a block's start has that of its header, which has
//!   those of its arrays, and the plan has those of the files beside it. What verifies is still looked at
//!   (`BlockFile::fits`, `read_rows`), because fuzzers skip digests (`cfg(fuzzing)`). `run` makes again what does not
//!   verify.
//! - *What was read* (`brick_digests.rs`): all passes and blocks read whole bricks of samples. Each read notes the
//!   digest of every brick, the plan keeps one digest of the bricks that each block will read, and the block
//!   compares. The size and time of files (`job.rs`) only decide whether interrupted work is planned again.
//! - *Merging* (`merge.rs`) reads the summaries and border keys of blocks, never rows; the command verifies all of
//!   them first: points at edges between blocks unite components, sides of facets and singular edges unite sheets.
//!   A sheet's number comes from the first row that it is met in.
//! - *Outputs* (`blockwise.rs`) are filled and wait until all outputs of all processes are, and take a block at a time:
//!   VTK's parallel formats, a file for each block, and arrays of Zarr. One file of any other format takes the
//!   memory of the whole shape (`whole.rs`).
//! - *Teams* (`team.rs`): processes with ranks share tiles of the survey, blocks and pieces. What each found is
//!   joined along a binomial tree, in whatever order, as counts and sums are exact. The command's team is MPI
//!   (`cli/process/mpi.rs`, feature `mpi`): the first rank reads the command line and sends the others their work
//!   (`cli/commands/shape_in_blocks.rs`). MPI is used by the main thread alone, asked now and then rather than waited in, and
//!   finalised by a destructor; a failure or a panic aborts all ranks.
//!
//! ```
//! use walpha_model::outofcore::{Alone, Cutting, Job, Plan, merge, run};
//! use walpha_model::Recipe;
//!
//! let folder = tempfile::tempdir()?;
//! let job = Job::new("sample:phantom@40", Recipe::new())?;
//! let plan = Plan::make(job, Cutting::default().blocks(4), folder.path(), &Alone)?;
//! // In any order, anywhere, as long as all see the folder; again, if one fails.
//! for block in 0..plan.blocks.len() {
//!     run(&plan, block)?;
//! }
//! let merged = merge(&plan)?;
//! assert_eq!(merged.betti.b0, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod block_file;
mod blockwise;
mod brick_digests;
mod bytes;
mod cost;
mod error;
mod field;
mod job;
mod merge;
mod plan;
mod plan_files;
mod run;
mod sample_box;
mod survey;
mod team;
mod truncate;
mod whole;
#[cfg(feature = "zarr")]
mod zarr;

pub use blockwise::BlockwiseFormat;
pub use cost::{CostEstimate, estimate_cost};
pub use error::{BlocksError, Finding};
pub use job::Job;
pub use merge::{Merged, merge};
pub use plan::{BlockPlan, Cutting, Plan};
pub use plan_files::Checked;
pub use run::{run, run_all, run_missing};
pub use sample_box::SampleBox;
pub use survey::Survey;
pub use team::{Alone, Team};
pub use whole::whole;
