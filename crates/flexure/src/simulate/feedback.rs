//! Laws as a loop asks them.

use flexure_core::control::{Applied, Seen};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::laws::{self, AnyLaw, LawMemory, PARTS};

/// A law as the loop asks it.
pub trait Feedback<L, const N: usize> {
    /// Motor torque [N m] for the robot `robot` that moves as `x` at the time `t` in s, with the reference `q_ld` in rad to
    /// order 4 and the memory `z`; with that of a loop that starts there if there is none yet.
    fn torque(
        &self,
        robot: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
        z: Option<&LawMemory<f64, N>>,
    ) -> Vector<f64, N>;

    /// What it keeps from one instant to the next: names and units, a number per joint each.
    fn memory(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// The memory that a loop starts with.
    fn start(&self, _: &Fjr<f64, L, N>, _: &Motion<f64, N>, _: &Vector<Jet<f64, 5>, N>) -> LawMemory<f64, N> {
        [Vector::ZERO; PARTS]
    }

    /// The memory a `period` in s after it was `z`.
    fn advanced(
        &self,
        _: &Fjr<f64, L, N>,
        _seen: [&Seen<f64, N>; 2],
        z: &LawMemory<f64, N>,
        _: &Applied<f64, N>,
        _period: f64,
    ) -> LawMemory<f64, N> {
        *z
    }
}

impl<L: Links<f64, N>, const N: usize> Feedback<L, N> for AnyLaw<f64, N> {
    fn torque(
        &self,
        robot: &Fjr<f64, L, N>,
        _: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
        z: Option<&LawMemory<f64, N>>,
    ) -> Vector<f64, N> {
        match z {
            Some(z) => laws::torque(self, robot, x, q_ld, z),
            None if self.memory().is_empty() => {
                laws::torque(self, robot, x, q_ld, const { &[Vector::ZERO; PARTS] })
            }
            None => laws::torque(self, robot, x, q_ld, &laws::start(self, robot, x, q_ld)),
        }
    }

    fn memory(&self) -> &'static [(&'static str, &'static str)] {
        Self::memory(self)
    }

    fn start(
        &self,
        robot: &Fjr<f64, L, N>,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> LawMemory<f64, N> {
        laws::start(self, robot, x, q_ld)
    }

    fn advanced(
        &self,
        robot: &Fjr<f64, L, N>,
        seen: [&Seen<f64, N>; 2],
        z: &LawMemory<f64, N>,
        applied: &Applied<f64, N>,
        period: f64,
    ) -> LawMemory<f64, N> {
        laws::advanced(self, robot, seen, z, applied, period)
    }
}

/// A law that brings its own model along.
impl<L, F, const N: usize> Feedback<L, N> for F
where
    F: Fn(f64, &Motion<f64, N>, &Vector<Jet<f64, 5>, N>) -> Vector<f64, N>,
{
    fn torque(
        &self,
        _: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
        _: Option<&LawMemory<f64, N>>,
    ) -> Vector<f64, N> {
        self(t, x, q_ld)
    }
}
