//! What a robot must do to follow a reference.

use flexure_core::reference::Reference as _;

use crate::feasible::at_speed;
use crate::feasible::bounds::{Bound, LimitKind};
use crate::files::Problems;
use crate::references::AnyReference;
use crate::robot::Arm;
use crate::robot::sized::sized;
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
    pub(super) position: Vec<f64>,
}

impl Demand {
    /// Value of the quantity that `bound` limits, in its unit.
    pub fn of(&self, bound: &Bound) -> f64 {
        let values = match bound.quantity {
            LimitKind::Torque => &self.torque,
            LimitKind::TorqueRate => &self.torque_rate,
            LimitKind::Velocity => &self.velocity,
            LimitKind::Deflection => &self.deflection,
            LimitKind::Position => &self.position,
        };
        values[bound.joint]
    }
}

/// Hands robot and reference of `scenario` to `then`.
pub fn with_track<R>(scenario: &Scenario, then: impl Fn(&dyn Track) -> R) -> Result<R, Problems> {
    let arm = scenario.robot.arm()?;
    Ok(sized!(&scenario.robot, L, N => {
        then(&Pair { arm, reference: at_speed::<N>(scenario, 1.0)? })
    }))
}

struct Pair<const N: usize> {
    arm: Box<dyn Arm>,
    reference: AnyReference<f64, N>,
}

impl<const N: usize> Track for Pair<N> {
    fn at_speed(&self, speed: f64) -> Box<Demands<'_>> {
        let reference = self.reference.paced(speed);
        let n = self.arm.joints();
        Box::new(move |t| {
            let q_l = reference.at::<6>(t);
            let series: Vec<[f64; 6]> =
                q_l.iter().take(n).map(|q| std::array::from_fn(|k| q.coefficient(k))).collect();
            demand(&*self.arm, &series)
        })
    }
}

/// What a motion of the links takes at an instant, given by its Taylor coefficients: by exact inverse dynamics.
fn demand(arm: &dyn Arm, q_l: &[[f64; 6]]) -> Demand {
    let (mut q_m, mut u_m) = (vec![[0.0; 4]; q_l.len()], vec![[0.0; 2]; q_l.len()]);
    arm.feed_forward(q_l, &mut q_m, &mut u_m).expect("a series a joint");
    let of = |k: usize| q_l.iter().map(|q| q[k]).collect();
    Demand {
        torque: u_m.iter().map(|u| u[0]).collect(),
        torque_rate: u_m.iter().map(|u| u[1]).collect(),
        velocity: of(1),
        deflection: q_m.iter().zip(q_l).map(|(q_m, q_l)| q_m[0] - q_l[0]).collect(),
        position: of(0),
    }
}
