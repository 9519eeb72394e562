//! What gains are held to.

use serde::Serialize;

use crate::files::number;
use crate::simulate::{Measure, Run, Used};

/// Something that a tuned loop is held to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Constraint {
    /// What it is, in words.
    pub what: String,
    /// The joint that comes closest, or goes farthest beyond.
    pub joint: Option<String>,
    /// What the loop has.
    pub value: f64,
    /// Largest value that is accepted, or smallest for a rate and for the time that a run lasts.
    pub limit: f64,
    /// Unit of both; nothing for pure numbers.
    pub unit: &'static str,
    /// Part of the limit that is left; of spectral radii, parts of the instants and stops what is left of it. Negative where it is broken.
    pub slack: f64,
    /// Whether it must be kept; else it is wished for, and what keeps it is preferred.
    pub asked: bool,
    /// What it is about.
    #[serde(skip)]
    pub kind: Kind,
    /// More in words, if there is any.
    pub note: Option<String>,
}

/// What a constraint is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A spectral radius that must be below 1.
    Radius,
    /// A run that comes to its end.
    Whole,
    /// A run that the guard does not stop.
    Stopped,
    /// Something that a run is held to.
    Run(Measure),
    /// A loop with something to bear that does not follow.
    Lost,
    /// The certified rate.
    Rate,
    /// The rate of the sampled loop: that of a tube where one was looked for, else what one may have.
    SampledRate,
}

/// Spectral radius up to which a loop counts as stable: computed to about 1e-12.
const STABLE: f64 = 1.0 - 1e-9;

/// What the loop as it is is held to, and how a loop with something to bear is named.
pub(super) const NOMINAL: &str = "small errors shrink in the sampled loop";
pub(super) const FOLLOWS: &str = "follows with ";

/// By how much a spectral radius above 1 counts more than another limit that is exceeded by the same part.
const STEEP: f64 = 10.0;

impl Constraint {
    /// That a spectral radius is below 1.
    pub(super) fn radius(what: String, radius: f64) -> Self {
        let slack = STABLE - radius;
        Self {
            what,
            joint: None,
            value: radius,
            limit: 1.0,
            unit: "",
            slack,
            asked: true,
            kind: Kind::Radius,
            note: None,
        }
    }

    /// That a run comes to its end at `duration` in s, where it diverges at `time`.
    pub(super) fn diverged(time: f64, duration: f64) -> Self {
        Self {
            what: "the run comes to its end".to_owned(),
            joint: None,
            value: time,
            limit: duration,
            unit: "s",
            slack: -1.0,
            asked: true,
            kind: Kind::Whole,
            note: Some(format!("diverges at t = {}", number::duration(time))),
        }
    }

    /// What `runs` are held to, each in the run that comes closest; `at_limit` is the largest part of the instants at which a torque
    /// limit may act.
    pub(super) fn of_runs(runs: &[Run], at_limit: f64) -> Vec<Self> {
        let of = |measure: Measure| {
            let used = runs.iter().flat_map(|run| &run.summary.following.used);
            let used = used.filter(|used| used.measure == measure).map(Self::used);
            used.min_by(|a, b| a.slack.total_cmp(&b.slack))
        };
        let limits = Measure::ALL.into_iter().filter(|measure| *measure != Measure::AtLimit);
        let share = runs.iter().map(|run| run.summary.saturated_fraction).fold(0.0, f64::max);
        let stopped = runs.iter().any(|run| run.summary.stops > 0);
        let constraint = |what: &str, value: f64, limit: f64, kind: Kind| Self {
            what: what.to_owned(),
            joint: None,
            value,
            limit,
            unit: "",
            slack: limit - value,
            asked: true,
            kind,
            note: None,
        };
        let share = constraint(
            "part of the instants at a torque limit",
            share,
            at_limit,
            Kind::Run(Measure::AtLimit),
        );
        let stops = stopped.then(|| constraint("stops by the guard", 1.0, 0.0, Kind::Stopped));
        limits.filter_map(of).chain([share]).chain(stops).collect()
    }

    fn used(used: &Used) -> Self {
        let Used { measure, joint, unit, value, limit } = used;
        Self {
            what: measure.what().trim_end_matches(',').to_owned(),
            joint: Some(joint.clone()),
            value: *value,
            limit: *limit,
            unit,
            slack: 1.0 - value / limit,
            asked: true,
            kind: Kind::Run(*measure),
            note: None,
        }
    }

    /// That a loop with something to bear does not follow, with the first reason.
    pub(super) fn lost(what: &str, reason: &str) -> Self {
        Self {
            what: format!("{FOLLOWS}{what}"),
            joint: None,
            value: 0.0,
            limit: 1.0,
            unit: "",
            slack: -1.0,
            asked: true,
            kind: Kind::Lost,
            note: Some(reason.to_owned()),
        }
    }

    /// That a certified rate is as large as was asked [1/s].
    pub(super) fn rate(proved: f64, asked: f64) -> Self {
        Self {
            what: "certified contraction rate, at least".to_owned(),
            joint: None,
            value: proved,
            limit: asked,
            unit: "1/s",
            slack: proved / asked - 1.0,
            asked: true,
            kind: Kind::Rate,
            note: None,
        }
    }

    /// That motions of the sampled loop were proved to come closer at `rate`, where `asked` is asked \[1/s\]; `note` says why there is no tube.
    pub(super) fn sampled_rate(rate: f64, asked: f64, note: Option<String>) -> Self {
        Self {
            what: "rate of the sampled loop near its run, proved, at least".to_owned(),
            value: number::rounded_down(rate, 4),
            kind: Kind::SampledRate,
            note,
            ..Self::rate(rate, asked)
        }
    }

    /// That small errors shrink fast enough for a tube that has `asked`, as one may have about `rate` \[1/s\].
    pub(super) fn outlook(rate: f64, asked: f64, note: Option<String>) -> Self {
        let what = "rate that a tube of the sampled loop may have, a guess".to_owned();
        Self { what, value: rate, ..Self::sampled_rate(rate, asked, note) }
    }

    /// The same, `asked` or wished for.
    pub(super) fn asked(self, asked: bool) -> Self {
        Self { asked, ..self }
    }

    /// Whether the loop keeps it.
    pub fn is_kept(&self) -> bool {
        self.slack >= 0.0
    }

    /// Whether the loop keeps it, or it is wished for alone.
    pub fn is_met(&self) -> bool {
        self.is_kept() || !self.asked
    }

    /// By how much it is broken; 0 if it is kept.
    pub(super) fn excess(&self) -> f64 {
        let times = if self.kind == Kind::Radius { STEEP } else { 1.0 };
        if self.slack.is_nan() { f64::INFINITY } else { times * (-self.slack).max(0.0) }
    }
}
