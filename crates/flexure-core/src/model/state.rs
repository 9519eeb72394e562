//! Where a flexible-joint robot is and how it moves.

use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// The state x = (q_l, q_m, p_l, p_m) in positions and momenta. Its time derivative has the same shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S, const N: usize> {
    /// Link positions in rad.
    pub q_l: Vector<S, N>,
    /// Motor positions in rad, on the link side of the gear.
    pub q_m: Vector<S, N>,
    /// Link momenta M_l q̇_l [kg m²/s].
    pub p_l: Vector<S, N>,
    /// Motor momenta M_m q̇_m [kg m²/s].
    pub p_m: Vector<S, N>,
}

/// The same state in positions and velocities: what sensors give and controllers take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S, const N: usize> {
    /// Link positions in rad.
    pub q_l: Vector<S, N>,
    /// Motor positions in rad, on the link side of the gear.
    pub q_m: Vector<S, N>,
    /// Link velocities [rad/s].
    pub v_l: Vector<S, N>,
    /// Motor velocities [rad/s].
    pub v_m: Vector<S, N>,
}

impl<S: Scalar, const N: usize> State<S, N> {
    /// The state as numbers of another type, every component through `f`.
    #[inline]
    pub fn map<T: Copy>(&self, f: impl Fn(S) -> T) -> State<T, N> {
        State { q_l: self.q_l.map(&f), q_m: self.q_m.map(&f), p_l: self.p_l.map(&f), p_m: self.p_m.map(&f) }
    }
}

impl<S: Scalar, const N: usize> Motion<S, N> {
    /// At rest with links and motors at `q` in rad: springs relaxed.
    #[inline]
    pub fn at_rest(q: Vector<S, N>) -> Self {
        Self { q_l: q, q_m: q, v_l: Vector::ZERO, v_m: Vector::ZERO }
    }

    /// Spring deflection ζ = q_m − q_l in rad.
    #[inline]
    pub fn deflection(&self) -> Vector<S, N> {
        self.q_m - self.q_l
    }

    /// The motion as numbers of another type, every component through `f`.
    #[inline]
    pub fn map<T: Copy>(&self, f: impl Fn(S) -> T) -> Motion<T, N> {
        Motion { q_l: self.q_l.map(&f), q_m: self.q_m.map(&f), v_l: self.v_l.map(&f), v_m: self.v_m.map(&f) }
    }

    /// The motion as constants of a number type over `S`.
    #[inline]
    pub fn lift<T: Over<S>>(&self) -> Motion<T, N> {
        self.map(T::constant)
    }
}
