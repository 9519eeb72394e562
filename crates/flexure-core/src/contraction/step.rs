//! Solutions, a step at a time.

use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

use super::Dynamics;

/// The state after a step of `h` in s from `x` at `t`: the classical Runge–Kutta method of order 4.
///
/// On dual numbers it moves variations along with the solution, exactly as a step of the [`Prolonged`](super::Prolonged) system does.
#[inline]
pub fn runge_kutta<C: Scalar, T: Over<C> + Piecewise, const N: usize>(
    system: &impl Dynamics<C, N>,
    x: &Vector<T, N>,
    t: T,
    h: T,
) -> Vector<T, N> {
    let half = h * T::from_f64(0.5);
    let a = system.rate(x, t);
    let b = system.rate(&(*x + a.scaled(half)), t + half);
    let c = system.rate(&(*x + b.scaled(half)), t + half);
    let d = system.rate(&(*x + c.scaled(h)), t + h);
    *x + (a + b + b + c + c + d).scaled(h * T::from_ratio(1, 6))
}
