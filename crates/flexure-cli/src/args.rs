//! The command line's grammar.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use flexure::compare::{BUDGET, SEEDS};
use flexure::excite::{BUDGET as EXCITE_BUDGET, RESOLUTION};
use flexure::files::{Change, prepare_for};
use flexure::replay::HORIZON;
use flexure::report::{page_names, stem};
use flexure::robot::DriveClass;

use crate::failure::Failure;

/// Model, design, simulate and compare controllers for robots with elastic joints.
#[derive(Debug, Parser)]
#[command(
    name = "flexure",
    bin_name = "flexure",
    version,
    propagate_version = true,
    arg_required_else_help = true
)]
#[command(
    after_help = "Exit codes: 0 done; 1 the answer is no, as for a loop that diverges; 2 bad input; 3 not decided within the budget; \
    130 broken off by Ctrl-C, with what was found until then.\n\nExamples:\n  flexure run two-link-tanh-smooth --out out\n  flexure check panda"
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// Print one JSON document on stdout and nothing else there.
    #[arg(long, global = true)]
    pub json: bool,

    /// Let files name files outside of their own folders, as a scenario may a robot or samples, and a robot a URDF.
    #[arg(long, global = true)]
    pub allow_outside: bool,

    /// Change a key of the scenario before it is read, as controller.link.metric=[1, 2]; may be given several times.
    #[arg(long, global = true, value_name = "KEY=VALUE", value_parser = change)]
    pub set: Vec<Change>,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    #[command(after_help = "Example:\n  flexure reproduce --out out")]
    /// Run the paper's experiments: table, figures, traces and report.html.
    Reproduce(Output),
    #[command(
        after_help = "Examples:\n  flexure run two-link-tanh-smooth --out out\n  flexure run two-link-hardware --columns 'q_l*,u_m?' --every 10\n  flexure run --view two-link-linear-smooth two-link-tanh-smooth"
    )]
    /// Simulate one closed loop: summary, trace and figure.
    Run {
        /// Scenario file, or the name of a built-in scenario.
        scenario: String,
        /// With --view: another one, for the same page.
        #[arg(value_name = "BESIDE")]
        beside: Option<String>,
        #[command(flatten)]
        traced: Traced,
    },
    #[command(
        after_help = "Example:\n  flexure compare task-soft --controllers vcbc,vcbc:tanh,cascade --budget 5"
    )]
    /// Compare control laws, each with gains from the same search: table, figures and compare.html.
    Compare(Compare),
    #[command(
        after_help = "Examples:\n  flexure eval two-link-tanh --states states.jsonl\n  flexure eval two-link-tanh --states - < states.jsonl"
    )]
    /// Evaluate the control law at given states.
    Eval {
        /// Scenario file, or the name of a built-in scenario.
        scenario: String,
        /// JSON Lines with t, q_l, q_m, dq_l, dq_m; - for standard input.
        #[arg(long, value_name = "FILE")]
        states: PathBuf,
    },
    #[command(after_help = "Example:\n  flexure model quanser-2dof --states states.jsonl")]
    /// Evaluate the robot model at given states.
    Model {
        /// Robot file, or the name of a built-in robot.
        robot: String,
        /// JSON Lines with q_l, q_m, dq_l, dq_m and, for dx, u_m; - for standard input.
        #[arg(long, value_name = "FILE")]
        states: PathBuf,
    },
    #[command(after_help = "Example:\n  flexure certify two-link-tanh --error-box 3 --direct")]
    /// Prove how fast the closed loop contracts, and where; write a certificate that others can check.
    Certify(Certify),
    #[command(
        after_help = "Examples:\n  flexure import panda.urdf --lock panda_finger_joint1=0 > arm.toml\n  flexure import panda.urdf --lock panda_finger_joint1=0 --assume harmonic-drive --scenario"
    )]
    /// Draft a robot file from a URDF, and a scenario for it; what is still to be supplied is marked.
    Import(Import),
    #[command(after_help = "Example:\n  flexure check panda panda-tanh-smooth")]
    /// Validate robot and scenario files; show the joints of robots.
    Check {
        /// Files, or names of built-in robots and scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<String>,
        /// Draw how each joint of the robots answers its motor over frequency, into this folder; created if missing.
        #[arg(long, value_name = "FOLDER")]
        figure: Option<PathBuf>,
    },
    #[command(
        after_help = "Example:\n  flexure verify out/two-link-tanh.certificate.json --against two-link-tanh"
    )]
    /// Check a certificate's claims without what made it.
    Verify {
        /// Certificate, a JSON file as docs/certificate.md has it.
        #[arg(value_name = "CERTIFICATE")]
        certificate: PathBuf,
        /// Scenario, a file or a built-in name: is it the loop that the certificate is about?
        #[arg(long, value_name = "SCENARIO")]
        against: Option<String>,
    },
    #[command(after_help = "Example:\n  flexure tune two-link-hardware --budget 10 --out tuned.toml")]
    /// Find gains: a complete scenario, what each gain trades, every constraint with its slack, and the evidence.
    Tune(Tune),
    #[command(
        after_help = "Examples:\n  flexure margins two-link-hardware\n  flexure margins task-soft --controllers cascade --budget 5"
    )]
    /// Measure how much delay, gain error, stiffness error and noise a loop bears, by bisection in simulation.
    Margins(Margins),
    #[command(
        args_conflicts_with_subcommands = true,
        subcommand_negates_reqs = true,
        disable_help_subcommand = true,
        after_help = "Examples:\n  flexure sweep sweep.toml --out study\n  flexure sweep sweep.toml --out study --shards 0..8\n  flexure sweep show study\n  flexure sweep replay study --row 8123"
    )]
    /// Run a scenario many times with changed numbers: rows of metrics as Parquet files, computed shard by shard.
    Sweep(Sweep),
    #[command(after_help = "Example:\n  flexure excite planar-2r --budget 5 --out excite.toml")]
    /// Design the motion that tells most about a robot's joints, inside all limits: a scenario file.
    Excite(Excite),
    #[command(after_help = "Example:\n  flexure replay two-link-tanh --log out/two-link-tanh.csv")]
    /// Lay a log of the robot over the simulation: closed loop, prediction from window to window, residuals.
    Replay(Replay),
    #[command(
        after_help = "Example:\n  flexure identify planar-2r --log out/excite.csv --out identified.toml"
    )]
    /// Find stiffness, motor inertia, damping and friction of the joints from logs, with error bars.
    Identify(Identify),
    #[command(after_help = "Example:\n  flexure list scenarios")]
    /// List what is registered.
    List {
        /// What to list; everything if left out.
        kind: Option<Kind>,
    },
    #[command(after_help = "Example:\n  flexure completions bash > flexure.bash")]
    /// Print the script that lets a shell complete this command's words.
    Completions {
        /// The shell.
        shell: Shell,
    },
    #[command(after_help = "Examples:\n  flexure man > flexure.1\n  flexure man man1")]
    /// Print the manual page, or write a page for each command.
    Man {
        /// Folder for flexure.1, flexure-run.1 and the others; without it the first is printed.
        #[arg(value_name = "DIR")]
        folder: Option<PathBuf>,
    },
}

