//! Both checkers say the same of whatever is made of a certificate: digits, exponents, signs, keys, nesting, encodings, and
//! claims at the very edge of what is accepted.
//!
//! `FLEXURE_MUTANTS=10000 cargo test --release -p flexure --test suite verify::agreement` takes as many as that; without it as many as
//! take some seconds.

use std::ops::Range;

use flexure::verify::{Rejected, verify};
use serde_json::Value;

use super::{CERTIFICATES, prover, python};
use crate::common::Random;

/// Mutants that are looked at where nothing else is said.
const FEW: usize = 400;

/// The exit code that the command has for these bytes.
fn code(bytes: &[u8]) -> i32 {
    let Ok(text) = std::str::from_utf8(bytes) else { return 2 };
    match verify(text) {
        Ok(_) => 0,
        Err(Rejected::False { .. }) => 1,
        Err(Rejected::Malformed { .. }) => 2,
    }
}

/// Texts between quotes: those that are numbers, and the others.
struct Quoted {
    numbers: Vec<Range<usize>>,
    others: Vec<Range<usize>>,
}

impl Quoted {
    fn of(text: &str) -> Self {
        let quotes: Vec<_> = text.match_indices('"').map(|(at, _)| at).collect();
        let inside = quotes.chunks_exact(2).map(|pair| pair[0] + 1..pair[1]);
        let (numbers, others) =
            inside.partition(|range| text[range.clone()].parse().is_ok_and(f64::is_finite));
        Self { numbers, others }
    }
}

/// Texts where a number stands: numbers at the edges of the grammar, and what is none.
#[rustfmt::skip]
const STRANGE: &[&str] = &[
    "0", "-0", "00", "01", "-01", "+1", ".5", "5.", "1_0", " 1", "1 ", "１", "٣", "0x1", "1e", "1e+", "1e-", "e5",
    "", "-", ".", "NaN", "nan", "inf", "Infinity", "-Infinity", "1e00", "1e000", "1e003", "1e0003", "1e00003",
    "0e999", "0e9999", "0e-9999", "1e99", "9.999999999999999e99", "1e100", "-1e100", "1e308",
    "1.7976931348623157e308", "1.7976931348623158e308", "1e400", "-1e400", "5e-324", "2e-324", "1e-330",
    "9.9e-331", "1e-400", "1E5", "1E+5", "1e5.0", "1e1e1", "1,5", "1/2", "--1", "+-1", "1e99999999999999999999",
    "\\u0031", "1\\n", "\\t1", "1\\u0000",
];

/// What stands instead of a whole value, quotes and all.
#[rustfmt::skip]
const VALUES: &[&str] = &[
    "null", "true", "false", "[]", "{}", "1", "0", "-0", "-1", "1.0", "1e0", "01", "NaN", "Infinity", "-Infinity",
    "1e400", "\"", "''", "[null]", "[[\"1\"]]", "[\"1\"]", "[\"1\", \"1\"]", "[\"1\", \"1.0\"]", "[\"1\", \"2\"]",
    "[\"2\", \"1\"]", "[\"0.10000000000000000001\", \"0.1\"]", "[\"1\", \"2\", \"3\"]", "[\"1\", null]", "[1, 2]",
    "{\"a\": \"1\"}", "{\"1\": \"1\", \"1\": \"1\"}", "99999999999999999999999999", "\"\\ud800\"",
    "\"\\ud83d\\ude00\"", "\"\\x\"", "\"a\tb\"", "\"\u{7f}\u{202e}\"", "/* */ null", "undefined", "\"1\" \"1\"",
    "\"1\",", ",\"1\"",
];

/// What is put between two characters.
const BETWEEN: &[&str] =
    &["\u{feff}", "\u{a0}", "\u{c}", "\r", "\t", "\0", "\u{2028}", "//\n", ",", "}", "]", "[", "\\", "\""];

