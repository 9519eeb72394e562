//! A scenario as a simulated run: from its file to trace and summary.

mod limits;
mod preload;
mod recorder;

use std::time::Instant as Clock;

use flexure_core::control::Command;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion, RotorCoupling};
use flexure_core::reference::Reference;
use flexure_core::scalar::Jet;

pub use limits::exceeded;
pub use preload::preload;
use recorder::Recorder;
pub use recorder::SETTLED;

use crate::io::{self, Problem, Problems, Scenario};
use crate::rates::BlockRates;
use crate::registry::{self, AnyLaw, AnyReference, RobotVisitor, any_law, vector, with_robot};
use crate::sim::{ClosedLoop, Divergence, Hold, Instant, Plant};
use crate::summary::Summary;
use crate::trace::Trace;

/// Tolerated local error of the plant integrator, relative to the joint speeds.
pub const TOLERANCE: f64 = 1e-10;

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What it is judged by.
    pub summary: Summary,
    /// Every control instant.
    pub trace: Trace,
    /// Set if the loop diverged before the end; trace and summary then end there.
    pub divergence: Option<Divergence>,
}

/// Simulates a scenario. `progress` is told the fraction done, now and then.
///
/// # Errors
/// If the robot has more joints than this program was built for, its links cannot contain its coupled rotors, or the
/// samples of the reference make no path.
pub fn run(scenario: &Scenario, progress: &(dyn Fn(f64) + Sync)) -> Result<Run, Problems> {
    with_robot(&scenario.robot, Simulate { scenario, progress })?
}

struct Simulate<'a> {
    scenario: &'a Scenario,
    progress: &'a (dyn Fn(f64) + Sync),
}

impl RobotVisitor for Simulate<'_> {
    type Output = Result<Run, Problems>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let Self { scenario, progress } = self;
        let started = Clock::now();
        let plant = plant(scenario, robot);
        let start = initial(scenario);
        if !plant.carries_its_rotors(&start.q_l) {
            return Err(too_heavy(scenario).into());
        }
        let robot = &plant.robot;
        let law: AnyLaw<f64, N> = any_law(&scenario.controller, |x| x);
        let reference = AnyReference::<f64, N>::new(scenario)?;
        let settings = ClosedLoop {
            duration: scenario.duration,
            period: scenario.control_period,
            hold: match scenario.hold {
                io::Hold::ZeroOrder => Hold::ZeroOrder,
                io::Hold::Continuous => Hold::Continuous,
            },
            tolerance: TOLERANCE,
        };
        let command = |t: f64, x: &Motion<f64, N>| command(&law, robot, x, &reference.at(t));
        let mut recorder = Recorder::new(vector(&scenario.robot.limits.torque));
        let mut observe = |instant: &Instant<'_, N>| {
            let rate = match &law {
                AnyLaw::Vcbc(law) => {
                    BlockRates::at(robot, law, &instant.motion.q_l, instant.command).overall()
                }
                _ => f64::NAN,
            };
            recorder.record(robot, instant, rate);
            progress(instant.t / settings.duration);
        };
        let outcome = settings.run(&plant, start, &command, &mut observe);
        let (trace, figures) = recorder.finish();
        // Errors of a run that diverged are beyond those that were recorded: no number stands for them.
        let ended = |error: f64| if outcome.divergence.is_none() { error } else { f64::NAN };
        let summary = Summary {
            name: scenario.name.clone(),
            controller: scenario.controller.kind().to_owned(),
            phi: scenario.controller.phi().map(str::to_owned),
            plant: scenario.plant.options(),
            max_abs_e_l: ended(figures.max_abs_e_l),
            rms_e_l: ended(figures.rms_e_l()),
            final_abs_e_l: ended(figures.final_abs_e_l),
            settling_time: figures.settled_since.filter(|_| outcome.divergence.is_none()),
            max_abs_u_m: figures.max_abs_u_m,
            rms_u_m: figures.rms_u_m(),
            saturated_fraction: figures.limited_fraction(),
            rate_measured: figures.rate,
            rate_certified: None,
            energy_drift: outcome.energy_drift,
            steps: outcome.steps,
            wall_seconds: started.elapsed().as_secs_f64(),
        };
        Ok(Run { summary, trace, divergence: outcome.divergence })
    }
}

/// What the law commands; of laws other than v-CBC only torque and link error are numbers.
fn command<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Command<f64, N> {
    if let AnyLaw::Vcbc(law) = law {
        return registry::command(law, robot, x, q_ld);
    }
    let none = Vector([f64::NAN; N]);
    let e_l = x.q_l - q_ld.map(|jet| jet.coefficient(0));
    let u_m = registry::torque(law, robot, x, q_ld);
    Command { u_m, u_l: none, q_md: none, e_l, e_m: none, s_l: none, s_m: none }
}

/// The initial motion of the scenario.
fn initial<const N: usize>(scenario: &Scenario) -> Motion<f64, N> {
    let initial = &scenario.initial;
    Motion {
        q_l: vector(&initial.q_l),
        q_m: vector(&initial.q_m),
        v_l: vector(&initial.dq_l),
        v_m: vector(&initial.dq_m),
    }
}

/// The robot with what the scenario says that the law does not know.
fn plant<L, const N: usize>(scenario: &Scenario, robot: Fjr<f64, L, N>) -> Plant<L, N> {
    let io::Plant { rotor_coupling, spring_hardening } = &scenario.plant;
    Plant {
        spring_hardening: spring_hardening.as_deref().map_or(Vector::ZERO, vector),
        rotor_coupling: rotor_coupling
            .as_deref()
            .map(|gears| RotorCoupling::new(&robot.motor_inertia, &vector(gears))),
        ..Plant::from(robot)
    }
}

fn too_heavy(scenario: &Scenario) -> Problem {
    let message = format!(
        "with coupled rotors the mass matrix of {} is not positive definite at the start",
        scenario.robot.name
    );
    let help = "rotors have motor_inertia / gear_ratio² about their axes, and link inertias must contain the rotors that \
                the links carry: a gear ratio is too small, or the links lack their motors";
    scenario.places.problem("plant.rotor_coupling", "rotors", message, help)
}
