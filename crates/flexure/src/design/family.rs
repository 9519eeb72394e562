//! Gains as functions of a few numbers that a search can move.

use crate::design::least::Least;
use crate::laws::{Controller, Drive, VcbcGains};

/// A law whose gains follow from a few logarithms: the first makes the whole loop faster, the others are factors on single gains.
#[derive(Clone, Debug)]
pub(super) struct Family {
    base: Controller,
    /// By which power of the speed each gain grows.
    powers: Vec<i32>,
    /// The gains that have a factor of their own.
    own: Vec<usize>,
    /// What proves a rate, for v-CBC.
    least: Option<Least>,
    /// Of v-CBC, the logarithm of √(M_m / m) of each joint, m its links with the other joints free: with that factor on the motor's metric
    /// motor errors are exchanged with link momenta as fast as with motor momenta.
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

/// The metric of the motors.
const EXCHANGE: &str = "motor.metric";

/// Gains of v-CBC that have a factor of their own: the metrics, which no rate depends on. Shaping and damping follow from the speed.
const METRICS: &str = ".metric";

impl Family {
    /// Around `base`; `least` says what proves a rate.
    pub fn new(base: Controller, least: Option<Least>, drives: &[Drive]) -> Self {
        let balance =
            drives.iter().map(|drive| 0.5 * (drive.motor_inertia / drive.free_inertia).ln()).collect();
        let gains = base.gains();
        let is_vcbc = matches!(base, Controller::Vcbc(_));
        let is_own = |path: &str| !is_vcbc || path.ends_with(METRICS);
        let own = gains.iter().enumerate().filter(|(_, (path, _))| is_own(path)).map(|(i, _)| i).collect();
        let powers = base.speed_powers();
        Self { base, powers, own, least, balance }
    }

    /// Numbers that a member follows from.
    pub fn dimension(&self) -> usize {
        1 + self.own.len() + usize::from(self.exchange().is_some())
    }

    /// Which of them says how far the metrics of the motors are balanced, if there is one.
    pub fn balance(&self) -> Option<usize> {
        self.exchange().map(|_| 1 + self.own.len())
    }

    /// Which of them is the factor of a motor's metric, if there is one: that of the exchange between motor errors and link momenta.
    pub fn exchange(&self) -> Option<usize> {
        let gains = self.base.gains();
        self.own.iter().position(|&gain| gains[gain].0 == EXCHANGE).map(|i| 1 + i)
    }

    /// The member at `x`.
    pub fn at(&self, x: &[f64], pace: Pace) -> Controller {
        let (first, own) = x.split_first().expect("at least the speed");
        let speed = if pace == Pace::Proved { self.ratio(*first) } else { *first };
        let gains = self.base.gains();
        let mut values: Vec<Vec<f64>> = Vec::with_capacity(gains.len());
        for (gain, ((_, base), power)) in gains.iter().zip(&self.powers).enumerate() {
            let factor = self.own.iter().position(|own| *own == gain).map_or(0.0, |i| own[i]);
            let factor = (f64::from(*power) * speed + factor).exp();
            let balanced = |joint: usize| match self.balance() {
                Some(balance) if gains[gain].0 == EXCHANGE => (x[balance] * self.balance[joint]).exp(),
                _ => 1.0,
            };
            values.push(base.iter().enumerate().map(|(i, value)| value * factor * balanced(i)).collect());
        }
        let member = self.base.with_gains(&values);
        match (member, &self.least, pace) {
            (Controller::Vcbc(gains), Some(least), Pace::AtLeast(rate)) => {
                Controller::Vcbc(Box::new(least.raised(&gains, rate)))
            }
            (Controller::Vcbc(gains), Some(least), Pace::Proved) => {
                Controller::Vcbc(Box::new(least.exactly(&gains, first.exp())))
            }
            (member, ..) => member,
        }
    }

    /// The speed at which the slowest joint of the base has the rate of this logarithm: metrics belong to it.
    fn ratio(&self, rate: f64) -> f64 {
        let Controller::Vcbc(gains) = &self.base else { return rate };
        rate - slowest(gains).ln()
    }

    /// The logarithm of the rate that members at speed zero shape their errors with.
    pub fn base_rate(&self) -> f64 {
        let Controller::Vcbc(gains) = &self.base else { return 0.0 };
        slowest(gains).ln()
    }
}

/// The smallest Λ of the links [1/s].
fn slowest(gains: &VcbcGains) -> f64 {
    gains.link.shaping.iter().copied().fold(f64::INFINITY, f64::min)
}
