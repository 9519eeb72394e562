//! Built-in robots: links, mass matrix and law.

use flexure::core::control::Input;
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Motion};
use flexure::core::reference::Reference as _;
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::{Interval, Scalar};
use flexure::eval::evaluate_law;
use flexure::feasible;
use flexure::files::{ROBOTS, SCENARIOS, StateFile, StateRow};
use flexure::laws::{Law, law_over};
use flexure::robot::Arm;
use flexure::robot::load_robot;
use flexure::robot::{Links, Robot};
use flexure::scenario::load_scenario;

use super::encloses;
use crate::common::Random;

/// Every number of the links.
fn numbers<C: Copy>(links: &Links<C>) -> Vec<C> {
    match links {
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, length, com, inertia }) => {
            [*mass, *length, *com, *inertia].concat()
        }
        Links::Pendulum(flexure::robot::Pendulum { mass, com, inertia }) => vec![*mass, *com, *inertia],
        Links::Tree(bodies) => bodies
            .iter()
            .flat_map(|body| {
                let vectors = [&body.axis, &body.translation, &body.com].into_iter();
                let rows = vectors.chain(&body.rotation).chain(&body.inertia).flatten();
                rows.copied().chain([body.mass]).collect::<Vec<_>>()
            })
            .collect(),
    }
}

#[test]
fn links_are_enclosed_tightly() {
    for (name, _) in ROBOTS {
        let robot = load_robot(name).expect("built in");
        let (floats, enclosed) = (numbers(&robot.links), numbers(&robot.enclosed));
        assert_eq!(floats.len(), enclosed.len());
        for (bounds, x) in enclosed.into_iter().zip(floats) {
            encloses(bounds, x, 1e-12 * x.abs().max(1e-3), 1e-13 * x.abs().max(1.0), name);
        }
        for x in robot.stiffness.iter().chain(&robot.motor_inertia).chain(&robot.gravity) {
            let bounds = robot.bounds(*x);
            assert!(bounds.contains(*x) && bounds.width() <= x.abs() * f64::EPSILON, "{name}: {bounds:?}");
        }
    }
}

/// The mass matrix at the posture `q`, by rows.
fn mass_matrix<C: Scalar>(arm: &dyn Arm<C>, q: &[f64]) -> Vec<C> {
    let mut mass = vec![C::ZERO; q.len() * q.len()];
    let q: Vec<C> = q.iter().map(|&x| C::from_f64(x)).collect();
    arm.mass_matrix(&q, &mut mass).expect("a number per joint");
    mass
}

/// Panda has seven joints and fixed ones in between: some thousand roundings of numbers below 3 kg m².
#[test]
fn mass_matrices_are_enclosed() {
    let mut r = Random(7);
    for (name, _) in ROBOTS {
        let robot = load_robot(name).expect("built in");
        for _ in 0..10 {
            let q: Vec<f64> = (0..robot.joint_count()).map(|_| 3.0 * r.next()).collect();
            let floats = mass_matrix(&*robot.arm().expect("few joints"), &q);
            let bounds = mass_matrix(&*robot.enclosed_arm().expect("few joints"), &q);
            assert_eq!(floats.len(), bounds.len());
            for (bounds, x) in bounds.into_iter().zip(floats) {
                encloses(bounds, x, 1e-13 * x.abs().max(1.0), 1e-11 * x.abs().max(1.0), name);
            }
        }
    }
}

/// The torque of each law on the two-link arm, in floats and in intervals.
#[test]
fn laws_are_enclosed() {
    let mut r = Random(11);
    for (name, _) in SCENARIOS.iter().filter(|(name, _)| name.starts_with("two-link")) {
        let scenario = load_scenario(name).expect("built in");
        let law: Law<Interval, 2> = law_over(scenario.vcbc().unwrap(), |x| scenario.bounds(x));
        let reference = feasible::enclosed_reference::<2>(&scenario).expect("a path");
        let robot = two_links(&scenario.robot);
        for _ in 0..5 {
            let [q_l, q_m, dq_l, dq_m] =
                [0.5, 0.5, 2.0, 2.0].map(|scale| vec![scale * r.next(), scale * r.next()]);
            let t = 1.0 + r.next();
            let point = |x: &[f64]| Vector([x[0], x[1]].map(Interval::point));
            let x = Motion { q_l: point(&q_l), q_m: point(&q_m), v_l: point(&dq_l), v_m: point(&dq_m) };
            let bounds = law.command(&robot, &x, &reference.at(Interval::point(t)), &Input::ZERO).u_m;
            let rows = vec![StateRow { t, q_l, q_m, dq_l, dq_m, ..StateRow::default() }];
            let states = StateFile { name: "test".to_owned(), rows };
            let floats = &evaluate_law(&scenario, &states).expect("two joints")[0].u_m;
            for (bounds, &u) in bounds.iter().zip(floats) {
                // Second derivatives of the link torque, 1e5 N m and more, times the motor inertia over the stiffness.
                encloses(bounds, u, 1e-9 * u.abs().max(1.0), 1e-7 * u.abs().max(1.0), name);
            }
        }
    }
}

/// The two-link arm, without the visitor, which would compile the law ten times.
fn two_links(robot: &Robot) -> Fjr<Interval, PlanarTwoLink<Interval>, 2> {
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, length, com, inertia }) = robot.enclosed
    else {
        panic!("two links")
    };
    let drive = |values: &[f64]| Vector([values[0], values[1]].map(|x| robot.bounds(x)));
    Fjr {
        links: PlanarTwoLink::new(mass, length[0], com, inertia),
        motor_inertia: drive(&robot.motor_inertia),
        stiffness: drive(&robot.stiffness),
        link_damping: drive(&robot.link_damping),
        motor_damping: drive(&robot.motor_damping),
    }
}
