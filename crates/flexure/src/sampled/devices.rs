//! What stands between motion and torque, as far as small signals see it.

use crate::imperfections::stages::split;
use crate::imperfections::{Deadline, Delay, Imperfection, Sampling, Side};
use crate::scenario::Scenario;

/// Control periods after which a pattern of slow sensors and missed instants is taken to repeat, at most: of longer ones the
/// missed instants are left out.
const LONGEST: u32 = 128;

/// Sensors, computer and drives of a loop. Noise, rounding, limits and what happens by chance are no part of it: to small signals
/// around the nominal motion they are not there.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Devices {
    /// Control periods from one delivery of the sensors to the next, links and motors.
    pub sampling: [u32; 2],
    /// Each so many-th control instant is missed; none for no regular misses.
    pub every: Option<u32>,
    /// Torques that are on their way.
    pub waiting: usize,
    /// How long into a control period the torque changes in s; 0 for from its beginning.
    pub offset: f64,
    /// Control periods after which all this repeats.
    pub cycle: u32,
}

impl Devices {
    /// Those of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        let each = || scenario.imperfections.iter();
        let slow = |side: Side| {
            let slow = each().filter_map(Imperfection::of::<Sampling>);
            slow.filter(|sampling| sampling.sides.contain(side)).map(|sampling| sampling.periods).fold(1, lcm)
        };
        let sampling = Side::ALL.map(slow);
        let sensed = lcm(sampling[0], sampling[1]);
        let every = each().filter_map(Imperfection::of::<Deadline>).find_map(|deadline| match deadline {
            Deadline::Every(every) => Some(*every).filter(|every| lcm(sensed, *every) <= LONGEST),
            Deadline::Random { .. } => None,
        });
        let delay = each().filter_map(Imperfection::of::<Delay>).map(Delay::total).sum();
        let (waiting, offset) = split(delay, scenario.control_period);
        Self { sampling, every, waiting, offset, cycle: lcm(sensed, every.unwrap_or(1)) }
    }

    /// Whether the sensors of a side deliver at control instant `k` of the cycle.
    pub fn delivers(&self, side: usize, k: u32) -> bool {
        k.is_multiple_of(self.sampling[side])
    }

    /// Whether control instant `k` of the cycle is missed.
    pub fn misses(&self, k: u32) -> bool {
        self.every.is_some_and(|every| (k + 1).is_multiple_of(every))
    }
}

fn lcm(a: u32, b: u32) -> u32 {
    let gcd = |mut a: u32, mut b: u32| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    (a / gcd(a, b)).saturating_mul(b)
}
