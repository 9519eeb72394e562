//! Files that files name: inside their folders, or allowed to be elsewhere.

use serde_json::Value;

use crate::command::{Place, ROBOT, SCENARIO, altered};

/// What must never be said.
const SECRET: &str = "root:x:0:0";

/// Every way to name a file in a file: robot of a scenario, URDF of a robot, samples, another robot for the plant.
fn naming(place: &Place, path: &str) -> Vec<Vec<String>> {
    let quoted = format!("\"{path}\"");
    place.write("home/arm.toml", ROBOT);
    place.scenario("home/robot.toml", &[("\"quanser-2dof\"", &quoted)]);
    let urdf = format!("name = \"a\"\n[links]\nkind = \"urdf\"\nfile = {quoted}\n[joints]\nstiffness = 1\n");
    place.write("home/urdf.toml", urdf);
    place.scenario("home/through.toml", &[("\"quanser-2dof\"", "\"urdf.toml\"")]);
    let sine = &SCENARIO[SCENARIO.find("kind = \"sine\"").unwrap()..SCENARIO.find("[controller]").unwrap()];
    place.scenario("home/samples.toml", &[(sine, &format!("kind = \"samples\"\nfile = {quoted}\n"))]);
    let plant = format!("[[imperfection]]\nkind = \"model-error\"\nrobot = {quoted}\n[sources]");
    place.scenario("home/plant.toml", &[("[sources]", &plant)]);
    let mut commands = vec![vec!["model", "home/urdf.toml", "--states", "-"]];
    for file in
        ["home/robot.toml", "home/urdf.toml", "home/through.toml", "home/samples.toml", "home/plant.toml"]
    {
        commands.push(vec!["check", file]);
        commands.push(vec!["check", file, "--json"]);
    }
    for file in ["home/robot.toml", "home/through.toml", "home/samples.toml", "home/plant.toml"] {
        for command in ["run", "certify", "margins", "compare"] {
            commands.push(vec![command, file]);
        }
        commands.push(vec!["run", file, "--json"]);
        commands.push(vec!["eval", file, "--states", "-"]);
    }
    commands.into_iter().map(|command| command.into_iter().map(str::to_owned).collect()).collect()
}

#[test]
#[cfg(unix)]
fn nothing_outside_is_shown() {
    let place = Place::new();
    place.write("passwd", format!("{SECRET}:root:/root:/bin/sh\n")).write("home/sub/none", "");
    std::os::unix::fs::symlink("../passwd", place.path().join("home/link.toml")).unwrap();
    let absolute = place.path().join("passwd").display().to_string();
    for path in ["../passwd", "sub/../../passwd", "link.toml", &absolute] {
        for command in naming(&place, path) {
            let args: Vec<&str> = command.iter().map(String::as_str).collect();
            let outcome = place.run(&args);
            let said = format!("{}{}", outcome.stdout, outcome.stderr);
            assert!(!said.contains(SECRET), "{command:?}: {said}");
            assert_eq!(outcome.code, Some(2), "{command:?}: {said}");
            assert!(said.contains("--allow-outside") && said.contains(".toml"), "{command:?}: {said}");
        }
    }
    // What is there and what is not look the same.
    let said = |path: &str| {
        place.scenario("home/s.toml", &[("\"quanser-2dof\"", &format!("\"{path}\""))]);
        place.run(&["check", "home/s.toml"]).stderr.replace(path, "PATH")
    };
    assert_eq!(said("../passwd"), said("../nobody"));
}

#[test]
fn what_is_allowed_is_read() {
    let place = Place::new();
    place.write("robots/arm.toml", ROBOT);
    place.scenario("scenarios/s.toml", &[("\"quanser-2dof\"", "\"../robots/arm.toml\"")]);
    place.run(&["check", "scenarios/s.toml"]).refused(&[
        "s.toml:3:9",
        "'../robots/arm.toml' is outside of 'scenarios'",
        "--allow-outside",
    ]);
    place.run(&["check", "--allow-outside", "scenarios/s.toml"]).done();
    // Below, and in the same place by another way, needs no leave.
    place.write("scenarios/robots/arm.toml", ROBOT);
    for path in ["robots/arm.toml", "../scenarios/robots/arm.toml", "./robots/../robots/arm.toml"] {
        place.scenario("scenarios/s.toml", &[("\"quanser-2dof\"", &format!("\"{path}\""))]);
        place.run(&["check", "scenarios/s.toml"]).done();
    }
}

