//! Control laws: v-CBC, and those it is compared with, behind [`ControlLaw`].

mod gains;
mod law;
mod motor_pd;
mod pd;
mod pd_online_gravity;
mod rigid;
mod shaping;
mod vcbc;

pub use gains::{LinkGains, LinkTorque, Metric, MotorGains};
pub use law::ControlLaw;
pub use motor_pd::MotorPd;
pub use pd::Pd;
pub use pd_online_gravity::PdOnlineGravity;
pub use rigid::RigidVcbc;
pub use shaping::{CoupledTanh, Linear, Shaping, Tanh};
pub use vcbc::{Command, Input, Vcbc};
