//! Runs under a disturbance stay in the tube, and within the bounds.

use flexure::core::linalg::Vector;
use flexure::core::model::{Links, Motion};
use flexure::progress::unwatched;
use flexure::prove::along::{along, start_level};
use flexure::scenario::Integration;
use flexure::scenario::Scenario;
use flexure::scenario::load_scenario;
use flexure::simulate::{Controller, Hold, Simulation, Timing};

use super::floats::{self, Floats};
use super::{bounds, level};

/// Runs the loop in continuous time with `disturbance(t)` on every motor [N m], of at most `largest`; the largest share of
/// the level that W took.
fn stays<L: Links<f64, N> + Clone, const N: usize>(
    system: &Floats<L, N>,
    scenario: &Scenario,
    largest: f64,
    disturbance: &dyn Fn(f64) -> f64,
) -> f64 {
    let level = level(scenario, largest);
    assert!(start_level(scenario).unwrap() <= level.bounds().lo());
    let found = along(scenario, &level, 1000, &unwatched).unwrap().unwrap();
    let bounds = bounds(&found);
    let [q_l, q_m] = [&scenario.initial.q_l, &scenario.initial.q_m].map(|q| Vector::from_fn(|i| q[i]));
    let start = Motion { q_l, q_m, v_l: Vector::ZERO, v_m: Vector::ZERO };
    let law =
        |t: f64, x: &Motion<f64, N>, _: &Vector<_, N>| system.command(t, x).u_m.map(|u| u + disturbance(t));
    let controller = Controller::ideal(system.robot.clone(), &system.reference, law);
    let integration = Integration::Collocation { tolerance: 1e-10 };
    let timing = Timing { hold: Hold::Continuous, integration, ..Timing::sampled(1e-3) };
    let mut run = Simulation::new(timing, system.robot.clone().into(), start, Vec::new(), controller);
    let mut worst = 0.0_f64;
    for _ in 0..=4000 {
        run.step().expect("a loop in its tube does not diverge");
        let instant = run.instant().expect("after a step");
        let values = system.values(instant.t, instant.motion);
        worst = worst.max(values.level / found.level);
        for (i, value) in values.quantities.iter().enumerate() {
            assert!(value.abs() <= bounds[i], "quantity {i} is {value} at {} s", instant.t);
        }
        for (error, bound) in values.error.iter().zip(&found.error) {
            assert!(error.abs() <= *bound);
        }
    }
    println!("{} {largest} N m: W up to {worst:.4} of the level", scenario.name);
    assert!(worst <= 1.0, "{worst}");
    worst
}

#[test]
fn disturbed_runs_stay_in_the_tube() {
    let scenario = load_scenario("two-link-tanh-smooth").unwrap();
    let arm = floats::arm(&scenario);
    stays(&arm, &scenario, 0.1, &|_| 0.1);
    stays(&arm, &scenario, 0.1, &|t| 0.1 * (10.0 * t).sin());
    let scenario = load_scenario("pendulum-tanh").unwrap();
    let pendulum = floats::pendulum(&scenario);
    // A disturbance that changes its sign with the error is nearly the worst: the bound of W is not idle.
    assert!(stays(&pendulum, &scenario, 0.01, &|_| 0.01) > 0.01);
    stays(&pendulum, &scenario, 0.01, &|t| 0.01 * (40.0 * t).sin());
}
