//! Robot files: gaps go in, numbers come out, everything else stays.

use std::fs;

use flexure::files::Outside;
use flexure::identify::{Estimate, Identified, IdentifiedJoint, NoiseRatio, Parameter, RobotFile};
use flexure::robot::load_robot;

use super::ARM;

/// As if all numbers had been found to be `value` times the parameter's number, those of `unknown` not.
fn found(unknown: &[(usize, Parameter)]) -> Identified {
    let estimate = |joint: usize, parameter: Parameter| Estimate {
        key: parameter.name(),
        unit: "",
        value: 1234.5678 * (joint + 1) as f64,
        error: 0.5,
        before: None,
        known: !unknown.contains(&(joint, parameter)),
    };
    let joint = |joint: usize| IdentifiedJoint {
        doubt: None,
        name: ["shoulder", "elbow"][joint].to_owned(),
        parameters: Parameter::ALL.map(|parameter| estimate(joint, parameter)).to_vec(),
        noise_ratio: NoiseRatio { link: None, motor: 1.0 },
        torque_noise: 0.0,
        held_out: None,
    };
    Identified {
        robot: "elbow-arm".to_owned(),
        joints: vec![joint(0), joint(1)],
        offsets: Vec::new(),
        samples: 1,
        held_out: 0,
        link_encoders: true,
        converged: true,
        condition: 1.0,
        weakest: String::new(),
    }
}

/// The file after it was completed from `text`.
fn completed(text: &str, found: &Identified) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, text).unwrap();
    let file = RobotFile::load(path.to_str().unwrap(), Outside::Refused)
        .unwrap_or_else(|problems| panic!("{problems}"));
    let logs = ["run.csv".to_owned()];
    file.completed(found, &logs, &path, Outside::Refused).unwrap_or_else(|problems| panic!("{problems}"))
}

fn read(text: &str) -> flexure::Robot {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, text).unwrap();
    load_robot(path.to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn numbers_come_out_and_everything_else_stays() {
    let text = completed(ARM, &found(&[]));
    let robot = read(&text);
    assert_eq!(robot.stiffness, [1234.57, 2469.14]);
    assert_eq!(robot.motor_damping, [1234.57, 2469.14]);
    assert!(robot.assumed.is_empty(), "{:?}", robot.assumed);
    assert!(
        text.contains("# N m/rad, of the data sheet") && text.contains("identified: 1234.57 ± 0.5"),
        "{text}"
    );
    assert!(text.contains("# kind = \"friction\""), "{text}");
    // Once more changes nothing.
    assert_eq!(completed(&text, &found(&[])), text);
}

#[test]
fn what_is_not_known_stays_as_it_was() {
    let robot = read(&completed(ARM, &found(&[(1, Parameter::Stiffness)])));
    assert_eq!(robot.stiffness, [1234.57, 4000.0]);
    let assumed: Vec<_> = robot.assumed.iter().map(|assumption| &*assumption.key).collect();
    assert_eq!(assumed, ["joints.stiffness"]);
    let robot = read(&completed(ARM, &found(&[(0, Parameter::LinkDamping), (1, Parameter::LinkDamping)])));
    assert_eq!(robot.link_damping, [0.4, 0.2]);
}

#[test]
fn gaps_are_read_and_filled() {
    let open =
        ARM.replace("stiffness = [9000.0, 4000.0]", "stiffness = [nan, 4000.0]").replace("[0.5, 0.2]", "nan");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, &open).unwrap();
    let file = RobotFile::load(path.to_str().unwrap(), Outside::Refused).unwrap();
    assert_eq!(
        file.gaps,
        [(0, Parameter::Stiffness), (0, Parameter::MotorInertia), (1, Parameter::MotorInertia)]
    );
    assert_eq!(read(&completed(&open, &found(&[]))).motor_inertia, [1234.57, 2469.14]);
}

/// What the log does not know either is no number afterwards.
#[test]
fn gaps_that_stay_unknown_stay_gaps() {
    let open = ARM
        .replace("stiffness = [9000.0, 4000.0]", "stiffness = [nan, nan]")
        .replace("motor_damping = [1.0, 0.5]", "motor_damping = nan");
    let dampings = [(0, Parameter::MotorDamping), (1, Parameter::MotorDamping)];
    let text = completed(&open, &found(&[&[(1, Parameter::Stiffness)], &dampings[..]].concat()));
    assert!(text.contains("stiffness = [1234.57, nan] "), "{text}");
    assert!(text.contains("\nmotor_damping = nan\n"), "{text}");
}

/// Joints may have sources of their own.
#[test]
fn sources_of_single_joints_are_replaced() {
    let (head, _) = ARM.split_once("[joints]").unwrap();
    let drive = "stiffness = 4000.0\nmotor_inertia = 0.2\nmotor_damping = 0.5\nlink_damping = 0.1\n";
    let sources =
        "[sources]\nstiffness = \"assumed: typical\"\n\"joints.elbow.stiffness\" = \"data sheet\"\n";
    let text = format!("{head}[joints.shoulder]\n{drive}[joints.elbow]\n{drive}{sources}");
    let of_both = completed(&text, &found(&[]));
    let source = "\"joints.elbow.stiffness\" = \"identified: 2469.14 ± 0.5 (3 sigma) from run.csv\"";
    assert!(of_both.contains(source) && of_both.contains("\nstiffness = \"identified: 1234.57"), "{of_both}");
    let of_one = completed(&text, &found(&[(1, Parameter::Stiffness)]));
    assert!(of_one.contains("\"joints.elbow.stiffness\" = \"data sheet\""), "{of_one}");
}

