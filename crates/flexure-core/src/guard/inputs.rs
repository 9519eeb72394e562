//! Whether a reading can be believed.

use super::Settings;
use crate::linalg::Vector;
use crate::model::Motion;
use crate::scalar::{Float, Piecewise};

/// Control periods since the encoders of either side last delivered: 0 for a reading of this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Age {
    /// Of the link encoders; 0 where an estimator stands in for them.
    pub link: u32,
    /// Of the motor encoders, in control periods too.
    pub motor: u32,
}

impl Age {
    /// Everything was read at this instant.
    pub const FRESH: Self = Self { link: 0, motor: 0 };
}

/// What is wrong with the reading of one joint on one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Position or velocity is NaN or infinite.
    NotFinite,
    /// The encoder has not delivered for longer than allowed.
    Stale,
    /// Position or velocity is beyond what is believable.
    OutOfBounds,
}

/// Faults of all joints on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Faults<const N: usize> {
    pub link: Vector<Option<Fault>, N>,
    pub motor: Vector<Option<Fault>, N>,
}

impl<const N: usize> Faults<N> {
    #[inline]
    pub fn of<C: Float>(settings: &Settings<C, N>, x: &Motion<C, N>, age: Age) -> Self {
        let side = |q: &Vector<C, N>, v: &Vector<C, N>, age: u32| {
            Vector::from_fn(|i| fault(settings, i, q[i], v[i], age))
        };
        Self { link: side(&x.q_l, &x.v_l, age.link), motor: side(&x.q_m, &x.v_m, age.motor) }
    }

    #[inline]
    pub fn any(&self) -> bool {
        self.link.iter().chain(self.motor.iter()).any(|fault| fault.is_some())
    }
}

#[inline]
fn fault<C: Float, const N: usize>(
    settings: &Settings<C, N>,
    i: usize,
    q: C,
    v: C,
    age: u32,
) -> Option<Fault> {
    if !(q.is_finite() && v.is_finite()) {
        Some(Fault::NotFinite)
    } else if age > settings.allowed_age {
        Some(Fault::Stale)
    } else if Piecewise::abs(q) > settings.position_bound[i] || Piecewise::abs(v) > settings.speed_bound[i] {
        Some(Fault::OutOfBounds)
    } else {
        None
    }
}
