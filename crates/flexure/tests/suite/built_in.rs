//! The built-in robots carry the numbers of their sources.

use std::collections::BTreeSet;

use flexure::files::ROBOTS;
use flexure::references::SmoothStart;
use flexure::robot::load_robot;
use flexure::robot::{Body, Links};
use flexure::scenario::load_scenario;
use toml::de::{DeTable, DeValue};

/// Sum of the masses of panda.urdf but for the base link, which does not move.
const PANDA_MOVING_MASS: f64 =
    4.970684 + 0.646926 + 3.228604 + 3.587895 + 1.225946 + 1.666555 + 0.735522 + 0.73 + 2.0 * 0.015;

fn panda() -> Vec<Body> {
    match load_robot("panda").unwrap().links {
        Links::Tree(bodies) => bodies,
        other => panic!("{other:?}"),
    }
}

#[test]
fn panda_has_the_mass_of_its_urdf() {
    let bodies = panda();
    assert_eq!(bodies.len(), 7);
    let mass: f64 = bodies.iter().map(|body| body.mass).sum();
    assert!((mass - PANDA_MOVING_MASS).abs() < 1e-12, "{mass}");
    let parents: Vec<_> = bodies.iter().map(|body| body.parent).collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(2), Some(3), Some(4), Some(5)]);
}

/// The hand is on link 7, 0.107 m out and turned by −45° about z: its centre (−0.01, 0, 0.03) is at
/// (−0.01 cos 45°, 0.01 sin 45°, 0.137); the fingers' origins are 0.0584 m further out than the hand's.
#[test]
fn panda_hand_is_merged_into_the_last_link() {
    let last = panda().pop().unwrap();
    let (m7, c7) = (0.735522, [1.0517e-02, -4.252e-03, 6.1597e-02]);
    let half = 0.01 * 0.5_f64.sqrt();
    let (hand, fingers) = ([-half, half, 0.137], [0.0, 0.0, 0.107 + 0.0584]);
    let total = m7 + 0.73 + 0.03;
    assert!((last.mass - total).abs() < 1e-15);
    for i in 0..3 {
        let expected = (m7 * c7[i] + 0.73 * hand[i] + 0.03 * fingers[i]) / total;
        assert!((last.com[i] - expected).abs() < 1e-15, "{:?}", last.com); // 40 flops × ε × 0.1
    }
    // About z, along which the hand's z axis stands: its 0.0017 goes in as it is, the rest by parallel axes.
    let about = |m: f64, c: [f64; 3]| m * ((c[0] - last.com[0]).powi(2) + (c[1] - last.com[1]).powi(2));
    let expected =
        0.004815 + 0.0017 + 2.0 * 7.5e-7 + about(m7, c7) + about(0.73, hand) + about(0.03, fingers);
    assert!((last.inertia[2][2] - expected).abs() < 1e-16);
}

/// The second joint stands at roll −90°: its z axis is the parent's y axis.
#[test]
fn panda_joints_stand_as_in_the_urdf() {
    let z = panda()[1].rotation.map(|row| row[2]);
    for (found, exact) in z.into_iter().zip([0.0, 1.0, 0.0]) {
        assert!((found - exact).abs() < 1e-15, "{z:?}");
    }
}

#[test]
fn what_the_paper_leaves_out_is_assumed() {
    let keys = |name: &str| -> Vec<String> {
        load_scenario(name).unwrap().assumptions.into_iter().map(|assumption| assumption.key).collect()
    };
    let linear = keys("two-link-linear");
    for key in ["joints.stiffness", "initial", "control_period"] {
        assert!(linear.iter().any(|assumed| assumed == key), "{key} of {linear:?}");
    }
    assert!(!linear.iter().any(|assumed| assumed.contains("kappa")));
    assert!(keys("two-link-coupled-tanh").iter().any(|assumed| assumed == "controller.motor.kappa"));
}

#[test]
fn files_on_disk_are_read_like_built_in_ones() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../");
    let robot = load_robot(&format!("{root}robots/quanser-2dof.toml")).unwrap();
    assert_eq!(robot.links, load_robot("quanser-2dof").unwrap().links);
    let scenario = load_scenario(&format!("{root}scenarios/two-link-tanh.toml")).unwrap();
    assert_eq!((scenario.name.as_str(), scenario.smooth_start), ("two-link-tanh", None));
    assert_eq!(load_scenario("two-link-tanh-smooth").unwrap().smooth_start, Some(SmoothStart::within(2.0)));
}

/// Dotted keys of the numbers in `value`, entries of a list of tables together: `links.joint.mass`.
fn numbers(value: &DeValue<'_>, path: &str, found: &mut BTreeSet<String>) {
    let inside = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        DeValue::Integer(_) | DeValue::Float(_) => drop(found.insert(path.to_owned())),
        DeValue::Array(entries) => entries.iter().for_each(|entry| numbers(entry.get_ref(), path, found)),
        DeValue::Table(table) => {
            for (key, value) in table {
                numbers(value.get_ref(), &inside(key.get_ref()), found);
            }
        }
        _ => (),
    }
}

/// The numbers of a robot file that no line of `[sources]` names, by a last part or as part of a table.
fn without_source(text: &str) -> Vec<String> {
    let file = DeTable::parse(text).unwrap().into_inner();
    let sources: Vec<_> =
        file["sources"].get_ref().as_table().unwrap().keys().map(ToString::to_string).collect();
    let mut found = BTreeSet::new();
    numbers(&DeValue::Table(file), "", &mut found);
    let covered = |number: &String| {
        sources.iter().any(|key| {
            number == key || number.ends_with(&format!(".{key}")) || number.starts_with(&format!("{key}."))
        })
    };
    found.into_iter().filter(|number| !covered(number)).collect()
}

#[test]
fn every_number_of_a_built_in_robot_has_a_source() {
    for (name, text) in ROBOTS {
        assert_eq!(without_source(text), [""; 0], "{name}");
    }
    // A line taken away is missed, in a tree and in a closed form.
    for (name, line, key) in [
        ("planar-2r", "\"links.joint.com\" = ", "links.joint.com"),
        ("quanser-2dof", "stiffness = \"", "joints.stiffness"),
        ("panda", "gravity = \"", "gravity"),
    ] {
        let text = ROBOTS.iter().find(|(known, _)| *known == name).unwrap().1;
        let kept: Vec<_> = text.lines().filter(|each| !each.starts_with(line)).collect();
        assert_eq!(without_source(&kept.join("\n")), [key]);
    }
}
