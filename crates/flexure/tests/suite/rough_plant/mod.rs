//! Plants that are not smooth: dry friction, play, hysteresis, and the time stepping that moves them.

mod effects;
mod friction;
mod spring;
mod stepping;

use flexure::plant::Plant;
use flexure::scenario::Integration;
use flexure::simulate::{Ledger, Stepper, Stepping};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{Pendulum, PlanarTwoLink};

/// Step of the tests in s.
const STEP: f64 = Stepping::<1>::STEP;

/// One joint without gravity and damping.
fn joint(inertia: f64, motor_inertia: f64, stiffness: f64) -> Plant<Pendulum<f64>, 1> {
    Plant::from(Fjr {
        links: Pendulum { inertia, weight_moment: 0.0 },
        motor_inertia: Vector([motor_inertia]),
        stiffness: Vector([stiffness]),
        link_damping: Vector::ZERO,
        motor_damping: Vector::ZERO,
    })
}

/// The arm of the paper.
fn two_link() -> Plant<PlanarTwoLink<f64>, 2> {
    Plant::from(Fjr {
        links: PlanarTwoLink::new([1.51, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.23, 0.01]),
        stiffness: Vector([9.0, 4.0]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([0.2, 90.0]),
    })
}

fn at_rest<const N: usize>() -> Motion<f64, N> {
    Motion::at_rest(Vector::ZERO)
}

/// A plant on its way.
struct Ride<'a, L, const N: usize> {
    plant: &'a Plant<L, N>,
    stepper: Stepper<N>,
    x: Motion<f64, N>,
    ledger: Ledger,
    start: f64,
}

impl<'a, L: Links<f64, N>, const N: usize> Ride<'a, L, N> {
    fn new(plant: &'a Plant<L, N>, x: Motion<f64, N>, step: f64) -> Self {
        let stepper = Stepper::new(plant, Integration::Collocation { tolerance: 1e-10 }, step);
        Self { plant, x, ledger: Ledger::default(), start: stepper.total_energy(plant, &x), stepper }
    }

    /// For `seconds` under a constant torque [N m].
    fn on(&mut self, seconds: f64, u_m: [f64; N]) -> &mut Self {
        let torque = |_, _: &Motion<f64, N>| Vector(u_m);
        self.x = self
            .stepper
            .advance(self.plant, self.x, 0.0, seconds, &torque, &mut self.ledger)
            .expect("bounded");
        self
    }

    /// Energy in J that the books do not explain.
    fn residual(&self) -> f64 {
        let now = self.stepper.total_energy(self.plant, &self.x);
        now - self.start - self.ledger.supplied + self.ledger.dissipated
    }
}
