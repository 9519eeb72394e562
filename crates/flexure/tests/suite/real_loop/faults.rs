//! Loops in which things go wrong: torques stay inside the limits, and what the law does when it has the robot again is what it does
//! without faults.
//!
//! Each loop has one of eight surroundings (noise, delay, pushes, saturation, missed deadlines), which the loop without faults has as
//! well, and faults of its sensors: dropouts that hold or give NaN, or readings that lie. `FLEXURE_FAULTS=1000` runs so many combinations
//! of each campaign.

use std::fmt::Write;

use flexure::scenario::Scenario;
use flexure::simulate::Observed;
use rand_distr::{Distribution, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use rayon::prelude::*;

use super::{with, with_these};

/// Control period in s.
const PERIOD: f64 = 0.001;

/// What errors after a stop may be beside three times those without faults, in rad.
const ALLOWANCE: f64 = 0.01;

/// How many surroundings there are.
const SURROUNDINGS: u64 = 8;

/// Random numbers, one after the other.
struct Chance(Xoshiro256PlusPlus);

impl Chance {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        Uniform::new(low, high).unwrap().sample(&mut self.0)
    }

    fn below(&mut self, count: usize) -> usize {
        Uniform::new(0, count).unwrap().sample(&mut self.0)
    }

    fn happens(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }
}

/// Control instants [from, until), in s, at which something is wrong, and whether a reading is missing that nobody may bridge.
struct Outage {
    window: [f64; 2],
    is_dead: bool,
}

/// A robot, its law, and what may happen to it.
struct Campaign {
    /// All faults are over by then, in s.
    clear: f64,
    /// Largest torques that may leave the controller [N m].
    limit: [f64; 2],
    /// Bridged silence [control periods].
    max_age: usize,
    surroundings: fn(&mut Chance) -> String,
    /// Faults of sensors that do not say so.
    lies: bool,
    /// How many combinations, unless asked for others.
    count: u64,
    /// How many of a hundred may stay stopped: a guard rather stays than takes over from what it cannot believe.
    stay: u64,
    /// A loop with these imperfections, this guard and this seed.
    scenario: fn(&str) -> Scenario,
}

impl Campaign {
    fn surroundings(&self, index: u64) -> String {
        (self.surroundings)(&mut Chance::new(1000 + index))
    }

    /// What goes wrong under `seed`, and when.
    fn faults(&self, seed: u64) -> (String, Vec<Outage>) {
        let mut chance = Chance::new(seed);
        let mut text = String::new();
        let mut outages = Vec::new();
        for _ in 0..chance.below(3) {
            let from = PERIOD * chance.between(10.0, 800.0 * self.clear).round();
            let length = if chance.happens(0.5) { 200.0 } else { 20.0 };
            let until = (from + PERIOD * chance.between(1.0, length).round()).min(self.clear);
            let side = ["link", "motor", "both"][chance.below(3)];
            let kind = if self.lies { ["dropout", "freeze", "jump"][chance.below(3)] } else { "dropout" };
            writeln!(text, "[[imperfection]]\nkind = \"{kind}\"\nside = \"{side}\"").unwrap();
            writeln!(text, "from = {from:.3}\nuntil = {until:.3}").unwrap();
            match kind {
                "dropout" => writeln!(text, "mode = \"{}\"", ["nan", "hold"][chance.below(2)]).unwrap(),
                "jump" => {
                    let size = chance.between(0.05, 7.0) * [1.0, -1.0][chance.below(2)];
                    writeln!(text, "size = {size}").unwrap();
                }
                _ => {}
            }
            outages.push(Outage { window: [from, until], is_dead: kind == "dropout" });
        }
        (text, outages)
    }

    /// The loop without faults: its largest error in rad and torque [N m].
    fn peaks(&self, index: u64) -> [f64; 2] {
        let scenario = (self.scenario)(&self.surroundings(index));
        let mut peaks = [0.0_f64; 2];
        course(&scenario, |observed| {
            assert!(!observed.stopped, "surroundings {index} stop the robot at {} s", observed.t);
            peaks = [peaks[0].max(error(observed)), peaks[1].max(torque(observed))];
        });
        peaks
    }

