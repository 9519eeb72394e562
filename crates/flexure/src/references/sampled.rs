//! Positions at given times.

use flexure_core::scalar::Interval;

use crate::files::{Entry, Places, Problem};
use crate::references::registry::{Context, Instant, Jump, Name, Named, ReferenceKind};
use crate::references::{Reference, Samples, samples_file};
use crate::robot::vector;

/// A path through positions at given times: the kind `samples`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Strictly increasing, 0 and the end of the run among or between them; at least 8 \[s\].
    pub t: Vec<f64>,
    /// The positions of all joints at each time \[rad\].
    pub q: Vec<Vec<f64>>,
}

impl Named for Sampled {
    const NAMES: &'static [Name] = &[Name {
        entry: Entry { name: "samples", summary: "a path from a CSV file through a septic spline" },
        keys: &["file"],
        read: |table, Context { joints, base, end }| {
            let (t, q) = samples_file::read(table, joints, base, *end)?;
            Some(Reference::Sampled(Sampled { t, q }))
        },
    }];
}

impl ReferenceKind for Sampled {
    type Core<C: Instant, const N: usize> = Samples<C, N>;

    /// The spline with the coefficients that floats give it, whatever `number` makes of decimals: samples are measured or
    /// computed, not meant to the last digit.
    fn core<C: Instant, const N: usize>(
        &self,
        _: &dyn Fn(f64) -> C,
        places: &Places,
    ) -> Result<Samples<C, N>, Problem> {
        let samples: Vec<_> = self.t.iter().copied().zip(self.q.iter().map(|q| vector(q))).collect();
        let spline = Samples::new(&samples).map_err(|error| {
            let help = "the path must be a smooth motion: check the numbers of that sample";
            places.problem("reference.file", "samples", error.to_string(), help)
        })?;
        Ok(spline.map(C::from_f64))
    }

    /// Straight between samples; the last one after the end.
    fn initial(&self) -> Vec<f64> {
        let Self { t, q } = self;
        let next = t.partition_point(|&t| t < 0.0).max(1);
        let (Some([t_a, t_b]), Some([q_a, q_b])) = (t.get(next - 1..=next), q.get(next - 1..=next)) else {
            return q.last().cloned().unwrap_or_default();
        };
        let part = -t_a / (t_b - t_a);
        q_a.iter().zip(q_b).map(|(a, b)| a + part * (b - a)).collect()
    }

    /// The run ends where the samples do, or before.
    fn jump(&self) -> Option<Jump> {
        None
    }

    /// Between the samples derivatives are continuous up to the rounding of coefficients only, so that all of them count.
    fn breaks<const N: usize>(path: &Samples<Interval, N>) -> Vec<Interval> {
        path.knots().collect()
    }

    fn kinks<const N: usize>(_: &Samples<Interval, N>) -> Vec<Interval> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{ReferenceKind, Sampled};

    #[test]
    fn position_at_the_start() {
        let t: Vec<f64> = (0..8).map(|i| f64::from(i) - 2.5).collect();
        let samples = Sampled { q: t.iter().map(|t| vec![1.0 + 2.0 * t]).collect(), t };
        assert_eq!(samples.initial(), [1.0]);
    }
}
