//! Torques that the model does not know, from momenta.

use super::positive;
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Float, Jet, Over};

/// Torques on the robot that its model does not contain: pushes, payload, friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance<C, const N: usize> {
    /// On the links [N m].
    pub link: Vector<C, N>,
    /// On the motors [N m].
    pub motor: Vector<C, N>,
}

impl<C: Float, const N: usize> Disturbance<C, N> {
    /// None.
    pub const ZERO: Self = Self { link: Vector::ZERO, motor: Vector::ZERO };
}

/// Momentum residual on both sides: what the momenta gained over a period beyond what springs, dampers, gravity and
/// motors gave, through a first-order low pass. De Luca & Mattone, *Actuator failure detection and isolation using
/// generalized momenta*, ICRA 2003, for links and motors separately.
///
/// r⁺ = ρ r + (1 − ρ) (Δp/T − f̄), ρ = e^{−ωT}: to a constant torque d the residual goes like d (1 − e^{−ωt}). No acceleration is
/// needed. Dampers enter by position increments, exactly; springs and C_lᵀ q̇_l − g by the mean of both ends of the period.
/// It is fed the torque that was applied, so that a limit that is hit looks like what it is and leaves nothing behind.
#[derive(Clone, Copy, Debug)]
pub struct DisturbanceObserver<C, const N: usize> {
    period: C,
    /// ρ.
    kept: Vector<C, N>,
    residual: Disturbance<C, N>,
    last: Option<Balance<C, N>>,
}

/// What the momentum balance needs of an instant.
#[derive(Clone, Copy, Debug)]
struct Balance<C, const N: usize> {
    q_l: Vector<C, N>,
    q_m: Vector<C, N>,
    p_l: Vector<C, N>,
    p_m: Vector<C, N>,
    /// K ζ + C_lᵀ q̇_l − g [N m].
    link: Vector<C, N>,
    /// K ζ [N m].
    spring: Vector<C, N>,
}

impl<C: Float, const N: usize> Balance<C, N> {
    /// At rest at 0, with neither springs nor gravity.
    const ZERO: Self = Self {
        q_l: Vector::ZERO,
        q_m: Vector::ZERO,
        p_l: Vector::ZERO,
        p_m: Vector::ZERO,
        link: Vector::ZERO,
        spring: Vector::ZERO,
    };

    /// Cᵀ q̇ = Ṁ q̇ − C q̇, with Ṁ q̇ from the momentum along q + q̇ t at constant q̇.
    #[inline]
    fn new<L: Links<C, N>>(robot: &Fjr<C, L, N>, x: &Motion<C, N>) -> Self {
        let momentum = robot.links.mass_mul(&x.q_l.with_rate(&x.v_l), &x.v_l.map(Jet::<C, 2>::constant));
        let bias = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        Self {
            q_l: x.q_l,
            q_m: x.q_m,
            p_l: momentum.map(|p| p.coefficient(0)),
            p_m: robot.motor_inertia.diag_mul(&x.v_m),
            link: spring + momentum.map(|p| p.coefficient(1)) - bias,
            spring,
        }
    }

    #[inline]
    fn is_finite(&self) -> bool {
        [&self.q_l, &self.q_m, &self.p_l, &self.p_m, &self.link, &self.spring]
            .iter()
            .all(|part| part.iter().all(C::is_finite))
    }
}

/// The residuals `link` and `motor` [N m]; `started`, whether there was an instant before; of that instant `q_l`, `q_m` in
/// rad, the momenta `p_l`, `p_m` [kg m²/s], the torques K ζ + C_lᵀ q̇_l − g `on_links` and K ζ of the `springs` [N m].
impl<C: Float, const N: usize> Memory<C> for DisturbanceObserver<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.joints("link", "N m", &mut self.residual.link.0);
        port.joints("motor", "N m", &mut self.residual.motor.0);
        port.optional("started", &mut self.last, Balance::ZERO, Balance::memory);
    }
}

impl<C: Float, const N: usize> Memory<C> for Balance<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.joints("q_l", "rad", &mut self.q_l.0);
        port.joints("q_m", "rad", &mut self.q_m.0);
        port.joints("p_l", "kg m²/s", &mut self.p_l.0);
        port.joints("p_m", "kg m²/s", &mut self.p_m.0);
        port.joints("on_links", "N m", &mut self.link.0);
        port.joints("springs", "N m", &mut self.spring.0);
    }
}

impl<C: Float, const N: usize> DisturbanceObserver<C, N> {
    /// `bandwidth` is ω per joint [rad/s], `period` the control period T in s. `None` unless all are positive.
    pub fn new(bandwidth: &Vector<C, N>, period: C) -> Option<Self> {
        (positive(period) && bandwidth.iter().all(positive)).then(|| Self {
            period,
            kept: bandwidth.map(|w| (-w * period).exp()),
            residual: Disturbance::ZERO,
            last: None,
        })
    }

    /// Forgets everything: the next update is the first.
    pub fn restart(&mut self) {
        (self.residual, self.last) = (Disturbance::ZERO, None);
    }

    /// The disturbance at a control instant, from the (estimated) motion there and the motor torque that was applied since
    /// the last instant [N m]. A motion that is not finite starts it over.
    #[inline]
    pub fn update<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        x: &Motion<C, N>,
        u_m: &Vector<C, N>,
    ) -> Disturbance<C, N> {
        let now = Balance::new(robot, x);
        if !now.is_finite() {
            self.restart();
            return self.residual;
        }
        if let Some(last) = self.last.replace(now) {
            self.residual = self.filtered(&self.unexplained(robot, &last, &now, u_m));
        }
        self.residual
    }

    /// Δp/T − f̄ of a period.
    #[inline]
    fn unexplained<L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        last: &Balance<C, N>,
        now: &Balance<C, N>,
        u_m: &Vector<C, N>,
    ) -> Disturbance<C, N> {
        let (rate, half) = (self.period.recip(), C::from_ratio(1, 2));
        let damped = |p: Vector<C, N>, damping: &Vector<C, N>, moved: Vector<C, N>| {
            (p + damping.diag_mul(&moved)).scaled(rate)
        };
        Disturbance {
            link: damped(now.p_l - last.p_l, &robot.link_damping, now.q_l - last.q_l)
                - (now.link + last.link).scaled(half),
            motor: damped(now.p_m - last.p_m, &robot.motor_damping, now.q_m - last.q_m)
                + (now.spring + last.spring).scaled(half)
                - *u_m,
        }
    }

    #[inline]
    fn filtered(&self, input: &Disturbance<C, N>) -> Disturbance<C, N> {
        let mix =
            |r: &Vector<C, N>, d: &Vector<C, N>| Vector::from_fn(|i| d[i] + self.kept[i] * (r[i] - d[i]));
        Disturbance {
            link: mix(&self.residual.link, &input.link),
            motor: mix(&self.residual.motor, &input.motor),
        }
    }
}
