//! How much work strides are.

use flexure_core::model::{Links, Motion};

use crate::plant::Plant;
use crate::simulate::gauss::Order;
use crate::simulate::newton::{Anchor, StageSolver};
use crate::simulate::scheme::Scheme;

/// How much work an interval is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Effort {
    /// Equal steps across the interval, at least 1.
    pub parts: u32,
    /// Corrections of the stage equations of a step, at least 1. A single one shows no contraction, and is trusted only where nothing was
    /// left to correct.
    pub corrections: usize,
    /// Steps that an iteration matrix serves, at least 1.
    pub kept: u32,
}

impl Effort {
    /// One step an interval. Its matrix serves ten: with twenty, one stride in three hundred of a seven-joint arm is not solved by two
    /// corrections, with one it costs half as much again.
    const fn corrected(corrections: usize) -> Self {
        Self { parts: 1, corrections, kept: 10 }
    }
}

/// Fastest rate of the robot times the length of a step, below which order 4 is likely to be good for a local error of 1e-7.
const FAST: f64 = 2.0;

/// The same for order 8.
const FASTER: f64 = 4.0;

/// At which order, and with how much work, strides over `h` s from `x` are likely to be trusted; none if it pays to move `plant` by the
/// integrator at once. It looks at the springs at `x` alone, so that it is the same for every row of a sweep that starts alike.
///
/// Torques of a loop hardly excite the fastest springs: local errors of closed loops are a hundred times smaller than those of an oscillation at
/// that rate, and grow with the same power of it. So the limits are measured: along `panda-tanh-smooth` order 4 is trusted in
/// all periods of 1 ms with two corrections (rate times length 0.8), in 93 % of periods of 2 ms with three (1.6), in 28 % of 4 ms
/// (3.2), where order 8 with four corrections is in 86 %.
pub(crate) fn likely<L: Links<f64, N>, const N: usize>(
    plant: &Plant<L, N>,
    x: &Motion<f64, N>,
    h: f64,
    tolerance: f64,
) -> Option<(Order, Effort)> {
    let anchor = Anchor { q: [x.q_l, x.q_m], h };
    let fastest = StageSolver::<2, N>::new(&Scheme::gauss(), plant, anchor).fastest;
    let limit = |limit: f64, order: f64| limit * (tolerance / 1e-7).powf(1.0 / order);
    let (fast, faster) = (limit(FAST, 5.0), limit(FASTER, 9.0));
    if fastest <= 0.5 * fast {
        Some((Order::Four, Effort::corrected(2)))
    } else if fastest <= fast {
        Some((Order::Four, Effort::corrected(3)))
    } else if fastest <= faster {
        Some((Order::Eight, Effort::corrected(4)))
    } else {
        None
    }
}
