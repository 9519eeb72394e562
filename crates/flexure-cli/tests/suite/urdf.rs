//! Robots from URDF files, as a user takes them in; and files that nobody should take in.

use serde_json::{Value, json};

use crate::command::Place;

const PANDA: &str = include_str!("../../../../robots/panda.urdf");

/// From a URDF to a robot that is checked: draft, numbers, table.
#[test]
fn a_draft_is_completed_and_checked() {
    let place = Place::new();
    place.write("urdf/panda.urdf", PANDA);
    let draft = place.run(&["import", "urdf/panda.urdf"]).done();
    assert!(draft.stderr.contains("21 numbers are still to be supplied"), "{}", draft.stderr);
    place.write("arm.toml", &draft.stdout);
    place.run(&["check", "arm.toml"]).refused(&[
        "arm.toml:",
        "21 numbers are still to be supplied (nan):",
        "each of 7 joints, panda_joint1 to panda_joint7: stiffness, motor_inertia, motor_damping",
    ]);
    place.write("arm.toml", draft.stdout.replace("= nan", "= 7.25"));
    let checked = place.run(&["check", "arm.toml"]).done();
    let first = checked.stdout.lines().next().unwrap();
    assert_eq!(first, "arm.toml: robot panda, 7 joints, 1 assumption, 0 warnings");
    assert!(checked.stdout.contains("assumed: joints.link_damping = 7 values: damping of the URDF"));
    let table = checked.stdout.lines().filter(|line| !line.starts_with("assumed"));
    assert!(table.clone().all(|line| line.chars().count() <= 100), "{}", checked.stdout);
    for joint in 1..=7 {
        let name = format!("panda_joint{joint}");
        let row = checked.stdout.lines().find(|line| line.contains(&name)).unwrap();
        assert!(row.contains("7.25") && row.contains("0.003"), "{row}");
    }
    let document = place.run(&["check", "arm.toml", "--json"]).done().json();
    let rows = document[0]["robot"].as_array().unwrap();
    assert_eq!((rows.len(), &rows[3]["parent"]), (7, &json!("panda_joint3")));
    assert_eq!((&rows[3]["position_lower"], &rows[3]["torque_limit"]), (&json!(-3.0718), &json!(87.0)));
    // Two equal inertias on a spring: the resonance is √(2 K / M) / 2π of the harmonic mean.
    let number = |key: &str| rows[1][key].as_f64().unwrap();
    let expected = (7.25 * (1.0 / 7.25 + 1.0 / number("link_inertia"))).sqrt() / std::f64::consts::TAU;
    assert!((number("resonance") - expected).abs() < 1e-12);
}

#[test]
fn drafts_hold_joints_still() {
    let place = Place::new();
    place.write("panda.urdf", PANDA);
    let locked =
        ["import", "panda.urdf", "--lock", "panda_joint7=0.5", "--lock", "panda_joint1=-1e-1", "--json"];
    let draft = place.run(&locked).done().json();
    assert_eq!(draft["joints"].as_array().unwrap().len(), 5);
    let toml = draft["toml"].as_str().unwrap();
    assert!(
        toml.contains("locked = { panda_finger_joint1 = 0.0, panda_joint1 = -0.1, panda_joint7 = 0.5 }"),
        "{toml}"
    );
    for (lock, said) in [
        ("panda_joint9=0", "'panda_joint9' is no joint of the URDF"),
        ("panda_hand_joint=0", "'panda_hand_joint' is a fixed joint"),
    ] {
        place.run(&["import", "panda.urdf", "--lock", lock]).refused(&[said, "panda.urdf:6:1"]);
    }
    let twice = ["import", "panda.urdf", "--lock", "panda_joint1=0", "--lock", "panda_joint1=1"];
    place.run(&twice).refused(&["joint \"panda_joint1\" is locked twice"]);
    for lock in ["panda_joint1", "panda_joint1=", "panda_joint1=x", "panda_joint1=nan"] {
        let outcome = place.run(&["import", "panda.urdf", "--lock", lock]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
    }
    place.run(&["import", "none.urdf"]).refused(&["cannot read none.urdf"]);
    place.run(&["import", "."]).refused(&["cannot read ."]);
    for command in ["check", "run"] {
        place.run(&[command, "panda.urdf"]).refused(&["this is XML", "flexure import"]);
    }
}

/// The law and the model of the golden file, through files and the command.
#[test]
fn golden_file_on_the_urdf() {
    let golden: Value =
        serde_json::from_str(include_str!("../../../flexure/tests/golden/panda.json")).unwrap();
    let place = Place::new();
    place.write("panda.urdf", PANDA);
    let mut samples = 0;
    for case in golden["cases"].as_array().unwrap() {
        let [K, M_m, D_l, D_m] = ["K", "M_m", "D_l", "D_m"].map(|key| &case[key]);
        place.write(
            "robot.toml",
            format!(
                "name = 'panda'\n[links]\nkind = 'urdf'\nfile = 'panda.urdf'\nlocked = {{ panda_finger_joint1 = 0.0 }}\n\
                 [joints]\nstiffness = {K}\nmotor_inertia = {M_m}\nlink_damping = {D_l}\nmotor_damping = {D_m}\n"
            ),
        );
        let [Lambda_l, Lambda_m, K_ld, K_md] = ["Lambda_l", "Lambda_m", "K_ld", "K_md"].map(|key| &case[key]);
        let [offset, amplitude, frequency] =
            ["offset", "amplitude", "frequency"].map(|key| &case["reference"][key]);
        place.write(
            "scenario.toml",
            format!(
                "robot = 'robot.toml'\nduration = 1.0\ncontrol_period = 0.001\n[initial]\nq_l = {offset}\n\
                 [reference]\nkind = 'sine'\noffset = {offset}\namplitude = {amplitude}\nfrequency = {frequency}\n\
                 [controller]\nkind = 'vcbc'\nphi = {}\n[controller.link]\nmetric = {Lambda_l}\nshaping = {Lambda_l}\ndamping = {K_ld}\n\
                 [controller.motor]\nmetric = {Lambda_m}\nshaping = {Lambda_m}\ndamping = {K_md}\n",
                case["phi"]
            ),
        );
        let states: String = case["samples"].as_array().unwrap().iter().map(state).collect();
        let eval = place.fed(&["eval", "scenario.toml", "--states", "-"], &states).done();
        let model = place.fed(&["model", "robot.toml", "--states", "-"], &states).done();
        let rows = eval.stdout.lines().zip(model.stdout.lines());
        for ((law, model), sample) in rows.zip(case["samples"].as_array().unwrap()) {
            let parse = |line: &str| serde_json::from_str::<Value>(line).unwrap();
            let (law, model) = (parse(law), parse(model));
            for (row, keys) in [(&law, &["u_m", "u_l", "q_md"]), (&model, &["M_l", "bias", "ddq_l"])] {
                for key in keys {
                    close(key, &numbers(&row[key]), &numbers(&sample["expect"][key]));
                }
            }
            samples += 1;
        }
    }
    assert_eq!(samples, 12);
}

/// A line of a states file.
fn state(sample: &Value) -> String {
    let keys = ["t", "q_l", "q_m", "dq_l", "dq_m"];
    let state: serde_json::Map<_, _> =
        keys.iter().map(|key| ((*key).to_owned(), sample[key].clone())).collect();
    format!("{}\n", Value::Object(state))
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

/// What is asked for, relative to the largest entry; torques are of 1e5 N m and rounding grows with them.
#[track_caller]
fn close(what: &str, found: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-9 * scale, "{what}: {found:?} against {expected:?}");
    }
}
