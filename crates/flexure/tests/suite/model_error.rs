//! Robots that differ from their models: factors, payloads, and both robots at once.

use flexure::files::ROBOTS;
use flexure::imperfections::{Factors, Imperfection, ModelError, Payload};
use flexure::robot::load_robot;
use flexure::robot::{Links, Robot};
use flexure::scenario::load_scenario;

fn robot(name: &str) -> Robot {
    load_robot(name).expect("built in")
}

fn ones(model: &Robot) -> Factors {
    Factors::ones(model.joint_count())
}

fn with_factors(model: &Robot, factors: Factors) -> Robot {
    ModelError { robot: None, factors, payload: None }.apply(model)
}

fn carrying(model: &Robot, mass: f64, position: [f64; 3]) -> Robot {
    ModelError { robot: None, factors: ones(model), payload: Some(Payload { mass, position }) }.apply(model)
}

/// Mass matrix, row by row, and potential energy at `q`: that of a robot at rest with relaxed springs.
fn at(robot: &Robot, q: &[f64]) -> (Vec<f64>, f64) {
    let arm = robot.arm().expect("supported");
    let mut mass = vec![0.0; q.len() * q.len()];
    arm.mass_matrix(q, &mut mass).expect("a number per joint");
    let motion = [q, q, &vec![0.0; 2 * q.len()]].concat();
    (mass, arm.energy(&motion).expect("a number per joint"))
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() <= tolerance, "{found:?} against {expected:?}");
    }
}

fn drives(robot: &Robot) -> [&[f64]; 4] {
    [&robot.stiffness, &robot.motor_inertia, &robot.link_damping, &robot.motor_damping]
}

#[test]
fn no_error_is_none_to_the_last_bit() {
    for (name, _) in ROBOTS {
        let model = robot(name);
        let none = with_factors(&model, ones(&model));
        let nothing = carrying(&model, 0.0, [0.1, 0.0, 0.0]);
        for same in [none, nothing] {
            assert_eq!((&same.links, &same.enclosed), (&model.links, &model.enclosed), "{name}");
            assert_eq!(drives(&same), drives(&model), "{name}");
        }
    }
}

/// Mass matrix and potential energy are linear in the masses if inertias go with them.
#[test]
fn heavier_links_are_heavier_by_that() {
    for name in ["quanser-2dof", "pendulum-1dof", "planar-3r", "panda"] {
        let model = robot(name);
        let q: Vec<f64> = (0..model.joint_count()).map(|i| 0.3 + 0.4 * i as f64).collect();
        let (mass, potential) = at(&model, &q);
        let heavier = with_factors(&model, Factors { mass: vec![1.3; q.len()], ..ones(&model) });
        let (more, higher) = at(&heavier, &q);
        let expected: Vec<f64> = mass.iter().map(|m| 1.3 * m).collect();
        assert_close(&more, &expected, 1e-13);
        assert!((higher - 1.3 * potential).abs() < 1e-12 * (1.0 + potential.abs()), "{name}");
        assert_eq!(drives(&heavier), drives(&model), "{name}");
    }
}

#[test]
fn factors_are_per_joint() {
    let model = robot("quanser-2dof");
    let factors = Factors {
        mass: vec![1.0, 2.0],
        stiffness: vec![0.7, 1.0],
        motor_inertia: vec![1.0, 3.0],
        link_damping: vec![0.0, 1.0],
        motor_damping: vec![1.0, 0.5],
    };
    let real = with_factors(&model, factors);
    assert_eq!(drives(&real), [&[9.0 * 0.7, 4.0][..], &[0.23, 0.03], &[0.0, 0.55], &[0.2, 45.0]]);
    let (
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass: m, inertia: i, .. }),
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, inertia, .. }),
    ) = (model.links, real.links)
    else {
        panic!("two links");
    };
    assert_eq!((mass, inertia), ([m[0], 2.0 * m[1]], [i[0], 2.0 * i[1]]));
}

/// m [[l1² + l2² + 2 l1 l2 c2, l2² + l1 l2 c2], [·, l2²]]: a point at the tip.
fn at_the_tip(mass: f64, [l1, l2]: [f64; 2], q2: f64) -> [f64; 4] {
    let (near, far) = (mass * l2 * (l2 + l1 * q2.cos()), mass * l2 * l2);
    [mass * (l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * q2.cos()), near, near, far]
}

