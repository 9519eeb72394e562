//! Robots of many joints in every command: two arms of seven joints with a sliding finger each, and parts of them.

#![allow(
    clippy::float_cmp,
    reason = "mirrored entries are the same number, and what is not coupled is exactly 0"
)]

use serde_json::Value;

use crate::command::{Outcome, Place, altered};

const URDF: &str = include_str!("../data/two-arms.urdf");
const ROBOT: &str = include_str!("../data/two-arms.toml");
const SCENARIO: &str = include_str!("../data/two-arms-tanh.toml");

/// Joints of one arm, from the shoulder.
const ARM: [&str; 8] = [
    "shoulder_yaw",
    "shoulder_pitch",
    "upper_arm_roll",
    "elbow",
    "forearm_roll",
    "wrist_pitch",
    "wrist_roll",
    "finger",
];

const DEVICES: &str = r#"
[estimator]
kind = "observer"
bandwidth = 400.0
[disturbance_observer]
bandwidth = 20.0
[guard]
torque_rate_limit = 20000.0
stop_damping = 1.0
[[imperfection]]
kind = "noise"
link = 1e-6
motor = 1e-6
[[imperfection]]
kind = "encoder"
resolution = 1e-6
dither = true
[[imperfection]]
kind = "delay"
computation = 0.0002
[[imperfection]]
kind = "saturation"
[[imperfection]]
kind = "friction"
side = "motor"
coulomb = 0.1
static = 0.15
stribeck_velocity = 0.05
[[imperfection]]
kind = "model-error"
mass = 1.02
payload = { mass = 0.05, position = [0.0, 0.0, 0.05] }
"#;

/// Two arms, and a scenario `duration` s long.
fn two_arms(duration: &str) -> Place {
    let place = Place::new();
    place.write("two-arms.urdf", URDF).write("two-arms.toml", ROBOT);
    place.write("arms.toml", altered(SCENARIO, &[("duration = 3.0", &format!("duration = {duration}"))]));
    place
}

/// Columns of a trace, by signal: how many joints each has, those without joints as 0.
fn joints_by_signal(trace: &str) -> Vec<(&str, usize)> {
    let mut found: Vec<(&str, usize)> = Vec::new();
    for name in trace.lines().next().unwrap().split(',') {
        let signal = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let joints = usize::from(signal != name);
        match found.iter_mut().find(|(known, _)| *known == signal) {
            Some((_, count)) => *count += joints,
            None => found.push((signal, joints)),
        }
    }
    found
}

/// Each signal of joints has `n` columns, and there are at least `signals` of them.
#[track_caller]
fn has_joints(trace: &str, n: usize, signals: usize) {
    let found = joints_by_signal(trace);
    assert!(found.iter().all(|&(_, joints)| joints == 0 || joints == n), "{found:?}");
    assert!(found.iter().filter(|&&(_, joints)| joints == n).count() >= signals, "{found:?}");
}

/// A state per line, `n` numbers in each list.
fn states(n: usize) -> String {
    let list = |start: f64| (0..n).map(|i| start + 0.01 * i as f64).collect::<Vec<_>>();
    let keys = ["q_l", "q_m", "dq_l", "dq_m", "u_m"];
    let lists: Vec<_> =
        keys.iter().enumerate().map(|(k, key)| format!("\"{key}\": {:?}", list(0.02 * k as f64))).collect();
    format!("{{\"t\": 0.5, {}}}\n", lists.join(", "))
}

fn length(value: &Value) -> usize {
    value.as_array().unwrap_or_else(|| panic!("{value}")).len()
}

fn first_line(outcome: &Outcome) -> Value {
    serde_json::from_str(outcome.stdout.lines().next().unwrap()).unwrap()
}

