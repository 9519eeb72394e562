//! `flexure verify`.

use crate::command::{Outcome, Place, SCENARIO, altered};

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
        "assumed: robot.stiffness: assumed",
    ] {
        assert!(stdout.lines().any(|found| found.starts_with(line)), "no '{line}' in\n{stdout}");
    }
    assert!(
        stdout.lines().last().unwrap().starts_with("verified: two-link-tanh: contraction 0.29598"),
        "{stdout}"
    );
    let json = verify(CERTIFICATE, &["--json"]).done().json();
    assert_eq!(json["verdict"], "verified");
    assert_eq!(json["claims"].as_array().unwrap().len(), stdout.lines().count() - 2);
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
        (b"\0\x01\xff\xfe", &["cannot read arm.json", "utf-8"]),
        (b"\0\x01\x02", &["arm.json:1:1 is not a certificate"]),
        (SCENARIO.as_bytes(), &["arm.json:1:1 is not a certificate"]),
        (cut.as_bytes(), &["arm.json:", "is not a certificate", "EOF"]),
        (b"{}", &["arm.json is not a certificate", "flexure-certificate"]),
        (b"[]", &["must be an object"]),
        (deep.as_bytes(), &["recursion limit"]),
        (large.as_bytes(), &["larger than 4 MiB"]),
        (number.as_bytes(), &["invalid type: floating point `0.23`", "arm.json:1"]),
        (infinite.as_bytes(), &["robot.motor_inertia[0]", "'1e999' is no finite decimal"]),
        (twice.as_bytes(), &["arm.json:4:", "key 'version' is there twice"]),
        (escape.as_bytes(), &["unknown key '[31mmetric'"]),
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
