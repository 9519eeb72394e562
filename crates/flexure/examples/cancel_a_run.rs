//! A run that is broken off: long jobs tell how far they are and stop when they are told to.

use std::ops::ControlFlow;

use flexure::{Problems, Scenario, simulate};

/// Breaks a run off after a third, then lets one run to its end.
pub fn main() -> Result<(), Problems> {
    let scenario = Scenario::load("pendulum-tanh")?;

    // A user who has seen enough after a third of it.
    let patience =
        |done: f64| if done < 1.0 / 3.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let part = simulate::run(&scenario, &patience)?;
    let end = part.broken_off.expect("nobody waits for the end"); // s
    println!("{} instants until t = {end} s", part.trace.len());
    assert!((end / scenario.duration - 1.0 / 3.0).abs() < 1e-3);

    // Nothing lingers: the next run goes to its end.
    let run = simulate::run(&scenario, &|_| ControlFlow::Continue(()))?;
    println!("{} instants, rms error {:.2e} rad", run.trace.len(), run.summary.rms_e_l);
    assert!(run.divergence.is_none() && run.broken_off.is_none());
    Ok(())
}
