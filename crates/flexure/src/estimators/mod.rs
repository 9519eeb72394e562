//! Estimators of the motion and of unknown torques: their settings in files, and those of the core by name.

mod any;
pub(crate) mod document;

pub use any::{AnyEstimator, ESTIMATORS, estimator};
pub use document::{DisturbanceObserver, Encoders, Estimator};
