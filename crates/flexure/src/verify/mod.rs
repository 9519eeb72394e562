//! Checking certificates: `docs/certificate.md` is the statement.
//!
//! Nothing here is shared with the rest of the program but the number type
//! [`Interval`](flexure_core::scalar::Interval): no robot model, no linear algebra, no reader of files, and nothing of what
//! writes certificates. A mistake would have to be made twice to go unnoticed.

mod block;
mod chain;
mod coupling;
mod document;
mod field;
mod frame;
mod json;
mod mass;
mod matrix;
mod measures;
mod momentum;
mod number;
mod position;
mod reach;
mod region;
mod robot;
mod shaping;
mod stretched;
mod structure;
mod subject;
mod tube;
mod vector;
mod verdict;
mod words;

pub use document::LARGEST;
pub(crate) use json::strict;
pub(crate) use number::is_decimal;
pub use subject::quoted;
pub use verdict::{CheckReport, Claim, Rejected};

/// Checks every claim of a certificate.
///
/// ```
/// use flexure::verify::{Rejected, verify};
/// let text = include_str!("../../tests/certificates/two-link-linear.json");
/// let report = verify(text).unwrap();
/// assert_eq!(Some(report.convergence_rate), report.contraction_rate);
/// let other = text.replace("\"format\"", "\"Format\"");
/// assert!(matches!(verify(&other), Err(Rejected::Malformed { .. })));
/// ```
///
/// # Errors
/// [`Rejected::Malformed`] if the text is no certificate, [`Rejected::False`] if a claim does not hold.
pub fn verify(text: &str) -> Result<CheckReport, Rejected> {
    let certificate = document::read(text)?;
    let checks = [
        robot::check,
        coupling::check,
        region::check,
        mass::check,
        position::check,
        momentum::check,
        block::check_rates,
        measures::check,
        structure::check,
        tube::check,
        stretched::check,
    ];
    let mut claims = Vec::new();
    for check in checks {
        claims.extend(check(&certificate)?);
    }
    Ok(CheckReport {
        about: subject::stated(&certificate),
        name: certificate.name,
        assumptions: certificate.assumptions,
        claims,
        contraction_rate: certificate.contraction_rate.map(|rate| rate.to_string()),
        convergence_rate: certificate.convergence_rate.to_string(),
    })
}
