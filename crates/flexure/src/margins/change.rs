//! A scenario with a little more of one imperfection.

use crate::imperfections::{Delay, Factors, Imperfection, ModelError, Noise, TorqueGain};
use crate::scenario::Scenario;

/// A change of a scenario, with how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Delay from command to torque, added, in s.
    Delay(f64),
    /// Factor on the motor torque.
    TorqueGain(f64),
    /// Factor on the springs of the simulated robot.
    Stiffness(f64),
    /// Factor on masses and inertias of its links.
    Mass(f64),
    /// Standard deviation of white noise on all measured positions, added, in rad.
    Noise(f64),
}

impl Change {
    /// `scenario` with this change, on top of what it has.
    pub fn of(self, scenario: &Scenario) -> Scenario {
        let mut changed = scenario.clone();
        let joints = scenario.robot.joint_count();
        let is_there =
            changed.imperfections.iter_mut().any(|imperfection| self.enter(imperfection).is_some());
        if !is_there {
            changed.imperfections.push(self.alone(joints));
        }
        changed
    }

    /// Adds to `imperfection` if it is of this kind; none if not.
    fn enter(self, imperfection: &mut Imperfection) -> Option<()> {
        let multiply = |values: &mut Vec<f64>, factor: f64| values.iter_mut().for_each(|x| *x *= factor);
        match self {
            Self::Delay(more) => imperfection.of_mut::<Delay>()?.actuation += more,
            Self::TorqueGain(factor) => multiply(&mut imperfection.of_mut::<TorqueGain>()?.factor, factor),
            Self::Stiffness(factor) => {
                multiply(&mut imperfection.of_mut::<ModelError>()?.factors.stiffness, factor);
            }
            Self::Mass(factor) => multiply(&mut imperfection.of_mut::<ModelError>()?.factors.mass, factor),
            Self::Noise(more) => {
                let Noise { link, motor, .. } = imperfection.of_mut()?;
                for deviation in link.iter_mut().chain(motor) {
                    *deviation = deviation.hypot(more);
                }
            }
        }
        Some(())
    }

    /// The imperfection that is this change and nothing else.
    fn alone(self, joints: usize) -> Imperfection {
        let all = |x: f64| vec![x; joints];
        match self {
            Self::Delay(actuation) => Imperfection::Delay(Delay { computation: 0.0, actuation }),
            Self::TorqueGain(factor) => Imperfection::TorqueGain(TorqueGain { factor: all(factor) }),
            Self::Stiffness(factor) => {
                model_error(Factors { stiffness: all(factor), ..Factors::ones(joints) })
            }
            Self::Mass(factor) => model_error(Factors { mass: all(factor), ..Factors::ones(joints) }),
            Self::Noise(deviation) => Imperfection::Noise(Noise {
                link: all(deviation),
                motor: all(deviation),
                link_velocity: all(0.0),
                motor_velocity: all(0.0),
            }),
        }
    }
}

fn model_error(factors: Factors) -> Imperfection {
    Imperfection::ModelError(ModelError { robot: None, factors, payload: None })
}
