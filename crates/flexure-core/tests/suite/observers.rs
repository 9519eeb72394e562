//! Observers: second-order predictions, estimation errors that die at the rate that was asked for, whatever the robot.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times become counts of periods"
)]

use flexure_core::estimate::{Estimator, MotorObserver, Observer};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Tree;

use crate::common::plant::{
    PERIOD, Push, advance, course, distance, paper_arm, plausible_arm, stirring, undamped,
};
use crate::common::{Numbers, branched, branched_bodies, flexible, planar};

fn both<const N: usize>(bandwidth: f64) -> Observer<f64, N> {
    Observer::new(&Vector([bandwidth; N]), PERIOD).expect("positive")
}

fn motor<const N: usize>(bandwidth: f64) -> MotorObserver<f64, N> {
    MotorObserver::new(&Vector([bandwidth; N]), PERIOD).expect("positive")
}

/// `x` with every position wrong by `by` rad, velocities by ten times that.
fn off<const N: usize>(x: &Motion<f64, N>, by: f64) -> Motion<f64, N> {
    let shifted = |v: &Vector<f64, N>, by: f64| v.map(|x| x + by);
    Motion {
        q_l: shifted(&x.q_l, by),
        q_m: shifted(&x.q_m, -by),
        v_l: shifted(&x.v_l, 10.0 * by),
        v_m: shifted(&x.v_m, -10.0 * by),
    }
}

/// Distances of two copies of an estimator that start at different motions and see the same, `per` [1/s].
fn distances<L: Links<f64, N>, E: Estimator<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    course: &[(Motion<f64, N>, Vector<f64, N>)],
    mut copies: [E; 2],
    starts: [&Motion<f64, N>; 2],
    per: f64,
) -> Vec<f64> {
    for (copy, start) in copies.iter_mut().zip(starts) {
        copy.start(start);
    }
    course
        .iter()
        .map(|(x, u)| {
            let [a, b] = copies.each_mut().map(|copy| copy.update(robot, &x.q_l, &x.q_m, u));
            distance(&a, &b, per)
        })
        .collect()
}

/// That `errors` fall like (1 + ωt)^order e^{−ωt}: `order` is how many poles coincide at most, less one. What is compared are the
/// largest errors of two windows of a time constant each, six time constants apart, so that oscillation under the
/// envelope does not count.
fn falls_at_the_rate(errors: &[f64], bandwidth: f64, order: i32) -> f64 {
    let per_constant = 1.0 / (bandwidth * PERIOD);
    let largest = |from: f64| {
        let window = (from * per_constant) as usize..((from + 1.0) * per_constant) as usize;
        errors[window].iter().fold(0.0, |m: f64, e| m.max(*e))
    };
    let (early, late) = (largest(8.0), largest(14.0));
    let polynomial = |t: f64| (1.0 + t).powi(order);
    let allowed = (-6.0_f64).exp() * polynomial(14.0) / polynomial(8.0);
    assert!(early > 0.0 && late <= 1.3 * allowed * early, "{early:.2e} to {late:.2e}: allowed {allowed:.2e}");
    (early / late).ln() / 6.0
}

/// With bandwidth next to nothing the estimate is the prediction. Its error over one period is of third order.
fn prediction_is_of_second_order<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    // Fast enough for mass matrix and Coriolis torques to change on the way.
    let x = r.motion::<N>(0.5);
    let x = Motion { v_l: x.v_l.scaled(20.0), ..x };
    let u = r.vector::<N>(2.0);
    let error = |period: f64| {
        let truth = advance(robot, &x, &u, &Push::NONE, period, 40);
        let mut observer = Observer::new(&Vector([1e-9; N]), period).expect("positive");
        observer.start(&x);
        let mut motor_only = MotorObserver::new(&Vector([1e-9; N]), period).expect("positive");
        motor_only.start(&x);
        let estimate = observer.update(robot, &truth.q_l, &truth.q_m, &u);
        let same = motor_only.update(robot, &truth.q_l, &truth.q_m, &u);
        // The motor-only gains contain ω/κ: what is left of them at 1e-9 rad/s is 1e-9 times the motor's error.
        assert!(distance(&estimate, &same, 1.0) < 1e-9);
        distance(&estimate, &truth, 10.0)
    };
    let ratio = error(1e-3) / error(5e-4);
    assert!((6.5..9.5).contains(&ratio), "{ratio}");
}

#[test]
fn prediction_is_of_second_order_for_arm_and_tree() {
    let mut r = Numbers(4);
    for _ in 0..5 {
        prediction_is_of_second_order(&flexible(planar(), &mut r), &mut r);
        prediction_is_of_second_order(&flexible(branched::<5>(2), &mut r), &mut r);
    }
}

