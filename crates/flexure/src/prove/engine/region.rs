//! Where a certificate holds: a box of errors, and the level set of W inside it, which is invariant.

use flexure_core::scalar::{Interval, Scalar};

use crate::prove::engine::certificate::{CertifiedRegion, DecimalRobot, Tube};
use crate::prove::engine::number::Number;

/// The region that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum RequestedRegion {
    /// Every error.
    Everywhere,
    /// |q̃_i| up to these, links then motors, > 0, in rad.
    Box(Vec<Number>),
    /// Every error with W up to this, > 0, in J.
    Level(f64),
}

/// The region for the metric Π of links and motors.
pub fn region(request: &RequestedRegion, metric: &[Interval]) -> CertifiedRegion {
    match request {
        RequestedRegion::Everywhere => CertifiedRegion { error: vec![None; metric.len()], level: None },
        RequestedRegion::Box(errors) => {
            let level = errors.iter().zip(metric).map(|(error, &metric)| level_of(error.bounds(), metric));
            let level = level.fold(f64::INFINITY, f64::min);
            CertifiedRegion {
                error: errors.iter().cloned().map(Some).collect(),
                level: Some(Number::below(level)),
            }
        }
        RequestedRegion::Level(level) => {
            let level = Number::above(*level);
            let error = metric.iter().map(|&metric| Some(error_of(&level, metric))).collect();
            CertifiedRegion { error, level: Some(level) }
        }
    }
}

/// The largest c with √(2c/Π_i) ≤ R_i, from below.
fn level_of(error: Interval, metric: Interval) -> f64 {
    (metric * error.square() * Interval::point(0.5)).lo()
}

/// √(2c/Π_i), from above.
fn error_of(level: &Number, metric: Interval) -> Number {
    Number::above((level.bounds() * Interval::point(2.0) / metric).sqrt().hi())
}

/// ½ Σ Π_i e_i², from above: W of position errors alone.
pub fn level_that_holds(errors: &[Number], metric: &[Interval]) -> f64 {
    let sum = errors
        .iter()
        .zip(metric)
        .fold(Interval::ZERO, |sum, (e, &metric)| sum + metric * e.bounds().square());
    (sum * Interval::point(0.5)).hi()
}

/// The tube that errors stay in while the motors feel an unknown torque of at most `disturbance` [N m]: the smallest
/// level c at which W cannot grow,
///
/// Ẇ ≤ −2 b W_m − 2 β (W − W_m) + δ √(2 W_m) with δ² = Σ d_i²/M_m,i, whatever share W_m the motor momenta have of W.
///
/// `motor_rate` is b, `other_rate` the smallest of the other three.
///
/// # Errors
/// If no level inside the region is large enough: says which would be.
pub fn tube(
    robot: &DecimalRobot,
    disturbance: &[Number],
    (motor_rate, other_rate): (Interval, Interval),
    metric: &[Interval],
    region: &CertifiedRegion,
) -> Result<Tube, String> {
    let delta_squared = disturbance
        .iter()
        .zip(&robot.motor_inertia)
        .fold(Interval::ZERO, |sum, (d, inertia)| sum + d.bounds().square() / inertia.bounds());
    let (b, beta) = (motor_rate, other_rate);
    let two = Interval::point(2.0);
    let level = if b.lo() >= (two * beta).hi() {
        delta_squared / (Interval::point(8.0) * beta * (b - beta))
    } else {
        delta_squared / (two * b.square())
    };
    let level = Number::above(level.hi());
    if let Some(largest) = &region.level
        && level.bounds().hi() > largest.bounds().lo()
    {
        return Err(format!(
            "the disturbance can push W to {:.4e} J, beyond the region's level of {:.4e} J",
            level.approximate(),
            largest.approximate()
        ));
    }
    let error = metric.iter().map(|&metric| error_of(&level, metric)).collect();
    Ok(Tube { disturbance: disturbance.to_vec(), level, error })
}