    /// Torque that leaves the controller is finite and inside the limits; a dead sensor stops the robot at the first control instant
    /// at which nobody may bridge it; whenever the law has the robot again, errors are at most three times those without faults and 10
    /// mrad, and torques at most three times; whether the law has it when all is over. Where sensors lie, the first holds.
    fn survives(&self, seed: u64, peaks: &[[f64; 2]]) -> bool {
        let (faults, outages) = self.faults(seed);
        let index = seed % SURROUNDINGS;
        let [worst_error, worst_torque] = peaks[usize::try_from(index).unwrap()];
        let faults = format!("{}{faults}", self.surroundings(index));
        let scenario = (self.scenario)(&faults);
        let context = |t: f64| format!("at {t} s, seed {seed}: {faults}");
        let (mut stops, mut stopped, mut end, mut last) = (0, false, 0.0, 0.0);
        course(&scenario, |observed| {
            let t = observed.t;
            for (u, limit) in observed.command.iter().zip(self.limit) {
                assert!(u.is_finite() && u.abs() <= limit, "{u} N m {}", context(t));
            }
            for Outage { window: [from, until], .. } in outages.iter().filter(|outage| outage.is_dead) {
                let bridged = PERIOD * self.max_age as f64;
                let dead = from + bridged - 1e-9 <= t && t < until - 1e-9;
                assert!(!dead || observed.stopped, "not stopped {}", context(t));
            }
            if !self.lies
                && stops > 0
                && !observed.stopped
                && !outages.iter().any(|outage| outage.contains(t))
            {
                let (error, torque) = (error(observed), torque(observed));
                assert!(
                    error <= 3.0 * worst_error + ALLOWANCE,
                    "{error} rad, not {worst_error}, {}",
                    context(t)
                );
                assert!(torque <= 3.0 * worst_torque, "{torque} N m, not {worst_torque}, {}", context(t));
            }
            stops += u32::from(observed.stopped && !stopped);
            (stopped, end, last) = (observed.stopped, t, error(observed));
        });
        assert!(end > self.clear + 0.9, "no end {}", context(end));
        if self.lies || stopped {
            return !stopped;
        }
        assert!(last < 0.01, "{last} rad at the end {}", context(end));
        let silent = |outage: &Outage| outage.is_dead && outage.lasts(self.max_age);
        assert!(stops > 0 || !outages.iter().any(silent), "no stop {}", context(end));
        assert!(stops == 0 || !outages.is_empty(), "stopped by nothing {}", context(end));
        true
    }

    fn run(&self) {
        let asked = std::env::var("FLEXURE_FAULTS").ok().map(|count| count.parse().expect("a number"));
        let peaks: Vec<_> = (0..SURROUNDINGS).into_par_iter().map(|index| self.peaks(index)).collect();
        let count = asked.unwrap_or(self.count);
        let resumed = (0..count).into_par_iter().filter(|seed| self.survives(*seed, &peaks)).count() as u64;
        println!("{resumed} of {count} went on");
        assert!(self.lies || 100 * (count - resumed) <= self.stay * count, "{resumed} of {count} went on");
    }
}

impl Outage {
    /// Whether it goes on at `t` in s, or a fault that it was is not found yet.
    fn contains(&self, t: f64) -> bool {
        self.window[0] - 1e-9 <= t && t < self.window[1] - 1e-9
    }

    /// Whether it lasts longer than so many control periods.
    fn lasts(&self, periods: usize) -> bool {
        self.window[1] - self.window[0] > PERIOD * (periods as f64 + 0.5)
    }
}

/// Every instant of a loop.
fn course(scenario: &Scenario, mut see: impl FnMut(&Observed)) {
    let mut held = scenario.open().expect("a robot of two joints");
    let mut observed = Observed::new(2);
    while observed.t < scenario.duration - 0.5 * PERIOD {
        held.step().expect("no divergence");
        held.observe(&mut observed).expect("of two joints");
        see(&observed);
    }
}

/// Largest distance of the links from the reference that the law follows in rad.
fn error(observed: &Observed) -> f64 {
    let links = observed.motion.iter().zip(&observed.followed);
    links.fold(0.0, |worst, (q_l, q_ld)| worst.max((q_l - q_ld).abs()))
}

/// Largest torque that leaves the controller [N m].
fn torque(observed: &Observed) -> f64 {
    observed.command.iter().fold(0.0, |worst, u| worst.max(u.abs()))
}

/// Delay, saturation, a push, missed deadlines and noise by chance.
fn gentle(chance: &mut Chance) -> String {
    let mut text = String::new();
    if chance.happens(0.5) {
        writeln!(text, "[[imperfection]]\nkind = \"delay\"\nactuation = {}", chance.between(0.0, 0.003))
            .unwrap();
    }
    if chance.happens(0.5) {
        let part = chance.between(0.8, 1.0);
        writeln!(text, "[[imperfection]]\nkind = \"saturation\"\nlimit = [{}, {}]", 8.39 * part, 1.67 * part)
            .unwrap();
    }
    if chance.happens(0.5) {
        let (a, b) = (chance.between(-2.0, 2.0), chance.between(-0.5, 0.5));
        push(&mut text, chance, [a, b]);
    }
    if chance.happens(0.3) {
        writeln!(text, "[[imperfection]]\nkind = \"deadline\"\nprobability = {}", chance.between(0.0, 0.2))
            .unwrap();
    }
    if chance.happens(0.3) {
        noise(&mut text, chance.between(0.0, 2e-4));
    }
    text
}

