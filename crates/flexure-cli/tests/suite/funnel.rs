//! The file of a funnel: `flexure certify` with disturbances writes it, and `flexure verify` follows it.

use crate::command::Place;

const LOOP: [&str; 5] =
    ["two-link-hardware", "--set", "duration=0.4", "--set", "reference.smooth_start.duration=2"];

/// It is beside the certificate, and is followed again for the loop that it is about alone.
#[test]
fn funnels_are_verified() {
    let folder = Place::new();
    let asked = ["--link-disturbance", "0.02", "--disturbance", "0.01"];
    let certify = |options: &[&str]| folder.run(&[&["certify"], &LOOP[..], options].concat());
    let wrote = certify(&asked).done().stdout;
    let file = "out/two-link-hardware.funnel.json";
    assert!(wrote.contains(&format!("wrote {file}")), "{wrote}");
    let told = certify(&[&asked[..], &["--json"]].concat()).done().json();
    assert_eq!(told["funnel_file"], file);
    let verify = |options: &[&str]| folder.run(&[&["verify", file], options].concat());
    let against = [&["--against"], &LOOP[..]].concat();
    let said = verify(&against).done().stdout;
    for line in [
        "asked about: torques up to 0.02 N m on links and 0.01 N m on motors",
        "errors beyond, up to 1.2 times as large, come back",
        "verified: it is about two-link-hardware, in the ideal loop",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
    let said = verify(&[&against[..], &["--json"]].concat()).done().json();
    assert_eq!((&said["verdict"], &said["slabs"]), (&"verified".into(), &told["funnel"]["slabs"]));
    assert_eq!(said["error"], told["funnel"]["error"]);
    let cases: [(&[&str], i32, &str); 4] = [
        (&[], 2, "is a funnel: it is checked by following a loop"),
        (&["--against", "two-link-hardware"], 1, "reference.join.duration is"),
        (&["--against", "two-link-tanh-smooth"], 1, "robot."),
        (&["--against", "no-such-scenario"], 2, "no built-in scenario"),
    ];
    for (options, code, complaint) in cases {
        let outcome = verify(options);
        assert_eq!(outcome.code, Some(code), "{options:?}: {outcome:?}");
        assert!(outcome.stderr.contains(complaint) && outcome.stdout.is_empty(), "{options:?}: {outcome:?}");
    }
    let text = folder.read(file);
    folder.write(file, text.replacen("\"0.02\"", "\"0.03\"", 1));
    let outcome = verify(&against);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stderr.contains("slabs[0] does not hold"), "{outcome:?}");
    folder.write(file, &text[..text.len() / 2]);
    let outcome = verify(&against);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("is not a funnel: "), "{outcome:?}");
    // What is no funnel stays, and so does an old one where none is found, and it is said whose it is.
    folder.write(file, "mine");
    let outcome = certify(&asked);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("exists and is no funnel") && folder.read(file) == "mine", "{outcome:?}");
    certify(&[]).done();
    folder.write(file, &text);
    let outcome = certify(&["--link-disturbance", "5"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stdout.contains(&format!("{file} is of an earlier proof")), "{outcome:?}");
}
