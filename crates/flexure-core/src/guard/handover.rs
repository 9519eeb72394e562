//! From the torque of a stop to that of the law without a jump.

use super::Settings;
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::scalar::{Float, Piecewise};

/// Control periods in which the torque goes over to the law's.
const PERIODS: u32 = 10;

/// What acted when the law took over, less what it asked for: added to its torque, and less of it every period.
#[derive(Clone, Copy, Debug)]
pub(super) struct Handover<C, const N: usize> {
    /// At the beginning [N m].
    offset: Vector<C, N>,
    /// Control periods that some of it is left for.
    left: u32,
}

impl<C: Float, const N: usize> Handover<C, N> {
    pub const NONE: Self = Self { offset: Vector([C::ZERO; N]), left: 0 };

    /// From `acting` to `asked` [N m]; none where the law asks for what is no number or beyond the torque limit, or the rate limit
    /// would not allow it to get there.
    #[inline]
    pub fn between(settings: &Settings<C, N>, acting: &Vector<C, N>, asked: &Vector<C, N>) -> Option<Self> {
        let offset = *acting - *asked;
        let is_smooth = (0..N).all(|i| {
            let way = settings.torque_rate_limit[i] * settings.period * periods::<C>(PERIODS);
            let inside = Piecewise::abs(asked[i]) <= settings.torque_limit[i];
            asked[i].is_finite() && inside && Piecewise::abs(offset[i]) <= way
        });
        is_smooth.then_some(Self { offset, left: PERIODS })
    }

    /// The `torque` of the law at the next instant, with what is still added [N m].
    #[inline]
    pub fn next(&mut self, torque: Vector<C, N>) -> Vector<C, N> {
        if self.left == 0 {
            return torque;
        }
        self.left -= 1;
        torque + self.offset.scaled(periods::<C>(self.left) / periods::<C>(PERIODS))
    }

    /// Whether something is still added.
    #[inline]
    pub fn goes_on(&self) -> bool {
        self.left > 0
    }
}

#[inline]
fn periods<C: Float>(count: u32) -> C {
    C::from_f64(f64::from(count))
}

/// The `offset` [N m] and periods `left`.
impl<C: Float, const N: usize> Memory<C> for Handover<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.joints("offset", "N m", &mut self.offset.0);
        port.word("left", &mut self.left);
        self.left = self.left.min(PERIODS);
    }
}
