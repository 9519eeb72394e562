//! What is said of every robot within the tolerances of the robot file, against robots that are within them.

mod differences;
pub mod motions;
mod said;

use std::fs;

use flexure::core::linalg::Vector;
use flexure::core::model::{Links as _, Motion};
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::Interval;
use flexure::prove::engine::envelope::deviation::Spread;
use flexure::prove::question::{Proof, Question, prove};
use flexure::prove::within::Within;
use flexure::robot::Tolerances;
use flexure::scenario::{Scenario, load_scenario};

use crate::along::floats::Floats;
use crate::common::Random;

pub type Arm = Floats<PlanarTwoLink<f64>, 2>;

/// K, M_m, D_l, D_m of both joints, and unknown torques on their motors and their links.
pub type Numbers = [Vector<f64, 2>; 6];

/// An arm with drives as such arms have them, and gains for 16 1/s.
const SCENARIO: &str = r#"robot = "two-link-plausible"
duration = 8.0
control_period = 0.001
[reference]
kind = "sine"
amplitude = [1.0, 1.0]
frequency = [0.6, 0.6]
[reference.smooth_start]
duration = 4.0
[controller]
kind = "vcbc"
phi = "linear"
link = { metric = [57.0, 2.7], shaping = [16.0, 16.0], damping = [3.2, 0.05] }
motor = { metric = [80.0, 14.0], shaping = [16.0, 16.0], damping = [0.06, 0.003] }
"#;

/// What identification leaves open, as parts of the numbers.
pub const IDENTIFIED: [f64; 4] = [0.0003, 0.0003, 0.02, 0.01];

/// Largest unknown torque on each motor [N m].
const UNKNOWN: [f64; 2] = [0.02, 0.01];

pub fn scenario() -> Scenario {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, SCENARIO).unwrap();
    load_scenario(path.to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// `scenario` with tolerances that are these parts of its robot's numbers.
pub fn tolerant(mut scenario: Scenario, parts: [f64; 4]) -> Scenario {
    let robot = &mut scenario.robot;
    let part = |values: &[f64], part: f64| values.iter().map(|x| x * part).collect::<Vec<_>>();
    robot.tolerances = Tolerances {
        stiffness: part(&robot.stiffness, parts[0]),
        motor_inertia: part(&robot.motor_inertia, parts[1]),
        link_damping: part(&robot.link_damping, parts[2]),
        motor_damping: part(&robot.motor_damping, parts[3]),
        link_mass: vec![0.0; robot.joint_count()],
    };
    scenario
}

pub fn proof(scenario: &Scenario) -> Proof {
    proof_with(scenario, None)
}

/// With so much of an unknown torque on each motor [N m].
fn proof_with(scenario: &Scenario, torque: Option<[f64; 2]>) -> Proof {
    let question = Question { disturbance: torque.map(|torque| torque.to_vec()), ..Question::default() };
    prove(scenario, &question).unwrap_or_else(|problems| panic!("{problems}"))
}

fn within(scenario: &Scenario) -> Within {
    within_with(scenario, None)
}

fn within_with(scenario: &Scenario, torque: Option<[f64; 2]>) -> Within {
    match proof_with(scenario, torque).within {
        Some(Ok(within)) => within,
        other => panic!("{other:?}"),
    }
}

/// The arm under a reference that moves from the start, which it begins beside.
fn displaced() -> Scenario {
    let mut scenario = scenario();
    scenario.smooth_start = None;
    let initial = &mut scenario.initial;
    for speed in initial.dq_l.iter_mut().chain(&mut initial.dq_m) {
        *speed = 0.6;
    }
    initial.q_l[0] += 0.01;
    initial.q_m[0] += 0.01;
    scenario
}

/// By how much the accelerations of links and motors differ from the model's where its numbers are off by `off`.
fn difference(arm: &Arm, off: &Numbers, x: &Motion<f64, 2>, u_m: &Vector<f64, 2>) -> [Vector<f64, 2>; 2] {
    let [stiffness, inertia, link_damping, motor_damping, torque, on_link] = off;
    let zeta = x.deflection();
    let robot = &arm.robot;
    let on_links = stiffness.diag_mul(&zeta) - link_damping.diag_mul(&x.v_l) + *on_link;
    let a_l = robot.links.mass_matrix(&x.q_l).ldl().solve(&on_links);
    let a_m = Vector::from_fn(|i| {
        let mass = robot.motor_inertia[i];
        let known = u_m[i] - robot.motor_damping[i] * x.v_m[i] - robot.stiffness[i] * zeta[i];
        let real = u_m[i]
            - (robot.motor_damping[i] + motor_damping[i]) * x.v_m[i]
            - (robot.stiffness[i] + stiffness[i]) * zeta[i]
            + torque[i];
        real / (mass + inertia[i]) - known / mass
    });
    [a_l, a_m]
}

/// What `tolerances` and unknown torques on motors and links leave open.
pub fn spread(tolerances: &Tolerances, [on_motors, on_links]: [[f64; 2]; 2]) -> Spread {
    let points = |values: &[f64]| values.iter().map(|&x| Interval::point(x)).collect();
    Spread {
        stiffness: points(&tolerances.stiffness),
        motor_inertia: points(&tolerances.motor_inertia),
        link_damping: points(&tolerances.link_damping),
        motor_damping: points(&tolerances.motor_damping),
        link_mass: points(&tolerances.link_mass),
        motor_torque: points(&on_motors),
        link_torque: points(&on_links),
    }
}

/// Numbers that are off by as much as may be, or a random part of that, and a torque on the motors of at most `torque`.
pub fn drawn(tolerances: &Tolerances, torque: [f64; 2], r: &mut Random) -> Numbers {
    let [k, m, d_l, d_m, _] = tolerances.named().map(|(_, values)| [values[0], values[1]]);
    [k, m, d_l, d_m, torque, [0.0; 2]].map(|most| {
        Vector(most.map(|most| if r.below(3) == 0 { most * r.next() } else { most.copysign(r.next()) }))
    })
}
