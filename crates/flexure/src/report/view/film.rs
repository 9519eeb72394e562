//! The instants of a run that its animation shows.

use std::ops::ControlFlow;

use crate::robot::Robot;
use crate::simulate::{Signal, Sink, of_joints};

/// There are at least half as many frames, if the run has them, and never more.
const MOST: usize = 4096;

/// Signals of each joint that are kept, by their names in traces.
const KEPT: [&str; 5] = ["q_l", "q_m", "q_ld", "e_l", "u_m"];

/// Instants of a run at equal distances, the first and the last among them, in memory that does not grow with its duration. As a [`Sink`] of
/// the run it takes every instant up to 4096, then every second, every fourth…
///
/// ```
/// use flexure::report::Film;
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let mut film = Film::new(&scenario.robot, &scenario.signals()?);
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
    /// The last instant, unless it is the last row.
    last: Option<Vec<f64>>,
    /// Instants from one row to the next.
    every: usize,
    seen: usize,
}

impl Film {
    /// Of nothing yet, for runs of `robot` that have these signals.
    pub fn new(robot: &Robot, signals: &[Signal]) -> Self {
        let time = signals.iter().position(|signal| signal.name == "t");
        let kept = KEPT.iter().flat_map(|prefix| of_joints(signals, prefix));
        let columns = time.into_iter().chain(kept).collect();
        Self { joints: robot.joint_count(), columns, rows: Vec::new(), last: None, every: 1, seen: 0 }
    }

    /// How many instants it has.
    pub fn frames(&self) -> usize {
        self.rows().count()
    }

    fn rows(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.rows.iter().chain(&self.last)
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
        let kept: Vec<f64> = self.columns.iter().map(|&column| row[column]).collect();
        self.last = if self.seen.is_multiple_of(self.every) {
            if self.rows.len() == MOST {
                let mut place = 0;
                self.rows.retain(|_| {
                    place += 1;
                    place % 2 == 1
                });
                self.every *= 2;
            }
            self.rows.push(kept);
            None
        } else {
            Some(kept)
        };
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
        let mut film = Film::new(&scenario.robot, &signals);
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
