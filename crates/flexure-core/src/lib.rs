//! Flexible-joint robots and virtual-contraction control, written once over a number type.
//!
//! Everything here is `no_std`, allocates nothing and has no panic path: it is what runs on the robot's
//! controller. The same functions evaluated on [`scalar::Jet`] give exact time derivatives, on [`scalar::Dual`]
//! Jacobians, on `Interval` rigorous bounds and on `Lanes` batches.

#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::unreachable
    )
)]

// Fused multiplication for intervals.
#[cfg(all(feature = "std", target_feature = "fma"))]
extern crate std;

mod array;
pub mod contraction;
pub mod control;
pub mod estimate;
pub mod guard;
pub mod linalg;
pub mod memory;
pub mod model;
pub mod reference;
pub mod robots;
pub mod scalar;
pub mod spatial;
pub mod virtual_system;
