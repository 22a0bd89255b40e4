//! Files of each format and damage, written here byte by byte, and our own read back.

#[path = "../common/mod.rs"]
mod common;
mod damage;
mod damaged;
mod files;
mod parts;
mod places;
mod points;
mod shapes;
mod sources;
mod tables;
#[path = "../common/told.rs"]
mod told;
mod values;
mod volumes;
