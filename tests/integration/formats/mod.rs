//! Files of each format and damage, written here byte by byte, and our own read back.

mod damaged;
mod described;
mod fields;
mod files;
mod parts;
mod places;
mod points;
mod shapes;
mod sources;
mod tables;
mod texts;
mod values;
mod volumes;
