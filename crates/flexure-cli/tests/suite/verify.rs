//! `flexure verify`.

use std::process::{Command, Stdio};

use crate::command::{Outcome, Place, ROBOT, SCENARIO, altered};

const CERTIFICATE: &str = include_str!("../../../flexure/tests/certificates/two-link-tanh.json");

fn verify(text: impl AsRef<[u8]>, more: &[&str]) -> Outcome {
    let place = Place::new();
    place.write("arm.json", text).run(&[&["verify", "arm.json"], more].concat())
}

#[test]
fn a_line_a_claim_and_the_rates() {
    let Outcome { stdout, stderr, .. } = verify(CERTIFICATE, &[]).done();
    assert_eq!(stderr, "");
    for line in [
        "closed_loop: the coupling cancels",
        "blocks.phi_l: contraction 0.2959811149631761400831888 1/s",
        "structure.ph-like: does not hold",
        "tube: W <= ",
        "  assumed: \"robot.stiffness: assumed\"",
        "  name: \"two-link-tanh\"",
        "  robot.links.mass: 1.510, 0.873 kg",
        "  controller.motor.damping: ",
    ] {
        assert!(stdout.lines().any(|found| found.starts_with(line)), "no '{line}' in\n{stdout}");
    }
    assert!(
        stdout.lines().last().unwrap().starts_with("verified: \"two-link-tanh\": contraction 0.29598"),
        "{stdout}"
    );
    let json = verify(CERTIFICATE, &["--json"]).done().json();
    assert_eq!(json["verdict"], "verified");
    let count = |key: &str| json[key].as_array().unwrap().len();
    // Two headings and the verdict.
    assert_eq!(count("claims") + count("about") + count("assumptions"), stdout.lines().count() - 3);
    assert_eq!(json["reason"], serde_json::Value::Null);
}

#[test]
fn a_claim_that_does_not_hold_is_named_with_what_was_found() {
    let more = altered(CERTIFICATE, &[("\"0.2959811149631761400831888\"", "\"0.2959815\"")]);
    let outcome = verify(&more, &[]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(1), ""));
    outcome.said(&["arm.json: blocks.phi_l.cases['LL'].contraction does not hold", "claimed", "found -"]);
    let outcome = verify(&more, &["--json"]);
    assert_eq!(outcome.code, Some(1));
    assert_eq!(outcome.json()["verdict"], "rejected");
    assert_eq!(outcome.json()["claim"], "blocks.phi_l.cases['LL'].contraction");
    assert!(outcome.json()["reason"].as_str().unwrap().contains("found -"));
}

#[test]
fn nasty_files_are_refused_with_their_name() {
    let cut = &CERTIFICATE[..CERTIFICATE.len() / 2];
    let deep = "[".repeat(100_000);
    let large = format!("{CERTIFICATE}{}", " ".repeat(4 << 20));
    let number = altered(CERTIFICATE, &[("\"0.23\"", "0.23")]);
    let infinite = altered(CERTIFICATE, &[("\"0.23\"", "\"1e999\"")]);
    let twice = altered(CERTIFICATE, &[("\"version\": 1,", "\"version\": 1,\n\"version\": 1,")]);
    let escape = altered(CERTIFICATE, &[("\"metric\"", "\"\\u001b[31mmetric\"")]);
    let cases: &[(&[u8], &[&str])] = &[
        (b"", &["arm.json:1:0 is not a certificate", "EOF"]),
        (b"\0\x01\xff\xfe", &["arm.json is not UTF-8"]),
        (b"\0\x01\x02", &["arm.json:1:1 is not a certificate"]),
        (SCENARIO.as_bytes(), &["arm.json:1:1 is not a certificate"]),
        (cut.as_bytes(), &["arm.json:", "is not a certificate", "EOF"]),
        (b"{}", &["arm.json is not a certificate", "flexure-certificate"]),
        (b"[]", &["must be an object"]),
        (deep.as_bytes(), &["recursion limit"]),
        (large.as_bytes(), &["larger than 4 MiB"]),
        (number.as_bytes(), &["invalid type: floating point `0.23`", "arm.json:1"]),
        (infinite.as_bytes(), &["robot.motor_inertia[0]", "'1e999' is no decimal as certificates have them"]),
        (twice.as_bytes(), &["arm.json:4:", "key 'version' is there twice"]),
        (escape.as_bytes(), &["unknown key '\\u{1b}[31mmetric'"]),
    ];
    for (text, said) in cases {
        verify(text, &[]).refused(said);
        verify(text, &["--json"]).error_taken().refused(said);
    }
    let place = Place::new();
    std::fs::create_dir(place.path().join("folder")).unwrap();
    place.run(&["verify", "folder"]).refused(&["cannot read folder"]);
    place.run(&["verify", "nowhere.json"]).refused(&["cannot read nowhere.json"]);
}

/// Robot and scenario in a folder, and a certificate of them.
fn certified() -> Place {
    let place = Place::new();
    place.scenario("arm.toml", &[("\"quanser-2dof\"", "\"robot.toml\"")]).write("robot.toml", ROBOT);
    place.run(&["certify", "arm.toml", "--error-box", "3", "--out", "c.json"]).done();
    place
}

