//! The scenario's own run, at the instants of a log.

use crate::files::Problems;
use crate::logs::Log;
use crate::progress::Progress;
use crate::scenario::Scenario;
use crate::simulate::{Trace, run};

/// Motion and torque of a simulation at the instants of a log, samples × joints; not a number where there is none.
pub(super) struct Signals {
    pub q_l: Vec<f64>,
    pub q_m: Vec<f64>,
    pub u_m: Vec<f64>,
}

/// A run beside a log.
pub(super) struct ClosedLoop {
    pub signals: Signals,
    /// When it diverged, if it did \[s\].
    pub diverged_at: Option<f64>,
}

/// Runs `scenario` for as long as `log` is, or itself where that is shorter.
pub(super) fn closed_loop(
    scenario: &Scenario,
    log: &Log,
    progress: Progress<'_>,
) -> Result<ClosedLoop, Problems> {
    let mut scenario = scenario.clone();
    scenario.duration = scenario.duration.min(log.duration().max(scenario.control_period));
    let run = run(&scenario, progress)?;
    let signal = |name| at_instants(&run.trace, name, log);
    let signals = Signals { q_l: signal("q_l"), q_m: signal("q_m"), u_m: signal("u_m") };
    Ok(ClosedLoop { signals, diverged_at: run.divergence.map(|divergence| divergence.time) })
}

/// A vector signal of `trace` at the instants of `log`, on straight lines between its own.
fn at_instants(trace: &Trace, name: &str, log: &Log) -> Vec<f64> {
    let columns = trace.joints(name);
    let t = trace.column("t").unwrap_or_default();
    // Of two clocks with the same rate rounding must not choose the row.
    let early = 1e-6 * log.period;
    let mut row = 0;
    let mut values = Vec::with_capacity(log.samples() * log.joints);
    for k in 0..log.samples() {
        let time = log.time(k);
        while row + 1 < t.len() && t[row + 1] <= time + early {
            row += 1;
        }
        let here = t.get(row).copied().unwrap_or(f64::NAN);
        let share = t.get(row + 1).map_or(0.0, |next| ((time - here) / (next - here)).max(0.0));
        let beyond = row + 1 >= t.len() && time > here + early;
        values.extend(columns.iter().map(|column| {
            let before = column.get(row).copied().unwrap_or(f64::NAN);
            let after = column.get(row + 1).copied().unwrap_or(before);
            if beyond { f64::NAN } else { before + share * (after - before) }
        }));
    }
    values
}
