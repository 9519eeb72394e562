//! Observers: second-order predictions, estimation errors that die at the rate that was asked for whatever the robot, less
//! noise from quantised encoders than filtered differences.

use flexure_core::estimate::{Estimator, FilteredDifference, LowPass, MotorObserver, Observer};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{PlanarTwoLink, Tree};

mod common;
use common::plant::{Arm, Push, advance, distance, paper_arm, plausible_arm, undamped};
use common::{Numbers, PLANAR, branched, branched_bodies, flexible, planar};

const PERIOD: f64 = 1e-3;

fn both<const N: usize>(bandwidth: f64) -> Observer<f64, N> {
    Observer::new(&Vector([bandwidth; N]), PERIOD).expect("positive")
}

fn motor<const N: usize>(bandwidth: f64) -> MotorObserver<f64, N> {
    MotorObserver::new(&Vector([bandwidth; N]), PERIOD).expect("positive")
}

/// A torque that keeps a robot moving, over one control period.
fn stirring<const N: usize>(size: f64, t: f64) -> Vector<f64, N> {
    Vector::from_fn(|i| size * (1.0 + 0.5 * i as f64) * ((3.0 + i as f64) * t).cos())
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

/// What the robot does from `x` on, stirred by torques of the size `torque`: motion and torque per period.
fn course<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    torque: f64,
    periods: u32,
) -> Vec<(Motion<f64, N>, Vector<f64, N>)> {
    let mut x = *x;
    (0..periods)
        .map(|k| {
            let u = stirring(torque, f64::from(k) * PERIOD);
            x = advance(robot, &x, &u, &Push::NONE, PERIOD, 20);
            (x, u)
        })
        .collect()
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
        errors[window].iter().fold(0.0, |m: f64, e| if e.is_nan() { f64::NAN } else { m.max(*e) })
    };
    let (early, late) = (largest(8.0), largest(14.0));
    let polynomial = |t: f64| (1.0 + t).powi(order);
    let allowed = (-6.0_f64).exp() * polynomial(14.0) / polynomial(8.0);
    assert!(early > 0.0 && late <= 1.3 * allowed * early, "{early:.2e} to {late:.2e}: allowed {allowed:.2e}");
    (early / late).ln() / 6.0
}

/// With bandwidth next to nothing the estimate is the prediction. Its error over one period is of third order.
fn prediction_is_of_second_order<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let (x, u) = (r.motion::<N>(0.5), r.vector::<N>(2.0));
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

