//! Better gains by search: a fixed number of simulated runs, the same result for the same seed.

use flexure::progress::unwatched;
use flexure::tune::tune;
use flexure::{Problems, Scenario};

/// Twelve runs for better gains.
pub fn main() -> Result<(), Problems> {
    let mut scenario = Scenario::load("two-link-hardware")?;
    scenario.duration = 2.0; // s
    let before = scenario.simulate()?.summary.rms_e_l;

    let tuned = tune(&scenario, 12, 1, &unwatched)?;
    scenario.controller = tuned.controller;
    let after = scenario.simulate()?.summary.rms_e_l;

    println!(
        "{} runs: rms error {:.3} mrad before, {:.3} mrad after",
        tuned.evaluations,
        1e3 * before,
        1e3 * after
    );
    for (name, values) in scenario.controller.gains() {
        println!("  {name} = {values:.3?}");
    }
    assert!(tuned.cost <= tuned.start_cost);
    Ok(())
}
