//! The parts of a loop on numbers that carry a derivative along, their joint count hidden.

use flexure_core::control::Applied;
use flexure_core::estimate::{DisturbanceObserver, Estimator as _};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::Reference as _;
use flexure_core::scalar::{Jet, Tangent};

use crate::estimators::{AnyEstimator, estimator};
use crate::feasible;
use crate::files::Problems;
use crate::imperfections::Effects;
use crate::laws::{self, AnyLaw, Controller, LawMemory, PARTS, any_law};
use crate::linalg::Dense;
use crate::plant::Plant;
use crate::references::AnyReference;
use crate::robot::sized::{OF_THE_KIND, fjr, pair, sized};
use crate::robot::slices::{read, read_motion, write_motion};
use crate::scenario::Scenario;
use crate::simulate::assembly;

/// Where a loop is linearised.
#[derive(Clone, Debug)]
pub(crate) struct Nominal {
    /// (q_l, q_m, q̇_l, q̇_m) in rad and rad/s.
    pub motion: Vec<f64>,
    /// Motor torque [N m].
    pub u_m: Vec<f64>,
}

/// A device with a memory, linearised: (output, next memory) from (readings, memory, torque since the last instant).
#[derive(Clone, Debug)]
pub(crate) struct Device {
    /// Numbers that it remembers.
    pub memory: usize,
    /// A row per output, then per number that it remembers.
    pub slope: Dense<f64>,
}

/// A law with memory, linearised: (torque, next memory) from (motion that is seen, motion that was seen, memory, torque that left the controller at the last
/// instant, torque that the motors got since).
#[derive(Clone, Debug)]
pub(crate) struct LawDevice {
    /// Numbers in the memory.
    pub memory: usize,
    /// A row per torque, then per number of the memory.
    pub slope: Dense<f64>,
}

/// The parts of a loop, each with its exact Jacobian.
pub(crate) trait Lifted: Send + Sync {
    /// Taylor coefficients of the reference in time at `t` in s, six per joint.
    fn reference(&self, t: f64) -> Vec<[f64; 6]>;

    /// What `law` asks for [N m] at `motion`, if it starts there.
    fn torque(&self, law: &Controller, t: f64, motion: &[f64]) -> Vec<f64>;

    /// By motion and torque: the rate of the motion of the simulated robot, 4n rows of 4n + n columns.
    fn plant(&self, at: &Nominal) -> Dense<f64>;

    /// By motion: the torque of `law`, n rows of 4n columns, its memory held where it is in a loop that starts at `motion`.
    fn law(&self, law: &Controller, t: f64, motion: &[f64]) -> Dense<f64>;

    /// The memory of `law` in a loop that was at `before` a control period before the time `t` in s and is at `now`; none if it has no memory. `settled`: the
    /// loop has followed for long, or it starts.
    fn memory(&self, law: &Controller, t: f64, moments: [&Nominal; 2], settled: bool) -> Option<LawDevice>;

    /// The estimator of a loop that was at `before` a period ago and is at `now`; none if the law sees readings.
    fn estimator(&self, before: &Nominal, now: &Nominal) -> Option<Device>;

    /// The observer of disturbances likewise, of what is seen; none if the law does without its estimate.
    fn disturbance(&self, before: &Nominal, now: &Nominal) -> Option<Device>;
}

/// The parts of the loop of `scenario`, as far as they act on small signals.
///
/// # Errors
/// As [`Scenario::open`].
pub(crate) fn lifted(scenario: &Scenario) -> Result<Box<dyn Lifted>, Problems> {
    let simulated = assembly::simulated(scenario);
    Ok(sized!(roomy &scenario.robot, L, N => {
        let [robot, there] = pair::<L<f64>, N>(&scenario.robot, &simulated)?;
        let constants = scenario.robot.links.map(Tangent::constant);
        let known = fjr::<_, L<Tangent>, N>(&scenario.robot, &constants, Tangent::constant, &|x| x.value);
        Box::new(Parts::<_, _, N> {
            scenario: scenario.clone(),
            reference: feasible::reference(scenario)?,
            plant: small_signals(assembly::plant(scenario, there)),
            known: known.expect(OF_THE_KIND),
            robot,
        })
    }))
}

/// For small signals: springs that slip inside are springs while they do not, and play, in which a link is loose, is left out.
fn small_signals<L, const N: usize>(mut plant: Plant<L, N>) -> Plant<L, N> {
    let inside = &plant.hysteresis;
    let holds = |i: usize| if inside.yield_torque[i] > 0.0 { inside.stiffness[i] } else { 0.0 };
    plant.robot.stiffness += Vector::from_fn(holds);
    plant.spring_gap = Vector::ZERO;
    plant
}

