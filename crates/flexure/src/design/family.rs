//! Gains as functions of a few numbers that a search can move.

use crate::design::least::Least;
use crate::laws::{Controller, Drive, VcbcGains};

/// A law whose gains follow from a few logarithms: the first makes the whole loop faster, the others are factors on single gains.
///
/// The metric of the motors of v-CBC may besides be balanced: motor errors are exchanged with link momenta at K / √(Π_m m), with motor
/// momenta at √(Π_m / M_m), and both are equally fast where Π_m = K √(M_m / m), m being the links with the other joints free. The last
/// number is the power of that root, joint by joint.
#[derive(Clone, Debug)]
pub(super) struct Family {
    base: Controller,
    /// By which power of the speed each gain grows.
    powers: Vec<i32>,
    /// The gains that have a factor of their own.
    own: Vec<usize>,
    /// What proves a rate, for v-CBC of which one is asked.
    least: Option<Least>,
    /// Of each joint the logarithm of √(M_m / m).
    balance: Vec<f64>,
}

/// How fast a member of a family shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pace {
    /// As fast as its first number says.
    Free,
    /// The same, with gains that prove this rate at least [1/s].
    AtLeast(f64),
    /// The first number is the logarithm of the rate that is to be proved [1/s], by no more than that takes.
    Proved,
}

/// Gains of v-CBC by their keys: shaping follows from the speed.
const EXCHANGE: &str = "motor.metric";
const MOTOR_DAMPING: &str = "motor.damping";
const OWN: [&str; 4] = ["link.metric", "link.damping", EXCHANGE, MOTOR_DAMPING];

impl Family {
    /// Around `base`, for joints that move `drives`; `least` says what proves a rate.
    pub fn new(base: Controller, least: Option<Least>, drives: &[Drive]) -> Self {
        let is_vcbc = matches!(base, Controller::Vcbc(_));
        let gains = base.gains();
        let is_own = |path: &str| !is_vcbc || OWN.contains(&path);
        let own = gains.iter().enumerate().filter(|(_, (path, _))| is_own(path)).map(|(i, _)| i).collect();
        let powers = base.speed_powers();
        let balance =
            drives.iter().map(|drive| 0.5 * (drive.motor_inertia / drive.free_inertia).ln()).collect();
        Self { base, powers, own, least, balance }
    }

    /// Numbers that a member follows from.
    pub fn dimension(&self) -> usize {
        1 + self.own.len() + usize::from(self.is_vcbc())
    }

    /// Whether it is of v-CBC.
    pub fn is_vcbc(&self) -> bool {
        matches!(self.base, Controller::Vcbc(_))
    }

    /// A member's numbers: how fast, and, of v-CBC, the factors on metric and damping of the motors, and the power of the balance.
    pub fn numbers(&self, speed: f64, [metric, damping, balance]: [f64; 3]) -> Vec<f64> {
        let mut x = vec![0.0; self.dimension()];
        x[0] = speed;
        if self.is_vcbc() {
            let gains = self.base.gains();
            for (i, gain) in self.own.iter().enumerate() {
                match gains[*gain].0.as_str() {
                    EXCHANGE => x[1 + i] = metric,
                    MOTOR_DAMPING => x[1 + i] = damping,
                    _ => {}
                }
            }
            x[1 + self.own.len()] = balance;
        }
        x
    }

    /// The member at `x`.
    pub fn at(&self, x: &[f64], pace: Pace) -> Controller {
        let speed = if pace == Pace::Proved { x[0] - self.base_rate() } else { x[0] };
        let gains = self.base.gains();
        let member = gains.iter().zip(&self.powers).enumerate().map(|(gain, ((path, base), power))| {
            let factor = self.own.iter().position(|own| *own == gain).map_or(0.0, |i| x[1 + i]);
            let factor = f64::from(*power) * speed + factor;
            let balance = if self.is_vcbc() && path == EXCHANGE { x[1 + self.own.len()] } else { 0.0 };
            let balanced = |(value, root): (&f64, &f64)| value * (factor + balance * root).exp();
            base.iter().zip(&self.balance).map(balanced).collect()
        });
        let member = self.base.with_gains(&member.collect::<Vec<Vec<f64>>>());
        match (member, &self.least, pace) {
            (Controller::Vcbc(gains), Some(least), Pace::AtLeast(rate)) => {
                Controller::Vcbc(Box::new(least.raised(&gains, rate)))
            }
            (Controller::Vcbc(gains), Some(least), Pace::Proved) => {
                Controller::Vcbc(Box::new(least.exactly(&gains, x[0].exp())))
            }
            (member, ..) => member,
        }
    }

    /// The logarithm of the rate that members at speed 0 shape their errors with: the smallest Λ of the links [1/s].
    pub fn base_rate(&self) -> f64 {
        let Controller::Vcbc(gains) = &self.base else { return 0.0 };
        smallest(gains).ln()
    }
}

fn smallest(gains: &VcbcGains) -> f64 {
    gains.link.shaping.iter().copied().fold(f64::INFINITY, f64::min)
}
