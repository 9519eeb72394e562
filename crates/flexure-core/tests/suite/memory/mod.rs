//! What is remembered is all that matters: save, run, restore, run again.

mod names;
mod step;

use flexure_core::estimate::{
    DisturbanceObserver, Estimator, FilteredDifference, LowPass, MotorObserver, Observer,
};
use flexure_core::guard::{
    Coasting, Collision, Frozen, Guard, Latch, Plausible, Reaction, Rejoin, Seen, Settings, Watchdog,
};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Unfit, length, restore, save};
use flexure_core::model::{Fjr, Motion};
use flexure_core::robots::Tree;
use flexure_core::scalar::Float;

use self::names::each_name;
use self::step::{Estimating, Step, run};
use crate::common::{Numbers, branched, flexible};

const N: usize = 3;
const PERIOD: f64 = 1e-3;

type Robot = Fjr<f64, Tree<f64, N>, N>;

fn robot() -> Robot {
    flexible(branched::<N>(2), &mut Numbers(1))
}

fn saved<S: Copy + Into<f64>>(it: &mut dyn Memory<S>) -> Vec<f64> {
    let mut numbers = vec![f64::NAN; length(it, N)];
    save(it, N, &mut numbers).expect("the right length");
    numbers
}

/// When something is saved: the guard loses its readings at 26, where the posture matters, waits for good ones at 28, doubts a jump at
/// 33, hands over at 35, doubts velocities from 39 on, answers a collision at 60 and 61, finds readings frozen from 92 on, waits for readings
/// at 108, and is about to go off at 118.
const THEN: [u32; 11] = [26, 28, 33, 35, 38, 60, 61, 86, 95, 108, 118];

/// What is remembered at `then`, and what happens in the next hundred steps.
fn ahead<M: Step + Memory<f64>>(mut it: M, then: u32) -> (Vec<f64>, Vec<u64>) {
    run(&mut it, 0, then);
    let numbers = saved(&mut it);
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&saved(&mut it)), bits(&numbers), "saving changes nothing");
    (numbers, run(&mut it, then, 100))
}

/// What happens after `numbers` have been restored at `then`.
fn after<M: Step + Memory<f64>>(mut it: M, numbers: &[f64], then: u32) -> Vec<u64> {
    restore(&mut it, N, numbers).expect("fits");
    run(&mut it, then, 100)
}

/// Whether what is restored goes on as it did: in what it was saved of, after that moved on, and in what is made alike.
fn goes_on<M: Step + Memory<f64>>(make: impl Fn() -> M, then: u32) -> bool {
    let (numbers, first) = ahead(make(), then);
    let mut moved = make();
    run(&mut moved, 0, then + 100);
    after(moved, &numbers, then) == first && after(make(), &numbers, then) == first
}

/// Saved and restored it goes on as it did, and every number that is saved matters.
fn goes_on_from_what_was_saved<M: Step + Memory<f64>>(make: impl Fn() -> M) {
    assert!(THEN.iter().all(|&then| goes_on(&make, then)));
    let matters = |i: usize, then: u32, value: f64| {
        let (mut numbers, first) = ahead(make(), then);
        let was = core::mem::replace(&mut numbers[i], value);
        if restore(&mut make(), N, &numbers).is_err() {
            numbers[i] = 1.0 - was; // a flag
        }
        after(make(), &numbers, then) != first
    };
    // 10 means nothing where a number stands for one of a few things.
    let moments = || THEN.iter().flat_map(|&then| [10.0, 1.0, 2.0].map(|value| (then, value)));
    let names = each_name(&mut make());
    assert_eq!(names.len(), length(&mut make(), N));
    for (i, name) in names.iter().enumerate().filter(|(_, name)| !is_unused(name)) {
        assert!(moments().any(|(then, value)| matters(i, then, value)), "{name}, number {i}");
    }
}

/// Whether it is a place of the log that no stop has come to yet when things are saved: at most four have at first.
fn is_unused(name: &str) -> bool {
    let place = name.strip_prefix("log.stop.").and_then(|rest| rest.split('.').next());
    place.is_some_and(|place| place.parse::<u32>().expect("a number") > 3)
}

fn observer() -> Estimating<Observer<f64, N>> {
    Estimating(Observer::new(&Vector([30.0; N]), PERIOD).expect("positive"))
}

fn motor_observer() -> Estimating<MotorObserver<f64, N>> {
    Estimating(MotorObserver::new(&Vector([30.0; N]), PERIOD).expect("positive"))
}

fn difference() -> Estimating<FilteredDifference<f64, N>> {
    Estimating(FilteredDifference::new(LowPass::second_order(40.0, 0.9, PERIOD).expect("a filter")))
}

fn disturbance() -> DisturbanceObserver<f64, N> {
    DisturbanceObserver::new(&Vector([30.0; N]), PERIOD).expect("positive")
}

fn guard() -> Guard<f64, N> {
    let all = |x| Vector([x; N]);
    let open = Settings::open(PERIOD);
    Guard::new(Settings {
        torque_limit: all(30.0),
        torque_rate_limit: all(4e3),
        stop_damping: all(0.5),
        rejoin: Rejoin { after: 5, ..open.rejoin },
        plausible: Plausible {
            jump: all(0.005),
            frozen: Some(Frozen { periods: 12, travel: 0.5 }),
            velocity: all(3.0),
            ..Plausible::ANYTHING
        },
        collision: Some(Collision { threshold: all(50.0), reaction: Reaction::Retract(3) }),
        off_after: Some(24),
        latch: Some(Latch { stops: 16, within: 1000 }),
        ..open
    })
    .expect("sound")
}

