//! Guards: finite torques inside the limits whatever comes in, stops within the step, no windup, no jump, and a certificate
//! that is suspended when it does not hold.

use core::fmt::Debug;

use flexure_core::control::Input;
use flexure_core::guard::{
    Age, Certificate, Decision, Fault, Guard, Phase, Plausible, Rejoin, Seen, Settings, Suspension,
};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::scalar::{Float, Jet, Scalar};

use crate::common::plant::{Push, advance, gentle, plausible_arm};
use crate::common::{Numbers, close};

const REJOIN: u32 = 5;

fn settings<C: Float>() -> Settings<C, 2> {
    let all = |x: f64| Vector([C::from_f64(x); 2]);
    Settings {
        torque_limit: Vector([C::from_f64(8.39), C::from_f64(1.67)]),
        torque_rate_limit: all(500.0),
        stop_damping: all(2.0),
        allowed_age: 1,
        rejoin: Rejoin { after: REJOIN, ..Settings::open(C::ONE).rejoin },
        plausible: Plausible { position: [all(-4.0), all(4.0)], speed: all(20.0), ..Plausible::ANYTHING },
        ..Settings::open(C::from_f64(1e-3))
    }
}

/// A step at the motion `x` with readings of the age `age`.
fn step<C: Float>(
    guard: &mut Guard<C, 2>,
    x: &Motion<C, 2>,
    age: Age,
    law: impl FnMut(&Motion<C, 2>) -> Vector<C, 2>,
    holding: impl FnMut(&Vector<C, 2>) -> Vector<C, 2>,
) -> Decision<C, 2> {
    guard.step(&Seen { age, ..Seen::fresh(x) }, &mut (law, holding))
}

fn guard() -> Guard<f64, 2> {
    Guard::new(settings()).expect("sound settings")
}

fn moving() -> Motion<f64, 2> {
    Motion {
        q_l: Vector([0.3, -0.5]),
        q_m: Vector([0.3, -0.5]),
        v_l: Vector([0.1, 0.2]),
        v_m: Vector([0.5, -0.25]),
    }
}

fn held(_: &Vector<f64, 2>) -> Vector<f64, 2> {
    Vector([0.4, 0.2])
}

/// A step with a law that asks for `torque`.
fn ask(guard: &mut Guard<f64, 2>, torque: [f64; 2]) -> Decision<f64, 2> {
    step(guard, &moving(), Age::FRESH, |_| Vector(torque), held)
}

/// A step that the law must not decide.
fn bad(guard: &mut Guard<f64, 2>, x: &Motion<f64, 2>, age: Age) -> Decision<f64, 2> {
    step(guard, x, age, |_| panic!("the law was called on a bad reading"), held)
}

/// A value that has broken controllers before, or a sane one.
fn nasty(r: &mut Numbers) -> f64 {
    const VALUES: [f64; 10] =
        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, f64::MAX, 5e-324, 1e38, -1e38, -0.0];
    // One number in two is sane.
    let pick = 10.0 * (r.next() + 1.0);
    let found = VALUES.iter().enumerate().find(|(i, _)| pick < *i as f64 + 1.0);
    found.map_or_else(|| 3.0 * r.next(), |(_, value)| *value)
}

