//! Bounds along a reference.

mod floats;

use flexure::along::{Along, along};
use flexure::certify::Number;
use flexure::core::model::Links;
use flexure::io::{Scenario, load_scenario};
use flexure::proof::{Question, Region, prove};
use floats::{Floats, Numbers};

/// The level of the tube under a disturbance of so much on every motor [N m].
fn level(scenario: &Scenario, disturbance: f64) -> Number {
    let n = scenario.robot.joint_count();
    let question = Question {
        region: Region::Errors(vec![0.5; 2 * n]),
        rate: None,
        disturbance: Some(vec![disturbance; n]),
    };
    let proof = prove(scenario, &question).unwrap();
    proof.verdict.proved().unwrap_or_else(|| panic!("{:?}", proof.verdict)).tube.clone().unwrap().level
}

fn bounds(found: &Along) -> Vec<f64> {
    [&found.velocity, &found.deflection, &found.torque].map(|peaks| peaks.bound.clone()).concat()
}

fn sampled<L: Links<f64, N>, const N: usize>(
    system: &Floats<L, N>,
    found: &Along,
    duration: f64,
) -> Vec<f64> {
    let mut r = Numbers(5);
    let bounds = bounds(found);
    let mut largest = vec![0.0_f64; bounds.len()];
    for k in 0..20000 {
        let t = 0.5 * duration * (1.0 + r.next());
        // On the level, and inside.
        let share = if k % 4 == 0 { 0.5 * (1.0 + r.next()) } else { 1.0 };
        let x = system.sample(t, found.level * share * (1.0 - 1e-9), &mut r);
        let values = system.values(t, &x);
        assert!(
            (values.level / (found.level * share) - 1.0).abs() < 1e-6,
            "{} {}",
            values.level,
            found.level
        );
        for (i, &value) in values.quantities.iter().enumerate() {
            assert!(value.abs() <= bounds[i], "quantity {i}: {value} beyond {} at {t} s", bounds[i]);
            largest[i] = largest[i].max(value.abs());
        }
    }
    bounds.iter().zip(&largest).map(|(bound, largest)| bound / largest).collect()
}

#[test]
fn explore() {
    for (name, disturbance) in [
        ("pendulum-tanh", 0.001),
        ("two-link-tanh-smooth", 0.001),
        ("two-link-tanh-smooth", 0.1),
        ("two-link-coupled-tanh-smooth", 0.01),
    ] {
        let scenario = load_scenario(name).unwrap();
        let level = level(&scenario, disturbance);
        let start = std::time::Instant::now();
        let found = along(&scenario, &level, 2000).unwrap();
        let ratios = if name.starts_with("pendulum") {
            sampled(&floats::pendulum(&scenario), &found, scenario.duration)
        } else {
            sampled(&floats::arm(&scenario), &found, scenario.duration)
        };
        println!(
            "{name} {disturbance} {:?} {} slabs: {ratios:.3?} {:.4?} nominal {:.3?}",
            start.elapsed(),
            found.slabs,
            bounds(&found),
            found.torque.nominal
        );
    }
}
