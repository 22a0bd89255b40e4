//! All integration tests in one program, because each program links everything again.

mod balls;
#[cfg(feature = "cgal")]
mod binding;
mod blocks_command;
mod check_command;
mod check_engine;
mod cli;
mod command_line;
mod common;
#[cfg(feature = "zarr")]
mod convert;
#[cfg(feature = "dicom")]
mod dicom;
#[cfg(all(unix, feature = "render"))]
mod documents;
mod engines;
mod exchange;
mod filtration;
mod flat;
mod formats;
mod hard;
mod interpolate;
mod keep;
mod labels;
mod ladder;
#[cfg(feature = "las")]
mod las;
mod laws;
#[cfg(feature = "las")]
mod lidar;
mod molecules;
#[cfg(feature = "mpi")]
mod mpi;
#[cfg(target_os = "linux")]
mod nothing;
mod opened_once;
#[cfg(feature = "cgal-oracles")]
mod oracles;
mod outline;
#[cfg(unix)]
mod outputs;
mod periodic;
#[cfg(feature = "render")]
mod pictures;
#[cfg(feature = "paper")]
mod plane;
mod refit;
#[cfg(feature = "paper")]
mod reproduce;
mod single;
mod skull;
mod surface;
mod triangulation;
#[cfg(feature = "render")]
mod view;
mod volume;
#[cfg(unix)]
mod working_folders;
mod wrong_answers;
mod wvm;
#[cfg(feature = "zarr")]
mod zarr;
#[cfg(feature = "zarr")]
mod zarr_shape;