/// Whatever comes in, finite torques inside both limits go out, and a step that was decided by the law had a good reading.
fn whatever_comes_in<C: Float + Debug>(epsilon: f64, seed: u64) {
    let mut r = Numbers(seed);
    let set = settings::<C>();
    let mut followed = 0;
    for _ in 0..50 {
        let mut guard = Guard::new(set).expect("sound settings");
        let mut last: Vector<C, 2> = Vector::ZERO;
        for _ in 0..400 {
            // Mostly good readings, or nothing would ever be followed.
            let garbled = r.next() > 0.7;
            let mut number = || C::from_f64(if garbled { nasty(&mut r) } else { r.next() });
            let [q_l, q_m, v_l, v_m] = core::array::from_fn(|_| Vector([number(), number()]));
            let age =
                Age { link: u32::from(r.next() > 0.9) * 3, motor: u32::from(r.next() > 0.9) * u32::MAX };
            let (x, torque) =
                (Motion { q_l, q_m, v_l, v_m }, Vector([(); 2]).map(|()| C::from_f64(nasty(&mut r))));
            let hold = Vector([(); 2]).map(|()| C::from_f64(nasty(&mut r)));
            let decision = step(&mut guard, &x, age, |_| torque, |_| hold);
            for i in 0..2 {
                let (u, limit) = (decision.torque[i], set.torque_limit[i]);
                assert!(
                    u.is_finite() && u <= limit && -limit <= u,
                    "{x:?} {torque:?} {hold:?}: {decision:?}"
                );
                // What is added to the last torque is rounded.
                let step = set.torque_rate_limit[i] * set.period + C::from_f64(20.0 * epsilon);
                assert!(u - last[i] <= step && last[i] - u <= step, "{last:?} {decision:?}");
            }
            let finite = |v: &Vector<C, 2>| v.iter().all(C::is_finite);
            if decision.status.phase.is_law_s() {
                followed += 1;
                assert!(
                    finite(&x.q_l) && finite(&x.q_m) && finite(&x.v_l) && finite(&x.v_m) && finite(&torque)
                );
                assert!(age.link <= 1 && age.motor <= 1);
            }
            last = decision.torque;
        }
    }
    // Of 20,000: both sides of the guard are tried.
    assert!((500..19_500).contains(&followed), "{followed}");
}

#[test]
fn whatever_comes_in_finite_torques_inside_the_limits_go_out() {
    whatever_comes_in::<f64>(f64::EPSILON, 1);
    whatever_comes_in::<f32>(f64::from(f32::EPSILON), 2);
}

/// Inside the limits the guard is not there.
#[test]
fn inside_the_limits_the_torque_is_the_law_s() {
    let mut guard = guard();
    for k in 0..100 {
        let torque = [0.004 * f64::from(k), -0.003 * f64::from(k)];
        let decision = ask(&mut guard, torque);
        assert_eq!(decision.torque, Vector(torque));
        assert_eq!(decision.status.phase, Phase::Following);
        assert_eq!(decision.status.certificate(), Certificate::Holds);
    }
}

/// After any time at the limit the torque is that of a guard that was never limited, in the first step in which the law asks for less
/// and the rate limit allows it; before that it goes there at the rate limit, without a jump.
#[test]
fn no_windup_and_no_jump_on_release() {
    for steps in [1, 10, 10_000] {
        let (mut limited, mut never) = (guard(), guard());
        for _ in 0..steps {
            ask(&mut limited, [1e3, -1e3]);
        }
        let mut last = ask(&mut limited, [1e3, -1e3]).torque;
        for _ in 0..17 {
            let decision = ask(&mut limited, [0.3, -0.2]);
            let status = decision.status;
            for i in 0..2 {
                let change = (decision.torque[i] - last[i]).abs();
                assert!(change <= 0.5 + 1e-12, "{change} N m in a step of 0.5");
                assert!(change > 0.49 || !status.rate_limited[i], "as fast as it may: {change}");
            }
            assert!(!status.torque_limited[0] && !status.torque_limited[1]);
            last = decision.torque;
        }
        // 8.39 N m at 0.5 N m a step are 17 steps at most.
        ask(&mut never, [0.3, -0.2]);
        for torque in [[0.31, -0.2], [0.5, 0.1], [0.2, 0.3]] {
            assert_eq!(ask(&mut limited, torque), ask(&mut never, torque));
        }
    }
    // Without a rate limit, in the very step.
    let unlimited = Settings { torque_rate_limit: Vector([f64::INFINITY; 2]), ..settings() };
    let mut guard = Guard::new(unlimited).expect("sound settings");
    for _ in 0..1000 {
        assert_eq!(ask(&mut guard, [1e3, -1e3]).torque, Vector([8.39, -1.67]));
    }
    assert_eq!(ask(&mut guard, [0.3, -0.2]).torque, Vector([0.3, -0.2]));
}