struct Parts<L, M, const N: usize> {
    scenario: Scenario,
    reference: AnyReference<f64, N>,
    /// As the law knows it.
    robot: Fjr<f64, L, N>,
    /// The same as estimators take it.
    known: Fjr<Tangent, M, N>,
    /// As it is simulated.
    plant: Plant<L, N>,
}

const SIZES: &str = "slices of the robot's size";

/// `values` of which entry `moving` moves, if it is one of them.
fn seeded(values: &[f64], moving: usize) -> Vec<Tangent> {
    values
        .iter()
        .enumerate()
        .map(|(i, &x)| Tangent { value: x, gradient: [f64::from(i == moving)] })
        .collect()
}

fn slopes(of: &[Tangent]) -> Vec<f64> {
    of.iter().map(|x| x.gradient[0]).collect()
}

impl<L: Links<f64, N>, M: Links<Tangent, N>, const N: usize> Parts<L, M, N> {
    fn joints(&self) -> usize {
        self.robot.links.joints()
    }

    /// `motion` of which entry `moving` moves.
    fn motion(&self, motion: &[f64], moving: usize) -> Motion<Tangent, N> {
        read_motion(&seeded(motion, moving), self.joints()).expect(SIZES)
    }

    fn vector(&self, values: &[f64], moving: usize) -> Vector<Tangent, N> {
        read("values", &seeded(values, moving), self.joints()).expect(SIZES)
    }

    fn slope(&self, x: &Motion<Tangent, N>) -> Vec<f64> {
        let mut slots = vec![Tangent::constant(0.0); 4 * self.joints()];
        write_motion(x, self.joints(), &mut slots);
        slopes(&slots)
    }

    fn q_ld(&self, t: f64) -> Vector<Jet<Tangent, 5>, N> {
        self.reference.at::<5>(t).map(|q: Jet<f64, 5>| Jet::from_fn(|k| Tangent::constant(q.coefficient(k))))
    }

    /// The slopes of a device: `after` runs it for the readings, with what it remembers, and the torque that it is given,
    /// and gives its output.
    fn device<D: Memory<Tangent> + Clone>(
        &self,
        device: &D,
        now: &Nominal,
        after: impl Fn(&mut D, &Motion<Tangent, N>, &Vector<Tangent, N>) -> Vec<f64>,
    ) -> Device {
        let n = self.joints();
        let memory = Slots::of(&mut device.clone(), n, |_, _| ());
        let columns: Vec<_> = (0..4 * n + memory + n)
            .map(|moving| {
                let mut device = device.clone();
                let none = usize::MAX;
                let own = moving.checked_sub(4 * n).unwrap_or(none);
                Slots::of(&mut device, n, |i, x| x.gradient = [f64::from(i == own)]);
                let readings = self.motion(&now.motion, moving);
                let torque = moving.checked_sub(4 * n + memory).unwrap_or(none);
                let mut column = after(&mut device, &readings, &self.vector(&now.u_m, torque));
                Slots::of(&mut device, n, |_, x| column.push(x.gradient[0]));
                column
            })
            .collect();
        Device { memory, slope: Dense::from_columns(&columns) }
    }
}