#[derive(Debug, Args)]
pub struct Output {
    /// Folder for the files that are written; created if missing.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// Where a run leaves its files, and what its trace has.
#[derive(Debug, Args)]
pub struct Traced {
    #[command(flatten)]
    pub output: Output,
    /// Columns of the trace, names in which * is any text and ? any character; t is always there. All if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Write every Nth row of the trace, from the first on: one in N control periods. Summary and figure see them all.
    #[arg(long, value_name = "N", default_value = "1", value_parser = every, allow_negative_numbers = true)]
    pub every: NonZeroU32,
    /// Write a page with the robot in motion, too: one file for any browser, which needs no network.
    #[arg(long)]
    pub view: bool,
}

/// Where the page of an answer goes.
#[derive(Debug, Args)]
pub struct Paged {
    /// Write a page with the answer as a picture and in numbers into this folder, too; created if missing.
    #[arg(long, value_name = "FOLDER")]
    pub page: Option<PathBuf>,
}

impl Paged {
    /// That a page about `name` with so many figures can be written, if one is asked for, and that it is not in the place of the file `out`:
    /// said before the work, not after.
    pub fn prepare(
        &self,
        name: &str,
        command: &str,
        figures: usize,
        out: Option<&Path>,
    ) -> Result<(), Failure> {
        let Some(folder) = &self.page else { return Ok(()) };
        let names = page_names(&stem(name, command), figures);
        let place = |path: &Path| std::path::absolute(path).ok();
        let taken = |out: &&Path| {
            std::iter::once(folder.clone())
                .chain(names.iter().map(|name| folder.join(name)))
                .any(|path| place(&path) == place(out))
        };
        if let Some(out) = out.filter(taken) {
            let message = format!("{} is what --out writes, and where the page goes", out.display());
            return Err(Failure::input("usage", message, "give the page a folder of its own"));
        }
        Ok(prepare_for(folder, names)?)
    }
}

#[derive(Debug, Args)]
pub struct Import {
    /// URDF file.
    pub urdf: String,
    /// Hold a joint still at a position, rad or m; may be given several times.
    #[arg(long, value_name = "JOINT=POSITION", value_parser = lock)]
    pub lock: Vec<(String, f64)>,
    /// Class of drives, of `flexure list drives`, that stands in for what a URDF does not say; listed as assumed.
    #[arg(long, value_name = "DRIVES", value_parser = drives)]
    pub assume: Option<&'static DriveClass>,
    /// Limits of zero, and ranges without width, stand for what nobody knew: take them as none instead of refusing them.
    #[arg(long)]
    pub unknown_limits: bool,
    /// Draft a scenario, too: files instead of standard output.
    #[arg(long)]
    pub scenario: bool,
    /// Folder for NAME.toml and NAME-scenario.toml, or the robot file, PATH.toml; default with --scenario: the current folder.
    #[arg(long, value_name = "PATH")]
    pub out: Option<PathBuf>,
    /// Replace files that exist.
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub struct Certify {
    /// Scenario file, or the name of a built-in scenario.
    pub scenario: String,
    /// Largest position errors in rad: one number, or links then motors, one per joint.
    #[arg(
        long,
        value_name = "R",
        value_delimiter = ',',
        allow_negative_numbers = true,
        conflicts_with = "initial_error"
    )]
    pub error_box: Option<Vec<f64>>,
    /// Position errors at the start in rad, momentum errors none: certifies the level of W that holds them.
    #[arg(long, value_name = "E", value_delimiter = ',', allow_negative_numbers = true)]
    pub initial_error: Option<Vec<f64>>,
    /// Contraction rate to prove or refute, 1/s; the largest if left out.
    #[arg(long, value_name = "RATE", allow_negative_numbers = true)]
    pub rate: Option<f64>,
    /// Largest unknown torque on each motor in N m: certifies the tube that errors settle in.
    #[arg(long, value_name = "D", value_delimiter = ',', allow_negative_numbers = true)]
    pub disturbance: Option<Vec<f64>>,
    /// Prove the rate once more, from the full inequality without any theorem.
    #[arg(long)]
    pub direct: bool,
    /// With --direct: largest speed of the links, rad/s.
    #[arg(long, value_name = "V", default_value_t = 5.0, allow_negative_numbers = true, requires = "direct")]
    pub speed: f64,
    /// With --direct: boxes that may be looked at.
    #[arg(long, value_name = "BOXES", default_value_t = 1000, requires = "direct")]
    pub budget: usize,
    /// Answer no (exit code 1) where the proof is about the ideal loop and the file has more: imperfections, plant options, an
    /// estimator, a guard.
    #[arg(long)]
    pub strict: bool,
    /// Certificate file; default out/NAME.certificate.json.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub paged: Paged,
}

