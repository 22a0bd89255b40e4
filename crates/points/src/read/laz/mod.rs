//! LAZ, compressed LAS: what a file claims of its compression is checked, then its points are decompressed.
//!
//! The library `laz` decompresses all fields but GPS times, because it decodes a change of their sequence by calling itself, which
//! damaged data can ask for until the stack is exhausted.

mod claims;
mod records;
mod times;

pub(super) use claims::Claims;
pub(super) use records::Records;