impl<L, M, const N: usize> Lifted for Parts<L, M, N>
where
    L: Links<f64, N> + Send + Sync,
    M: Links<Tangent, N> + Send + Sync,
{
    fn reference(&self, t: f64) -> Vec<[f64; 6]> {
        let series = self.reference.at::<6>(t);
        series.iter().take(self.joints()).map(|q| std::array::from_fn(|k| q.coefficient(k))).collect()
    }

    fn torque(&self, law: &Controller, t: f64, motion: &[f64]) -> Vec<f64> {
        let x = read_motion(motion, self.joints()).expect(SIZES);
        let law = any_law(law, &self.scenario.robot, &|x| x);
        let q_ld = self.reference.at(t);
        let u_m = laws::torque(&law, &self.robot, &x, &q_ld, &laws::start(&law, &self.robot, &x, &q_ld));
        u_m.iter().take(self.joints()).collect()
    }

    fn plant(&self, at: &Nominal) -> Dense<f64> {
        let n = self.joints();
        let gain = &self.plant.torque_gain;
        let columns: Vec<_> = (0..5 * n)
            .map(|moving| {
                let x = self.motion(&at.motion, moving);
                let u_m = self.vector(&at.u_m, moving.wrapping_sub(4 * n));
                let given = Vector::from_fn(|i| u_m[i] * Tangent::constant(gain[i]));
                let [a_l, a_m] = self.plant.accelerations(&x, &given);
                self.slope(&Motion { q_l: x.v_l, q_m: x.v_m, v_l: a_l, v_m: a_m })
            })
            .collect();
        Dense::from_columns(&columns)
    }

    fn law(&self, law: &Controller, t: f64, motion: &[f64]) -> Dense<f64> {
        let (n, q_ld) = (self.joints(), self.q_ld(t));
        let law = any_law::<f64, N>(law, &self.scenario.robot, &|x| x);
        let z = law.start(&self.robot, &self.motion(motion, usize::MAX), &q_ld);
        let columns: Vec<_> = (0..4 * n)
            .map(|moving| {
                let u_m = law.torque(&self.robot, &self.motion(motion, moving), &q_ld, &z);
                u_m.iter().take(n).map(|u| u.gradient[0]).collect()
            })
            .collect();
        Dense::from_columns(&columns)
    }

    fn memory(&self, law: &Controller, t: f64, moments: [&Nominal; 2], settled: bool) -> Option<LawDevice> {
        let (n, parts, period) = (self.joints(), law.memory().len(), self.scenario.control_period);
        if parts == 0 {
            return None;
        }
        let law = any_law::<f64, N>(law, &self.scenario.robot, &|x| x);
        let times = [(t - period).max(0.0), t];
        let [before, now] =
            [0, 1].map(|i| Remembering::new(self, &law, parts, (times[i], moments[i]), settled));
        let (rates, ends) = (before.rate(), now.rate());
        // (1 − T/2 ∂ż⁺) z⁺ = z + T/2 (ż + ż⁺), by (motion now, motion before, memory, asked, given).
        let (size, half) = (parts * n, 0.5 * period);
        let here = |of: &Dense<f64>, i: usize, j: usize| half * of[(i, j)];
        let implicit = Dense::from_fn(size, size, |i, j| f64::from(i == j) - here(&ends, i, 4 * n + j));
        let known = Dense::from_fn(size, 8 * n + size + 2 * n, |i, j| {
            if j < 4 * n {
                here(&ends, i, j)
            } else if j < 8 * n {
                here(&rates, i, j - 4 * n)
            } else if j < 8 * n + size {
                f64::from(i == j - 8 * n) + here(&rates, i, j - 4 * n)
            } else {
                here(&rates, i, j - 4 * n) + here(&ends, i, j - 4 * n)
            }
        });
        let next = implicit.solved(known);
        let torque = now.torque();
        let direct = Dense::from_fn(n, next.columns(), |i, j| if j < 4 * n { torque[(i, j)] } else { 0.0 });
        let by_memory = Dense::from_fn(n, size, |i, j| torque[(i, 4 * n + j)]);
        let torque = &direct + &(&by_memory * &next);
        Some(LawDevice { memory: size, slope: Dense::stacked(&[&torque, &next]) })
    }

    fn estimator(&self, before: &Nominal, now: &Nominal) -> Option<Device> {
        let Scenario { imperfections, estimator: asked, control_period, seed, .. } = &self.scenario;
        let velocities = Effects::of(imperfections, self.joints(), *control_period, *seed).velocities;
        let mut started: AnyEstimator<Tangent, N> = estimator(asked.as_ref(), velocities, *control_period)?;
        started.start(&self.motion(&before.motion, usize::MAX));
        Some(self.device(&started, now, |estimator, readings, u_m| {
            self.slope(&estimator.update(&self.known, &readings.q_l, &readings.q_m, u_m))
        }))
    }

    fn disturbance(&self, before: &Nominal, now: &Nominal) -> Option<Device> {
        let settings = self.scenario.disturbance_observer.as_ref().filter(|settings| settings.compensate)?;
        let bandwidth = crate::robot::padded(&settings.bandwidth, 1.0).map(Tangent::constant);
        let period = Tangent::constant(self.scenario.control_period);
        let mut started = DisturbanceObserver::new(&bandwidth, period)?;
        let (x, u_m) = (self.motion(&before.motion, usize::MAX), self.vector(&before.u_m, usize::MAX));
        started.update(&self.known, &x, &u_m);
        Some(self.device(&started, now, |observer, readings, u_m| {
            let torque = observer.update(&self.known, readings, u_m).motor;
            torque.iter().take(self.joints()).map(|d| d.gradient[0]).collect()
        }))
    }
}

