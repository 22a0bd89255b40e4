//! Files that appear under their names when they are complete, or not at all.
//!
//! Content is first written to a temporary file in the same folder, which is renamed when the last byte has been
//! written. Several outputs appear together. A file keeps the mode, owner and names of the one it replaces;
//! inputs are not replaced. For the commands of walpha, and for programs that write shapes with it.
//!
//! ```
//! use std::io::Write;
//! use walpha_files::Target;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("greeting");
//! let failed = Target::open(&path)?.write(|_| Err::<(), _>(std::io::Error::other("no")));
//! assert!(failed.is_err() && !path.exists());
//! Target::open(&path)?.write(|out| out.write_all(b"hello"))?;
//! assert_eq!(std::fs::read(&path)?, b"hello");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]
#![warn(unreachable_pub)]

mod destination;
mod error;
mod filled;
mod identity;
mod inputs;
mod lock;
mod ordinary;
mod partial;
mod scratch;
mod target;
mod unfinished;

pub use error::TargetError;
pub use filled::{Filled, fill_folder, make_folder, put_all};
pub use inputs::{FilesOf, Working, keep_input};
pub use lock::Lock;
pub use ordinary::open_ordinary;
pub use partial::remove_parts;
pub use scratch::Scratch;
pub use target::{Content, FilledAll, Target, fill_all, write_all};
pub use unfinished::{NewFolder, abandon, sweep};
pub use walpha_base::advice::Advise;

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
