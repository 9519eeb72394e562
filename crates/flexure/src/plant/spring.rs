//! Springs that are not linear: hardening, with play, with hysteresis.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Over, Piecewise};

use crate::plant::plant::Plant;

/// Springs that slip inside, one in parallel with each joint's own (Prandtl's elastic-perfectly-plastic element): its torque
/// z follows the deflection with slope `stiffness` and stays within ±`yield_torque`. A cycle of amplitude A in deflection
/// takes 4 τ_y (A − τ_y / k_h) out of the motion if A > τ_y / k_h, else nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis<const N: usize> {
    /// k_h ≥ 0 [N m/rad].
    pub stiffness: Vector<f64, N>,
    /// τ_y ≥ 0 [N m].
    pub yield_torque: Vector<f64, N>,
}

impl<const N: usize> Hysteresis<N> {
    /// No hysteresis.
    pub const NONE: Self = Self { stiffness: Vector([0.0; N]), yield_torque: Vector([0.0; N]) };

    /// Whether there is none in any joint.
    pub fn is_none(&self) -> bool {
        (0..N).all(|i| self.stiffness[i] == 0.0 || self.yield_torque[i] == 0.0)
    }

    /// Torque of joint `i` [N m] after `torque` and a further deflection in rad, were it elastic.
    #[inline]
    pub(crate) fn elastic(&self, i: usize, torque: f64, deflection: f64) -> f64 {
        torque + self.stiffness[i] * deflection
    }

    /// `torque` [N m] of joint `i` within what it can bear.
    #[inline]
    pub(crate) fn yielded(&self, i: usize, torque: f64) -> f64 {
        torque.min(self.yield_torque[i]).max(-self.yield_torque[i])
    }

    /// Torque of joint `i` [N m] after `torque` and a further deflection in rad in one direction, and the work in J that
    /// slipping took.
    #[inline]
    pub(crate) fn after(&self, i: usize, torque: f64, deflection: f64) -> (f64, f64) {
        if self.stiffness[i] == 0.0 {
            return (0.0, 0.0);
        }
        let elastic = self.elastic(i, torque, deflection);
        let after = self.yielded(i, elastic);
        (after, after * (elastic - after) / self.stiffness[i])
    }

    /// Energy in J that torques [N m] keep in the elements.
    pub fn energy(&self, torque: &Vector<f64, N>) -> f64 {
        (0..N)
            .filter(|&i| self.stiffness[i] > 0.0)
            .map(|i| 0.5 * torque[i] * torque[i] / self.stiffness[i])
            .sum()
    }
}

/// The part of the springs that is a function of the deflection.
impl<C: Piecewise + Over<C>, L: Links<C, N>, const N: usize> Plant<L, N, C> {
    /// Torque K ε + k ε³ of the springs on the links [N m]; the motors feel its opposite. ε is the deflection beyond the
    /// play. Hysteresis is not in it: its torque depends on the past.
    pub fn spring_torque(&self, x: &Motion<C, N>) -> Vector<C, N> {
        self.robot.spring_torque(&x.q_l, &x.q_m) + self.nonlinear_torque(x)
    }

    /// What [`spring_torque`](Self::spring_torque) has beyond K ζ [N m].
    #[inline]
    pub(crate) fn nonlinear_torque<T: Over<C> + Piecewise>(&self, x: &Motion<T, N>) -> Vector<T, N> {
        let slack = self.slack(x);
        let zeta = x.deflection();
        Vector::from_fn(|i| self.hardening(i, zeta[i] - slack[i]) - slack[i].scale(self.robot.stiffness[i]))
    }

    /// Slope K + 3 k ε² of the spring torque [N m/rad], none inside the play.
    #[inline]
    pub(crate) fn tangent_stiffness(&self, x: &Motion<C, N>) -> Vector<C, N> {
        let zeta = x.deflection();
        let slack = self.slack(x);
        Vector::from_fn(|i| {
            let wound = zeta[i] - slack[i];
            let slope = self.robot.stiffness[i] + C::from_f64(3.0) * self.spring_hardening[i] * wound * wound;
            (zeta[i].abs() - C::from_f64(0.5 * self.spring_gap[i])).select(slope, C::ZERO)
        })
    }

    /// Energy in J that hardening adds to the springs less what play takes out of them.
    pub(crate) fn nonlinear_energy(&self, x: &Motion<C, N>) -> C {
        let slack = self.slack(x);
        let zeta = x.deflection();
        let wound = zeta - slack;
        let hardening = Vector::from_fn(|i| self.hardening(i, wound[i])).dot(&wound);
        // ½ K (ζ² − ε²)
        let play = self.robot.stiffness.diag_mul(&slack).dot(&(zeta + wound));
        C::from_f64(0.25) * hardening - C::from_f64(0.5) * play
    }

    /// k ε³ of joint `i` [N m].
    #[inline]
    fn hardening<T: Over<C>>(&self, i: usize, wound: T) -> T {
        wound.scale(self.spring_hardening[i]) * wound * wound
    }

    /// The part of the deflections that winds no spring, in rad.
    #[inline]
    fn slack<T: Over<C> + Piecewise>(&self, x: &Motion<T, N>) -> Vector<T, N> {
        let zeta = x.deflection();
        Vector::from_fn(|i| {
            let half = 0.5 * self.spring_gap[i];
            if half == 0.0 {
                return T::ZERO;
            }
            // Where the deflection is on an edge it winds the spring: without play every deflection does.
            Piecewise::min(T::from_f64(half), Piecewise::max(T::from_f64(-half), zeta[i]))
        })
    }
}

impl<L: Links<f64, N>, const N: usize> Plant<L, N> {
    /// Deflection in rad at which the springs give `torque` [N m]; the middle of the play for none.
    pub fn deflection_under(&self, torque: &Vector<f64, N>) -> Vector<f64, N> {
        Vector::from_fn(|i| {
            deflection(torque[i], self.robot.stiffness[i], self.spring_hardening[i], self.spring_gap[i])
        })
    }
}

/// Deflection in rad at which a spring K ε + k ε³ with play gives `torque` [N m]; the middle of the play for none.
pub(crate) fn deflection(torque: f64, stiffness: f64, hardening: f64, play: f64) -> f64 {
    // Newton's iteration from beyond the root of a function that is convex there: monotone.
    let wound = (0..100).fold(torque / stiffness, |wound, _| {
        let square = hardening * wound * wound;
        wound - ((stiffness + square) * wound - torque) / (stiffness + 3.0 * square)
    });
    if wound == 0.0 { wound } else { wound + 0.5 * play * wound.signum() }
}
