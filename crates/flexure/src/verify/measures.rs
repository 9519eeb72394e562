//! Matrix measures of −Θ ∂φ Θ⁻¹ over the region.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::block;
use crate::verify::document::{Certificate, Measure, SIDES, Side};
use crate::verify::shaping::{Law, Rate};
use crate::verify::verdict::{Claim, Rejected, ensure};

const NORMS: [&str; 3] = ["1", "2", "inf"];

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let mut claims = Vec::new();
    for (name, side) in SIDES {
        for norm in NORMS {
            let claim = format!("measures.{name}.{norm}");
            let here = |entry: &&Measure| entry.side == side && entry.norm == norm;
            let mut found = certificate.measures.iter().filter(here);
            let (Some(measure), None) = (found.next(), found.next()) else {
                return Err(Rejected::claim(claim, "must be there once"));
            };
            bound(certificate, &claim, measure)?;
            claims.push(Claim::new(claim, format!("at most {} 1/s", measure.bound)));
        }
    }
    ensure(certificate.measures.len() == claims.len(), "measures", || "there is an unknown one".to_owned())?;
    Ok(claims)
}

fn bound(certificate: &Certificate, claim: &str, measure: &Measure) -> Result<(), Rejected> {
    if measure.norm == "2" {
        let block = if measure.side == Side::Link { "phi_l" } else { "phi_m" };
        let found = block::find(certificate, block)?.contraction.negated();
        return ensure(found.is_at_most(&measure.bound), claim, || {
            format!("{} is claimed, found {found} from block {block}", measure.bound)
        });
    }
    let found = largest_sum(&Law::of(certificate, measure.side), measure.norm == "1");
    ensure(found <= measure.bound.claimed.lo(), claim, || {
        format!("{} is claimed, found {found:e}", measure.bound)
    })
}

/// The largest of J_kk + Σ |J| over the rest of column, or row, k; J = −Θ ∂φ Θ⁻¹.
fn largest_sum(law: &Law<'_>, columns: bool) -> f64 {
    let slopes: Vec<_> =
        law.lower_ends(Rate::Contraction).into_iter().map(|low| low.hull(Interval::ONE)).collect();
    let magnitude = |i: usize, j: usize| {
        let weight = law.metric[i].value / law.metric[j].value;
        Interval::point(law.entry(i, j, slopes[j], weight).magnitude())
    };
    let sum = |k: usize| {
        let mut total = -law.entry(k, k, slopes[k], Interval::ONE);
        for other in (0..law.n).filter(|&other| other != k) {
            total += if columns { magnitude(other, k) } else { magnitude(k, other) };
        }
        total.hi()
    };
    (0..law.n).map(sum).fold(f64::NEG_INFINITY, f64::max)
}
