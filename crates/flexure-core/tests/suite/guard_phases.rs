//! The states of a guard: coasting, stops that end and stops that last, the log, and how the law takes over.

use flexure_core::estimate::Disturbance;
use flexure_core::guard::{
    Age, Coasting, Collision, Entry, Fault, Frozen, Guard, Latch, Log, Phase, Place, Plausible, Reaction,
    Rejoin, Seen, Settings, Torques, Watchdog,
};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;

use crate::common::plant::{PERIOD, Push, advance, plausible_arm, stirring};

type V = Vector<f64, 2>;

/// Asks for one torque, holds nothing, and takes over with another torque.
struct Asking {
    law: V,
    joining: V,
}

impl Torques<f64, 2> for Asking {
    fn law(&mut self, _: &Motion<f64, 2>) -> V {
        self.law
    }
    fn holding(&mut self, _: &V) -> V {
        Vector::ZERO
    }
    fn joining(&mut self, _: &Motion<f64, 2>, _: &V) -> V {
        self.joining
    }
}

fn nothing() -> Asking {
    Asking { law: Vector::ZERO, joining: Vector::ZERO }
}

fn settings() -> Settings<f64, 2> {
    let all = |x| Vector([x; 2]);
    let open = Settings::open(PERIOD);
    Settings {
        torque_limit: all(10.0),
        stop_damping: all(1.0),
        rejoin: Rejoin { after: 3, speed: all(0.5), error: all(0.2) },
        ..open
    }
}

fn guard(settings: &Settings<f64, 2>) -> Guard<f64, 2> {
    Guard::new(*settings).expect("sound")
}

fn at(q: f64) -> Seen<f64, 2> {
    Seen::fresh(&Motion::at_rest(Vector([q; 2])))
}

fn lost() -> Seen<f64, 2> {
    Seen { age: Age { link: u32::MAX, motor: 0 }, ..at(0.0) }
}

fn phases(guard: &mut Guard<f64, 2>, seen: &Seen<f64, 2>, steps: usize) -> Vec<Phase> {
    (0..steps).map(|_| guard.step(seen, &mut nothing()).status.phase).collect()
}

/// The law takes over from a robot that is slow and near its reference, and waits for that.
#[test]
fn the_law_takes_over_from_a_slow_robot_near_its_reference_only() {
    let slow = at(0.1);
    let fast = Seen::fresh(&Motion { v_l: Vector([0.0, 0.6]), ..slow.x });
    let far = Seen { target: Some(Vector([0.1, 0.31])), ..slow };
    for unfit in [fast, far] {
        let mut guard = guard(&settings());
        guard.step(&lost(), &mut nothing());
        assert_eq!(phases(&mut guard, &unfit, 50), [Phase::Stopped; 50]);
        assert_eq!(phases(&mut guard, &slow, 2), [Phase::Rejoined, Phase::Following]);
    }
}

/// The torque of the first instant after a stop is what acted but for a tenth of the way to the law's, and it gets there.
#[test]
fn the_law_takes_over_without_a_jump() {
    let mut guard = guard(&settings());
    let mut asking = Asking { law: Vector([4.0, -2.0]), joining: Vector([4.0, -2.0]) };
    guard.step(&lost(), &mut asking);
    let mut last = Vector::ZERO;
    let mut torques = Vec::new();
    for _ in 0..16 {
        let decision = guard.step(&at(0.0), &mut asking);
        let change = (decision.torque - last).iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        assert!(change <= 0.4 + 1e-12, "{change} N m in a step");
        last = decision.torque;
        torques.push(last);
    }
    assert_eq!(torques[2], Vector::ZERO, "the third good reading is the last of the stop");
    assert!((torques[3] - Vector([0.4, -0.2])).iter().all(|u| u.abs() < 1e-12));
    assert_eq!(torques[12..], [Vector([4.0, -2.0]); 4], "the law's to the bit");
}

