//! Sines, and sums of them.

use flexure_core::reference::{self, Multisine};
use flexure_core::scalar::Interval;

use crate::files::field::Field;
use crate::files::quantity;
use crate::files::table::Table;
use crate::files::{Entry, Places, Problem};
use crate::references::Reference;
use crate::references::registry::{Context, Instant, Jump, Name, Named, ReferenceKind};
use crate::robot::vector;

/// offset_i + Σ_j amplitude_ij sin(frequency_ij t + phase_ij): the kinds `sine`, with one term, and `multisine`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sines {
    /// Mean position \[rad\].
    pub offset: Vec<f64>,
    /// At least one.
    pub terms: Vec<Term>,
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

impl Named for Sines {
    const NAMES: &'static [Name] = &[
        Name {
            entry: Entry { name: "sine", summary: "offset + amplitude sin(frequency t + phase), per joint" },
            keys: &["offset", "amplitude", "frequency", "phase"],
            read: sine,
        },
        Name {
            entry: Entry { name: "multisine", summary: "offset + a sum of sines, per joint" },
            keys: &["offset", "term"],
            read: multisine,
        },
    ];
}

fn sine(table: &Table<'_>, context: &Context<'_>) -> Option<Reference> {
    let offset = table.per_joint_or_zero("offset", context.joints, &quantity::ANGLE);
    let term = term(table, context);
    Some(Reference::Sines(Sines { offset: offset?, terms: vec![term?] }))
}

fn multisine(table: &Table<'_>, context: &Context<'_>) -> Option<Reference> {
    let offset = table.per_joint_or_zero("offset", context.joints, &quantity::ANGLE);
    let fields = table.required("term", "[[reference.term]], once for each sine")?.tables()?;
    let read = |field: &Field<'_>| term(&field.table(&["amplitude", "frequency", "phase"])?, context);
    let terms: Vec<_> = fields.iter().map(read).collect();
    Some(Reference::Sines(Sines { offset: offset?, terms: terms.into_iter().collect::<Option<_>>()? }))
}

fn term(table: &Table<'_>, Context { joints, .. }: &Context<'_>) -> Option<Term> {
    let amplitude = table.per_joint("amplitude", joints, &quantity::AMPLITUDE);
    let frequency = table.per_joint("frequency", joints, &quantity::FREQUENCY);
    let phase = table.per_joint_or_zero("phase", joints, &quantity::PHASE);
    Some(Term { amplitude: amplitude?, frequency: frequency?, phase: phase? })
}

impl ReferenceKind for Sines {
    type Core<C: Instant, const N: usize> = Multisine<C, Vec<reference::Term<C, N>>, N>;

    fn core<C: Instant, const N: usize>(
        &self,
        number: &dyn Fn(f64) -> C,
        _: &Places,
    ) -> Result<Self::Core<C, N>, Problem> {
        let term = |term: &Term| reference::Term {
            amplitude: vector(&term.amplitude).map(number),
            frequency: vector(&term.frequency).map(number),
            phase: vector(&term.phase).map(number),
        };
        Ok(Multisine {
            offset: vector(&self.offset).map(number),
            terms: self.terms.iter().map(term).collect(),
        })
    }

    fn initial(&self) -> Vec<f64> {
        self.terms.iter().fold(self.offset.clone(), |mut sum, term| {
            for (q, (amplitude, phase)) in sum.iter_mut().zip(term.amplitude.iter().zip(&term.phase)) {
                *q += amplitude * phase.sin();
            }
            sum
        })
    }

    fn jump(&self) -> Option<Jump> {
        None
    }

    fn breaks<const N: usize>(_: &Self::Core<Interval, N>) -> Vec<Interval> {
        Vec::new()
    }

    fn kinks<const N: usize>(_: &Self::Core<Interval, N>) -> Vec<Interval> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{ReferenceKind, Sines, Term};

    #[test]
    fn position_at_the_start() {
        let term =
            |amplitude, phase| Term { amplitude: vec![amplitude], frequency: vec![3.0], phase: vec![phase] };
        let sines = Sines { offset: vec![0.5], terms: vec![term(2.0, 0.0), term(1.0, 1.0)] };
        assert_eq!(sines.initial(), [0.5 + 1.0_f64.sin()]);
    }
}
