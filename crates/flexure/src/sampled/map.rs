//! The map of a loop from one control instant to the next, linearised.
//!
//! Each signal at an instant is a linear function of what the loop is then: a matrix with a column for each number of its state.
//! The state is the motion, readings that are held, what estimators remember, the torque that was reported, and torques on
//! their way.

use crate::linalg::{Dense, exponential};
use crate::sampled::devices::Devices;
use crate::sampled::lifted::{Device, LawDevice, Lifted, Nominal};

/// A motion over a part of a control period: x⁺ = Φ x + Γ u.
#[derive(Clone, Debug)]
pub(crate) struct Flow {
    /// Φ, of 4n rows.
    state: Dense<f64>,
    /// Γ, of 4n rows.
    input: Dense<f64>,
}

impl Flow {
    /// Over `length` in s, by the exponential of the Magnus series to order 4: exact where the plant's Jacobian does not change.
    /// `nominal` says how the robot moves meanwhile, by the time since the beginning. Blanes, Casas, Oteo & Ros, *The Magnus
    /// expansion and some of its applications*, Physics Reports 470 (2009), eq. 253.
    pub fn over(lifted: &dyn Lifted, length: f64, nominal: &dyn Fn(f64) -> Nominal) -> Self {
        let apart = 3.0_f64.sqrt() / 6.0;
        let [one, two] =
            [0.5 - apart, 0.5 + apart].map(|node| extended(&lifted.plant(&nominal(node * length))));
        let mean = (&one + &two).scaled(0.5 * length);
        let commutator = &(&two * &one) + &(&one * &two).scaled(-1.0);
        let flow = exponential(&(&mean + &commutator.scaled(0.5 * apart * length * length)));
        let (size, n) = (flow.columns(), flow.columns() / 5);
        let part = |from: usize, count: usize| Dense::from_fn(size - n, count, |i, j| flow[(i, from + j)]);
        Self { state: part(0, 4 * n), input: part(4 * n, n) }
    }

    fn after(&self, x: &Dense<f64>, u_m: &Dense<f64>) -> Dense<f64> {
        &(&self.state * x) + &(&self.input * u_m)
    }
}

/// [[A, B], [0, 0]] from [A, B]: with the torque as a part of the state that stays.
fn extended(plant: &Dense<f64>) -> Dense<f64> {
    let size = plant.columns();
    let below = Dense::zeros(size - plant.rows().len(), size);
    Dense::stacked(&[plant, &below])
}

/// How the torque of a law moves.
#[derive(Clone, Debug)]
pub(crate) enum LawSlope {
    /// By the motion that is seen: n rows by 4n columns.
    Static(Dense<f64>),
    /// By that and its memory.
    Dynamic(LawDevice),
}

impl LawSlope {
    /// How many numbers it remembers, if it does.
    fn memory(&self) -> Option<usize> {
        match self {
            Self::Static(_) => None,
            Self::Dynamic(device) => Some(device.memory),
        }
    }
}

/// A loop around a nominal motion, but for its law.
#[derive(Clone, Debug)]
pub(crate) struct Around {
    devices: Devices,
    period: f64,
    /// Over the part of a period with the torque before, if there is one, and with the torque after.
    flows: (Option<Flow>, Flow),
    estimator: Option<Device>,
    disturbance: Option<Device>,
    joints: usize,
}

impl Around {
    /// Of a loop that is at `before` a control period before `nominal(0)` and moves on so.
    pub fn new(
        lifted: &dyn Lifted,
        devices: &Devices,
        period: f64,
        before: &Nominal,
        nominal: &dyn Fn(f64) -> Nominal,
    ) -> Self {
        let (offset, now) = (devices.offset, nominal(0.0));
        let late = (offset > 0.0).then(|| Flow::over(lifted, offset, nominal));
        let rest = Flow::over(lifted, period - offset, &|t| nominal(offset + t));
        Self {
            devices: devices.clone(),
            period,
            flows: (late, rest),
            estimator: lifted.estimator(before, &now),
            disturbance: lifted.disturbance(before, &now),
            joints: now.u_m.len(),
        }
    }

    /// The map over a cycle of the devices with the law `law`.
    pub fn cycle(&self, law: &LawSlope) -> Dense<f64> {
        let mut state = State::start(self, law.memory());
        let size = state.size();
        for k in 0..self.devices.cycle {
            state = self.next(state, law, k);
        }
        let all = state.stacked();
        debug_assert_eq!(all.columns(), size);
        all
    }

