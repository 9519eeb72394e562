//! States in the tube that exceed a limit, in plain `f64`.

use flexure_core::control::{Metric, Shaping};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::Reference;
use serde::Serialize;

use crate::feasible;
use crate::files::Problems;
use crate::laws::{self, Law, law};
use crate::prove::engine::envelope::witness::Candidate;
use crate::robot::sized::{OF_THE_KIND, fjr, sized, vector};
use crate::scenario::Scenario;

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

/// The state at `candidate` if it is in the tube of level `level` in J and quantity `k` is above `limit` in absolute value.
pub(crate) fn confirm(
    scenario: &Scenario,
    candidate: &Candidate,
    level: f64,
    k: usize,
    limit: f64,
) -> Option<Exceeding> {
    let found = exceeding(scenario, candidate, k).ok()??;
    (found.level <= level && found.value > limit).then_some(found)
}

/// The law at a state given by its errors.
fn exceeding(scenario: &Scenario, candidate: &Candidate, k: usize) -> Result<Option<Exceeding>, Problems> {
    let robot = &scenario.robot;
    Ok(
        sized!(robot, L, N => at::<L<f64>, N>(scenario, &fjr(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND), candidate, k)),
    )
}

fn at<L: Links<f64, N>, const N: usize>(
    scenario: &Scenario,
    robot: &Fjr<f64, L, N>,
    candidate: &Candidate,
    k: usize,
) -> Option<Exceeding> {
    let Candidate { time: t, error } = candidate;
    let law: Law<f64, N> = law(scenario.vcbc().ok()?);
    let reference = feasible::reference::<N>(scenario).ok()?;
    let q_ld = reference.at(*t);
    let n = robot.links.joints();
    let part = |i: usize| vector::<N>(&error[i * n..(i + 1) * n]);
    let [e_l, e_m, s_l, s_m] = [0, 1, 2, 3].map(part);
    let order = |k: usize| q_ld.map(|jet| jet.coefficient(k));
    let command = |x: &Motion<f64, N>| laws::command(&law, robot, x, &q_ld);
    // What the law wants of the motors does not depend on where they are.
    let mut x = Motion {
        q_l: order(0) + e_l,
        q_m: Vector::ZERO,
        v_l: order(1) - law.link.shaping.eval(&e_l) + s_l,
        v_m: Vector::ZERO,
    };
    x.q_m = command(&x).q_md + e_m;
    x.v_m = s_m - command(&x).s_m;
    let command = command(&x);

    let (Metric::Constant(metric) | Metric::Hardening { base: metric, .. }) = law.link.metric;
    let level = command.e_l.dot(&metric.diag_mul(&command.e_l))
        + command.e_m.dot(&law.motor.metric.diag_mul(&command.e_m))
        + command.s_l.dot(&robot.links.mass_mul(&x.q_l, &command.s_l))
        + command.s_m.dot(&robot.motor_inertia.diag_mul(&command.s_m));
    let quantities = [x.v_l, x.deflection(), command.u_m];
    let [q_l, q_m, dq_l, dq_m] = [x.q_l, x.q_m, x.v_l, x.v_m].map(|v| v.iter().take(n).collect());
    let value = quantities.get(k / n)?[k % n].abs();
    Some(Exceeding { t: *t, q_l, q_m, dq_l, dq_m, level: 0.5 * level, value })
}
