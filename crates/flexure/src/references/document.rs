//! `[reference]`: where the links shall be.

use crate::files::base::Base;
use crate::files::field::{Field, Joints};
use crate::files::quantity;
use crate::files::table::Table;
use crate::references::samples_file as samples;

/// A reference q_ld(t) as data.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// offset_i + Σ_j amplitude_ij sin(frequency_ij t + phase_ij): kinds `sine` (one term) and `multisine`.
    Sines {
        /// Mean position \[rad\].
        offset: Vec<f64>,
        /// At least one.
        terms: Vec<Term>,
    },
    /// From rest to rest along a straight line in joint space: kinds `quintic`, `septic`, `nonic`.
    PointToPoint {
        /// Degree of the polynomial in time.
        profile: Profile,
        /// Position before the motion \[rad\].
        from: Vec<f64>,
        /// Position after the motion \[rad\].
        to: Vec<f64>,
        /// Time of departure, ≥ 0 \[s\].
        start: f64,
        /// Time that the motion takes \[s\].
        duration: f64,
    },
    /// Positions at given times: kind `samples`.
    Samples {
        /// Strictly increasing, 0 and the end of the run among or between them; at least 8 \[s\].
        t: Vec<f64>,
        /// The positions of all joints at each time \[rad\].
        q: Vec<Vec<f64>>,
    },
}

/// One sine a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Amplitude \[rad\].
    pub amplitude: Vec<f64>,
    /// Angular frequency [rad/s].
    pub frequency: Vec<f64>,
    /// Phase at t = 0 \[rad\].
    pub phase: Vec<f64>,
}

/// How a point-to-point motion goes: the polynomial of this degree whose end derivatives vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// Degree 5: two derivatives vanish at the ends.
    Quintic,
    /// Degree 7: three.
    Septic,
    /// Degree 9: four, which is what a law on flexible joints needs for continuous torque.
    Nonic,
}

impl Reference {
    /// Position at t = 0 \[rad\], before any smooth start; straight between samples, the last one after the end.
    pub fn initial(&self) -> Vec<f64> {
        match self {
            Self::Sines { offset, terms } => terms.iter().fold(offset.clone(), |mut sum, term| {
                for (q, (amplitude, phase)) in sum.iter_mut().zip(term.amplitude.iter().zip(&term.phase)) {
                    *q += amplitude * phase.sin();
                }
                sum
            }),
            Self::PointToPoint { from, .. } => from.clone(),
            Self::Samples { t, q } => {
                let next = t.partition_point(|&t| t < 0.0).max(1);
                let (Some([t_a, t_b]), Some([q_a, q_b])) = (t.get(next - 1..=next), q.get(next - 1..=next))
                else {
                    return q.last().cloned().unwrap_or_default();
                };
                let part = -t_a / (t_b - t_a);
                q_a.iter().zip(q_b).map(|(a, b)| a + part * (b - a)).collect()
            }
        }
    }
}

/// Longest time in s in which a moving robot comes to rest if nothing is said: springs swing faster, and a jerk carries the
/// reference on by its cube.
const SETTLE: f64 = 0.25;

/// How the robot joins the reference from where it is and how it moves at t = 0: `[reference.smooth_start]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStart {
    /// Time in which the reference is reached \[s\].
    pub duration: f64,
    /// Time in which the robot's own motion would come to rest; `duration` unless given \[s\].
    pub settle: f64,
}

impl SmoothStart {
    /// Reaching the reference, and the end of the robot's own motion, in `duration` seconds.
    pub const fn within(duration: f64) -> Self {
        Self { duration, settle: duration.min(SETTLE) }
    }
}

/// Another clock for the reference: `[reference.time_scaling]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeScaling {
    /// Seconds of the reference per second of the run.
    pub speed: Speed,
    /// Time in which the clock gets from rest to its speed, if it does not run at it from the start \[s\].
    pub rise: Option<f64>,
}

/// How fast a clock goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// As given, > 0.
    Given(f64),
    /// The largest up to 1 that [`feasible`](crate::feasible) finds for this share of the robot's limits, > 0 and ≤ 1.
    Within(f64),
}

/// A reference with what is done to it.
pub(crate) struct Timed {
    pub reference: Reference,
    pub smooth_start: Option<SmoothStart>,
    pub time_scaling: Option<TimeScaling>,
}

