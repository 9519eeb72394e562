//! What the four blocks have in common: names, rates, cases and margins; and the rates of the whole.

use std::collections::BTreeSet;

use crate::verify::document::{Block, Case, Certificate, Side, Version};
use crate::verify::json::clipped;
use crate::verify::number::Number;
use crate::verify::robot::positive;
use crate::verify::shaping::{RATES, Rate};
use crate::verify::verdict::{Claim, Rejected, ensure};

/// In this order in reports, in any order in the file.
const BLOCKS: [&str; 4] = ["phi_l", "phi_m", "sigma_l", "sigma_m"];

impl Block {
    pub(super) fn rate(&self, rate: Rate) -> &Number {
        if rate == Rate::Contraction { &self.contraction } else { &self.convergence }
    }
}

impl Case {
    fn margin(&self, rate: Rate) -> &Number {
        if rate == Rate::Contraction { &self.contraction } else { &self.convergence }
    }
}

/// The block of that name: exactly one.
pub(super) fn find<'a>(certificate: &'a Certificate, name: &str) -> Result<&'a Block, Rejected> {
    let mut found = certificate.blocks.iter().filter(|block| block.name == name);
    match (found.next(), found.next()) {
        (Some(block), None) => Ok(block),
        (None, _) => Err(Rejected::claim(format!("blocks.{name}"), "is missing")),
        (_, Some(_)) => Err(Rejected::claim(format!("blocks.{name}"), "is there twice")),
    }
}

/// Rates are positive, the cases are exactly `wanted`, and in each the smallest pivot that `pivot` finds is at least the
/// margin.
pub(super) fn check(
    block: &Block,
    wanted: &[String],
    pivot: impl Fn(&str, Rate) -> f64,
) -> Result<Claim, Rejected> {
    let claim = format!("blocks.{}", block.name);
    for (name, rate) in RATES {
        let beta = block.rate(rate);
        ensure(beta.is_positive(), format!("{claim}.{name}"), || format!("the rate {beta} is not > 0"))?;
    }
    let mut missing: BTreeSet<_> = wanted.iter().map(String::as_str).collect();
    for case in &block.cases {
        ensure(missing.remove(case.name.as_str()), format!("{claim}.cases"), || {
            format!("case '{}' is there twice or not among those of the block", clipped(&case.name))
        })?;
    }
    ensure(missing.is_empty(), format!("{claim}.cases"), || {
        format!("case '{}' is missing", missing.first().unwrap_or(&""))
    })?;
    for case in &block.cases {
        for (name, rate) in RATES {
            margin(
                &format!("{claim}.cases['{}'].{name}", case.name),
                case.margin(rate),
                pivot(&case.name, rate),
            )?;
        }
    }
    let (contraction, convergence) = (&block.contraction, &block.convergence);
    let count = wanted.len();
    let cases = if count == 1 { "1 case".to_owned() } else { format!("{count} cases") };
    Ok(Claim::new(claim, format!("contraction {contraction} 1/s, convergence {convergence} 1/s, {cases}")))
}

/// The margin is ≥ 0 and the smallest pivot at least that.
pub(super) fn margin(claim: &str, margin: &Number, found: f64) -> Result<(), Rejected> {
    ensure(margin.is_nonnegative(), claim, || format!("the margin {margin} is not >= 0"))?;
    ensure(found >= margin.claimed.hi(), claim, || {
        format!("the smallest pivot is claimed to be at least {margin}, found {found:e}")
    })
}

/// Every block is one of the four, and the rates at the top are at most theirs.
pub(super) fn check_rates(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    if let Some(block) = certificate.blocks.iter().find(|block| !BLOCKS.contains(&block.name.as_str())) {
        return Err(Rejected::claim("blocks", format!("there is no block '{}'", clipped(&block.name))));
    }
    let cases = certificate.blocks.iter().flat_map(|block| &block.cases);
    if certificate.version != Version::One {
        let margins: Vec<_> = cases.flat_map(|case| [&case.contraction, &case.convergence]).collect();
        positive("blocks.cases", margins)?;
    }
    let hardens = !certificate.controller.gains(Side::Link).hardening.is_empty();
    ensure(certificate.contraction_rate.is_none() == hardens, "contraction_rate", || {
        "must be null where, and only where, the metric of the link hardens".to_owned()
    })?;
    let tops = [certificate.contraction_rate.as_ref(), Some(&certificate.convergence_rate)];
    let tops = RATES.into_iter().zip(tops).filter_map(|(rate, top)| Some((rate, top?)));
    let mut claims = Vec::new();
    for ((name, rate), top) in tops {
        let claim = format!("{name}_rate");
        ensure(top.is_positive(), claim.as_str(), || format!("the rate {top} is not > 0"))?;
        for block in BLOCKS {
            let beta = find(certificate, block)?.rate(rate);
            ensure(top.is_at_most(beta), claim.as_str(), || {
                format!("{top} 1/s is claimed, block {block} has {beta} 1/s")
            })?;
        }
        claims.push(Claim::new(claim, format!("{top} 1/s")));
    }
    Ok(claims)
}
