//! From a log to what holds of every robot that it leaves open: `flexure identify`, then `flexure certify`.

use serde_json::Value;

use crate::command::{Place, ROBOT};

/// A vertical arm of two joints, with its true numbers.
const ARM: &str = r#"name = "elbow-arm"
[links]
kind = "tree"
[[links.joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
mass = 4.0
com = [0.2, 0.0, 0.02]
inertia = [0.02, 0.0, 0.0, 0.08, 0.0, 0.08]
[[links.joint]]
name = "elbow"
parent = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
xyz = [0.4, 0.0, 0.0]
mass = 2.5
com = [0.15, 0.0, 0.0]
inertia = [0.01, 0.0, 0.0, 0.03, 0.0, 0.03]
[joints]
stiffness = [9000.0, 4000.0]
motor_inertia = [0.5, 0.2]
link_damping = [0.4, 0.2]
motor_damping = [1.0, 0.5]
torque_limit = [80.0, 40.0]
position_lower = -2.5
position_upper = 2.5
"#;

/// It follows slow sines from rest, with gains for 20 1/s.
const SCENARIO: &str = r#"robot = "found.toml"
duration = 3.0
control_period = 0.001
[reference]
kind = "sine"
amplitude = [0.1, 0.1]
frequency = [1.0, 1.0]
[reference.smooth_start]
duration = 2.0
[controller]
kind = "vcbc"
phi = "linear"
link = { metric = [412.0, 34.4], shaping = [20.0, 20.0], damping = [25.1, 6.2] }
motor = { metric = [18000.0, 8000.0], shaping = [20.0, 20.0], damping = [20.0, 8.0] }
"#;

/// A public arm with springs that are up to 30 % off what its file says, moved and logged with motor encoders alone. Its first axis and
/// its third are nearly the same, and what the log knows well of their compliances is the sum.
///
/// `cargo test --release -p flexure-cli --test suite -- --ignored identified --nocapture`.
#[test]
#[ignore = "a minute of two cores in release, many without"]
fn a_public_arm_is_identified_from_its_motors_alone() {
    let place = Place::new();
    let truth = flexure::Robot::load("panda").unwrap().stiffness;
    let guess = include_str!("../../../../robots/panda.toml")
        .replace(
            "[14000.0, 14000.0, 9000.0, 9000.0, 5000.0, 5000.0, 4000.0]",
            "[18000, 11000, 11500, 7000, 6300, 4000, 5200]",
        )
        .replace(
            "[0.6057, 0.6057, 0.4625, 0.4625, 0.2055, 0.2055, 0.2055]",
            "[0.75, 0.5, 0.6, 0.4, 0.26, 0.16, 0.26]",
        );
    place.write("guess.toml", guess).write("panda.urdf", include_str!("../../../../robots/panda.urdf"));
    place.run(&["excite", "panda", "--motor-only", "--out", "motion.toml"]).done();
    place.run(&["run", "motion.toml", "--out", "."]).done();
    let begun = std::time::Instant::now();
    place
        .run(&["identify", "guess.toml", "--log", "motion.csv", "--motor-only", "--out", "found.toml"])
        .done();
    let took = begun.elapsed().as_secs_f64();
    let found = flexure::Robot::load(place.path().join("found.toml").to_str().unwrap()).unwrap();
    for (i, (truth, (value, tolerance))) in
        truth.iter().zip(found.stiffness.iter().zip(&found.tolerances.stiffness)).enumerate()
    {
        println!(
            "{}: {:+.2} %, tolerance {:.2} %",
            i + 1,
            100.0 * (value / truth - 1.0),
            100.0 * tolerance / truth
        );
        assert!(
            (value - truth).abs() < 0.03 * truth && (value - truth).abs() <= *tolerance,
            "{value} ± {tolerance}: {truth}"
        );
    }
    println!("{took:.0} s");
}

/// Guesses that are off by a fifth, a log of the arm, a file with intervals, and one rate for all robots in them.
#[test]
fn an_identified_arm_is_certified_with_its_error_bars() {
    let place = Place::new();
    place.write("arm.toml", ARM);
    let guess = ARM
        .replace("[9000.0, 4000.0]", "[8000.0, 4800.0]")
        .replace("[0.5, 0.2]", "[0.6, 0.17]")
        .replace("[0.4, 0.2]", "[0.3, 0.3]")
        .replace("[1.0, 0.5]", "[1.4, 0.4]");
    place.write("guess.toml", guess);
    place
        .run(&["excite", "arm.toml", "--duration", "6", "--control-period", "0.001", "--budget", "20"])
        .done();
    place.run(&["run", "arm-excite.toml", "--out", "."]).done();
    place.run(&["identify", "guess.toml", "--log", "arm-excite.csv", "--out", "found.toml"]).done();
    let found_text = place.read("found.toml");
    // Over its own result, and over the file that is completed, but over nothing else.
    let again = |out: &str| place.run(&["identify", "guess.toml", "--log", "arm-excite.csv", "--out", out]);
    for other in ["arm.toml", "arm-excite.toml", "arm-excite.csv", "."] {
        let text = (other != ".").then(|| place.read(other));
        again(other).refused(&["is no robot file that was identified", "name another file"]);
        assert_eq!((other != ".").then(|| place.read(other)), text);
    }
    again("found.toml").done();
    assert_eq!(place.read("found.toml"), found_text);
    let found = flexure::Robot::load(place.path().join("found.toml").to_str().unwrap()).unwrap();
    let tolerances = &found.tolerances;
    for (values, tolerances, truth) in [
        (&found.stiffness, &tolerances.stiffness, [9000.0, 4000.0]),
        (&found.motor_inertia, &tolerances.motor_inertia, [0.5, 0.2]),
    ] {
        for ((x, tolerance), truth) in values.iter().zip(tolerances).zip(truth) {
            assert!(
                (x - truth).abs() <= *tolerance && *tolerance < 0.01 * truth,
                "{x} ± {tolerance}: {truth}"
            );
        }
    }
    // Every reader takes the file.
    place.run(&["check", "found.toml"]).done();

    place.write("arm-sine.toml", SCENARIO);
    let certified = place.run(&["certify", "arm-sine.toml", "--no-tube", "--json"]).done().json();
    let within = &certified["within"];
    let number = |key: &str| within[key].as_f64().unwrap();
    let nominal = certified["convergence_rate"].as_f64().unwrap();
    assert!(number("rate") > 0.8 * nominal && number("rate") < nominal, "{within}");
    assert!(number("settles") > 0.0 && number("settles") <= number("level"), "{within}");
    let errors = within["error"].as_array().unwrap();
    assert!(errors.len() == 4 && errors[0].as_f64().unwrap() < 0.003, "{within}");
    // Limits are kept by all of them.
    assert!(certified["along"].is_null(), "in the funnel");
    let limits = certified["funnel"]["limits"].as_array().unwrap();
    assert!(
        limits.len() == 2 && limits.iter().all(|limit| limit["verdict"]["proved"].is_number()),
        "{limits:?}"
    );
    let assumptions = certified["assumptions"].to_string();
    assert!(
        assumptions.contains("its tolerances are no part of the certificate")
            && assumptions.contains("link_damping of shoulder is taken as it stands"),
        "{assumptions}"
    );
    let shown = place.run(&["certify", "arm-sine.toml", "--no-tube"]).done().stdout;
    assert!(shown.contains("tolerances   every robot within them") && shown.contains("not to 0"), "{shown}");

    // The certificate is about the numbers, and says so; one that was made to look wider is not of this robot.
    let file = certified["file"].as_str().unwrap();
    let against = place.run(&["verify", file, "--against", "arm-sine.toml"]).done();
    assert!(against.stdout.contains("it says nothing of the tolerances"), "{}", against.stdout);
    let mut forged: Value = serde_json::from_str(&place.read(file)).unwrap();
    let wider = |x: &Value| {
        let x: f64 = x.as_str().unwrap().parse().unwrap();
        Value::from(vec![format!("{:?}", x - 7.0), format!("{:?}", x + 7.0)])
    };
    let stiffness = forged["robot"]["stiffness"].as_array_mut().unwrap();
    for x in stiffness.iter_mut() {
        *x = wider(x);
    }
    place.write("forged.json", forged.to_string());
    let refused = place.run(&["verify", "forged.json", "--against", "arm-sine.toml"]);
    assert_eq!(refused.code, Some(1), "{refused:?}");
    refused.said(&["is not about arm-sine.toml", "robot.stiffness"]);
    // With other tolerances it is another file.
    let (numbers, tolerances) = found_text.split_once("\n[tolerances]\n").expect("tolerances");
    let wider = tolerances.replacen("stiffness = [", "stiffness = [1", 1);
    assert_ne!(wider, tolerances);
    place.write("found.toml", format!("{numbers}\n[tolerances]\n{wider}"));
    let other = place.run(&["verify", file, "--against", "arm-sine.toml"]);
    assert_eq!(other.code, Some(1), "{other:?}");
}

/// A stiff law answers to every count of its encoders, and with much torque noise in the gain these answers pass for inertia and delay: 0.0588 ±
/// 0.0007 kg m² for 0.0635 was found so. The truth is inside of every printed bar.
#[test]
fn a_stiff_law_does_not_mislead() {
    let place = Place::new();
    place.run(&["excite", "two-link-plausible", "--duration", "8", "--out", "motion.toml"]).done();
    for (factors, name) in [([1.0, 1.0], "as its file"), ([1.2, 0.86], "another")] {
        let [k, m] = factors;
        let error =
            format!("imperfection.wrong={{kind=\"model-error\",stiffness={k:?},motor_inertia={m:?}}}");
        place.run(&["run", "motion.toml", "--set", &error, "--out", "."]).done();
        let found =
            place.run(&["identify", "two-link-plausible", "--log", "motion.csv", "--json"]).done().json();
        assert_eq!(found["converged"], true, "{name}");
        let [offset, bar] = ["value", "error"].map(|key| found["offsets"][0][key].as_f64().unwrap());
        assert!(offset.abs() <= bar && bar < 1e-4, "{name}: {offset} ± {bar} s");
        for (i, joint) in found["joints"].as_array().unwrap().iter().enumerate() {
            let truths = [
                ("stiffness", k * [39.96, 6.86][i]),
                ("motor_inertia", m * [0.0635, 0.00302][i]),
                ("link_damping", [0.8, 0.55][i]),
                ("motor_damping", [4.0, 1.5][i]),
            ];
            for (parameter, (key, truth)) in joint["parameters"].as_array().unwrap().iter().zip(truths) {
                let [value, error] = ["value", "error"].map(|key| parameter[key].as_f64().unwrap());
                assert!(parameter["key"] == key && parameter["known"] == true, "{name}: {parameter}");
                assert!((value - truth).abs() <= error, "{name}: {key} {value} ± {error} for {truth}");
            }
        }
    }
}

/// Robots that differ too much are not decided: exit code 3, the place of the tolerances, and a certificate of the file's numbers.
#[test]
fn too_wide_tolerances_are_not_decided() {
    let place = Place::new();
    place.write("found.toml", format!("{ARM}[tolerances]\nstiffness = [4000.0, 2000.0]\n"));
    place.write("arm-sine.toml", SCENARIO);
    let open = place.run(&["certify", "arm-sine.toml", "--no-tube", "--json"]);
    assert_eq!(open.code, Some(3), "{open:?}");
    open.said(&["found.toml:", "the robots within its tolerances are not decided"]);
    let found = open.json();
    assert_eq!((&found["verdict"], &found["within"]["verdict"]), (&"undecided".into(), &"undecided".into()));
    assert!(found["file"].is_string() && found["along"].is_null(), "{found}");
    // Without tolerances there is nothing to say of them.
    place.write("found.toml", ROBOT);
    let plain = place.run(&["check", "found.toml", "--json"]).done();
    assert!(!plain.stdout.contains("tolerances"), "{}", plain.stdout);
}
