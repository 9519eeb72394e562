//! What is remembered is all that matters: save, run, restore, run again.

use flexure_core::estimate::Disturbance;
use flexure_core::estimate::{
    DisturbanceObserver, Estimator, FilteredDifference, LowPass, MotorObserver, Observer,
};
use flexure_core::guard::{
    Age, Coasting, Collision, Frozen, Guard, Latch, Plausible, Reaction, Rejoin, Seen, Settings, Torques,
    Watchdog,
};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port, Unfit, length, restore, save};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Tree;
use flexure_core::scalar::Float;

use crate::common::{Numbers, branched, flexible};

const N: usize = 3;
const PERIOD: f64 = 1e-3;

type Robot = Fjr<f64, Tree<f64, N>, N>;

fn robot() -> Robot {
    flexible(branched::<N>(2), &mut Numbers(1))
}

/// One control instant of something that remembers: what it says of `x`, in numbers.
trait Step {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64>;
}

/// Estimators as they are.
struct Estimating<E>(E);

impl<E: Memory<f64>> Memory<f64> for Estimating<E> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        self.0.memory(port);
    }
}

impl<E: Estimator<f64, N>> Step for Estimating<E> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, _: u32) -> Vec<f64> {
        let seen = self.0.update(robot, &x.q_l, &x.q_m, u);
        [seen.q_l, seen.q_m, seen.v_l, seen.v_m].iter().flat_map(|v| v.0).collect()
    }
}

impl Step for DisturbanceObserver<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, _: u32) -> Vec<f64> {
        let found = self.update(robot, x, u);
        [found.link, found.motor].iter().flat_map(|v| v.0).collect()
    }
}

/// A law that takes over with a jump, if it is let.
struct Jumping<'a>(&'a Robot, Vector<f64, N>);

impl Torques<f64, N> for Jumping<'_> {
    fn law(&mut self, _: &Motion<f64, N>) -> Vector<f64, N> {
        self.1
    }
    fn holding(&mut self, q_l: &Vector<f64, N>) -> Vector<f64, N> {
        self.0.links.gravity_torque(q_l)
    }
    fn joining(&mut self, _: &Motion<f64, N>, acting: &Vector<f64, N>) -> Vector<f64, N> {
        acting.scaled(0.9)
    }
}

/// Stops now and then, so that postures and waits matter: readings are stale every 17 instants and for good from 115 on, time jumps at
/// 26, something collides at 59, and velocities are not those of the readings from 36 to 40. Readings move slowly, and not
/// at all from 52 to 74, where nothing else does either, and from 80 to 97, where they freeze; they are off at 28, which cannot
/// be, at 33, which can at the speed of the instant before, and at 112, after some that did not come.
impl Step for Guard<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        let still = match k {
            52..75 => 52,
            80..98 => 80,
            k => k,
        };
        let off = match k {
            28 => 0.01,
            33 => 0.006,
            105..112 => f64::NAN,
            112 => 0.025,
            _ => 0.0,
        };
        let at = Vector([1e-4 * f64::from(still) + off; N]);
        let more = match k {
            27 | 31..34 | 104 => 3.0,
            36..41 => 10.0,
            _ => 0.0,
        };
        let faster = |v: Vector<f64, N>| v.map(|v| v + more);
        let x = &Motion { v_l: faster(x.v_l), v_m: faster(x.v_m), ..*x };
        let pushed = if k == 59 { Vector([60.0; N]) } else { Vector::ZERO };
        let seen = Seen {
            read: [at; 2],
            age: Age { link: u32::from(k % 17 == 9 || k >= 115), motor: 0 },
            stamp: Some(u64::from(k + u32::from(k >= 26))),
            target: Some(Vector([f64::from(k.min(40) + k.saturating_sub(80)); N])),
            residual: Disturbance { link: pushed, motor: Vector::ZERO },
            ..Seen::fresh(x)
        };
        let decision = Guard::step(self, &seen, &mut Jumping(robot, u.scaled(20.0)));
        let mut numbers = decision.torque.0.to_vec();
        let log = self.log();
        let stops = log.entries().map(|entry| {
            let cause = f64::from(entry.cause.code());
            let place = match entry.place {
                flexure_core::guard::Place::Controller => 0,
                flexure_core::guard::Place::Link(joint) => 1 + joint,
                flexure_core::guard::Place::Motor(joint) => 101 + joint,
            };
            vec![entry.time as f64, cause, f64::from(place)]
        });
        let steps = log.steps().map(|step| {
            let x = step.x;
            let motion = [x.q_l, x.q_m, x.v_l, x.v_m, step.torque].into_iter().flat_map(|v| v.0);
            [step.time as f64, f64::from(step.phase.code())].into_iter().chain(motion).collect()
        });
        numbers.extend(stops.chain(steps).flatten());
        let status = decision.status;
        let faults = status.link_fault.iter().chain(status.motor_fault.iter());
        numbers.extend(faults.map(|fault| f64::from(fault.map_or(0, flexure_core::guard::Fault::code))));
        numbers.extend([f64::from(status.phase.code()), f64::from(u8::from(status.latched))]);
        numbers
    }
}