/// What the paper's gains bear at 1 kHz: by chance a delay, a push and noise.
fn fast(chance: &mut Chance) -> String {
    let mut text = String::new();
    if chance.happens(0.5) {
        writeln!(text, "[[imperfection]]\nkind = \"delay\"\nactuation = {}", chance.between(0.0, 0.0002))
            .unwrap();
    }
    if chance.happens(0.5) {
        let (a, b) = (chance.between(-0.2, 0.2), chance.between(-0.1, 0.1));
        push(&mut text, chance, [a, b]);
    }
    if chance.happens(0.5) {
        noise(&mut text, chance.between(0.0, 1e-5));
    }
    text
}

fn push(text: &mut String, chance: &mut Chance, [a, b]: [f64; 2]) {
    let (from, duration) = (chance.between(0.0, 0.8), chance.between(0.01, 0.2));
    writeln!(
        text,
        "[[imperfection]]\nkind = \"push\"\ntorque = [{a}, {b}]\nfrom = {from}\nduration = {duration}"
    )
    .unwrap();
}

fn noise(text: &mut String, deviation: f64) {
    writeln!(text, "[[imperfection]]\nkind = \"noise\"\nlink = {deviation}\nmotor = {deviation}").unwrap();
}

/// The plausible arm at 1 kHz with a small, slow reference that starts at rest. What it moves with when the law takes over, by a push
/// that nobody held against, goes on for `rejoin_settle`: 0.18 s of that are too far, 0.1 s ask for too much torque.
fn plausible(imperfections: &str) -> Scenario {
    const GUARD: &str = r#"
[guard]
torque_limit = [6.7, 1.33]
torque_rate_limit = [2000.0, 400.0]
stop_damping = [1.0, 0.2]
rejoin_after = 10
rejoin_duration = 0.5
rejoin_settle = 0.15
[[imperfection]]
kind = "velocity-filter"
order = 2
cutoff = 40.0
damping = 0.9
"#;
    let parts = with("two-link-tanh-smooth", 1.0, &format!("{imperfections}{GUARD}"));
    let mut scenario = super::ideal(2.5);
    scenario.control_period = PERIOD;
    scenario.reference = flexure::references::Reference::Sines(flexure::references::Sines {
        offset: vec![0.0; 2],
        terms: vec![flexure::references::Term {
            amplitude: vec![0.4; 2],
            frequency: vec![0.6; 2],
            phase: vec![0.0; 2],
        }],
    });
    scenario.guard = parts.guard;
    with_these(scenario, parts.imperfections)
}

/// The paper's arm and gains at 1 kHz, on sin t within a second: joints at up to 1.3 rad/s.
fn paper(imperfections: &str) -> Scenario {
    const GUARD: &str = r"
[guard]
torque_limit = [300.0, 300.0]
torque_rate_limit = [30000.0, 30000.0]
stop_damping = [4.0, 4.0]
max_age = 5
rejoin_duration = 1.0
speed = 6.0
deflection = 2.0
frozen_after = 3
frozen_travel = 0.003
";
    let mut scenario = with("two-link-tanh-smooth", 3.5, &format!("{imperfections}{GUARD}"));
    scenario.smooth_start = Some(flexure::references::SmoothStart { duration: 1.0, settle: 0.25 });
    scenario
}

#[test]
fn a_thousand_combinations_of_faults() {
    let campaign = Campaign {
        clear: 1.0,
        limit: [6.7, 1.33],
        max_age: 0,
        surroundings: gentle,
        lies: false,
        count: 1000,
        stay: 0,
        scenario: plausible,
    };
    campaign.run();
}

const PAPER: Campaign = Campaign {
    clear: 1.5,
    limit: [300.0; 2],
    max_age: 5,
    surroundings: fast,
    lies: false,
    count: 60,
    stay: 4,
    scenario: paper,
};

#[test]
fn combinations_of_faults_with_the_gains_of_the_paper() {
    PAPER.run();
}

/// Readings that freeze and jump: torques stay inside the limits, and nothing diverges. A robot that went farther unseen than can be
/// believed stays stopped.
#[test]
fn combinations_of_lies_with_the_gains_of_the_paper() {
    Campaign { lies: true, ..PAPER }.run();
}