/// A digit of `number` changed, added or removed; its exponent or sign changed; the same in another spelling; something else.
fn respelled(number: &str, noise: &mut Random) -> String {
    let digits: Vec<_> = number.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
    let digit = |noise: &mut Random| char::from(b'0' + u8::try_from(noise.below(10)).unwrap()).to_string();
    let (mut text, at) = (number.to_owned(), digits[noise.below(digits.len())]);
    match noise.below(12) {
        0 => text.replace_range(at..=at, &digit(noise)),
        1 => {
            let last = *digits.iter().rfind(|&&at| !number[..at].contains('e')).unwrap();
            text.replace_range(last..=last, &digit(noise));
        }
        2 => text.insert_str(at, &digit(noise)),
        3 => drop(text.drain(at..=at)),
        4 => text.push_str(
            ["e0", "e1", "e-1", "E+2", "e-3", "e5", "e-12", "e40", "e-90", "e200"][noise.below(10)],
        ),
        5 => text = text.strip_prefix('-').map_or_else(|| format!("-{text}"), str::to_owned),
        6 if !text.contains(['e', '.']) => {
            text.push_str([".0", ".000", "e0", ".0e00", "0e-1"][noise.below(5)]);
        }
        6 => {
            // More digits of the same.
            let end = text.find('e').unwrap_or(text.len());
            text.insert_str(end, &"0".repeat(1 + noise.below(90)));
        }
        7 => text = format!("{:e}", number.parse::<f64>().unwrap()),
        8 => text = format!("{:.*e}", noise.below(40), number.parse::<f64>().unwrap()),
        9 => {
            // A little more, a little less: as the last digits go.
            let by = [1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-9, 1e-6, 1e-3][noise.below(9)];
            let sign = [-1.0, 1.0][noise.below(2)];
            text = format!("{:e}", number.parse::<f64>().unwrap() * (1.0 + sign * by));
        }
        10 => {
            let by = [0.5, 0.9, 0.99, 1.01, 1.5, 1.9, 1.99, 2.0, 2.01, 3.0][noise.below(10)];
            text = format!("{}", number.parse::<f64>().unwrap() * by);
        }
        _ => STRANGE[noise.below(STRANGE.len())].clone_into(&mut text),
    }
    text
}

/// One change somewhere in `text`.
fn changed(text: &str, noise: &mut Random) -> String {
    let Quoted { numbers, others } = Quoted::of(text);
    let mut changed = text.to_owned();
    if numbers.is_empty() || others.is_empty() {
        return changed;
    }
    let number = numbers[noise.below(numbers.len())].clone();
    let other = others[noise.below(others.len())].clone();
    let whole = |range: &Range<usize>| range.start - 1..range.end + 1;
    match noise.below(20) {
        0..=10 => changed.replace_range(number.clone(), &respelled(&text[number], noise)),
        11 => changed.replace_range(number, &text[numbers[noise.below(numbers.len())].clone()]),
        12 => changed.replace_range(whole(&number), VALUES[noise.below(VALUES.len())]),
        13 => changed.replace_range(whole(&other), VALUES[noise.below(VALUES.len())]),
        14 => {
            // A pair for a number: of the same, of others, of a hair's breadth.
            let own = &text[number.clone()];
            let x: f64 = own.parse().unwrap();
            let pair = match noise.below(4) {
                0 => format!("[\"{own}\", \"{own}\"]"),
                1 => format!("[\"{:e}\", \"{:e}\"]", x.next_down(), x.next_up()),
                2 => format!("[\"{own}\", \"{}\"]", &text[numbers[noise.below(numbers.len())].clone()]),
                _ => format!("[\"{:e}\", \"{own}\"]", x.next_up()),
            };
            changed.replace_range(whole(&number), &pair);
        }
        15 => {
            // A key, or a word, with a letter escaped, changed or said twice.
            let own = &text[other.clone()];
            let first = own.chars().next().unwrap_or('x');
            let rest: String = own.chars().skip(1).collect();
            let new = match noise.below(4) {
                0 => format!("\\u{:04x}{rest}", u32::from(first)),
                1 => rest,
                2 => text[others[noise.below(others.len())].clone()].to_owned(),
                _ => format!("{own}\": null, \"{own}"),
            };
            changed.replace_range(other, &new);
        }
        16 => {
            let depth = [2, 60, 126, 127, 128, 129, 1000, 20_000][noise.below(8)];
            let deep = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
            changed.replace_range(whole(if noise.below(2) == 0 { &number } else { &other }), &deep);
        }
        17 => changed.insert_str(floor(text, noise.below(text.len())), BETWEEN[noise.below(BETWEEN.len())]),
        18 => {
            let (from, to) = (floor(text, noise.below(text.len())), floor(text, noise.below(text.len())));
            changed.replace_range(from..(from + noise.below(40)).min(text.len()).max(from), "");
            changed
                .insert_str(floor(&changed, to), &text[from..floor(text, from + noise.below(40)).max(from)]);
        }
        _ => {
            let ends = ["\u{feff}", "\n", "\r\n \t", "x", "{}", "null", ",", "\u{a0}", "\0"];
            let end = ends[noise.below(ends.len())];
            if noise.below(2) == 0 { changed.insert_str(0, end) } else { changed.push_str(end) }
        }
    }
    changed
}

/// The last boundary of a character at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rfind(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// Bytes of a text, some of them in an encoding or with bits that are none.
fn encoded(text: String, noise: &mut Random) -> Vec<u8> {
    if noise.below(40) > 0 {
        return text.into_bytes();
    }
    let at = floor(&text, noise.below(text.len().max(1)));
    let bad: [&[u8]; 6] = [b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\x80", b"\xe2\x82"];
    match noise.below(4) {
        0 => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        1 => text.replace('\n', "\r\n").into_bytes(),
        2 => {
            let mut bytes = text.into_bytes();
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << noise.below(8);
            }
            bytes
        }
        _ => [&text.as_bytes()[..at], bad[noise.below(bad.len())], &text.as_bytes()[at..]].concat(),
    }
}

