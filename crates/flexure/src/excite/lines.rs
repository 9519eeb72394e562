//! The lines of a joint's multisine: which frequencies, and what of each limit a line takes.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::excite::joint::Joint;
use crate::linalg::Complex;

/// Lines of a joint.
const COUNT: usize = 16;

/// Slowest line where there is a choice \[Hz\].
const SLOWEST: f64 = 0.2;

/// Fastest line over the joint's swing.
const BEYOND: f64 = 1.5;

/// Fastest line over the rate of control.
const SAMPLED: f64 = 0.1;

/// One sine of the links' reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Amplitude \[rad\].
    pub amplitude: f64,
    /// Phase when the run begins \[rad\].
    pub phase: f64,
}

/// What a joint may use: magnitudes about its posture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    /// Of the link position \[rad\].
    pub position: f64,
    /// Of the velocity [rad/s].
    pub velocity: f64,
    /// Of the motor torque, beside what carries the weight [N m].
    pub torque: f64,
    /// Of the deflection, beside what carries the weight \[rad\].
    pub deflection: f64,
}

/// Shares of the limits that a link amplitude of 1 rad at `omega` takes, as phasors: position, velocity, torque, deflection.
pub(super) fn shares(joint: &Joint, allowed: &Allowed, omega: f64) -> [Complex; 4] {
    let [link, motor] = joint.gains(omega);
    let unit = Complex::real(1.0);
    let torque = unit / link;
    [
        unit.scaled(allowed.position.recip()),
        Complex { re: 0.0, im: omega / allowed.velocity },
        torque.scaled(allowed.torque.recip()),
        (motor / link - unit).scaled(allowed.deflection.recip()),
    ]
}

/// Harmonics of 1/`period` for joint `index` of `joints`: spread evenly in their logarithms, and no other joint's.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least one, far below 2³²")]
pub(super) fn harmonics(
    joint: &Joint,
    index: usize,
    joints: usize,
    period: f64,
    control_period: f64,
) -> Vec<usize> {
    let fastest = (BEYOND * joint.resonance() / TAU).min(SAMPLED / control_period).max(2.0 * SLOWEST);
    let own = |rank: usize| index + 1 + rank * joints;
    let nearest = |frequency: f64| {
        ((frequency * period - (index + 1) as f64) / joints as f64).round().max(0.0) as usize
    };
    let mut ranks: Vec<usize> = (0..COUNT)
        .map(|k| nearest(SLOWEST * (fastest / SLOWEST).powf(k as f64 / (COUNT - 1) as f64)))
        .collect();
    ranks.sort_unstable();
    // Lines that fall on each other move up, as far as there is room.
    for k in 1..ranks.len() {
        ranks[k] = ranks[k].max(ranks[k - 1] + 1);
    }
    let last = nearest(fastest);
    ranks.into_iter().filter(|rank| *rank <= last).map(own).collect()
}
