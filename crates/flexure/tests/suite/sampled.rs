//! The spectral radius of sampled loops against the period map of the loop that runs, differentiated numerically.

use flexure::Scenario;
use flexure::compare::entrants;
use flexure::laws::{CONTROLLERS, Controller};
use flexure::linalg::{Dense, spectral_radius};
use flexure::sampled::{Place, probe, radii};
use flexure::scenario::{Integration, scenario_from_text};
use flexure::simulate::Observed;

use crate::common::root;

fn read(text: &str) -> Scenario {
    scenario_from_text("test.toml", text, &root().join("scenarios")).unwrap()
}

/// A two-link arm with the starting gains of φ tanh, control periods of `period` in s, drives without limits and what
/// `more` adds.
fn two_link(period: f64, reference: &str, more: &str) -> Scenario {
    let mut scenario = read(&format!(
        "robot = \"planar-2r\"\nduration = 1.2\ncontrol_period = {period}\n{more}\n[plant]\ntorque_limits = false\n\
         [reference]\n{reference}\n\
         [controller]\nkind = \"pd\"\nstiffness = 1.0\ndamping = 1.0"
    ));
    // What is measured are differences of motions.
    scenario.integration = Integration::Collocation { tolerance: 1e-12 };
    scenario.controller =
        entrants(&["vcbc:tanh".to_owned()]).unwrap()[0].controller(&scenario.robot).unwrap();
    scenario
}

/// It stands where it shall, without gravity: in balance from the first instant on.
fn standing(period: f64, more: &str) -> Scenario {
    let mut scenario = two_link(period, "kind = \"sine\"\namplitude = 0.0\nfrequency = 1.0", more);
    scenario.robot.gravity = [0.0; 3];
    scenario
}

/// Parts of the state of a loop that act on what happens next: motion, torques, what devices remember.
fn acts(name: &str) -> bool {
    let inner = ["motion.", "instant.u_m.", "controller."];
    let books = ["rejoined", "disturbance_observer.started", "random"];
    inner.iter().any(|part| name.starts_with(part)) && !books.iter().any(|part| name.contains(part))
}

/// Spectral radius, per control period, of the map of the loop over `cycle` periods after `time`, by differences of fourth order
/// of the states that [`Loop::state`](flexure::simulate::Loop::state) saves.
fn measured(scenario: &Scenario, time: f64, cycle: u32) -> f64 {
    let mut held = scenario.open().unwrap();
    let mut k = 0.0;
    while k * scenario.control_period <= time + 1e-9 {
        held.step().unwrap();
        k += 1.0;
    }
    let (state, names) = (held.state(), held.state_names());
    // What was never read is not a number, and stays it.
    let moving: Vec<_> = (0..state.len()).filter(|&i| acts(&names[i].name) && state[i].is_finite()).collect();
    let mut after = |i: usize, change: f64| -> Vec<f64> {
        let mut moved = state.clone();
        moved[i] += change;
        held.restore(&moved).unwrap();
        for _ in 0..cycle {
            held.step().unwrap();
        }
        let next = held.state();
        moving.iter().map(|&i| next[i]).collect()
    };
    let columns: Vec<Vec<f64>> = moving
        .iter()
        .map(|&i| {
            let unit = names[i].unit;
            if unit.is_empty() {
                return vec![0.0; moving.len()]; // flags and counts
            }
            // The law is stiff, the springs are stiff: torques move by much more than positions.
            let h = if unit.starts_with("N m") { 1e-2 } else { 1e-4 };
            // A boundary layer is thin.
            let h = if scenario.controller.kind() == "sliding-mode" { 1e-3 * h } else { h };
            let [far, near] = [2.0 * h, h].map(|h| (after(i, h), after(i, -h)));
            let slope = |(up, down): &(Vec<f64>, Vec<f64>), j: usize, h: f64| (up[j] - down[j]) / (2.0 * h);
            (0..moving.len()).map(|j| (4.0 * slope(&near, j, h) - slope(&far, j, 2.0 * h)) / 3.0).collect()
        })
        .collect();
    spectral_radius(&Dense::from_columns(&columns)).powf(1.0 / f64::from(cycle))
}

/// 1e-6 is what is promised. Standing loops agree to 1e-13, but for the motor observer (3e-11), feedback linearisation (3e-10) and
/// 20 ms (7e-8), where differences are not exact; the loop that moves leaves its reference between instants (7e-7).
const TOLERANCE: f64 = 1e-6;

/// At the places on the reference from the time `from` in s on.
fn agrees(scenario: &Scenario, cycle: u32, from: f64, places: usize) {
    let found = radii(scenario).unwrap();
    let on_reference = found.iter().filter(|(time, place, _)| *place == Place::Reference && *time >= from);
    for &(time, _, radius) in on_reference.step_by(4).take(places) {
        let expected = measured(scenario, time, cycle);
        assert!(
            (radius - expected).abs() <= TOLERANCE * expected,
            "{} at {time} s: {radius} here, {expected} measured",
            scenario.controller.kind()
        );
    }
}

