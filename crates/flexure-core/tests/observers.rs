//! Observers: exact predictions, exponential convergence at the rate that was asked for, velocities from quantised encoders.

use flexure_core::estimate::{Estimator, FilteredDifference, LowPass, MotorObserver, Observer};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};

mod common;
use common::plant::{Arm, Push, advance, distance, paper_arm, plausible_arm, undamped};
use common::{Numbers, branched};

/// A torque that keeps a robot moving, over one control period.
fn stirring<const N: usize>(size: f64, t: f64) -> Vector<f64, N> {
    Vector::from_fn(|i| size * (1.0 + 0.5 * i as f64) * ((3.0 + i as f64) * t).cos())
}

/// Estimation errors over time: the robot is stirred (or rests, for zero torque), the estimator starts elsewhere.
struct Course<'a, L, const N: usize> {
    robot: &'a Fjr<f64, L, N>,
    truth: Motion<f64, N>,
    period: f64,
    torque: f64,
}

impl<L: Links<f64, N>, const N: usize> Course<'_, L, N> {
    fn errors(
        &self,
        estimator: &mut impl Estimator<f64, N>,
        start: &Motion<f64, N>,
        periods: u32,
        per: f64,
    ) -> Vec<f64> {
        let mut truth = self.truth;
        estimator.start(start);
        (0..periods)
            .map(|k| {
                let u = stirring(self.torque, f64::from(k) * self.period);
                truth = advance(self.robot, &truth, &u, &Push::NONE, self.period, 20);
                let estimate = estimator.update(self.robot, &truth.q_l, &truth.q_m, &u);
                distance(&estimate, &truth, per)
            })
            .collect()
    }
}

fn off<const N: usize>(x: &Motion<f64, N>, by: f64) -> Motion<f64, N> {
    let shift = |v: &Vector<f64, N>, by: f64| v.map(|x| x + by);
    Motion {
        q_l: shift(&x.q_l, by),
        q_m: shift(&x.q_m, -by),
        v_l: shift(&x.v_l, 10.0 * by),
        v_m: shift(&x.v_m, -10.0 * by),
    }
}

#[test]
fn probe() {
    for (name, arm) in
        [("paper", paper_arm()), ("plausible", plausible_arm()), ("undamped", undamped(plausible_arm()))]
    {
        for w in [25.0, 50.0, 100.0, 200.0] {
            let truth = Motion {
                q_l: Vector([0.3, -0.5]),
                q_m: Vector([0.3, -0.5]),
                v_l: Vector([0.0, 0.0]),
                v_m: Vector([0.0, 0.0]),
            };
            for torque in [0.0, 0.5] {
                let course = Course { robot: &arm, truth, period: 1e-3, torque };
                let n = (5.0 / w / 1e-3) as u32;
                let (mut o, mut m) = (
                    Observer::new(&Vector([w; 2]), 1e-3).unwrap(),
                    MotorObserver::new(&Vector([w; 2]), 1e-3).unwrap(),
                );
                for (kind, e) in [
                    ("both", course.errors(&mut o, &off(&truth, 1e-4), 3 * n, w)),
                    ("motor", course.errors(&mut m, &off(&truth, 1e-4), 3 * n, w)),
                ] {
                    let at = |k: u32| e[k as usize - 1];
                    println!(
                        "{name} w {w} u {torque} {kind}: {:.2e} {:.2e} {:.2e}; rates {:.1} {:.1} max {:.2e}",
                        at(n),
                        at(2 * n),
                        at(3 * n),
                        (at(n) / at(2 * n)).ln() / (n as f64 * 1e-3),
                        (at(2 * n) / at(3 * n)).ln() / (n as f64 * 1e-3),
                        e.iter().fold(0.0f64, |m, x| m.max(*x))
                    );
                }
            }
        }
    }
}