/// Where the rate limit would not let the torque get there, the law has to wait.
#[test]
fn the_law_waits_for_a_torque_that_it_can_take_over_from() {
    let rated = Settings { torque_rate_limit: Vector([100.0; 2]), ..settings() };
    let mut guard = guard(&rated);
    guard.step(&lost(), &mut nothing());
    // 0.1 N m a period, ten periods.
    let mut far = Asking { law: Vector::ZERO, joining: Vector([0.0, 1.01]) };
    for _ in 0..50 {
        assert_eq!(guard.step(&at(0.0), &mut far).status.phase, Phase::Stopped);
    }
    let mut near = Asking { joining: Vector([0.0, 0.99]), ..far };
    assert_eq!(guard.step(&at(0.0), &mut near).status.phase, Phase::Rejoined);
}

#[test]
fn torque_goes_off_after_a_time_and_stays_off() {
    let mut guard = guard(&Settings { off_after: Some(5), ..settings() });
    assert_eq!(phases(&mut guard, &lost(), 5), [Phase::Stopped; 5]);
    let moving = Motion { v_m: Vector([1.0; 2]), ..lost().x };
    let decision = guard.step(&Seen { x: moving, ..lost() }, &mut nothing());
    assert_eq!((decision.status.phase, decision.torque), (Phase::Off, Vector::ZERO), "not even braked");
    assert!(decision.status.latched);
    assert_eq!(phases(&mut guard, &at(0.0), 100), [Phase::Off; 100]);
    guard.reset();
    assert_eq!(phases(&mut guard, &at(0.0), 3)[1..], [Phase::Stopped, Phase::Rejoined]);
}

/// The third stop within the time lasts; stops far apart do not count.
#[test]
fn a_robot_that_keeps_stopping_stays_stopped() {
    let latch = Some(Latch { stops: 3, within: 30 });
    for (pause, lasts) in [(4, true), (20, false)] {
        let mut guard = guard(&Settings { latch, ..settings() });
        for _ in 0..3 {
            guard.step(&lost(), &mut nothing());
            phases(&mut guard, &at(0.0), pause);
        }
        let status = guard.step(&at(0.0), &mut nothing()).status;
        assert_eq!(status.latched, lasts, "{pause} instants between");
        let phase = if lasts { Phase::Stopped } else { Phase::Following };
        assert_eq!(phases(&mut guard, &at(0.0), 100), [phase; 100]);
        guard.reset();
        assert_eq!(phases(&mut guard, &at(0.0), 20).last(), Some(&Phase::Following));
    }
}

/// Instants that are missed are seen, and a clock that stands or goes back.
#[test]
fn time_is_watched() {
    let stamps = |stamps: &[u64]| {
        let mut guard = guard(&Settings { allowed_age: 2, ..settings() });
        let fault = |&stamp| {
            guard.step(&Seen { stamp: Some(stamp), ..at(0.0) }, &mut nothing()).status.controller_fault
        };
        stamps.iter().map(fault).last().flatten()
    };
    assert_eq!(stamps(&[7, 8, 9, 10]), None);
    assert_eq!(stamps(&[7, 8, 11]), None, "two missed");
    assert_eq!(stamps(&[7, 8, 12]), Some(Fault::Late), "three missed");
    assert_eq!(stamps(&[7, 8, 8]), Some(Fault::Backwards));
    assert_eq!(stamps(&[7, 8, 3]), Some(Fault::Backwards));
    assert_eq!(stamps(&[7, 8, 3, 4]), None, "it goes on from there");
    assert_eq!(stamps(&[0, u64::MAX]), Some(Fault::Late));
}

