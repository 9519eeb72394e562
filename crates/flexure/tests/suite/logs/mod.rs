//! Logs: what is read is what was written, whatever names, units and signs it has; what cannot be true is refused.

mod bad;
mod good;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use flexure::Robot;
use flexure::files::{Problem, Problems};
use flexure::logs::{Columns, Log, read_log};
use flexure::robot::robot_from_text;

/// An arm with limits and gears.
pub const ARM: &str = r#"
name = "arm"
[links]
kind = "planar-two-link"
mass = [1.5, 0.9]
length = [0.3, 0.3]
com = [0.15, 0.12]
inertia = [0.04, 0.008]
[joints]
stiffness = [90.0, 40.0]
motor_inertia = [0.2, 0.1]
link_damping = 0.1
motor_damping = 0.5
gear_ratio = [100.0, -80.0]
torque_limit = [20.0, 10.0]
velocity_limit = 5.0
position_lower = -2.0
position_upper = 2.0
[sources]
"#;

pub fn arm() -> Robot {
    robot_from_text("arm.toml", ARM, Path::new(".")).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The time, and positions of links and motors and torques of two joints, at `k` ms.
pub fn sample(k: usize) -> (f64, [f64; 2], [f64; 2], [f64; 2]) {
    let t = 1e-3 * k as f64;
    let q_l = [0.5 * (3.0 * t).sin(), 0.3 * (5.0 * t).cos()];
    let q_m = [q_l[0] + 0.02 * (9.0 * t).sin(), q_l[1] - 0.01];
    (t, q_l, q_m, [5.0 * (3.0 * t).cos(), -2.0 * (5.0 * t).sin()])
}

/// A file with `header` and a row for each of 200 samples.
pub fn written(header: &str, row: impl Fn(usize) -> String) -> String {
    let mut text = format!("{header}\n");
    for k in 0..200 {
        writeln!(text, "{}", row(k)).unwrap();
    }
    text
}

/// As a trace without devices has it.
pub const HEADER: &str = "t,q_l1,q_l2,q_m1,q_m2,u_m1,u_m2";

pub fn row(k: usize) -> String {
    let (t, [a, b], [c, d], [e, f]) = sample(k);
    format!("{t},{a},{b},{c},{d},{e},{f}")
}

/// The log in a file with `text`, read with the columns that `said` says.
pub fn read(text: &str, said: Option<&str>) -> Result<(Log, Vec<Problem>), Problems> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    fs::write(&path, text).unwrap();
    let columns = said.map_or(Ok((Columns::default(), Vec::new())), |said| Columns::read(said, &arm()))?.0;
    read_log(&path, &columns, &arm())
}
