//! Drives of a class in place of what a URDF does not say.

use std::f64::consts::TAU;

use flexure::robot::{
    DRIVES, DriveClass, ImportOptions, JointKind, Robot, import_text, overview, robot_from_text,
};

use super::{ARM, Folder};

fn assumed(urdf: &str, class: &'static DriveClass) -> Robot {
    let folder = Folder::with(urdf);
    let options = ImportOptions { assume: Some(class), ..ImportOptions::default() };
    let draft = import_text("arm.urdf", urdf, &options).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(draft.missing.is_empty() && draft.still_missing().is_none());
    robot_from_text("draft.toml", &draft.toml, folder.path()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Drives of a class are scaled copies of each other: springs and rotors grow with the torque, their frequency does not.
#[test]
fn drives_scale_with_their_torque() {
    for class in DRIVES {
        let [small, large] = [7.0, 70.0].map(|torque| class.drive(JointKind::Revolute, torque));
        let pairs = [
            (small.stiffness, large.stiffness),
            (small.motor_inertia, large.motor_inertia),
            (small.link_damping, large.link_damping),
            (small.motor_damping, large.motor_damping),
            (small.friction, large.friction),
            (small.torque_rate, large.torque_rate),
        ];
        for (small, large) in pairs {
            assert!(
                small > 0.0 && (large / small - 10.0).abs() < 0.1,
                "{}: {small} {large}",
                class.entry.name
            );
        }
        assert!(small.gear_ratio.to_bits() == large.gear_ratio.to_bits() && small.gear_ratio > 1.0);
        // A tenth of the torque is left for motion, friction is a small part of it, and the motor swings slower than 50 Hz.
        let motor = (large.stiffness / large.motor_inertia).sqrt() / TAU;
        assert!((3.0..50.0).contains(&motor) && large.friction < 7.0, "{}: {motor} Hz", class.entry.name);
    }
}

/// A drive that slides is one that turns, with a pinion on it: the same energies at the same motion of the motor.
#[test]
fn pinions_keep_energies() {
    let radius = 0.05;
    for class in DRIVES {
        let turning = class.drive(JointKind::Revolute, 10.0 * radius);
        let sliding = class.drive(JointKind::Prismatic, 10.0);
        let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 0.02, "{}: {a} {b}", class.entry.name);
        same(sliding.stiffness * radius * radius, turning.stiffness);
        same(sliding.motor_inertia * radius * radius, turning.motor_inertia);
        same(sliding.motor_damping * radius * radius, turning.motor_damping);
        same(sliding.friction * radius, turning.friction);
        same(sliding.gear_ratio * radius, turning.gear_ratio);
    }
}

/// The large joints of a light arm swing as such arms do, and softer drives swing slower.
#[test]
fn resonances_are_those_of_the_class() {
    let panda = include_str!("../../../../../robots/panda.urdf");
    let options = |class| ImportOptions { assume: Some(class), ..ImportOptions::default() };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("panda.urdf"), panda).unwrap();
    let shoulder = |name: &str| {
        let draft = import_text("panda.urdf", panda, &options(DriveClass::named(name).unwrap())).unwrap();
        let robot = robot_from_text("draft.toml", &draft.toml, folder.path()).unwrap();
        let rows = overview(&robot).unwrap();
        // Link against a motor that is held: what is felt when the brakes are on.
        let held = (rows[1].stiffness / rows[1].link_inertia).sqrt() / TAU;
        let assumed: Vec<_> = robot.assumptions().into_iter().map(|assumed| assumed.key).collect();
        for key in
            ["stiffness", "motor_inertia", "motor_damping", "link_damping", "torque_rate_limit", "gear_ratio"]
        {
            assert!(assumed.contains(&format!("joints.{key}")), "{key} in {assumed:?}");
        }
        held
    };
    let [harmonic, elastic, cycloidal, belt] =
        ["harmonic-drive", "series-elastic", "cycloidal", "belt"].map(shoulder);
    assert!((8.0..30.0).contains(&harmonic), "{harmonic} Hz");
    assert!(elastic < 5.0 && elastic < belt && belt < harmonic && harmonic < cycloidal);
}

/// What the URDF says stays, and what it says by zeros is what it does not say.
#[test]
fn what_the_urdf_says_stays() {
    let class = DriveClass::named("harmonic-drive").unwrap();
    let robot = assumed(ARM, class);
    assert_eq!((robot.limits.torque, robot.link_damping), (vec![20.0, 50.0], vec![0.3, 0.7]));
    let drives = [class.drive(JointKind::Revolute, 20.0), class.drive(JointKind::Prismatic, 50.0)];
    assert_eq!(robot.stiffness, drives.map(|drive| drive.stiffness).to_vec());
    let silent = ARM.replace("effort=\"20\"", "").replace("damping=\"0.3\"", "damping=\"0\"");
    assert_ne!(silent, ARM);
    let robot = assumed(&silent, class);
    // Twice what holds 1 kg at 0.1 m, and the slider with its tool.
    assert!(robot.limits.torque[0] > 2.0 * 9.81 * 0.1 && robot.limits.torque[0] < 200.0);
    assert_eq!(
        robot.link_damping,
        [class.drive(JointKind::Revolute, robot.limits.torque[0]).link_damping, 0.7]
    );
    let assumed: Vec<_> = robot.assumed.iter().map(|assumed| assumed.key.as_str()).collect();
    assert!(assumed.iter().any(|key| key.ends_with("torque_limit")), "{assumed:?}");
}

/// Everything that is assumed follows from torque limits: what can be none is said once, for all joints.
#[test]
fn torque_limits_that_can_be_none_are_said() {
    let warnings = |urdf: &str, class: &str| {
        let options =
            ImportOptions { assume: Some(DriveClass::named(class).unwrap()), ..ImportOptions::default() };
        let draft = import_text("arm.urdf", urdf, &options).unwrap();
        draft.warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let panda = include_str!("../../../../../robots/panda.urdf");
    assert!(warnings(panda, "harmonic-drive").is_empty(), "{:?}", warnings(panda, "harmonic-drive"));
    // Wrists of 12 N m, and a hand that slides: 100 N on a pinion of 50 mm are 5 N m.
    let [heavy] = warnings(panda, "cycloidal").try_into().unwrap();
    assert!(heavy.contains("100 to 12000 N m") && heavy.contains("panda_joint7 (12 N m)"), "{heavy}");
    let unknown = ["87.0", "12.0", "100"].iter().fold(panda.to_owned(), |urdf, effort| {
        urdf.replace(&format!("effort=\"{effort}\""), "effort=\"300\"")
    });
    let said = warnings(&unknown, "harmonic-drive");
    assert!(said.iter().any(|said| said.contains("torque limit of 300")), "{said:?}");
    let [huge] =
        warnings(&ARM.replace("effort=\"20\"", "effort=\"1e5\""), "harmonic-drive").try_into().unwrap();
    assert!(huge.contains("outside") && huge.contains("turn ("), "{huge}");
}

#[test]
fn names_that_are_none_are_refused() {
    let problem = DriveClass::named("harmonic-drives").unwrap_err();
    assert_eq!(problem.code_word(), "unknown-name");
    assert!(problem.hint().contains("did you mean 'harmonic-drive'"));
    for class in DRIVES {
        assert_eq!(DriveClass::named(class.entry.name).unwrap().entry, class.entry);
    }
}
