//! The tube: how far an unknown torque on the motors can push the errors.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::block;
use crate::verify::document::{Certificate, SIDES, Tube};
use crate::verify::number::Number;
use crate::verify::region::twice;
use crate::verify::robot::nonnegative;
use crate::verify::shaping::Law;
use crate::verify::verdict::{Claim, Rejected, ensure};

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let Some(tube) = &certificate.tube else { return Ok(Vec::new()) };
    nonnegative("tube.disturbance", &tube.disturbance)?;
    nonnegative("tube.level", [&tube.level])?;
    nonnegative("tube.error", &tube.error)?;
    let needed = least_level(certificate, tube)?;
    ensure(needed <= tube.level.claimed.lo(), "tube.level", || {
        format!("{} J is claimed, found {needed:e} J", tube.level)
    })?;
    if let Some(region) = &certificate.region.level {
        ensure(tube.level.is_at_most(region), "tube.level", || {
            format!("{} J is more than the region's {region} J", tube.level)
        })?;
    }
    let metrics = SIDES.into_iter().flat_map(|(_, side)| Law::of(certificate, side).metric);
    for (i, (error, metric)) in tube.error.iter().zip(metrics).enumerate() {
        let (needed, reached) = (twice(tube.reached.claimed), metric.value * error.claimed.square());
        ensure(needed.hi() <= reached.lo(), format!("tube.error[{i}]"), || {
            format!("{error} rad is claimed, found {:e} rad", (needed / metric.value).sqrt().hi())
        })?;
    }
    let errors: Vec<_> = tube.error.iter().map(Number::to_string).collect();
    Ok(vec![Claim::new("tube", format!("W <= {} J, |error| <= {} rad", tube.level, errors.join(", ")))])
}

/// An upper bound of the level that the formula asks for.
fn least_level(certificate: &Certificate, tube: &Tube) -> Result<f64, Rejected> {
    let number = |x: f64| Interval::from_f64(x);
    let inertia = certificate.robot.motor_inertia.iter();
    let terms = tube.disturbance.iter().zip(inertia).map(|(d, m)| d.value.square() / m.value);
    let strength = terms.fold(Interval::ZERO, |sum, term| sum + term);
    let b = block::find(certificate, "sigma_m")?.convergence.value;
    let rate = |name| block::find(certificate, name).map(|block| block.convergence.value);
    let others = [rate("phi_l")?, rate("phi_m")?, rate("sigma_l")?];
    // The smallest of the other three: end by end.
    let [lo, hi] =
        [Interval::lo, Interval::hi].map(|end| others.map(end).into_iter().fold(f64::INFINITY, f64::min));
    let beta = Interval::new(lo, hi).unwrap_or(Interval::ENTIRE);
    let fast = strength / (number(8.0) * beta * (b - beta));
    let slow = strength / (number(2.0) * b.square());
    let twice = number(2.0) * beta;
    Ok(if b.lo() >= twice.hi() {
        fast.hi()
    } else if b.hi() < twice.lo() {
        slow.hi()
    } else {
        // Either may be the one: both.
        fast.hi().max(slow.hi())
    })
}
