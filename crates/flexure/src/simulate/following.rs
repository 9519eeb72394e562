//! Whether a run follows its reference, and if not, why.

use serde::Serialize;

use crate::files::number::short;
use crate::robot::{JointKind, MovingJoint};
use crate::simulate::criteria::{Bound, Criteria, Measure};
use crate::simulate::interface::Observed;
use crate::simulate::simulation::Divergence;
use crate::units::of_joints;

/// The verdict on a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Following {
    /// Whether it follows its reference: it ran to its end, inside every limit, and no guard has stopped the robot there.
    pub follows: bool,
    /// Why not; nothing for a run that follows.
    pub reasons: Vec<Reason>,
    /// What it came to of each limit, in the joint in which that is most; nothing for a loop that diverged.
    pub used: Vec<Used>,
    /// What it was held to.
    pub accepted: Accepted,
    /// How far the reference goes from where the links start, a joint each [rad or m].
    #[serde(skip)]
    pub size: Vec<f64>,
}

/// What a run came to of a limit, in the joint in which that is most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Used {
    /// What is limited.
    pub measure: Measure,
    /// Name of the joint.
    pub joint: String,
    /// Its unit there.
    pub unit: &'static str,
    /// Its largest value.
    pub value: f64,
    /// The limit.
    pub limit: f64,
}

/// What a run was held to.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Accepted {
    /// Time from which errors, torque changes and time at the limit count \[s\].
    pub settling: f64,
    /// Where that is from.
    pub because: &'static str,
    /// The limits, in the order of [`Measure::ALL`].
    pub bounds: Vec<Bound>,
}

/// Something that keeps a run from following.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// Name of the joint; none for what concerns the whole robot.
    pub joint: Option<String>,
    /// What is beyond its limit; none for loops that diverged, robots that were stopped and runs that were broken off.
    pub measure: Option<Measure>,
    /// Its largest value; NaN (null in JSON) without a measure.
    pub value: f64,
    /// The limit.
    pub limit: f64,
    /// When that was, or when the run ended \[s\]; none for figures of the whole run.
    pub time: Option<f64>,
    /// All of that in words.
    pub words: String,
}

/// The largest value of a measure so far.
#[derive(Clone, Copy, Debug)]
struct Worst {
    value: f64,
    time: f64,
}

/// A run as it goes on, held to criteria.
pub(crate) struct Watch {
    criteria: Criteria,
    /// Torque limits that act, infinite where there is none [N m].
    limits: Vec<f64>,
    /// Link positions at the first instant.
    start: Vec<f64>,
    /// Farthest that the reference is from there.
    size: Vec<f64>,
    /// Of error, torque, speed, deflection.
    worst: [Vec<Worst>; 4],
    last: Vec<f64>,
    squared_change: Vec<f64>,
    at_limit: Vec<u32>,
    /// Instants from settling on.
    settled: u32,
    stopped_since: Option<f64>,
}

impl Watch {
    /// Of nothing yet; `limits` are the torque limits that act [N m].
    pub(crate) fn new(criteria: Criteria, limits: Vec<f64>) -> Self {
        let n = limits.len();
        let none = || vec![Worst { value: 0.0, time: 0.0 }; n];
        Self {
            criteria,
            limits,
            start: Vec::new(),
            size: vec![0.0; n],
            worst: [none(), none(), none(), none()],
            last: Vec::with_capacity(n),
            squared_change: vec![0.0; n],
            at_limit: vec![0; n],
            settled: 0,
            stopped_since: None,
        }
    }

    /// Takes in an instant.
    pub(crate) fn record(&mut self, instant: &Observed) {
        let n = self.limits.len();
        let t = instant.t;
        let (q_l, rest) = instant.motion.split_at(n);
        let (q_m, v_l) = rest.split_at(n);
        if self.start.is_empty() {
            self.start = q_l.to_vec();
        }
        let settled = t >= self.criteria.settling;
        self.settled += u32::from(settled);
        let sizes = self.size.iter_mut().zip(self.start.iter().zip(&instant.reference));
        for (size, (start, reference)) in sizes {
            *size = size.max((reference - start).abs());
        }
        let [errors, torques, speeds, deflections] = &mut self.worst;
        if settled {
            raise(errors, t, q_l.iter().zip(&instant.reference).map(|(q_l, reference)| q_l - reference));
            let changes = instant.applied.iter().zip(&self.last).map(|(torque, last)| torque - last);
            for (sum, change) in self.squared_change.iter_mut().zip(changes) {
                *sum += change * change;
            }
            let commands = instant.command.iter().zip(&self.limits);
            for (count, (command, limit)) in self.at_limit.iter_mut().zip(commands) {
                *count += u32::from(command.abs() >= *limit);
            }
        }
        raise(torques, t, instant.applied.iter().copied());
        raise(speeds, t, v_l.iter().copied());
        raise(deflections, t, q_m.iter().zip(q_l).map(|(q_m, q_l)| q_m - q_l));
        self.last.clone_from(&instant.applied);
        self.stopped_since = instant.stopped.then(|| self.stopped_since.unwrap_or(t));
    }