#[test]
fn the_ideal_sampled_loop() {
    agrees(&standing(0.001, ""), 1, 0.0, 1);
    agrees(&standing(0.02, ""), 1, 0.0, 1);
}

/// Under gravity, on the way, when what the start left has died out. Between two instants the loop leaves the reference, on which
/// it is looked at, by what a held torque costs.
#[test]
fn the_loop_that_moves() {
    let sine =
        "kind = \"sine\"\namplitude = 0.6\nfrequency = [2.0, 3.0]\n[reference.smooth_start]\nduration = 0.5";
    agrees(&two_link(0.001, sine, ""), 1, 0.8, 2);
}

#[test]
fn delays_slow_sensors_and_missed_instants() {
    for (kind, cycle) in [
        ("delay\"\ncomputation = 0.0004", 1),
        ("delay\"\ncomputation = 0.002", 1),
        ("delay\"\ncomputation = 0.0031", 1),
        ("sampling\"\nperiod = 0.006", 6),
        ("sampling\"\nside = \"link\"\nperiod = 0.004", 4),
        ("deadline\"\nevery = 5", 5),
        ("torque-gain\"\nfactor = [0.8, 1.3]", 1),
        ("model-error\"\nmass = 1.2", 1),
    ] {
        agrees(&standing(0.001, &format!("[[imperfection]]\nkind = \"{kind}")), cycle, 0.0, 1);
    }
}

#[test]
fn filters_and_observers() {
    let filter = "[[imperfection]]\nkind = \"velocity-filter\"\norder = 2\ncutoff = 60.0\ndamping = 0.9\n";
    let first = "[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 80.0\n";
    let both = "[estimator]\nkind = \"observer\"\nbandwidth = 150.0\n";
    let motor = "[estimator]\nkind = \"observer\"\nencoders = \"motor\"\nbandwidth = 60.0\n";
    let observer = "[disturbance_observer]\nbandwidth = 20.0\ncompensate = true\n";
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 0.0004\n";
    for more in [filter, first, both, motor, observer, &format!("{both}{observer}{late}")] {
        agrees(&standing(0.001, more), 1, 0.0, 1);
    }
}

/// Every law, from its starting gains.
#[test]
fn every_law() {
    for law in CONTROLLERS {
        let mut scenario = standing(0.002, "");
        scenario.controller = Controller::default_for(law.name, &scenario.robot).unwrap();
        agrees(&scenario, 1, 0.0, 1);
    }
}

/// A loop pushed aside by 0.1 mrad comes back where ρ < 1 and does not where ρ > 1, whatever law and period.
#[test]
fn small_errors_do_what_the_radius_says() {
    const START: f64 = 1e-4; // rad
    let (mut shrunk, mut grew) = (0, 0);
    for law in ["vcbc", "vcbc:tanh", "feedback-linearization", "cascade"] {
        for milliseconds in [1, 3, 5, 10, 15, 60] {
            let mut scenario = standing(f64::from(milliseconds) * 1e-3, "");
            scenario.controller =
                entrants(&[law.to_owned()]).unwrap()[0].controller(&scenario.robot).unwrap();
            let radius = probe(&scenario).unwrap().unwrap().spectral_radius;
            scenario.initial.q_l[1] = START;
            let mut held = scenario.open().unwrap();
            let mut seen = Observed::new(2);
            let mut error = START;
            // Within a thousand periods 0.99 makes 4e-5 of an error, 1.01 makes 2e4 of it.
            for _ in 0..1000 {
                if error > 100.0 * START || held.step().is_err() {
                    break;
                }
                held.observe(&mut seen).unwrap();
                error = seen.motion[..4].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            }
            match radius {
                ..0.99 => assert!(error < 0.1 * START, "{law} at {milliseconds} ms: {radius}, {error}"),
                1.01.. => assert!(error > 100.0 * START, "{law} at {milliseconds} ms: {radius}, {error}"),
                _ => continue,
            }
            (shrunk, grew) = if radius < 1.0 { (shrunk + 1, grew) } else { (shrunk, grew + 1) };
        }
    }
    assert!(shrunk >= 4 && grew >= 4, "{shrunk} and {grew}");
}

/// What is proved of a law in continuous time says nothing of a slow computer: the paper's gains bear 1 ms, not 2 ms.
#[test]
fn a_slow_loop_is_found_out() {
    let at = |period: f64| {
        let mut scenario = Scenario::load("two-link-linear-smooth").unwrap();
        scenario.control_period = period;
        probe(&scenario).unwrap().unwrap()
    };
    assert!(at(1e-3).stable);
    let slow = at(5e-3);
    assert!(!slow.stable && slow.spectral_radius > 1.0 && slow.rate < 0.0);
    assert!(slow.joint.is_some() && slow.gain.is_some());
}

