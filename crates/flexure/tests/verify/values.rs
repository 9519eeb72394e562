//! Every claimed number changed by a millionth in the direction that claims more; every verdict swapped.

use serde_json::Value;

use crate::mutants::{Mutant, all_refused, each};

/// By what a claimed number has to be multiplied to claim more; none if there is no claim at this path.
fn more(path: &str, value: &Value) -> Option<f64> {
    let number: f64 = value.as_str()?.parse().ok()?;
    let keys: Vec<_> = path.split('/').collect();
    let (up, down) = (1.0 + 1e-6, 1.0 - 1e-6);
    Some(match *keys.as_slice() {
        ["", "contraction_rate" | "convergence_rate"] => up,
        ["", "blocks", _, "contraction" | "convergence"] => up,
        // Margins are half of what there is.
        ["", "blocks", _, "cases", ..] | ["", "mass_matrix", ..] => 2.0 * up,
        ["", "region", "level"] => up,
        ["", "tube", "level"] | ["", "tube", "error", _] => down,
        ["", "tube", "disturbance", _] => up,
        ["", "structure", _, "witness", "difference"] => up,
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
    mutants
}

/// Texts that are not checked.
fn is_free(path: &str) -> bool {
    matches!(path, "/name" | "/made_by" | "/robot/name") || path.starts_with("/assumptions")
}

#[test]
fn whatever_claims_more_is_refused() {
    all_refused(&mutants(), 350);
}