/// A motor that is damped at 9000 1/s, at 1 kHz: what is left of a velocity after one period is e^{−9}.
#[test]
fn stiff_motor_damping_is_exact() {
    let robot = Fjr { stiffness: Vector([1e-12; 2]), ..paper_arm() };
    let x = Motion { v_m: Vector([0.3, 2.0]), ..Motion::at_rest(Vector([0.1, 0.2])) };
    let u = Vector([0.0, 9.0]);
    let mut observer: Observer<f64, 2> = both(1e-9);
    observer.start(&x);
    let v = observer.update(&robot, &x.q_l, &x.q_m, &u).v_m[1];
    // Ends at u / D_m = 0.1 rad/s; the residual at 1e-9 rad/s of bandwidth adds 1e-15.
    assert!((v - (0.1 + 1.9 * (-9.0_f64).exp())).abs() < 1e-12, "{v}");
}

/// How fast estimation errors die around a robot at rest, over the bandwidth: from copies that start off by a little in each
/// coordinate, so that the root of the sum of squares does not oscillate; between 8 and 16 time constants, where it falls like
/// (ωt)^order e^{−ωt} if `order` + 1 poles coincide.
fn rate_at_rest<L: Links<f64, N>, E: Estimator<f64, N> + Copy, const N: usize>(
    robot: &Fjr<f64, L, N>,
    estimator: E,
    bandwidth: f64,
    order: i32,
) -> f64 {
    let rest = Motion::at_rest(Vector::from_fn(|i| 0.3 - 0.4 * i as f64));
    let unit = |j: usize| Vector::from_fn(|i| if i == j { 1e-3 } else { 0.0 });
    let none = Vector::ZERO;
    let mut copies: Vec<E> = (0..N)
        .flat_map(|j| {
            [
                [unit(j), none, none, none],
                [none, unit(j), none, none],
                [none, none, unit(j), none],
                [none, none, none, unit(j)],
            ]
        })
        .map(|[q_l, q_m, v_l, v_m]| {
            let mut copy = estimator;
            copy.start(&Motion {
                q_l: rest.q_l + q_l,
                q_m: rest.q_m + q_m,
                v_l: v_l.scaled(bandwidth),
                v_m: v_m.scaled(bandwidth),
            });
            copy
        })
        .collect();
    let span = (8.0 / bandwidth / PERIOD).round();
    let errors: Vec<f64> = (0..2 * span as usize)
        .map(|_| {
            let squares = copies.iter_mut().map(|copy| {
                let x = copy.update(robot, &rest.q_l, &rest.q_m, &Vector::ZERO);
                let (e_l, e_m) = (x.q_l - rest.q_l, x.q_m - rest.q_m);
                e_l.dot(&e_l) + e_m.dot(&e_m) + (x.v_l.dot(&x.v_l) + x.v_m.dot(&x.v_m)) / bandwidth.powi(2)
            });
            squares.sum::<f64>().sqrt()
        })
        .collect();
    let (early, late) = (errors[span as usize - 1], errors[2 * span as usize - 1]);
    ((early / late).ln() + f64::from(order) * 2.0_f64.ln()) / (span * PERIOD * bandwidth)
}

/// Undamped, as plausible and as stiff as the paper's: the error dies at the bandwidth; not much faster where nothing helps it.
#[test]
fn errors_die_at_the_bandwidth() {
    let arms = [undamped(plausible_arm()), undamped(paper_arm()), plausible_arm(), paper_arm()];
    for bandwidth in [20.0, 50.0, 100.0, 200.0] {
        for (arm, helped) in arms.iter().zip([false, false, true, true]) {
            let two = rate_at_rest(arm, both(bandwidth), bandwidth, 1);
            let one = rate_at_rest(arm, motor(bandwidth), bandwidth, 3);
            println!("{bandwidth} rad/s: {two:.3} and {one:.3} of it");
            // What is not settled after eight time constants, and what the trapezoidal rule slows of modes at ν rad/s:
            // (νT/2)², 4 % for the stiffest. Where springs split the poles the allowance for coinciding ones, order · ln 2 / 8, is
            // too much.
            assert!(two > 0.94 && one > 0.92, "{two} and {one} times the bandwidth");
            assert!(helped || (two < 1.1 && one < 1.27), "{two} and {one} times the bandwidth");
        }
    }
}

