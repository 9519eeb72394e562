//! Identification: what was simulated with imperfections is found again, inside the error bars; what cannot be used is refused.

mod bad;
mod coverage;
mod files;
mod recovers;
mod simulated;

use std::path::Path;

use flexure::Robot;
use flexure::robot::robot_from_text;

/// A vertical arm of two joints with drives as harmonic drives have them.
pub const ARM: &str = r#"name = "elbow-arm"
[links]
kind = "tree"
[[links.joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
mass = 4.0
com = [0.2, 0.0, 0.02]
inertia = [0.02, 0.0, 0.0, 0.08, 0.0, 0.08]
[[links.joint]]
name = "elbow"
parent = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
xyz = [0.4, 0.0, 0.0]
mass = 2.5
com = [0.15, 0.0, 0.0]
inertia = [0.01, 0.0, 0.0, 0.03, 0.0, 0.03]
[joints]
stiffness = [9000.0, 4000.0]       # N m/rad, of the data sheet
motor_inertia = [0.5, 0.2]
link_damping = [0.4, 0.2]
motor_damping = [1.0, 0.5]
torque_limit = [80.0, 40.0]
position_lower = -2.5
position_upper = 2.5
[sources]
stiffness = "assumed: data sheet"
"#;

pub fn arm() -> Robot {
    robot_from_text("arm.toml", ARM, Path::new(".")).unwrap_or_else(|problems| panic!("{problems}"))
}