    /// The verdict on the run that ends here, of a robot with these `joints`; `broken_off` is when that was \[s\], if the run
    /// should have gone on.
    pub(crate) fn verdict(
        &self,
        joints: &[MovingJoint],
        divergence: Option<&Divergence>,
        broken_off: Option<f64>,
    ) -> Following {
        let bounds = self.criteria.bounds(&self.size);
        let used = if divergence.is_some() {
            Vec::new()
        } else {
            bounds.iter().filter_map(|bound| self.used(bound, joints)).collect()
        };
        let mut reasons: Vec<Reason> = broken_off.map(Reason::broken_off).into_iter().collect();
        match (divergence, self.stopped_since) {
            (Some(divergence), _) => reasons.push(Reason::whole(divergence.time, divergence.to_string())),
            (None, Some(since)) => {
                let words = format!("the guard has stopped the robot since t = {} s", short(since, 4));
                reasons.push(Reason::whole(since, words));
            }
            (None, None) => {}
        }
        for bound in &bounds {
            // What comes after a divergence nobody knows: it is the reason.
            let found = joints.iter().enumerate().filter(|_| divergence.is_none());
            reasons.extend(found.filter_map(|(i, joint)| self.objection(bound, i, joint)));
        }
        let Criteria { settling, settling_because: because, .. } = self.criteria;
        let accepted = Accepted { settling, because, bounds };
        Following { follows: reasons.is_empty(), reasons, used, accepted, size: self.size.clone() }
    }

    /// The largest value of what `bound` limits in joint `i`, and when that was if it was at some time.
    fn value(&self, measure: Measure, i: usize) -> (f64, Option<f64>) {
        let mean = |sum: f64| sum / f64::from(self.settled.max(1));
        let worst = |k: usize| (self.worst[k][i].value, Some(self.worst[k][i].time));
        match measure {
            Measure::Error => worst(0),
            Measure::Torque => worst(1),
            Measure::Speed => worst(2),
            Measure::Deflection => worst(3),
            Measure::TorqueChange => (mean(self.squared_change[i]).sqrt(), None),
            Measure::AtLimit => (mean(f64::from(self.at_limit[i])), None),
        }
    }

    /// What came closest to a limit, or went farthest beyond; none where no joint has one.
    fn used(&self, bound: &Bound, joints: &[MovingJoint]) -> Option<Used> {
        let share = |value: f64, limit: f64| if limit > 0.0 { value / limit } else { value };
        let limited = joints.iter().enumerate().filter(|(i, _)| bound.limit[*i].is_finite());
        let used = limited.map(|(i, joint)| {
            let (value, limit) = (self.value(bound.measure, i).0, bound.limit[i]);
            let unit = bound.measure.unit(joint.kind);
            Used { measure: bound.measure, joint: joint.name.clone(), unit, value, limit }
        });
        used.max_by(|a, b| share(a.value, a.limit).total_cmp(&share(b.value, b.limit)))
    }

    /// What joint `i` did beyond a limit.
    fn objection(&self, bound: &Bound, i: usize, joint: &MovingJoint) -> Option<Reason> {
        let (value, time) = self.value(bound.measure, i);
        let limit = bound.limit[i];
        let is_inside = value <= limit;
        (!is_inside).then(|| {
            let unit = bound.measure.unit(joint.kind);
            let amount = |x: f64| format!("{}{}{unit}", short(x, 4), if unit.is_empty() { "" } else { " " });
            let when = match time {
                Some(time) => format!(" at t = {} s", short(time, 4)),
                None => format!(" from t = {} s on", short(self.criteria.settling, 4)),
            };
            let words = format!(
                "joint {}: {} of {}{when}, accepted are {} ({})",
                joint.name,
                bound.measure.what(),
                amount(value),
                amount(limit),
                bound.because
            );
            Reason {
                joint: Some(joint.name.clone()),
                measure: Some(bound.measure),
                value,
                limit,
                time,
                words,
            }
        })
    }
}

/// Takes in `values` at `time`, a joint each: of the largest so far the first counts, and what is no number stays.
fn raise(worst: &mut [Worst], time: f64, values: impl Iterator<Item = f64>) {
    for (worst, value) in worst.iter_mut().zip(values) {
        let value = value.abs();
        if value > worst.value || value.is_nan() {
            *worst = Worst { value, time };
        }
    }
}

impl Reason {
    fn broken_off(time: f64) -> Self {
        Self::whole(time, format!("the run was broken off at t = {} s", short(time, 4)))
    }

    fn whole(time: f64, words: String) -> Self {
        Self { joint: None, measure: None, value: f64::NAN, limit: f64::NAN, time: Some(time), words }
    }
}

impl Accepted {
    /// In words, a limit each: what is accepted and where that is from.
    pub fn words(&self, kinds: &[JointKind]) -> Vec<String> {
        let from = format!("from t = {} s on ({})", short(self.settling, 4), self.because);
        let limited = self.bounds.iter().filter(|bound| bound.limit.iter().any(|limit| limit.is_finite()));
        let bound = |bound: &Bound| {
            let mut limits: Vec<String> = bound.limit.iter().map(|limit| number(*limit)).collect();
            if limits.windows(2).all(|pair| pair[0] == pair[1]) {
                limits.truncate(1);
            }
            let unit = of_joints(bound.measure.measured_in(), "", kinds);
            let from = if bound.measure.is_settled() { format!(" {from}") } else { String::new() };
            let what = bound.measure.what().trim_end_matches(',');
            format!("{what} up to {} {unit}{from}: {}", limits.join(", "), bound.because).replace("  ", " ")
        };
        limited.map(bound).collect()
    }
}

fn number(limit: f64) -> String {
    if limit.is_finite() { short(limit, 4) } else { "any".to_owned() }
}
