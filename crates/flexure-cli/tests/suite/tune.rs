//! `flexure tune`.

use crate::command::Place;

/// Half a second of a pendulum with its gains left out.
const SHORT: &str = "robot = \"pendulum-1dof\"\nduration = 0.5\ncontrol_period = 0.001\n\
                     # a swing\n[reference]\nkind = \"sine\"\namplitude = 0.3\nfrequency = 3.0\n\
                     [reference.smooth_start]\nduration = 0.2\n[controller]\nkind = \"vcbc\" # to be tuned\n";

#[test]
fn a_tuned_scenario_is_written_and_follows() {
    let place = Place::new();
    place.write("swing.toml", SHORT);
    let text = place.run(&["tune", "swing.toml", "--budget", "4"]).done().stdout;
    assert!(text.contains("a quarter more of") && text.contains("wrote swing-tuned.toml"), "{text}");
    let tuned = place.read("swing-tuned.toml");
    assert!(tuned.starts_with("# Tuned by flexure") && tuned.contains("# a swing"), "{tuned}");
    place.run(&["run", "swing-tuned.toml"]).done();
    // Twice is no problem, over another file it is.
    place.run(&["tune", "swing.toml", "--budget", "1"]).done();
    let json = place.run(&["tune", "swing.toml", "--budget", "2", "--json"]).done().json();
    assert!(
        json["feasible"] == true && json["gains"].as_array().is_some_and(|gains| gains.len() == 6),
        "{json}"
    );
}

/// Tuning, a run and a proof say of the same loop in the same words what is proved, and what stands outside.
#[test]
fn what_stands_outside_of_proofs_is_said_alike() {
    let place = Place::new();
    place.write("late.toml", format!("{SHORT}[[imperfection]]\nkind = \"delay\"\ncomputation = 0.001\n"));
    let words = "proofs are of the ideal loop (true states, no delay, torque in continuous time); outside of them stand, in this scenario: \
                 delay";
    let tuned = place.run(&["tune", "late.toml", "--budget", "4"]).done().stdout;
    assert!(tuned.contains("proved (ideal loop)") && tuned.contains(words), "{tuned}");
    for command in ["run", "certify"] {
        let said = place.run(&[command, "late-tuned.toml"]).done().stdout;
        assert!(said.contains(words), "{command}: {said}");
    }
    // Nothing stands outside, nothing is said.
    place.write("swing.toml", SHORT);
    assert!(!place.run(&["run", "swing.toml"]).done().stdout.contains("proofs are of"));
}

#[test]
fn what_cannot_be_had_is_a_no_and_writes_nothing() {
    let place = Place::new();
    place.write("swing.toml", SHORT).write("spec.toml", "rate = 9000.0\n");
    let outcome = place.run(&["tune", "swing.toml", "--spec", "spec.toml", "--budget", "4"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&["no gains were found", "feasible"]);
    assert!(!place.path().join("swing-tuned.toml").exists());
}

#[test]
fn what_is_far_too_late_is_a_no() {
    let place = Place::new();
    place.write("spec.toml", "delay = 0.15\n");
    let late =
        ["tune", "two-link-tanh-smooth", "--spec", "spec.toml", "--budget", "2", "--out", "new/tuned.toml"];
    let outcome = place.run(&late);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&["less delay"]);
    assert!(outcome.stdout.contains("sampled loop: not looked at"), "{}", outcome.stdout);
    assert!(!outcome.stdout.contains("small errors shrink in the sampled loop"), "{}", outcome.stdout);
    assert_eq!(place.names("."), ["spec.toml"]);
}

#[test]
fn questions_that_cannot_be_meant_are_refused() {
    let place = Place::new();
    place
        .write("swing.toml", SHORT)
        .write("spec.toml", "rate = 3.0\n")
        .write("bad.toml", "rate = \"quick\"\n")
        .write("both.toml", "delay = 0.0\n[[imperfection]]\nkind = \"delay\"\ncomputation = 0.005\n");
    place.write("pd.toml", SHORT.replace("vcbc", "pd"));
    place.write("ideal.toml", SHORT.replace("[reference]", "hold = \"continuous\"\n[reference]"));
    let refused = |args: &[&str], fragments: &[&str]| place.run(args).refused(fragments);
    refused(&["tune", "nowhere"], &["nowhere"]);
    refused(&["tune", "swing.toml", "--budget", "0"], &["budget is 0"]);
    refused(&["tune", "swing.toml", "--spec", "none.toml"], &["none.toml"]);
    refused(&["tune", "swing.toml", "--spec", "bad.toml"], &["bad.toml", "quick", "max"]);
    refused(&["tune", "swing.toml", "--spec", "both.toml"], &["both say how late", "leave one"]);
    refused(&["tune", "pd.toml", "--spec", "spec.toml"], &["rate is asked for", "leave rate out"]);
    refused(&["tune", "ideal.toml"], &["hold is \"continuous\""]);
    refused(&["tune", "swing.toml", "--out", "swing.toml"], &["is what is read"]);
    refused(&["tune", "swing.toml", "--out", "spec.toml"], &["exists and is no scenario that was tuned"]);
    refused(&["tune", "swing.toml", "--out", "."], &["exists and is no scenario that was tuned"]);
    refused(&["tune", "panda"], &["robot"]);
    let robot = ["tune", "swing.toml", "--set", "robot.gravity=[0, 0, 0]"];
    refused(&robot, &["what is written is the scenario's", "--set robot=COPY.toml"]);
    assert_eq!(
        place.names("."),
        ["bad.toml", "both.toml", "ideal.toml", "pd.toml", "spec.toml", "swing.toml"]
    );
}
