//! Robots within the tolerances in motion.

use flexure::core::linalg::Vector;
use flexure::core::model::{Links as _, Motion};
use flexure::core::robots::PlanarTwoLink;

use super::{
    Arm, IDENTIFIED, Numbers, UNKNOWN, difference, displaced, drawn, scenario, tolerant, within_with,
};
use crate::along::floats;
use crate::common::Random;

/// The rates of change of positions and velocities, links then motors, of an arm that is off by `off`.
pub fn rates(arm: &Arm, off: &Numbers, t: f64, x: &Motion<f64, 2>) -> [Vector<f64, 2>; 4] {
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

/// As [`rates`], of an arm with other links, too.
pub fn rates_with(
    links: &PlanarTwoLink<f64>,
    arm: &Arm,
    off: &Numbers,
    t: f64,
    x: &Motion<f64, 2>,
) -> [Vector<f64, 2>; 4] {
    let [stiffness, _, link_damping, _, _, on_link] = off;
    let spring = (arm.robot.stiffness + *stiffness).diag_mul(&x.deflection());
    let damper = (arm.robot.link_damping + *link_damping).diag_mul(&x.v_l);
    let a_l = links.forward_dynamics(&x.q_l, &x.v_l, &(spring - damper + *on_link));
    let [v_l, v_m, _, a_m] = rates(arm, off, t, x);
    [v_l, v_m, a_l, a_m]
}

/// `x` a time `h` later at these rates.
pub fn along(x: &Motion<f64, 2>, [v_l, v_m, a_l, a_m]: &[Vector<f64, 2>; 4], h: f64) -> Motion<f64, 2> {
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
    let h = 1e-3;
    let mut t = 0.0;
    while t < end {
        each(t, &x);
        x = later(|t, x| rates(arm, off, t, x), t, &x, h);
        t += h;
    }
}

/// A motion a time `h` after `t`, by its rates.
pub fn later(
    rate: impl Fn(f64, &Motion<f64, 2>) -> [Vector<f64, 2>; 4],
    t: f64,
    x: &Motion<f64, 2>,
    h: f64,
) -> Motion<f64, 2> {
    let k1 = rate(t, x);
    let k2 = rate(t + 0.5 * h, &along(x, &k1, 0.5 * h));
    let k3 = rate(t + 0.5 * h, &along(x, &k2, 0.5 * h));
    let k4 = rate(t + h, &along(x, &k3, h));
    let mean = std::array::from_fn(|i| (k1[i] + (k2[i] + k3[i]).scaled(2.0) + k4[i]).scaled(1.0 / 6.0));
    along(x, &mean, h)
}

/// Robots within the tolerances under the law that knows the numbers of the file, from anywhere in the level set: errors come down
/// as is said, and not to 0, which a rate of the blocks with the worst of all numbers would say.
#[test]
fn simulated_robots_keep_what_is_said() {
    let scenario = tolerant(scenario(), IDENTIFIED);
    let within = within_with(&scenario, Some(UNKNOWN));
    assert!(within.settles > 1.1 * super::within(&scenario).settles, "an unknown torque counts");
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