#[test]
fn sixteen_joints_are_shown_and_simulated() {
    let place = two_arms("0.2");
    let rows = place.run(&["check", "two-arms.toml", "--json"]).done().json();
    assert_eq!(length(&rows[0]["robot"]), 16);
    assert_eq!(rows[0]["robot"][8]["parent"], Value::Null, "the other arm is on the torso too");
    place.run(&["check", "arms.toml"]).done();
    let summary = place.run(&["run", "arms.toml", "--json"]).done().json();
    assert!(summary["max_abs_e_l"].as_f64().unwrap() < 1e-5, "{summary}");
    assert_eq!(summary["rate_certified"], Value::Null, "torque limits act");
    has_joints(&place.read("out/arms.csv"), 16, 11);
    let picture = place.read("out/arms.svg");
    let names: Vec<_> =
        rows[0]["robot"].as_array().unwrap().iter().map(|joint| joint["name"].as_str().unwrap()).collect();
    assert!(names.len() == 16 && names.iter().all(|name| picture.contains(name)), "{names:?}");
    let arms = altered(&place.read("arms.toml"), &[("[sources]", &format!("{DEVICES}\n[sources]"))]);
    place.write("devices.toml", arms);
    let summary = place.run(&["run", "devices.toml", "--json"]).done().json();
    assert!(summary["rms_e_l"].as_f64().unwrap() < 5e-3, "{summary}");
    has_joints(&place.read("out/devices.csv"), 16, 17);
}

#[test]
fn sixteen_joints_are_evaluated() {
    let place = two_arms("0.2");
    let law = first_line(&place.fed(&["eval", "arms.toml", "--states", "-"], states(16)).done());
    for key in ["u_m", "u_l", "q_md", "e_l", "sigma_m"] {
        assert_eq!(length(&law[key]), 16, "{key}");
    }
    let model = first_line(&place.fed(&["model", "two-arms.toml", "--states", "-"], states(16)).done());
    assert_eq!((length(&model["M_l"]), length(&model["dx"])), (16, 64));
    let mass: Vec<Vec<f64>> = serde_json::from_value(model["M_l"].clone()).unwrap();
    for (i, row) in mass.iter().enumerate() {
        assert_eq!(row.len(), 16);
        for (j, entry) in row.iter().enumerate() {
            let arms_apart = (i < 8) != (j < 8);
            assert!(*entry == mass[j][i] && !(arms_apart && *entry != 0.0), "M_{i}{j} = {entry}");
        }
    }
    place.fed(&["eval", "arms.toml", "--states", "-"], states(15)).refused(&["16 numbers expected"]);
}

#[test]
fn sixteen_joints_are_proved_and_checked() {
    let place = two_arms("0.2");
    let proof = ["certify", "arms.toml", "--error-box", "0.1", "--out", "arms.json"];
    place.run(&proof).done();
    let certificate: Value = serde_json::from_str(&place.read("arms.json")).unwrap();
    assert_eq!(length(&certificate["robot"]["links"]["bodies"]), 16);
    assert_eq!(length(&certificate["region"]["error"]), 32);
    assert_eq!(length(&certificate["mass_matrix"]["margins"]), 16);
    place.run(&["verify", "arms.json"]).done();
    place.run(&["certify", "arms.toml", "--error-box", "0.1,0.1"]).refused(&["1 or 32 numbers expected"]);
}