/// The log has the first cause of each stop with its time and place, and the steps that led to the first.
#[test]
fn the_log_says_what_came_first() {
    let mut guard = guard(&settings());
    for k in 0..20 {
        guard.step(&at(0.01 * f64::from(k)), &mut nothing());
    }
    assert_eq!(guard.log().count(), 0);
    let mut bad = at(0.2);
    bad.x.v_m[1] = f64::NAN;
    guard.step(&bad, &mut nothing());
    phases(&mut guard, &lost(), 10);
    phases(&mut guard, &at(0.2), 10);
    guard.step(&at(0.2), &mut Asking { law: Vector([f64::NAN; 2]), ..nothing() });
    let expected = [
        Entry { time: 20, cause: Fault::NotFinite, place: Place::Motor(1) },
        Entry { time: 41, cause: Fault::Law, place: Place::Controller },
    ];
    assert!(guard.log().entries().eq(expected), "{:?}", guard.log());
    let steps: Vec<_> = guard.log().steps().collect();
    assert_eq!(steps.len(), Log::<f64, 2>::STEPS);
    for (k, step) in (13..21).zip(&steps) {
        assert_eq!(step.time, k, "up to the first stop");
        assert_eq!(step.phase, if k < 20 { Phase::Following } else { Phase::Stopped });
    }
    assert_eq!(steps[0].x.q_l, Vector([0.01 * 13.0; 2]));
    // A ring: of many stops the last are kept.
    for _ in 0..40 {
        guard.step(&lost(), &mut nothing());
        phases(&mut guard, &at(0.2), 4);
    }
    // The first of the forty finds it stopped.
    assert_eq!((guard.log().count(), guard.log().entries().count()), (41, Log::<f64, 2>::CAPACITY));
    let times: Vec<_> = guard.log().entries().map(|entry| entry.time).collect();
    assert!(times.is_sorted() && times.last() == Some(&(42 + 39 * 5)), "{times:?}");
}

fn doubting(plausible: Plausible<f64, 2>) -> Guard<f64, 2> {
    guard(&Settings { plausible, ..settings() })
}

/// What a reading is doubted for, at the second joint.
fn doubt(guard: &mut Guard<f64, 2>, q_l: f64, q_m: f64, v: f64) -> [Option<Fault>; 2] {
    let x = Motion {
        q_l: Vector([0.0, q_l]),
        q_m: Vector([0.0, q_m]),
        v_l: Vector([0.0, v]),
        v_m: Vector([0.0, v]),
    };
    let status = guard.step(&Seen { target: Some(x.q_m), ..Seen::fresh(&x) }, &mut nothing()).status;
    assert_eq!((status.link_fault[0], status.motor_fault[0]), (None, None), "the other joint is fine");
    [status.link_fault[1], status.motor_fault[1]]
}

#[test]
fn what_cannot_be_is_not_believed() {
    let any = Plausible::<f64, 2>::ANYTHING;
    let all = |x| Vector([x; 2]);
    let fine = [None; 2];
    let mut wound = doubting(Plausible { deflection: all(0.3), ..any });
    assert_eq!(doubt(&mut wound, 0.0, 0.29, 0.0), fine);
    assert_eq!(doubt(&mut wound, 0.0, 0.31, 0.0), [Some(Fault::Deflection); 2]);
    let position = [Vector([-1.0, -0.2]), Vector([1.0, 0.7])];
    let mut bounded = doubting(Plausible { position, ..any });
    assert_eq!(doubt(&mut bounded, -0.19, 0.69, 0.0), fine);
    assert_eq!(doubt(&mut bounded, -0.21, 0.71, 0.0), [Some(Fault::Position); 2]);
    // A turn that is lost stays lost until the reading is back, however long that takes.
    let mut jumping = doubting(Plausible { jump: all(0.5), ..any });
    assert_eq!(doubt(&mut jumping, 0.0, 0.0, 0.0), fine);
    assert_eq!(doubt(&mut jumping, 0.4, 0.4, 0.0), fine);
    for _ in 0..100 {
        assert_eq!(doubt(&mut jumping, 0.4 + std::f64::consts::TAU, 0.4, 0.0), [Some(Fault::Jump), None]);
    }
    assert_eq!(doubt(&mut jumping, 0.5, 0.4, 0.0), fine);
    // A robot that was moving goes on while nobody sees it: by 2 rad/s for at most a quarter of a second.
    for (after, far, doubted) in
        [(100, 0.69, false), (100, 0.71, true), (900, 0.99, false), (900, 1.01, true)]
    {
        let mut jumping = doubting(Plausible { jump: all(0.5), ..any });
        assert_eq!(doubt(&mut jumping, 0.0, 0.0, 2.0), fine);
        for _ in 1..after {
            doubt(&mut jumping, f64::NAN, f64::NAN, 0.0);
        }
        assert_eq!(doubt(&mut jumping, far, 0.0, 0.0)[0], doubted.then_some(Fault::Jump), "{after}: {far}");
    }
}

