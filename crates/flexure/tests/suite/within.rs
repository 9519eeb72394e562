//! What is said of every robot within the tolerances of the robot file, against robots that are within them.

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::sync::Mutex;

use flexure::core::linalg::Vector;
use flexure::core::model::{Links as _, Motion};
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::Interval;
use flexure::progress::unwatched;
use flexure::prove::engine::envelope::deviation::{Deviation, Spread};
use flexure::prove::question::{Proof, Question, prove, prove_watched};
use flexure::prove::within::Within;
use flexure::robot::Tolerances;
use flexure::scenario::{Scenario, load_scenario};

use crate::along::floats::{self, Floats};
use crate::along::slabs::enclosed;
use crate::common::Random;

type Arm = Floats<PlanarTwoLink<f64>, 2>;

/// K, M_m, D_l, D_m of both joints, and an unknown torque on their motors.
type Numbers = [Vector<f64, 2>; 5];

/// An arm with drives as such arms have them, and gains for 16 1/s.
const SCENARIO: &str = r#"robot = "two-link-plausible"
duration = 8.0
control_period = 0.001
[reference]
kind = "sine"
amplitude = [1.0, 1.0]
frequency = [0.6, 0.6]
[reference.smooth_start]
duration = 4.0
[controller]
kind = "vcbc"
phi = "linear"
link = { metric = [57.0, 2.7], shaping = [16.0, 16.0], damping = [3.2, 0.05] }
motor = { metric = [80.0, 14.0], shaping = [16.0, 16.0], damping = [0.06, 0.003] }
"#;

/// What identification leaves open, as parts of the numbers.
pub const IDENTIFIED: [f64; 4] = [0.0003, 0.0003, 0.02, 0.01];

/// Largest unknown torque on each motor [N m].
const UNKNOWN: [f64; 2] = [0.02, 0.01];

