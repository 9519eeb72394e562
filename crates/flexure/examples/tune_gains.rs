//! Gains by search: a law from the literature on an arm with encoders, filters and torque limits, in fifteen simulated runs.

use flexure::compare::Entrant;
use flexure::progress::unwatched;
use flexure::tune::tune;
use flexure::{Problems, Scenario};

/// The search does not end worse than it began, and says what it found.
pub fn main() -> Result<(), Problems> {
    let mut scenario = Scenario::load("two-link-hardware")?;
    scenario.duration = 4.0; // s
    scenario.controller = Entrant::named("feedforward-pd")?.controller(&scenario.robot)?;
    let before = scenario.simulate()?.summary.rms_e_l;

    // The same seed gives the same gains.
    let tuned = tune(&scenario, 15, 1, &unwatched)?;
    scenario.controller = tuned.controller;
    let after = scenario.simulate()?.summary.rms_e_l;

    println!("{} runs: rms error {:.3} mrad, now {:.3} mrad", tuned.evaluations, 1e3 * before, 1e3 * after);
    for (name, values) in scenario.controller.gains() {
        println!("  {name} = {values:.3?}");
    }
    assert!(tuned.cost <= tuned.start_cost);
    assert!(after < 1e-2, "rad");
    Ok(())
}
