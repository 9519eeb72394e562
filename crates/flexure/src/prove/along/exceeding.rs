//! States in the tube that exceed a limit, in plain `f64`.

use serde::Serialize;

use crate::laws::VcbcGains;
use crate::prove::engine::envelope::witness::Candidate;
use crate::scenario::Scenario;
use crate::simulate::{Commanded, Errors, Loop};

/// A state in the tube at which a limit is exceeded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Exceeding {
    /// Time in s.
    pub t: f64,
    /// Link positions in rad.
    pub q_l: Vec<f64>,
    /// Motor positions in rad.
    pub q_m: Vec<f64>,
    /// Link velocities [rad/s].
    pub dq_l: Vec<f64>,
    /// Motor velocities [rad/s].
    pub dq_m: Vec<f64>,
    /// W at that state, in J.
    pub level: f64,
    /// The absolute value that exceeds the limit.
    pub value: f64,
}

/// The first of `candidates` that is in the tube of level `level` in J and whose quantity `k` is above `limit` in absolute
/// value.
pub(crate) fn first(
    scenario: &Scenario,
    candidates: &[Candidate],
    level: f64,
    k: usize,
    limit: f64,
) -> Option<Exceeding> {
    let (held, gains) = (scenario.open().ok()?, scenario.vcbc().ok()?);
    let at = |candidate| exceeding(&*held, gains, candidate, k);
    candidates.iter().filter_map(at).find(|found| found.level <= level && found.value > limit)
}

/// The law at a state given by its errors.
fn exceeding(held: &dyn Loop, gains: &VcbcGains, candidate: &Candidate, k: usize) -> Option<Exceeding> {
    let (n, t) = (held.joints(), candidate.time);
    let mut q_ld = vec![[0.0; 5]; n];
    held.reference(t, &mut q_ld).ok()?;
    let mut parts = candidate.error.chunks(n);
    let mut part = || parts.next();
    let (e_l, e_m, s_l, s_m) = (part()?, part()?, part()?, part()?);
    let plus = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
    let minus = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    let command = |x: &[&[f64]; 4]| -> Option<(Vec<f64>, Vec<f64>, Errors)> {
        let Commanded { u_m, e_l, errors, .. } = held.command(t, &x.concat()).ok()?;
        Some((u_m, e_l, errors?))
    };
    let rest = vec![0.0; n];
    let q_l = plus(&q_ld.iter().map(|q| q[0]).collect::<Vec<_>>(), e_l);
    // At rest the velocity error is that of the reference velocity alone, with the other sign.
    let (.., errors) = command(&[&q_l, &rest, &rest, &rest])?;
    let dq_l = minus(s_l, &errors.s_l);
    // What the law wants of the motors does not depend on where they are.
    let (.., errors) = command(&[&q_l, &rest, &dq_l, &rest])?;
    let q_m = plus(&errors.q_md, e_m);
    let (.., errors) = command(&[&q_l, &q_m, &dq_l, &rest])?;
    let dq_m = minus(s_m, &errors.s_m);
    let (u_m, e_l, errors) = command(&[&q_l, &q_m, &dq_l, &dq_m])?;

    let form =
        |metric: &[f64], e: &[f64]| -> f64 { e.iter().zip(metric).map(|(e, metric)| e * (metric * e)).sum() };
    let product = |s: &[f64], sigma: &[f64]| -> f64 { s.iter().zip(sigma).map(|(s, sigma)| s * sigma).sum() };
    let level = form(&gains.link.metric, &e_l)
        + form(&gains.motor.metric, &errors.e_m)
        + product(&errors.s_l, &errors.sigma_l)
        + product(&errors.s_m, &errors.sigma_m);
    let value = [&dq_l, &minus(&q_m, &q_l), &u_m].get(k / n)?[k % n].abs();
    Some(Exceeding { t, q_l, q_m, dq_l, dq_m, level: 0.5 * level, value })
}
