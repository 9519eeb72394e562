//! Laws of the number types, through the public API.
//!
//! Every type is a [`probe::Probe`]: the laws are written once and run on all of them, nested ones included.
#![expect(clippy::float_cmp, reason = "laws that hold exactly are tested exactly")]

mod derivatives;
mod laws;
mod oracle;
mod probe;

#[cfg(feature = "interval")]
mod containment;
#[cfg(feature = "interval")]
mod intervals;
#[cfg(feature = "lanes")]
mod lanes;
#[cfg(feature = "interval")]
mod tightness;
