//! Exact slopes of a loop's parts, for who designs by linear means.

use crate::files::Problems;
use crate::laws::Controller;
use crate::robot::Mismatch;
use crate::robot::slices::check;
use crate::sampled::lifted::{Lifted, Nominal, lifted};
use crate::scenario::Scenario;

/// The law and the simulated robot of a scenario, to be linearised where one likes: by dual numbers, so to rounding. Dry friction and
/// play have no slopes and are left out.
///
/// ```
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let linear = flexure::sampled::Linearised::of(&scenario)?;
/// let [a, b] = linear.plant(&[0.3, 0.3, 0.0, 0.0], &[0.0])?;
/// // The motor's acceleration: the spring over the inertia, and the torque over it.
/// let (k, m) = (scenario.robot.stiffness[0], scenario.robot.motor_inertia[0]);
/// assert!((a[12] - k / m).abs() < 1e-9 * k / m && (b[3] - 1.0 / m).abs() < 1e-12 / m);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Linearised {
    parts: Box<dyn Lifted>,
    law: Controller,
    joints: usize,
}

impl Linearised {
    /// Of the parts of `scenario`.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn of(scenario: &Scenario) -> Result<Self, Problems> {
        let (parts, law) = (lifted(scenario)?, scenario.controller.clone());
        Ok(Self { parts, law, joints: scenario.robot.joint_count() })
    }

    /// ∂u_m/∂(q_l, q_m, q̇_l, q̇_m) of the law at the time `t` in s: n rows of 4n numbers, N m over rad and rad/s.
    ///
    /// # Errors
    /// If `motion` does not have 4n numbers.
    pub fn law(&self, t: f64, motion: &[f64]) -> Result<Vec<f64>, Mismatch> {
        check("motion", "4n", motion.len(), 4 * self.joints)?;
        let slopes = self.parts.law(&self.law, t, motion);
        Ok(slopes.rows().flatten().copied().collect())
    }

    /// A and B of d(ẋ) = A dx + B du_m about `motion` and motor torques `u_m` [N m]: 4n rows of 4n and of n numbers.
    ///
    /// # Errors
    /// If `motion` does not have 4n numbers, or `u_m` n.
    pub fn plant(&self, motion: &[f64], u_m: &[f64]) -> Result<[Vec<f64>; 2], Mismatch> {
        let n = self.joints;
        check("motion", "4n", motion.len(), 4 * n)?;
        check("u_m", "n", u_m.len(), n)?;
        let slopes = self.parts.plant(&Nominal { motion: motion.to_vec(), u_m: u_m.to_vec() });
        let columns =
            |from: usize, to: usize| slopes.rows().flat_map(|row| row[from..to].iter().copied()).collect();
        Ok([columns(0, 4 * n), columns(4 * n, 5 * n)])
    }
}