/// A law with memory at an instant of a loop, its memory as numbers.
struct Remembering<'a, L, M, const N: usize> {
    parts: &'a Parts<L, M, N>,
    law: &'a AnyLaw<f64, N>,
    q_ld: Vector<Jet<Tangent, 5>, N>,
    motion: &'a [f64],
    memory: Vec<f64>,
    u_m: &'a [f64],
}

impl<'a, L: Links<f64, N>, M: Links<Tangent, N>, const N: usize> Remembering<'a, L, M, N> {
    fn new(
        parts: &'a Parts<L, M, N>,
        law: &'a AnyLaw<f64, N>,
        count: usize,
        (t, moment): (f64, &'a Nominal),
        settled: bool,
    ) -> Self {
        let n = parts.joints();
        let (q_ld, x) = (parts.q_ld(t), parts.motion(&moment.motion, usize::MAX));
        let z =
            if settled { law.settled(&parts.robot, &x, &q_ld) } else { law.start(&parts.robot, &x, &q_ld) };
        let memory = z.iter().take(count).flat_map(|part| part.iter().take(n)).map(|x| x.value).collect();
        Self { parts, law, q_ld, motion: &moment.motion, memory, u_m: &moment.u_m }
    }

    /// The memory of which entry `moving` moves.
    fn z(&self, moving: usize) -> LawMemory<Tangent, N> {
        let n = self.parts.joints();
        let seeded = seeded(&self.memory, moving);
        let mut z = [Vector([Tangent::constant(0.0); N]); PARTS];
        for (part, values) in z.iter_mut().zip(seeded.chunks_exact(n)) {
            *part = read("memory", values, n).expect(SIZES);
        }
        z
    }

    /// By motion, memory, torque asked and given: the rate of the memory.
    fn rate(&self) -> Dense<f64> {
        let (n, size) = (self.parts.joints(), self.memory.len());
        let columns: Vec<_> = (0..4 * n + size + 2 * n)
            .map(|moving| {
                let after = |from: usize| moving.wrapping_sub(from);
                let applied = Applied {
                    asked: self.parts.vector(self.u_m, after(4 * n + size)),
                    given: self.parts.vector(self.u_m, after(5 * n + size)),
                };
                let (x, z) = (self.parts.motion(self.motion, moving), self.z(after(4 * n)));
                let rate = self.law.rate(&self.parts.robot, &x, &self.q_ld, &z, &applied);
                rate.iter()
                    .take(size / n)
                    .flat_map(|part| part.iter().take(n))
                    .map(|x| x.gradient[0])
                    .collect()
            })
            .collect();
        Dense::from_columns(&columns)
    }

    /// By motion and memory: the torque.
    fn torque(&self) -> Dense<f64> {
        let n = self.parts.joints();
        let columns: Vec<_> = (0..4 * n + self.memory.len())
            .map(|moving| {
                let (x, z) = (self.parts.motion(self.motion, moving), self.z(moving.wrapping_sub(4 * n)));
                let u_m = self.law.torque(&self.parts.robot, &x, &self.q_ld, &z);
                u_m.iter().take(n).map(|u| u.gradient[0]).collect()
            })
            .collect();
        Dense::from_columns(&columns)
    }
}

/// Visits each number that something remembers of its first `joints` joints, by place.
struct Slots<F> {
    joints: usize,
    count: usize,
    visit: F,
}

impl<F: FnMut(usize, &mut Tangent)> Slots<F> {
    /// Visits the numbers of `memory`; says how many there are.
    fn of(memory: &mut impl Memory<Tangent>, joints: usize, visit: F) -> usize {
        let mut slots = Self { joints, count: 0, visit };
        memory.memory(&mut slots);
        slots.count
    }

    fn each(&mut self, x: &mut [Tangent]) {
        for x in x {
            (self.visit)(self.count, x);
            self.count += 1;
        }
    }
}

impl<F: FnMut(usize, &mut Tangent)> Port<Tangent> for Slots<F> {
    fn numbers(&mut self, _: &'static str, _: &'static str, x: &mut [Tangent]) {
        self.each(x);
    }

    fn joints(&mut self, _: &'static str, _: &'static str, x: &mut [Tangent]) {
        let joints = self.joints;
        self.each(&mut x[..joints]);
    }

    fn word(&mut self, _: &'static str, _: &mut u32) {}

    fn flag(&mut self, _: &'static str, _: &mut bool) {}
}
