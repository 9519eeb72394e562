//! Robot files drafted from URDFs.

use flexure::robot::load_robot;
use flexure::robot::{ImportOptions, import, robot_from_text};

use super::{ARM, Folder};

fn held(locks: &[(String, f64)]) -> ImportOptions<'_> {
    ImportOptions { locks, ..ImportOptions::default() }
}

fn drafted(urdf: &str, locks: &[(String, f64)]) -> (Folder, String) {
    let folder = Folder::with(urdf);
    let path = folder.path().join("arm.urdf");
    let draft = import(path.to_str().unwrap(), &held(locks)).unwrap_or_else(|problems| panic!("{problems}"));
    (folder, draft.toml)
}

/// Every number that the URDF lacks is in one message, joint by joint, at the first of them; supplied, the file is a robot.
#[test]
fn what_is_missing_is_one_message() {
    let (folder, toml) = drafted(ARM, &[]);
    let marks = toml.lines().filter(|line| line.contains("= nan")).count();
    assert_eq!(marks, 6, "{toml}");
    let problems = robot_from_text("draft.toml", &toml, folder.path()).unwrap_err();
    let problem = problems.iter().next().unwrap();
    assert_eq!((problems.iter().count(), problem.code_word()), (1, "missing-number"), "{problems}");
    let (line, _) = problem.line_column().unwrap();
    assert!(toml.lines().nth(line - 1).unwrap().contains("SUPPLY"), "{problem}");
    let all = "6 numbers are still to be supplied (nan):\n  each of 2 joints, turn to slide: stiffness, motor_inertia, motor_damping";
    assert_eq!(problem.to_string(), all);
    // Joints that lack different numbers have a line each; an array lacks what stands as nan in it.
    let some = toml
        .replacen("stiffness = nan", "stiffness = 7.0", 1)
        .replace("[joints.turn]", "[joints]\ngear_ratio = [1.0, nan]\n[joints.turn]");
    let problems = robot_from_text("draft.toml", &some, folder.path()).unwrap_err();
    let expected = "6 numbers are still to be supplied (nan):\n  joint turn: motor_inertia, motor_damping\n  \
                    joint slide: stiffness, motor_inertia, motor_damping, gear_ratio";
    assert_eq!(problems.iter().next().unwrap().to_string(), expected);
    // What else is wrong is said as well.
    let worse = some.replace("stiffness = 7.0", "stiffness = -7.0");
    let problems = robot_from_text("draft.toml", &worse, folder.path()).unwrap_err();
    assert!(problems.to_string().contains("must be > 0") && problems.to_string().contains("6 numbers"));
    let robot = robot_from_text("draft.toml", &toml.replace("nan", "0.5"), folder.path()).unwrap();
    assert_eq!((robot.stiffness, robot.link_damping), (vec![0.5; 2], vec![0.3, 0.7]));
    assert_eq!(robot.limits.torque, [20.0, 50.0]);
    assert!(robot.warnings.is_empty());
}

/// Joints that mimic others are held still with them, wherever the chain of mimics ends.
#[test]
fn mimics_are_locked() {
    let urdf = ARM
        .replace(
            "<axis xyz=\"0 0 1\"/>",
            "<axis xyz=\"0 0 1\"/><mimic joint=\"lead\" multiplier=\"2\" offset=\"0.25\"/>",
        )
        .replace(
            "</robot>",
            r#"<link name="l"/><joint name="lead" type="prismatic"><parent link="upper"/><child link="l"/>
            <limit effort="1" velocity="1" lower="0.5" upper="1"/></joint></robot>"#,
        );
    let (folder, toml) = drafted(&urdf, &[]);
    assert!(toml.contains("locked = { lead = 0.5 }"), "{toml}");
    let robot = robot_from_text("draft.toml", &toml.replace("nan", "0.5"), folder.path()).unwrap();
    assert_eq!(robot.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["slide"]);
    // turn is held at 2 · 0.5 + 0.25: the slider starts 0.3 m out in that direction.
    let flexure::robot::Links::Tree(bodies) = robot.links else { panic!() };
    let [x, y, _] = bodies[0].translation;
    assert!((x - 0.3 * 1.25_f64.cos()).abs() < 1e-15 && (y - 0.3 * 1.25_f64.sin()).abs() < 1e-15);
    // Left to themselves they are refused.
    let problems = folder.robot("", super::DRIVES).unwrap_err();
    assert!(problems.to_string().contains("arm.urdf:16:"), "{problems}");
    assert!(problems.to_string().contains("joint 'turn' mimics joint 'lead'"), "{problems}");
}

/// Names that TOML would not take bare are quoted; paths too.
#[test]
fn odd_names_survive() {
    let odd = ARM.replace("\"turn\"", "\"left arm.&quot;turn&quot; é\"");
    let (folder, toml) = drafted(&odd, &[]);
    let robot = robot_from_text("draft.toml", &toml.replace("nan", "0.5"), folder.path()).unwrap();
    assert_eq!(robot.joints[0].name, "left arm.\"turn\" é");
    // A robot without a usable name is called like its file, and no name reaches a terminal that would obey it.
    for name in ["", "&#27;[31m"] {
        let (_, toml) =
            drafted(&ARM.replace("<robot name=\"arm\">", &format!("<robot name=\"{name}\">")), &[]);
        assert!(toml.contains("\nname = \"arm\"\n"), "{toml}");
    }
    let obeyed = toml.replace("name = \"arm\"", "name = \"\\u001b[31m\"").replace("nan", "0.5");
    let problems = robot_from_text("draft.toml", &obeyed, folder.path()).unwrap_err();
    assert!(problems.to_string().contains("must be a name"), "{problems}");
}

/// The draft of panda.urdf, completed, is the built-in arm.
#[test]
fn the_draft_of_the_panda_is_the_panda() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
    let toml = import(&format!("{folder}/panda.urdf"), &ImportOptions::default())
        .unwrap()
        .toml
        .replace("nan", "0.5");
    let robot = robot_from_text("draft.toml", &toml, folder.as_ref()).unwrap();
    let panda = load_robot("panda").unwrap();
    assert_eq!((robot.links, robot.limits), (panda.links, panda.limits));
}

#[test]
fn bad_locks_are_refused() {
    let folder = Folder::with(ARM);
    let path = folder.path().join("arm.urdf");
    for (name, objection) in [("trun", "is no joint of the URDF"), ("mount", "is a fixed joint")] {
        let problems = import(path.to_str().unwrap(), &held(&[(name.to_owned(), 0.0)])).unwrap_err();
        assert!(problems.to_string().contains(&format!("'{name}' {objection}")), "{problems}");
    }
    let draft = import(path.to_str().unwrap(), &held(&[("turn".to_owned(), 2.6)])).unwrap();
    assert!(draft.warnings[0].to_string().contains("'turn' is at 2.6, outside the limits -2 to 2.5"));
    assert!(import(path.to_str().unwrap(), &held(&[("turn".to_owned(), -2.0)])).unwrap().warnings.is_empty());
    let all = [("turn".to_owned(), 0.0), ("slide".to_owned(), 0.0)];
    let problems = import(path.to_str().unwrap(), &held(&all)).unwrap_err();
    assert!(problems.to_string().contains("no joint of the robot moves"), "{problems}");
}