    fn next(&self, before: State, law: &LawSlope, k: u32) -> State {
        let n = self.joints;
        let State { motion, mut held, estimator, disturbance, mut law_s, reported, mut kept, mut waiting } =
            before;
        let mut readings = motion.clone();
        for (side, held) in held.iter_mut().enumerate() {
            let Some(held) = held else { continue };
            if self.devices.delivers(side, k) {
                *held = Dense::stacked(&[
                    &motion.slice(side * n..(side + 1) * n),
                    &motion.slice((side + 2) * n..(side + 3) * n),
                ]);
            }
            for i in 0..n {
                for j in 0..motion.columns() {
                    readings[(side * n + i, j)] = held[(i, j)];
                    readings[((side + 2) * n + i, j)] = held[(n + i, j)];
                }
            }
        }
        let (seen, estimator) = through(self.estimator.as_ref(), readings, estimator, &reported, 4 * n);
        let mut asked = match law {
            LawSlope::Static(slope) => slope * &seen,
            LawSlope::Dynamic(LawDevice { memory, slope }) => {
                let [was_seen, z, asked] = &law_s;
                let after = slope * &Dense::stacked(&[&seen, was_seen, z, asked, &reported]);
                law_s = [seen.clone(), after.slice(n..n + memory), asked.clone()];
                after.slice(0..n)
            }
        };
        let mut disturbance = disturbance;
        if self.disturbance.is_some() {
            let (torque, after) = through(self.disturbance.as_ref(), seen, disturbance, &reported, n);
            asked = &asked + &torque.scaled(-1.0);
            disturbance = after;
        }
        if let LawSlope::Dynamic(_) = law {
            law_s[2].clone_from(&asked);
        }
        if let Some(kept) = &mut kept {
            if self.devices.misses(k) {
                asked.clone_from(kept);
            } else {
                kept.clone_from(&asked);
            }
        }
        waiting.push(asked);
        let first = waiting.remove(0);
        let (late, rest) = &self.flows;
        let (motion, mean) = match late {
            None => (rest.after(&motion, &first), first),
            Some(late) => {
                let (then, share) = (&waiting[0], self.devices.offset / self.period);
                let mean = &first.scaled(share) + &then.scaled(1.0 - share);
                (rest.after(&late.after(&motion, &first), then), mean)
            }
        };
        let reported = if reported.rows().len() == 0 { reported } else { mean };
        State { motion, held, estimator, disturbance, law_s, reported, kept, waiting }
    }
}

/// Output and memory after an instant of a device, if there is one: else what it is given passes.
fn through(
    device: Option<&Device>,
    given: Dense<f64>,
    memory: Dense<f64>,
    reported: &Dense<f64>,
    outputs: usize,
) -> (Dense<f64>, Dense<f64>) {
    let Some(device) = device else { return (given, memory) };
    let after = &device.slope * &Dense::stacked(&[&given, &memory, reported]);
    (after.slice(0..outputs), after.slice(outputs..outputs + device.memory))
}

/// What a loop is at a control instant, before anything happens there, as functions of what it was at the first.
struct State {
    motion: Dense<f64>,
    /// Positions, then velocities, of each side whose sensors are slow.
    held: [Option<Dense<f64>>; 2],
    estimator: Dense<f64>,
    disturbance: Dense<f64>,
    /// Of a law with memory: the motion that was seen, the memory, and what left the controller; no rows of others.
    law_s: [Dense<f64>; 3],
    /// Mean torque of the period before; no rows where nobody asks.
    reported: Dense<f64>,
    /// The last command, where instants are missed.
    kept: Option<Dense<f64>>,
    waiting: Vec<Dense<f64>>,
}

impl State {
    /// Of a loop whose law has so many numbers in its memory, if it has one.
    fn start(around: &Around, law: Option<usize>) -> Self {
        let (n, devices) = (around.joints, &around.devices);
        let memory = |device: &Option<Device>| device.as_ref().map_or(0, |device| device.memory);
        let asks = around.estimator.is_some() || around.disturbance.is_some() || law.is_some();
        let slow = devices.sampling.map(|periods| periods > 1);
        let counts = [
            4 * n,
            2 * n * usize::from(slow[0]),
            2 * n * usize::from(slow[1]),
            memory(&around.estimator),
            memory(&around.disturbance),
            law.map_or(0, |_| 4 * n),
            law.unwrap_or(0),
            law.map_or(0, |_| n),
            n * usize::from(asks),
            n * usize::from(devices.every.is_some()),
        ];
        let size: usize = counts.iter().sum::<usize>() + devices.waiting * n;
        let all = Dense::identity(size);
        let mut from = 0;
        let mut next = |count: usize| {
            from += count;
            all.slice(from - count..from)
        };
        let [motion, link, motor, estimator, disturbance, seen, memory, asked, reported, kept] =
            counts.map(&mut next);
        Self {
            motion,
            held: [slow[0].then_some(link), slow[1].then_some(motor)],
            estimator,
            disturbance,
            law_s: [seen, memory, asked],
            reported,
            kept: devices.every.is_some().then_some(kept),
            waiting: (0..devices.waiting).map(|_| next(n)).collect(),
        }
    }

    fn size(&self) -> usize {
        self.motion.columns()
    }

    fn stacked(&self) -> Dense<f64> {
        let held = self.held.iter().flatten();
        let parts = [&self.motion].into_iter().chain(held).chain([&self.estimator, &self.disturbance]);
        let parts = parts.chain(&self.law_s).chain([&self.reported]);
        let parts: Vec<_> = parts.chain(&self.kept).chain(&self.waiting).collect();
        Dense::stacked(&parts)
    }
}
