//! From one section of a tube to the next.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse};
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
use crate::prove::engine::sampled_data::period::{Passage, open_of};
use crate::prove::engine::sampled_data::section::{Section, inverse_of};

/// What is said of a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// λ.
    pub growth: f64,
    /// ρ, by which the middle is missed.
    pub offset: f64,
    /// σ, by which readings that are off move the loop.
    pub noise: f64,
}

/// Of 1 − λ, the parts for what is left open of the law and of the robot, and for readings before that are no longer kept.
#[derive(Clone, Copy)]
struct Shares {
    law: f64,
    robot: f64,
    readings: f64,
}

/// Where readings are exact, and where they are off.
const EXACT: Shares = Shares { law: 0.25, robot: 0.5, readings: 0.0 };
const OFF: Shares = Shares { law: 0.25, robot: 0.3, readings: 0.05 };

/// How the sections of a tube follow each other.
pub struct Recursion {
    /// Torques beside the law's that hold the tube open anyway [N m].
    torques: Vec<f64>,
    /// The factor that errors are asked to shrink by in a period.
    shrink: f64,
    shares: Shares,
    /// A tube that gets wider than was asked for is held so many times tighter than its shares say: narrower, and what is left open takes more of 1 − λ.
    grip: f64,
}

/// A tube is held tighter where its links reach so many times as far as was asked for.
const WIDE: f64 = 1.5;

/// By what a grip changes from one period to the next, what it is at most, and how much looser it is taken where it was too tight.
const FIRMER: f64 = 1.1;
const TIGHTEST: f64 = 12.0;
const LOOSER: f64 = 1.05;

/// Of 1 − λ, what a firm grip leaves over, for checkers whose bounds are wider, and what it leaves of the rate.
const OVER: f64 = 0.1;
const RATE: f64 = 0.5;

impl Recursion {
    /// Of a tube that is held open by `torques` anyway; `exact` where readings are.
    pub fn new(torques: Vec<f64>, shrink: f64, exact: bool) -> Self {
        Self { torques, shrink, shares: if exact { EXACT } else { OFF }, grip: 1.0 }
    }

    /// How large each |η_j| may be without making the tube wider [N m].
    pub fn enough(&self) -> Vec<f64> {
        let count = (self.torques.len() as f64).sqrt();
        self.torques.iter().map(|w| w * self.shares.law * (1.0 - self.shrink) / count).collect()
    }

    /// The section after `passage`, from one whose links reach `wide` times as far as was asked for, and what is said of the period; no section where there is no root.
    pub fn after(&mut self, passage: &Passage, wide: f64) -> Option<(Section, Step)> {
        let firmer = if wide > WIDE { self.grip * FIRMER } else { self.grip / FIRMER };
        self.grip = firmer.clamp(1.0, TIGHTEST);
        loop {
            let next = self.next(passage)?;
            let step = check(passage, &next, self.torques.len());
            let part = 1.0 - self.shrink;
            let room = step.total() <= 1.0 - OVER * part && step.growth <= 1.0 - RATE * part;
            if self.grip <= 1.0 || room {
                return Some((next, step));
            }
            self.grip = (self.grip / LOOSER).max(1.0);
        }
    }

    /// The section after `passage`, without the oldest readings of which little is left.
    fn next(&self, passage: &Passage) -> Option<Section> {
        let Self { torques, shrink, shares, grip } = self;
        let n = torques.len();
        let [flow, columns, readings] = middles(passage, n);
        let sizes = &passage.law.sizes;
        let [law, robot, of_readings] =
            [shares.law * grip, shares.robot * grip, shares.readings].map(|part| part * (1.0 - shrink));
        let left: Vec<_> =
            sizes.slopes.iter().zip(&sizes.most).take(n).map(|(slope, most)| slope + most).collect();
        let torques: Vec<_> =
            held_open(&left, law).zip(torques).map(|(left, &anyway)| left.max(anyway)).collect();
        // Of all r with Σ (open/r)² = robot², those with the least Σ (r/row)².
        let (open, rows) = open_of(passage);
        let beside = beside(passage, &readings);
        let open: Vec<_> = open.iter().zip(&beside).map(|(open, beside)| open + beside).collect();
        let parts: f64 = open.iter().zip(&rows).map(|(open, row)| open / row).sum();
        let open: Vec<_> =
            open.iter().zip(&rows).map(|(open, row)| (open * row * parts).sqrt() / robot).collect();
        let lower = cholesky(&spread(&(&flow * &flow.transposed()), &columns, &torques, *shrink, &open))?;
        let center = passage.after.center.iter().map(|c| c.midpoint()).collect();
        let scaled = &lower_inverse(&lower) * &readings;
        let length = |j: usize| (0..sizes.ball).map(|i| scaled[(i, j)].powi(2)).sum::<f64>().sqrt();
        let (mut dropped, mut left) = (0, of_readings);
        while dropped < readings.columns() && length(dropped) < left {
            left -= length(dropped);
            dropped += 1;
        }
        let past = latest(&readings, readings.columns() - dropped);
        Some(Section { center, lower, past })
    }
}

