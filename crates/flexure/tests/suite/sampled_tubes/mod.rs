//! Tubes of sampled loops against simulated ones: what starts in a tube ends where it was said to, and no tube is found where none is.

mod file;
mod python;
mod random;
mod readings;
mod strongest;

use flexure::files::{Change, Reading};
use flexure::imperfections::{Delay, Imperfection};
use flexure::progress::unwatched;
use flexure::prove::engine::sampled_data::section::Section;
use flexure::prove::sampled_data::{NoTube, SampledTube, sampled_tube};
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::simulate::Observed;

use crate::common::Random;

/// The arm with the paper's gains, soon at speed, for a fraction of a second.
const LOOP: [&str; 2] = ["duration = 0.12", "reference.smooth_start.duration = 0.1"];

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<Change> =
        changes.iter().map(|change| Change::parse(change).expect("a change")).collect();
    load_scenario_with(name, Reading::changed(&changes))
        .unwrap_or_else(|problems| panic!("{name}: {problems}"))
}

fn with_delay(delay: f64) -> Scenario {
    let mut scenario = scenario("two-link-tanh-smooth", &LOOP);
    scenario.imperfections = vec![Imperfection::Delay(Delay { computation: delay, actuation: 0.0 })];
    scenario
}

fn found(scenario: &Scenario, error: f64) -> Result<SampledTube, NoTube> {
    let error = vec![error; scenario.robot.joint_count()];
    sampled_tube(scenario, &error, &unwatched).expect("suitable").expect("nobody breaks it off")
}

/// The motion at the end of the run from `start`, the reference that of the file: a smooth start begins where the file says.
fn end(scenario: &Scenario, start: &[f64]) -> Vec<f64> {
    let n = scenario.robot.joint_count();
    let mut held = scenario.open().expect("a loop");
    let (mut state, names) = (held.state(), held.state_names());
    let motion = (0..state.len()).filter(|&i| names[i].name.starts_with("motion."));
    let motion: Vec<_> = motion.filter(|&i| names[i].unit.starts_with("rad")).collect();
    let initial = &scenario.initial;
    let initial = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].into_iter().flatten();
    assert!(motion.iter().map(|&i| &state[i]).eq(initial), "the order of motions");
    motion.iter().zip(start).for_each(|(&i, &x)| state[i] = x);
    held.restore(&state).expect("of its size");
    let mut observed = Observed::new(n);
    // The first step is the first instant.
    while observed.t < scenario.duration - 0.5 * scenario.control_period {
        held.step().expect("it follows");
        held.observe(&mut observed).expect("of its size");
    }
    observed.motion
}

/// A state at |y| = 1, in a random direction of motions, the torques on their way as in the middle.
fn on_the_surface(tube: &Section, n: usize, random: &mut Random) -> Vec<f64> {
    let y: Vec<f64> = (0..4 * n).map(|_| random.next()).collect();
    let mut off: Vec<f64> =
        (0..4 * n).map(|i| (0..=i).map(|k| tube.lower[(i, k)] * y[k]).sum::<f64>()).collect();
    off.resize(tube.center.len(), 0.0);
    let at = |scale: f64| -> Vec<f64> { tube.center.iter().zip(&off).map(|(c, x)| c + scale * x).collect() };
    let distance = tube.distance(&at(1.0));
    at(1.0 / distance)
}

/// 1,020 runs from the surface of three tubes, of two and seven joints, with and without a delay: none ends farther from the run than was said.
#[test]
fn no_run_decays_slower_than_said() {
    let mut random = Random(18);
    let seven = scenario("panda-tanh-smooth", &["duration = 0.02"]);
    for (scenario, error) in
        [(scenario("two-link-tanh-smooth", &LOOP), 1e-4), (with_delay(0.0005), 1e-5), (seven, 1e-6)]
    {
        let tube = found(&scenario, error).unwrap_or_else(|none| panic!("{}", none.at));
        assert!(tube.rate > 5.0, "{}", tube.rate);
        let (first, last) = (tube.sections.first().unwrap(), tube.sections.last().unwrap());
        let n = scenario.robot.joint_count();
        // The middle is the run.
        let missed = last.distance(&end(&scenario, &first.center[..4 * n]));
        assert!(missed < 1e-3, "{missed}");
        let left = (-tube.mean_rate * scenario.duration).exp();
        let mut largest = 0.0_f64;
        for _ in 0..340 {
            let start = on_the_surface(first, n, &mut random);
            let distance = last.distance(&end(&scenario, &start[..4 * n]));
            largest = largest.max(distance);
            assert!(distance <= left + 1e-3, "{distance} of {left}");
        }
        println!("rate {}, {largest} of {left} at the end", tube.mean_rate);
        // It says something: a rate of three times as much is refuted.
        assert!(largest > left.powi(3), "{largest} of {left}");
    }
}

/// The loop with 0.7 ms of delay is unstable, and with torques of 5 N m at most it cannot follow.
#[test]
fn no_tube_is_found_where_there_is_none() {
    let none = found(&with_delay(0.0007), 1e-5).unwrap_err();
    assert!(none.at.contains("small errors do not shrink"), "{}", none.at);
    let mut limited = scenario("two-link-tanh-smooth", &LOOP);
    limited.plant.unlimited = false;
    limited.robot.limits.torque = vec![5.0, 5.0];
    let none = found(&limited, 1e-5).unwrap_err();
    assert!(none.at.contains("N m, and the limit is 5 N m"), "{}", none.at);
    let none = found(&scenario("two-link-tanh-smooth", &LOOP), 0.1).unwrap_err();
    assert!(none.at.contains("a smaller one may have one"), "{}", none.at);
}

/// A run asks its law after its last period, too: what is said of errors and torques is true there, where they are largest.
#[test]
fn the_last_instant_counts() {
    for duration in [0.001_f64, 0.02] {
        // The simulation's own error is below the tube's width then.
        let duration_of = format!("duration = {duration}");
        let scenario = scenario("two-link-linear", &[&duration_of, "integration_tolerance = 1e-12"]);
        let tube = found(&scenario, 1e-6).unwrap_or_else(|none| panic!("{}", none.at));
        let runs = readings::run(&scenario);
        let (q, torques) = runs.last().expect("instants");
        for (q, most) in q.iter().zip(&tube.tracking) {
            let part = (q - duration.sin()).abs() / most;
            assert!((0.99..=1.0).contains(&part), "{duration}: {part} of {most}");
        }
        assert!(torques.iter().zip(tube.torque.iter().cycle()).all(|(u, most)| u.abs() <= *most));
    }
}

/// Of what is beyond it nothing is said, and which that is.
#[test]
fn loops_with_more_are_refused() {
    for (name, changes, what) in [
        ("two-link-everything", &[][..], "imperfections of kind"),
        ("two-link-hardware", &["guard.velocity_gap = 1.0"], "has a guard with velocity_gap"),
        ("two-link-tanh-smooth", &["hold = \"continuous\""], "acts in continuous time"),
        ("two-link-tanh-smooth", &["plant.spring_hardening = [1.0, 1.0]"], "plant.spring_hardening"),
    ] {
        let scenario = scenario(name, changes);
        let problems = sampled_tube(&scenario, &[1e-5, 1e-5], &unwatched).unwrap_err();
        assert!(problems.to_string().contains(what), "{problems}");
    }
}
