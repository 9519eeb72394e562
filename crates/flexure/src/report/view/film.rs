//! The instants of a run that its animation shows.

use std::ops::ControlFlow;

use crate::scenario::Scenario;
use crate::simulate::{Signal, Sink, acting_limits, of_joints};

/// There are at least half as many frames, if the run has them, and never more.
const MOST: usize = 4096;

/// Signals of each joint that are kept, by their names in traces; torques last.
const KEPT: [&str; 5] = ["q_l", "q_m", "q_ld", "e_l", "u_m"];

/// The part of a torque limit from which a torque counts as at it: limits act on numbers that are rounded.
const AT_LIMIT: f64 = 0.9999;

/// Instants of a run at equal distances, the first and the last among them, in memory that does not grow with its duration. As a [`Sink`] of
/// the run it takes every instant up to 4096, then every second, every fourth…
///
/// ```
/// use flexure::report::Film;
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let mut film = Film::new(&scenario, &scenario.signals()?);
/// let run = flexure::simulate::run_into(&scenario, &mut [&mut film], &flexure::progress::unwatched)?;
/// assert!((2049..=4097).contains(&film.frames()));
/// # Ok::<(), flexure::Problems>(())
/// ```
#[derive(Clone, Debug)]
pub struct Film {
    joints: usize,
    /// Columns of the time, then of the signals of [`KEPT`], joint by joint each.
    columns: Vec<usize>,
    /// Numbers of the columns at each kept instant.
    rows: Vec<Vec<f64>>,
    /// Those of the last instant.
    last: Vec<f64>,
    /// Instants from one row to the next.
    every: usize,
    seen: usize,
    /// Torque limit of each joint, infinite without one [N m], and when it was first reached, at whatever instant \[s\].
    limits: Vec<(f64, Option<f64>)>,
}

impl Film {
    /// Of nothing yet, for runs of `scenario`, which have these signals.
    pub fn new(scenario: &Scenario, signals: &[Signal]) -> Self {
        let time = signals.iter().position(|signal| signal.name == "t");
        let kept = KEPT.iter().flat_map(|prefix| of_joints(signals, prefix));
        Self {
            joints: scenario.robot.joint_count(),
            columns: time.into_iter().chain(kept).collect(),
            rows: Vec::new(),
            last: Vec::new(),
            every: 1,
            seen: 0,
            limits: acting_limits(scenario).into_iter().map(|limit| (limit, None)).collect(),
        }
    }

    /// How many instants it has.
    pub fn frames(&self) -> usize {
        self.rows().count()
    }

    /// When it ends \[s\].
    pub(super) fn end(&self) -> f64 {
        self.last.first().copied().unwrap_or(0.0)
    }

    /// The joints whose torque reached its limit, and when it did first \[s\].
    pub(super) fn at_limit(&self) -> impl Iterator<Item = (usize, f64)> {
        self.limits.iter().enumerate().filter_map(|(joint, (_, first))| Some((joint, (*first)?)))
    }

    fn rows(&self) -> impl Iterator<Item = &Vec<f64>> {
        let is_kept = self.seen == 0 || (self.seen - 1).is_multiple_of(self.every);
        self.rows.iter().chain(Some(&self.last).filter(|_| !is_kept))
    }

    /// The time of each frame \[s\].
    pub(super) fn times(&self) -> Vec<f64> {
        self.rows().map(|row| row[0]).collect()
    }

    /// The signal called `prefix`, one of [`KEPT`], joint by joint.
    pub(super) fn signal(&self, prefix: &str) -> Vec<Vec<f64>> {
        let Some(place) = KEPT.iter().position(|kept| *kept == prefix) else { return Vec::new() };
        let of_joint = |joint: usize| {
            let column = 1 + place * self.joints + joint;
            self.rows().map(|row| row.get(column).copied().unwrap_or(f64::NAN)).collect()
        };
        (0..self.joints).map(of_joint).collect()
    }
}

impl Sink for Film {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        self.last.clear();
        self.last.extend(self.columns.iter().map(|&column| row[column]));
        let (t, torques) = (self.last.first(), self.last.iter().rev().take(self.joints).rev());
        for ((limit, first), torque) in self.limits.iter_mut().zip(torques) {
            if first.is_none() && torque.abs() >= AT_LIMIT * *limit {
                *first = t.copied();
            }
        }
        if self.seen.is_multiple_of(self.every) {
            if self.rows.len() == MOST {
                let mut place = 0;
                self.rows.retain(|_| {
                    place += 1;
                    place % 2 == 1
                });
                self.every *= 2;
            }
            self.rows.push(self.last.clone());
        }
        self.seen += 1;
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Film, MOST};
    use crate::scenario::load_scenario;
    use crate::simulate::Sink;

    /// The times of the film of a run of so many instants, a second each.
    fn times(instants: usize) -> Vec<f64> {
        let scenario = load_scenario("pendulum-tanh").unwrap();
        let signals = scenario.signals().unwrap();
        let mut film = Film::new(&scenario, &signals);
        let mut row = vec![0.0; signals.len()];
        for k in 0..instants {
            row[0] = k as f64;
            assert!(film.take(&row).is_continue());
        }
        film.times()
    }

    #[test]
    fn frames_are_equally_far_apart_and_have_both_ends() {
        for instants in [1, 2, MOST, MOST + 1, MOST + 2, 2 * MOST, 2 * MOST + 1, 10_001, 100_000] {
            let times = times(instants);
            assert_eq!((times[0], times[times.len() - 1]), (0.0, (instants - 1) as f64), "{instants}");
            assert!(
                times.len() <= MOST + 1 && times.len() >= instants.min(MOST / 2),
                "{instants}: {}",
                times.len()
            );
            let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            if let [equal @ .., last] = steps.as_slice() {
                assert!(equal.iter().all(|step| (step - equal[0]).abs() < 0.5 && step >= last), "{instants}");
            }
        }
    }
}