/// Silent for three instants of seven.
impl Step for Coasting<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        let age = if k % 7 > 3 { Age { link: 1, motor: 1 } } else { Age::FRESH };
        let (seen, lost) = self.fill(robot, x, age, [true; 2], u);
        self.saw(&seen);
        let motion = [seen.q_l, seen.q_m, seen.v_l, seen.v_m].into_iter().flat_map(|v| v.0);
        motion.chain([lost.link, lost.motor].map(f64::from)).collect()
    }
}

/// Without a command in three periods of seven.
impl Step for Watchdog<f64, N> {
    fn step(&mut self, _: &Robot, _: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        Watchdog::step(self, (k % 7 < 4).then_some(*u)).0.to_vec()
    }
}

/// Steps from instant `from` on.
fn run(it: &mut impl Step, from: u32, steps: u32) -> Vec<u64> {
    let robot = robot();
    let place = |k: u32| {
        let mut r = Numbers(u64::from(k));
        (r.motion(1.0), r.vector(1.0))
    };
    (from..from + steps)
        .flat_map(|k| {
            let (x, u) = place(k);
            it.step(&robot, &x, &u, k)
        })
        .map(f64::to_bits)
        .collect()
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

/// The names of all pieces, with units.
struct Names {
    within: Vec<&'static str>,
    names: Vec<String>,
}

impl Names {
    fn add(&mut self, name: &'static str, unit: &str) {
        let path = [self.within.join("."), name.to_owned()].into_iter().filter(|part| !part.is_empty());
        let path = path.collect::<Vec<_>>().join(".");
        self.names.push(format!("{path} [{unit}]"));
    }
}

impl Port<f64> for Names {
    fn numbers(&mut self, name: &'static str, unit: &'static str, _: &mut [f64]) {
        self.add(name, unit);
    }
    fn joints(&mut self, name: &'static str, unit: &'static str, _: &mut [f64]) {
        self.add(name, unit);
    }
    fn word(&mut self, name: &'static str, _: &mut u32) {
        self.add(name, "");
    }
    fn flag(&mut self, name: &'static str, _: &mut bool) {
        self.add(name, "");
    }
    fn enter(&mut self, name: &'static str) {
        self.within.push(name);
    }
    fn leave(&mut self) {
        self.within.pop();
    }
}

/// The name of every number.
fn each_name(it: &mut dyn Memory<f64>) -> Vec<String> {
    let each = |name: String| {
        let (name, unit) = name.split_once(" [").expect("a unit");
        // Words and flags have none; numbers that are no joint's are none of theirs.
        vec![name.to_owned(); if unit == "]" { 1 } else { N }]
    };
    names(it).into_iter().flat_map(each).collect()
}

fn names(it: &mut dyn Memory<f64>) -> Vec<String> {
    let mut port = Names { within: Vec::new(), names: Vec::new() };
    it.memory(&mut port);
    port.names
}

/// Two devices side by side, as a loop has them, with integers.
struct Loop {
    observer: Estimating<Observer<f64, N>>,
    watchdog: Watchdog<f64, N>,
    noise: u64,
    on: bool,
    gain: f64,
}

impl Memory<f64> for Loop {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.part("observer", &mut self.observer);
        port.part("watchdog", &mut self.watchdog);
        port.long("noise", &mut self.noise);
        port.flag("on", &mut self.on);
        port.number("gain", "N m/rad", &mut self.gain);
    }
}