/// One case per corner of the slopes would be 65536 of them: it says so, and does not run for hours.
#[test]
fn cases_that_double_with_each_joint_are_not_begun() {
    let place = two_arms("0.05");
    let kappa = |side: &str| format!("[controller.{side}]\nkappa = {:?}", [20.0; 16]);
    let coupled = altered(
        &place.read("arms.toml"),
        &[
            ("phi = \"tanh\"", "phi = \"coupled-tanh\""),
            ("[controller.link]", &kappa("link")),
            ("[controller.motor]", &kappa("motor")),
        ],
    );
    place.write("coupled.toml", coupled);
    let summary = place.run(&["run", "coupled.toml", "--json"]).done().json();
    assert_eq!(summary["rate_certified"], Value::Null);
    let outcome = place.run(&["certify", "coupled.toml", "--error-box", "0.1"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    outcome.said(&["phi_l has 65536 cases", "16 joints", "1024"]);
}

#[test]
fn sixteen_joints_are_compared_and_measured() {
    let place = two_arms("0.02");
    let args = ["compare", "arms.toml", "--controllers", "vcbc:tanh,backstepping", "--budget", "2", "--json"];
    let scores = place.run(&args).done().json()["tasks"][0]["scores"].clone();
    for score in scores.as_array().unwrap() {
        let gains = score["gains"].as_array().unwrap();
        assert!(gains.iter().all(|gain| length(&gain["values"]) == 16), "{score}");
        assert!(score["rms_error"].as_f64().unwrap() < 1e-3, "{score}");
    }
    let margins = place.run(&["margins", "arms.toml", "--json"]).done().json();
    assert!(margins["loops"][0]["gain_low"]["holds"].as_f64().unwrap() < 1.0, "{margins}");
}

/// The first `n` joints of the two arms, the others held still, as every capacity has to take them.
#[test]
fn any_number_of_joints_fits() {
    let place = Place::new();
    place.write("two-arms.urdf", URDF);
    for n in [1, 3, 4, 5, 8, 9, 14] {
        let all = ["left", "right"].iter().flat_map(|side| ARM.map(|joint| format!("{side}_{joint}")));
        let locks: Vec<String> = all.skip(n).map(|joint| format!("--lock={joint}=0.01")).collect();
        let words: Vec<&str> =
            ["import", "two-arms.urdf"].into_iter().chain(locks.iter().map(String::as_str)).collect();
        let draft = place.run(&words).done().stdout;
        place.write("part.toml", draft.replace("= nan", "= 2.0"));
        let list = |value: f64| format!("{:?}", vec![value; n]);
        let side = |name: &str, damping: f64| {
            let (metric, damping) = (list(2.0), list(damping));
            format!("[controller.{name}]\nmetric = {metric}\nshaping = {}\ndamping = {damping}\n", list(2.0))
        };
        place.write(
            "moves.toml",
            format!(
                "robot = 'part.toml'\nduration = 0.02\ncontrol_period = 0.001\n[reference]\nkind = 'sine'\n\
                 amplitude = {}\nfrequency = {}\n[controller]\nkind = 'vcbc'\nphi = 'tanh'\n{}{}[accept]\nerror = 0.01\nat_limit = 1.0\n",
                list(0.01),
                list(1.0),
                side("link", 0.01),
                side("motor", 1.0)
            ),
        );
        let rows = place.run(&["check", "part.toml", "--json"]).done().json();
        assert_eq!(length(&rows[0]["robot"]), n);
        place.run(&["run", "moves.toml"]).done();
        // Torque limits of the URDF act: what is seen and commanded has columns, too.
        has_joints(&place.read("out/moves.csv"), n, 17);
        let model = first_line(&place.fed(&["model", "part.toml", "--states", "-"], states(n)).done());
        assert_eq!((length(&model["M_l"]), length(&model["dx"])), (n, 4 * n));
        place.run(&["certify", "moves.toml", "--error-box", "0.1", "--out", "c.json"]).done();
        let verified = place.run(&["verify", "c.json"]).done();
        assert!(verified.stdout.contains(&format!("robot, controller: {n} joint")), "{verified:?}");
    }
}

#[test]
fn seventeen_joints_are_refused() {
    let place = Place::new();
    let head = "<joint name=\"head\" type=\"continuous\"><parent link=\"torso\"/><child link=\"head_link\"/>\
                <axis xyz=\"0 0 1\"/></joint><link name=\"head_link\"><inertial><mass value=\"2\"/>\
                <inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.01\" iyz=\"0\" izz=\"0.01\"/></inertial></link></robot>";
    place.write("two-arms.urdf", altered(URDF, &[("</robot>", head)]));
    place.run(&["import", "two-arms.urdf"]).refused(&[
        "17 joints of two-arms.urdf move",
        "at most 16",
        "--lock JOINT=POSITION",
    ]);
    let robot = "name = 'arms'\n[links]\nkind = 'urdf'\nfile = 'two-arms.urdf'\n\
                 [joints]\nstiffness = 2.0\nmotor_inertia = 2.0\nlink_damping = 2.0\nmotor_damping = 2.0\n";
    place.write("robot.toml", robot);
    let states = ["model", "robot.toml", "--states", "-"];
    for outcome in [place.run(&["check", "robot.toml"]), place.fed(&states, self::states(17))] {
        outcome.refused(&["arms has 17 moving joints", "at most 16", "lock joints"]);
    }
}
