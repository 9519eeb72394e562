//! One way to move any plant.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::Plant;
use crate::simulate::gauss::{Integrator, StepFailure};
use crate::simulate::ledger::Ledger;
use crate::simulate::stepping::Stepping;

/// Moves a plant, by the method that suits it, and keeps what the plant remembers.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one a run")]
pub enum Stepper<const N: usize> {
    /// Of high order, for smooth plants.
    Smooth(Integrator<N>),
    /// In short steps, for plants with dry friction, play or hysteresis.
    Rough(Stepping<N>),
}

impl<const N: usize> Stepper<N> {
    /// For `plant`: with the tolerated local error relative to the joint speeds if it is smooth, in steps of at most
    /// `longest` s if not.
    pub fn new<L>(plant: &Plant<L, N>, tolerance: f64, longest: f64) -> Self {
        if plant.is_smooth() {
            Self::Smooth(Integrator::new(tolerance))
        } else {
            Self::Rough(Stepping::new(longest))
        }
    }

    /// Moves `x` over `[t, t + interval]` under the torque `u_m(t, x)` and books the work in `ledger`. Nothing happens in an
    /// interval of no length.
    ///
    /// # Errors
    /// As [`Integrator::advance`] and [`Stepping::advance`].
    pub fn advance<L: Links<f64, N>>(
        &mut self,
        plant: &Plant<L, N>,
        x: Motion<f64, N>,
        t: f64,
        interval: f64,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
        ledger: &mut Ledger,
    ) -> Result<Motion<f64, N>, StepFailure> {
        if interval == 0.0 {
            return Ok(x);
        }
        match self {
            Self::Smooth(integrator) => integrator.advance(plant, x, t, interval, torque, ledger),
            Self::Rough(stepping) => stepping.advance(plant, x, t, interval, torque, ledger),
        }
    }

    /// Total energy in J, with what hysteresis keeps.
    pub fn total_energy<L: Links<f64, N>>(&self, plant: &Plant<L, N>, x: &Motion<f64, N>) -> f64 {
        let energy = plant.total_energy(x);
        match self {
            Self::Smooth(_) => energy,
            Self::Rough(stepping) => energy + plant.hysteresis.energy(stepping.hysteresis_torque()),
        }
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        match self {
            Self::Smooth(integrator) => integrator.steps(),
            Self::Rough(stepping) => stepping.steps(),
        }
    }
}