/// A pipe is in no folder: what it names is found from the current one.
#[test]
#[cfg(target_os = "linux")]
fn pipes_are_read_once_by_every_command() {
    let place = Place::new();
    let short = [("duration = 10.0", "duration = 0.05"), ("\"quanser-2dof\"", "\"arm.toml\"")];
    place.write("arm.toml", ROBOT).write("s.txt", altered(SCENARIO, &short));
    place.write("q.jsonl", "{\"q_l\": [0, 0], \"q_m\": [0, 0], \"dq_l\": [0, 0], \"dq_m\": [0, 0]}\n");
    place.write("a.urdf", include_str!("../../../../robots/panda.urdf"));
    place.write("c.json", include_str!("../../../flexure/tests/certificates/pendulum.json"));
    for command in [
        "check <(cat arm.toml)",
        "check <(cat s.txt)",
        "check --json <(cat s.txt) <(cat arm.toml)",
        "run <(cat s.txt)",
        "eval <(cat s.txt) --states <(cat q.jsonl)",
        "model <(cat arm.toml) --states <(cat q.jsonl)",
        "certify <(cat s.txt) --out c.certificate.json",
        "import <(cat a.urdf) --lock panda_finger_joint1=0",
        "verify <(cat c.json)",
        "compare <(cat s.txt) --controllers pd --budget 2",
        "margins <(cat s.txt)",
    ] {
        let script = format!("exec '{}' {command}", env!("CARGO_BIN_EXE_flexure"));
        let mut shell = std::process::Command::new("bash");
        let output = shell.args(["-c", &script]).current_dir(place.path()).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        // Whether the loop is any good is another question.
        assert!(matches!(output.status.code(), Some(0 | 1)), "{command}: {said}");
        assert!(!output.stdout.is_empty(), "{command}: {said}");
    }
}

/// With `--json` every command says what is wrong as JSON, and in words as ever.
#[test]
fn errors_are_json() {
    let place = Place::new();
    place.scenario("s.toml", &[("duration = 10.0", "duration = -1")]);
    place
        .write("a.toml", ROBOT.replace("[9.0, 4.0]", "[9.0, 0.0]"))
        .write("a.urdf", "<robot>\n<link/></robot>");
    place.write("c.json", "{\n\"format\" 3}").write("q.jsonl", "{\n");
    let error = |args: &[&str]| -> Value {
        let outcome = place.run(&[args, &["--json"]].concat());
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains("rror"), "{outcome:?}");
        let error = outcome.json()["error"].clone();
        for key in ["code", "message", "hint"] {
            assert!(error[key].as_str().is_some_and(|text| !text.is_empty()), "{key} of {args:?}: {error}");
        }
        error
    };
    for (args, code, file, line) in [
        (&["run", "s.toml"][..], "range", "s.toml", 4),
        (&["eval", "s.toml", "--states", "-"], "range", "s.toml", 4),
        (&["certify", "s.toml"], "range", "s.toml", 4),
        (&["margins", "s.toml"], "range", "s.toml", 4),
        (&["compare", "s.toml"], "range", "s.toml", 4),
        (&["model", "a.toml", "--states", "-"], "range", "a.toml", 14),
        (&["model", "quanser-2dof", "--states", "q.jsonl"], "state", "q.jsonl", 1),
        (&["import", "a.urdf"], "missing", "a.urdf", 2),
        (&["verify", "c.json"], "verify", "c.json", 2),
    ] {
        let found = error(args);
        assert_eq!(
            (found["code"].as_str(), found["file"].as_str()),
            (Some(code), Some(file)),
            "{args:?}: {found}"
        );
        assert_eq!(found["line"], line, "{args:?}: {found}");
        assert!(found["others"].is_array() && found["column"].is_u64(), "{found}");
    }
    place.write("file", "");
    for (args, code) in [
        (&["run", "two-link-tahn"][..], "unknown-name"),
        (&["run", "none.toml"], "unreadable"),
        (&["reproduce", "--out", "file"], "write"),
        (&["certify", "two-link-tanh", "--rate", "-1"], "range"),
        (&["run"], "usage"),
        (&["bogus"], "usage"),
        (&["list", "bogus"], "usage"),
        (&[], "usage"),
    ] {
        assert_eq!(error(args)["code"], code, "{args:?}");
    }
    let verdicts = place.run(&["check", "s.toml", "a.toml", "--json"]).json();
    assert_eq!(
        (&verdicts[0]["errors"][0]["code"], &verdicts[1]["errors"][0]["line"]),
        (&"range".into(), &14.into())
    );
}

/// An answer that is no stands on stdout as ever, with the reason in it.
#[test]
fn a_no_has_its_reason() {
    let place = Place::new();
    let certificate = include_str!("../../../flexure/tests/certificates/pendulum.json");
    let at = certificate.find("\"contraction_rate\": \"").unwrap() + "\"contraction_rate\": \"".len();
    place.write("c.json", format!("{}9{}", &certificate[..at], &certificate[at..]));
    let outcome = place.run(&["verify", "c.json", "--json"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    let answer = outcome.json();
    assert_eq!((&answer["verdict"], &answer["error"]["code"]), (&"rejected".into(), &"verify".into()));
    let help = place.run(&["run", "--help", "--json"]).done();
    assert!(help.stdout.starts_with("Simulate") && help.stderr.is_empty());
}

/// Temporary files that a killed run left go with the next run into that folder.
#[test]
#[cfg(target_os = "linux")]
fn leftovers_of_killed_runs_go() {
    let place = Place::new();
    let ours = format!("out/.flexure-{}-aB3dE6.tmp", u32::MAX);
    place.write(&ours, "half a trace").write("out/.tmpaB3dE6", "").write("out/notes.tmp", "");
    place.scenario("s.toml", &[("duration = 10.0", "duration = 0.01")]);
    place.run(&["run", "s.toml"]).done();
    let names = place.names("out");
    assert!(!names.iter().any(|name| name.starts_with(".flexure-")), "{names:?}");
    assert!(names.contains(&".tmpaB3dE6".to_owned()) && names.contains(&"notes.tmp".to_owned()), "{names:?}");
}