/// A velocity that is not the rate of the position shows after some periods; noise of one reading does not.
#[test]
fn a_velocity_goes_with_its_position() {
    let plausible = Plausible { velocity: Vector([0.5; 2]), ..Plausible::ANYTHING };
    let mut guard = doubting(plausible);
    let q = |k: u32| 1e-3 * f64::from(k);
    assert!((0..200).all(|k| doubt(&mut guard, q(k), q(k), 1.0) == [None; 2]), "1 rad/s at 1 kHz");
    // A count of 3 mrad is 3 rad/s for one period, of which a tenth counts.
    assert_eq!(doubt(&mut guard, q(200) + 3e-3, q(200), 1.0), [None; 2]);
    let mut guard = doubting(plausible);
    let first = (0..200).find(|&k| doubt(&mut guard, q(k), q(k), 2.0) != [None; 2]);
    // 1 − 0.9ⁿ > ½ from n = 7 on; the first reading has no rate.
    assert_eq!(first, Some(7));
}

/// Stuck readings show when the other side moves, or where the robot shall be; a robot at rest is not stuck.
#[test]
fn a_reading_that_is_stuck_is_none() {
    let frozen = Some(Frozen { periods: 10, travel: 0.05 });
    let plausible = Plausible { frozen, ..Plausible::ANYTHING };
    let mut guard = doubting(plausible);
    assert!((0..1000).all(|_| doubt(&mut guard, 0.3, 0.3, 0.0) == [None; 2]), "at rest");
    let moved = (0..100).map(|k| doubt(&mut guard, 0.3, 0.3 + 0.01 * f64::from(k), 0.0)).collect::<Vec<_>>();
    let first = moved.iter().position(|doubt| doubt[0].is_some()).expect("found");
    assert!((5..8).contains(&first), "0.05 rad at 0.01 rad a period: {first}");
    assert!(moved[first..].iter().all(|doubt| *doubt == [Some(Fault::Frozen), None]), "until it changes");
    assert_eq!(doubt(&mut guard, 0.31, 1.3, 0.0), [None; 2]);
    // Both sides stuck: the reference tells.
    let mut guard = doubting(plausible);
    let mut stuck = |k: u32| {
        let target = Some(Vector([0.01 * f64::from(k); 2]));
        guard.step(&Seen { target, ..at(0.3) }, &mut nothing()).status.fault()
    };
    let first = (0..100).find(|&k| stuck(k).is_some());
    assert_eq!(first, Some(10), "ten periods");
}

/// Every reaction answers the torque that was felt; the law comes back when it is gone.
#[test]
fn a_collision_is_answered() {
    let push = Disturbance { link: Vector([0.0, 3.0]), motor: Vector::ZERO };
    let moving = Seen::fresh(&Motion { v_m: Vector([0.2, -0.4]), ..Motion::at_rest(Vector::ZERO) });
    let hit = Seen { residual: push, ..moving };
    let braked = Vector([-0.2, 0.4]);
    let cases = [
        (Reaction::Stop, [braked; 4]),
        (Reaction::Float, [Vector::ZERO; 4]),
        (Reaction::Retract(2), [Vector([-0.2, 3.4]), Vector([-0.2, 3.4]), braked, braked]),
    ];
    for (reaction, expected) in cases {
        let collision = Some(Collision { threshold: Vector([2.5; 2]), reaction });
        let mut guard = guard(&Settings { collision, ..settings() });
        let soft = Seen { residual: Disturbance { link: Vector([2.4; 2]), ..push }, ..moving };
        assert_eq!(guard.step(&soft, &mut nothing()).status.phase, Phase::Following);
        let first = guard.step(&hit, &mut nothing());
        assert_eq!(first.status.fault(), Some((Fault::Collision, Place::Link(1))));
        let rest = (0..3).map(|_| guard.step(&hit, &mut nothing()));
        let torques: Vec<_> = [first].into_iter().chain(rest).map(|decision| decision.torque).collect();
        assert_eq!(torques, expected, "{reaction:?}");
        assert_eq!(phases(&mut guard, &moving, 4)[2..], [Phase::Rejoined, Phase::Following]);
    }
}

