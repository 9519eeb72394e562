//! The position blocks: ∂φ against Π on one side. Every registered φ is affine in the slopes of its tanh, so that the
//! vertices of their ranges cover all errors.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{CertifiedPhi, DecimalGains, bounds};
use crate::prove::engine::rate::Inequality;
use crate::prove::engine::shaping::Numbers;

/// φ and Π of one side, enclosed.
#[derive(Clone, Debug)]
pub struct Position {
    phi: CertifiedPhi,
    metric: Vec<Interval>,
    numbers: Numbers,
    /// Largest |q̃_i|; none for no bound.
    error: Vec<Option<Interval>>,
}

/// Whether a case takes each slope at the upper end of its range.
pub type Ends = Vec<bool>;

impl Position {
    /// From the gains of a side and the largest errors on it in rad.
    pub fn new(phi: CertifiedPhi, gains: &DecimalGains, error: &[Option<Interval>]) -> Self {
        Self { phi, metric: bounds(&gains.metric), numbers: Numbers::new(gains), error: error.to_vec() }
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.metric.len()
    }

    /// How many cases cover every error; their number doubles with each joint that φ couples.
    pub fn case_count(&self) -> usize {
        self.phi.certified().case_count(self.joints())
    }

    /// The cases that cover every error: all of them for a φ that couples joints, the slowest slopes where each joint
    /// is for itself, one where slopes are constant.
    pub fn cases(&self) -> Vec<Ends> {
        self.phi.certified().cases(self.joints())
    }

    /// Slopes of tanh at the `ends` of their range: sech² R = 4 t/(1 + t)² with t = e^(−2R), in which nothing cancels, and 1.
    pub fn slopes(&self, ends: &[bool]) -> Vec<Interval> {
        self.at(ends, |error| {
            let t = (-(error + error)).exp();
            t * Interval::point(4.0) / (Interval::ONE + t).square()
        })
    }

    /// Chords tanh(e)/e at the `ends` of their range: that of R, and 1.
    pub fn chords(&self, ends: &[bool]) -> Vec<Interval> {
        self.at(ends, |error| error.tanh() / error)
    }

    fn at(&self, ends: &[bool], lowest: impl Fn(Interval) -> Interval) -> Vec<Interval> {
        let end = |(&high, error): (&bool, &Option<Interval>)| match error {
            _ if high => Interval::ONE,
            Some(error) => lowest(*error),
            None => Interval::ZERO,
        };
        ends.iter().zip(&self.error).map(end).collect()
    }

    /// ∂φ_ij with the slopes (or chords) `a` of tanh; those that do not occur may be left out.
    pub fn slope(&self, a: &[Interval], i: usize, j: usize) -> Interval {
        self.phi.certified().slope(&self.numbers, a, i, j)
    }

    /// sym(Π ∂φ) − β Π with the slopes (or chords) `a`.
    pub fn inequality(&self, a: &[Interval]) -> Inequality {
        let half = Interval::point(0.5);
        let n = self.joints();
        let entry = |i: usize, j: usize| {
            if i == j {
                return self.metric[i] * self.slope(a, i, i);
            }
            half * (self.metric[i] * self.slope(a, i, j) + self.metric[j] * self.slope(a, j, i))
        };
        Inequality { form: Symmetric::from_fn(n, entry), weight: Symmetric::diagonal(&self.metric) }
    }

    /// An entry of −Θ ∂φ Θ⁻¹ with Θ² = Π.
    fn generalised(&self, a: &[Interval], i: usize, j: usize) -> Interval {
        let slope = self.slope(a, i, j);
        if i == j { -slope } else { -(self.metric[i] / self.metric[j]).sqrt() * slope }
    }

    /// An upper bound of the matrix measure μ_1 (`columns`) or μ_∞ of −Θ ∂φ Θ⁻¹ over the region [1/s].
    pub fn measure(&self, columns: bool) -> f64 {
        let n = self.joints();
        let (low, high) = (self.slopes(&vec![false; n]), self.slopes(&vec![true; n]));
        let a: Vec<Interval> = low.iter().zip(high).map(|(low, high)| low.hull(high)).collect();
        let sum = |i: usize| {
            (0..n).fold(Interval::ZERO, |sum, j| {
                let entry = if columns { self.generalised(&a, j, i) } else { self.generalised(&a, i, j) };
                sum + if i == j { entry } else { Interval::point(entry.magnitude()) }
            })
        };
        (0..n).map(|i| sum(i).hi()).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether errors have bounds on all joints that are `far` out.
    pub fn bounded(&self, far: &[bool]) -> bool {
        far.iter().zip(&self.error).all(|(&far, error)| !far || error.is_some())
    }

    /// An error inside the region in rad: the largest on each joint that is `far` out, 1 where there is none, else 0.
    pub fn error_at(&self, far: &[bool]) -> Vec<f64> {
        let entry = |(&far, error): (&bool, &Option<Interval>)| match (far, error) {
            (false, _) => 0.0,
            (true, Some(error)) if error.width() == 0.0 => error.lo(),
            // Its shortest decimal still lies inside.
            (true, Some(error)) => error.lo().next_down().next_down(),
            (true, None) => 1.0,
        };
        far.iter().zip(&self.error).map(entry).collect()
    }

    /// Slopes of tanh at the error `e` in rad.
    pub fn slopes_at(e: &[f64]) -> Vec<Interval> {
        e.iter().map(|&e| Interval::ONE - Interval::point(e).tanh().square()).collect()
    }

    /// Π_i.
    pub fn metric(&self, i: usize) -> Interval {
        self.metric[i]
    }
}