pub fn scenario() -> Scenario {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    fs::write(&path, SCENARIO).unwrap();
    load_scenario(path.to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// `scenario` with tolerances that are these parts of its robot's numbers.
pub fn tolerant(mut scenario: Scenario, parts: [f64; 4]) -> Scenario {
    let robot = &mut scenario.robot;
    let part = |values: &[f64], part: f64| values.iter().map(|x| x * part).collect::<Vec<_>>();
    robot.tolerances = Tolerances {
        stiffness: part(&robot.stiffness, parts[0]),
        motor_inertia: part(&robot.motor_inertia, parts[1]),
        link_damping: part(&robot.link_damping, parts[2]),
        motor_damping: part(&robot.motor_damping, parts[3]),
    };
    scenario
}

pub fn proof(scenario: &Scenario) -> Proof {
    proof_with(scenario, None)
}

/// With so much of an unknown torque on each motor [N m].
fn proof_with(scenario: &Scenario, torque: Option<[f64; 2]>) -> Proof {
    let question = Question { disturbance: torque.map(|torque| torque.to_vec()), ..Question::default() };
    prove(scenario, &question).unwrap_or_else(|problems| panic!("{problems}"))
}

fn within(scenario: &Scenario) -> Within {
    within_with(scenario, None)
}

fn within_with(scenario: &Scenario, torque: Option<[f64; 2]>) -> Within {
    match proof_with(scenario, torque).within {
        Some(Ok(within)) => within,
        other => panic!("{other:?}"),
    }
}

/// The convergence rate that is certified of the numbers of the file.
fn certified(scenario: &Scenario) -> f64 {
    proof(scenario).verdict.proved().expect("proved").convergence_rate.approximate()
}

/// Where nothing is shown of the tolerances of the file: the largest of their halves, quarters and so on of which something is, and
/// which tolerance counts most there.
#[test]
fn what_is_too_wide_to_prove_names_what_counts_most() {
    let parts = IDENTIFIED.map(|part| 16.0 * part);
    let wide = proof(&tolerant(scenario(), parts));
    let Some(Err(open)) = &wide.within else { panic!("{:?}", wide.within) };
    let closer = open.closer.as_ref().expect("something is shown of smaller ones");
    let at = |factor: f64| proof(&tolerant(scenario(), parts.map(|part| factor * part))).within;
    let Some(Ok(found)) = at(closer.factor) else { panic!("{closer:?}") };
    assert!((found.rate / closer.rate - 1.0).abs() < 1e-6, "{closer:?}: {found:?}");
    assert!(matches!(at(2.0 * closer.factor), Some(Err(_))), "{closer:?}");
    // Errors by one tolerance alone are less than those by all, and to take it away helps.
    assert!(closer.share > 0.0 && closer.share < 1.0, "{closer:?}");
    let mut without = tolerant(scenario(), parts.map(|part| closer.factor * part));
    let tolerances = &mut without.robot.tolerances;
    let values = match closer.key {
        "stiffness" => &mut tolerances.stiffness,
        "motor_inertia" => &mut tolerances.motor_inertia,
        "link_damping" => &mut tolerances.link_damping,
        _ => &mut tolerances.motor_damping,
    };
    values[closer.joint] = 0.0;
    assert!(within(&without).settles < found.settles, "{closer:?}");
    let (problem, is_wrong) = wide.complaint(&tolerant(scenario(), parts)).unwrap();
    assert!(!is_wrong && problem.hint().contains("with all tolerances times"), "{}", problem.hint());
}

/// By how much the accelerations of links and motors differ from the model's where its numbers are off by `off`.
fn difference(arm: &Arm, off: &Numbers, x: &Motion<f64, 2>, u_m: &Vector<f64, 2>) -> [Vector<f64, 2>; 2] {
    let [stiffness, inertia, link_damping, motor_damping, torque] = off;
    let zeta = x.deflection();
    let robot = &arm.robot;
    let on_links = stiffness.diag_mul(&zeta) - link_damping.diag_mul(&x.v_l);
    let a_l = robot.links.mass_matrix(&x.q_l).ldl().solve(&on_links);
    let a_m = Vector::from_fn(|i| {
        let mass = robot.motor_inertia[i];
        let known = u_m[i] - robot.motor_damping[i] * x.v_m[i] - robot.stiffness[i] * zeta[i];
        let real = u_m[i]
            - (robot.motor_damping[i] + motor_damping[i]) * x.v_m[i]
            - (robot.stiffness[i] + stiffness[i]) * zeta[i]
            + torque[i];
        real / (mass + inertia[i]) - known / mass
    });
    [a_l, a_m]
}

/// Numbers that are off by as much as may be, or a random part of that, and a torque of at most `torque`.
fn drawn(tolerances: &Tolerances, torque: [f64; 2], r: &mut Random) -> Numbers {
    let [k, m, d_l, d_m] = tolerances.named().map(|(_, values)| [values[0], values[1]]);
    [k, m, d_l, d_m, torque].map(|most| {
        Vector(most.map(|most| if r.below(3) == 0 { most * r.next() } else { most.copysign(r.next()) }))
    })
}

/// √(2 W_b) of the four blocks.
fn lengths(arm: &Arm, x: &Motion<f64, 2>, t: f64) -> [f64; 4] {
    let command = arm.command(t, x);
    let flexure::core::control::Metric::Constant(metric) = &arm.law.link.metric else { panic!("constant") };
    let form = |d: &Vector<f64, 2>, e: &Vector<f64, 2>| e.dot(&d.diag_mul(e)).sqrt();
    [
        form(metric, &command.e_l),
        form(&arm.law.motor.metric, &command.e_m),
        command.s_l.dot(&arm.robot.links.mass_mul(&x.q_l, &command.s_l)).sqrt(),
        form(&arm.robot.motor_inertia, &command.s_m),
    ]
}

/// `x` with the errors of one block alone: q̃_m, s_l or s_m.
fn alone(arm: &Arm, x: &Motion<f64, 2>, t: f64, block: usize) -> Motion<f64, 2> {
    let command = arm.command(t, x);
    let mut errors = [Vector::ZERO; 4];
    errors[block] = [command.e_l, command.e_m, command.s_l, command.s_m][block];
    arm.motion(t, errors)
}

/// What a difference of the numbers adds to Ẇ: by differences of W where the accelerations lead. Its bound in intervals is never
/// below it, and not far above: a term that is missing, or has the wrong sign or corner, does not pass. Each kind of number alone,
/// where the reference decides (a narrow tube) and where the errors do.
#[test]
fn what_differences_add_is_bounded_and_tight() {
    let mut r = Random(11);
    for kind in 0..6 {
        let of_kind = |k: usize| k == kind || kind == 5;
        // Inertias by so much that a lighter motor and a heavier one are far apart.
        let parts = [0.02, 0.2, 0.02, 0.02];
        let parts = std::array::from_fn(|k| if of_kind(k) { parts[k] } else { 0.0 });
        let torque = if of_kind(4) { UNKNOWN } else { [0.0; 2] };
        let scenario = tolerant(scenario(), parts);
        let (arm, system) = (floats::arm(&scenario), enclosed(&scenario));
        let tolerances = &scenario.robot.tolerances;
        let points = |values: &[f64]| values.iter().map(|&x| Interval::point(x)).collect::<Vec<_>>();
        let spread = Spread {
            stiffness: points(&tolerances.stiffness),
            motor_inertia: points(&tolerances.motor_inertia),
            link_damping: points(&tolerances.link_damping),
            motor_damping: points(&tolerances.motor_damping),
            motor_torque: points(&torque),
        };
        for (level, start) in [(1e-9, 4.5), (1e-4, 0.0)] {
            // Of errors in all blocks, and in one alone.
            let mut tightest = [0.0_f64; 4];
            for _ in 0..12 {
                // At the very start the reference stands still: all there is comes from the errors.
                let t = if start == 0.0 { 0.0 } else { start + 1.5 * (1.0 + r.next()) };
                let deviation =
                    Deviation::watched(&system, &spread, level, Interval::point(t), &|| true).unwrap();
                for k in 0..400 {
                    let mut x = arm.sample(t, level * (1.0 - 1e-6), &mut r);
                    let only = k % 4;
                    if only > 0 {
                        x = alone(&arm, &x, t, only);
                    }
                    let off = drawn(tolerances, torque, &mut r);
                    let [a_l, a_m] = difference(&arm, &off, &x, &arm.command(t, &x).u_m);
                    let size = a_l.dot(&a_l).sqrt() + a_m.dot(&a_m).sqrt();
                    let h = 1e-3 * level.sqrt() / size.max(1e-9);
                    let storage = |h: f64| {
                        let x = Motion { v_l: x.v_l + a_l.scaled(h), v_m: x.v_m + a_m.scaled(h), ..x };
                        arm.level(&x, &arm.command(t, &x))
                    };
                    let added = (storage(h) - storage(-h)) / (2.0 * h);
                    let lengths = lengths(&arm, &x, t);
                    let slope =
                        |b: usize| -> f64 { (0..4).map(|c| deviation.slopes[b][c] * lengths[c]).sum() };
                    let bound: f64 = (0..4).map(|b| lengths[b] * (deviation.steady[b] + slope(b))).sum();
                    assert!(added <= bound * (1.0 + 1e-6), "kind {kind} at {t} s: {added} beyond {bound}");
                    if bound > 0.0 {
                        tightest[only] = tightest[only].max(added / bound);
                    }
                }
            }
            println!("kind {kind}, level {level}: {tightest:.3?} of the bound");
            // Inertia, damping and torque of the motors act on the motors' velocities alone.
            let acted_on = if matches!(kind, 1 | 3 | 4) { [0, 3].as_slice() } else { &[0, 1, 2, 3] };
            let least = if start == 0.0 { &acted_on[..1] } else { acted_on };
            assert!(least.iter().all(|&b| tightest[b] > 0.25), "kind {kind}, level {level}: {tightest:?}");
        }
    }
}

/// Without tolerances nothing is said; with next to none it is the certified rate; with more it is less.
#[test]
fn the_rate_goes_down_with_the_tolerances() {
    assert!(proof(&scenario()).within.is_none());
    let nominal = certified(&scenario());
    let [none, some, more] =
        [1e-9, 0.3, 1.0].map(|share| within(&tolerant(scenario(), IDENTIFIED.map(|part| share * part))));
    println!("{nominal}: {none:?} {some:?} {more:?}");
    assert!(none.rate <= nominal && none.rate > nominal * (1.0 - 1e-6), "{none:?}");
    assert!(some.rate < none.rate && more.rate < some.rate, "{some:?} {more:?}");
    assert!(none.settles < 1e-12 && none.settles < some.settles && some.settles < more.settles);
    for within in [&none, &some, &more] {
        assert!(within.settles <= within.level, "{within:?}");
    }
    // Some number may be 0 to the law, or the springs of another robot: then nothing is said.
    let open = proof(&tolerant(scenario(), [0.9; 4])).within;
    assert!(matches!(open, Some(Err(_))), "{open:?}");
}

/// The rates of change of positions and velocities, links then motors, of an arm that is off by `off`.
fn rates(arm: &Arm, off: &Numbers, t: f64, x: &Motion<f64, 2>) -> [Vector<f64, 2>; 4] {
    let command = arm.command(t, x);
    let zeta = x.deflection();
    let robot = &arm.robot;
    let [da_l, da_m] = difference(arm, off, x, &command.u_m);
    let spring = robot.stiffness.diag_mul(&zeta);
    let bias = robot.links.inertial_torque(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO);
    let on_links = spring - robot.link_damping.diag_mul(&x.v_l) - bias;
    let a_l = robot.links.mass_matrix(&x.q_l).ldl().solve(&on_links) + da_l;
    let on_motors = command.u_m - robot.motor_damping.diag_mul(&x.v_m) - spring;
    let a_m = robot.motor_inertia.map(f64::recip).diag_mul(&on_motors) + da_m;
    [x.v_l, x.v_m, a_l, a_m]
}

/// `x` a time `h` later at these rates.
fn along(x: &Motion<f64, 2>, [v_l, v_m, a_l, a_m]: &[Vector<f64, 2>; 4], h: f64) -> Motion<f64, 2> {
    Motion {
        q_l: x.q_l + v_l.scaled(h),
        q_m: x.q_m + v_m.scaled(h),
        v_l: x.v_l + a_l.scaled(h),
        v_m: x.v_m + a_m.scaled(h),
    }
}

/// ρ̇ ≤ −μ (ρ − ν) wherever ν ≤ ρ = √(2 W) and W is at most the level, for every robot within the tolerances: by differences of W along
/// its own motion. Somewhere it is not much less.
#[test]
fn every_robot_within_obeys_the_inequality() {
    for torque in [None, Some(UNKNOWN)] {
        let scenario = tolerant(displaced(), IDENTIFIED);
        let within = within_with(&scenario, torque);
        let arm = floats::arm(&scenario);
        let mut r = Random(2);
        let mut slowest = f64::INFINITY;
        for _ in 0..4000 {
            let off = drawn(&scenario.robot.tolerances, torque.unwrap_or_default(), &mut r);
            let t = 4.0 * (1.0 + r.next());
            let level = within.settles + (within.level - within.settles) * 0.5 * (1.0 + r.next());
            let x = arm.sample(t, level * (1.0 - 1e-9), &mut r);
            let rates = rates(&arm, &off, t, &x);
            let h = 1e-6;
            let length = |h: f64| {
                let x = along(&x, &rates, h);
                (2.0 * arm.level(&x, &arm.command(t + h, &x))).sqrt()
            };
            let above = length(0.0) - (2.0 * within.settles).sqrt();
            if above > 0.0 {
                slowest = slowest.min((length(-h) - length(h)) / (2.0 * h) / above);
            }
        }
        println!("{torque:?}: {slowest} 1/s at the slowest, {} said", within.rate);
        assert!(
            slowest >= within.rate * (1.0 - 1e-6) && slowest < 3.0 * within.rate,
            "{slowest}: {within:?}"
        );
    }
}

/// The motion of an arm that is off by `off`, from `x` at `t` on, by Runge and Kutta, `each` looking on.
fn moved(
    arm: &Arm,
    off: &Numbers,
    mut x: Motion<f64, 2>,
    end: f64,
    mut each: impl FnMut(f64, &Motion<f64, 2>),
) {
    let rate = |t: f64, x: &Motion<f64, 2>| rates(arm, off, t, x);
    let h = 1e-3;
    let mut t = 0.0;
    while t < end {
        each(t, &x);
        let k1 = rate(t, &x);
        let k2 = rate(t + 0.5 * h, &along(&x, &k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, &along(&x, &k2, 0.5 * h));
        let k4 = rate(t + h, &along(&x, &k3, h));
        let mean = std::array::from_fn(|i| (k1[i] + (k2[i] + k3[i]).scaled(2.0) + k4[i]).scaled(1.0 / 6.0));
        x = along(&x, &mean, h);
        t += h;
    }
}

/// Robots within the tolerances under the law that knows the numbers of the file, from anywhere in the level set: errors come down
/// as is said, and not to 0, which a rate of the blocks with the worst of all numbers would say.
#[test]
fn simulated_robots_keep_what_is_said() {
    let scenario = tolerant(scenario(), IDENTIFIED);
    let within = within_with(&scenario, Some(UNKNOWN));
    assert!(within.settles > 1.1 * self::within(&scenario).settles, "an unknown torque counts");
    let arm = floats::arm(&scenario);
    // The largest position errors of {W ≤ settles}.
    let flexure::core::control::Metric::Constant(link) = &arm.law.link.metric else { panic!("constant") };
    for (error, metric) in within.error.iter().zip(link.iter().chain(arm.law.motor.metric.iter())) {
        assert!((error / (2.0 * within.settles / metric).sqrt() - 1.0).abs() < 1e-9, "{within:?}");
    }
    let mut r = Random(4);
    let mut last = 0.0_f64;
    for run in 0..6 {
        let off = drawn(&scenario.robot.tolerances, UNKNOWN, &mut r);
        let x = if run == 0 {
            arm.motion(0.0, [Vector::ZERO; 4])
        } else {
            arm.sample(0.0, within.level * (1.0 - 1e-9), &mut r)
        };
        let storage = |t: f64, x: &Motion<f64, 2>| arm.level(x, &arm.command(t, x)).sqrt();
        let (first, settles) = (storage(0.0, &x), within.settles.sqrt());
        moved(&arm, &off, x, 6.0, |t, x| {
            let now = storage(t, x);
            let said = settles + (-within.rate * t).exp() * (first - settles).max(0.0);
            assert!(now <= said + 1e-9, "run {run} at {t} s: {now} beyond {said}");
            if t > 5.5 {
                last = last.max(now);
            }
        });
    }
    println!("{last:e} at the end, {:e} said", within.settles.sqrt());
    assert!(last > 1e-6, "the errors do not vanish: {last}");
}

/// The arm under a reference that moves from the start, which it begins beside.
fn displaced() -> Scenario {
    let mut scenario = scenario();
    scenario.smooth_start = None;
    let initial = &mut scenario.initial;
    for speed in initial.dq_l.iter_mut().chain(&mut initial.dq_m) {
        *speed = 0.6;
    }
    initial.q_l[0] += 0.01;
    initial.q_m[0] += 0.01;
    scenario
}

/// The level holds the start, wherever it is.
#[test]
fn the_start_lies_in_the_level() {
    let scenario = tolerant(displaced(), IDENTIFIED);
    let start = proof(&scenario).start.expect("a start");
    let within = within(&scenario);
    println!("{start} J at the start: {within:?}");
    assert!(start > 3.0 * within.settles && within.level >= start, "{start}: {within:?}");
}

/// What is broken off says nothing.
#[test]
fn broken_off_nothing_is_said() {
    use flexure::prove::within::within;

    let scenario = tolerant(scenario(), IDENTIFIED);
    let proof = proof(&scenario);
    let certificate = proof.verdict.proved().unwrap();
    let found = within(&scenario, certificate, proof.start, 100, &|_| ControlFlow::Break(())).unwrap();
    assert!(found.is_none(), "{found:?}");
    // A start that is not known to lie in the level set: said, not passed over.
    let found = within(&scenario, certificate, None, 100, &unwatched).unwrap();
    assert!(matches!(&found, Some(Err(open)) if open.at.contains("start")), "{found:?}");
}

/// Whoever waits while levels are tried sees that it goes on.
#[test]
fn levels_that_are_tried_are_told() {
    let told = Mutex::new(BTreeSet::new());
    let note = |fraction: f64| {
        told.lock().unwrap().insert(fraction.to_bits());
        ControlFlow::Continue(())
    };
    prove_watched(&tolerant(scenario(), IDENTIFIED), &Question::default(), &note).unwrap();
    let inside =
        told.into_inner().unwrap().into_iter().map(f64::from_bits).filter(|x| (0.06..0.24).contains(x));
    let count = inside.count();
    assert!(count > 20, "{count}");
}
