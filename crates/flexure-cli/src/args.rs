//! The command line's grammar.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Model, design, simulate and compare controllers for robots with elastic joints.
#[derive(Debug, Parser)]
#[command(
    name = "flexure",
    bin_name = "flexure",
    version,
    propagate_version = true,
    arg_required_else_help = true
)]
#[command(after_help = "Exit codes: 0 done; 1 the answer is no, as for a loop that diverges; 2 bad input.")]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// Print one JSON document on stdout and nothing else there.
    #[arg(long, global = true)]
    pub json: bool,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the paper's experiments: table, figures, traces and report.html.
    Reproduce(Output),
    /// Simulate one closed loop: summary, trace and figure.
    Run {
        /// Scenario file, or the name of a built-in scenario.
        scenario: String,
        #[command(flatten)]
        output: Output,
    },
    /// Evaluate the control law at given states.
    Eval {
        /// Scenario file, or the name of a built-in scenario.
        scenario: String,
        /// JSON Lines with t, q_l, q_m, dq_l, dq_m; - for standard input.
        #[arg(long, value_name = "FILE")]
        states: PathBuf,
    },
    /// Evaluate the robot model at given states.
    Model {
        /// Robot file, or the name of a built-in robot.
        robot: String,
        /// JSON Lines with q_l, q_m, dq_l, dq_m and, for dx, u_m; - for standard input.
        #[arg(long, value_name = "FILE")]
        states: PathBuf,
    },
    /// Validate robot and scenario files.
    Check {
        /// Files, or names of built-in robots and scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<String>,
    },
    /// List what is registered.
    List {
        /// What to list; everything if left out.
        kind: Option<Kind>,
    },
}

#[derive(Debug, Args)]
pub struct Output {
    /// Folder for the files that are written; created if missing.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    Robots,
    Scenarios,
    Shaping,
    References,
    Controllers,
}