/// A kind of reference: its keys and its reader. One line adds one.
type Reader = (&'static [&'static str], fn(&Table<'_>, &Joints, &Base, f64) -> Option<Reference>);

/// Keys of every kind.
const COMMON: &[&str] = &["kind", "smooth_start", "time_scaling"];

const POINT_TO_POINT: &[&str] = &["from", "to", "start", "duration"];

const KINDS: &[(&str, Reader)] = &[
    ("sine", (&["offset", "amplitude", "frequency", "phase"], sine)),
    ("multisine", (&["offset", "term"], multisine)),
    ("quintic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Quintic))),
    ("septic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Septic))),
    ("nonic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Nonic))),
    ("samples", (&["file"], |table, joints, base, end| samples::read(table, joints, base, end))),
];

/// Reads `[reference]` for a run of `end` seconds (NaN if that is not known).
pub(crate) fn read(field: &Field<'_>, joints: &Joints, base: &Base, end: f64) -> Option<Timed> {
    let table = field.any_table()?;
    let smooth_start = table.optional("smooth_start", smooth_start);
    let time_scaling = table.optional("time_scaling", time_scaling);
    let (own, reader) = table.choice("kind", KINDS)?;
    table.refuse_unknown(&[COMMON, own].concat());
    let speed = match time_scaling {
        Some(Some(TimeScaling { speed: Speed::Given(speed), .. })) => speed,
        _ => 1.0,
    };
    let reference = reader(&table, joints, base, end * speed);
    Some(Timed { reference: reference?, smooth_start: smooth_start?, time_scaling: time_scaling? })
}

fn smooth_start(field: &Field<'_>) -> Option<SmoothStart> {
    let table = field.table(&["duration", "settle"])?;
    let duration = table.number("duration", &quantity::DURATION);
    let settle = table.optional("settle", |field| field.number(&quantity::DURATION));
    let (duration, settle) = (duration?, settle?);
    Some(SmoothStart { duration, settle: settle.unwrap_or(duration.min(SETTLE)) })
}

fn time_scaling(field: &Field<'_>) -> Option<TimeScaling> {
    let table = field.table(&["speed", "margin", "rise"])?;
    let rise = table.optional("rise", |field| field.number(&quantity::DURATION));
    let speed = match (table.get("speed"), table.get("margin")) {
        (Some(speed), None) => speed.number(&quantity::SPEED_OF_TIME).map(Speed::Given),
        (None, Some(margin)) => share(&margin).map(Speed::Within),
        (given, _) => {
            let (what, help) =
                (given.map_or("neither", |_| "both"), "speed = 0.5, or margin = 0.9 to have it found");
            let message =
                format!("{}: {what} of speed and margin are given, must be one of them", field.path);
            field.error("time-scaling", message, help);
            None
        }
    };
    Some(TimeScaling { speed: speed?, rise: rise? })
}

/// A share of limits, up to all of them.
fn share(field: &Field<'_>) -> Option<f64> {
    let share = field.number(&quantity::MARGIN)?;
    if share > 1.0 {
        field.error(
            "range",
            format!("{} is {share}, must be <= 1", field.path),
            quantity::MARGIN.described(),
        );
        return None;
    }
    Some(share)
}

fn sine(table: &Table<'_>, joints: &Joints, _: &Base, _: f64) -> Option<Reference> {
    let offset = table.per_joint_or_zero("offset", joints, &quantity::ANGLE);
    let term = term(table, joints);
    Some(Reference::Sines { offset: offset?, terms: vec![term?] })
}

fn multisine(table: &Table<'_>, joints: &Joints, _: &Base, _: f64) -> Option<Reference> {
    let offset = table.per_joint_or_zero("offset", joints, &quantity::ANGLE);
    let fields = table.required("term", "[[reference.term]], once for each sine")?.tables()?;
    let read = |field: &Field<'_>| term(&field.table(&["amplitude", "frequency", "phase"])?, joints);
    let terms: Vec<_> = fields.iter().map(read).collect();
    Some(Reference::Sines { offset: offset?, terms: terms.into_iter().collect::<Option<_>>()? })
}

fn term(table: &Table<'_>, joints: &Joints) -> Option<Term> {
    let amplitude = table.per_joint("amplitude", joints, &quantity::AMPLITUDE);
    let frequency = table.per_joint("frequency", joints, &quantity::FREQUENCY);
    let phase = table.per_joint_or_zero("phase", joints, &quantity::PHASE);
    Some(Term { amplitude: amplitude?, frequency: frequency?, phase: phase? })
}

fn point_to_point(table: &Table<'_>, joints: &Joints, profile: Profile) -> Option<Reference> {
    let from = table.per_joint("from", joints, &quantity::ANGLE);
    let to = table.per_joint("to", joints, &quantity::ANGLE);
    let start = table.optional("start", |field| field.number(&quantity::START));
    let duration = table.number("duration", &quantity::DURATION);
    Some(Reference::PointToPoint {
        profile,
        from: from?,
        to: to?,
        start: start?.unwrap_or(0.0),
        duration: duration?,
    })
}

#[cfg(test)]
mod tests {
    use super::{Reference, Term};

    #[test]
    fn position_at_the_start() {
        let term =
            |amplitude, phase| Term { amplitude: vec![amplitude], frequency: vec![3.0], phase: vec![phase] };
        let sines = Reference::Sines { offset: vec![0.5], terms: vec![term(2.0, 0.0), term(1.0, 1.0)] };
        assert_eq!(sines.initial(), [0.5 + 1.0_f64.sin()]);
        let t: Vec<f64> = (0..8).map(|i| f64::from(i) - 2.5).collect();
        let samples = Reference::Samples { q: t.iter().map(|t| vec![1.0 + 2.0 * t]).collect(), t };
        assert_eq!(samples.initial(), [1.0]);
    }
}
