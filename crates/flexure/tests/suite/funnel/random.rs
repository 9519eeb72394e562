//! Robots, gains, tolerances and torques at random: no run of a robot within the tolerances, under any torque that is drawn, leaves the bounds
//! of a funnel.
//!
//! Nothing is shared with what makes funnels: the robot that is off is a file of its own, and what is run is the law and the dynamics of the
//! simulation in floats.

use std::fmt::Write as _;
use std::path::Path;

use flexure::Scenario;
use flexure::core::scalar::Interval;
use flexure::progress::unwatched;
use flexure::prove::engine::envelope::deviation::Spread;
use flexure::prove::robust::{Robust, robust};
use flexure::robot::Arm;
use flexure::scenario::scenario_from_text;
use flexure::simulate::Loop;
use rayon::prelude::*;

use crate::common::Random;

/// Numbers of a chain of turning joints.
#[derive(Clone)]
pub(crate) struct Chain {
    axes: Vec<[f64; 3]>,
    places: Vec<[f64; 3]>,
    masses: Vec<f64>,
    stiffness: Vec<f64>,
    motor_inertia: Vec<f64>,
    link_damping: Vec<f64>,
    motor_damping: Vec<f64>,
}

impl Chain {
    /// The robot file.
    fn text(&self) -> String {
        let mut text = "name = 'random'\ngravity = [0.0, 0.0, -9.81]\n[links]\nkind = 'tree'\n".to_owned();
        for (i, ((axis, place), mass)) in self.axes.iter().zip(&self.places).zip(&self.masses).enumerate() {
            let parent = if i > 0 { format!("parent = 'j{}'\n", i - 1) } else { String::new() };
            // A body of its joint's size, its middle halfway to the next: inertias are as heavy as it is.
            let [along, across] = [0.02, 0.01].map(|square| mass * square);
            write!(
                text,
                "[[links.joint]]\nname = 'j{i}'\nkind = 'revolute'\naxis = {axis:?}\nxyz = {place:?}\nmass = {mass:?}\n\
                 com = [0.1, 0.02, 0.0]\ninertia = [{across:?}, 0.0, 0.0, {along:?}, 0.0, {along:?}]\n{parent}"
            )
            .unwrap();
        }
        let Self { stiffness, motor_inertia, link_damping, motor_damping, .. } = self;
        text + &format!(
            "[joints]\nstiffness = {stiffness:?}\nmotor_inertia = {motor_inertia:?}\nlink_damping = {link_damping:?}\n\
             motor_damping = {motor_damping:?}\n"
        )
    }

    /// With numbers that are up to these parts off.
    fn off(&self, parts: &Parts, noise: &mut Random) -> Self {
        // Mostly as far as may be.
        let mut other = |values: &[f64], part: f64| -> Vec<f64> {
            let one = |x: &f64| {
                let r = noise.next();
                x * (1.0 + part * if noise.below(3) == 0 { r } else { r.signum() } * (1.0 - 1e-9))
            };
            values.iter().map(one).collect()
        };
        Self {
            masses: other(&self.masses, parts.mass),
            stiffness: other(&self.stiffness, parts.drive),
            motor_inertia: other(&self.motor_inertia, parts.drive),
            link_damping: other(&self.link_damping, parts.damping),
            motor_damping: other(&self.motor_damping, parts.damping),
            ..self.clone()
        }
    }
}

/// By which parts numbers may be off.
struct Parts {
    mass: f64,
    /// K and M_m.
    drive: f64,
    /// D_l and D_m.
    damping: f64,
}

/// A scenario, and what it is to bear.
pub(crate) struct Case {
    pub chain: Chain,
    scenario: Scenario,
    /// Its file.
    pub text: String,
    parts: Parts,
    /// Largest torques on links and motors [N m].
    torques: [Vec<f64>; 2],
}