#[test]
fn a_certificate_is_about_its_scenario_and_no_other() {
    let place = certified();
    let against = |scenario: &str| place.run(&["verify", "c.json", "--against", scenario]);
    assert!(against("arm.toml").done().stdout.ends_with("it is about arm.toml\n"));
    // Another name in another folder, a comment, another spelling.
    let text = place.read("arm.toml").replace("robot.toml", "../robot.toml");
    place.write("other/name.toml", format!("# A comment.\n{text}").replace("0.001", "1e-3"));
    place.run(&["verify", "c.json", "--against", "other/name.toml", "--allow-outside"]).done();
    against("two-link-tanh").done();
    // Exit code 1, with the value where the certificate tells it.
    let gain = text.lines().find(|line| line.starts_with("damping")).unwrap();
    place.write("gain.toml", altered(&place.read("arm.toml"), &[(gain, "damping = [4.5, 0.5]")]));
    let other = against("gain.toml");
    assert_eq!(other.code, Some(1));
    other.said(&[
        "c.json is not about gain.toml",
        "controller.link.damping[0] is",
        "\"4.5\" in the scenario",
    ]);
    place.write(
        "late.toml",
        altered(&place.read("arm.toml"), &[("control_period = 0.001", "control_period = 0.002")]),
    );
    let other = against("late.toml");
    assert_eq!(other.code, Some(1));
    other.said(&["c.json is not about late.toml", "its scenario says something else"]);
    // The robot, behind the same name.
    place.write("robot.toml", altered(ROBOT, &[("mass = [1.51", "mass = [1.52")]));
    let other = place.run(&["verify", "c.json", "--against", "arm.toml", "--json"]);
    assert_eq!(other.code, Some(1));
    let json = other.json();
    assert_eq!((&json["verdict"], &json["against"]["same"]), (&"verified".into(), &false.into()));
    assert_eq!(json["against"]["differences"][0]["place"], "robot.links.mass[0]");
    assert_eq!(json["against"]["differences"][0]["certificate"], "\"1.51\"");
    // A scenario that cannot be read is bad input, and so is a law without certificates.
    against("nowhere.toml").refused(&["cannot read nowhere.toml"]);
    place.write("bad.toml", "robot = 1\n");
    against("bad.toml").refused(&["bad.toml:1"]);
}

#[test]
fn version_1_says_that_it_has_no_hash() {
    let place = Place::new();
    place.write("arm.json", CERTIFICATE);
    let outcome = place.run(&["verify", "arm.json", "--against", "two-link-tanh"]);
    assert_eq!(outcome.code, Some(1));
    outcome.said(&["arm.json"]);
    let json = place.run(&["verify", "arm.json", "--against", "two-link-tanh", "--json"]).json();
    let differences = json["against"]["differences"].as_array().unwrap();
    assert!(differences.iter().any(|found| found["place"] == "subject" && found["certificate"] == "null"));
}

/// What a file calls itself cannot look like what the program says: it stands in quotes, in one line.
#[test]
fn forged_names_are_words_of_the_file() {
    let forged = "x\\nverified: all is well\\u001b[2J\\u202e";
    let name = altered(CERTIFICATE, &[("\"name\": \"two-link-tanh\"", &format!("\"name\": \"{forged}\""))]);
    let stdout = verify(&name, &[]).done().stdout;
    assert!(!stdout.contains(['\u{1b}', '\u{202e}']), "{stdout}");
    let verified: Vec<_> = stdout.lines().filter(|line| line.starts_with("verified: ")).collect();
    assert_eq!(verified.len(), 1, "{stdout}");
    assert!(
        verified[0].starts_with("verified: \"x\\nverified: all is well\\u{1b}[2J\\u{202e}\": contraction"),
        "{stdout}"
    );
    // A name of three megabytes is not printed.
    let long = altered(
        CERTIFICATE,
        &[("\"name\": \"two-link-tanh\"", &format!("\"name\": \"{}\"", "y".repeat(3 << 20)))],
    );
    assert!(verify(&long, &[]).done().stdout.len() < 10_000);
    // A file whose own name commands the terminal.
    let place = Place::new();
    place.write("a\u{1b}[2Jb.json", "{}");
    place.run(&["verify", "a\u{1b}[2Jb.json"]).refused(&["a\\u{1b}[2Jb.json is not a certificate"]);
}

/// Pipes and streams are read as files are; what goes on forever is read no farther than a certificate may be long.
#[test]
#[cfg(unix)]
fn pipes_and_devices() {
    let place = Place::new();
    let pipe = place.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for (content, code) in [(CERTIFICATE, 0), ("{}", 2), ("", 2)] {
        let child =
            place.command(&["verify", "pipe"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::fs::write(&pipe, content).unwrap();
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(code), "{content}");
    }
    let stdin = place.fed(&["verify", "/dev/stdin"], CERTIFICATE);
    stdin.done();
    place.run(&["verify", "/dev/zero"]).refused(&["larger than 4 MiB"]);
    place.run(&["verify", "/dev/null"]).refused(&["/dev/null:1:0 is not a certificate", "EOF"]);
    // A folder instead of a scenario, a certificate instead of one.
    place.write("arm.json", CERTIFICATE);
    place.run(&["verify", "arm.json", "--against", "."]).refused(&["cannot read"]);
    place.run(&["verify", "arm.json", "--against", "arm.json"]).refused(&["arm.json:1"]);
}
