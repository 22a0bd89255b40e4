//! The `walpha` command.

fn main() {}