/// What the joints feel of inertia where all are at 0, each with the others free.
fn felt(chain: &Chain) -> Vec<f64> {
    let n = chain.masses.len();
    let arm = loaded(chain, STILL).unwrap().robot.arm().unwrap();
    let unit = |i: usize| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<_>>();
    let inverse = |i: usize| {
        let mut column = vec![0.0; n];
        arm.solve_mass(&vec![0.0; n], &unit(i), &mut column).unwrap();
        column[i]
    };
    (0..n).map(|i| inverse(i).recip()).collect()
}

/// A scenario that any robot may be loaded with.
const STILL: &str = "robot = 'robot.toml'\nduration = 1.0\ncontrol_period = 0.001\n[reference]\nkind = 'sine'\namplitude = 0.1\nfrequency = 1.0\n\
                     [controller]\nkind = 'vcbc'\nphi = 'tanh'\nlink = { metric = 1.0, shaping = 1.0, damping = 1.0 }\n\
                     motor = { metric = 1.0, shaping = 1.0, damping = 1.0 }\n";

pub(crate) fn drawn(number: u64) -> Case {
    let mut r = Random(5000 + number);
    let n = [1, 2, 2, 3][r.below(4)];
    // As likely to be in one part of a decade as in any other.
    let between = |r: &mut Random, low: f64, high: f64| low * (high / low).powf(0.5 * (1.0 + r.next()));
    let times = |r: &mut Random, values: &[f64], low: f64, high: f64| {
        values.iter().map(|x| x * between(r, low, high)).collect::<Vec<_>>()
    };
    let axis = |r: &mut Random| {
        let v = [r.next(), r.next(), 1.0];
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / length)
    };
    let ones = vec![1.0; n];
    let chain = Chain {
        axes: (0..n).map(|_| axis(&mut r)).collect(),
        places: (0..n)
            .map(|i| if i == 0 { [0.0; 3] } else { [0.2, 0.1 * r.next(), 0.1 * r.next()] })
            .collect(),
        masses: (0..n).map(|i| between(&mut r, 0.5, 4.0) / (1.0 + i as f64)).collect(),
        stiffness: ones.clone(),
        motor_inertia: ones.clone(),
        link_damping: ones.clone(),
        motor_damping: ones,
    };
    let inertia = felt(&chain);
    let chain = Chain {
        stiffness: times(&mut r, &inertia, 800.0, 4000.0),
        motor_inertia: times(&mut r, &inertia, 0.3, 2.0),
        link_damping: times(&mut r, &inertia, 0.01, 1.0),
        motor_damping: times(&mut r, &inertia, 0.01, 1.0),
        ..chain
    };
    let metric = times(&mut r, &inertia, 60.0, 400.0);
    let damping = times(&mut r, &inertia, 8.0, 25.0);
    let motor_metric = times(&mut r, &chain.stiffness, 0.6, 3.0);
    let motor_damping = times(&mut r, &chain.motor_inertia, 15.0, 60.0);
    let shaping = [(); 2].map(|()| between(&mut r, 4.0, 16.0));
    // A third of them none.
    let mut part = |most: f64| if r.below(3) == 0 { 0.0 } else { between(&mut r, 0.01 * most, most) };
    let parts = Parts { mass: part(0.03), drive: part(0.01), damping: part(0.1) };
    let torques = [&inertia, &chain.motor_inertia].map(|inertia| times(&mut r, inertia, 0.003, 0.1));
    let amplitude = times(&mut r, &vec![1.0; n], 0.1, 0.8);
    let frequency = times(&mut r, &vec![1.0; n], 0.3, 1.5);
    let phi = ["tanh", "linear"][r.below(2)];
    let [shaping, motor_shaping] = shaping;
    let text = format!(
        "robot = 'robot.toml'\nduration = 2.0\ncontrol_period = 0.001\ninitial = 'at rest'\n\
         [reference]\nkind = 'sine'\namplitude = {amplitude:?}\nfrequency = {frequency:?}\n\
         [reference.smooth_start]\nduration = 2.0\n[controller]\nkind = 'vcbc'\nphi = '{phi}'\n\
         [controller.link]\nmetric = {metric:?}\nshaping = {shaping:?}\ndamping = {damping:?}\n\
         [controller.motor]\nmetric = {motor_metric:?}\nshaping = {motor_shaping:?}\ndamping = {motor_damping:?}\n"
    );
    let scenario = loaded(&chain, &text).unwrap_or_else(|problems| panic!("{number}: {problems}\n{text}"));
    Case { chain, scenario, text, parts, torques }
}

