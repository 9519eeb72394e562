//! Every sign of every number and word flipped, one at a time.

use std::collections::BTreeSet;

use serde_json::Value;

use super::CERTIFICATES;
use super::mutants::{Mutant, each};

pub fn mutants() -> Vec<Mutant> {
    each("sign", |_, value| match value {
        Value::String(text) if text.parse::<f64>().is_ok_and(|number| number != 0.0) => {
            vec![Value::from(text.strip_prefix('-').map_or_else(|| format!("-{text}"), str::to_owned))]
        }
        Value::String(text) => words(text).into_iter().map(Value::from).collect(),
        Value::Number(number) if number.as_u64() != Some(0) => vec![Value::from(-number.as_i64().unwrap())],
        _ => Vec::new(),
    })
}

/// A sum of words with the sign of each term flipped; nothing of other texts.
fn words(text: &str) -> Vec<String> {
    let letters = ["Pl", "Pm", "Pm^-1", "K", "Fl", "Fm", "S", "R", "Bl", "Bm", "1/2", "-", "+"];
    let tokens: Vec<_> = text.split_whitespace().collect();
    if !tokens.iter().all(|token| letters.contains(&token.trim_start_matches('-'))) || tokens.is_empty() {
        return Vec::new();
    }
    let first = text.strip_prefix('-').map_or_else(|| format!("-{text}"), str::to_owned);
    let others = text
        .match_indices(" - ")
        .map(|(at, _)| (at, " + "))
        .chain(text.match_indices(" + ").map(|(at, _)| (at, " - ")));
    let others = others.map(|(at, sign)| format!("{}{sign}{}", &text[..at], &text[at + 3..]));
    [first].into_iter().chain(others).collect()
}

/// Flips that leave the theorem true, by reason.
const TRUE_ANYWAY: &[(&str, &[&str])] = &[
    (
        "a bound of a measure that is positive instead of negative claims less",
        &["*/measures/0/bound", "*/measures/1/bound", "*/measures/2/bound"],
    ),
    ("the same on the motors' side", &["*/measures/3/bound", "*/measures/4/bound", "*/measures/5/bound"]),
    ("the first link's centre of mass enters squared", &["pendulum/robot/links/com"]),
    (
        "the same in the arm; (the second's also with the cosine, which swaps the cases' margins)",
        &[
            "two-link-coupled-tanh/robot/links/com/0",
            "two-link-linear/robot/links/com/0",
            "two-link-tanh/robot/links/com/0",
            "two-link-uneven/robot/links/com/0",
        ],
    ),
    (
        "slopes are even in the error",
        &[
            "pendulum/structure/1/witness/error/0",
            "tree/structure/1/witness/error/0",
            "tree/structure/1/witness/error/1",
            "tree/structure/1/witness/error/2",
            "tree-chain/structure/1/witness/error/0",
            "tree-chain/structure/1/witness/error/1",
            "tree-chain/structure/1/witness/error/2",
            "two-link-coupled-tanh/structure/0/witness/error/0",
            "two-link-coupled-tanh/structure/0/witness/error/1",
            "two-link-coupled-tanh/structure/1/witness/error/0",
            "two-link-coupled-tanh/structure/1/witness/error/1",
            "two-link-tanh/structure/1/witness/error/0",
            "two-link-tanh/structure/1/witness/error/1",
            "two-link-uneven/structure/0/witness/error/0",
            "two-link-uneven/structure/0/witness/error/1",
            "two-link-uneven/structure/1/witness/error/0",
            "two-link-uneven/structure/1/witness/error/1",
        ],
    ),
    (
        "an axis that points the other way turns the other way; that of body 1 as a mirror image reaches less far",
        &[
            "tree/robot/links/bodies/0/axis/2",
            "tree/robot/links/bodies/1/axis/1",
            "tree/robot/links/bodies/1/axis/2",
            "tree/robot/links/bodies/2/axis/0",
            "tree-chain/robot/links/bodies/0/axis/2",
            "tree-chain/robot/links/bodies/2/axis/0",
        ],
    ),
    (
        "what body 0 carries turns freely about its axis, and the height of the base is not felt",
        &[
            "tree/robot/links/bodies/0/com/0",
            "tree/robot/links/bodies/0/com/1",
            "tree/robot/links/bodies/0/com/2",
            "tree/robot/links/bodies/0/inertia/1",
            "tree/robot/links/bodies/0/inertia/2",
            "tree/robot/links/bodies/0/inertia/4",
            "tree/robot/links/bodies/0/translation/2",
            "tree-chain/robot/links/bodies/0/com/0",
            "tree-chain/robot/links/bodies/0/com/1",
            "tree-chain/robot/links/bodies/0/com/2",
            "tree-chain/robot/links/bodies/0/inertia/1",
            "tree-chain/robot/links/bodies/0/inertia/2",
            "tree-chain/robot/links/bodies/0/inertia/4",
            "tree-chain/robot/links/bodies/0/translation/2",
        ],
    ),
    (
        "an arm whose bodies lie on the other side, no farther from the axes: its bound is not larger",
        &[
            "tree/robot/links/bodies/1/com/0",
            "tree/robot/links/bodies/1/com/1",
            "tree/robot/links/bodies/1/inertia/1",
            "tree/robot/links/bodies/1/inertia/2",
            "tree/robot/links/bodies/1/translation/0",
            "tree/robot/links/bodies/1/translation/1",
            "tree/robot/links/bodies/1/translation/2",
            "tree/robot/links/bodies/2/com/0",
            "tree/robot/links/bodies/2/com/1",
            "tree/robot/links/bodies/2/com/2",
            "tree/robot/links/bodies/2/inertia/2",
            "tree/robot/links/bodies/2/translation/0",
            "tree-chain/robot/links/bodies/1/com/0",
            "tree-chain/robot/links/bodies/1/com/1",
            "tree-chain/robot/links/bodies/1/inertia/1",
            "tree-chain/robot/links/bodies/1/inertia/2",
            "tree-chain/robot/links/bodies/1/translation/2",
            "tree-chain/robot/links/bodies/2/com/0",
        ],
    ),
    (
        "a shorter travel, from 0.1 m instead of -0.1 m",
        &["tree/robot/links/bodies/2/travel/0", "tree-chain/robot/links/bodies/2/travel/0"],
    ),
];

#[test]
fn every_sign_matters_but_those_that_are_listed() {
    let verified = mutants().into_iter().filter(|mutant| mutant.code() == 0).map(|mutant| mutant.name);
    let names = CERTIFICATES.map(|(name, _)| name);
    let listed = TRUE_ANYWAY.iter().flat_map(|(_, paths)| *paths).flat_map(|path| {
        let certificates: &[&str] = if path.starts_with('*') { &names } else { &[""] };
        certificates.iter().map(|name| format!("{}: sign", path.replacen('*', name, 1)))
    });
    assert_eq!(verified.collect::<BTreeSet<_>>(), listed.collect::<BTreeSet<_>>());
}
