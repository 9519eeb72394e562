//! Bounds along a reference.

pub mod floats;
mod limits;
mod simulated;
pub mod slabs;

use flexure::core::control::Input;
use flexure::core::linalg::Vector;
use flexure::core::model::{Links, Motion};
use flexure::core::reference::Reference as _;
use flexure::core::virtual_system::{Structure, error_coordinates};
use flexure::progress::unwatched;
use flexure::prove::along::{Along, along, start_level};
use flexure::prove::engine::number::Number;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, Region};
use flexure::prove::verified::certify;
use flexure::references::{PointToPoint, Profile, Reference};
use flexure::scenario::Scenario;
use flexure::scenario::load_scenario;
use floats::Floats;

use crate::common::Random;

/// The level of the tube under a disturbance of so much on every motor [N m].
fn level(scenario: &Scenario, disturbance: f64) -> Number {
    let n = scenario.robot.joint_count();
    let question = Question {
        region: Region::Errors(vec![0.5; 2 * n]),
        disturbance: Some(vec![disturbance; n]),
        ..Question::default()
    };
    let verdict = certify(&proposition(scenario, &question, None).unwrap());
    verdict.proved().unwrap_or_else(|| panic!("{verdict:?}")).tube.clone().unwrap().level
}

/// Velocity, deflection, torque, each for all joints.
fn bounds(found: &Along) -> Vec<f64> {
    [&found.velocity, &found.deflection, &found.torque].map(|peaks| peaks.bound.clone()).concat()
}

/// Random states in the tube at random times, most of them on its surface: all within the bounds. Each bound over the largest
/// value seen.
fn sampled<L: Links<f64, N>, const N: usize>(system: &Floats<L, N>, found: &Along, end: f64) -> Vec<f64> {
    let mut r = Random(5);
    let bounds = bounds(found);
    let mut largest = vec![0.0_f64; bounds.len()];
    for k in 0..20000 {
        let t = 0.5 * end * (1.0 + r.next());
        let share = if k % 4 == 0 { 0.5 * (1.0 + r.next()) } else { 1.0 };
        let level = found.level * share * (1.0 - 1e-9);
        let values = system.values(t, &system.sample(t, level, &mut r));
        assert!((values.level / level - 1.0).abs() < 1e-6, "{} is not {level}", values.level);
        for (i, error) in values.error.iter().enumerate() {
            assert!(error.abs() <= found.error[i]);
        }
        for (i, &value) in values.quantities.iter().enumerate() {
            assert!(value.abs() <= bounds[i], "quantity {i}: {value} beyond {} at {t} s", bounds[i]);
            largest[i] = largest[i].max(value.abs());
        }
    }
    bounds.iter().zip(&largest).map(|(bound, largest)| bound / largest).collect()
}

/// No random state is beyond the bounds, and the bounds are less than half above the largest of them. (Random directions in
/// eight dimensions miss the worst one by some percent.)
#[test]
fn bounds_hold_and_are_tight() {
    for (name, disturbance) in [
        ("pendulum-tanh", 0.001),
        ("pendulum-tanh", 0.01),
        ("two-link-tanh-smooth", 0.01),
        ("two-link-tanh-smooth", 0.1),
        ("two-link-coupled-tanh-smooth", 0.01),
        ("two-link-coupled-tanh-smooth", 0.5),
    ] {
        let scenario = load_scenario(name).unwrap();
        let level = level(&scenario, disturbance);
        let start = std::time::Instant::now();
        let found = along(&scenario, &level, 2000, &unwatched).unwrap().unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let ratios = if name.starts_with("pendulum") {
            sampled(&floats::pendulum(&scenario), &found, scenario.duration)
        } else {
            sampled(&floats::arm(&scenario), &found, scenario.duration)
        };
        println!(
            "{name} {disturbance} N m: {:e} J, {seconds:.1} s, {} slabs, bounds {:.4?}, ratios {ratios:.3?}",
            found.level,
            found.slabs,
            bounds(&found)
        );
        assert!(ratios.iter().all(|&ratio| ratio < 1.5), "{name} {disturbance}: {ratios:?}");
    }
}

