//! Certificates with cuts, flipped bits and stray values: verified or refused, never a panic.

use flexure::verify::Rejected;
use flexure::verify::verify;
use serde_json::{Value, json};

use super::mutants::paths;
use super::{CERTIFICATES, certificates};
use crate::common::Random;

fn malformed(text: &str) {
    let verdict = verify(text);
    let start: String = text.chars().take(60).collect();
    assert!(matches!(verdict, Err(Rejected::Malformed { .. })), "{start}: {verdict:?}");
}

#[test]
fn bytes_that_are_cut_and_flipped_never_panic() {
    let mut noise = Random(11);
    let (mut verified, mut refused) = (0, 0);
    for (_, text) in CERTIFICATES {
        for _ in 0..400 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=noise.below(3) {
                let at = noise.below(bytes.len());
                match noise.below(6) {
                    0 => bytes.truncate(at),
                    1 => drop(bytes.drain(at..(at + 40).min(bytes.len()))),
                    _ if bytes.is_empty() => {}
                    _ => bytes[at] ^= 1 << noise.below(7),
                }
            }
            match verify(&String::from_utf8_lossy(&bytes)) {
                Ok(_) => verified += 1,
                Err(rejected) => {
                    refused += 1;
                    assert!(!rejected.to_string().is_empty());
                }
            }
        }
    }
    assert!(refused > 1000, "{verified} verified, {refused} refused");
}

#[test]
fn values_from_elsewhere_never_panic() {
    let strays = [
        json!("1e308"),
        json!("-1e308"),
        json!("1e-400"),
        json!("5e-324"),
        json!("0"),
        json!("nan"),
        json!("inf"),
        json!("1e400"),
        json!(["-1e308", "1e308"]),
        json!(["0", "1"]),
        json!([]),
        json!({}),
        json!(null),
        json!(0),
        json!(1_000_000_000),
        json!(u64::MAX),
        json!(-1),
        json!(1.5),
        json!(true),
        json!(""),
    ];
    for (_, certificate) in certificates() {
        let paths = paths(&certificate);
        for path in &paths {
            for stray in &strays {
                let mut content = certificate.clone();
                *content.pointer_mut(path).unwrap() = stray.clone();
                let _ = verify(&content.to_string());
            }
        }
        let mut noise = Random(5);
        for _ in 0..300 {
            let mut content = certificate.clone();
            let from = certificate.pointer(&paths[noise.below(paths.len())]).unwrap().clone();
            *content.pointer_mut(&paths[noise.below(paths.len())]).unwrap() = from;
            let _ = verify(&content.to_string());
        }
    }
}

#[test]
fn what_is_no_certificate_is_malformed() {
    for text in
        ["", "{", "null", "[]", "1", "\"flexure-certificate\"", "{}", "\u{feff}{}", "{\"format\": \"x\"}"]
    {
        malformed(text);
    }
    malformed(&"[".repeat(1_000_000));
    malformed(&format!("{}{}", "{\"a\":".repeat(10_000), "}".repeat(10_000)));
    malformed(&format!("{}{}", CERTIFICATES[0].1, " ".repeat(5 << 20)));
    let text = CERTIFICATES[0].1;
    for (from, to) in [
        ("\"version\": 1", "\"version\": 2"),
        ("\"version\": 1", "\"version\": 3"),
        ("\"version\": 1", "\"version\": 1.0"),
        ("\"version\": 1", "\"version\": true"),
        ("\"version\": 1", "\"version\": NaN"),
        ("\"version\": 1", "\"version\": 1, \"version\": 1"),
        ("\"joints\": 1", "\"joints\": 0"),
        ("\"joints\": 1", "\"joints\": 1000000000"),
        ("\"joints\": 1", "\"joints\": 99999999999999999999999"),
        ("\"joints\": 1", "\"joints\": 2"),
        ("\"1.61\"", "1.61"),
        ("\"1.61\"", "\"nan\""),
        ("\"1.61\"", "\"1e400\""),
        ("\"1.61\"", "[\"2\", \"1\"]"),
        ("\"1.61\"", "[\"1\"]"),
    ] {
        assert!(text.contains(from), "{from}");
        malformed(&text.replacen(from, to, 1));
    }
    let (tree, arm) = (CERTIFICATES[1].1, CERTIFICATES[4].1);
    for (text, from, to) in [(tree, "\"parent\": 1", "\"parent\": 2"), (arm, "\"row\": 0", "\"row\": 2")] {
        assert!(text.contains(from), "{from}");
        malformed(&text.replacen(from, to, 1));
    }
    let position = verify("{\n  \"format\": ,\n}").unwrap_err();
    assert!(matches!(position, Rejected::Malformed { line: Some(2), column: Some(13), .. }), "{position:?}");
}

/// 2¹⁶ cases are the most that are enumerated.
#[test]
fn many_joints_of_the_coupled_law_are_refused_at_once() {
    let mut content: Value = serde_json::from_str(CERTIFICATES[2].1).unwrap();
    content["robot"]["joints"] = json!(64);
    content["robot"]["links"] = json!({"kind": "tree", "bodies": []});
    malformed(&content.to_string());
}
