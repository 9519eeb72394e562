//! One way to move any plant.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::Plant;
use crate::scenario::Integration;
use crate::simulate::gauss::{Integrator, StepFailure};
use crate::simulate::ledger::Ledger;
use crate::simulate::midpoint;
use crate::simulate::stepping::Stepping;

/// Moves a plant, by the method that suits it, and keeps what the plant remembers.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one a run")]
pub enum Stepper<const N: usize> {
    /// Of high order, for smooth plants that are moved by collocation.
    Smooth(Integrator<N>),
    /// In equal steps of the midpoint rule, for all others.
    Rough(Stepping<N>),
}

impl<const N: usize> Stepper<N> {
    /// For `plant`: by `integration` if it is smooth, in steps of at most `longest` s if not.
    pub fn new<L>(plant: &Plant<L, N>, integration: Integration, longest: f64) -> Self {
        match integration {
            _ if !plant.is_smooth() => Self::Rough(Stepping::new(longest)),
            Integration::Collocation { tolerance } => Self::Smooth(Integrator::new(tolerance)),
            Integration::Midpoint => Self::Rough(Stepping::new(midpoint::LONGEST)),
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
