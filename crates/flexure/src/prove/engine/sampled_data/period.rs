//! A control period of a sampled loop, from an ellipsoid on.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::hold::{held, pace};
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::norm::radius;
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::sensors::Sensors;
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};
use crate::prove::engine::sampled_data::watch::Passes;

/// A loop that acts at instants.
#[derive(Clone, Copy)]
pub struct HeldLoop<'a> {
    /// Its law and its robot.
    pub system: &'a dyn TrackingLoop,
    /// What the law sees.
    pub sensors: &'a Sensors,
    /// Control period in s.
    pub period: Interval,
    /// Torques on their way at an instant, before the law has asked for another.
    pub waiting: usize,
    /// How long into a period the next of them begins to act in s; none if from its beginning.
    pub offset: Option<Interval>,
    /// What its guard and its drives do nothing about.
    pub passes: &'a Passes,
}

impl HeldLoop<'_> {
    /// Numbers of a motion.
    pub fn motion(&self) -> usize {
        4 * self.system.joints()
    }

    /// Where a loop begins at the motion (q_l, q_m, q̇_l, q̇_m): filters as [`Sensors::start`] says, the torques on their way hold the motors against their springs. All of it
    /// is proportional to the motion.
    pub fn started(&self, motion: &[Interval]) -> Vec<Interval> {
        let n = self.system.joints();
        let stiffness = self.system.drive().stiffness;
        let springs: Vec<_> = (0..n).map(|i| stiffness[i] * (motion[n + i] - motion[i])).collect();
        [motion.to_vec(), self.sensors.start(motion, self.period), springs.repeat(self.waiting)].concat()
    }

    /// The torques on their way at `state`, those of all joints for the next to act first [N m].
    pub fn on_their_way(&self, state: &Spread) -> Spread {
        state.part(self.before_torques(), self.waiting * self.system.joints())
    }

    /// Numbers of a motion and of what is remembered of readings: torques on their way follow.
    pub fn before_torques(&self) -> usize {
        self.motion() + self.sensors.remembered(self.system.joints())
    }
}

/// What is at an instant before the law is asked.
#[derive(Clone, Debug)]
pub struct Before {
    /// Motions, what is remembered, torques on their way.
    pub state: Spread,
    /// What the law is given.
    pub seen: Spread,
    /// What is remembered after it.
    pub remembered: Spread,
    /// What is known of y and z so far: nothing of the law's torques.
    pub sizes: Sizes,
}

impl Before {
    /// In `now`. Columns are those of y, of each η_j, of readings before, of those of now.
    pub fn over(of: &HeldLoop<'_>, now: &Section) -> Self {
        let (n, ball, off) = (of.system.joints(), now.center.len(), &of.sensors.off);
        let (first, count) = (ball + n, now.past.columns());
        let deviations = Dense::from_fn(ball, first + count + off.len(), |i, j| {
            if j < ball {
                Interval::point(now.lower[(i, j)])
            } else if (first..first + count).contains(&j) {
                Interval::point(now.past[(i, j - first)])
            } else {
                Interval::ZERO
            }
        });
        let center = now.center.iter().map(|&c| Interval::point(c)).collect();
        let state = Spread { center, deviations };
        let [seen, remembered] = of.sensors.seen(&state, n, first + count);
        let most = [vec![0.0; n], vec![1.0; count], off.clone()].concat();
        Self { state, seen, remembered, sizes: Sizes { ball, slopes: vec![0.0; most.len()], most } }
    }
}

/// What becomes of a section in a control period.
#[derive(Clone, Debug)]
pub struct Passage {
    /// The law at its beginning.
    pub law: Instant,
    /// Motions, what is remembered and torques on their way at its end.
    pub after: Spread,
}

/// Into how many pieces holds are cut.
pub struct Cuts {
    /// So many times as many as are needed at least.
    finer: usize,
    /// What intervals leave open of all numbers together, as a part of their extents, that is not worth more pieces.
    closed: f64,
    /// What was open when finer pieces did not help.
    floor: f64,
}

/// Pieces are halved at most to this part.
const FINEST: usize = 32;

/// With a decay by 1 − λ in a period, so many times (1 − λ)^(3/2) are closed: squares of extents grow by that of what is open, over the share of 1 − λ that it has, and shrink by
/// some 1 − λ.
const CLOSED: f64 = 0.25;

/// What the middle may be off by takes its part of 1 − λ once, but does not make the next ellipsoid wider: so much of it counts.
const MISSED: f64 = 0.1;

/// Halves that leave open more than this part of what there was do not help.
const HELPED: f64 = 0.9;

/// Pieces that did not help are tried again when so many times as much is open.
const AGAIN: f64 = 1.25;

impl Cuts {
    /// As few as are needed, where errors shrink by the factor `shrink` in a period.
    pub fn new(shrink: f64) -> Self {
        let closed = CLOSED * (1.0 - shrink).powf(1.5);
        Self { finer: 1, closed, floor: closed }
    }

    /// The period after `before` under `law`, in pieces that leave little open, as far as pieces can.
    pub fn passage(&mut self, of: &HeldLoop<'_>, before: &Before, law: &Instant) -> Option<Passage> {
        let mut found = passage(of, before, law, self.finer)?;
        let mut open = openness(&found);
        while open > AGAIN * self.floor && self.finer < FINEST {
            let Some(halved) = passage(of, before, law, 2 * self.finer) else { break };
            let left = openness(&halved);
            if left > HELPED * open {
                self.floor = open.max(self.closed);
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
    let ball = passage.law.sizes.ball;
    let length = |row: &[Interval], of: &dyn Fn(Interval) -> f64| {
        row[..ball].iter().map(|&x| of(x).powi(2)).sum::<f64>().sqrt()
    };
    let all = || passage.after.deviations.rows();
    let open = all().map(|row| length(row, &|x| radius(x).hi())).collect();
    (open, all().map(|row| length(row, &Interval::midpoint)).collect())
}

/// What is open of all rows together, and of the middle, as parts of them.
fn openness(passage: &Passage) -> f64 {
    let (open, rows) = open_of(passage);
    let middle = passage.after.center.iter().map(|&x| MISSED * radius(x).hi());
    open.iter().zip(middle).zip(&rows).map(|((open, middle), row)| (open + middle) / row).sum()
}

/// A period after `before` under `law`, in so many times as many pieces as are needed; none if motions are not shown to exist.
pub fn passage(of: &HeldLoop<'_>, before: &Before, law: &Instant, finer: usize) -> Option<Passage> {
    let (n, size, from) = (of.system.joints(), of.motion(), of.before_torques());
    let waiting = |m: usize| before.state.part(from + m * n, n);
    let queue: Vec<Spread> = (0..of.waiting).map(waiting).chain([law.asked.clone()]).collect();
    let holds = |motion: &Spread, torque: &Spread, length: Interval| {
        let pieces = finer * pace(of.system, &motion.center, length);
        held(of.system, motion, torque, &law.sizes, length, pieces)
    };
    let motion = before.state.part(0, size);
    let moved = match of.offset {
        None => holds(&motion, &queue[0], of.period)?,
        Some(offset) => holds(&holds(&motion, &queue[0], offset)?, &queue[1], of.period - offset)?,
    };
    let known = moved.followed_by(&before.remembered);
    let after = queue[1..].iter().fold(known, |all, torque| all.followed_by(torque));
    Some(Passage { law: law.clone(), after })
}
