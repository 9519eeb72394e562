//! Where names become types: robots, shaping functions, references and controllers. One new file plus one line adds a
//! member.

mod controller;
mod reference;
mod robot;
mod shaping;

pub use controller::{CONTROLLERS, Law, command, law, law_over};
pub use reference::{AnyReference, REFERENCES};
pub(crate) use robot::vector;
pub use robot::{
    MAX_JOINTS, PairVisitor, RobotVisitor, TwinVisitor, supported, with_enclosed_robot, with_pair,
    with_robot, with_twins,
};
pub use shaping::{AnyShaping, SHAPING};

/// A registered name and what it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The name in files and on the command line.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
}
