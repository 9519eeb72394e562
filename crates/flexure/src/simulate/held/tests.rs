//! A loop of seven joints in a size for eight is the loop of exactly seven, to the last bit.

use std::path::Path;

use flexure_core::robots::Tree;

use super::Held;
use crate::files::SCENARIOS;
use crate::scenario::{Scenario, scenario_from_text};
use crate::simulate::interface::Loop;

/// What a smooth plant can have: estimator, disturbance observer, guard, sensors, drive, a push.
const DEVICES: &str = r#"
[estimator]
kind = "observer"
bandwidth = 300.0
[disturbance_observer]
bandwidth = 20.0
[guard]
torque_rate_limit = 2000.0
stop_damping = 5.0
[[imperfection]]
kind = "noise"
link = 1e-6
motor = 1e-6
[[imperfection]]
kind = "encoder"
resolution = 1e-6
dither = true
[[imperfection]]
kind = "deadline"
probability = 0.05
[[imperfection]]
kind = "torque-gain"
factor = 0.98
[[imperfection]]
kind = "delay"
computation = 0.0003
[[imperfection]]
kind = "model-error"
mass = 1.05
[[imperfection]]
kind = "push"
torque = 0.5
from = 0.01
duration = 0.02
"#;

/// What no method of high order resolves.
const FRICTION: &str = r#"
[[imperfection]]
kind = "friction"
side = "link"
coulomb = 0.02
[[imperfection]]
kind = "friction"
side = "motor"
coulomb = 0.1
static = 0.15
stribeck_velocity = 0.05
[[imperfection]]
kind = "spring"
hardening = 100.0
dead_zone = 1e-6
hysteresis_stiffness = 100.0
hysteresis_torque = 0.05
"#;

/// The seven-joint arm with more tables.
fn panda(more: &str) -> Scenario {
    let (name, text) = SCENARIOS.iter().find(|(name, _)| *name == "panda-tanh-smooth").unwrap();
    let text = format!("{text}{more}");
    scenario_from_text(name, &text, Path::new(".")).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// The bits of everything that can be read of a loop and that it remembers, over its first instants.
fn bits(held: &mut dyn Loop) -> Vec<u64> {
    let mut values = vec![0.0; held.signals().len()];
    let mut bits = Vec::new();
    for _ in 0..60 {
        held.step().unwrap();
        held.read(&mut values).unwrap();
        bits.extend(values.iter().map(|x| x.to_bits()));
    }
    bits.extend(held.state().iter().map(|x| x.to_bits()));
    bits
}

#[test]
fn room_for_more_joints_changes_no_bit() {
    for more in ["", DEVICES, &format!("{DEVICES}{FRICTION}")] {
        let scenario = panda(more);
        let mut exact = Held::<Tree<f64, 7>, 7>::of(&scenario).unwrap();
        let mut roomy = scenario.open().unwrap();
        let names = |held: &dyn Loop| held.signals().to_vec();
        assert_eq!((roomy.joints(), names(&*roomy)), (7, names(&exact)));
        assert!(names(&exact).iter().filter(|signal| signal.name.starts_with("q_l")).count() >= 14);
        assert_eq!(bits(&mut exact), bits(&mut *roomy), "with {more}");
    }
}
