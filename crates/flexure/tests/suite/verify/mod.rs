//! Checking certificates: what holds is verified, and everything that claims more is refused, by both checkers.
//!
//! The certificates in `tests/certificates` were made without this program's prover, from the formulas of
//! `docs/certificate.md` in 40 digits: rates are 1e-13 below the exact ones, relatively, so that nothing more can be
//! claimed, and margins half of the pivots.

mod accepted;
mod agreement;
mod lists;
mod mangled;
mod mutants;
mod prover;
pub mod python;
mod signs;
mod subject;
mod values;

use serde_json::Value;

/// Names and texts of the certificates.
const CERTIFICATES: [(&str, &str); 7] = [
    ("pendulum", include_str!("../../certificates/pendulum.json")),
    ("tree", include_str!("../../certificates/tree.json")),
    ("two-link-coupled-tanh", include_str!("../../certificates/two-link-coupled-tanh.json")),
    ("two-link-linear", include_str!("../../certificates/two-link-linear.json")),
    ("two-link-tanh", include_str!("../../certificates/two-link-tanh.json")),
    // Metric and gains differ, so that rows and columns of the slope's matrix do.
    ("two-link-uneven", include_str!("../../certificates/two-link-uneven.json")),
    // The same tree in version 2, with a chain of forms that the prover suggested; its rate, 1e-8 below the
    // largest, and its margins in 90 digits.
    ("tree-chain", include_str!("../../certificates/tree-chain.json")),
];

/// Name and content of each certificate.
fn certificates() -> impl Iterator<Item = (&'static str, Value)> {
    CERTIFICATES.into_iter().map(|(name, text)| (name, serde_json::from_str(text).unwrap()))
}

/// The tree whose last body is a thin rod: no inertia about one axis.
fn tree_with_a_rod() -> String {
    let mut content: Value = serde_json::from_str(CERTIFICATES[1].1).unwrap();
    content["robot"]["links"]["bodies"][2]["inertia"] =
        serde_json::json!(["0", "0", "0", "0.0011", "0", "0.0011"]);
    content.to_string()
}
