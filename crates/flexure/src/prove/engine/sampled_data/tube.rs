//! The recursion of ellipsoids, and the check of each.

use std::ops::Range;

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse, stein};
use crate::progress::Progress;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::hold::{Sizes, Spread, held, pace};
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::norm::{frobenius, radius, spectral};

/// A loop that acts at instants.
#[derive(Clone, Copy)]
pub struct HeldLoop<'a> {
    /// Its law, with the numbers of the robot that the law knows.
    pub law: &'a dyn TrackingLoop,
    /// The robot that moves.
    pub robot: &'a dyn TrackingLoop,
    /// Control period in s.
    pub period: Interval,
    /// Torques on their way at an instant, before the law has asked for another.
    pub waiting: usize,
    /// How long into a period the next of them begins to act in s; none if from its beginning.
    pub offset: Option<Interval>,
    /// Largest torques of the drives [N m], from below; none if nothing limits them.
    pub limits: Option<&'a [f64]>,
}

/// What tube is asked for.
#[derive(Clone, Debug)]
pub struct TubeRequest {
    /// Motion at the first instant.
    pub start: Vec<f64>,
    /// Torque that acts until the first that is asked for [N m].
    pub torque: Vec<f64>,
    /// Control periods.
    pub periods: usize,
    /// How far link positions may be off at the start in rad, for each link.
    pub extents: Vec<f64>,
    /// The rate to look for [1/s].
    pub rate: f64,
}

/// An ellipsoid of the tube.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    /// c: motion, then torques on their way, the first to act first.
    pub center: Vec<f64>,
    /// L, lower triangular.
    pub lower: Dense<f64>,
}

/// What is said of a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// λ.
    pub growth: f64,
    /// ρ.
    pub offset: f64,
}

/// Why a tube ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Ends {
    /// The control period, from 0.
    pub period: usize,
    /// What was not shown there.
    pub why: Why,
}

/// What was not shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// Small errors shrink at the start with the rate that is asked for.
    NotStable,
    /// Motions stay bounded for a period.
    Unbounded,
    /// Ellipsoids have a root in floats.
    NoRoot,
    /// Motions come closer: what is known of λ + ρ.
    Grows(f64),
    /// Links stay as near the run as was asked for, nearly: how far one of them may be [rad].
    Widens(f64),
    /// The torque of a joint, by index, stays below its limit: its bound [N m].
    Limited(usize, f64),
}

impl HeldLoop<'_> {
    /// The first torque on its way, of those in `places`, that may be beyond its limit.
    fn beyond(&self, mut places: Range<usize>, of: &Ellipsoid) -> Option<Why> {
        let n = self.law.joints();
        let extents = of.extents();
        let torque = |place: usize, joint: usize| {
            let at = (4 + place) * n + joint;
            (Interval::point(of.center[at].abs()) + Interval::point(extents[at])).hi()
        };
        let limits = self.limits?;
        places.find_map(|place| {
            let joint = (0..n).find(|&joint| torque(place, joint) > limits[joint])?;
            Some(Why::Limited(joint, torque(place, joint)))
        })
    }
}

impl Ellipsoid {
    /// How far each number reaches, from above.
    pub fn extents(&self) -> Vec<f64> {
        self.lower.rows().map(|row| frobenius(row.iter().map(|&x| Interval::point(x)))).collect()
    }

    /// How far number `i` may be off alone, from below: 1/|L⁻¹ e_i|.
    pub fn alone(&self, i: usize) -> f64 {
        let (root, inverse) = inverse_of(&self.lower);
        let column = frobenius((0..self.center.len()).map(|k| root[(k, i)]));
        (inverse * Interval::point(column)).recip().lo()
    }

    /// |y| of a state, or of the first numbers of one, then of as many numbers of y, which depend on no others; but for rounding.
    pub fn distance(&self, state: &[f64]) -> f64 {
        let root = lower_inverse(&self.lower);
        let off: Vec<f64> = state.iter().zip(&self.center).map(|(x, c)| x - c).collect();
        let y =
            root.rows().take(state.len()).map(|row| row.iter().zip(&off).map(|(r, x)| r * x).sum::<f64>());
        y.map(|y| y * y).sum::<f64>().sqrt()
    }
}

/// R near the inverse of `lower`, and a bound of ‖(R L)⁻¹‖: 1/(1 − ‖1 − R L‖), so that |L⁻¹ x| ≤ ‖(R L)⁻¹‖ |R x|; infinite where R is not near.
fn inverse_of(lower: &Dense<f64>) -> (Dense<Interval>, Interval) {
    let size = lower.columns();
    let root = lower_inverse(lower).map(Interval::point);
    let product = &root * &lower.map(Interval::point);
    let off = (0..size)
        .flat_map(|i| (0..size).map(move |j| (i, j)))
        .map(|(i, j)| if i == j { product[(i, j)] - Interval::ONE } else { product[(i, j)] });
    let left = Interval::ONE - Interval::point(frobenius(off));
    let bound = if left.lo() > 0.0 { left.recip() } else { Interval::point(f64::INFINITY) };
    (root, bound)
}

