//! What a law must know of a number type: how to draw an element and when one agrees with an `f64`.

#[cfg(feature = "interval")]
use flexure_core::scalar::Interval;
use flexure_core::scalar::{Dual, Jet, Scalar};
#[cfg(feature = "lanes")]
use flexure_core::scalar::{Lane, Lanes};

use super::oracle::Random;

/// A number type under test.
pub trait Probe: Scalar + PartialEq {
    /// An element whose value is `head` and whose other components are small integers: exact under ring operations.
    fn sample(head: f64, random: &mut Random) -> Self;

    /// Whether the value is `x` to `steps` ulp of `f64` and every derivative zero.
    fn agrees(self, x: f64, steps: f64) -> bool;
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    // Bitwise at zero tolerance, up to the sign of zero.
    a == b || (a - b).abs() <= tolerance * b.abs()
}

impl Probe for f64 {
    fn sample(head: f64, _: &mut Random) -> Self {
        head
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        near(self, x, steps * f64::EPSILON)
    }
}

impl Probe for f32 {
    fn sample(head: f64, _: &mut Random) -> Self {
        Self::from_f64(head)
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        // A float of 24 bits: one step at least for rounding x itself.
        near(f64::from(self), x, (1.0 + steps) * f64::from(Self::EPSILON))
    }
}

#[cfg(feature = "interval")]
impl Probe for Interval {
    fn sample(head: f64, _: &mut Random) -> Self {
        Self::point(head)
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        // Contains what f64 computed if f64's own error is added, and is not much wider.
        let slack = steps * f64::EPSILON * x.abs();
        self.lo() - slack <= x && x <= self.hi() + slack && self.width() <= 4.0 * slack
    }
}

#[cfg(feature = "lanes")]
impl<S: Lane<W> + Probe, const W: usize> Probe for Lanes<S, W> {
    fn sample(head: f64, random: &mut Random) -> Self {
        Self::from_array(std::array::from_fn(|_| S::sample(head, random)))
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        self.to_array().into_iter().all(|lane| lane.agrees(x, steps))
    }
}

impl<S: Probe, const K: usize> Probe for Jet<S, K> {
    fn sample(head: f64, random: &mut Random) -> Self {
        Self::from_fn(|k| S::sample(if k == 0 { head } else { random.integer(3) }, random))
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        (0..K).all(|k| self.coefficient(k).agrees(if k == 0 { x } else { 0.0 }, steps))
    }
}

impl<S: Probe, const M: usize> Probe for Dual<S, M> {
    fn sample(head: f64, random: &mut Random) -> Self {
        let gradient = std::array::from_fn(|_| S::sample(random.integer(3), random));
        Self { value: S::sample(head, random), gradient }
    }
    fn agrees(self, x: f64, steps: f64) -> bool {
        self.value.agrees(x, steps) && self.gradient.into_iter().all(|g| g.agrees(0.0, steps))
    }
}
