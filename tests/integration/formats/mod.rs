//! Files of each format and damage, written here byte by byte, and our own read back.

mod clouds;
mod columns;
mod damage;
mod damaged;
mod described;
mod files;
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
mod values;
mod volumes;