pub(crate) fn loaded(chain: &Chain, text: &str) -> Result<Scenario, flexure::files::Problems> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), chain.text()).unwrap();
    scenario_from_text("scenario.toml", text, Path::new(folder.path()))
}

impl Case {
    /// The file of its funnel, if it has one.
    pub(crate) fn file(&self) -> Option<String> {
        let found = robust(&self.scenario, &self.spread(), Some(1000), &unwatched).unwrap().unwrap();
        found.ok().map(|funnel| funnel.file(&self.scenario).expect("a law that funnels speak of"))
    }

    fn spread(&self) -> Spread {
        let Self { chain, parts, torques: [links, motors], .. } = self;
        // Rounding of the products is more than made up for by drawing 1e-9 less.
        let points =
            |values: &[f64], part: f64| values.iter().map(|x| Interval::point(x * part)).collect::<Vec<_>>();
        Spread {
            stiffness: points(&chain.stiffness, parts.drive),
            motor_inertia: points(&chain.motor_inertia, parts.drive),
            link_damping: points(&chain.link_damping, parts.damping),
            motor_damping: points(&chain.motor_damping, parts.damping),
            link_mass: vec![Interval::point(parts.mass); chain.masses.len()],
            motor_torque: points(motors, 1.0),
            link_torque: points(links, 1.0),
        }
    }
}

/// A run: the robot that is off, the law, and torques that jump.
struct Run<'a> {
    arm: Box<dyn Arm>,
    held: &'a dyn Loop,
    /// On links and motors [N m].
    torques: [Vec<f64>; 2],
}

impl Run<'_> {
    fn rates(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let n = x.len() / 4;
        let mut u_m = vec![0.0; n];
        self.held.torque(t, x, &mut u_m).unwrap();
        u_m.iter_mut().zip(&self.torques[1]).for_each(|(u, d)| *u += d);
        let (mut a, mut pushed) = (vec![0.0; 2 * n], vec![0.0; n]);
        self.arm.forward_dynamics(x, &u_m, &mut a).unwrap();
        self.arm.solve_mass(&x[..n], &self.torques[0], &mut pushed).unwrap();
        a.iter_mut().zip(&pushed).for_each(|(a, push)| *a += push);
        [&x[2 * n..], &a[..]].concat()
    }

    /// By the classical Runge–Kutta method.
    fn step(&self, t: f64, x: &[f64], h: f64) -> Vec<f64> {
        let moved = |rates: &[f64], h: f64| x.iter().zip(rates).map(|(x, r)| x + h * r).collect::<Vec<_>>();
        let k1 = self.rates(t, x);
        let k2 = self.rates(t + 0.5 * h, &moved(&k1, 0.5 * h));
        let k3 = self.rates(t + 0.5 * h, &moved(&k2, 0.5 * h));
        let k4 = self.rates(t + h, &moved(&k3, h));
        (0..x.len()).map(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])).collect()
    }
}

