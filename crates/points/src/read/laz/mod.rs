//! LAZ, compressed LAS: checks the claims of a file about its compression, then decompresses its points.
//!
//! The library `laz` decompresses all fields except GPS times. It decodes a change of their sequence by recursion, which damaged
//! data can repeat until the stack is exhausted.

mod claims;
mod layers;
mod records;
mod times;

pub(super) use claims::Claims;
pub(super) use records::Records;