fn coasting() -> Coasting<f64, N> {
    Coasting::new(2, PERIOD).expect("positive")
}

fn watchdog() -> Watchdog<f64, N> {
    Watchdog::new(1, Vector([0.1; N])).expect("positive")
}

#[test]
fn an_observer() {
    goes_on_from_what_was_saved(observer);
}

#[test]
fn a_motor_observer() {
    goes_on_from_what_was_saved(motor_observer);
}

#[test]
fn filtered_differences() {
    goes_on_from_what_was_saved(difference);
}

#[test]
fn a_disturbance_observer() {
    goes_on_from_what_was_saved(disturbance);
}

#[test]
fn a_guard() {
    goes_on_from_what_was_saved(guard);
}

#[test]
fn a_coasting_loop() {
    goes_on_from_what_was_saved(coasting);
}

#[test]
fn a_watchdog() {
    goes_on_from_what_was_saved(watchdog);
}

/// What has not begun is restored as that.
#[test]
fn what_is_absent() {
    fn begins_again<M: Step + Memory<f64>>(make: impl Fn() -> M) {
        let (mut it, numbers) = (make(), saved(&mut make()));
        let first = run(&mut it, 9, 40);
        restore(&mut it, N, &numbers).expect("fits");
        assert_eq!(run(&mut it, 9, 40), first);
    }
    begins_again(disturbance);
    begins_again(guard);
}

/// Phantoms are not saved.
#[test]
fn real_joints_only() {
    let mut it = observer();
    run(&mut it, 0, 28);
    let all = saved(&mut it);
    let mut two = [0.0; 8];
    save(&mut it, 2, &mut two).expect("two joints, four numbers each");
    for (two, all) in two.chunks(2).zip(all.chunks(N)) {
        assert_eq!(two, &all[..2]);
    }
    let mut fresh = observer();
    restore(&mut fresh, 2, &two).expect("fits");
    let numbers = saved(&mut fresh);
    assert_eq!(numbers[..3], [all[0], all[1], 0.0]);
}

#[test]
fn narrow_floats() {
    fn walk<C: Float + Into<f64>>(x: f64) -> (Vec<f64>, Vec<f64>) {
        let make = || Observer::<C, N>::new(&Vector([C::ONE; N]), C::ONE).expect("positive");
        let (mut a, mut b) = (make(), make());
        a.start(&Motion::at_rest(Vector([C::from_f64(x); N])));
        let numbers = saved(&mut a);
        restore(&mut b, N, &numbers).expect("fits");
        (saved(&mut b), numbers)
    }
    let (a, b) = walk::<f32>(0.1);
    assert_eq!(a, b);
    assert_eq!(a[..1], [f64::from(0.1_f32)]);
    assert_eq!(walk::<f64>(0.1).0[..1], [0.1]);
}

/// The place of the readings that a guard waits for: after its torque, posture and clock, and whether it is stopped.
const AWAITED: usize = N + 1 + N + 2 + 3 + 1;

#[test]
fn what_does_not_fit() {
    let mut it = guard();
    run(&mut it, 0, 28);
    let numbers = saved(&mut it);
    let needs = numbers.len();
    assert_eq!(save(&mut it, N, &mut [0.0; 2]), Err(Unfit::Length { has: 2, needs }));
    assert_eq!(restore(&mut it, N, &numbers[1..]), Err(Unfit::Length { has: needs - 1, needs }));
    let (flag, word) = (N, AWAITED);
    for (at, value) in [(flag, 2.0), (flag, 0.5), (word, -1.0), (word, 1.5), (word, 4_294_967_296.0)] {
        let mut wrong = vec![1.0; needs];
        wrong[at] = value;
        assert_eq!(restore(&mut it, N, &wrong), Err(Unfit::Entry { at, value }));
        assert_eq!(saved(&mut it), numbers, "nothing was restored");
    }
    let message = Unfit::Entry { at: 3, value: 0.5 }.to_string();
    assert!(message.contains("number 3 is 0.5"), "{message}");
}

/// Whatever is restored, the torque is finite and inside its limits.
#[test]
fn a_guard_keeps_its_promise() {
    let mut it = guard();
    let (x, nan) = (Motion::at_rest(Vector::ZERO), f64::NAN);
    let mut resting = (|_: &Motion<f64, N>| Vector::ZERO, |q: &Vector<f64, N>| *q);
    for torque in [nan, f64::INFINITY, 1e6, -1e6] {
        let mut numbers = saved(&mut guard());
        numbers[..N].fill(torque);
        numbers[N..=2 * N].fill(nan);
        numbers[N] = 1.0;
        (numbers[AWAITED - 1], numbers[AWAITED]) = (1.0, 1000.0);
        restore(&mut it, N, &numbers).expect("fits");
        for _ in 0..5 {
            let decision = Guard::step(&mut it, &Seen::fresh(&x), &mut resting);
            assert!(decision.torque.iter().all(|u| u.abs() <= 30.0));
        }
        let phase = Guard::step(&mut it, &Seen::fresh(&x), &mut resting).status.phase;
        assert_eq!(phase, flexure_core::guard::Phase::Following, "no longer a wait than settings ask");
    }
}