/// The status names the limits and the joints in the step in which they act, and the certificate is suspended in that step.
#[test]
fn limits_are_reported_in_the_same_step() {
    let none = Suspension::NONE;
    let mut fast = Guard::new(Settings { torque_rate_limit: Vector([1e6; 2]), ..settings() }).expect("sound");
    assert_eq!(ask(&mut fast, [8.39, -1.67]).status.certificate(), Certificate::Holds);
    let status = ask(&mut fast, [8.0, -1.68]).status;
    assert_eq!((status.torque_limited, status.rate_limited), (Vector([false, true]), Vector([false, false])));
    assert_eq!(status.certificate(), Certificate::Suspended(Suspension { torque_limited: true, ..none }));
    assert_eq!(ask(&mut fast, [8.0, -1.67]).status.certificate(), Certificate::Holds);

    let mut slow = guard();
    let status = ask(&mut slow, [0.6, 0.4]).status;
    assert_eq!(status.rate_limited, Vector([true, false]));
    assert_eq!(status.certificate(), Certificate::Suspended(Suspension { rate_limited: true, ..none }));
    assert_eq!(ask(&mut slow, [0.6, 0.4]).status.certificate(), Certificate::Holds);

    let status = bad(&mut slow, &moving(), Age { link: 2, motor: 0 }).status;
    assert!(matches!(status.certificate(), Certificate::Suspended(Suspension { stopped: true, .. })));
}

/// Links that are farther from the reference than what is proved speaks of suspend the certificate in that step, and nothing else; so does
/// where they are not known. Without a target nothing is compared.
#[test]
fn outside_of_a_region_nothing_is_done_and_it_is_said() {
    let region = Settings { region: Vector([0.1, f64::INFINITY]), ..settings() };
    let [mut guard, mut without] =
        [region, settings()].map(|settings| Guard::new(settings).expect("sound settings"));
    let seen = |q: f64, target: Option<f64>| Seen {
        target: target.map(|target| Vector([target, 5.0])),
        ..Seen::fresh(&Motion::at_rest(Vector([q, 0.0])))
    };
    let none = Suspension::NONE;
    for (q, target, outside) in
        [(0.0, Some(0.1), false), (0.2, Some(0.09), true), (-0.2, Some(-0.09), true), (0.2, None, false)]
    {
        let step = |guard: &mut Guard<f64, 2>| {
            let law = |_: &Motion<f64, 2>| Vector([0.1, 0.1]);
            guard.step(&seen(q, target), &mut (law, |_: &Vector<f64, 2>| Vector::ZERO))
        };
        let (with, plain) = (step(&mut guard), step(&mut without));
        assert_eq!((with.torque, with.status.phase), (plain.torque, plain.status.phase));
        assert_eq!(with.status.outside, Vector([outside, false]), "{q} {target:?}");
        let suspended = Certificate::Suspended(Suspension { outside: true, ..none });
        assert_eq!(with.status.certificate(), if outside { suspended } else { Certificate::Holds });
        assert_eq!(plain.status.certificate(), Certificate::Holds);
    }
    assert!(Guard::new(Settings { region: Vector([0.0, 1.0]), ..settings::<f64>() }).is_none());
}

