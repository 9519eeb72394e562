//! What is saved has a name, a unit and an order.

use flexure_core::estimate::Observer;
use flexure_core::guard::Watchdog;
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port, restore};
use flexure_core::model::Motion;

use super::step::{Estimating, Step};
use super::{
    N, Robot, THEN, coasting, difference, disturbance, goes_on, guard, motor_observer, observer, saved,
    watchdog,
};

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
pub fn each_name(it: &mut dyn Memory<f64>) -> Vec<String> {
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
