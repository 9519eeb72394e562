//! `flexure certify --sampled-tube` and `flexure verify` of its file.

use crate::command::Place;

/// The loop of the file, its torque held and late, has a tube in which motions come closer; a loop that is too late has none, and it is said.
#[test]
fn sampled_loops_have_tubes() {
    let folder = Place::new();
    let late = |name: &str, delay: &str| {
        let text = format!("[[imperfection]]\nkind = \"delay\"\ncomputation = {delay}\n\n[sources]");
        let start = "[reference.smooth_start]\nduration = 2.0\n\n[controller]";
        folder.scenario(name, &[("[sources]", &text), ("[controller]", start)]);
    };
    late("late.toml", "5e-4");
    late("later.toml", "7e-4");
    let asked = |file: &str, options: &[&str]| {
        folder
            .run(&[&["certify", file, "--sampled-tube", "1e-5", "--set", "duration=0.05"], options].concat())
    };
    let found = asked("late.toml", &["--json"]).done().json()["sampled_tube"].clone();
    assert_eq!(
        (&found["verdict"], &found["periods"], &found["delay"]),
        (&"proved".into(), &50.into(), &5e-4.into())
    );
    assert!(found["rate"].as_f64().unwrap() > 5.0, "{found}");
    let said = asked("late.toml", &[]).done().stdout;
    assert!(said.contains("the loop with its torque held for 0.001 s and 0.0005 s late"), "{said}");
    assert!(said.contains("1/s or faster in every period"), "{said}");
    let outcome = asked("later.toml", &[]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stdout.contains("sampled      no tube was found"), "{outcome:?}");
}

/// The file of a tube is beside the certificate, and is followed again for the loop that it is about alone.
#[test]
fn tubes_are_verified() {
    let folder = Place::new();
    let loop_of = ["two-link-tanh-smooth", "--set", "duration=0.02"];
    let wrote = folder.run(&[&["certify"], &loop_of[..], &["--sampled-tube", "1e-5"]].concat()).done().stdout;
    let file = "out/two-link-tanh-smooth.tube.json";
    assert!(wrote.contains(&format!("wrote {file}")), "{wrote}");
    let verify = |options: &[&str]| folder.run(&[&["verify", file], options].concat());
    let against = [&["--against"], &loop_of[..]].concat();
    let said = verify(&against).done().stdout;
    assert!(
        said.contains("20 control periods, one by one") && said.contains("verified: it is about two-link"),
        "{said}"
    );
    let said = verify(&[&against[..], &["--json"]].concat()).done().json();
    assert_eq!((&said["verdict"], &said["periods"]), (&"verified".into(), &20.into()));
    let cases: [(&[&str], i32, &str); 4] = [
        (&[], 2, "give the scenario that it is about with --against"),
        (&["--against", "two-link-tanh-smooth"], 1, "periods is 20 in the file and 10000 in the scenario"),
        (&["--against", "two-link-linear-smooth"], 1, "controller.phi"),
        (&["--against", "no-such-scenario"], 2, "no built-in scenario"),
    ];
    for (options, code, complaint) in cases {
        let outcome = verify(options);
        assert_eq!(outcome.code, Some(code), "{options:?}: {outcome:?}");
        assert!(outcome.stderr.contains(complaint) && outcome.stdout.is_empty(), "{options:?}: {outcome:?}");
    }
    let text = folder.read(file);
    // The claim, not what was asked for.
    let at = text.rfind("\"rate\": \"19").unwrap();
    folder.write(file, text[..at].to_owned() + &text[at..].replacen("19", "21", 1));
    let outcome = verify(&against);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stderr.contains("rate does not hold"), "{outcome:?}");
    folder.write(file, &text[..text.len() / 2]);
    let outcome = verify(&against);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("is not a tube: "), "{outcome:?}");
    // What is no tube stays.
    folder.write(file, "mine");
    let outcome = folder.run(&[&["certify"], &loop_of[..], &["--sampled-tube", "1e-5"]].concat());
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("exists and is no tube") && folder.read(file) == "mine", "{outcome:?}");
}

/// The ladder is climbed without being told how far, and a run beside the file that comes of it says where it is.
#[test]
fn the_strongest_statement_is_looked_for() {
    let folder = Place::new();
    let loop_of = ["two-link-tanh-smooth", "--set", "duration=0.02"];
    let certify = |options: &[&str]| folder.run(&[&["certify"], &loop_of[..], options].concat());
    let below = certify(&["--no-tube"]).done().stdout;
    assert!(below.contains("highest step proved: ideal") && below.contains("--strongest looks"), "{below}");
    // What names something is answered, and nothing else is looked for; what would take long neither.
    for (options, duration) in [(&["--error-box", "0.5"][..], "0.02"), (&[], "1000")] {
        let duration = format!("duration={duration}");
        let named = certify(&[options, &["--set", &duration]].concat()).done().stdout;
        assert!(named.contains("ideal") && named.contains("--strongest looks"), "{named}");
    }
    assert!(!folder.path().join("out/two-link-tanh-smooth.tube.json").exists());
    let found = certify(&["--json"]).done().json();
    assert_eq!((&found["step"], &found["sampled_tube"]["verdict"]), (&"sampled".into(), &"proved".into()));
    let said = certify(&["--strongest", "--error-box", "0.5"]).done().stdout;
    assert!(said.contains("highest step proved: sampled") && said.contains("region = ["), "{said}");
    for [one, other] in [
        ["--strongest", "--sampled-tube=1e-5"],
        ["--no-tube", "--sampled-tube=1e-5"],
        ["--no-tube", "--strongest"],
    ] {
        assert_eq!(certify(&[one, other]).code, Some(2), "{one} {other}");
    }
    // Where there is none, the ideal loop's proof stands, and it is said why.
    let none = folder.run(&["certify", "two-link-everything"]).done().stdout;
    assert!(
        none.contains("highest step proved: ideal") && none.contains("no tube was found: this loop"),
        "{none}"
    );

    let file = "out/two-link-tanh-smooth.tube.json";
    let run = |options: &[&str]| folder.run(&[&["run"], &loop_of[..], &["--tube", file], options].concat());
    let said = run(&[]).done().stdout;
    assert!(said.contains("the tube holds the run at every control instant"), "{said}");
    let header = folder.read("out/two-link-tanh-smooth.csv");
    assert!(header.lines().next().unwrap().ends_with(",rate,certificate,tube"), "{header}");
    let found = run(&["--json", "--columns", "tube"]).done().json()["tube"].clone();
    assert_eq!((&found["certified_fraction"], &found["left"]), (&1.0.into(), &serde_json::Value::Null));
    let other = run(&["--set", "controller.link.damping=[1.0, 1.0]"]);
    assert_eq!(other.code, Some(1), "{other:?}");
    assert!(other.stderr.contains("the tube says nothing of this run: controller.link.damping"), "{other:?}");
    let longer = run(&["--set", "duration=0.03"]);
    assert_eq!(longer.code, Some(1), "{longer:?}");
    assert!(longer.stderr.contains("ends before t = 0.021 s"), "{longer:?}");
    for (text, complaint) in [("", "is not a tube"), ("{}", "is not a tube"), ("[1, 2]", "is not a tube")] {
        folder.write(file, text);
        let outcome = run(&[]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(complaint), "{outcome:?}");
    }
    let outcome = folder.run(&["run", "pendulum-tanh", "--tube", "nowhere.json"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
}
