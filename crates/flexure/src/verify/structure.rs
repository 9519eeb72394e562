//! Which structures the closed loop keeps: by the kind of law, or a witness against.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::document::{Certificate, Phi, Property, SIDES, Side, Witness};
use crate::verify::robot::positive;
use crate::verify::shaping::{Law, slope};
use crate::verify::verdict::{Claim, Rejected, ensure};

const NAMES: [&str; 4] =
    ["variational-ph", "ph-like", "strict-differential-passivity", "incremental-passivity"];

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    if certificate.contraction_rate.is_none() {
        ensure(certificate.structure.is_empty(), "structure", || {
            "nothing is claimed where the metric depends on the error".to_owned()
        })?;
        return Ok(Vec::new());
    }
    let mut claims = Vec::new();
    for name in NAMES {
        let claim = format!("structure.{name}");
        let mut found = certificate.structure.iter().filter(|property| property.name == name);
        let (Some(property), None) = (found.next(), found.next()) else {
            return Err(Rejected::claim(claim, "must be there once"));
        };
        claims.push(Claim::new(claim.as_str(), self::property(certificate, &claim, property)?));
    }
    ensure(certificate.structure.len() == claims.len(), "structure", || {
        "there is an unknown one".to_owned()
    })?;
    Ok(claims)
}

/// Whether the property holds is decided here; the file must say the same, with a witness where it does not.
fn property(certificate: &Certificate, claim: &str, property: &Property) -> Result<String, Rejected> {
    let controller = &certificate.controller;
    let own = match property.name.as_str() {
        "variational-ph" => controller.phi != Phi::CoupledTanh || certificate.robot.joints == 1,
        "ph-like" => {
            let equal = |side: Side| {
                let gains = controller.gains(side);
                gains.shaping.iter().zip(&gains.metric).all(|(shaping, metric)| shaping.is(metric))
            };
            controller.phi == Phi::Linear && SIDES.into_iter().all(|(_, side)| equal(side))
        }
        // The rates are positive: checked with the blocks.
        _ => true,
    };
    ensure(property.holds == own, claim, || format!("holds: {} is claimed, found {own}", property.holds))?;
    match (&property.witness, own) {
        (None, true) => Ok("holds".to_owned()),
        (Some(_), true) => Err(Rejected::claim(claim, "it holds, and yet there is a witness against it")),
        (None, false) => Err(Rejected::claim(claim, "it does not hold, and there is no witness")),
        (Some(witness), false) => {
            self::witness(certificate, claim, witness, property.name == "ph-like")?;
            Ok(format!("does not hold: off by at least {}", witness.difference))
        }
    }
}

/// At the witness's error, the entry differs by at least what is claimed.
fn witness(certificate: &Certificate, claim: &str, witness: &Witness, like: bool) -> Result<(), Rejected> {
    let law = Law::of(certificate, witness.side);
    for (i, (error, bound)) in witness.error.iter().zip(law.error).enumerate() {
        let inside = bound.as_ref().is_none_or(|bound| error.is_within(bound));
        ensure(inside, claim, || format!("error[{i}] of the witness, {error} rad, is outside the region"))?;
    }
    positive(claim, [&witness.difference])?;
    let entry = |i: usize, j: usize| law.entry(i, j, slope(witness.error[j].value), Interval::ONE);
    let metric = |i: usize| law.metric[i].value;
    let (i, j) = (witness.row, witness.column);
    let off = match like {
        true if i == j => entry(i, i) - metric(i),
        true => entry(i, j),
        false => entry(i, j) / metric(j) - entry(j, i) / metric(i),
    };
    let found = off.lo().max(-off.hi());
    ensure(found >= witness.difference.claimed.hi(), claim, || {
        format!("a difference of at least {} is claimed, found {found:e}", witness.difference)
    })
}
