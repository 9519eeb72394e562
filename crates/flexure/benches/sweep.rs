//! What rows of sweeps cost, and how threads share them: `cargo bench -p flexure --bench sweep`.

use std::path::Path;

use divan::Bencher;
use flexure::progress::unwatched;
use flexure::sweep::Sweep;
use rayon::ThreadPoolBuilder;

fn main() {
    divan::main();
}

/// Runs of 2 s at 1 kHz under a law that is held, over stiffnesses.
fn sweep(scenario: &str) -> Sweep {
    let text = format!(
        "scenario = \"{scenario}\"\ndesign = \"sobol\"\npoints = 100\nset.duration = 2.0\nset.control_period = 0.001\n\
         [parameters]\n\"robot.joints.stiffness\" = {{ from = 0.8, to = 1.25, scale = \"log\", relative = true }}\n"
    );
    Sweep::from_text("bench", &text, Path::new(".")).expect("a sweep")
}

/// A row: ideal sensors; encoders, filter, limits and guard; the paper's arm, with a damper of 9000 1/s.
#[divan::bench(args = ["task-ideal-tracking", "two-link-hardware", "two-link-tanh-smooth"])]
fn row(bencher: Bencher, scenario: &str) {
    let sweep = sweep(scenario);
    bencher.bench(|| sweep.row(17));
}

/// A shard of 100 rows with its file, on one thread and on two.
#[divan::bench(args = [1, 2])]
fn shard_on_threads(bencher: Bencher, threads: usize) {
    let sweep = sweep("task-ideal-tracking");
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    bencher.bench(|| pool.install(|| sweep.shard(0, &unwatched)).expect("rows"));
}
