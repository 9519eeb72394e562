//! The recursion of ellipsoids, and the check of each.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse, stein};
use crate::progress::Progress;
use crate::prove::engine::sampled_data::ahead::Ahead;
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
use crate::prove::engine::sampled_data::period::{Before, Cuts, HeldLoop, Passage, open_of, passage};
use crate::prove::engine::sampled_data::section::{Section, inverse_of};
use crate::prove::engine::sampled_data::watch::{Beyond, Watch};

/// What tube is asked for.
#[derive(Clone, Debug)]
pub struct TubeRequest {
    /// Motion at the first instant.
    pub start: Vec<Interval>,
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
    /// ρ, by which the middle is missed.
    pub offset: f64,
    /// σ, by which readings that are off move the loop.
    pub noise: f64,
}

/// An instant of a tube.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// Which, from 0.
    pub k: usize,
    /// Where motions are.
    pub section: &'a Section,
    /// The law there.
    pub law: &'a Instant,
    /// The period after it; the last instant has none.
    pub step: Option<Step>,
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
    /// The start of the run is in the first ellipsoid.
    StartsOutside,
    /// Motions stay bounded for a period.
    Unbounded,
    /// Motions come closer.
    Grows,
    /// They come closer by more than the middle is rounded.
    Missed,
    /// Links stay as near the run as was asked for, nearly: which does not, by index, and how far it may be in rad.
    Widens(usize, f64),
    /// Nothing of it is limited or doubted.
    Beyond(Beyond),
}

/// Of 1 − λ, the parts for what intervals leave open of the law and of the robot, and for readings that are off.
#[derive(Clone, Copy)]
struct Shares {
    law: f64,
    robot: f64,
    readings: f64,
}

/// Where readings are exact, and where they are off.
const EXACT: Shares = Shares { law: 0.25, robot: 0.5, readings: 0.0 };
const OFF: Shares = Shares { law: 0.25, robot: 0.3, readings: 0.4 };

/// A tube whose links reach so many times as far as was asked for is none: what makes it so wide has taken over.
const WIDEST: f64 = 10.0;

/// Numbers of a state are off by this part of their extents at least, each for itself.
const LEAST: f64 = 1e-6;

/// Extents of the first ellipsoid are brought to those that are asked for in so many rounds.
const ROUNDS: u32 = 8;

/// Where filters and torques on their way begin as the motion does, each position alone may be off by this part of its extent, nearly.
const ALONE: f64 = 0.5;

/// Half of the box that the loop is linearised over, in rad, rad/s and N m.
const SMALL: f64 = 1e-12;

/// Where a tube's sections come from.
#[derive(Clone, Copy, Debug)]
pub enum Sections<'a> {
    /// They are made from one period to the next.
    Made,
    /// They are there, one for each instant, but for their P, which has so many columns: only the checks are left.
    Given(&'a [Section], &'a [usize]),
}

/// All sections of a tube; `each` is told of every instant.
pub fn tube(
    of: &HeldLoop<'_>,
    request: &TubeRequest,
    sections: Sections<'_>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(At<'_>),
) -> Option<Result<Vec<Section>, Ends>> {
    let ends = |period: usize, why: Why| Some(Err(Ends { period, why }));
    let shrink = (-request.rate * of.period.midpoint()).exp();
    let Some((first, off)) = first(of, request, shrink) else { return ends(0, Why::NotStable) };
    let mut now = match sections {
        Sections::Made => first,
        Sections::Given(all, _) => all[0].clone(),
    };
    let mut found = Vec::with_capacity(request.periods + 1);
    let begins = now.reach(&of.started(&request.start));
    if begins.is_nan() || begins > 1.0 {
        return ends(0, Why::StartsOutside);
    }
    let (mut cuts, mut ahead, mut watch) = (Cuts::new(shrink), Ahead::default(), Watch::default());
    // Torques beside the law's that hold the tube open anyway leave this much to |η|.
    let count = (off.len() as f64).sqrt();
    let enough: Vec<_> = off.iter().map(|w| w * shares(of).law * (1.0 - shrink) / count).collect();
    for k in 0.. {
        if progress(k as f64 / request.periods as f64).is_break() {
            return None;
        }
        let reached = now
            .extents()
            .into_iter()
            .zip(&request.extents)
            .position(|(extent, asked)| extent > WIDEST * asked);
        if let Some(link) = reached {
            return ends(k, Why::Widens(link, now.extents()[link]));
        }
        let before = Before::over(of, &now);
        let t = of.period * Interval::point(k as f64);
        let law = ahead.law(of, t, &before.seen, &before.sizes, &enough);
        if let Some(beyond) = watch.look(of, t, &before, &law) {
            return ends(k, Why::Beyond(beyond));
        }
        if k == request.periods {
            each(At { k, section: &now, law: &law, step: None });
            break;
        }
        let Some(passage) = cuts.passage(of, &before, &law) else { return ends(k, Why::Unbounded) };
        let next = match sections {
            Sections::Made => next(&passage, &off, shrink, shares(of)),
            Sections::Given(all, kept) => {
                let [_, _, readings] = middles(&passage, off.len());
                Some(Section { past: latest(&readings, kept[k + 1]), ..all[k + 1].clone() })
            }
        };
        let Some(next) = next else { return ends(k, Why::Grows) };
        let step = check(&passage, &next, off.len());
        let Step { growth, offset, noise } = step;
        let most = (Interval::point(growth) + Interval::point(offset) + Interval::point(noise)).hi();
        if most.is_nan() || most > 1.0 {
            let missed = (Interval::point(growth) + Interval::point(noise)).hi() <= 1.0;
            return ends(k, if missed { Why::Missed } else { Why::Grows });
        }
        each(At { k, section: &now, law: &law, step: Some(step) });
        watch.passed(&before, &passage, off.len());
        found.push(std::mem::replace(&mut now, next));
    }
    found.push(now);
    Some(Ok(found))
}

