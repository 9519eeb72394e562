//! What a robot must do to follow a reference.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::reference::Reference as _;
use flexure_core::scalar::Jet;

use crate::feasible::at_speed;
use crate::feasible::bounds::{Bound, LimitKind};
use crate::files::Problems;
use crate::lanes::{self, Each, Several, WIDTH};
use crate::references::AnyReference;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::scenario::Scenario;

/// A robot and a reference, whatever their types.
pub trait Track {
    /// What follows from running along the reference at `speed`.
    fn at_speed(&self, speed: f64) -> Box<Demands<'_>>;

    /// Shows `each` the positions of the links in rad and the motor torques [N m] along the reference at `speed`, at as many `instants` as there
    /// are, a `period` in s apart, the first at 0: by exact inverse dynamics of several instants at once.
    fn torques(&self, speed: f64, period: f64, instants: u32, each: &mut dyn FnMut(&[f64], &[f64]));
}

/// Numbers along a reference, at a time in s.
pub type Demands<'a> = dyn Fn(f64) -> Demand + 'a;

/// What following the reference takes at some time, an entry per joint.
pub struct Demand {
    torque: Vec<f64>,
    torque_rate: Vec<f64>,
    velocity: Vec<f64>,
    deflection: Vec<f64>,
    position: Vec<f64>,
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
pub fn with_track<R>(scenario: &Scenario, then: impl FnOnce(&dyn Track) -> R) -> Result<R, Problems> {
    let robot = &scenario.robot;
    Ok(sized!(robot, L, N => {
        let robot = fjr::<f64, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        then(&Pair { robot, reference: at_speed::<N>(scenario, 1.0)? })
    }))
}

struct Pair<L, const N: usize> {
    robot: Fjr<f64, L, N>,
    reference: AnyReference<f64, N>,
}

impl<L: Links<f64, N>, const N: usize> Track for Pair<L, N> {
    fn at_speed(&self, speed: f64) -> Box<Demands<'_>> {
        let reference = self.reference.paced(speed);
        Box::new(move |t| demand(&self.robot, &reference.at::<6>(t)))
    }

    fn torques(&self, speed: f64, period: f64, instants: u32, each: &mut dyn FnMut(&[f64], &[f64])) {
        let reference = self.reference.paced(speed);
        let n = self.robot.links.joints();
        for first in (0..instants).step_by(WIDTH) {
            let mut k = first;
            // Beyond the last instant the register is filled with it.
            let t: Each<f64> = array::from_fn(|_| {
                let t = f64::from(k) * period;
                k = (k + 1).min(instants - 1);
                t
            });
            let q_l: Vector<Jet<Several, 5>, N> = reference.on(Jet::variable(Several::from_array(t)));
            let u_m = self.robot.inverse_dynamics::<Several, 1, 3, 5>(&q_l).u_m;
            let [positions, torques] = [q_l.map(|q_l| q_l.coefficient(0)), u_m.map(|u_m| u_m.coefficient(0))]
                .map(|vector| lanes::apart(&vector));
            for ((q_l, u_m), _) in positions.iter().zip(&torques).zip(first..instants) {
                each(&q_l.0[..n], &u_m.0[..n]);
            }
        }
    }
}

/// What the motion `q_l` of the links takes at an instant, by exact inverse dynamics.
fn demand<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, q_l: &Vector<Jet<f64, 6>, N>) -> Demand {
    let forward = robot.inverse_dynamics::<f64, 2, 4, 6>(q_l);
    let list = |of: &dyn Fn(usize) -> f64| (0..robot.links.joints()).map(of).collect();
    Demand {
        torque: list(&|i| forward.u_m[i].coefficient(0)),
        torque_rate: list(&|i| forward.u_m[i].coefficient(1)),
        velocity: list(&|i| q_l[i].coefficient(1)),
        deflection: list(&|i| forward.q_m[i].coefficient(0) - q_l[i].coefficient(0)),
        position: list(&|i| q_l[i].coefficient(0)),
    }
}

#[cfg(test)]
mod tests {
    use super::with_track;
    use crate::scenario::load_scenario;

    /// Torques of several instants at once beside those of each, with rates: they differ by rounding and by the last digits of sines in lanes.
    /// Numbers of instants that fill no register, one, and some.
    #[test]
    fn torques_of_several_instants_are_those_of_each() {
        for name in ["two-link-tanh-smooth", "panda-tanh-smooth", "pendulum-tanh"] {
            let scenario = load_scenario(name).expect("built in");
            for instants in [1, 3, 8, 1001] {
                let mut k = 0;
                let compared = with_track(&scenario, |track| {
                    let demands = track.at_speed(0.7);
                    track.torques(0.7, 2e-3, instants, &mut |positions, torques| {
                        let demand = demands(2e-3 * f64::from(k));
                        for (found, expected) in [(positions, demand.position), (torques, demand.torque)] {
                            let largest = expected.iter().fold(1.0, |most: f64, each| most.max(each.abs()));
                            for (found, expected) in found.iter().zip(&expected) {
                                let off = (found - expected).abs();
                                assert!(off < 1e-12 * largest, "{name}, instant {k}: {found} or {expected}");
                            }
                        }
                        k += 1;
                    });
                });
                compared.expect("a track");
                assert_eq!(k, instants, "{name}");
            }
        }
    }
}
