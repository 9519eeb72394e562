//! SIMD lanes.
/// Placeholder until lanes land.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes;
/// Placeholder until lanes land.
pub trait Lane {}
