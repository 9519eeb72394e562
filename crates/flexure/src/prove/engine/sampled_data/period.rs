//! A control period of a sampled loop, from an ellipsoid on.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::ellipsoid::Ellipsoid;
use crate::prove::engine::sampled_data::hold::{held, pace};
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::norm::radius;
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// A loop that acts at instants.
#[derive(Clone, Copy)]
pub struct HeldLoop<'a> {
    /// Its law and its robot.
    pub system: &'a dyn TrackingLoop,
    /// Control period in s.
    pub period: Interval,
    /// Torques on their way at an instant, before the law has asked for another.
    pub waiting: usize,
    /// How long into a period the next of them begins to act in s; none if from its beginning.
    pub offset: Option<Interval>,
    /// Largest torques of the drives [N m], from below; none if nothing limits them.
    pub limits: Option<&'a [f64]>,
}

/// What becomes of an ellipsoid in a control period.
#[derive(Clone, Debug)]
pub struct Passage {
    /// The law at its beginning.
    pub law: Instant,
    /// Motions and torques on their way at its end.
    pub after: Spread,
    /// What they are by: y, and how far the law is beside the middle of its slopes.
    pub sizes: Sizes,
}

fn points(all: &[f64]) -> Vec<Interval> {
    all.iter().map(|&x| Interval::point(x)).collect()
}

/// Into how many pieces holds are cut.
pub struct Cuts {
    /// So many times as many as are needed at least.
    finer: usize,
    /// What was open when finer pieces did not help.
    floor: f64,
}

/// Pieces are halved at most to this part.
const FINEST: usize = 32;

/// What intervals leave open of all numbers together, as a part of their extents, that is not worth more pieces.
const CLOSED: f64 = 2e-4;

/// Halves that leave open more than this part of what there was do not help.
const HELPED: f64 = 0.9;

/// Pieces that did not help are tried again when so many times as much is open.
const AGAIN: f64 = 1.25;

impl Default for Cuts {
    /// As few as are needed.
    fn default() -> Self {
        Self { finer: 1, floor: CLOSED }
    }
}

impl Cuts {
    /// The period from `now` under `law`, in pieces that leave little open, as far as pieces can.
    pub fn passage(&mut self, of: &HeldLoop<'_>, now: &Ellipsoid, law: &Instant) -> Option<Passage> {
        let mut found = passage(of, now, law, self.finer)?;
        let mut open = openness(&found);
        while open > AGAIN * self.floor && self.finer < FINEST {
            let Some(halved) = passage(of, now, law, 2 * self.finer) else { break };
            let left = openness(&halved);
            if left > HELPED * open {
                self.floor = open.max(CLOSED);
                break;
            }
            (found, open) = (halved, left);
            self.finer *= 2;
        }
        if open < 0.25 * self.floor {
            self.finer = (self.finer / 2).max(1);
        }
        Some(found)
    }
}

/// Lengths of what the rows of y leave open, and of the rows.
pub fn open_of(passage: &Passage) -> (Vec<f64>, Vec<f64>) {
    let ball = passage.sizes.ball;
    let length = |row: &[Interval], of: &dyn Fn(Interval) -> f64| {
        row[..ball].iter().map(|&x| of(x).powi(2)).sum::<f64>().sqrt()
    };
    let all = || passage.after.deviations.rows();
    let open = all().map(|row| length(row, &|x| radius(x).hi())).collect();
    (open, all().map(|row| length(row, &Interval::midpoint)).collect())
}

/// What is open of all rows together, as parts of them.
fn openness(passage: &Passage) -> f64 {
    let (open, rows) = open_of(passage);
    open.iter().zip(&rows).map(|(open, row)| open / row).sum()
}

/// The law at instant `k` over `now`.
pub fn law_at(of: &HeldLoop<'_>, k: usize, now: &Ellipsoid) -> Instant {
    let size = 4 * of.system.joints();
    let square = Dense::from_fn(size, size, |i, j| now.lower[(i, j)]);
    Instant::over(of.system, of.period * Interval::point(k as f64), &now.center[..size], &square)
}

/// A period from `now` under `law`, in so many times as many pieces as are needed; none if motions are not shown to exist.
pub fn passage(of: &HeldLoop<'_>, now: &Ellipsoid, law: &Instant, finer: usize) -> Option<Passage> {
    let (n, ball) = (of.system.joints(), now.center.len());
    let size = 4 * n;
    let lower = now.lower.map(Interval::point);
    let motion = Spread { center: points(&now.center[..size]), deviations: rows(&lower, 0, size) };
    let sizes = Sizes { ball, others: law.beside.clone() };
    let wide = |all: &Dense<Interval>, own: bool| {
        Dense::from_fn(all.rows().len(), ball + n, |i, j| match j.checked_sub(ball) {
            None => all[(i, j)],
            Some(j) if own && i == j => Interval::ONE,
            Some(_) => Interval::ZERO,
        })
    };
    // L is lower triangular: motions have nothing to do with the last numbers of y.
    let slopes = Dense::from_fn(n, ball, |j, k| if k < size { law.slopes[(j, k)] } else { Interval::ZERO });
    let asked = Spread { center: law.torque.clone(), deviations: wide(&slopes, true) };
    let waiting = |m: usize| Spread {
        center: points(&now.center[size + m * n..size + (m + 1) * n]),
        deviations: wide(&rows(&lower, size + m * n, n), false),
    };
    let queue: Vec<Spread> = (0..of.waiting).map(waiting).chain([asked]).collect();
    let motion = Spread { center: motion.center, deviations: wide(&motion.deviations, false) };
    let holds = |motion: Spread, torque: &Spread, length: Interval| {
        let pieces = finer * pace(of.system, &motion.center, length);
        held(of.system, motion, torque, &sizes, length, pieces)
    };
    let moved = match of.offset {
        None => holds(motion, &queue[0], of.period)?,
        Some(offset) => holds(holds(motion, &queue[0], offset)?, &queue[1], of.period - offset)?,
    };
    let all: Vec<&Spread> = [&moved].into_iter().chain(&queue[1..]).collect();
    let center = all.iter().flat_map(|part| part.center.iter().copied()).collect();
    let each: Vec<&[Interval]> = all.iter().flat_map(|part| part.deviations.rows()).collect();
    let deviations = Dense::from_fn(ball, ball + n, |i, j| each[i][j]);
    Some(Passage { law: law.clone(), after: Spread { center, deviations }, sizes })
}

fn rows(of: &Dense<Interval>, from: usize, count: usize) -> Dense<Interval> {
    Dense::from_fn(count, of.columns(), |i, j| of[(from + i, j)])
}
