//! What a robot must do to follow a reference.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::reference::Reference as _;
use flexure_core::scalar::Jet;

use crate::feasible::at_speed;
use crate::feasible::bounds::{Bound, Quantity};
use crate::files::Problems;
use crate::references::AnyReference;
use crate::robot::{RobotVisitor, with_robot};
use crate::scenario::Scenario;

/// A robot and a reference, whatever their types.
pub trait Track {
    /// What follows from running along the reference at `speed`.
    fn at_speed(&self, speed: f64) -> Box<Demands<'_>>;
}

/// Numbers along a reference, at a time in s.
pub type Demands<'a> = dyn Fn(f64) -> Demand + 'a;

/// What following the reference takes at some time, an entry per joint.
pub struct Demand {
    pub(super) torque: Vec<f64>,
    torque_rate: Vec<f64>,
    velocity: Vec<f64>,
    deflection: Vec<f64>,
    position: Vec<f64>,
}

impl Demand {
    /// What `bound` is about.
    pub fn of(&self, bound: &Bound) -> f64 {
        let values = match bound.quantity {
            Quantity::Torque => &self.torque,
            Quantity::TorqueRate => &self.torque_rate,
            Quantity::Velocity => &self.velocity,
            Quantity::Deflection => &self.deflection,
            Quantity::Position => &self.position,
        };
        values[bound.joint]
    }
}

/// Hands robot and reference of `scenario` to `then`.
pub fn with_track<R>(scenario: &Scenario, then: impl Fn(&dyn Track) -> R) -> Result<R, Problems> {
    with_robot(&scenario.robot, Visitor { scenario, then: &then })?
}

struct Visitor<'a, R> {
    scenario: &'a Scenario,
    then: &'a dyn Fn(&dyn Track) -> R,
}

impl<R> RobotVisitor for Visitor<'_, R> {
    type Output = Result<R, Problems>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let reference = at_speed(self.scenario, 1.0)?;
        Ok((self.then)(&Pair { robot, reference }))
    }
}

struct Pair<L, const N: usize> {
    robot: Fjr<f64, L, N>,
    reference: AnyReference<f64, N>,
}

impl<L: Links<f64, N>, const N: usize> Track for Pair<L, N> {
    fn at_speed(&self, speed: f64) -> Box<Demands<'_>> {
        let reference = self.reference.paced(speed);
        Box::new(move |t| demand(&self.robot, &reference.at(t)))
    }
}

/// By exact inverse dynamics.
#[inline(never)]
fn demand<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, q_ld: &Vector<Jet<f64, 6>, N>) -> Demand {
    let forward = robot.inverse_dynamics::<_, 2, 4, 6>(q_ld);
    let order = |k: usize, x: &Vector<Jet<f64, 2>, N>| x.iter().map(|x| x.derivative(k)).collect();
    let q_l = q_ld.map(|x| x.truncate());
    let deflection = forward.q_m.map(|x| x.truncate()) - q_l;
    Demand {
        torque: order(0, &forward.u_m),
        torque_rate: order(1, &forward.u_m),
        velocity: order(1, &q_l),
        deflection: order(0, &deflection),
        position: order(0, &q_l),
    }
}
