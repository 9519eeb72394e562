//! Robots, gains, delays and tubes at random: no run decays more slowly than its tube says.

use std::ops::Range;

use flexure::imperfections::{Delay, Imperfection};
use rayon::prelude::*;

use crate::common::Random;
use crate::funnel::random::{drawn, loaded};
use crate::sampled_tubes::{end, found, on_the_surface};

/// How much of what is allowed at the end runs reach at most, of each robot that has a tube.
fn examine(numbers: Range<u64>, runs: usize) -> Vec<f64> {
    let one = |number: u64| {
        let (case, mut r) = (drawn(number), Random(number));
        // At speed within a tenth of a second; what the simulation is off by is to be little beside the narrowest tubes.
        let text = "integration_tolerance = 1e-12\n".to_owned() + &case.text;
        let text =
            text.replace("duration = 2.0", "duration = 0.1").replacen("duration = 0.1", "duration = 0.12", 1);
        let mut scenario = loaded(&case.chain, &text).expect("as it was drawn");
        let delay = [0.0, 0.0003, 0.001, 0.0014][r.below(4)];
        if delay > 0.0 {
            scenario.imperfections.push(Imperfection::Delay(Delay { computation: delay, actuation: 0.0 }));
        }
        let n = scenario.robot.joint_count();
        let tube = found(&scenario, 1e-6 * 100.0_f64.powf(0.5 * (1.0 + r.next()))).ok()?;
        let (first, last) = (tube.sections.first().unwrap(), tube.sections.last().unwrap());
        let left = (-tube.mean_rate * scenario.duration).exp();
        // That two motions come closer is what is said, and that they stay: the middle is off by what ρ allows for.
        let middle = end(&scenario, &first.center[..4 * n]);
        assert!(last.distance(&middle) <= 1.0, "robot {number}: the middle leaves");
        let after = |start: &[f64]| {
            let at = end(&scenario, &start[..4 * n]);
            assert!(last.distance(&at) <= 1.0, "robot {number}: leaves");
            let apart = last.center.iter().zip(at.iter().zip(&middle)).map(|(c, (x, m))| c + (x - m));
            last.distance(&apart.collect::<Vec<_>>())
        };
        let distance = (0..runs).map(|_| after(&on_the_surface(first, n, &mut r))).fold(0.0, f64::max);
        // The simulation's own error beside tubes of a microrad.
        assert!(distance <= left + 1e-3, "robot {number}: {distance} of {left}");
        Some(distance / left)
    };
    let count = numbers.end - numbers.start;
    let mut found: Vec<f64> = numbers.into_par_iter().filter_map(one).collect();
    found.sort_by(f64::total_cmp);
    let (median, most) = (found[found.len() / 2], found[found.len() - 1]);
    println!(
        "{} of {count} robots have a tube; of what it allows runs reach {median:.3} (median) to {most:.3}",
        found.len()
    );
    found
}

#[test]
fn runs_keep_to_their_tubes() {
    let found = examine(0..12, 5);
    assert!(found.len() >= 6, "{found:?}");
    // Tubes that allow everything would say nothing.
    assert!(found.iter().any(|&part| part > 0.1), "{found:?}");
}

/// `cargo test --release -p flexure --test suite sampled_tubes::random:: -- --ignored --nocapture`
#[test]
#[ignore = "an hour of processor time: 2,000 robots"]
fn two_thousand_robots_keep_to_their_tubes() {
    assert!(examine(1000..3000, 5).len() >= 1000);
}