#[test]
fn a_payload_adds_a_point_at_the_tip() {
    let q = [0.4, 1.1];
    for (name, position, length) in
        [("quanser-2dof", [0.267, 0.0, 0.0], [0.343, 0.267]), ("planar-2r", [0.4, 0.0, 0.0], [0.4, 0.4])]
    {
        let model = robot(name);
        let ((mass, potential), (more, higher)) = (at(&model, &q), at(&carrying(&model, 0.8, position), &q));
        let added: Vec<f64> = more.iter().zip(&mass).map(|(a, b)| a - b).collect();
        assert_close(&added, &at_the_tip(0.8, length, q[1]), 1e-14);
        // Positive angles lift the arm that feels gravity.
        let height = length[0] * q[0].sin() + length[1] * (q[0] + q[1]).sin();
        let weight = if name == "planar-2r" { 0.8 * 9.81 } else { 0.0 };
        assert!(
            (higher - potential - weight * height).abs() < 1e-13,
            "{name}: {higher} against {potential} J"
        );
    }
}

/// Off the plane of the arm, where products of inertia arise, and on a wrist that turns every way: ½ m |v|² of a point.
#[test]
fn a_payload_anywhere_moves_as_a_point() {
    let model = robot("panda");
    let q: Vec<f64> = (0..7).map(|i| 0.2 * f64::from(i) - 0.5).collect();
    let (bare, _) = at(&model, &q);
    let (here, _) = at(&carrying(&model, 1.0, [0.1, -0.2, 0.3]), &q);
    let (twice, _) = at(&carrying(&model, 2.0, [0.1, -0.2, 0.3]), &q);
    // Linear in its mass, and of rank three: a point has three directions to move in.
    let once: Vec<f64> = here.iter().zip(&bare).map(|(a, b)| a - b).collect();
    let expected: Vec<f64> = bare.iter().zip(&once).map(|(b, a)| b + 2.0 * a).collect();
    assert_close(&twice, &expected, 1e-13);
    let minor = |rows: [usize; 4]| {
        let m: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| once[7 * rows[i] + rows[j]]));
        flexure_core::linalg::Matrix(m).ldl().pivots().0
    };
    // Joints 1 and 2 meet in the shoulder, 4 is the elbow, 6 in the wrist.
    let pivots = minor([0, 1, 3, 5]);
    assert!(pivots[..3].iter().all(|&pivot| pivot > 1e-4) && pivots[3].abs() < 1e-12, "{pivots:?}");
    // The last joint's own: distance from its axis, squared.
    assert!((once[48] - (0.01 + 0.04)).abs() < 1e-14, "{}", once[48]);
}

/// The difference of the first entries of their mass matrices at rest [kg m²].
fn heavier(model: &Robot, plant: &Robot) -> f64 {
    let first = |robot: &Robot| at(robot, &vec![0.0; robot.joint_count()]).0[0];
    first(plant) - first(model)
}

#[test]
fn a_pair_is_the_model_and_the_plant() {
    for name in ["quanser-2dof", "pendulum-1dof", "planar-3r", "panda"] {
        let model = robot(name);
        let stiffness = vec![1.5; model.joint_count()];
        let mass = vec![2.0; model.joint_count()];
        let plant = with_factors(&model, Factors { stiffness, mass, ..ones(&model) });
        for (stiff, soft) in plant.stiffness.iter().zip(&model.stiffness) {
            assert!((stiff - 1.5 * soft).abs() <= 1e-15 * stiff, "{name}");
        }
        assert!(heavier(&model, &plant) > 0.0, "{name}");
    }
    // Two files of one arm: a1 of the drawing is 1.500 · 0.1562² + 0.873 · 0.343² + 0.03605.
    let heavier = heavier(&robot("quanser-2dof"), &robot("quanser-2dof-cad"));
    let total = |m: [f64; 2], l: f64, r: [f64; 2], i: [f64; 2]| {
        m[0] * r[0] * r[0] + i[0] + m[1] * (l + r[1]) * (l + r[1]) + i[1]
    };
    let expected = total([1.5, 0.873], 0.343, [0.1562, 0.0589], [0.03605, 0.00866])
        - total([1.51, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]);
    assert!((heavier - expected).abs() < 1e-15, "{heavier} against {expected} kg m²");
}

#[test]
fn unlike_robots_are_no_pair() {
    for (scenario, plant, said) in [
        (
            "two-link-tanh",
            "planar-2r",
            "a planar two-link arm with joints: 2; planar-2r is a tree with joints: 2",
        ),
        (
            "planar-2r-tanh",
            "planar-3r",
            "planar-2r is a tree with joints: 2; planar-3r is a tree with joints: 3",
        ),
        ("pendulum-tanh", "quanser-2dof", "pendulum-1dof is a pendulum"),
    ] {
        let mut scenario = load_scenario(scenario).expect("built in");
        let other =
            ModelError { robot: Some(Box::new(robot(plant))), factors: ones(&scenario.robot), payload: None };
        scenario.imperfections.push(Imperfection::ModelError(other));
        let problems = scenario.open().map(drop).expect_err("unlike");
        assert!(problems.to_string().contains(said), "{problems}");
    }
}