/// Wherever it is looked at along a reference that repeats, phases are not all the same.
#[test]
fn places_fall_on_all_phases() {
    for repeats in [2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 24.0] {
        let found = radii(&two_link(0.01, "kind = \"sine\"\namplitude = 0.0\nfrequency = 1.0", "")).unwrap();
        let phase = |time: f64| (time / 1.2 * repeats).fract();
        let mut phases: Vec<_> = found.iter().map(|(time, ..)| phase(*time)).collect();
        phases.sort_by(f64::total_cmp);
        let widest = phases.windows(2).fold(0.0_f64, |widest, pair| widest.max(pair[1] - pair[0]));
        assert!(widest < 0.2, "{repeats} repetitions: {widest} of a phase unseen");
    }
}

/// What is advised was tried: done one at a time, each makes the loop stable.
#[test]
fn advice_helps() {
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 0.0007\n";
    let filter = "[[imperfection]]\nkind = \"velocity-filter\"\norder = 2\ncutoff = 90.0\ndamping = 0.9\n";
    let slow = "[[imperfection]]\nkind = \"sampling\"\nside = \"link\"\nperiod = 0.02\n";
    let (mut factors, mut periods, mut starts) = (0, 0, 0);
    for law in ["vcbc", "vcbc:tanh", "cascade", "backstepping", "feedback-linearization"] {
        for (milliseconds, more) in [(2, late), (5, ""), (5, filter), (5, slow), (20, "")] {
            let mut scenario = standing(f64::from(milliseconds) * 1e-3, more);
            let start = entrants(&[law.to_owned()]).unwrap()[0].controller(&scenario.robot).unwrap();
            for (gain, factor) in [(0, 1.0), (0, 1e-3), (1, 20.0)] {
                scenario.controller = start.with_gain(gain, factor);
                let Some(found) = probe(&scenario).unwrap().filter(|found| !found.stable) else { continue };
                let Some(advice) = found.advice else { continue };
                let stable = |change: &dyn Fn(&mut Scenario)| {
                    let mut changed = scenario.clone();
                    change(&mut changed);
                    probe(&changed).unwrap().unwrap().stable
                };
                let gain = found.gain.unwrap();
                let place = scenario
                    .controller
                    .gains()
                    .iter()
                    .position(|(key, _)| gain == format!("controller.{key}"))
                    .unwrap();
                if let Some(factor) = advice.factor {
                    factors += 1;
                    let moved = scenario.controller.with_gain(place, factor);
                    assert!(
                        stable(&|scenario| scenario.controller = moved.clone()),
                        "{law}: {gain} times {factor}"
                    );
                }
                if let Some(period) = advice.period {
                    periods += 1;
                    assert!(stable(&|scenario| scenario.control_period = period), "{law}: {period} s");
                }
                if advice.starting_gains < 1.0 {
                    starts += 1;
                    assert!(stable(&|scenario| scenario.controller = start.clone()), "{law}: starting gains");
                }
            }
        }
    }
    assert!(
        factors > 5 && periods > 5 && starts > 5,
        "{factors} factors, {periods} periods, {starts} starts"
    );
}

/// Two loops that start 0.1 µrad apart, along a reference that takes the arm through all postures of its elbow: what becomes of that is what
/// the verdict says, where the largest radius is above 1, too.
#[test]
fn small_errors_do_on_the_way_what_the_verdict_says() {
    const APART: f64 = 1e-7; // rad
    let sine = "kind = \"sine\"\namplitude = [0.5, 1.6]\nfrequency = [2.0, 3.0]\n[reference.smooth_start]\nduration = 0.5";
    let (mut shrunk, mut passed, mut grew) = (0, 0, 0);
    for law in ["vcbc", "cascade", "feedback-linearization", "backstepping"] {
        for milliseconds in [4, 8, 10, 14, 20, 32] {
            let mut scenario = two_link(f64::from(milliseconds) * 1e-3, sine, "");
            scenario.duration = 8.0;
            scenario.controller =
                entrants(&[law.to_owned()]).unwrap()[0].controller(&scenario.robot).unwrap();
            let found = probe(&scenario).unwrap().unwrap();
            let end = |start: f64| {
                let mut scenario = scenario.clone();
                scenario.initial.q_l[1] += start;
                scenario.initial.q_m[1] += start;
                let mut held = scenario.open().unwrap();
                let mut seen = Observed::new(2);
                while seen.t < 7.9 && held.step().is_ok() {
                    held.observe(&mut seen).unwrap();
                }
                (seen.t, seen.motion)
            };
            let [(until, one), (_, other)] = [end(0.0), end(APART)];
            let distance = one[..4].iter().zip(&other).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            let what = format!("{law} at {milliseconds} ms: {}, apart {distance}", found.line());
            if found.stable {
                assert!(until > 7.8 && distance < APART, "{what}");
                passed += i32::from(found.spectral_radius > 1.0);
                shrunk += 1;
            } else {
                assert!(until < 7.8 || distance > 100.0 * APART, "{what}");
                grew += 1;
            }
        }
    }
    assert!(shrunk >= 8 && passed >= 4 && grew >= 8, "{shrunk} shrunk, {passed} of them passed, {grew} grew");
}
