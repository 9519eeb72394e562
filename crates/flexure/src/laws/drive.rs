//! What a joint has to move, and how fast a law may be asked to move it.

/// What a joint has to move: all that starting gains depend on.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Spring constant K [N m/rad].
    pub stiffness: f64,
    /// Motor inertia [kg m²].
    pub motor_inertia: f64,
    /// Inertia of the links about the joint at q = 0, the other joints held [kg m²].
    pub link_inertia: f64,
    /// The same with the other joints free [kg m²], the smallest at q = 0 and with one joint at a time a quarter turn (or
    /// π/2 m) away: what damping of this joint alone acts on.
    pub free_inertia: f64,
    /// Link damping D_l [N m s/rad].
    pub link_damping: f64,
}

/// Fastest errors that starting gains ask for [1/s]: a control period of 1 ms does not show at that.
const FASTEST: f64 = 20.0;

/// How much faster than the links motors shall be that stand between them and the law.
const INNER: f64 = 3.0;

impl Drive {
    /// How fast errors shall decay [1/s]: half the frequency at which the links swing while the motor is held, at most
    /// 20 1/s.
    pub fn bandwidth(&self) -> f64 {
        (0.5 * (self.stiffness / self.link_inertia).sqrt()).min(FASTEST)
    }

    /// How fast errors of motors that stand between the law and the links shall decay [1/s].
    pub(crate) fn inner_bandwidth(&self) -> f64 {
        INNER * self.bandwidth()
    }

    /// Links and motor as if they were one [kg m²].
    pub(crate) fn inertia(&self) -> f64 {
        self.motor_inertia + self.link_inertia
    }

    /// ω² J [N m/rad].
    pub(crate) fn motor_stiffness(&self) -> f64 {
        self.bandwidth().powi(2) * self.inertia()
    }

    /// 2 ω J [N m s/rad]: with [`motor_stiffness`](Self::motor_stiffness) critically damped.
    pub(crate) fn motor_damping(&self) -> f64 {
        2.0 * self.bandwidth() * self.inertia()
    }

    /// 0.3 k √(D_l D_θ) with k = 2 and D_θ the starting damping of motors [N m s/rad]: a third of what dampers bear between motors and links.
    pub(crate) fn cross_damping(&self) -> f64 {
        0.6 * (self.link_damping * self.motor_damping()).sqrt()
    }
}