/// Whatever links, springs, dampers and couplings: trees without gravity, under which a posture need not be an equilibrium.
#[test]
fn errors_die_at_the_bandwidth_on_any_tree() {
    let mut r = Numbers(6);
    for seed in 0..10 {
        let links = Tree::new(&branched_bodies::<5>(seed), [0.0; 3]).expect("parents come first");
        let robot = flexible(links, &mut r);
        let (two, one) =
            (rate_at_rest(&robot, both(100.0), 100.0, 1), rate_at_rest(&robot, motor(100.0), 100.0, 3));
        println!("{two:.3} and {one:.3} of it");
        assert!(two > 0.94 && one > 0.94, "{two} and {one} times the bandwidth");
    }
}

/// Where dampers are strong the slowest errors are those of positions that nothing pulls back, each with a pole of its own: from motor
/// encoders they die at the bandwidth, no faster and no slower.
#[test]
fn free_positions_die_at_exactly_the_bandwidth() {
    for (link_damping, motor_damping) in [([16.0, 11.0], [0.0, 0.0]), ([16.0, 11.0], [4.0, 1.5])] {
        let arm = Fjr {
            link_damping: Vector(link_damping),
            motor_damping: Vector(motor_damping),
            stiffness: Vector([400.0, 70.0]),
            ..plausible_arm()
        };
        for bandwidth in [10.0, 30.0] {
            let rate = rate_at_rest(&arm, motor(bandwidth), bandwidth, 0);
            println!("{link_damping:?} {motor_damping:?} {bandwidth}: {rate}");
            assert!((0.98..1.02).contains(&rate), "{rate} times the bandwidth");
        }
    }
}

/// Two copies that start differently agree exponentially while the robot moves and the springs work.
#[test]
fn errors_die_while_the_robot_moves() {
    let x = Motion { v_l: Vector([1.0, -2.0]), ..Motion::at_rest(Vector([0.3, -0.5])) };
    for (arm, bandwidth) in [(plausible_arm(), 50.0), (plausible_arm(), 100.0), (paper_arm(), 50.0)] {
        let moving = course(&arm, &x, 1.0, (16.0 / bandwidth / PERIOD) as u32);
        let near = off(&x, 1e-3);
        let errors = distances(&arm, &moving, [both(bandwidth), both(bandwidth)], [&x, &near], bandwidth);
        falls_at_the_rate(&errors, bandwidth, 1);
        let near = off(&x, 1e-5);
        let errors = distances(&arm, &moving, [motor(bandwidth), motor(bandwidth)], [&x, &near], bandwidth);
        falls_at_the_rate(&errors, bandwidth, 3);
    }
}

/// A motion and the torque that led there to an estimate.
type Estimate<'a> = &'a mut dyn FnMut(&Motion<f64, 2>, &Vector<f64, 2>) -> Motion<f64, 2>;

/// What remains on a moving robot is the error of the prediction, so a quarter at half the period; links are found without an
/// encoder.
#[test]
fn what_remains_is_of_second_order() {
    let (arm, x) = (plausible_arm(), Motion::at_rest(Vector([0.3, -0.5])));
    let remains = |period: f64, estimator: Estimate| {
        let mut x = x;
        let mut worst: f64 = 0.0;
        for k in 0..(1.0 / period) as u32 {
            // Held over 4 ms either way, so that both see the same robot.
            let t = (f64::from(k) * period / 4e-3 + 1e-6).floor() * 4e-3;
            let u = stirring(1.0, t);
            x = advance(&arm, &x, &u, &Push::NONE, period, 20);
            let estimate = estimator(&x, &u);
            worst = if t > 0.6 { worst.max(distance(&estimate, &x, 50.0)) } else { worst };
        }
        worst
    };
    let two = [2e-3, 1e-3].map(|period| {
        let mut observer = Observer::new(&Vector([50.0; 2]), period).expect("positive");
        observer.start(&off(&x, 0.05));
        remains(period, &mut |x, u| observer.update(&arm, &x.q_l, &x.q_m, u))
    });
    let one = [2e-3, 1e-3].map(|period| {
        let mut observer = MotorObserver::new(&Vector([50.0; 2]), period).expect("positive");
        observer.start(&off(&x, 0.05));
        let unseen = Vector([f64::NAN; 2]);
        remains(period, &mut |x, u| observer.update(&arm, &unseen, &x.q_m, u))
    });
    println!("both encoders {two:?} rad, motor encoder {one:?} rad");
    for [coarse, fine] in [two, one] {
        assert!(coarse < 1e-3 && (3.0..5.5).contains(&(coarse / fine)), "{coarse} and {fine}");
    }
}

#[test]
fn bandwidths_must_be_positive() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Observer::new(&Vector([1.0, bad]), PERIOD).is_none());
        assert!(MotorObserver::new(&Vector([1.0, bad]), PERIOD).is_none());
        assert!(
            Observer::new(&Vector([1.0]), bad).is_none() && MotorObserver::new(&Vector([1.0]), bad).is_none()
        );
    }
}
