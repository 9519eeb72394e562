//! Certificates that the checker accepts.

use crate::prove::engine;
use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::reserve::Reserve;
use crate::prove::engine::structural::Proposition;
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::prove::engine::witness::RateWitness;
use crate::verify::verify;

/// Proves the rates of the closed loop, and has the certificate checked as it will be written: what [`verify`] rejects is
/// claimed again with more reserve. What it rejects with the most is undecided.
pub fn certify(problem: &Proposition) -> Verdict<Certificate, RateWitness> {
    let mut reserve = Reserve::default();
    loop {
        let verdict = engine::certify(problem, reserve);
        let Some(certificate) = verdict.proved() else { return verdict };
        let Err(rejected) = verify(&certificate.text()) else { return verdict };
        let Some(more) = reserve.more() else {
            let at = format!("the checker does not see what the prover saw: {rejected}");
            return Verdict::Undecided(Undecided { at, spent: 1 });
        };
        reserve = more;
    }
}
