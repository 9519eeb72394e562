//! What motions and torques at the start of a piece make of motions at its end.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::fundamental::{Coefficients, fundamental};

/// The slopes ∂a_l/∂(q_l, δ, q̇_l) of the links' accelerations during a piece of time.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// Between motions, and between them and the path, so much of the piece after its beginning: in this + that part × `change`.
    pub begin: Dense<Interval>,
    /// How they change in the piece.
    pub change: Dense<Interval>,
    /// Of all motions of the piece.
    pub anywhere: Dense<Interval>,
}

/// Of ẋ = J x + J_u u, x = (q_l, δ, q̇_l, q̇_m), u held.
pub struct Flow {
    /// What motions and torques at the start make of the motion at the end.
    pub at_end: Dense<Interval>,
    /// Where motions are at the end beside where the path begins, by mean values between them.
    pub carried: Vec<Interval>,
    /// From above, what a motion at any time makes of one at any later time.
    pub between: Dense<f64>,
}

/// For `length` in s, with the `slopes` of the links, the rates `path_rates` of a path where it begins, and motions and torques `start` beside it there; none if that is
/// too long.
///
/// X(1) of ξ' = `length` S J S⁻¹ ξ for motions, torques and the number 1, S a power of two for velocities so that no entry is large.
pub fn flow(
    system: &dyn TrackingLoop,
    slopes: &Slopes,
    path_rates: &[Interval],
    start: &[Interval],
    length: Interval,
) -> Option<Flow> {
    let (size, half, n) = (path_rates.len(), path_rates.len() / 2, path_rates.len() / 4);
    let drive = system.drive();
    // Beside those of the links' accelerations.
    let constant = |i: usize, j: usize| match (i, j) {
        (i, _) if i >= size => Interval::ZERO,
        (i, j) if j == size + n => path_rates[i],
        (i, j) if i < half && j == half + i => Interval::ONE,
        (i, j) if (n..half).contains(&i) && j == half + i - n => -Interval::ONE,
        (i, j) if i >= half + n => {
            let motor = i - half - n;
            let torque = match j.checked_sub(motor) {
                Some(by) if by == n => -drive.stiffness[motor],
                Some(by) if by == half + n => -drive.motor_damping[motor],
                Some(by) if by == size => Interval::ONE,
                _ => return Interval::ZERO,
            };
            torque / drive.motor_inertia[motor]
        }
        _ => Interval::ZERO,
    };
    let scale = length.midpoint().log2().round().exp2();
    let of = |i: usize| if (half..size).contains(&i) { Interval::point(scale) } else { Interval::ONE };
    let scaled = |by_links: &Dense<Interval>, other: &dyn Fn(usize, usize) -> Interval| {
        Dense::from_fn(size + n + 1, size + n + 1, |i, j| {
            let of_link = (half..half + n).contains(&i) && j < 3 * n;
            let entry = if of_link { by_links[(i - half, j)] } else { other(i, j) };
            length * of(i) * entry / of(j)
        })
    };
    let found = fundamental(&Coefficients {
        begin: scaled(&slopes.begin, &constant),
        change: scaled(&slopes.change, &|_, _| Interval::ZERO),
        anywhere: scaled(&slopes.anywhere, &constant),
    })?;
    let at_end = Dense::from_fn(size, size + n, |i, j| found.at_end[(i, j)] * of(j) / of(i));
    let start: Vec<_> = (0..size + n).map(|i| of(i) * start[i]).chain([Interval::ONE]).collect();
    let carried = found.anywhere(&start).iter().take(size).enumerate().map(|(i, &x)| x / of(i)).collect();
    let between =
        Dense::from_fn(size, size, |i, j| (Interval::point(found.between[(i, j)]) * of(j) / of(i)).hi());
    Some(Flow { at_end, carried, between })
}
