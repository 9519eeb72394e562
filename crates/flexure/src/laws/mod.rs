//! Control laws: their gains in files, gains to start from, and the laws of the core by name.

mod any;
mod baseline;
pub(crate) mod document;
mod rates;
mod shaping;
mod starting;
mod vcbc;

pub use any::{AnyLaw, CONTROLLERS, Law, any_law, command, law, law_over, torque};
pub use baseline::{BASELINES, Baseline, Drive, Gain, Shape};
pub use document::Controller;
pub use rates::BlockRates;
pub use shaping::{AnyShaping, SHAPING};
pub use vcbc::{Phi, SideGains, VcbcGains};