/// Each kind of fault stops in its own step, and is reported where it is.
#[test]
fn faults_are_reported_by_joint_and_side() {
    let good = moving();
    let with = |q_l: [f64; 2], v_m: [f64; 2]| Motion { q_l: Vector(q_l), v_m: Vector(v_m), ..good };
    let (ok, fresh) = (None, Age::FRESH);
    let cases = [
        (with([f64::NAN, 0.0], [0.0; 2]), fresh, [Some(Fault::NotFinite), ok], [ok, ok]),
        (with([0.0; 2], [0.0, f64::INFINITY]), fresh, [ok, ok], [ok, Some(Fault::NotFinite)]),
        (with([0.0, 4.1], [0.0; 2]), fresh, [ok, Some(Fault::Position)], [ok, ok]),
        (with([0.0; 2], [-20.1, 0.0]), fresh, [ok, ok], [Some(Fault::Speed), ok]),
        (good, Age { link: 0, motor: 2 }, [ok, ok], [Some(Fault::Stale); 2]),
        (good, Age { link: 9, motor: 1 }, [Some(Fault::Stale); 2], [ok, ok]),
    ];
    for (x, age, link, motor) in cases {
        let mut guard = guard();
        ask(&mut guard, [0.1, 0.1]);
        let status = bad(&mut guard, &x, age).status;
        assert_eq!((status.link_fault, status.motor_fault), (Vector(link), Vector(motor)));
        assert_eq!((status.phase, status.controller_fault), (Phase::Stopped, None));
    }
    let late = step(&mut guard(), &good, Age { link: 1, motor: 1 }, |_| Vector::ZERO, held).status;
    assert_eq!(late.phase, Phase::Coasting, "not yet too old");
    assert_eq!(late.certificate(), Certificate::Suspended(Suspension { coasting: true, ..Suspension::NONE }));
}

/// During a stop: damping where the motor is good, the holding torque of the last good posture alone where it is not.
#[test]
fn a_stop_damps_the_motors_that_are_good_and_holds() {
    let mut guard = guard();
    ask(&mut guard, [0.4, 0.2]);
    let x = Motion { q_l: Vector([f64::NAN; 2]), q_m: Vector([0.0, f64::NAN]), ..moving() };
    let mut torque = Vector::ZERO;
    for _ in 0..10 {
        let step = step(
            &mut guard,
            &x,
            Age::FRESH,
            |_| panic!("bad"),
            |q| {
                assert_eq!(*q, moving().q_l, "the last good posture");
                held(q)
            },
        );
        torque = step.torque;
    }
    // Joint 1: 0.4 − 2 · 0.5; joint 2: its motor is unknown.
    close(&torque, &Vector([-0.6, 0.2]), 1e-15);
    // A reading that is bad from the start: no posture, no holding.
    let first = bad(&mut self::guard(), &x, Age { link: 0, motor: 5 });
    assert_eq!(first.torque, Vector::ZERO);
}

/// The law takes over after the asked number of good readings in a row, one step after it was announced.
#[test]
fn rejoins_after_consecutive_good_readings() {
    let mut guard = guard();
    ask(&mut guard, [0.1, 0.1]);
    bad(&mut guard, &moving(), Age { link: 2, motor: 0 });
    for interruption in [true, false] {
        for k in 1..=REJOIN {
            let last = k == REJOIN;
            if last && interruption {
                bad(&mut guard, &moving(), Age { link: 0, motor: 2 });
            } else {
                let status = bad(&mut guard, &moving(), Age::FRESH).status;
                assert_eq!(status.phase, if last { Phase::Rejoined } else { Phase::Stopped }, "after {k}");
                assert_ne!(status.certificate(), Certificate::Holds, "the torque is not the law's yet");
            }
        }
    }
    assert_eq!(ask(&mut guard, [0.1, 0.1]).status.phase, Phase::Following);
}

/// A law that gives no numbers stops the robot as a sensor does.
#[test]
fn a_law_that_fails_stops() {
    for garbage in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut guard = guard();
        ask(&mut guard, [0.1, 0.1]);
        let status = ask(&mut guard, [0.0, garbage]).status;
        assert!(status.controller_fault == Some(Fault::Law) && status.phase == Phase::Stopped);
        for _ in 1..REJOIN {
            assert_eq!(bad(&mut guard, &moving(), Age::FRESH).status.phase, Phase::Stopped);
        }
        assert_eq!(bad(&mut guard, &moving(), Age::FRESH).status.phase, Phase::Rejoined);
        assert_eq!(ask(&mut guard, [0.1, 0.1]).status.phase, Phase::Following);
    }
}

