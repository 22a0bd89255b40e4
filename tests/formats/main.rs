//! Files of each format and damage, written here byte by byte, and our own read back.

mod clouds;
mod columns;
#[path = "../common/mod.rs"]
mod common;
mod damage;
mod damaged;
mod described;
mod files;
#[path = "../common/largest.rs"]
mod largest;
mod meshes;
mod mgh;
mod parts;
mod places;
mod points;
mod scattered;
mod shapes;
mod sources;
mod tables;
mod texts;
#[path = "../common/told.rs"]
mod told;
mod values;
mod volumes;
