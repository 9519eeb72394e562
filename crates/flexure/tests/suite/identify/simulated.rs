//! Logs of arms whose numbers are known: friction, encoders, torque steps, a delay of one period, under a joint controller that
//! follows slow sines and adds fast ones to the torque.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use flexure::Robot;
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Links as _, Motion};
use flexure::core::robots::Tree;
use flexure::logs::Log;
use flexure::plant::{Friction, Plant};
use flexure::robot::Links;
use flexure::simulate::{Ledger, Stepping};
use rand_distr::{Distribution, StandardNormal, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// K, M_m, D_l, D_m, Coulomb friction of link and motor, per joint.
pub type Truth = Vec<[f64; 6]>;

/// Sampling period and delay of the torque \[s\].
pub const PERIOD: f64 = 1e-3;
pub const DELAY: f64 = PERIOD;

/// One count of a link encoder of 17 bits and of a motor encoder of 4096 counts behind a gear of 100 \[rad\].
const COUNTS: [f64; 2] = [TAU / 131_072.0, TAU / 409_600.0];

/// Random numbers of a seed.
pub struct Draw(Xoshiro256PlusPlus);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        Uniform::new(low, high).expect("low < high").sample(&mut self.0)
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Numbers that the file's are up to 35 % off of, and damping and friction as shares of the torque.
    pub fn truth(&mut self, guess: &Robot) -> Truth {
        let mut joint = |i: usize| {
            let size = guess.limits.torque[i];
            [
                guess.stiffness[i] * self.between(0.72, 1.35),
                guess.motor_inertia[i] * self.between(0.75, 1.3),
                size * self.between(0.0042, 0.0078),
                size * self.between(0.0084, 0.0156),
                size * self.between(0.002, 0.006),
                size * self.between(0.006, 0.018),
            ]
        };
        (0..guess.joint_count()).map(&mut joint).collect()
    }
}

/// Amplitude, frequency in Hz and phase of sines.
type Sines = Vec<[f64; 3]>;

fn at(sines: &Sines, t: f64) -> f64 {
    sines.iter().map(|[amplitude, frequency, phase]| amplitude * (TAU * frequency * t + phase).sin()).sum()
}

/// A log of `seconds` of an arm with the numbers `truth` and the links of `guess`, with white torque noise of `noise` N m rms. `N`
/// is at least the joint count.
pub fn log<const N: usize>(guess: &Robot, truth: &Truth, seconds: f64, noise: f64, draw: &mut Draw) -> Log {
    let n = guess.joint_count();
    let plant = plant::<N>(guess, truth);
    let middle: Vec<f64> =
        guess.limits.lower.iter().zip(&guess.limits.upper).map(|(low, high)| 0.5 * (low + high)).collect();
    let mut sines = |list: &[f64], amplitude: &dyn Fn(usize) -> f64| -> Sines {
        let of = |(k, &frequency): (usize, &f64)| {
            [amplitude(k), frequency * draw.between(0.93, 1.07), draw.between(0.0, TAU)]
        };
        list.iter().enumerate().map(of).collect()
    };
    let slow: Vec<Sines> = (0..n)
        .map(|_| sines(&[0.15, 0.3, 0.55, 0.9, 1.4, 2.3], &|k| 0.08 / (1.0 + 0.3 * k as f64)))
        .collect();
    let lines: Vec<f64> = (0..12).map(|k| 3.0 * 20.0_f64.powf(f64::from(k) / 11.0)).collect();
    let fast: Vec<Sines> = (0..n).map(|i| sines(&lines, &|_| 0.02 * guess.limits.torque[i])).collect();
    let posture = |t: f64| Vector::from_fn(|i| if i < n { middle[i] + at(&slow[i], t) } else { 0.0 });
    let mut x = Motion::at_rest(posture(0.0));
    x.q_m = plant.robot.motors_at_rest(&x.q_l);
    let read = |q: f64, side: usize| (q / COUNTS[side]).round() * COUNTS[side];
    let (mut q_l, mut q_m, mut u_m) = (Vec::new(), Vec::new(), Vec::new());
    let mut late = VecDeque::from([plant.robot.links.gravity_torque(&x.q_l)]);
    let (mut stepping, mut ledger) = (Stepping::new(0.05e-3), Ledger::default());
    let (mut before, mut speed) = (x.q_m, Vector::<f64, N>::ZERO);
    let times = (0_u32..).map(|k| f64::from(k) * PERIOD);
    for t in times.take_while(|t| *t < seconds - 0.5 * PERIOD) {
        let (wanted, soon) = (posture(t), posture(t + 1e-4));
        let weight = plant.robot.links.gravity_torque(&wanted);
        let mut u = Vector::ZERO;
        for i in 0..n {
            let motor = read(x.q_m[i], 1);
            speed[i] += 0.2 * ((motor - before[i]) / PERIOD - speed[i]);
            before[i] = motor;
            let (inertia, rate) = (guess.motor_inertia[i] + 0.003 * guess.limits.torque[i], 2.0 * TAU);
            let behind = wanted[i] + weight[i] / guess.stiffness[i] - motor;
            let slower = (soon[i] - wanted[i]) / 1e-4 - speed[i];
            let asked = weight[i] + inertia * (rate * rate * behind + 1.4 * rate * slower) + at(&fast[i], t);
            let step = guess.limits.torque[i] / 4096.0;
            u[i] = (asked / step).round() * step;
            q_l.push(read(x.q_l[i], 0));
            q_m.push(motor);
            u_m.push(u[i]);
        }
        late.push_back(u);
        let given = late.pop_front().expect("one period late");
        let given = Vector::from_fn(|i| if i < n { given[i] + noise * draw.normal() } else { 0.0 });
        x = stepping.advance(&plant, x, t, PERIOD, &|_, _| given, &mut ledger).expect("a tame motion");
    }
    let (q_l, q_m) = (Some(q_l), Some(q_m));
    Log { name: "simulated".to_owned(), period: PERIOD, joints: n, q_l, q_m, dq_l: None, dq_m: None, u_m }
}

fn plant<const N: usize>(guess: &Robot, truth: &Truth) -> Plant<Tree<f64, N>, N> {
    let Links::Tree(bodies) = &guess.links else { panic!("a tree") };
    let links = Tree::from_bodies(bodies, guess.gravity, |x| x).expect("a tree that fits");
    let of = |k: usize, pad: f64| Vector::from_fn(|i| truth.get(i).map_or(pad, |joint| joint[k]));
    let mut plant = Plant::from(Fjr {
        links,
        stiffness: of(0, 1.0),
        motor_inertia: of(1, 1.0),
        link_damping: of(2, 0.0),
        motor_damping: of(3, 0.0),
    });
    plant.link_friction = Friction::coulomb(of(4, 0.0));
    plant.motor_friction = Friction::coulomb(of(5, 0.0));
    plant
}
