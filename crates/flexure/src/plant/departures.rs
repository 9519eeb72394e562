//! What the model of a plant leaves out of its joints, as slices.

use crate::plant::friction::Friction;
use crate::plant::plant::Plant;

/// What joints have that the model leaves out, to be changed: an entry per joint each, in units as in [`Plant`].
pub(crate) struct Departures<'a> {
    /// k in K ε + k ε³.
    pub spring_hardening: &'a mut [f64],
    /// All of the play.
    pub spring_gap: &'a mut [f64],
    /// k_h of springs that slip inside.
    pub hysteresis_stiffness: &'a mut [f64],
    /// τ_y at which they do.
    pub yield_torque: &'a mut [f64],
    /// Of the links.
    pub link_friction: DryFriction<'a>,
    /// Of the motors.
    pub motor_friction: DryFriction<'a>,
    /// Torque that motors give for each N m that their drives believe to give.
    pub torque_gain: &'a mut [f64],
}

/// [`Friction`] as slices.
pub(crate) struct DryFriction<'a> {
    /// F_C.
    pub coulomb: &'a mut [f64],
    /// F_S.
    pub stiction: &'a mut [f64],
    /// v_S.
    pub stribeck_velocity: &'a mut [f64],
}

impl<L, const N: usize> Plant<L, N> {
    /// Of the first `joints` joints.
    ///
    /// # Panics
    /// If those are more than `N`.
    pub(crate) fn departures(&mut self, joints: usize) -> Departures<'_> {
        Departures {
            spring_hardening: &mut self.spring_hardening.0[..joints],
            spring_gap: &mut self.spring_gap.0[..joints],
            hysteresis_stiffness: &mut self.hysteresis.stiffness.0[..joints],
            yield_torque: &mut self.hysteresis.yield_torque.0[..joints],
            link_friction: self.link_friction.slices(joints),
            motor_friction: self.motor_friction.slices(joints),
            torque_gain: &mut self.torque_gain.0[..joints],
        }
    }
}

impl<const N: usize> Friction<N> {
    fn slices(&mut self, joints: usize) -> DryFriction<'_> {
        DryFriction {
            coulomb: &mut self.coulomb.0[..joints],
            stiction: &mut self.stiction.0[..joints],
            stribeck_velocity: &mut self.stribeck_velocity.0[..joints],
        }
    }
}
