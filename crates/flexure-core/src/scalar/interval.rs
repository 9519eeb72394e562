//! Outward-rounded intervals.
/// Placeholder until the interval type lands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval;
