//! What motions and torques at the start of a piece make of motions at its end.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::fundamental::fundamental;

/// Of ẋ = J x + J_u u with rates over a box, u held.
pub struct Flow {
    /// What motions and torques at the start make of the motion at the end, and how the path would move on if nothing changed.
    pub at_end: Dense<Interval>,
    /// From above, what a motion at any time makes of one at any later time.
    pub between: Dense<f64>,
}

/// For `length` in s, with the slopes `by_links` of the links' accelerations and the rates `path_rates` of a path where it begins; none if that is too long.
///
/// X(1) of ξ' = `length` S J S⁻¹ ξ for motions, torques and the number 1, S a power of two for velocities so that no entry is large.
pub fn flow(
    system: &dyn TrackingLoop,
    by_links: &Dense<Interval>,
    path_rates: &[Interval],
    length: Interval,
) -> Option<Flow> {
    let (size, half, n) = (path_rates.len(), path_rates.len() / 2, path_rates.len() / 4);
    let drive = system.drive();
    let by_motors = |i: usize, j: usize| {
        let torque = match j.checked_sub(i) {
            Some(0) => drive.stiffness[i],
            Some(by) if by == n => -drive.stiffness[i],
            Some(by) if by == half + n => -drive.motor_damping[i],
            Some(by) if by == size => Interval::ONE,
            _ => return Interval::ZERO,
        };
        torque / drive.motor_inertia[i]
    };
    let entry = |i: usize, j: usize| match (i, j) {
        (i, _) if i >= size => Interval::ZERO,
        (i, j) if j == size + n => path_rates[i],
        (i, j) if i < half => {
            if j == half + i {
                Interval::ONE
            } else {
                Interval::ZERO
            }
        }
        (i, j) if i < half + n => {
            if j < 3 * n {
                by_links[(i - half, j)]
            } else {
                Interval::ZERO
            }
        }
        (i, j) => by_motors(i - half - n, j),
    };
    let scale = length.midpoint().log2().round().exp2();
    let of = |i: usize| if (half..size).contains(&i) { Interval::point(scale) } else { Interval::ONE };
    let rates = Dense::from_fn(size + n + 1, size + n + 1, |i, j| length * of(i) * entry(i, j) / of(j));
    let found = fundamental(&rates)?;
    let at_end = Dense::from_fn(size, size + n + 1, |i, j| found.at_end[(i, j)] * of(j) / of(i));
    let between =
        Dense::from_fn(size, size, |i, j| (Interval::point(found.between[(i, j)]) * of(j) / of(i)).hi());
    Some(Flow { at_end, between })
}
