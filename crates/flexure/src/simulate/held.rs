//! From a scenario to a loop that can be held.

use flexure_core::linalg::Vector;
use flexure_core::memory::{self, Memory, Unfit};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::Reference;
use flexure_core::scalar::Jet;

use crate::estimators::AnyEstimator;
use crate::feasible;
use crate::files::{Problem, Problems};
use crate::laws::{self, AnyLaw, BlockRates, VcbcGains, any_law};
use crate::plant::{Plant, Push};
use crate::references::AnyReference;
use crate::robot::Mismatch;
use crate::robot::links::FromFile;
use crate::robot::sized::{pair, sized};
use crate::robot::slices::{check, read, read_motion, write, write_motion};
use crate::scenario::Scenario;
use crate::simulate::assembly;
use crate::simulate::fault_log::FaultLog;
use crate::simulate::feedback::Feedback as _;
use crate::simulate::in_step::{Opened, grouped};
use crate::simulate::interface::{Commanded, Errors, Loop, Observed, Signal};
use crate::simulate::lanes;
use crate::simulate::names::Names;
use crate::simulate::own_law::{HeldLaw, OwnLaw, OwnShaping};
use crate::simulate::signals::Columns;
use crate::simulate::simulation::{Divergence, Simulation};

impl Scenario {
    /// The closed loop of this scenario, to be moved by the caller.
    ///
    /// # Errors
    /// If the robot has more joints than this program was built for, its links cannot contain its coupled rotors, the simulated
    /// robot is of another kind, the samples of the reference make no path, or no speed keeps it inside the limits.
    pub fn open(&self) -> Result<Box<dyn Loop>, Problems> {
        opened(self, None)
    }

    /// The same with the law of the caller in the place of its own.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_with(&self, law: OwnLaw) -> Result<Box<dyn Loop>, Problems> {
        opened(self, Some(Own::Law(law)))
    }

    /// The same with the shaping function of the caller in the place of that of its own law.
    ///
    /// # Errors
    /// As [`open`](Self::open), and if its law is no v-CBC.
    pub fn open_shaped(&self, shaping: &OwnShaping) -> Result<Box<dyn Loop>, Problems> {
        opened(self, Some(Own::Shaping(Box::new(self.vcbc()?.clone()), shaping.clone())))
    }
}

/// What the caller has in the place of what is the scenario's own.
enum Own {
    Law(OwnLaw),
    Shaping(Box<VcbcGains>, OwnShaping),
}

/// The loops of at most [`WIDTH`](crate::lanes::WIDTH) scenarios that may go together: in one group, if their structures allow it.
///
/// # Errors
/// If their robots have more joints than this program was built for.
pub(super) fn opened_together<K>(scenarios: Vec<(K, &Scenario)>) -> Result<Opened<K>, Problems> {
    let mut opened = Opened { groups: Vec::new(), refused: Vec::new() };
    let Some((_, first)) = scenarios.first() else { return Ok(opened) };
    sized!(&first.robot, L, N => {
        let (mut keys, mut loops) = (Vec::new(), Vec::new());
        for (key, scenario) in scenarios {
            match Held::<L<f64>, N>::of(scenario) {
                Ok(held) => {
                    keys.push(key);
                    loops.push(held);
                }
                Err(problems) => opened.refused.push((key, problems)),
            }
        }
        grouped(keys, loops, &mut opened);
    });
    Ok(opened)
}

/// The loop of `scenario` with its own law, or with that of the caller.
fn opened(scenario: &Scenario, own: Option<Own>) -> Result<Box<dyn Loop>, Problems> {
    Ok(sized!(&scenario.robot, L, N => Box::new(Held::<L<f64>, N>::new(scenario, own)?)))
}

#[cfg(test)]
mod tests;

/// A loop whose size is known to the compiler.
pub(super) struct Held<L, const N: usize> {
    pub(super) simulation: Simulation<L, AnyReference<f64, N>, HeldLaw<N>, AnyEstimator<f64, N>, N>,
    scenario: Scenario,
    columns: Columns,
    signals: Vec<Signal>,
}

impl<L: FromFile<f64, N> + Clone, const N: usize> Held<L, N> {
    /// The loop of `scenario` with its own law.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub(super) fn of(scenario: &Scenario) -> Result<Self, Problems> {
        Self::new(scenario, None)
    }

    fn new(scenario: &Scenario, own: Option<Own>) -> Result<Self, Problems> {
        let [model, simulated] = pair(&scenario.robot, &assembly::simulated(scenario))?;
        let law = match own {
            None => HeldLaw::Registered(any_law(&scenario.controller, &scenario.robot, &|x| x)),
            Some(Own::Law(law)) => HeldLaw::Own(law),
            Some(Own::Shaping(gains, shaping)) => HeldLaw::Shaped(Box::new(shaping.law(&gains))),
        };
        let plant = assembly::plant(scenario, simulated);
        if !plant.carries_its_rotors(&assembly::initial::<N>(scenario).q_l) {
            return Err(too_heavy(scenario).into());
        }
        let columns = assembly::columns(scenario, matches!(law, HeldLaw::Registered(AnyLaw::Vcbc(_))));
        let signals = columns.signals(&scenario.robot.joints);
        let reference = feasible::reference::<N>(scenario)?;
        let simulation = simulation(scenario, model, plant, law, reference);
        Ok(Self { simulation, scenario: scenario.clone(), columns, signals })
    }
}

