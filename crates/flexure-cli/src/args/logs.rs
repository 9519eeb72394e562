//! Arguments of commands about logs of the robot.

use std::path::PathBuf;

use clap::Args;
use flexure::excite::{BUDGET, RESOLUTION};
use flexure::replay::HORIZON;

use super::{Output, Paged};

#[derive(Debug, Args)]
pub struct Excite {
    /// Robot file, or the name of a built-in robot.
    pub robot: String,
    /// Length of the motion, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 20.0, allow_negative_numbers = true)]
    pub duration: f64,
    /// Control period of the robot, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.001, allow_negative_numbers = true)]
    pub control_period: f64,
    /// Link positions that the motion is about, rad or m, as 0,-0.5,1.2; default the middle of the limits.
    #[arg(long, value_name = "Q1,Q2,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub posture: Option<Vec<f64>>,
    /// One count of the encoders on the links, rad; default 2π/2¹⁷, 47.9e-6.
    #[arg(long, value_name = "RAD", default_value_t = RESOLUTION, hide_default_value = true, allow_negative_numbers = true)]
    pub link_resolution: f64,
    /// One count of the encoders on the motors, rad on the link side of the gear; default 2π/2¹⁷, 47.9e-6.
    #[arg(long, value_name = "RAD", default_value_t = RESOLUTION, hide_default_value = true, allow_negative_numbers = true)]
    pub motor_resolution: f64,
    /// The links have no encoders.
    #[arg(long, conflicts_with = "link_resolution")]
    pub motor_only: bool,
    /// Sets of phases that are tried for each joint, for the smallest peaks.
    #[arg(long, value_name = "SETS", default_value_t = BUDGET)]
    pub budget: usize,
    /// Seed of the phases.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Scenario file; default ROBOT-excite.toml beside the robot's file.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct Replay {
    /// Scenario file, or the name of a built-in scenario.
    pub scenario: String,
    /// Log of the robot: CSV, a trace of `flexure run` or any other with --columns.
    #[arg(long, value_name = "FILE")]
    pub log: PathBuf,
    /// Which column is what: a TOML file, or q_l=link_pos_{},q_l.unit=deg,u_m=tau_{} and so on.
    #[arg(long, value_name = "MAP")]
    pub columns: Option<String>,
    /// Length of the windows over which the robot is predicted from the logged torque, s.
    #[arg(long, value_name = "SECONDS", default_value_t = HORIZON, allow_negative_numbers = true)]
    pub horizon: f64,
    #[command(flatten)]
    pub output: Output,
}

#[derive(Debug, Args)]
pub struct Identify {
    /// Robot file, or the name of a built-in robot; numbers to be found may be guesses or nan.
    pub robot: String,
    /// Log of the robot: CSV, a trace of `flexure run` or any other with --columns; may be given several times.
    #[arg(long = "log", value_name = "FILE", required = true)]
    pub logs: Vec<PathBuf>,
    /// Which column is what: a TOML file, or q_l=link_pos_{},q_l.unit=deg,u_m=tau_{} and so on.
    #[arg(long, value_name = "MAP")]
    pub columns: Option<String>,
    /// Fit nothing of the links, as if only the motors had encoders: a trace has the links' positions even so.
    #[arg(long)]
    pub motor_only: bool,
    /// Part of each log, at its end, that is kept from the fit to judge it by.
    #[arg(long, value_name = "PART", default_value_t = 0.2, allow_negative_numbers = true)]
    pub hold_out: f64,
    /// Largest error of a stiffness or motor inertia, as a part of it, for the number to be taken over.
    #[arg(long, value_name = "PART", default_value_t = 0.2, allow_negative_numbers = true)]
    pub accuracy: f64,
    /// Robot file to write, with the numbers found and everything else as it is.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub paged: Paged,
}