#[test]
fn parts_integers_and_their_names() {
    let make = |noise, on| Loop { observer: observer(), watchdog: watchdog(), noise, on, gain: 0.1 };
    let mut whole = make(0xfedc_ba98_7654_3210, true);
    let expected = [
        "observer.q_l [rad]",
        "observer.q_m [rad]",
        "observer.dq_l [rad/s]",
        "observer.dq_m [rad/s]",
        "watchdog.torque [N m]",
        "watchdog.age []",
        "noise.low []",
        "noise.high []",
        "on []",
        "gain [N m/rad]",
    ];
    assert_eq!(names(&mut whole), expected);
    let mut other = make(0, false);
    let numbers = saved(&mut make(0xfedc_ba98_7654_3210, true));
    assert_eq!(numbers.len(), 12 + 3 + 1 + 2 + 1 + 1);
    restore(&mut other, N, &numbers).expect("fits");
    assert_eq!((other.noise, other.on), (0xfedc_ba98_7654_3210, true));
}

#[test]
fn names_of_the_others() {
    let [link, motor] = ["link", "motor"].map(|side| {
        ["position [rad]", "increment [rad]", "velocity [rad/s]", "last_velocity [rad/s]"]
            .map(|name| format!("{side}.{name}"))
    });
    assert_eq!(names(&mut difference()), [link, motor].concat());
    assert_eq!(names(&mut motor_observer())[4], "reading [rad]");
    let of_an_instant = ["q_l [rad]", "q_m [rad]", "p_l [kg m²/s]", "p_m [kg m²/s]"];
    assert_eq!(names(&mut disturbance())[3..7], of_an_instant);
}

/// What a walk looks like that forgets piece number `piece`.
struct Forgetful<M> {
    it: M,
    piece: usize,
}

/// Passes on all pieces but one.
struct Without<'a> {
    port: &'a mut dyn Port<f64>,
    piece: usize,
    at: usize,
}

impl Without<'_> {
    fn next(&mut self) -> Option<&mut dyn Port<f64>> {
        self.at += 1;
        if self.at - 1 == self.piece { None } else { Some(self.port) }
    }
}

impl Port<f64> for Without<'_> {
    fn numbers(&mut self, name: &'static str, unit: &'static str, x: &mut [f64]) {
        self.next().into_iter().for_each(|port| port.numbers(name, unit, x));
    }
    fn joints(&mut self, name: &'static str, unit: &'static str, x: &mut [f64]) {
        self.next().into_iter().for_each(|port| port.joints(name, unit, x));
    }
    fn word(&mut self, name: &'static str, x: &mut u32) {
        self.next().into_iter().for_each(|port| port.word(name, x));
    }
    fn flag(&mut self, name: &'static str, x: &mut bool) {
        self.next().into_iter().for_each(|port| port.flag(name, x));
    }
}

impl<M: Memory<f64>> Memory<f64> for Forgetful<M> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        self.it.memory(&mut Without { port, piece: self.piece, at: 0 });
    }
}

impl<M: Step> Step for Forgetful<M> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        self.it.step(robot, x, u, k)
    }
}

/// No piece can be left out of a walk unnoticed.
#[test]
fn a_piece_left_out_shows() {
    fn shows<M: Step + Memory<f64>>(make: impl Fn() -> M) {
        // Nobody waits for 2³² control periods, the first phases are 0, and of two motions that tell what is frozen either is enough.
        let spared = [".high []", ".phase []", ".other [rad]", ".target [rad]"];
        // Places of a ring are alike; the first is enough.
        let again = |name: &String| name.starts_with("log.stop.") && !name.starts_with("log.stop.0.");
        let matters = |name: &String| !again(name) && !spared.iter().any(|end| name.ends_with(end));
        for (piece, name) in names(&mut make()).iter().enumerate().filter(|(_, name)| matters(name)) {
            let unnoticed = THEN.iter().all(|&then| goes_on(|| Forgetful { it: make(), piece }, then));
            assert!(!unnoticed, "{name}");
        }
    }
    shows(observer);
    shows(motor_observer);
    shows(difference);
    shows(disturbance);
    shows(guard);
    shows(coasting);
    shows(watchdog);
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
