//! Torque limit and torque-rate limit.

use super::Settings;
use crate::linalg::Vector;
use crate::scalar::{Float, Piecewise};

/// A torque inside the limits, and which of them were active.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowed<C, const N: usize> {
    pub torque: Vector<C, N>,
    pub torque_limited: Vector<bool, N>,
    pub rate_limited: Vector<bool, N>,
}

/// The torque nearest to what is `asked` [N m], finite, that the limits allow after `last` [N m], which is inside them.
///
/// The rate limit moves from `last` towards a torque inside the torque limit, so it can not lead out of that. There is no
/// memory but `last`: the torque is that of the law as soon as both limits allow it.
#[inline]
pub(super) fn allowed<C: Float, const N: usize>(
    settings: &Settings<C, N>,
    last: &Vector<C, N>,
    asked: &Vector<C, N>,
) -> Allowed<C, N> {
    let inside = Vector::<C, N>::from_fn(|i| {
        let limit = settings.torque_limit[i];
        Piecewise::clamp(asked[i], -limit, limit)
    });
    let torque = Vector::<C, N>::from_fn(|i| {
        let step = settings.torque_rate_limit[i] * settings.period;
        Piecewise::clamp(inside[i], last[i] - step, last[i] + step)
    });
    Allowed {
        torque,
        torque_limited: Vector::from_fn(|i| inside[i] != asked[i]),
        rate_limited: Vector::from_fn(|i| torque[i] != inside[i]),
    }
}