/// Claims that are compared with what a checker finds.
fn is_claim(path: &str) -> bool {
    match *path.split('/').collect::<Vec<_>>().as_slice() {
        ["", "blocks", _, "cases", _, rate] => rate != "case",
        ["", "blocks", "0" | "1", "contraction" | "convergence"]
        | ["", "mass_matrix", "margins", _]
        | ["", "region" | "tube", "level"]
        | ["", "tube", "error", _]
        | ["", "stretched", "rate"]
        | ["", "measures", _, "bound"]
        | ["", "structure", _, "witness", "difference"] => true,
        _ => false,
    }
}

/// For every claim of a certificate, the two neighbouring doubles of which one is accepted and the other is not, found by
/// halving, and their neighbours.
fn edges(certificate: &Value) -> Vec<String> {
    let mut mutants = Vec::new();
    for path in super::mutants::paths(certificate).into_iter().filter(|path| is_claim(path)) {
        let own = certificate.pointer(&path).unwrap().as_str().and_then(|text| text.parse::<f64>().ok());
        let Some(own) = own.filter(|own| *own != 0.0) else { continue };
        let with = |x: f64| {
            let mut content = certificate.clone();
            *content.pointer_mut(&path).unwrap() = Value::from(format!("{x:e}"));
            content.to_string()
        };
        let holds = |x: f64| code(with(x).as_bytes()) == 0;
        for factor in [0.1, 10.0] {
            let (mut good, mut bad) = (own, own * factor);
            if holds(bad) {
                continue;
            }
            while good.min(bad).next_up() < good.max(bad) {
                let middle = 0.5 * (good + bad);
                *(if holds(middle) { &mut good } else { &mut bad }) = middle;
            }
            let (low, high) = (good.min(bad), good.max(bad));
            mutants.extend([low.next_down(), low, high, high.next_up()].map(with));
        }
    }
    mutants
}

/// Valid certificates: those of version 1 that this program did not make, and what the prover writes.
fn originals() -> Vec<String> {
    let written =
        prover::certificates().into_iter().filter(|(_, content)| content.to_string().len() < 20_000);
    let written = written.map(|(_, content)| serde_json::to_string_pretty(&content).unwrap());
    CERTIFICATES.iter().map(|(_, text)| (*text).to_owned()).chain(written).collect()
}

#[test]
fn the_checkers_agree_on_every_mutant() {
    let count = std::env::var("FLEXURE_MUTANTS").ok().and_then(|text| text.parse().ok()).unwrap_or(FEW);
    let mut noise = Random(2026);
    let originals = originals();
    // Those at the edge take many verdicts to find.
    let some = originals.iter().filter(|text| count > 5000 || text.contains("\"name\": \"pendulum"));
    let edges: Vec<String> = some
        .filter(|text| text.contains("\"version\": 3"))
        .flat_map(|text| edges(&serde_json::from_str(text).unwrap()))
        .collect();
    let keep = (count / 4).min(edges.len());
    let mut mutants: Vec<Vec<u8>> =
        (0..keep).map(|i| edges[i * edges.len() / keep].clone().into_bytes()).collect();
    let at_the_edge = mutants.len();
    while mutants.len() < count {
        let mut text = originals[noise.below(originals.len())].clone();
        for _ in 0..=[0, 0, 0, 1, 2][noise.below(5)] {
            text = changed(&text, &mut noise);
        }
        mutants.push(encoded(text, &mut noise));
    }
    let own: Vec<i32> = mutants.iter().map(|mutant| code(mutant)).collect();
    let Some(others) = python::codes(&mutants) else { return };
    let tally = [0, 1, 2].map(|code| own.iter().filter(|own| **own == code).count());
    println!("{count} mutants, {at_the_edge} of them at edges: {tally:?} with the codes 0, 1, 2");
    let different: Vec<_> = (0..count)
        .filter(|&i| own[i] != others[i])
        .map(|i| (i, own[i], others[i], difference(&originals, &mutants[i])))
        .collect();
    assert!(different.is_empty(), "{} of {count} differ: {different:#?}", different.len());
    // Each verdict is met often, or little is shown.
    assert!(tally.iter().all(|&met| met > count / 20), "{tally:?}");
}

/// What a mutant has that the most similar original has not.
fn difference(originals: &[String], mutant: &[u8]) -> String {
    let text = String::from_utf8_lossy(mutant);
    let common = |a: &str| a.bytes().zip(text.bytes()).take_while(|(a, b)| a == b).count();
    let (shared, original) = originals.iter().map(|a| (common(a), a)).max().unwrap();
    let from = floor(&text, shared.saturating_sub(60));
    let to = floor(&text, shared + 60);
    let theirs = &original[floor(original, shared.saturating_sub(10))..floor(original, shared + 50)];
    format!("{:?} for {theirs:?}", &text[from..to.max(from)])
}
