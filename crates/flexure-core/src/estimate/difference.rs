//! Velocities from encoders by filtered differences.

use super::reading::nan;
use super::{Estimator, LowPass};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Velocities of both sides by [`LowPass`] filtered differences of both encoders; positions pass through. It knows nothing of
/// the robot. The paper's choice.
///
/// Where an encoder delivers no number the estimate of that joint and side is NaN; with the next number it starts over at rest.
#[derive(Clone, Copy, Debug)]
pub struct FilteredDifference<C, const N: usize> {
    filter: LowPass<C>,
    link: Vector<Memory<C>, N>,
    motor: Vector<Memory<C>, N>,
}

/// What the recursion remembers of one encoder.
#[derive(Clone, Copy, Debug)]
struct Memory<C> {
    /// Last position in rad.
    position: C,
    /// Last increment in rad.
    increment: C,
    /// The last two velocities [rad/s], the latest first.
    velocity: [C; 2],
}

impl<C: Float, const N: usize> FilteredDifference<C, N> {
    /// At rest at 0 until it is [started](Estimator::start) elsewhere.
    pub fn new(filter: LowPass<C>) -> Self {
        let rest = Vector([Memory::at_rest(C::ZERO); N]);
        Self { filter, link: rest, motor: rest }
    }
}

impl<C: Float> Memory<C> {
    #[inline]
    fn at_rest(position: C) -> Self {
        Self { position, increment: C::ZERO, velocity: [C::ZERO; 2] }
    }

    /// As after a long time at constant velocity.
    #[inline]
    fn moving(position: C, velocity: C, period: C) -> Self {
        Self { position, increment: velocity * period, velocity: [velocity; 2] }
    }

    /// The velocity at the next position.
    #[inline]
    fn update(&mut self, filter: &LowPass<C>, position: C) -> C {
        let increment = position - self.position;
        let [[a_1, a_2], [b_0, b_1]] = [filter.feedback, filter.forward];
        let [v_1, v_2] = self.velocity;
        let v = a_1 * v_1 + a_2 * v_2 + b_0 * increment + b_1 * self.increment;
        if v.is_finite() {
            *self = Self { position, increment, velocity: [v, v_1] };
            v
        } else {
            *self = Self::at_rest(position);
            if position.is_finite() { C::ZERO } else { nan() }
        }
    }
}

impl<C: Float, const N: usize> Estimator<C, N> for FilteredDifference<C, N> {
    fn start(&mut self, x: &Motion<C, N>) {
        let period = self.filter.period;
        let side =
            |q: &Vector<C, N>, v: &Vector<C, N>| Vector::from_fn(|i| Memory::moving(q[i], v[i], period));
        (self.link, self.motor) = (side(&x.q_l, &x.v_l), side(&x.q_m, &x.v_m));
    }

    #[inline]
    fn update<L: Links<C, N>>(
        &mut self,
        _: &Fjr<C, L, N>,
        q_l: &Vector<C, N>,
        q_m: &Vector<C, N>,
        _: &Vector<C, N>,
    ) -> Motion<C, N> {
        let filter = &self.filter;
        let v_l = Vector::from_fn(|i| self.link[i].update(filter, q_l[i]));
        let v_m = Vector::from_fn(|i| self.motor[i].update(filter, q_m[i]));
        Motion { q_l: *q_l, q_m: *q_m, v_l, v_m }
    }
}
