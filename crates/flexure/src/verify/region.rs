//! The region: the level set of W lies inside the box of errors.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::document::{Certificate, Side};
use crate::verify::number::Number;
use crate::verify::robot::positive;
use crate::verify::shaping::Law;
use crate::verify::verdict::{Claim, Rejected, ensure};

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let region = &certificate.region;
    let bounds: Vec<&Number> = region.error.iter().flatten().collect();
    let Some(level) = &region.level else {
        ensure(bounds.is_empty(), "region", || "errors have bounds but there is no level".to_owned())?;
        return Ok(vec![Claim::new("region", "everywhere")]);
    };
    ensure(bounds.len() == region.error.len(), "region", || {
        "there is a level but some errors have no bound".to_owned()
    })?;
    positive("region.error", bounds.iter().copied())?;
    positive("region.level", [level])?;
    for (offset, side) in [(0, Side::Link), (certificate.robot.joints, Side::Motor)] {
        let law = Law::of(certificate, side);
        for (i, (bound, metric)) in law.error.iter().flatten().zip(law.metric).enumerate() {
            let (needed, reached) = (twice(level.claimed), metric.value * bound.value.square());
            ensure(needed.hi() <= reached.lo(), "region.level", || {
                format!(
                    "2 c = {:e} J is claimed to be at most metric times error[{}]^2, found {:e} J",
                    needed.hi(),
                    i + offset,
                    reached.lo()
                )
            })?;
        }
    }
    let bounds: Vec<_> = bounds.iter().map(ToString::to_string).collect();
    Ok(vec![Claim::new("region", format!("W <= {level} J keeps |error| <= {} rad", bounds.join(", ")))])
}

/// 2 c.
pub(super) fn twice(level: Interval) -> Interval {
    level * Interval::from_f64(2.0)
}
