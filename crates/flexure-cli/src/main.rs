//! The command line of Flexure.
fn main() {}
