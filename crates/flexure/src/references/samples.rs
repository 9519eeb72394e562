//! A smooth trajectory through sampled postures.

use flexure_core::linalg::Vector;
use flexure_core::reference::Reference;
use flexure_core::scalar::{Over, Piecewise, Scalar};
use thiserror::Error;

use crate::references::registry::Instant;
use crate::references::septic::{Segment, interpolate};

/// The septic spline through samples (t_i, q_i), at rest at both ends.
///
/// Of all trajectories through the samples that start and end at rest it is the one with the least ∫ |q_d⁗|² dt, the
/// term of a flexible joint's torque that is hardest to deliver. It is of degree 7 between samples, which need not
/// be evenly spaced, and C⁶ across them. Error: O(h⁸) in position and O(h⁴) in the fourth derivative, where the sampled
/// motion is at rest (three zero derivatives) at both ends.
///
/// Before the first and after the last sample it stays where it is. There it is C³: the ends have zero velocity,
/// acceleration and jerk, and only the fourth derivative jumps (at the end itself it is that of the inside). Samples that
/// begin or end in full motion get a hard stop inside their first or last interval, and an error that alternates and
/// falls by the factor 0.54 a sample: join them with a [`SmoothStart`](flexure_core::reference::SmoothStart) or sample
/// the way to rest too.
///
/// Rounding of the samples by δ shows in the fourth derivative as about 100 δ / h⁴. Samples 10 ms apart give 1e-6 rad/s⁴
/// in full double precision, but 5e3 rad/s⁴ when written with six decimals: sample no finer than the motion asks for,
/// and write all digits.
///
/// ```
/// use flexure::core::linalg::Vector;
/// use flexure::core::reference::Reference;
/// use flexure::references::Samples;
///
/// let path = [(0.0, Vector([0.0])), (0.5, Vector([0.8])), (1.5, Vector([0.2])), (2.0, Vector([0.0]))];
/// let q_d = Samples::new(&path)?;
/// let [jet] = q_d.at::<5>(0.5).0;
/// assert!((jet.derivative(0) - 0.8).abs() < 1e-15);
/// # Ok::<(), flexure::references::SamplesError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Samples<C, const N: usize> {
    end: C,
    /// At least one, in the order of time.
    segments: Vec<Segment<C, N>>,
}

/// Why there is no trajectory through the samples. Samples and joints are counted from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SamplesError {
    /// A trajectory needs a beginning and an end.
    #[error("{found} samples, must be >= 2")]
    TooFew {
        /// Number of samples.
        found: usize,
    },
    /// A time that is not a number, or infinite.
    #[error("time of sample {sample} is {time} s, must be finite")]
    TimeNotFinite {
        /// Which sample.
        sample: usize,
        /// Its time in s.
        time: f64,
    },
    /// A position that is not a number, or infinite.
    #[error("position of joint {joint} in sample {sample} is {position} rad, must be finite")]
    PositionNotFinite {
        /// Which sample.
        sample: usize,
        /// Which joint.
        joint: usize,
        /// Its position in rad.
        position: f64,
    },
    /// Samples out of order, or two at the same time.
    #[error("time of sample {sample} is {time} s, must be > {previous} s, the time of the sample before it")]
    NotIncreasing {
        /// Which sample.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// The time of the sample before it in s.
        previous: f64,
    },
    /// Derivatives up to the sixth leave the range of double precision.
    #[error("derivatives overflow: the shortest interval, after sample {sample}, is {width} s")]
    Overflow {
        /// The sample before the shortest interval.
        sample: usize,
        /// The shortest interval in s.
        width: f64,
    },
}

impl<const N: usize> Samples<f64, N> {
    /// The trajectory through `samples`, pairs of time in s and posture in rad; O(number of samples).
    ///
    /// # Errors
    /// Fewer than two samples, times that do not increase strictly, anything that is not finite, intervals so
    /// short that the derivatives overflow.
    pub fn new(samples: &[(f64, Vector<f64, N>)]) -> Result<Self, SamplesError> {
        for (sample, &(time, q)) in samples.iter().enumerate() {
            if !time.is_finite() {
                return Err(SamplesError::TimeNotFinite { sample, time });
            }
            for (joint, position) in q.iter().enumerate() {
                if !position.is_finite() {
                    return Err(SamplesError::PositionNotFinite { sample, joint, position });
                }
            }
        }
        for (i, pair) in samples.windows(2).enumerate() {
            let (previous, time) = (pair[0].0, pair[1].0);
            if time <= previous {
                return Err(SamplesError::NotIncreasing { sample: i + 1, time, previous });
            }
        }
        let [_, .., (end, _)] = samples else {
            return Err(SamplesError::TooFew { found: samples.len() });
        };
        let segments = interpolate(samples);
        if !segments.iter().all(Segment::is_finite) {
            let widths = samples.windows(2).map(|pair| pair[1].0 - pair[0].0).enumerate();
            let (sample, width) =
                widths.fold((0, f64::INFINITY), |least, w| if w.1 < least.1 { w } else { least });
            return Err(SamplesError::Overflow { sample, width });
        }
        Ok(Self { end: *end, segments })
    }
}

impl<C: Scalar, const N: usize> Samples<C, N> {
    /// The trajectory with its coefficients as constants of another type.
    pub fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Samples<D, N> {
        Samples { end: f(self.end), segments: self.segments.iter().map(|segment| segment.map(&f)).collect() }
    }

    /// Time of the first sample in s.
    pub fn start(&self) -> C {
        self.segments.first().map_or(self.end, |segment| segment.start)
    }

    /// Time of the last sample in s.
    pub fn end(&self) -> C {
        self.end
    }

    /// Times of the samples in s: in between the path is one polynomial.
    pub fn knots(&self) -> impl Iterator<Item = C> + '_ {
        self.segments.iter().map(|segment| segment.start).chain([self.end])
    }

    /// Position in rad at time `t` in s, which is on one of `segments`, before the first or after the last.
    #[inline]
    fn along<T: Over<C> + Piecewise>(&self, segments: &[Segment<C, N>], t: T) -> Vector<T, N> {
        let t = t.clamp(T::constant(self.start()), T::constant(self.end));
        let mut q_d = segments.first().map_or(Vector::ZERO, |first| first.on(t));
        for segment in segments.iter().skip(1) {
            let (after, here) = (t - T::constant(segment.start), segment.on(t));
            q_d = Vector::from_fn(|i| after.select(here[i], q_d[i]));
        }
        q_d
    }

    /// The segments that are needed where `begun` have begun for sure and `possible` may have.
    fn needed(&self, begun: usize, possible: usize) -> &[Segment<C, N>] {
        self.segments.get(begun.saturating_sub(1)..possible.max(1)).unwrap_or_default()
    }
}

impl<C: Instant, const N: usize> Reference<C, N> for Samples<C, N> {
    /// In O(log of the number of samples) and the number of segments that `t` meets.
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let begun = self.segments.partition_point(|segment| segment.start.highest() <= t.lowest());
        let possible = self.segments.partition_point(|segment| segment.start.lowest() <= t.highest());
        self.along(self.needed(begun, possible), t)
    }
}
