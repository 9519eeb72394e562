//! Velocities from encoders by filtered differences.

use super::reading::nan;
use super::{Estimator, LowPass};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Velocities of both sides by [`LowPass`] filtered differences of both encoders; positions pass through. It knows nothing of
/// the robot. The paper's choice.
///
/// Where an encoder delivers no number the estimate of that joint and side is NaN; with the next number it starts over at rest.
#[derive(Clone, Copy, Debug)]
pub struct FilteredDifference<C, const N: usize> {
    filter: LowPass<C>,
    link: Side<C, N>,
    motor: Side<C, N>,
}

/// What the recursion remembers of the encoders of one side.
#[derive(Clone, Copy, Debug)]
struct Side<C, const N: usize> {
    /// Last positions in rad.
    position: Vector<C, N>,
    /// Last increments in rad.
    increment: Vector<C, N>,
    /// The last two velocities [rad/s], the latest first.
    velocity: [Vector<C, N>; 2],
}

impl<C: Float, const N: usize> FilteredDifference<C, N> {
    /// At rest at 0 until it is [started](Estimator::start) elsewhere.
    pub fn new(filter: LowPass<C>) -> Self {
        let rest = Side::moving(&Vector::ZERO, &Vector::ZERO, filter.period);
        Self { filter, link: rest, motor: rest }
    }
}

impl<C: Float, const N: usize> Side<C, N> {
    /// As after a long time at constant velocity.
    #[inline]
    fn moving(position: &Vector<C, N>, velocity: &Vector<C, N>, period: C) -> Self {
        Self { position: *position, increment: velocity.scaled(period), velocity: [*velocity; 2] }
    }

    /// The velocities at the next positions.
    #[inline]
    fn update(&mut self, filter: &LowPass<C>, position: &Vector<C, N>) -> Vector<C, N> {
        Vector::from_fn(|i| self.update_joint(filter, i, position[i]))
    }

    /// The velocity of joint `i` at its next position.
    #[inline]
    fn update_joint(&mut self, filter: &LowPass<C>, i: usize, position: C) -> C {
        let increment = position - self.position[i];
        let [[a_1, a_2], [b_0, b_1]] = [filter.feedback, filter.forward];
        let [v_1, v_2] = self.velocity.each_mut().map(|v| &mut v[i]);
        let v = a_1 * *v_1 + a_2 * *v_2 + b_0 * increment + b_1 * self.increment[i];
        self.position[i] = position;
        if v.is_finite() {
            (self.increment[i], *v_2, *v_1) = (increment, *v_1, v);
            v
        } else {
            (self.increment[i], *v_2, *v_1) = (C::ZERO, C::ZERO, C::ZERO);
            if position.is_finite() { C::ZERO } else { nan() }
        }
    }
}

/// `link` and `motor`, each with `position` and `increment` in rad, `velocity` and `last_velocity` [rad/s].
impl<C: Float, const N: usize> Memory<C> for FilteredDifference<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.part("link", &mut self.link);
        port.part("motor", &mut self.motor);
    }
}

impl<C: Float, const N: usize> Memory<C> for Side<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        let [velocity, last_velocity] = &mut self.velocity;
        port.joints("position", "rad", &mut self.position.0);
        port.joints("increment", "rad", &mut self.increment.0);
        port.joints("velocity", "rad/s", &mut velocity.0);
        port.joints("last_velocity", "rad/s", &mut last_velocity.0);
    }
}

impl<C: Float, const N: usize> Estimator<C, N> for FilteredDifference<C, N> {
    fn start(&mut self, x: &Motion<C, N>) {
        let period = self.filter.period;
        self.link = Side::moving(&x.q_l, &x.v_l, period);
        self.motor = Side::moving(&x.q_m, &x.v_m, period);
    }

    #[inline]
    fn update<L: Links<C, N>>(
        &mut self,
        _: &Fjr<C, L, N>,
        q_l: &Vector<C, N>,
        q_m: &Vector<C, N>,
        _: &Vector<C, N>,
    ) -> Motion<C, N> {
        let v_l = self.link.update(&self.filter, q_l);
        let v_m = self.motor.update(&self.filter, q_m);
        Motion { q_l: *q_l, q_m: *q_m, v_l, v_m }
    }
}
