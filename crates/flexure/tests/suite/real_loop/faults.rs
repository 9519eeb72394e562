//! A thousand loops in which things go wrong.

use std::fmt::Write;

use flexure::scenario::Scenario;
use flexure::simulate::run;
use rand_distr::{Distribution, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use rayon::prelude::*;

use super::{with, with_these};

/// All faults are over by then, in s.
const CLEAR: f64 = 1.0;

/// Control period in s.
const PERIOD: f64 = 0.001;

/// What goes wrong in a loop.
struct Fault {
    text: String,
    /// Dropouts as [from, until) in s.
    outages: Vec<[f64; 2]>,
}

/// Random numbers, one after the other.
struct Chance(Xoshiro256PlusPlus);

impl Chance {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        Uniform::new(low, high).unwrap().sample(&mut self.0)
    }

    fn below(&mut self, count: usize) -> usize {
        Uniform::new(0, count).unwrap().sample(&mut self.0)
    }
}

/// A random number of dropouts (holding or NaN, of links, motors or both), and by chance delay, saturation, push, missed
/// deadlines and noise.
fn fault(seed: u64) -> Fault {
    let mut chance = Chance(Xoshiro256PlusPlus::seed_from_u64(seed));
    let mut text = String::new();
    let mut outages = Vec::new();
    for _ in 0..chance.below(3) {
        let from = PERIOD * chance.between(10.0, 800.0).round();
        let until = (from + PERIOD * chance.between(1.0, 200.0).round()).min(CLEAR);
        let mode = ["nan", "hold"][chance.below(2)];
        let side = ["link", "motor", "both"][chance.below(3)];
        let window = format!("from = {from:.3}\nuntil = {until:.3}");
        writeln!(
            text,
            "[[imperfection]]\nkind = \"dropout\"\nmode = \"{mode}\"\nside = \"{side}\"\n{window}"
        )
        .unwrap();
        outages.push([from, until]);
    }
    if chance.between(0.0, 1.0) < 0.5 {
        writeln!(text, "[[imperfection]]\nkind = \"delay\"\nactuation = {}", chance.between(0.0, 0.003))
            .unwrap();
    }
    if chance.between(0.0, 1.0) < 0.5 {
        let part = chance.between(0.8, 1.0);
        writeln!(text, "[[imperfection]]\nkind = \"saturation\"\nlimit = [{}, {}]", 8.39 * part, 1.67 * part)
            .unwrap();
    }
    if chance.between(0.0, 1.0) < 0.5 {
        let (a, b) = (chance.between(-2.0, 2.0), chance.between(-0.5, 0.5));
        let (from, duration) = (chance.between(0.0, 0.8), chance.between(0.01, 0.2));
        writeln!(
            text,
            "[[imperfection]]\nkind = \"push\"\ntorque = [{a}, {b}]\nfrom = {from}\nduration = {duration}"
        )
        .unwrap();
    }
    if chance.between(0.0, 1.0) < 0.3 {
        writeln!(text, "[[imperfection]]\nkind = \"deadline\"\nprobability = {}", chance.between(0.0, 0.2))
            .unwrap();
    }
    if chance.between(0.0, 1.0) < 0.3 {
        let noise = chance.between(0.0, 2e-4);
        writeln!(text, "[[imperfection]]\nkind = \"noise\"\nlink = {noise}\nmotor = {noise}").unwrap();
    }
    Fault { text, outages }
}

const GUARD: &str = r#"
[guard]
torque_limit = [6.7, 1.33]
torque_rate_limit = [2000.0, 400.0]
stop_damping = [1.0, 0.2]
rejoin_after = 10
rejoin_duration = 0.5
[[imperfection]]
kind = "velocity-filter"
order = 2
cutoff = 40.0
damping = 0.9
"#;

/// The plausible arm at 1 kHz with a small, slow reference that starts at rest.
fn loop_with(fault: &Fault, seed: u64) -> Scenario {
    let parts = with("two-link-tanh-smooth", 1.0, &format!("{}{GUARD}", fault.text));
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
    (scenario.guard, scenario.seed) = (parts.guard, seed);
    with_these(scenario, parts.imperfections)
}

/// Torque that leaves the controller is finite and inside the limits; a dead sensor stops the robot at the first control instant
/// without a reading, which is within 1 ms; and when all is over the law has the robot again and the error is small.
fn survives(seed: u64) {
    let fault = fault(seed);
    let run = run(&loop_with(&fault, seed), &flexure::progress::unwatched).expect("a robot of two joints");
    let context = || format!("seed {seed}: {}", fault.text);
    assert!(run.divergence.is_none(), "diverged: {}", context());
    let column = |name: &str| run.trace.column(name).unwrap();
    let (t, stopped) = (column("t"), column("stopped"));
    for (name, limit) in [("u_command1", 6.7), ("u_command2", 1.33)] {
        let worst = column(name).iter().find(|u| !u.is_finite() || u.abs() > limit);
        assert!(worst.is_none(), "{name} is {worst:?}: {}", context());
    }
    for [from, until] in &fault.outages {
        for k in 0..t.len() {
            // Within 1 ms of the first instant without a reading: at it.
            let dead = *from - 1e-9 <= t[k] && t[k] < *until - 1e-9;
            assert!(!dead || stopped[k] == 1.0, "not stopped at {} s: {}", t[k], context());
        }
    }
    let last = t.len() - 1;
    assert!(t[last] > CLEAR + 1.0 && stopped[last] == 0.0, "still stopped: {}", context());
    assert!(
        run.summary.final_abs_e_l < 0.01,
        "error {} at the end: {}",
        run.summary.final_abs_e_l,
        context()
    );
    let stops = usize::try_from(run.summary.stops).unwrap();
    assert_ne!(stops > 0, fault.outages.is_empty(), "{stops} stops: {}", context());
}

#[test]
fn a_thousand_combinations_of_faults() {
    (0..1000).into_par_iter().for_each(survives);
}