/// The plausible arm at speed loses its link encoders for good: from then on no step adds energy, and it comes to rest.
#[test]
fn a_stop_takes_energy_out_until_the_robot_rests() {
    let arm = plausible_arm();
    let settings = Settings { torque_rate_limit: Vector([f64::INFINITY; 2]), ..settings() };
    let mut guard = Guard::new(settings).expect("sound settings");
    let mut x =
        Motion { v_l: Vector([3.0, -4.0]), v_m: Vector([3.0, -4.0]), ..Motion::at_rest(Vector([0.3, -0.5])) };
    let start = arm.total_energy(&x);
    let mut energy = start;
    for _ in 0..2000 {
        let seen = Motion { q_l: Vector([f64::NAN; 2]), ..x };
        let u = step(&mut guard, &seen, Age::FRESH, |_| panic!("bad"), |_| Vector::ZERO).torque;
        x = advance(&arm, &x, &u, &Push::NONE, 1e-3, 20);
        assert!(arm.total_energy(&x) <= energy, "energy is added");
        energy = arm.total_energy(&x);
    }
    assert!(energy < 1e-9 * start, "{energy} J of {start}");
}

/// The whole loop: the law tracks, its sensors die and come back, and it tracks again; torques never leave the limits.
#[test]
fn a_loop_survives_a_dropout() {
    let (arm, law) = (plausible_arm(), gentle());
    let mut guard = guard();
    let mut x = Motion::at_rest(Vector([0.3, -0.5]));
    let goal = Vector([Jet::<f64, 5>::from_f64(0.3), Jet::from_f64(-0.5)]);
    let mut phases = Vec::new();
    for k in 0..8000 {
        let dead = (3000..3050).contains(&k);
        let seen =
            if dead { Motion { q_l: Vector([f64::NAN; 2]), v_l: Vector([f64::NAN; 2]), ..x } } else { x };
        let decision = step(
            &mut guard,
            &seen,
            Age::FRESH,
            |x| law.command(&arm, x, &goal, &Input::ZERO).u_m,
            |_| Vector::ZERO,
        );
        let push = if (2900..3000).contains(&k) { Vector([0.5, 0.1]) } else { Vector::ZERO };
        x = advance(&arm, &x, &decision.torque, &Push { link: push, motor: Vector::ZERO }, 1e-3, 20);
        phases.push(decision.status.phase);
    }
    assert!(phases[..3000].iter().all(|phase| *phase == Phase::Following));
    assert!(phases[3000..3054].iter().all(|phase| *phase == Phase::Stopped), "at once, and 5 good readings");
    assert_eq!(phases[3054], Phase::Rejoined);
    assert!(phases[3055..].iter().all(|phase| *phase == Phase::Following));
    let error = (x.q_l - Vector([0.3, -0.5])).iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    assert!(error < 1e-6, "{error} rad left");
}

#[test]
fn only_sound_settings() {
    let sound = settings::<f64>();
    let with = |change: fn(&mut Settings<f64, 2>)| {
        let mut settings = sound;
        change(&mut settings);
        Guard::new(settings).is_some()
    };
    assert!(
        with(|_| ())
            && with(|s| s.torque_rate_limit[1] = f64::INFINITY)
            && with(|s| s.plausible.speed[0] = f64::INFINITY)
    );
    assert!(with(|s| s.stop_damping[0] = 0.0) && with(|s| s.allowed_age = 0));
    assert!(
        !with(|s| s.period = 0.0) && !with(|s| s.period = f64::INFINITY) && !with(|s| s.rejoin.after = 0)
    );
    assert!(with(|s| s.torque_limit[1] = f64::INFINITY) && !with(|s| s.torque_limit[1] = f64::NAN));
    assert!(!with(|s| s.torque_rate_limit[0] = f64::NAN) && !with(|s| s.torque_rate_limit[0] = 0.0));
    assert!(!with(|s| s.stop_damping[0] = -1.0) && !with(|s| s.stop_damping[0] = f64::INFINITY));
    assert!(!with(|s| s.plausible.position[1][0] = f64::NAN) && !with(|s| s.plausible.speed[1] = 0.0));
}