/// The torque of a septic motion jumps at both ends: no slab is smooth there.
#[test]
fn torques_that_jump_are_bounded() {
    let mut scenario = load_scenario("two-link-coupled-tanh-smooth").unwrap();
    (scenario.smooth_start, scenario.duration) = (None, 2.0);
    scenario.reference = Reference::PointToPoint(PointToPoint {
        profile: Profile::Septic,
        from: vec![0.0, 0.0],
        to: vec![1.0, -0.5],
        start: 0.3,
        duration: 0.9,
    });
    let found = along(&scenario, &level(&scenario, 1e-6), 2000, &unwatched).unwrap().unwrap();
    let system = floats::arm(&scenario);
    let mut largest = [0.0_f64; 2];
    for t in [0.3_f64, 1.2].iter().flat_map(|&t| [t - 1e-9, t, t + 1e-9]) {
        let x = system.motion(t, [Vector::ZERO; 4]);
        for (i, u) in system.values(t, &x).quantities[4..].iter().enumerate() {
            largest[i] = largest[i].max(u.abs());
        }
    }
    println!("at the jumps {largest:?}, bounds {:?}, {} slabs", found.torque.bound, found.slabs);
    let ratios = sampled(&system, &found, scenario.duration);
    println!("{ratios:.3?}");
    assert!(largest.iter().zip(&found.torque.bound).all(|(u, bound)| u <= bound));
    assert!(ratios.iter().all(|&ratio| ratio < 1.5), "{ratios:?}");

    scenario.reference = Reference::PointToPoint(PointToPoint {
        profile: Profile::Quintic,
        from: vec![0.0, 0.0],
        to: vec![1.0, -0.5],
        start: 0.3,
        duration: 0.9,
    });
    let problems = along(&scenario, &Number::decimal(1e-6), 10, &unwatched).unwrap_err();
    assert!(problems.to_string().contains("quintic jumps"), "{problems}");
}

/// W at the start, from the virtual system's own error coordinates and storage.
#[test]
fn the_start_is_in_its_level() {
    let scenario = load_scenario("two-link-tanh").unwrap();
    let system = floats::arm(&scenario);
    let x = Motion { q_l: Vector::ZERO, q_m: Vector::ZERO, v_l: Vector::ZERO, v_m: Vector::ZERO };
    let state = system.robot.state(&x);
    let q_ld = system.reference.at(0.0);
    let error = error_coordinates(&system.robot, &system.law, &state, &x, &q_ld, &Input::ZERO);
    let W = Structure::new(&system.robot, &system.law, &error, &x).storage(&error);
    let bound = start_level(&scenario).unwrap();
    assert!(W <= bound && bound <= W * (1.0 + 1e-9), "{W} {bound}");

    for name in ["two-link-tanh-smooth", "two-link-coupled-tanh-smooth", "pendulum-tanh", "panda-tanh-smooth"]
    {
        let start = start_level(&load_scenario(name).unwrap()).unwrap();
        // The panda's springs are loaded in ten digits.
        assert!((0.0..1e-10).contains(&start), "{name}: {start}");
    }
}

/// The first 40 ms of the seven-joint arm.
#[test]
fn seven_joints() {
    let mut scenario = load_scenario("panda-tanh-smooth").unwrap();
    let level = level(&scenario, 1e-4);
    scenario.duration = 0.04;
    let found = along(&scenario, &level, 8, &unwatched).unwrap().unwrap();
    for (bound, nominal) in found.torque.bound.iter().zip(&found.torque.nominal) {
        assert!(nominal <= bound && *bound < nominal + 0.3, "{bound} {nominal}");
    }
}
