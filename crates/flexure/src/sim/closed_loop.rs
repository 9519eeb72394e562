//! A controller on a robot: sampled with a zero-order hold, or continuous.

use flexure_core::control::Command;
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use super::gauss::Integrator;
use super::ledger::Ledger;
use super::plant::Plant;

/// How the torque behaves between control instants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Constant over the control period.
    ZeroOrder,
    /// The law is evaluated at every integration stage: the continuous-time loop of the theory.
    Continuous,
}

/// A closed loop to simulate.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLoop {
    /// Length of the run in s.
    pub duration: f64,
    /// Control period in s; also the interval at which the run is observed.
    pub period: f64,
    /// Torque between control instants.
    pub hold: Hold,
    /// Tolerated local error of the integrator, relative to the joint speeds.
    pub tolerance: f64,
}

/// What a control instant looks like to an observer.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a, const N: usize> {
    /// Time in s.
    pub t: f64,
    /// Motion of the robot.
    pub motion: &'a Motion<f64, N>,
    /// What the law commands.
    pub command: &'a Command<f64, N>,
    /// Total energy H in J.
    pub energy: f64,
    /// H(t) − H(0) − supplied + dissipated in J: zero up to integration errors.
    pub residual: f64,
    /// Work so far.
    pub ledger: &'a Ledger,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// |H(T) − H(0) − supplied + dissipated|, its largest value over the run, relative to the energy that went through
    /// the robot.
    pub energy_drift: f64,
    /// Integration steps.
    pub steps: u64,
    /// Set if the loop diverged before the end.
    pub divergence: Option<Divergence>,
}

/// A loop that left the finite numbers, or any sensible range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// Time at which the run had to stop, in s.
    pub time: f64,
    /// Largest link position or velocity seen at the last good instant [rad, rad/s].
    pub magnitude: f64,
    /// What stopped the run.
    pub cause: Cause,
}

/// What stopped a run before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Positions, speeds or torques left every sensible range, or the finite numbers.
    Unbounded,
    /// The motion between two control instants could not be integrated.
    Unsolvable,
}

/// A position in rad or speed [rad/s] beyond this is a diverged loop, not a robot.
const BEYOND: f64 = 1e6;

impl ClosedLoop {
    /// Runs `law(t, x)` on `plant` from `x` and shows every control instant to `observe`, the last included.
    pub fn run<L: Links<f64, N>, const N: usize>(
        &self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        law: &impl Fn(f64, &Motion<f64, N>) -> Command<f64, N>,
        observe: &mut impl FnMut(&Instant<'_, N>),
    ) -> Outcome {
        let mut integrator = Integrator::new(self.tolerance);
        let mut ledger = Ledger::default();
        let start = plant.total_energy(&x);
        let (mut worst, mut scale) = (0.0_f64, start.abs());
        let periods = self.periods();
        let mut divergence = None;
        for k in 0..=periods {
            let t = self.period * f64::from(k);
            let command = law(t, &x);
            let energy = plant.total_energy(&x);
            let residual = energy - start - ledger.supplied + ledger.dissipated;
            scale = scale.max(energy.abs()).max(ledger.throughput).max(ledger.dissipated);
            worst = worst.max(residual.abs());
            let magnitude = [&x.q_l, &x.q_m, &x.v_l, &x.v_m]
                .iter()
                .flat_map(|v| v.iter())
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            let sane = magnitude < BEYOND && command.u_m.iter().all(f64::is_finite);
            if !sane {
                divergence = Some(Divergence { time: t, magnitude, cause: Cause::Unbounded });
                break;
            }
            observe(&Instant { t, motion: &x, command: &command, energy, residual, ledger: &ledger });
            if k == periods {
                break;
            }
            let next = match self.hold {
                Hold::ZeroOrder => integrator.advance(
                    plant,
                    x,
                    t,
                    self.period,
                    &|_, _: &Motion<f64, N>| command.u_m,
                    &mut ledger,
                ),
                Hold::Continuous => integrator.advance(
                    plant,
                    x,
                    t,
                    self.period,
                    &|t, x: &Motion<f64, N>| -> Vector<f64, N> { law(t, x).u_m },
                    &mut ledger,
                ),
            };
            match next {
                Ok(next) => x = next,
                Err(failure) => {
                    let time = t + failure.after;
                    divergence = Some(Divergence { time, magnitude, cause: Cause::Unsolvable });
                    break;
                }
            }
        }
        let energy_drift = if scale > 0.0 { worst / scale } else { worst };
        Outcome { energy_drift, steps: integrator.steps(), divergence }
    }

    /// Number of control periods in the run.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 1e9]")]
    fn periods(&self) -> u32 {
        (self.duration / self.period).round().clamp(1.0, 1e9) as u32
    }
}