#[derive(Debug, Args)]
pub struct Compare {
    /// Scenario files, or names of built-in scenarios; the suite of tasks if left out.
    #[arg(value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Laws: names of `flexure list controllers`, vcbc:tanh, vcbc:coupled-tanh; the first list and vcbc:tanh if left out.
    #[arg(long, value_name = "LAW", value_delimiter = ',')]
    pub controllers: Vec<String>,
    /// Runs that the search for gains may simulate, for each law, task and seed.
    #[arg(long, value_name = "RUNS", default_value_t = BUDGET)]
    pub budget: usize,
    /// First seed of search and imperfections.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Number of seeds: what ranks is the median, and places that overlap are ties.
    #[arg(long, value_name = "COUNT", default_value_t = SEEDS)]
    pub seeds: usize,
    #[command(flatten)]
    pub output: Output,
}

#[derive(Debug, Args)]
pub struct Tune {
    /// Scenario file, or the name of a built-in scenario; its gains may be left out.
    pub scenario: String,
    /// What the loop shall do: rate, delays, uncertainty, margins, references.
    #[arg(long, value_name = "SPEC")]
    pub spec: Option<PathBuf>,
    /// Runs that the search for gains may simulate.
    #[arg(long, value_name = "RUNS", default_value_t = flexure::design::BUDGET)]
    pub budget: usize,
    /// Seed of the search.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Scenario file to write; default NAME-tuned.toml beside the scenario.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub paged: Paged,
}