/// Largest parts of the bounds of link errors, link speeds, deflections, motor torques and how fast these change that runs reach under torques `times` as large.
fn fullest(case: &Case, bounds: &Robust, runs: usize, times: f64, noise: &mut Random) -> [f64; 5] {
    let Case { chain, scenario, text, parts, torques } = case;
    let n = chain.masses.len();
    let held = scenario.open().unwrap();
    let of = &scenario.initial;
    let begin = [&of.q_l[..], &of.q_m, &of.dq_l, &of.dq_m].concat();
    let fastest = scenario.vcbc().unwrap().motor.metric.iter().zip(&chain.motor_inertia);
    let fastest = fastest.map(|(metric, inertia)| (metric / inertia).sqrt()).fold(100.0, f64::max);
    let h = 0.3 / fastest;
    let mut most = [0.0_f64; 5];
    for _ in 0..runs {
        let arm = loaded(&chain.off(parts, noise), text).unwrap().robot.arm().unwrap();
        let mut run = Run { arm, held: &*held, torques: [vec![0.0; n], vec![0.0; n]] };
        let (mut x, mut u_m, mut reference) = (begin.clone(), vec![0.0; n], vec![[0.0; 5]; n]);
        held.torque(0.0, &x, &mut u_m).unwrap();
        for step in (0..).take_while(|&step| h * f64::from(step + 1) <= scenario.duration) {
            if step % 20 == 0 {
                for (now, most) in run.torques.iter_mut().zip(torques) {
                    let torque = |most: &f64| times * most.copysign(noise.next());
                    *now = most.iter().map(torque).collect();
                }
            }
            x = run.step(h * f64::from(step), &x, h);
            let t = h * f64::from(step + 1);
            held.reference(t, &mut reference).unwrap();
            let before = u_m.clone();
            held.torque(t, &x, &mut u_m).unwrap();
            for i in 0..n {
                let seen = [
                    (x[i] - reference[i][0]) / bounds.error[i],
                    x[2 * n + i] / bounds.velocity.bound[i],
                    (x[n + i] - x[i]) / bounds.deflection.bound[i],
                    u_m[i] / bounds.torque.bound[i],
                    // The mean over a step is the rate somewhere in it.
                    (u_m[i] - before[i]) / h / bounds.torque_rate.bound[i],
                ];
                most.iter_mut().zip(seen).for_each(|(most, seen)| *most = most.max(seen.abs()));
            }
        }
    }
    most
}

/// What many robots come to.
struct Found {
    /// Those that have a funnel.
    with: usize,
    /// Those that leave it under torques four times as large.
    leave: usize,
    /// The largest parts of their bounds that were reached.
    fullest: Vec<[f64; 5]>,
}

fn examine(numbers: std::ops::Range<u64>, runs: usize) -> Found {
    let one = |number: u64| {
        let case = drawn(number);
        let found = robust(&case.scenario, &case.spread(), Some(1000), &unwatched).unwrap().unwrap();
        let bounds = found.ok()?;
        let most = fullest(&case, &bounds, runs, 1.0, &mut Random(number));
        assert!(most.iter().all(|&part| part <= 1.0), "robot {number}: {most:?} of the bounds");
        let leaves = fullest(&case, &bounds, 1, 4.0, &mut Random(number)).iter().any(|&part| part > 1.0);
        Some((most, leaves))
    };
    let count = numbers.end - numbers.start;
    let found: Vec<_> = numbers.into_par_iter().filter_map(one).collect();
    let leave = found.iter().filter(|(_, leaves)| *leaves).count();
    let fullest: Vec<_> = found.into_iter().map(|(most, _)| most).collect();
    let of = |k: usize| {
        let mut all: Vec<f64> = fullest.iter().map(|most| most[k]).collect();
        all.sort_by(f64::total_cmp);
        [all[all.len() / 2], all[all.len() - 1]]
    };
    println!(
        "{} of {count} robots have a funnel, {leave} leave it under four times the torques; of their bounds is reached (median, most): \
         link errors {:.3?}, speeds {:.3?}, deflections {:.3?}, torques {:.3?}, their rates {:.3?}",
        fullest.len(),
        of(0),
        of(1),
        of(2),
        of(3),
        of(4)
    );
    Found { with: fullest.len(), leave, fullest }
}

#[test]
fn no_run_leaves_its_bounds() {
    let Found { with, leave, fullest } = examine(0..12, 3);
    assert!(with >= 6 && leave >= 3, "{with} {leave}");
    // Wide bounds would say nothing.
    assert!(fullest.iter().any(|most| most[0] > 0.3), "{fullest:?}");
}

/// `cargo test --release -p flexure --test suite funnel::random:: -- --ignored --nocapture`
#[test]
#[ignore = "a quarter of an hour: 2,000 robots"]
fn two_thousand_robots_keep_to_their_bounds() {
    let Found { with, leave, .. } = examine(1000..3000, 5);
    assert!(with >= 1000 && leave >= 500, "{with} {leave}");
}
