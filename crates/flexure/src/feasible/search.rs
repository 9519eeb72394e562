//! The largest speed at which a reference keeps the limits.

use crate::feasible::bounds::{Bound, bounds};
use crate::feasible::peaks::{PacedReference, fits, peaks};
use crate::feasible::track::{Track, with_track};
use crate::feasible::{Usage, bounds as words, described};
use crate::files::{Problem, Problems};
use crate::references::Speed;
use crate::scenario::Scenario;

/// Speeds are tried downwards in steps of this ratio.
const RATIO: f64 = 0.9;

/// The slowest that is tried.
const SLOWEST: f64 = 1e-3;

/// Halvings between a speed that fits and the next larger one tried, which does not: to 1e-5 of it.
const HALVINGS: usize = 14;

/// Samples of a run in the search; what comes out is confirmed with more.
const COARSE: usize = 1000;

/// Most samples of a run.
const FINE: f64 = 1e5;

/// Samples that a usage is found from: a control period apart, or closer.
pub fn fine(scenario: &Scenario) -> usize {
    let periods = (scenario.duration / scenario.control_period).ceil().clamp(COARSE as f64, FINE);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 1e3 and 1e5")]
    let samples = periods as usize;
    samples
}

/// Seconds of its own time that the reference of `scenario` passes per second of the run, once its clock is at speed.
///
/// For a time scaling by margin it is searched: speeds from 1 down in steps of 10 %, then by bisection between the first
/// that keeps every limit and the one before it. Torques need not grow with the speed, under gravity or where the run, which is
/// as long as ever, gets less far: what is found keeps the limits, and none of the larger speeds that were tried does.
///
/// # Errors
/// If the robot has too many joints, the samples of the reference make no path, or no speed keeps it inside the limits.
pub fn speed(scenario: &Scenario) -> Result<f64, Problems> {
    match scenario.time_scaling.map(|scaling| scaling.speed) {
        None => Ok(1.0),
        Some(Speed::Given(speed)) => Ok(speed),
        Some(Speed::Within(margin)) => with_track(scenario, |track| search(scenario, track, margin))?,
    }
}

fn search(scenario: &Scenario, track: &dyn Track, margin: f64) -> Result<f64, Problems> {
    let bounds = bounds(&scenario.robot);
    let fits_with = |samples: usize, speed: f64| {
        fits(&PacedReference::new(scenario, track, speed), &bounds, samples, margin)
    };
    let mut refused = f64::INFINITY;
    let mut speed = 1.0;
    while !fits_with(COARSE, speed) || !fits_with(fine(scenario), speed) {
        if speed <= SLOWEST {
            return Err(impossible(scenario, &bounds, track, margin).into());
        }
        refused = speed;
        speed = (RATIO * speed).max(SLOWEST);
    }
    if refused.is_infinite() {
        return Ok(speed);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (speed + refused);
        if fits_with(COARSE, middle) && fits_with(fine(scenario), middle) {
            speed = middle;
        } else {
            refused = middle;
        }
    }
    Ok(speed)
}

/// What to say where even the slowest speed is too fast.
fn impossible(scenario: &Scenario, bounds: &[Bound], track: &dyn Track, margin: f64) -> Problem {
    let peaks = peaks(&PacedReference::new(scenario, track, SLOWEST), bounds, fine(scenario));
    let excess = |(bound, usage): &(&Bound, Usage)| usage.share / bound.allowed(margin);
    let worst = bounds
        .iter()
        .zip(&peaks)
        .map(|(bound, peak)| (bound, bound.usage(peak)))
        .max_by(|a, b| excess(a).total_cmp(&excess(b)))
        .map(|(_, usage)| usage)
        .expect("without limits every speed fits");
    let message = format!(
        "no speed keeps the reference within {margin} of the limits: at {SLOWEST} of its own speed there is still {}",
        described(scenario, &worst)
    );
    let joining = scenario.smooth_start.is_some_and(|start| worst.time <= start.duration);
    let help = if words::is_position(worst.key) {
        "no speed mends that: choose another path, or end points inside the limits".to_owned()
    } else if !worst.share.is_finite() {
        "its torque jumps at any speed: take nonic".to_owned()
    } else {
        let start =
            if joining { "; or a longer reference.smooth_start.duration: it is while joining" } else { "" };
        format!("{} = {:.4} would do, or another path{start}", worst.key, worst.value.abs() / margin)
    };
    scenario.places.problem("reference.time_scaling.margin", "limits", message, help)
}