impl Step {
    /// λ + ρ + σ, from above: 1 at most where the period is proved.
    pub fn total(&self) -> f64 {
        let Self { growth, offset, noise } = self;
        (Interval::point(*growth) + Interval::point(*offset) + Interval::point(*noise)).hi()
    }

    /// Whether the period is proved.
    pub fn holds(&self) -> bool {
        self.total() <= 1.0
    }
}

/// Φ, the columns that torques beside the law's go by, and those of readings, the oldest first, as long as they may be off.
pub fn middles(passage: &Passage, n: usize) -> [Dense<f64>; 3] {
    let (all, sizes) = (&passage.after.deviations, &passage.law.sizes);
    let ball = sizes.ball;
    let part = |from: usize, count: usize| Dense::from_fn(ball, count, |i, j| all[(i, from + j)].midpoint());
    let readings = Dense::from_fn(ball, all.columns() - ball - n, |i, j| {
        all[(i, ball + n + j)].midpoint() * sizes.most[n + j]
    });
    [part(0, ball), part(ball, n), readings]
}

/// For each z, how far it may be off so that all together move a tube by `part` of what it is, from what they are.
fn held_open(sizes: &[f64], part: f64) -> impl Iterator<Item = f64> {
    let count = sizes.len() as f64;
    sizes.iter().map(move |size| size * count.sqrt() / part)
}

/// Numbers of a state are off by this part of their extents at least, each for itself.
pub const LEAST: f64 = 1e-6;

/// λ⁻² A + Σ w² b bᵀ and a little on the diagonal.
pub fn spread(
    a: &Dense<f64>,
    columns: &Dense<f64>,
    others: &[f64],
    shrink: f64,
    open: &[f64],
) -> Symmetric<f64> {
    let entry = |i: usize, j: usize| {
        let by_others = others.iter().enumerate().map(|(k, w)| w * w * columns[(i, k)] * columns[(j, k)]);
        a[(i, j)] / (shrink * shrink) + by_others.sum::<f64>()
    };
    let size = a.columns();
    Symmetric::from_fn(size, |i, j| {
        let own = if i == j { (LEAST * LEAST * entry(i, i)).max(open[i] * open[i]) } else { 0.0 };
        entry(i, j) + own
    })
}

/// The last columns.
pub fn latest(readings: &Dense<f64>, count: usize) -> Dense<f64> {
    let from = readings.columns() - count;
    Dense::from_fn(readings.rows().len(), count, |i, j| readings[(i, from + j)])
}

/// How far columns of readings are beside those of `kept`, the last of them, all together, number by number, from above.
fn beside(passage: &Passage, kept: &Dense<f64>) -> Vec<f64> {
    let (all, sizes) = (&passage.after.deviations, &passage.law.sizes);
    let from = all.columns() - kept.columns();
    let row = |i: usize| {
        let each = all.row(i)[from..].iter().zip(&sizes.most[from - sizes.ball..]).zip(kept.row(i));
        let off = each.map(|((&x, &most), &kept)| x * Interval::point(most) - Interval::point(kept));
        off.fold(Interval::ZERO, |sum, off| sum + Interval::point(off.magnitude())).hi()
    };
    (0..sizes.ball).map(row).collect()
}

/// λ, ρ and σ from above, from what is known at the end of `passage` of `n` joints to `next`, which keeps the latest readings.
pub fn check(passage: &Passage, next: &Section, n: usize) -> Step {
    let (all, sizes) = (&passage.after.deviations, &passage.law.sizes);
    let ball = sizes.ball;
    let dropped = all.columns() - ball - n - next.past.columns();
    let (root, inverse) = inverse_of(&next.lower);
    let little = &root * &Dense::from_fn(ball, ball + n + dropped, |i, j| all[(i, j)]);
    let flow = Dense::from_fn(ball, ball, |i, j| little[(i, j)]);
    // |M z| for all z with |z_j| ≤ sizes_j: column by column, or by |z| ≤ √count, whichever is less.
    let moved = |from: usize, sizes: &[f64]| {
        let scaled =
            Dense::from_fn(ball, sizes.len(), |i, k| little[(i, from + k)] * Interval::point(sizes[k]));
        let column = |k: usize| Interval::point(frobenius((0..ball).map(|i| scaled[(i, k)])));
        let each = (0..sizes.len()).fold(Interval::ZERO, |sum, k| sum + column(k));
        let together = Interval::point(spectral(&scaled)) * Interval::point(sizes.len() as f64).sqrt();
        Interval::point(each.hi().min(together.hi()))
    };
    let growth = inverse * (Interval::point(spectral(&flow)) + moved(ball, &sizes.slopes[..n]));
    let sized = root.map(|x| Interval::point(x.magnitude()));
    let beside: Vec<_> = beside(passage, &next.past).into_iter().map(Interval::point).collect();
    let noise = moved(ball, &sizes.most[..n])
        + moved(ball + n, &sizes.most[n..n + dropped])
        + Interval::point(frobenius(sized.apply(&beside).into_iter()));
    Step { growth: growth.hi(), offset: next.reach(&passage.after.center), noise: (inverse * noise).hi() }
}
