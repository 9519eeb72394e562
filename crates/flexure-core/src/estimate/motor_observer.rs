//! Links that no encoder sees, from motor encoders and the model of the robot.

use super::prediction::{Correction, predict};
use super::reading::{at_rest, is_finite, where_read};
use super::{Estimator, positive};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Observer on the flexible-joint model with motor encoders only. It sees the links by what their springs do to the motors.
///
/// The model is integrated by the trapezoidal rule with the motor residual fed back inside it, gains by pole placement
/// joint by joint with the current diagonal of the mass matrix: every pole z of the sampled joint becomes ρ z, ρ = e^{−ωT}.
/// Where the robot has slow modes the error goes like e^{−ωt}, and what is fast by itself stays so. Coupling of the joints through
/// the mass matrix is in the prediction but not in the gains, and a link's posture is where the estimate believes it: convergence is local.
#[derive(Clone, Copy, Debug)]
pub struct MotorObserver<C, const N: usize> {
    period: C,
    /// tanh(ωT/2).
    shift: Vector<C, N>,
    /// Last motor positions in rad.
    reading: Vector<C, N>,
    estimate: Motion<C, N>,
}

impl<C: Float, const N: usize> MotorObserver<C, N> {
    /// `bandwidth` is ω per joint [rad/s], `period` the control period T in s. `None` unless all are positive.
    ///
    /// At rest at 0 until it is [started](Estimator::start) elsewhere.
    pub fn new(bandwidth: &Vector<C, N>, period: C) -> Option<Self> {
        if !(positive(period) && bandwidth.iter().all(positive)) {
            return None;
        }
        let half = period * C::from_ratio(1, 2);
        Some(Self {
            period,
            shift: bandwidth.map(|w| (w * half).tanh()),
            reading: Vector::ZERO,
            estimate: Motion::at_rest(Vector::ZERO),
        })
    }
}

/// The estimated [`Motion`], then the last `reading` of the motors in rad.
impl<C: Float, const N: usize> Memory<C> for MotorObserver<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        self.estimate.memory(port);
        port.joints("reading", "rad", &mut self.reading.0);
    }
}

impl<C: Float, const N: usize> Estimator<C, N> for MotorObserver<C, N> {
    fn start(&mut self, x: &Motion<C, N>) {
        (self.estimate, self.reading) = (*x, x.q_m);
    }

    #[inline]
    fn update<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        _: &Vector<C, N>,
        q_m: &Vector<C, N>,
        u_m: &Vector<C, N>,
    ) -> Motion<C, N> {
        // Where nothing was read, what the motor would have done.
        let read = Vector::from_fn(|i| {
            if q_m[i].is_finite() { q_m[i] } else { self.reading[i] + self.period * self.estimate.v_m[i] }
        });
        let reading = (read + self.reading).scaled(C::from_ratio(1, 2));
        let correction = Correction { reading: &reading, shift: &self.shift };
        let x = predict(robot, &self.estimate, u_m, self.period, Some(&correction));
        if is_finite(&x) {
            (self.estimate, self.reading) = (x, read);
        } else {
            let rest = at_rest(q_m, q_m);
            (self.estimate, self.reading) = (rest, rest.q_m);
        }
        Motion {
            q_l: where_read(&x.q_l, q_m),
            q_m: where_read(&x.q_m, q_m),
            v_l: where_read(&x.v_l, q_m),
            v_m: where_read(&x.v_m, q_m),
        }
    }
}