/// Of 1 − λ, the part that each of what intervals leave open may take.
const SHARE: f64 = 0.25;

/// A tube whose links reach so many times as far as was asked for is none: what makes it so wide has taken over.
const WIDEST: f64 = 10.0;

/// Numbers of a state are off by this part of their extents at least, each for itself.
const LEAST: f64 = 1e-6;

/// Extents of the first ellipsoid are brought to those that are asked for in so many rounds.
const ROUNDS: u32 = 8;

/// Half of the box that the loop is linearised over, in rad, rad/s and N m.
const SMALL: f64 = 1e-12;

/// Where a tube goes: `each` is told of every ellipsoid and of the period after it.
pub fn tube(
    of: &HeldLoop<'_>,
    request: &TubeRequest,
    progress: Progress<'_>,
    each: &mut dyn FnMut(usize, &Ellipsoid, &Passage, Step),
) -> Option<Result<Ellipsoid, Ends>> {
    let ends = |period: usize, why: Why| Some(Err(Ends { period, why }));
    let shrink = (-request.rate * of.period.midpoint()).exp();
    let Some((mut now, off)) = first(of, request, shrink) else { return ends(0, Why::NotStable) };
    if let Some(limited) = of.beyond(0..of.waiting, &now) {
        return ends(0, limited);
    }
    let mut cuts = Cuts::new();
    for k in 0..request.periods {
        if progress(k as f64 / request.periods as f64).is_break() {
            return None;
        }
        let reached = now
            .extents()
            .into_iter()
            .zip(&request.extents)
            .find(|(extent, asked)| *extent > WIDEST * **asked);
        if let Some((extent, _)) = reached {
            return ends(k, Why::Widens(extent));
        }
        let law = law_at(of, k, &now);
        let beyond = |(_, (torque, limit)): &(usize, (f64, &f64))| torque > limit;
        let torques = law.largest();
        if let Some((joint, (torque, _))) =
            torques.into_iter().zip(of.limits.unwrap_or_default()).enumerate().find(beyond)
        {
            return ends(k, Why::Limited(joint, torque));
        }
        let Some(passage) = cuts.passage(of, &now, &law) else { return ends(k, Why::Unbounded) };
        let Some(next) = next(&passage, &off, shrink) else { return ends(k, Why::NoRoot) };
        let step = check(&passage, &next);
        let most = (Interval::point(step.growth) + Interval::point(step.offset)).hi();
        if most.is_nan() || most > 1.0 {
            return ends(k, Why::Grows(step.growth + step.offset));
        }
        each(k, &now, &passage, step);
        now = next;
    }
    Some(Ok(now))
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
struct Cuts {
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
const HELPED: f64 = 0.75;

impl Cuts {
    fn new() -> Self {
        Self { finer: 1, floor: CLOSED }
    }

    /// The period from `now` under `law`, in pieces that leave little open, as far as pieces can.
    fn passage(&mut self, of: &HeldLoop<'_>, now: &Ellipsoid, law: &Instant) -> Option<Passage> {
        let mut found = passage(of, now, law, self.finer)?;
        let mut open = openness(&found);
        while open > 2.0 * self.floor && self.finer < FINEST {
            let halved = passage(of, now, law, 2 * self.finer)?;
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
fn open_of(passage: &Passage) -> (Vec<f64>, Vec<f64>) {
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
fn law_at(of: &HeldLoop<'_>, k: usize, now: &Ellipsoid) -> Instant {
    let size = 4 * of.law.joints();
    let square = Dense::from_fn(size, size, |i, j| now.lower[(i, j)]);
    Instant::over(of.law, of.period * Interval::point(k as f64), &now.center[..size], &square)
}

/// A period from `now` under `law`, in so many times as many pieces as are needed; none if motions are not shown to exist.
fn passage(of: &HeldLoop<'_>, now: &Ellipsoid, law: &Instant, finer: usize) -> Option<Passage> {
    let (n, ball) = (of.law.joints(), now.center.len());
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
        held(
            of.robot,
            motion,
            torque,
            &sizes,
            length,
            finer * pace(of.robot, &motion_at(&now.center, n), length),
        )
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

fn motion_at(center: &[f64], n: usize) -> Vec<Interval> {
    points(&center[..4 * n])
}

fn rows(of: &Dense<Interval>, from: usize, count: usize) -> Dense<Interval> {
    Dense::from_fn(count, of.columns(), |i, j| of[(from + i, j)])
}

/// Φ, and the columns that a torque beside the law's goes by.
fn middles(passage: &Passage) -> (Dense<f64>, Dense<f64>) {
    let (all, ball) = (&passage.after.deviations, passage.sizes.ball);
    let part = |from: usize, count: usize| Dense::from_fn(ball, count, |i, j| all[(i, from + j)].midpoint());
    (part(0, ball), part(ball, all.columns() - ball))
}

/// λ⁻² A + Σ w² b bᵀ and a little on the diagonal.
fn spread(
    a: &Dense<f64>,
    columns: &Dense<f64>,
    torques: &[f64],
    shrink: f64,
    open: &[f64],
) -> Symmetric<f64> {
    let entry = |i: usize, j: usize| {
        let by_torque = torques.iter().enumerate().map(|(k, w)| w * w * columns[(i, k)] * columns[(j, k)]);
        a[(i, j)] / (shrink * shrink) + by_torque.sum::<f64>()
    };
    let size = a.columns();
    Symmetric::from_fn(size, |i, j| {
        let own = if i == j { (LEAST * LEAST * entry(i, i)).max(open[i] * open[i]) } else { 0.0 };
        entry(i, j) + own
    })
}

/// The first ellipsoid, and the torques that hold the tube open [N m].
fn first(of: &HeldLoop<'_>, request: &TubeRequest, shrink: f64) -> Option<(Ellipsoid, Vec<f64>)> {
    let n = of.law.joints();
    let mut center = request.start.clone();
    center.extend((0..of.waiting).flat_map(|_| request.torque.iter().copied()));
    let size = center.len();
    let small = Ellipsoid { center: center.clone(), lower: Dense::identity(size).scaled(SMALL) };
    let (flow, columns) = middles(&passage(of, &small, &law_at(of, 0, &small), 1)?);
    let flow = flow.scaled(1.0 / (SMALL * shrink));
    let mut torques = vec![1.0; n];
    for round in 0..=ROUNDS {
        let zero = Dense::zeros(size, size);
        let added = spread(&zero, &columns, &torques, shrink, &vec![0.0; size]);
        let square = stein(flow.clone(), Dense::from(&added))?;
        if round == ROUNDS {
            let square = Symmetric::from_fn(size, |i, j| square[(i, j)]);
            // A ball more, so that it has a root.
            let own = |i: usize, j: usize| if i == j { 1.0 + LEAST * LEAST } else { 1.0 };
            let lower = cholesky(&Symmetric::from_fn(size, |i, j| square.at(i, j) * own(i, j)))?;
            return Some((Ellipsoid { center, lower }, torques));
        }
        for (i, torque) in torques.iter_mut().enumerate() {
            *torque *= request.extents[i] / square[(i, i)].sqrt();
        }
    }
    None
}

/// The ellipsoid after `passage`.
fn next(passage: &Passage, torques: &[f64], shrink: f64) -> Option<Ellipsoid> {
    let (flow, columns) = middles(passage);
    let room = SHARE * (1.0 - shrink);
    let count = torques.len() as f64;
    let torques: Vec<_> = torques
        .iter()
        .zip(&passage.sizes.others)
        .map(|(&w, &open)| w.max(open * count.sqrt() / room))
        .collect();
    // Of all r with Σ (open/r)² = room², those with the least Σ (r/row)².
    let (open, rows) = open_of(passage);
    let parts: f64 = open.iter().zip(&rows).map(|(open, row)| open / row).sum();
    let open: Vec<_> = open.iter().zip(&rows).map(|(open, row)| (open * row * parts).sqrt() / room).collect();
    let lower = cholesky(&spread(&(&flow * &flow.transposed()), &columns, &torques, shrink, &open))?;
    let center = passage.after.center.iter().map(|c| c.midpoint()).collect();
    Some(Ellipsoid { center, lower })
}

/// λ and ρ from above, from what is known at the end of `passage` to `next`.
fn check(passage: &Passage, next: &Ellipsoid) -> Step {
    let (all, ball) = (&passage.after.deviations, passage.sizes.ball);
    let (root, inverse) = inverse_of(&next.lower);
    let mapped = &root * all;
    let flow = Dense::from_fn(ball, ball, |i, j| mapped[(i, j)]);
    let beside = passage.sizes.others.iter().enumerate().map(|(k, &size)| {
        Interval::point(frobenius((0..ball).map(|i| mapped[(i, ball + k)]))) * Interval::point(size)
    });
    let beside = beside.fold(Interval::ZERO, |a, b| a + b).hi();
    let others = passage.sizes.others.len();
    let scaled =
        Dense::from_fn(ball, others, |i, k| mapped[(i, ball + k)] * Interval::point(passage.sizes.others[k]));
    // |η_j| ≤ s_j |y| for each of them.
    let together = Interval::point(spectral(&scaled)) * Interval::point(others as f64).sqrt();
    let growth = inverse * (Interval::point(spectral(&flow)) + Interval::point(beside.min(together.hi())));
    let missed: Vec<_> =
        passage.after.center.iter().zip(&next.center).map(|(&c, &at)| c - Interval::point(at)).collect();
    let missed =
        root.rows().map(|row| row.iter().zip(&missed).fold(Interval::ZERO, |sum, (&r, &x)| sum + r * x));
    let offset = inverse * Interval::point(frobenius(missed));
    Step { growth: growth.hi(), offset: offset.hi() }
}
