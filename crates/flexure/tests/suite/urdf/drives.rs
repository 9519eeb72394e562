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

/// All joints that cannot move are one error, at the first of them and with the line of each; what is held still may say what it
/// likes, and limits that are unknown are none.
#[test]
fn joints_that_cannot_move_are_one_error() {
    let urdf = ARM
        .replace("effort=\"20\" velocity=\"3\"", "effort=\"0\" velocity=\"0\"")
        .replace("lower=\"-0.1\" upper=\"0.4\"", "lower=\"0.4\" upper=\"0.4\"");
    let folder = Folder::with(&urdf);
    let line = |part: &str| urdf.lines().position(|line| line.contains(part)).unwrap() + 1;
    let (turn, slide) = (line("effort=\"0\""), line("effort=\"50\""));
    // Limits of the robot file come after those of the URDF: they do not make it right.
    for joints in [DRIVES, &format!("{DRIVES}\ntorque_limit = 9\nvelocity_limit = 1")] {
        let problems: Vec<_> = folder.robot("", joints).unwrap_err().into_iter().collect();
        let [problem] = problems.as_slice() else { panic!("{problems:?}") };
        assert_eq!((problem.code_word(), problem.line_column().unwrap().0), ("limits", turn));
        assert_eq!(
            problem.to_string(),
            format!(
                "2 joints cannot move: effort and velocity must be > 0, lower less than upper:\n  \
                 line {turn}: joint 'turn': effort 0, velocity 0\n  \
                 line {slide}: joint 'slide': lower 0.4 with upper 0.4"
            )
        );
    }
    let held = folder.robot("locked = { slide = 0.0 }", DRIVES).unwrap_err().to_string();
    assert!(held.contains("1 joint cannot move") && !held.contains("slide"), "{held}");
    assert!(folder.robot("locked = { turn = 0.0 }", DRIVES).unwrap_err().to_string().contains("'slide'"));
    let limits = folder.robot("unknown_limits = true", DRIVES).unwrap().limits;
    assert_eq!((limits.torque[0], limits.velocity[0]), (f64::INFINITY, f64::INFINITY));
    assert_eq!(
        (limits.torque[1], limits.lower[1], limits.upper[1]),
        (50.0, f64::NEG_INFINITY, f64::INFINITY)
    );
    // What the file says itself counts then.
    let given = folder.robot("unknown_limits = true", &format!("{DRIVES}\n[joints.turn]\ntorque_limit = 9"));
    assert_eq!(given.unwrap().limits.torque, [9.0, 50.0]);
}

/// Ranges of the robot file that are empty are one error, too.
#[test]
fn empty_ranges_are_one_error() {
    let joints = format!("{DRIVES}\nposition_lower = [1, 0.4]\nposition_upper = [1, -3]");
    let problems: Vec<_> = Folder::with(ARM).robot("", &joints).unwrap_err().into_iter().collect();
    let [problem] = problems.as_slice() else { panic!("{problems:?}") };
    assert_eq!(
        problem.to_string(),
        "position_lower must be less than position_upper:\n  joint 'turn': 1 and 1\n  joint 'slide': 0.4 and -3"
    );
}
