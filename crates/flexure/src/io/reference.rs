//! `[reference]`: where the links shall be.

use super::base::Base;
use super::field::{Field, Joints};
use super::quantity;
use super::samples;
use super::table::Table;

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

/// A kind of reference: its keys and its reader. One line adds one.
type Reader = (&'static [&'static str], fn(&Table<'_>, &Joints, &Base, f64) -> Option<Reference>);

const POINT_TO_POINT: &[&str] = &["kind", "smooth_start", "from", "to", "start", "duration"];

const KINDS: &[(&str, Reader)] = &[
    ("sine", (&["kind", "smooth_start", "offset", "amplitude", "frequency", "phase"], sine)),
    ("multisine", (&["kind", "smooth_start", "offset", "term"], multisine)),
    ("quintic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Quintic))),
    ("septic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Septic))),
    ("nonic", (POINT_TO_POINT, |table, joints, _, _| point_to_point(table, joints, Profile::Nonic))),
    (
        "samples",
        (&["kind", "smooth_start", "file"], |table, joints, base, end| {
            samples::read(table, joints, base, end)
        }),
    ),
];

/// Reads `[reference]` for a run of `end` seconds (NaN if that is not known), and the time of its smooth start \[s\].
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
pub(super) fn read(
    field: &Field<'_>,
    joints: &Joints,
    base: &Base,
    end: f64,
) -> (Option<Reference>, Option<Option<f64>>) {
    let Some(table) = field.any_table() else { return (None, None) };
    let smooth_start = table.optional("smooth_start", |field| {
        field.table(&["duration"])?.number("duration", &quantity::DURATION)
    });
    let Some((known, reader)) = table.choice("kind", KINDS) else { return (None, smooth_start) };
    table.refuse_unknown(known);
    (reader(&table, joints, base, end), smooth_start)
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