fn shares(of: &HeldLoop<'_>) -> Shares {
    if of.sensors.off.is_empty() { EXACT } else { OFF }
}

/// Φ, the columns that torques beside the law's go by, and those of readings, the oldest first, as long as they may be off.
fn middles(passage: &Passage, n: usize) -> [Dense<f64>; 3] {
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

/// λ⁻² A + Σ w² b bᵀ and a little on the diagonal.
fn spread(a: &Dense<f64>, columns: &Dense<f64>, others: &[f64], shrink: f64, open: &[f64]) -> Symmetric<f64> {
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

/// The first ellipsoid, and the torques that hold the tube open [N m].
fn first(of: &HeldLoop<'_>, request: &TubeRequest, shrink: f64) -> Option<(Section, Vec<f64>)> {
    let n = of.system.joints();
    let center: Vec<_> = of.started(&request.start).iter().map(|x| x.midpoint()).collect();
    let size = center.len();
    let none = Dense::zeros(size, 0);
    let small =
        Section { center: center.clone(), lower: Dense::identity(size).scaled(SMALL), past: none.clone() };
    let before = Before::over(of, &small);
    let law = Ahead::default().law(of, Interval::ZERO, &before.seen, &before.sizes, &vec![0.0; n]);
    let [flow, columns, _] = middles(&passage(of, &before, &law, 1)?, n);
    let flow = flow.scaled(1.0 / (SMALL * shrink));
    let mut torques = vec![1.0; n];
    let zero = Dense::zeros(size, size);
    for round in 0..=ROUNDS {
        let added = spread(&zero, &columns, &torques, shrink, &vec![0.0; size]);
        let square = stein(flow.clone(), Dense::from(&added))?;
        let alone = if size > of.motion() { ALONE } else { 0.0 };
        if round == ROUNDS {
            let starts: Vec<_> = (0..2 * n)
                .map(|i| {
                    let length = alone * square[(i, i)].sqrt() / (1.0 - alone * alone).sqrt();
                    let unit = |k: usize| Interval::point(if i == k { length } else { 0.0 });
                    of.started(&(0..of.motion()).map(unit).collect::<Vec<_>>())
                })
                .collect();
            let started = |i: usize, j: usize| -> f64 {
                starts.iter().map(|start| start[i].midpoint() * start[j].midpoint()).sum()
            };
            let square = Symmetric::from_fn(size, |i, j| square[(i, j)] + started(i, j));
            // A ball more, so that it has a root.
            let own = |i: usize, j: usize| if i == j { 1.0 + LEAST * LEAST } else { 1.0 };
            let lower = cholesky(&Symmetric::from_fn(size, |i, j| square.at(i, j) * own(i, j)))?;
            return Some((Section { center, lower, past: none }, torques));
        }
        for (i, torque) in torques.iter_mut().enumerate() {
            *torque *= request.extents[i] * (1.0 - alone * alone).sqrt() / square[(i, i)].sqrt();
        }
    }
    None
}

/// The section after `passage`, without the oldest readings of which little is left.
fn next(passage: &Passage, torques: &[f64], shrink: f64, shares: Shares) -> Option<Section> {
    let n = torques.len();
    let [flow, columns, readings] = middles(passage, n);
    let sizes = &passage.law.sizes;
    let [law, robot, of_readings] =
        [shares.law, shares.robot, shares.readings].map(|part| part * (1.0 - shrink));
    // Half of it for the law beside its slopes, half for readings that are not kept.
    let others =
        held_open(&sizes.slopes[..n], law).zip(held_open(&sizes.most[..n], 0.5 * of_readings.max(law)));
    let torques: Vec<_> =
        others.zip(torques).map(|((slope, most), &anyway)| slope.max(most).max(anyway)).collect();
    // Of all r with Σ (open/r)² = robot², those with the least Σ (r/row)².
    let (open, rows) = open_of(passage);
    let beside = beside(passage, &readings);
    let open: Vec<_> = open.iter().zip(&beside).map(|(open, beside)| open + beside).collect();
    let parts: f64 = open.iter().zip(&rows).map(|(open, row)| open / row).sum();
    let open: Vec<_> =
        open.iter().zip(&rows).map(|(open, row)| (open * row * parts).sqrt() / robot).collect();
    let lower = cholesky(&spread(&(&flow * &flow.transposed()), &columns, &torques, shrink, &open))?;
    let center = passage.after.center.iter().map(|c| c.midpoint()).collect();
    let scaled = &lower_inverse(&lower) * &readings;
    let length = |j: usize| (0..sizes.ball).map(|i| scaled[(i, j)].powi(2)).sum::<f64>().sqrt();
    let (mut dropped, mut left) = (0, 0.5 * of_readings);
    while dropped < readings.columns() && length(dropped) < left {
        left -= length(dropped);
        dropped += 1;
    }
    let past = latest(&readings, readings.columns() - dropped);
    Some(Section { center, lower, past })
}

/// The last columns.
fn latest(readings: &Dense<f64>, count: usize) -> Dense<f64> {
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
fn check(passage: &Passage, next: &Section, n: usize) -> Step {
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
