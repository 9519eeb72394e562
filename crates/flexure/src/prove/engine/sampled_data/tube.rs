//! All sections of a tube, from the start on.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, stein};
use crate::progress::Progress;
use crate::prove::engine::sampled_data::ahead::Ahead;
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::period::{Before, Cuts, HeldLoop, passage};
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::step::{LEAST, Recursion, Step, check, latest, middles, spread};
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
    /// How many times as far as was asked for links reach there.
    pub wide: f64,
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

/// A tube whose links reach so many times as far as was asked for is none: what makes it so wide has taken over.
const WIDEST: f64 = 10.0;

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
    let mut wide = 1.0;
    let ends = |period: usize, wide: f64, why: Why| Some(Err(Ends { period, why, wide }));
    let shrink = (-request.rate * of.period.midpoint()).exp();
    let Some((first, torques)) = first(of, request, shrink) else { return ends(0, wide, Why::NotStable) };
    let mut now = match sections {
        Sections::Made => first,
        Sections::Given(all, _) => all[0].clone(),
    };
    let mut found = Vec::with_capacity(request.periods + 1);
    let begins = now.reach(&of.started(&request.start));
    if begins.is_nan() || begins > 1.0 {
        return ends(0, wide, Why::StartsOutside);
    }
    let (mut cuts, mut ahead, mut watch) = (Cuts::new(shrink), Ahead::default(), Watch::default());
    let mut recursion = Recursion::new(torques, shrink, of.sensors.off.is_empty());
    let enough = recursion.enough();
    for k in 0.. {
        if progress(k as f64 / request.periods as f64).is_break() {
            return None;
        }
        let extents = now.extents();
        let reaches = || extents.iter().zip(&request.extents).map(|(extent, asked)| extent / asked);
        wide = reaches().fold(0.0, f64::max);
        if let Some(link) = reaches().position(|reach| reach > WIDEST) {
            return ends(k, wide, Why::Widens(link, extents[link]));
        }
        let before = Before::over(of, &now);
        let t = of.period * Interval::point(k as f64);
        let law = ahead.law(of, t, &before.seen, &before.sizes, &enough);
        if let Some(beyond) = watch.look(of, t, &before, &law) {
            return ends(k, wide, Why::Beyond(beyond));
        }
        if k == request.periods {
            each(At { k, section: &now, law: &law, step: None });
            break;
        }
        let Some(passage) = cuts.passage(of, &before, &law) else { return ends(k, wide, Why::Unbounded) };
        let next = match sections {
            Sections::Made => recursion.after(&passage, wide),
            Sections::Given(all, kept) => {
                let [_, _, readings] = middles(&passage, of.system.joints());
                let next = Section { past: latest(&readings, kept[k + 1]), ..all[k + 1].clone() };
                let step = check(&passage, &next, of.system.joints());
                Some((next, step))
            }
        };
        let Some((next, step)) = next else { return ends(k, wide, Why::Grows) };
        if !step.holds() {
            let exact = Step { offset: 0.0, ..step };
            return ends(k, wide, if exact.holds() { Why::Missed } else { Why::Grows });
        }
        each(At { k, section: &now, law: &law, step: Some(step) });
        watch.passed(&before, &passage, of.system.joints());
        found.push(std::mem::replace(&mut now, next));
    }
    found.push(now);
    Some(Ok(found))
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
    let law = Ahead::default().law(of, Interval::ZERO, &before.seen, &before.sizes, &vec![f64::INFINITY; n]);
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