/// Only numbers are gaps: not what is said of them, not what is a tolerance; lists may take several lines.
#[test]
fn gaps_are_numbers() {
    let open = ARM
        .replace("stiffness = [9000.0, 4000.0]", "stiffness = [\n  nan, # to be found\n  4000.0,\n]")
        .replace("\"assumed: data sheet\"", "\"assumed: data sheet\"\nmotor_inertia = \"Brennan 1998\"");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, &open).unwrap();
    let file = RobotFile::load(path.to_str().unwrap(), Outside::Refused)
        .unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(file.gaps, [(0, Parameter::Stiffness)]);
    let unknown = [(0, Parameter::MotorInertia), (1, Parameter::MotorInertia)];
    assert!(completed(&open, &found(&unknown)).contains("\"Brennan 1998\""));
}

/// Of what an earlier log said of friction only its own lines are replaced.
#[test]
fn what_was_written_behind_the_friction_stays() {
    let text = completed(ARM, &found(&[]));
    let note = "# The elbow was greased.\n";
    let noted = text.clone() + note;
    let again = completed(&noted, &found(&[(1, Parameter::MotorFriction)]));
    assert_eq!(again.matches("# Dry friction").count(), 1, "{again}");
    assert!(again.contains(note), "{again}");
    let (before, tolerances) = text.split_once("\n[tolerances]\n").unwrap();
    let (tolerances, friction) = tolerances.split_once("\n\n").unwrap();
    let behind = format!("{before}\n{friction}\n[tolerances]\n{tolerances}\n");
    let robot = read(&completed(&behind, &found(&[])));
    assert_eq!(robot.tolerances.stiffness, [0.51, 0.51]);
}

/// Zeros are not written as if they had been found.
#[test]
fn friction_that_is_not_known_is_not_said() {
    let of_links = [(0, Parameter::LinkFriction), (1, Parameter::LinkFriction)];
    let text = completed(ARM, &found(&of_links));
    assert!(!text.contains("side = \"link\"") && text.contains("side = \"motor\""), "{text}");
    let of_motors = [(0, Parameter::MotorFriction), (1, Parameter::MotorFriction)];
    let text = completed(ARM, &found(&[of_links, of_motors].concat()));
    assert!(!text.contains("Dry friction"), "{text}");
    let text = completed(ARM, &found(&of_links[1..]));
    assert_eq!(text.matches("0.0 where the log does not know it").count(), 1, "{text}");
    assert!(text.contains("# coulomb = [1234.57, 0.0]"), "{text}");
}

/// Then there is nothing to write.
#[test]
fn logs_may_know_nothing() {
    let all = |joint: usize| Parameter::ALL.map(|parameter| (joint, parameter));
    let nothing = found(&[all(0), all(1)].concat());
    assert!(!nothing.knows_something() && completed(ARM, &nothing) == ARM);
    assert!(found(&[&all(0)[..], &all(1)[1..]].concat()).knows_something());
}

/// Error bars come along, around what is written, and replace what an earlier log said; what is not known keeps what it had.
#[test]
fn error_bars_are_tolerances() {
    let text = completed(ARM, &found(&[(1, Parameter::LinkDamping)]));
    let robot = read(&text);
    // 1234.57 is written for 1234.5678 ± 0.5, 2469.14 for 2469.1356.
    assert_eq!(robot.tolerances.stiffness, [0.51, 0.51]);
    assert_eq!(robot.tolerances.link_damping, [0.51, 0.0]);
    let mut better = found(&[(0, Parameter::Stiffness)]);
    for joint in &mut better.joints {
        joint.parameters.iter_mut().for_each(|estimate| estimate.error = 0.04);
    }
    let again = completed(&text, &better);
    let robot = read(&again);
    assert_eq!(robot.tolerances.stiffness, [0.51, 0.041]);
    assert!(robot.tolerances.motor_inertia.iter().all(|&x| x < 0.05), "{:?}", robot.tolerances);
    assert_eq!(again.matches("[tolerances]").count(), 1, "{again}");
    // Of a file that was identified before there were tolerances: they go before the comment, which is written anew.
    let (before, after) = text.split_once("\n[tolerances]\n").unwrap();
    let (_, friction) = after.split_once("\n\n").unwrap();
    assert_eq!(completed(&format!("{before}\n{friction}"), &found(&[(1, Parameter::LinkDamping)])), text);
    // None of a kind known: nothing is said of it.
    let none = completed(ARM, &found(&[(0, Parameter::MotorDamping), (1, Parameter::MotorDamping)]));
    assert!(!none.split_once("[tolerances]").unwrap().1.contains("motor_damping"), "{none}");
}

/// Tables of one joint each, as `flexure import` drafts them, and no table for all joints.
#[test]
fn tables_by_joint_are_filled_in_place() {
    let (head, _) = ARM.split_once("[joints]").unwrap();
    let drive = "stiffness = nan # here\nmotor_inertia = nan # kg m², assumed\nmotor_damping = nan\nlink_damping = 0.1\n";
    let text = format!("{head}[joints.shoulder]\n{drive}[joints.elbow]\n{drive}");
    let completed = completed(&text, &found(&[]));
    let robot = read(&completed);
    assert_eq!(robot.stiffness, [1234.57, 2469.14]);
    assert!(completed.contains("stiffness = 1234.57 # here"), "{completed}");
    assert!(completed.contains("motor_inertia = 2469.14 # kg m², identified"), "{completed}");
    assert!(completed.contains("[sources]"), "{completed}");
}

#[test]
fn a_robot_in_another_folder_is_refused_before_anything_is_computed() {
    let file = RobotFile::load("panda", Outside::Refused).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let problems = file.fits(&folder.path().join("panda.toml"), Outside::Refused).unwrap_err();
    assert_eq!(problems.iter().next().unwrap().code_word(), "unreadable");
}
