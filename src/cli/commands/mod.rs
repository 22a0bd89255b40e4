//! The commands, and the steps that several of them share.

pub(super) mod balls;
pub(super) mod blocks;
pub(super) mod check;
pub(super) mod compare;
pub(super) mod completions;
#[cfg(feature = "zarr")]
pub(super) mod convert;
pub(super) mod filtration;
mod folder;
pub(super) mod haar;
pub(super) mod info;
pub(super) mod interpolate;
pub(super) mod ladder;
pub(super) mod man;
mod outline;
pub(super) mod pipeline;
pub(super) mod points;
pub(super) mod pores;
#[cfg(feature = "paper")]
pub(super) mod reproduce;
pub(super) mod shape;
mod shape_by;
pub(super) mod shape_in_blocks;
mod shape_of_labels;
#[cfg(feature = "render")]
pub(super) mod view;
