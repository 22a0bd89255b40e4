//! Files of each format and damage, written here byte by byte, and our own read back.

mod clouds;
#[path = "../common/mod.rs"]
mod common;
mod damage;
mod damaged;
mod files;
mod meshes;
mod parts;
mod places;
mod points;
mod scattered;
mod shapes;
mod sources;
mod tables;
#[path = "../common/told.rs"]
mod told;
mod values;
mod volumes;
