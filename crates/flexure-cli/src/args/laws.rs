//! Arguments of commands about a loop and its law: proofs, comparisons, gains, margins, sweeps.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use flexure::compare::{BUDGET, SEEDS};

use super::{Output, Paged, Traced};

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
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
    /// Largest unknown torque on each motor in N m: certifies the tube that errors settle in, and looks for a funnel, which is narrower and has a file of its own.
    #[arg(long, value_name = "D", value_delimiter = ',', allow_negative_numbers = true)]
    pub disturbance: Option<Vec<f64>>,
    /// Largest unknown torque on each link in N m: bounds errors, speeds, deflections and torques by a funnel along the reference, whose file `verify` follows.
    #[arg(long, value_name = "D", value_delimiter = ',', allow_negative_numbers = true)]
    pub link_disturbance: Option<Vec<f64>>,
    /// Multiply the disturbances until a limit of the robot may act: the largest funnel in which none does, and which one is in the way.
    #[arg(long)]
    pub up_to_limits: bool,
    /// Slabs of time that a funnel may have; 100,000 over the third power of the number of joints if left out.
    #[arg(long, value_name = "SLABS")]
    pub slabs: Option<usize>,
    /// Largest velocity errors in rad/s, links then motors: certifies the contraction rate, in a metric that grows with the error, of any two
    /// solutions of the virtual system while both keep to them and to the region. For phi = tanh, and for linear where the link metric hardens.
    #[arg(long, value_name = "S", value_delimiter = ',', allow_negative_numbers = true)]
    pub velocity_error: Option<Vec<f64>>,
    /// How far links reach in a tube around the run in rad, one number or one per link: proves how fast motions in it come closer in the sampled loop,
    /// with the control period, delay, encoders, velocity filter, guard and limits of the file. Begin with 1e-5 and try smaller and larger ones.
    #[arg(long, value_name = "E", value_delimiter = ',', allow_negative_numbers = true)]
    pub sampled_tube: Option<Vec<f64>>,
    /// Look for the widest tube of the sampled loop, from 0.1 rad down to 1e-7 or until narrower ones come no farther, whatever else is asked for and
    /// however long it takes: minutes for two joints and a long run, more than an hour for 10 s of seven. Where there is none, what is proved of the ideal loop stands, and it is said why. Without options that name a statement it
    /// is looked for where that takes a minute or two.
    #[arg(long, conflicts_with = "sampled_tube")]
    pub strongest: bool,
    /// Look for no tube of the sampled loop.
    #[arg(long, conflicts_with_all = ["sampled_tube", "strongest"])]
    pub no_tube: bool,
    /// Prove the certified contraction rate once more, from the full inequality; of theorems only that the rate of the mass matrix cancels.
    #[arg(long)]
    pub direct: bool,
    /// With --direct: boxes that may be looked at.
    #[arg(long, value_name = "BOXES", default_value_t = 10_000, requires = "direct")]
    pub budget: usize,
    /// Answer no (exit code 1) where the proof is about the ideal loop and the file has more: imperfections, plant options, jumps
    /// of the reference, an estimator, a guard.
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
    /// What the loop shall do: rates to be proved, of the ideal loop or as it is sampled, delays, uncertainty, margins, references.
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
    /// How far links reach in a tube around the run in rad, as for `certify`: looks for the largest delay with which it is proved, beside the one that is
    /// simulated.
    #[arg(long, value_name = "E", value_delimiter = ',', allow_negative_numbers = true)]
    pub sampled_tube: Option<Vec<f64>>,
    #[command(flatten)]
    pub paged: Paged,
}