/// Twenty periods without any reading on a moving arm: the prediction is as good as its order, and no estimate is needed.
#[test]
fn a_short_silence_is_bridged_by_the_model() {
    let arm = plausible_arm();
    let mut coasting = Coasting::new(20, PERIOD).expect("positive");
    let mut x =
        Motion { v_l: Vector([1.0, -0.5]), v_m: Vector([1.0, -0.5]), ..Motion::at_rest(Vector([0.1, 0.2])) };
    coasting.saw(&x);
    let silence = Motion::at_rest(Vector([f64::NAN; 2]));
    let mut u = Vector::ZERO;
    for k in 1..=25_u32 {
        u = stirring(1.0, f64::from(k) * PERIOD);
        x = advance(&arm, &x, &u, &Push::NONE, PERIOD, 20);
        let (filled, age) = coasting.fill(&arm, &silence, Age::FRESH, [true; 2], &u);
        coasting.saw(&filled);
        assert_eq!(age, Age { link: k, motor: k });
        if k > 20 {
            assert!(filled.q_l[0].is_nan(), "too long");
            continue;
        }
        let error = [filled.q_l - x.q_l, filled.q_m - x.q_m];
        let error = error.iter().flat_map(Vector::iter).fold(0.0, |m: f64, e| m.max(e.abs()));
        // Trapezoidal rule: of a motor that brakes with 500 1/s a step of 1 ms misses (500 · 1 ms)²/12 of up to 2 mrad.
        assert!(error < 1e-4, "{error} rad after {k} periods");
    }
    // One side: the other one is read.
    coasting.fill(&arm, &x, Age::FRESH, [true; 2], &u);
    coasting.saw(&x);
    let half = Motion { q_l: Vector([f64::NAN; 2]), ..x };
    let (filled, age) = coasting.fill(&arm, &half, Age::FRESH, [true; 2], &u);
    assert!(filled.q_m == x.q_m && filled.q_l[0].is_finite() && age == Age { link: 1, motor: 0 });
    // A side without sensors is not missed.
    let (filled, age) = coasting.fill(&arm, &half, Age::FRESH, [false, true], &u);
    assert!(filled.q_l[0].is_nan() && age == Age::FRESH);
}

/// Of a silent controller the torque fades to nothing, and comes back with it.
#[test]
fn a_watchdog_gives_nothing_of_old() {
    let fall = Vector([1.0, f64::INFINITY]);
    let mut watchdog = Watchdog::new(2, fall).expect("positive");
    assert!(watchdog.has_tripped() && watchdog.step(None) == Vector::ZERO, "nothing was commanded yet");
    let command = Vector([-2.5, 4.0]);
    assert_eq!(watchdog.step(Some(command)), command);
    let given: Vec<_> = (0..6).map(|_| watchdog.step(None).0).collect();
    let faded = [[-1.5, 0.0], [-0.5, 0.0], [0.0, 0.0], [0.0, 0.0]];
    assert_eq!(given, [[command.0; 2].as_slice(), &faded].concat());
    assert_eq!(watchdog.step(Some(Vector([f64::NAN, 1.0]))), Vector::ZERO, "no command");
    assert_eq!(watchdog.step(Some(command)), command);
    assert!(Watchdog::new(1, Vector([0.0])).is_none() && Watchdog::new(1, Vector([f64::NAN])).is_none());
}
