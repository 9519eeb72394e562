//! Dry friction: Coulomb and Stribeck.

use flexure_core::linalg::Vector;

/// Dry friction on one side of the springs. Sliding at v it has F(v) = F_C + (F_S − F_C) exp(−(v/v_S)²) against the motion;
/// at rest it holds against whatever is at most F_S. Armstrong-Hélouvry, Dupont & Canudas de Wit, *Automatica* 30 (1994).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<const N: usize> {
    /// F_C ≥ 0, torque at speeds far beyond v_S [N m].
    pub coulomb: Vector<f64, N>,
    /// F_S ≥ F_C, largest torque at rest [N m].
    pub stiction: Vector<f64, N>,
    /// v_S > 0, speed at which most of the excess at rest is gone [rad/s].
    pub stribeck_velocity: Vector<f64, N>,
}

impl<const N: usize> Friction<N> {
    /// No friction.
    pub const NONE: Self = Self::coulomb(Vector([0.0; N]));

    /// The same torque at rest as at any speed [N m].
    pub const fn coulomb(torque: Vector<f64, N>) -> Self {
        Self { coulomb: torque, stiction: torque, stribeck_velocity: Vector([1.0; N]) }
    }

    /// Whether there is none on any joint.
    pub fn is_none(&self) -> bool {
        self.stiction.iter().chain(self.coulomb.iter()).all(|torque| torque == 0.0)
    }

    /// Torque F(v) of joint `i` at a speed |v| [N m].
    #[inline]
    pub fn torque(&self, i: usize, speed: f64) -> f64 {
        let excess = self.stiction[i] - self.coulomb[i];
        if excess == 0.0 {
            return self.coulomb[i];
        }
        let relative = speed / self.stribeck_velocity[i];
        self.coulomb[i] + excess * (-relative * relative).exp()
    }
}
