//! A closed loop in the caller's hand: encoders, filters, guard and torque limits of a real arm at 500 Hz.
//!
//! Stepped from outside it gives the trace of `flexure run two-link-hardware`, bit for bit, and it can be set back in time.

use std::error::Error;

use flexure::Scenario;
use flexure::simulate::{Loop, Trace};

/// Steps a loop through the whole run and through its second half once more; every number equals the trace.
pub fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::load("two-link-hardware")?;
    let trace = scenario.simulate()?.trace;

    let mut held = scenario.open()?;
    println!("{} joints, one step every {} ms", held.joints(), 1e3 * held.period());

    let half = trace.len() / 2;
    for row in 0..half {
        held.step()?;
        compare(&*held, &trace, row)?;
    }

    // What motion, sensors, guard, drive, integrator and random numbers remember, as plain numbers.
    let saved = held.state();
    println!("a state of {} numbers after {half} steps:", saved.len());
    for (signal, value) in held.state_names().iter().zip(&saved).take(8) {
        println!("  {} = {value} {}", signal.name, signal.unit);
    }

    for row in half..trace.len() {
        held.step()?;
        compare(&*held, &trace, row)?;
    }

    // Back to the middle: the second half happens once more.
    held.restore(&saved)?;
    for row in half..trace.len() {
        held.step()?;
        compare(&*held, &trace, row)?;
    }
    println!("{} rows of {} signals, all equal to the last bit", trace.len(), held.signals().len());
    Ok(())
}

/// Every signal of the loop is what stands in its column of the trace.
fn compare(held: &dyn Loop, trace: &Trace, row: usize) -> Result<(), Box<dyn Error>> {
    let mut values = vec![0.0; held.signals().len()];
    held.read(&mut values)?;
    assert_eq!(values.len(), trace.columns().len());
    for (column, value) in trace.columns().iter().zip(&values) {
        assert_eq!(column.values[row].to_bits(), value.to_bits(), "{} in row {row}", column.name);
    }
    Ok(())
}
