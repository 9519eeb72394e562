//! `flexure check` and `flexure list`.

use std::path::Path;

use serde_json::Value;

use crate::command::{Place, ROBOT};

#[test]
fn every_listed_robot_and_scenario_is_good() {
    let place = Place::new();
    let listed = place.run(&["list", "--json"]).done().json();
    for kind in ["robots", "scenarios", "controllers", "shaping", "references", "imperfections"] {
        assert!(listed[kind].as_object().is_some_and(|members| !members.is_empty()), "{kind}");
        let only = place.run(&["list", kind, "--json"]).done().json();
        assert_eq!(only.as_object().unwrap().len(), 1);
        assert_eq!(only[kind], listed[kind]);
        let text = place.run(&["list", kind]).done().stdout;
        for (name, summary) in listed[kind].as_object().unwrap() {
            let line = text.lines().find(|line| line.split_whitespace().next() == Some(name));
            assert!(line.is_some_and(|line| line.ends_with(summary.as_str().unwrap())), "{name} in\n{text}");
        }
    }
    for kind in ["robots", "scenarios"] {
        let names: Vec<_> = listed[kind].as_object().unwrap().keys().map(String::as_str).collect();
        let verdicts = place.run(&[&["check", "--json"], &names[..]].concat()).done().json();
        for (verdict, name) in verdicts.as_array().unwrap().iter().zip(names) {
            assert_eq!((&verdict["ok"], &verdict["name"]), (&true.into(), &name.into()), "{verdict}");
            assert_eq!(verdict["kind"].as_str().map(|one| format!("{one}s")).as_deref(), Some(kind));
        }
    }
}

#[test]
fn shipped_files_are_good() {
    let place = Place::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for folder in ["robots", "scenarios"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "toml") {
                place.run(&["check", path.to_str().unwrap()]).done();
            }
        }
    }
}

/// A reference that exceeds a limit is an answer, a limit that no speed keeps a bad input; both with numbers.
#[test]
fn what_a_reference_uses_of_the_limits_is_told() {
    let place = Place::new();
    let used = place.run(&["check", "planar-2r-tanh", "--json"]).done().json();
    assert_eq!(used[0]["reference"]["usage"].as_array().unwrap().len(), 2, "{used}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/two-link-tanh-smooth.toml");
    let text = std::fs::read_to_string(root).unwrap().replace("quanser-2dof", "two-link-plausible");
    place.write("fast.toml", &text);
    let fast = place.run(&["check", "fast.toml"]);
    assert_eq!(fast.code, Some(1), "{fast:?}");
    fast.said(&["joint2: motor torque of 2.746", "fast.toml"]);
    assert!(fast.stdout.contains("torque_limit") && fast.stdout.contains("1.64"), "{}", fast.stdout);
    let scaled =
        |key: &str| text.replace("[controller]", &format!("[reference.time_scaling]\n{key}\n[controller]"));
    place.write("slow.toml", scaled("margin = 0.8"));
    // The paper's gains are nothing for that arm, but the reference keeps its limits now.
    let slow = place.run(&["check", "slow.toml"]);
    assert!(slow.stdout.contains("at 0.346") && !slow.stderr.contains("exceeds a limit"), "{slow:?}");
    place.write("never.toml", scaled("margin = 0.8").replace("q_m = [0.0, 0.0]", "q_m = [0.0, 1.0]"));
    for command in ["check", "run"] {
        place.run(&[command, "never.toml"]).refused(&["no speed keeps the reference within 0.8", "would do"]);
    }
}

#[test]
fn one_bad_file_among_good_ones_is_told_apart() {
    let place = Place::new();
    place.write("good.toml", ROBOT).scenario("bad.toml", &[("[55.0, 30.0]", "[55.0, -30.0]")]);
    let files = ["check", "good.toml", "bad.toml", "two-link-tanh", "none.toml"];
    let outcome = place.run(&files);
    assert_eq!(outcome.code, Some(2));
    outcome.said(&["bad.toml:23:17", "2 of 4 files", "cannot read none.toml"]);
    let verdicts = outcome.stdout.lines().filter(|line| line.ends_with("warnings")).count();
    assert_eq!(verdicts, 2, "a line for each good one: {}", outcome.stdout);

    let outcome = place.run(&[&files[..], &["--json"]].concat());
    assert_eq!(outcome.code, Some(2));
    let document = outcome.json();
    let verdicts = document.as_array().unwrap();
    let ok: Vec<_> = verdicts.iter().map(|verdict| verdict["ok"].as_bool().unwrap()).collect();
    assert_eq!(ok, [true, false, true, false]);
    let error = &verdicts[1]["errors"][0];
    assert_eq!(
        (&error["line"], &error["column"], &error["file"]),
        (&23.into(), &17.into(), &"bad.toml".into())
    );
    assert!(error["message"].as_str().unwrap().contains("-30"), "{error}");
    assert!(error["hint"].as_str().is_some_and(|hint| !hint.is_empty()));
}

#[test]
fn assumptions_and_warnings_count_once() {
    let place = Place::new();
    place.write("arm.toml", ROBOT.replacen("[9.0, 4.0]", "[9.0, 4e-4]", 1));
    place.scenario("s.toml", &[("\"quanser-2dof\"", "\"arm.toml\"")]);
    let outcome = place.run(&["check", "s.toml"]).done();
    assert_eq!(outcome.stderr.matches("warning[").count(), 1, "{}", outcome.stderr);
    let verdict = &place.run(&["check", "s.toml", "--json"]).done().json()[0];
    assert_eq!(verdict["warnings"].as_array().map(Vec::len), Some(1));
    let assumed = |file: &str| place.read(file).matches("= \"assumed").count();
    assert_eq!(verdict["assumptions"], Value::from(assumed("arm.toml") + assumed("s.toml")));
}

#[test]
fn joints_are_drawn_over_frequency() {
    let place = Place::new();
    let text = place.run(&["check", "panda", "--figure", "there"]).done().stdout;
    assert!(text.ends_with("wrote there/panda.response.svg\nwrote there/panda.response.png\n"), "{text}");
    let svg = place.read("there/panda.response.svg");
    assert!(svg.contains("panda_joint7") && svg.contains("antiresonance") && !svg.contains("NaN"));
    // Of a scenario its robot; of a bad file nothing.
    let json = place.run(&["check", "pendulum-tanh", "--figure", "there", "--json"]).done().json();
    assert_eq!(json[0]["files"][0], "there/pendulum-1dof.response.svg");
    let one_bad = place.run(&["check", "none.toml", "panda", "--figure", "elsewhere"]);
    assert_eq!(one_bad.code, Some(2));
    one_bad.said(&["none.toml"]);
    assert!(!place.path().join("elsewhere").exists());
    // Robots of one name have a figure each, wherever their names would lead.
    for file in ["a.toml", "b.toml"] {
        place.write(file, ROBOT.replace("name = \"quanser-2dof\"", "name = \"../x\""));
    }
    place.run(&["check", "a.toml", "b.toml", "--figure", "two"]).done();
    assert_eq!(place.names("two").len(), 4, "{:?}", place.names("two"));
    std::fs::create_dir_all(place.path().join("taken/panda.response.png")).unwrap();
    place
        .run(&["check", "panda", "--figure", "taken"])
        .refused(&["panda.response.png is not a regular file"]);
    assert_eq!(place.names("taken"), ["panda.response.png"]);
}
