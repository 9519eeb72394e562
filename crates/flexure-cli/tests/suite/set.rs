//! `--set`: scenarios changed on the command line.

use crate::command::Place;

/// Every command that takes a scenario sees the change, and what is wrong with it points there.
#[test]
fn every_command_with_a_scenario_takes_changes() {
    let place = Place::new();
    let state = r#"{"q_l": [0, 0], "q_m": [0.1, 0], "dq_l": [0, 0], "dq_m": [0, 0]}"#;
    place.write("states", state);
    let torque = |set: &[&str]| {
        let arguments = [&["eval", "two-link-tanh", "--states", "states", "--json"], set].concat();
        place.run(&arguments).done().json()[0]["u_m"][0].as_f64().unwrap()
    };
    assert!((torque(&["--set", "controller.motor.metric=[0.1, 0.1]"]) - torque(&[])).abs() > 1.0);
    let run =
        ["run", "two-link-tanh-smooth", "--set", "duration=0.02", "--set", "controller.phi=linear", "--json"];
    let summary = place.run(&run).json();
    assert_eq!((&summary["phi"], &summary["name"]), (&"linear".into(), &"two-link-tanh-smooth".into()));
    let bad = "controller.link.metirc=3";
    for command in [
        &["run", "two-link-tanh"][..],
        &["eval", "two-link-tanh", "--states", "states"],
        &["certify", "two-link-tanh"],
        &["check", "two-link-tanh"],
        &["compare", "two-link-tanh"],
        &["margins", "two-link-tanh"],
    ] {
        let outcome = place.run(&[command, &["--set", bad]].concat());
        outcome.refused(&[
            "unknown key 'metirc' in [controller.link]",
            "--set:1:17",
            "did you mean 'metric'",
        ]);
    }
    assert_eq!(place.names("."), ["out", "states"], "of the one run");
    let json = place.run(&["run", "two-link-tanh", "--set", bad, "--json"]).error_taken();
    json.refused(&[]);
}

#[test]
fn changes_that_change_nothing_are_refused() {
    let place = Place::new();
    for (command, said) in [
        (&["list"][..], "list takes none"),
        (&["model", "panda", "--states", "-"], "model takes none"),
        (&["verify", "certificate.json"], "verify without --against takes none"),
        (&["reproduce"], "reproduce takes none"),
    ] {
        place.run(&[command, &["--set", "duration=3"]].concat()).refused(&[said, "--set changes a scenario"]);
    }
    for (set, said) in
        [("duration", "= and a value are missing"), ("", "a key is missing"), ("a[x]=1", "an index is")]
    {
        let outcome = place.run(&["run", "two-link-tanh", "--set", set]);
        assert_eq!((outcome.code, outcome.stderr.contains(said)), (Some(2), true), "{outcome:?}");
    }
    // A robot file is changed by `check`, by its own keys.
    let changed = ["check", "panda", "--set", "joints.stiffness=1234", "--json"];
    assert_eq!(place.run(&changed).done().json()[0]["robot"][6]["stiffness"], 1234.0);
}

/// Where there is no scenario, changes are refused, and the help does not offer them.
#[test]
fn commands_without_a_scenario_do_not_offer_changes() {
    let place = Place::new();
    for command in [
        &["reproduce"][..],
        &["model", "panda", "--states", "states"],
        &["import", "arm.urdf"],
        &["excite", "panda"],
        &["identify", "panda", "--log", "log.csv"],
        &["list"],
        &["completions", "bash"],
        &["man"],
    ] {
        place.run(&[command, &["--set", "duration=1"]].concat()).refused(&["takes none", command[0]]);
        let help = place.run(&[command[0], "--help"]).done().stdout;
        assert!(!help.contains("--set") && help.contains("--json"), "{help}");
    }
    for command in ["run", "certify", "check", "compare", "eval", "margins", "replay", "tune", "verify"] {
        let help = place.run(&[command, "--help"]).done().stdout;
        assert!(help.contains("--set <KEY=VALUE>"), "{help}");
    }
}