/// What remains on a moving robot is the error of the prediction, so a quarter at half the period; links are found without an
/// encoder.
#[test]
fn what_remains_is_of_second_order() {
    let (arm, x) = (plausible_arm(), Motion::at_rest(Vector([0.3, -0.5])));
    let remains =
        |period: f64, estimator: &mut dyn FnMut(&Motion<f64, 2>, &Vector<f64, 2>) -> Motion<f64, 2>| {
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

fn quantised<const N: usize>(q: &Vector<f64, N>) -> Vector<f64, N> {
    let count = core::f64::consts::TAU / 4096.0;
    q.map(|q| (q / count).round() * count)
}

/// Root mean square of the velocity errors of both sides [rad/s], from 0.5 s on, of an estimator that sees 4096 counts a turn.
fn velocity_noise(arm: &Arm, period: f64, estimator: &mut impl Estimator<f64, 2>) -> [f64; 2] {
    let mut x = Motion::at_rest(Vector([0.3, -0.5]));
    estimator.start(&x);
    let (mut sum, mut count) = ([0.0; 2], 0.0);
    for k in 0..2000 {
        let t = f64::from(k) * period;
        let u = stirring(1.5, t);
        x = advance(arm, &x, &u, &Push::NONE, period, 20);
        let estimate = estimator.update(arm, &quantised(&x.q_l), &quantised(&x.q_m), &u);
        if t > 0.5 {
            let (e_l, e_m) = (estimate.v_l - x.v_l, estimate.v_m - x.v_m);
            sum = [sum[0] + e_l.dot(&e_l), sum[1] + e_m.dot(&e_m)];
            count += 2.0;
        }
    }
    sum.map(|sum| (sum / count).sqrt())
}

/// On the plausible hardware, 4096 counts and 2 ms, the model beats the maker's filter on both sides, by more than three.
#[test]
fn the_model_beats_filtered_differences_on_quantised_encoders() {
    let (arm, period) = (plausible_arm(), 2e-3);
    let filter = LowPass::second_order(40.0, 0.9, period).expect("a filter");
    let difference = velocity_noise(&arm, period, &mut FilteredDifference::new(filter));
    let first = LowPass::first_order(40.0, period).expect("a filter");
    let first = velocity_noise(&arm, period, &mut FilteredDifference::new(first));
    let two = velocity_noise(&arm, period, &mut Observer::new(&Vector([30.0; 2]), period).expect("positive"));
    let one =
        velocity_noise(&arm, period, &mut MotorObserver::new(&Vector([10.0; 2]), period).expect("positive"));
    println!(
        "rms: first order {first:.4?}, second order {difference:.4?}, both {two:.4?}, motor {one:.4?} rad/s"
    );
    for side in 0..2 {
        assert!(3.0 * two[side] < difference[side].min(first[side]), "{two:?} against {difference:?}");
        assert!(one[side] < difference[side], "{one:?} against {difference:?}");
    }
}

/// A limit that is hit cuts the command. Fed what was applied, the estimate is as good as ever; fed what was asked for, it is not.
#[test]
fn a_saturated_command_does_not_disturb() {
    let (arm, limit) = (plausible_arm(), 1.0);
    let worst = |fed: fn(&Vector<f64, 2>, &Vector<f64, 2>) -> Vector<f64, 2>| {
        let mut x = Motion::at_rest(Vector([0.3, -0.5]));
        let mut estimators = (both::<2>(50.0), motor::<2>(50.0));
        (estimators.0.start(&x), estimators.1.start(&x));
        (0..1000).fold([0.0_f64; 2], |worst, k| {
            let asked = stirring(4.0, f64::from(k) * PERIOD);
            let applied = asked.map(|u| u.clamp(-limit, limit));
            x = advance(&arm, &x, &applied, &Push::NONE, PERIOD, 20);
            let fed = fed(&asked, &applied);
            let two = estimators.0.update(&arm, &x.q_l, &x.q_m, &fed);
            let one = estimators.1.update(&arm, &x.q_l, &x.q_m, &fed);
            [worst[0].max(distance(&two, &x, 50.0)), worst[1].max(distance(&one, &x, 50.0))]
        })
    };
    let (good, bad) = (worst(|_, applied| *applied), worst(|asked, _| *asked));
    println!("fed what was applied {good:?} rad, fed what was asked for {bad:?} rad");
    for (good, bad) in good.iter().zip(bad) {
        assert!(*good < 3e-4 && bad > 1000.0 * good, "{good} against {bad}");
    }
}

/// Readings that are no numbers make the estimate NaN there and then, and leave nothing behind.
#[test]
fn a_dead_encoder_is_seen_and_forgotten() {
    let arm = plausible_arm();
    let rest = Motion::at_rest(Vector([0.3, -0.5]));
    let (mut two, mut one) = (both::<2>(50.0), motor::<2>(50.0));
    let filter = LowPass::first_order(40.0, PERIOD).expect("a filter");
    let mut difference = FilteredDifference::new(filter);
    (two.start(&rest), one.start(&rest), difference.start(&rest));
    for garbage in [f64::NAN, f64::INFINITY, 1e308, -1e308] {
        let (q_l, q_m) = (Vector([0.3, garbage]), Vector([garbage, -0.5]));
        for _ in 0..3 {
            let seen = [
                two.update(&arm, &q_l, &q_m, &Vector::ZERO),
                difference.update(&arm, &q_l, &q_m, &Vector::ZERO),
                one.update(&arm, &q_l, &q_m, &Vector::ZERO),
            ];
            if !garbage.is_finite() {
                assert!(seen.iter().all(|x| !x.q_m[0].is_finite() && x.v_m[0].is_nan()), "{seen:?}");
                assert!(seen.iter().all(|x| x.q_m[1].is_finite() && x.v_m[1].is_finite()), "{seen:?}");
                assert!(seen[..2].iter().all(|x| !x.q_l[1].is_finite() && x.v_l[1].is_nan()), "{seen:?}");
            }
        }
        // 1e308 is forgotten at the bandwidth, 50 1/s: 40 s are enough for e^{−2000} of it.
        for _ in 0..40_000 {
            two.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO);
            one.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO);
            difference.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO);
        }
        let update = |e: &mut dyn FnMut() -> Motion<f64, 2>| distance(&e(), &rest, 1.0);
        let after = [
            update(&mut || two.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO)),
            update(&mut || one.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO)),
            update(&mut || difference.update(&arm, &rest.q_l, &rest.q_m, &Vector::ZERO)),
        ];
        assert!(after.iter().all(|e| *e < 1e-9), "{garbage}: {after:?}");
    }
}

/// In single precision as in double, up to rounding: 1e-7 of a rad a step, that the bandwidth forgets within 20 ms, and over the spring's pull on
/// the motor, κ, for the motor encoder alone.
#[test]
fn single_precision_will_do() {
    let arm = plausible_arm();
    let narrow = |v: &Vector<f64, 2>| v.map(|x| x as f32);
    let [m_1, m_2] = PLANAR.mass.map(|x| x as f32);
    let links = PlanarTwoLink::new(
        [m_1, m_2],
        PLANAR.length as f32,
        PLANAR.com.map(|x| x as f32),
        PLANAR.inertia.map(|x| x as f32),
    );
    let single = Fjr {
        links,
        motor_inertia: narrow(&arm.motor_inertia),
        stiffness: narrow(&arm.stiffness),
        link_damping: narrow(&arm.link_damping),
        motor_damping: narrow(&arm.motor_damping),
    };
    let x = Motion::at_rest(Vector([0.3, -0.5]));
    let (mut two, mut one) = (both::<2>(50.0), motor::<2>(20.0));
    let mut two_single = Observer::new(&Vector([50.0_f32; 2]), 1e-3).expect("positive");
    let mut one_single = MotorObserver::new(&Vector([20.0_f32; 2]), 1e-3).expect("positive");
    (two.start(&x), one.start(&x));
    (two_single.start(&x.map(|x| x as f32)), one_single.start(&x.map(|x| x as f32)));
    let mut worst = [0.0_f64; 2];
    for (x, u) in course(&arm, &x, 1.0, 2000) {
        let (q_l, q_m, v) = (narrow(&x.q_l), narrow(&x.q_m), narrow(&u));
        let a = distance(
            &two.update(&arm, &x.q_l, &x.q_m, &u),
            &two_single.update(&single, &q_l, &q_m, &v).map(f64::from),
            50.0,
        );
        let b = distance(
            &one.update(&arm, &x.q_l, &x.q_m, &u),
            &one_single.update(&single, &q_l, &q_m, &v).map(f64::from),
            20.0,
        );
        worst = [worst[0].max(a), worst[1].max(b)];
    }
    println!("{worst:?} rad");
    assert!(worst[0] < 1e-5 && worst[1] < 1e-4, "{worst:?}");
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
