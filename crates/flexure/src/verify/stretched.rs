//! The stretched metric: what it leaves of each joint's inequality is borne by the damping of the links.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::block;
use crate::verify::document::{Certificate, Phi, Side, Stretched};
use crate::verify::mass::{pendulum_mass, planar_mass};
use crate::verify::matrix::Symmetric;
use crate::verify::momentum::damping;
use crate::verify::number::Number;
use crate::verify::robot::{Links, nonnegative, positive};
use crate::verify::shaping::{Law, slope};
use crate::verify::verdict::{Claim, Rejected, ensure};

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let Some(claim) = &certificate.stretched else { return Ok(Vec::new()) };
    let phi = certificate.controller.phi;
    ensure(phi != Phi::CoupledTanh, "stretched", || "is for phi = tanh or linear".to_owned())?;
    ensure(phi == Phi::Tanh || claim.exponent.iter().all(Option::is_none), "stretched.exponent", || {
        "an exponent is for phi = tanh".to_owned()
    })?;
    nonnegative("stretched.velocity_error", &claim.velocity_error)?;
    positive("stretched.exponent", claim.exponent.iter().flatten())?;
    let too_large = claim.exponent.iter().flatten().find(|b| b.value.hi() >= 1.0);
    ensure(too_large.is_none(), "stretched.exponent", || "an exponent is not < 1".to_owned())?;
    positive("stretched.rate", [&claim.rate])?;
    let loads = (0..certificate.robot.joints).map(|i| load(certificate, claim, i));
    let loads = loads.collect::<Result<Vec<_>, _>>()?;
    let pivot = smallest_pivot(certificate, &loads, claim.rate.claimed)?;
    ensure(pivot > 0.0, "stretched.rate", || {
        format!(
            "{} 1/s is claimed; the links' damping does not bear it: smallest pivot {pivot:e}",
            claim.rate
        )
    })?;
    let speeds: Vec<_> = claim.velocity_error.iter().map(ToString::to_string).collect();
    let value = format!(
        "{} 1/s between any two solutions of the virtual system while both are in the region with |s| <= {} rad/s",
        claim.rate,
        speeds.join(", ")
    );
    Ok(vec![Claim::new("stretched", value)])
}

/// What the stretched position error of one joint and side leaves.
struct Rest {
    /// Its own rate less β, while it drifts outwards as fast as it can.
    rate: Interval,
    /// (P − Π)²/P, at most.
    mismatch: Interval,
}

/// At the largest error of joint `i` on a side that drifts by at most `drift`.
fn rest(
    certificate: &Certificate,
    claim: &Stretched,
    (side, i): (Side, usize),
    drift: Interval,
) -> Result<Rest, Rejected> {
    let law = Law::of(certificate, side);
    let at = if side == Side::Link { i } else { law.n + i };
    let name = format!("stretched.exponent[{at}]");
    let hardening = certificate.controller.gains(side).hardening.get(i).map_or(Interval::ZERO, |h| h.value);
    let [metric, gain] = [law.metric[i].value, law.entry(i, i, Interval::ONE, Interval::ONE)];
    // What Π (1 + g x²) loses of the rate that Π has, where φ is at least chord times x.
    let lost = |chord: Interval| {
        let root = (chord.square() + hardening / metric * drift.square()).sqrt();
        if hardening == Interval::ZERO { Interval::ZERO } else { (root - chord) / Interval::from_f64(2.0) }
    };
    let enough = |rate: Interval| {
        ensure(rate.lo() > 0.0, name.as_str(), || {
            let less = -rate.lo();
            format!("the position error alone contracts more slowly than {} 1/s: {less:e} less", claim.rate)
        })
    };
    if law.phi == Phi::Linear {
        let rate = gain - lost(gain) - claim.rate.claimed;
        enough(rate)?;
        return Ok(Rest { rate, mismatch: Interval::ZERO });
    }
    let Some(error) = &law.error[i] else {
        return Err(Rejected::claim(name, "errors of its joint have no bound"));
    };
    let largest = Interval::point(error.value.hi());
    let (flat, tanh) = (slope(largest), largest.tanh());
    // r over its least value, squared, and r'/r.
    let (square, growth) = match claim.exponent[at].as_ref().map(|b| b.value) {
        Some(b) if b.lo() > flat.hi() => {
            let rest = Interval::ONE - b;
            let base = tanh.square() / flat * (b / rest);
            ((b * base.ln()).exp() * rest / tanh.square(), (b - flat) / tanh)
        }
        // The stretch begins beyond the region.
        Some(b) if b.hi() > flat.lo() => {
            return Err(Rejected::claim(name, "is too close to sech^2 of the largest error"));
        }
        _ => (Interval::ONE, Interval::ZERO),
    };
    let rate =
        gain * (flat + growth * tanh) - growth * drift - lost(gain * tanh / largest) - claim.rate.claimed;
    enough(rate)?;
    let metric = metric + hardening * largest.square();
    // P is Π r² over the largest r: as far from Π at no error as at the largest.
    let ratio = square.sqrt();
    Ok(Rest { rate, mismatch: metric * (ratio - Interval::ONE).square() / ratio })
}

/// What joint `i` takes from the damping of its link.
fn load(certificate: &Certificate, claim: &Stretched, i: usize) -> Result<Interval, Rejected> {
    let (robot, n) = (&certificate.robot, certificate.robot.joints);
    let four = Interval::from_f64(4.0);
    let [link_speed, motor_speed] = [i, n + i].map(|at| claim.velocity_error[at].value);
    let motor_gains = certificate.controller.gains(Side::Motor);
    let coupling = robot.stiffness[i].value / motor_gains.metric[i].value;
    let link = rest(certificate, claim, (Side::Link, i), link_speed)?;
    let motor = rest(certificate, claim, (Side::Motor, i), motor_speed + coupling * link_speed)?;
    let left = robot.motor_damping[i].value + motor_gains.damping[i].value
        - claim.rate.claimed * robot.motor_inertia[i].value;
    let rate = motor.rate - motor.mismatch / (four * left);
    ensure(left.lo() > 0.0 && rate.lo() > 0.0, "stretched.rate", || {
        format!("{} 1/s is claimed; the motor of joint {i} does not reach it", claim.rate)
    })?;
    Ok(link.mismatch / (four * link.rate) + coupling.square() * motor.mismatch / (four * rate))
}

/// Of B − diag(`loads`) − β M_l(q), from below, for all q.
fn smallest_pivot(certificate: &Certificate, loads: &[Interval], beta: Interval) -> Result<f64, Rejected> {
    let robot = &certificate.robot;
    let damping = damping(&robot.link_damping, &certificate.controller.gains(Side::Link).damping);
    let of = |mass: &dyn Fn(usize, usize) -> Interval| {
        let own = |i: usize, j: usize| if i == j { damping[i] - loads[i] } else { Interval::ZERO };
        Symmetric::from_fn(robot.joints, |i, j| own(i, j) - beta * mass(i, j)).smallest_pivot()
    };
    Ok(match &robot.links {
        Links::PlanarTwoLink(_) => {
            let at = |cosine| {
                let mass = planar_mass(&robot.links, cosine);
                of(&|i, j| mass[i + j])
            };
            at(-1.0).min(at(1.0))
        }
        Links::Pendulum(_) => of(&|_, _| pendulum_mass(&robot.links)),
        // The block of the links' momenta bounds the mass matrix by its damping over its rate.
        Links::Tree(_) => {
            let rate: &Number = &block::find(certificate, "sigma_l")?.contraction;
            of(&|i, j| if i == j { damping[i] / rate.value } else { Interval::ZERO })
        }
    })
}
