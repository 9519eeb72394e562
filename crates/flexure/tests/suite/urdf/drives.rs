//! `[joints]`: by order, by name, and what the URDF says.

use flexure::robot::Robot;

use super::{ARM, DRIVES, Folder};

fn robot(joints: &str) -> Robot {
    Folder::with(ARM).robot("", joints).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Joint by joint beats all joints, which beats the URDF.
#[test]
fn the_closest_word_counts() {
    let r = robot(
        "stiffness = [100, 200]\nmotor_inertia = 0.1\nmotor_damping = 1\ntorque_limit = 9\n\
         [joints.slide]\nstiffness = 300\nlink_damping = 5\nposition_upper = 0.3\n[joints.turn]\nlink_damping = 4",
    );
    assert_eq!(r.stiffness, [100.0, 300.0]);
    assert_eq!(r.motor_inertia, [0.1, 0.1]);
    assert_eq!(r.link_damping, [4.0, 5.0]);
    assert_eq!(r.limits.torque, [9.0, 9.0]);
    assert_eq!(r.limits.velocity, [3.0, 1.0]);
    assert_eq!((r.limits.lower, r.limits.upper), (vec![-2.0, -0.1], vec![2.5, 0.3]));
    assert_eq!(r.limits.deflection, [f64::INFINITY; 2]);
    assert_eq!(r.gear_ratio, None);
}

/// Damping of the URDF stands in for link damping, and the report says so; its friction is left out, and it says that.
#[test]
fn what_the_urdf_says_of_drives_is_assumed() {
    let r = robot("stiffness = 100\nmotor_inertia = 0.1\nmotor_damping = 1");
    assert_eq!(r.link_damping, [0.3, 0.7]);
    let assumed: Vec<_> = r.assumed.iter().map(|a| (a.key.as_str(), a.value.as_str())).collect();
    assert_eq!(assumed, [("joints.link_damping", "[0.3, 0.7]"), ("links.file", "[0.05, 0.0]")]);
    // Given in the file, the damping is nobody's assumption.
    assert_eq!(robot(DRIVES).assumed.len(), 1);
}

/// Sources speak of a key wherever it stands.
#[test]
fn sources_cover_keys_joint_by_joint() {
    let text = "stiffness = 100\nmotor_inertia = 0.1\nmotor_damping = 1\nlink_damping = 1\n[joints.turn]\nstiffness = 3\n\
                [joints.slide]\nstiffness = 4\n[sources]\nstiffness = 'assumed: by eye'\n\
                'joints.turn.stiffness' = 'data sheet'";
    let assumed = &robot(text).assumed[0];
    assert_eq!((assumed.key.as_str(), assumed.value.as_str()), ("joints.stiffness", "3 values"));
}

/// A continuous joint has no stops, whatever its `<limit>` says.
#[test]
fn continuous_joints_have_no_stops() {
    let urdf = ARM.replace("type=\"revolute\"", "type=\"continuous\"");
    let limits = Folder::with(&urdf).robot("", DRIVES).unwrap().limits;
    assert_eq!((limits.lower[0], limits.upper[0]), (f64::NEG_INFINITY, f64::INFINITY));
    assert_eq!((limits.lower[1], limits.upper[1]), (-0.1, 0.4));
}
