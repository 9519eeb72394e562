//! The recursion of ellipsoids, and the check of each.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, stein};
use crate::progress::Progress;
use crate::prove::engine::sampled_data::ellipsoid::{Ellipsoid, inverse_of};
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
use crate::prove::engine::sampled_data::period::{Cuts, HeldLoop, Passage, law_at, open_of, passage};

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
    /// Motions come closer.
    Grows,
    /// Links stay as near the run as was asked for, nearly: how far one of them may be (rad).
    Widens(f64),
    /// The torque of a joint, by index, stays below its limit: its bound [N m].
    Limited(usize, f64),
}

/// Of 1 − λ, the parts that what intervals leave open of the law and of the robot may take.
const LAW: f64 = 0.25;
const ROBOT: f64 = 0.5;

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
    let on_their_way = now.center.iter().zip(now.extents()).skip(request.start.len());
    let on_their_way =
        on_their_way.map(|(c, extent)| (Interval::point(c.abs()) + Interval::point(extent)).hi());
    if let Some(limited) = beyond(of, on_their_way) {
        return ends(0, limited);
    }
    let mut cuts = Cuts::default();
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
        if let Some(limited) = beyond(of, law.largest()) {
            return ends(k, limited);
        }
        let Some(passage) = cuts.passage(of, &now, &law) else { return ends(k, Why::Unbounded) };
        let Some(next) = next(&passage, &off, shrink) else { return ends(k, Why::Grows) };
        let step = check(&passage, &next);
        let most = (Interval::point(step.growth) + Interval::point(step.offset)).hi();
        if most.is_nan() || most > 1.0 {
            return ends(k, Why::Grows);
        }
        each(k, &now, &passage, step);
        now = next;
    }
    Some(Ok(now))
}

/// The first torque, of those of all joints one instant after the other [N m], that is beyond its limit.
fn beyond(of: &HeldLoop<'_>, torques: impl IntoIterator<Item = f64>) -> Option<Why> {
    let limits = of.limits?.iter().enumerate().cycle();
    let found = torques.into_iter().zip(limits).find(|(torque, (_, limit))| torque > limit);
    found.map(|(torque, (joint, _))| Why::Limited(joint, torque))
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
    let n = of.system.joints();
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
    let [law, robot] = [LAW, ROBOT].map(|part| part * (1.0 - shrink));
    let count = torques.len() as f64;
    let torques: Vec<_> = torques
        .iter()
        .zip(&passage.sizes.others)
        .map(|(&w, &open)| w.max(open * count.sqrt() / law))
        .collect();
    // Of all r with Σ (open/r)² = robot², those with the least Σ (r/row)².
    let (open, rows) = open_of(passage);
    let parts: f64 = open.iter().zip(&rows).map(|(open, row)| open / row).sum();
    let open: Vec<_> =
        open.iter().zip(&rows).map(|(open, row)| (open * row * parts).sqrt() / robot).collect();
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
    let offset = next.reach(&passage.after.center);
    Step { growth: growth.hi(), offset }
}