#[derive(Debug, Args)]
pub struct Sweep {
    #[command(subcommand)]
    pub of: Option<OfFolder>,
    /// Sweep file: a scenario, which of its numbers change, which points, what is kept.
    #[arg(required = true, value_name = "SWEEP")]
    pub file: Option<String>,
    /// Shards to compute, counted from 0: A..B without B, or one; all if left out. Those that are there stay.
    #[arg(long, value_name = "A..B")]
    pub shards: Option<String>,
    /// Folder of the rows; created if missing; default out/SWEEP.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub paged: Paged,
}

#[derive(Debug, Subcommand)]
pub enum OfFolder {
    /// Run a row again: summary, trace and figure.
    Replay {
        /// Folder of a sweep.
        folder: PathBuf,
        /// The row, counted from 0.
        #[arg(long)]
        row: u64,
        #[command(flatten)]
        traced: Traced,
    },
    /// Tell what the rows that are there come to.
    Show {
        /// Folder of a sweep.
        folder: PathBuf,
        #[command(flatten)]
        paged: Paged,
    },
}

#[derive(Debug, Args)]
pub struct Margins {
    /// Scenario file, or the name of a built-in scenario.
    pub scenario: String,
    /// Laws to measure instead of the scenario's, with gains from the search of `compare`.
    #[arg(long, value_name = "LAW", value_delimiter = ',')]
    pub controllers: Vec<String>,
    /// With --controllers: runs that the search for gains may simulate, for each law.
    #[arg(long, value_name = "RUNS", default_value_t = BUDGET, requires = "controllers")]
    pub budget: usize,
    /// With --controllers: seed of the search.
    #[arg(long, default_value_t = 0, requires = "controllers")]
    pub seed: u64,
    #[command(flatten)]
    pub paged: Paged,
}

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
    #[arg(long, value_name = "SETS", default_value_t = EXCITE_BUDGET)]
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    Robots,
    Scenarios,
    Shaping,
    References,
    Controllers,
    Imperfections,
    Drives,
}

impl Command {
    /// Its name, if it takes no scenario that `--set` could change.
    pub fn without_scenario(&self) -> Option<&'static str> {
        match self {
            Self::Reproduce(_) => Some("reproduce"),
            Self::Model { .. } => Some("model"),
            Self::Import(_) => Some("import"),
            Self::Excite(_) => Some("excite"),
            Self::Identify(_) => Some("identify"),
            Self::List { .. } => Some("list"),
            Self::Completions { .. } => Some("completions"),
            Self::Man { .. } => Some("man"),
            Self::Verify { against: None, .. } => Some("verify without --against"),
            Self::Verify { .. }
            | Self::Run { .. }
            | Self::Compare(_)
            | Self::Eval { .. }
            | Self::Certify(_)
            | Self::Check { .. }
            | Self::Tune(_)
            | Self::Sweep(_)
            | Self::Replay(_)
            | Self::Margins(_) => None,
        }
    }
}

/// A change of a scenario.
fn change(text: &str) -> Result<Change, String> {
    Change::parse(text).map_err(|problem| format!("{problem}; {}", problem.hint()))
}

/// A number of control periods.
fn every(text: &str) -> Result<NonZeroU32, String> {
    let must = || format!("it must be a whole number of control periods from 1 to {}", u32::MAX);
    text.trim().parse().map_err(|_| must())
}

/// The name of a class of drives.
fn drives(name: &str) -> Result<&'static DriveClass, String> {
    DriveClass::named(name).map_err(|problem| format!("{problem}; {}", problem.hint()))
}

/// `JOINT=POSITION`.
fn lock(text: &str) -> Result<(String, f64), String> {
    let (name, position) =
        text.rsplit_once('=').ok_or("write it as JOINT=POSITION, for instance finger=0.0")?;
    match position.trim().parse() {
        Ok(position) if f64::is_finite(position) => Ok((name.trim().to_owned(), position)),
        _ => Err(format!("the position is '{position}', must be a number in rad or m")),
    }
}
