//! The command line's grammar.

mod import;
mod laws;
mod logs;
mod paged;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::LazyLock;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use flexure::files::Change;
use flexure::processor;

pub use import::Import;
pub use laws::{Certify, Compare, Margins, OfFolder, Sweep, Tune};
pub use logs::{Excite, Identify, Replay};
pub use paged::Paged;

/// The version, and what instructions this build is for: one of several may have been chosen when the program started.
fn version() -> &'static str {
    static VERSION: LazyLock<String> =
        LazyLock::new(|| format!("{} ({})", env!("CARGO_PKG_VERSION"), processor::BUILT_FOR));
    &VERSION
}

/// Model, design, simulate and compare controllers for robots with elastic joints.
#[derive(Debug, Parser)]
#[command(
    name = "flexure",
    bin_name = "flexure",
    version = version(),
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
    /// Check a certificate's claims without what made it, or follow a funnel, or the tube of a sampled loop, anew.
    Verify {
        /// Certificate, funnel, or tube of a sampled loop: JSON files as docs/certificate.md, docs/funnel.md and docs/tube.md have them.
        #[arg(value_name = "CERTIFICATE")]
        certificate: PathBuf,
        /// Scenario, a file or a built-in name: is it the loop that the file is about? Funnels and tubes are checked with it only.
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
    /// File of a tube of this loop, as `certify` writes it: columns `tube`, how far out the run is, and `certificate`, whether what the file claims can hold;
    /// exit code 1 where the run is not inside at every control instant. The file is taken at its word: `verify` follows it.
    #[arg(long, value_name = "FILE")]
    pub tube: Option<PathBuf>,
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
