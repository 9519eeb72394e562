//! Every claimed number changed by a millionth in the direction that claims more; every verdict swapped.

use serde_json::Value;

use super::certificates;
use super::mutants::{Mutant, all_refused, each};

/// By what a claimed number has to be multiplied to claim more; none if there is no claim at this path.
fn more(path: &str, value: &Value) -> Option<f64> {
    let number: f64 = value.as_str()?.parse().ok()?;
    let keys: Vec<_> = path.split('/').collect();
    let (up, down) = (1.0 + 1e-6, 1.0 - 1e-6);
    Some(match *keys.as_slice() {
        ["", "contraction_rate" | "convergence_rate"]
        | ["", "blocks", _, "contraction" | "convergence"]
        | ["", "region", "level"]
        | ["", "tube", "disturbance", _]
        | ["", "structure", _, "witness", "difference"] => up,
        // Margins are half of what there is.
        ["", "blocks", _, "cases", ..] | ["", "mass_matrix", ..] => 2.0 * up,
        ["", "tube", "level"] | ["", "tube", "error", _] => down,
        // A measure that is negative claims more farther below 0.
        ["", "measures", _, "bound"] => {
            if number < 0.0 {
                up
            } else {
                down
            }
        }
        _ => return None,
    })
}

pub fn mutants() -> Vec<Mutant> {
    let mut mutants = each("claims more", |path, value| {
        more(path, value)
            .map(|factor| {
                let number: f64 = value.as_str().unwrap().parse().unwrap();
                // Of a measure of 0 a little less.
                let changed = if number == 0.0 { -1e-6 } else { number * factor };
                Value::from(format!("{changed:.20e}"))
            })
            .into_iter()
            .collect()
    });
    mutants.extend(each("swapped", |_, value| match value {
        Value::Bool(holds) => vec![Value::from(!holds)],
        _ => Vec::new(),
    }));
    mutants.extend(each("another name", |path, value| match value {
        Value::String(text) if text.parse::<f64>().is_err() && !is_free(path) => {
            vec![Value::from(format!("{text}x"))]
        }
        _ => Vec::new(),
    }));
    // Less is claimed, but the statement has one rate in these blocks.
    mutants.extend(each("another rate", |path, value| {
        match *path.split('/').collect::<Vec<_>>().as_slice() {
            ["", "blocks", "2" | "3", "contraction"] => {
                let rate: f64 = value.as_str().unwrap().parse().unwrap();
                vec![Value::from((0.9999 * rate).to_string())]
            }
            _ => Vec::new(),
        }
    }));
    mutants.extend(several());
    mutants
}

/// What is wrong, the certificate, and places with what is to stand there.
type Change = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// Changes in several places, after which everything holds but one thing.
fn several() -> Vec<Mutant> {
    let cases: [Change; 7] = [
        ("a witness outside the region", "two-link-tanh", &[("/structure/1/witness/error/0", "3.5")]),
        ("gains that are not the metric", "two-link-linear", &[("/controller/link/shaping/0", "56")]),
        (
            "a tube that leaves the region",
            "two-link-tanh",
            &[
                ("/tube/level", "1000"),
                ("/tube/error/0", "100"),
                ("/tube/error/1", "100"),
                ("/tube/error/2", "100"),
                ("/tube/error/3", "100"),
            ],
        ),
        (
            "rates that are negative everywhere they can be",
            "two-link-linear",
            &[
                ("/contraction_rate", "-1"),
                ("/convergence_rate", "-1"),
                ("/blocks/0/contraction", "-1"),
                ("/blocks/0/convergence", "-1"),
            ],
        ),
        ("an axis that is not of unit length", "tree", &[("/robot/links/bodies/2/axis/0", "0.99")]),
        (
            "an inertia that is none, where an entry is zero",
            "tree",
            &[("/robot/links/bodies/2/inertia/0", "0"), ("/robot/links/bodies/2/inertia/1", "0.0001")],
        ),
        ("a travel the wrong way round", "tree", &[("/robot/links/bodies/2/travel/0", "0.26")]),
    ];
    let changed = |(what, name, changes): Change| {
        let (_, mut content) = certificates().find(|(known, _)| *known == name).unwrap();
        for (path, value) in changes {
            *content.pointer_mut(path).unwrap() = Value::from(*value);
        }
        Mutant::new(name, "", what, &content)
    };
    cases.into_iter().map(changed).collect()
}

/// Texts that are not checked.
fn is_free(path: &str) -> bool {
    matches!(path, "/name" | "/made_by" | "/robot/name") || path.starts_with("/assumptions")
}

#[test]
fn whatever_claims_more_is_refused() {
    all_refused(&mutants(), 350);
}
