//! Tubes of loops that read counts: whatever readings are off by, runs keep to what was said of them.

use std::path::Path;

use flexure::imperfections::{Bias, Imperfection};
use flexure::scenario::{Scenario, scenario_from_text};
use flexure::simulate::Observed;

use crate::common::Random;
use crate::sampled_tubes::found;

/// Half a count in rad.
const OFF: f64 = 5e-5;

/// The arm as its hardware runs it, from rest at an end of its sine, for half a second, and counts of 0.1 mrad. Its reference does not depend on its start. `changes` are of its text.
pub fn hardware(changes: &[(&str, &str)]) -> Scenario {
    let changes = [
        (
            "[reference.smooth_start]\nduration = 4.0                     # s",
            "phase = [1.5707963267948966, 1.5707963267948966]\n\n[initial]\nq_l = [1.0, 1.0]\nq_m = [1.0, 1.0]\ndq_l = [0.0, 0.0]\ndq_m = [0.0, 0.0]",
        ),
        ("\"reference.smooth_start\" = \"assumed\"\n", ""),
        ("duration = 20.0", "duration = 0.5"),
        ("resolution = 1.5339807878856412e-3", "resolution = 1e-4"),
    ]
    .iter()
    .chain(changes);
    let text = include_str!("../../../../../scenarios/two-link-hardware.toml").to_owned();
    let text = changes.fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    scenario_from_text("scenario.toml", &text, Path::new(".")).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The motions of a run at its control instants, from the first, with the torques that its law asks for.
pub fn run(scenario: &Scenario) -> Vec<(Vec<f64>, Vec<f64>)> {
    let n = scenario.robot.joint_count();
    let mut held = scenario.open().expect("a loop");
    let mut observed = Observed::new(n);
    let mut all = Vec::new();
    for _ in 0..=scenario.periods() {
        held.step().expect("it follows");
        held.observe(&mut observed).expect("of its size");
        all.push((observed.motion[..2 * n].to_vec(), [&observed.command[..], &observed.applied].concat()));
    }
    all
}

/// With counts of all sizes up to those of the file, and readings that are off by as much as counts allow all the time, and positions that start off: nowhere farther from the
/// run on exact readings, or from the reference, than was said, and no larger torques.
#[test]
fn readings_that_are_off_move_no_run_out_of_its_tube() {
    keeps_to_its_tube(&[], OFF, 5e-5);
}

/// Counts of half a millirad, of which the law's third derivatives have to be known.
#[test]
fn nor_do_coarse_readings() {
    keeps_to_its_tube(&[("resolution = 1e-4", "resolution = 5e-4")], 5.0 * OFF, 5e-4);
}

/// The same a millisecond late: the torque that acts until the first command is that of the springs where the run starts.
#[test]
fn nor_do_they_late() {
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 1e-3\n\n[sources]";
    keeps_to_its_tube(&[("[sources]", late)], OFF, 5e-5);
}

/// With half a count of `off` in rad, links in the tube `error` in rad from the run at the start.
fn keeps_to_its_tube(changes: &[(&str, &str)], off: f64, error: f64) {
    let scenario = hardware(changes);
    let tube = found(&scenario, error).unwrap_or_else(|none| panic!("{}", none.at));
    assert!(
        tube.rate > 2.0 && tube.readings.iter().all(|found| (off..1.001 * off).contains(found)),
        "{tube:?}"
    );
    let n = scenario.robot.joint_count();
    let with = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = hardware(changes);
        change(&mut scenario);
        run(&scenario)
    };
    let exact =
        with(&|scenario| scenario.imperfections.retain(|part| !matches!(part, Imperfection::Encoder(_))));
    let mut random = Random(7);
    let (mut largest, mut reached) = (vec![0.0_f64; 2 * n], 0.0_f64);
    for number in 0..24 {
        let sign = |bit: usize| if number >> bit & 1 == 1 { off } else { -off };
        let part = 0.5 * (1.0 + random.next());
        let moved = [0.999 * tube.alone[number % 4], 0.0][number / 4 % 2];
        let runs = with(&|scenario| {
            for part_of in &mut scenario.imperfections {
                let Imperfection::Encoder(encoder) = part_of else { continue };
                if number % 3 == 0 {
                    *part_of = Imperfection::Bias(Bias {
                        link: vec![sign(0), sign(1)],
                        motor: vec![sign(2), sign(3)],
                    });
                } else {
                    encoder
                        .link
                        .iter_mut()
                        .chain(&mut encoder.motor)
                        .flatten()
                        .for_each(|count| *count *= part);
                }
            }
            let start = if number % 4 < n { &mut scenario.initial.q_l } else { &mut scenario.initial.q_m };
            start[number % n] += moved;
        });
        for ((q, u), (exact, _)) in runs.iter().zip(&exact) {
            for i in 0..2 * n {
                largest[i] = largest[i].max((q[i] - exact[i]).abs() / tube.error[i]);
            }
            assert!(
                u.iter().zip(tube.torque.iter().cycle()).all(|(u, most)| u.abs() <= *most),
                "{number}: {u:?} of {:?}",
                tube.torque
            );
        }
        let periods = runs.len() - 1;
        assert_eq!(tube.profile.end.len(), runs.len(), "each instant is a part");
        for (k, (q, _)) in runs.iter().enumerate() {
            let reference = (0.6 * k as f64 * scenario.control_period).cos();
            for (i, q) in q[..n].iter().enumerate() {
                let [lowest, highest] = [&tube.profile.lowest, &tube.profile.highest].map(|ends| ends[i][k]);
                let beside = q - reference;
                assert!(
                    (lowest..=highest).contains(&beside),
                    "{number} {k} {i}: {beside} {lowest} {highest}"
                );
                assert!(highest - lowest < 2.1 * tube.error[i], "{k} {i}: {lowest} {highest}");
            }
            // The run of the file starts where the file says.
            if moved == 0.0 && 4 * k >= 3 * periods {
                for (q, most) in q.iter().zip(&tube.tracking) {
                    reached = reached.max((q - reference).abs() / most);
                }
            }
        }
    }
    println!("of what the tube says runs reach {largest:?}, of how near the reference {reached}");
    assert!(largest.iter().all(|&part| part < 1.0) && reached < 1.0, "{largest:?} {reached}");
    // It says something.
    assert!(largest.iter().all(|&part| part > 0.2) && reached > 0.1, "{largest:?} {reached}");
}

/// A guard that would limit the torque's rate, or doubt a reading, is not said to do nothing.
#[test]
fn guards_that_would_act_are_named() {
    let rejoin = "rejoin_duration = 1.0              # s";
    for (change, what) in [
        ("torque_rate_limit = [20.0, 20.0]", "period's change of the torque of joint"),
        ("speed = 0.1", "and the guard believes up to 0.1 rad/s"),
        ("deflection = 1e-4", "a reading of the deflection of joint"),
        ("jump = 1e-4", "period's change of a reading of joint"),
        ("frozen_travel = 1e-4", "takes it to be frozen"),
        (
            "torque_limit = [0.05, 0.05]",
            "and the limit is 0.05 N m: the run takes 0.284, readings may add 0.00846",
        ),
    ] {
        let limit = "torque_rate_limit = [2000.0, 400.0] # N m/s";
        let from = if change.starts_with("torque_rate") { limit } else { rejoin };
        let none = found(&hardware(&[(from, change)]), 5e-4).unwrap_err();
        assert!(none.at.contains(what), "{change}: {}", none.at);
    }
}
