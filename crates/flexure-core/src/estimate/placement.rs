//! Gains for the motor encoders alone, by pole placement.

use crate::scalar::Float;

/// One joint over half a period h = T/2, with velocities as V = h v.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive<C> {
    /// J [kg m²].
    pub inertia: C,
    /// δ = h D_m / J.
    pub damping: C,
    /// κ = h² K / J.
    pub stiffness: C,
    /// h D_l [kg m²].
    pub link_damping: C,
}

/// What the residual r̄ = ȳ − q̄_m of the motor position adds to the mean rates over a period:
/// λ_q r̄ to q̇_m, λ_v r̄ to V̇_m, α r̄ − M⁻¹ β r̄ to q̇_l, γ r̄ − M⁻¹ η r̄ to V̇_l, where D_l acts on q̇_l instead of V_l.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gains<C> {
    /// λ_q.
    pub position: C,
    /// λ_v.
    pub velocity: C,
    /// α.
    pub link_position: C,
    /// β [kg m²].
    pub link_position_torque: C,
    /// γ.
    pub link_velocity: C,
    /// η [kg m²].
    pub link_velocity_torque: C,
}

impl<C: Float> Gains<C> {
    /// The model alone.
    pub const ZERO: Self = Self {
        position: C::ZERO,
        velocity: C::ZERO,
        link_position: C::ZERO,
        link_position_torque: C::ZERO,
        link_velocity: C::ZERO,
        link_velocity_torque: C::ZERO,
    };

    /// Gains that move the poles w of the error to the left by t, all joints together: with M the whole mass matrix.
    ///
    /// With e_l = κ⁻¹ (w² + (δ + λ_q) w + δ λ_q + κ + λ_v) e_m from the motors, the links leave a polynomial of order 4 in w
    /// with matrix coefficients for e_m. These gains make it, in σ = w + t,
    ///
    /// (σ² M + σ D_l + K) κ⁻¹ (σ² + σ δ + κ) − K + t D_l κ⁻¹ (σ² + σ δ),
    ///
    /// which is what links and motors have whose link springs are K + t D_l on the side of the link: passive, so that
    /// no σ has a positive real part, whatever M is.
    #[inline]
    pub fn shifting(drive: &Drive<C>, t: C) -> Self {
        let (two, three) = (C::from_f64(2.0), C::from_f64(3.0));
        let (four, five, six) = (C::from_f64(4.0), C::from_f64(5.0), C::from_f64(6.0));
        let Drive { inertia: J, damping: delta, stiffness: kappa, link_damping: D_l } = *drive;
        let t_2 = t.square();
        let by_spring = t_2 / kappa;
        Self {
            position: four * t,
            velocity: six * t_2 - t * delta,
            link_position: two * t + by_spring * (three * delta + four * t),
            link_position_torque: two * t * J + by_spring * D_l,
            link_velocity: t_2 + by_spring * t * (delta + t),
            link_velocity_torque: J * t * (two * delta + five * t)
                - D_l * (t + two * by_spring * (delta + t)),
        }
    }
}
