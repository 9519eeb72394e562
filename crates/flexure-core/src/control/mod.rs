//! Control laws.

mod gains;
mod rigid;
mod shaping;
mod vcbc;

pub use gains::{LinkGains, LinkTorque, Metric, MotorGains};
pub use rigid::RigidVcbc;
pub use shaping::{CoupledTanh, Linear, Shaping, Tanh};
pub use vcbc::{Command, Input, Vcbc};