fn simulation<L: Links<f64, N> + Clone, const N: usize>(
    scenario: &Scenario,
    model: Fjr<f64, L, N>,
    plant: Plant<L, N>,
    law: HeldLaw<N>,
    reference: AnyReference<f64, N>,
) -> Simulation<L, AnyReference<f64, N>, HeldLaw<N>, AnyEstimator<f64, N>, N> {
    let start = assembly::initial(scenario);
    let controller = assembly::controller(scenario, model, reference, law, &start);
    Simulation::new(assembly::timing(scenario), plant, start, assembly::pushes(scenario), controller)
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

impl<L: Links<f64, N>, const N: usize> Held<L, N> {
    /// The robot that the law knows.
    pub(super) fn robot(&self) -> &Fjr<f64, L, N> {
        &self.simulation.controller().robot
    }

    /// The scenario that it is the loop of.
    pub(super) fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn reference_at(&self, t: f64) -> Vector<Jet<f64, 5>, N> {
        self.simulation.controller().reference.at(t)
    }

    /// What the law asks of a robot that moves as `x`, with the memory that it has [N m].
    fn asked(&self, t: f64, x: &Motion<f64, N>, q_ld: &Vector<Jet<f64, 5>, N>) -> Vector<f64, N> {
        let controller = self.simulation.controller();
        let memory = controller.state.remembered.as_ref().map(|remembered| &remembered.z);
        controller.law.torque(&controller.robot, t, x, q_ld, memory)
    }

    /// Torque from outside on the links [N m].
    fn pushed(&self, t: f64) -> Vector<f64, N> {
        self.simulation.pushes().iter().fold(Vector::ZERO, |sum, push: &Push<N>| sum + push.at(t))
    }

    fn list(&self, v: &Vector<f64, N>) -> Vec<f64> {
        v.iter().take(self.robot().links.joints()).collect()
    }
}

impl<L, const N: usize> Loop for Held<L, N>
where
    L: Links<f64, N> + Clone + Send + Sync,
{
    fn joints(&self) -> usize {
        self.robot().links.joints()
    }

    fn period(&self) -> f64 {
        self.scenario.control_period
    }

    fn torque(&self, t: f64, motions: &[f64], u_m: &mut [f64]) -> Result<(), Mismatch> {
        let n = self.joints();
        let whole = motions.len().next_multiple_of(4 * n);
        check("motions", "4n for each motion", motions.len(), whole)?;
        check("u_m", "n for each motion", u_m.len(), whole / 4)?;
        let (robot, reference) = (self.robot(), self.reference_at(t));
        if let (HeldLaw::Registered(AnyLaw::Vcbc(law)), true) =
            (&self.simulation.controller().law, motions.len() > 4 * n)
        {
            lanes::torques(law, robot, &reference, n, motions, u_m);
            return Ok(());
        }
        for (motion, u_m) in motions.chunks_exact(4 * n).zip(u_m.chunks_exact_mut(n)) {
            let x = read_motion(motion, n)?;
            write(&self.asked(t, &x, &reference), u_m);
        }
        Ok(())
    }

    fn command(&self, t: f64, motion: &[f64]) -> Result<Commanded, Mismatch> {
        let x: Motion<f64, N> = read_motion(motion, self.joints())?;
        let (robot, reference) = (self.robot(), self.reference_at(t));
        let list = |v: &Vector<f64, N>| self.list(v);
        let e_l = list(&(x.q_l - reference.map(|jet| jet.coefficient(0))));
        let energy = robot.total_energy(&x);
        let HeldLaw::Registered(AnyLaw::Vcbc(law)) = &self.simulation.controller().law else {
            let u_m = list(&self.asked(t, &x, &reference));
            return Ok(Commanded { u_m, e_l, energy, errors: None });
        };
        let command = laws::command(law, robot, &x, &reference);
        let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..x });
        let errors = Errors {
            u_l: list(&command.u_l),
            q_md: list(&command.q_md),
            e_m: list(&command.e_m),
            s_l: list(&command.s_l),
            s_m: list(&command.s_m),
            sigma_l: list(&sigma.p_l),
            sigma_m: list(&sigma.p_m),
        };
        Ok(Commanded { u_m: list(&command.u_m), e_l, energy, errors: Some(errors) })
    }

    fn reference(&self, t: f64, series: &mut [[f64; 5]]) -> Result<(), Mismatch> {
        check("series", "n", series.len(), self.joints())?;
        write(&self.reference_at(t).map(|jet| std::array::from_fn(|k| jet.coefficient(k))), series);
        Ok(())
    }

    fn derivative(&self, t: f64, motion: &[f64], u_m: &[f64], rate: &mut [f64]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("rate", "4n", rate.len(), 4 * n)?;
        let (x, u_m): (Motion<f64, N>, _) = (read_motion(motion, n)?, read("u_m", u_m, n)?);
        let plant = self.simulation.plant();
        let external = self.pushed(t);
        let [a_l, a_m] = Plant { external, ..plant.clone() }.accelerations(&x, &u_m);
        write_motion(&Motion { q_l: x.v_l, q_m: x.v_m, v_l: a_l, v_m: a_m }, n, rate);
        Ok(())
    }

    fn loads(
        &self,
        t: f64,
        motion: &[f64],
        spring: &mut [f64],
        external: &mut [f64],
    ) -> Result<(), Mismatch> {
        let n = self.joints();
        check("spring", "n", spring.len(), n)?;
        check("external", "n", external.len(), n)?;
        let x: Motion<f64, N> = read_motion(motion, n)?;
        write(&self.simulation.plant().spring_torque(&x), spring);
        write(&self.pushed(t), external);
        Ok(())
    }

    fn step(&mut self) -> Result<(), Divergence> {
        self.simulation.step()
    }

    fn signals(&self) -> &[Signal] {
        &self.signals
    }

    fn read(&self, values: &mut [f64]) -> Result<(), Mismatch> {
        check("values", "one per signal", values.len(), self.signals.len())?;
        let Some(instant) = self.simulation.instant() else {
            values.fill(f64::NAN);
            return Ok(());
        };
        let robot = self.robot();
        let errors = match &self.simulation.controller().law {
            HeldLaw::Registered(AnyLaw::Vcbc(law)) => {
                let command = laws::command(law, robot, instant.motion, &instant.action.reference);
                let rate = BlockRates::at(robot, law, &instant.motion.q_l, &command).overall();
                Some((command, rate))
            }
            _ => None,
        };
        self.columns.read(robot, &instant, errors.as_ref(), values);
        Ok(())
    }

    fn observe(&self, observed: &mut Observed) -> Result<(), Mismatch> {
        let n = self.joints();
        check("motion", "4n", observed.motion.len(), 4 * n)?;
        for (name, vector) in [
            ("reference", &observed.reference),
            ("followed", &observed.followed),
            ("command", &observed.command),
            ("applied", &observed.applied),
        ] {
            check(name, "n", vector.len(), n)?;
        }
        let Some(instant) = self.simulation.instant() else { return Ok(()) };
        let action = instant.action;
        observed.t = instant.t;
        write_motion(instant.motion, n, &mut observed.motion);
        let positions = |q_ld: Vector<Jet<f64, 5>, N>| q_ld.map(|jet| jet.coefficient(0));
        write(&positions(action.reference), &mut observed.followed);
        if self.simulation.controller().has_rejoined() {
            write(&positions(self.reference_at(instant.t)), &mut observed.reference);
        } else {
            observed.reference.clone_from(&observed.followed);
        }
        write(&action.u_m, &mut observed.command);
        write(&action.applied.last(), &mut observed.applied);
        (observed.certificate, observed.stopped) = (action.certificate, action.stopped);
        Ok(())
    }

    fn faults(&self) -> Option<FaultLog> {
        let guarded = self.simulation.controller().guard.as_ref()?;
        Some(FaultLog::new(guarded.guard.log(), self.joints(), self.period()))
    }

    fn steps(&self) -> u64 {
        self.simulation.steps()
    }

    fn energy_drift(&self) -> f64 {
        self.simulation.energy_drift()
    }

    fn state(&mut self) -> Vec<f64> {
        let n = self.joints();
        let mut state = vec![0.0; memory::length(&mut self.simulation, n)];
        memory::save(&mut self.simulation, n, &mut state).expect("as long as it was counted");
        state
    }

    fn state_names(&mut self) -> Vec<Signal> {
        let mut names = Names::new(self.joints());
        self.simulation.memory(&mut names);
        names.found
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), Unfit> {
        let n = self.joints();
        memory::restore(&mut self.simulation, n, state)
    }

    fn reset(&mut self, seed: u64) {
        self.scenario.seed = seed;
        let controller = self.simulation.controller();
        let (model, law, reference) =
            (controller.robot.clone(), controller.law.clone(), controller.reference.clone());
        let plant = self.simulation.plant().clone();
        self.simulation = simulation(&self.scenario, model, plant, law, reference);
    }
}
