//! How memory gets from one control instant to the next.

use super::{Applied, DynamicLaw};
use crate::linalg::{Matrix, Vector, eliminate};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Dual, Float, Jet, Over, Scalar};

/// Corrections of the memory at the end of a step: the first is exact where the memory is a linear filter, the second takes what is left of mild
/// nonlinearity.
const CORRECTIONS: usize = 2;

/// The memory `z` a `period` in s later: the trapezoidal rule z⁺ = z + T/2 (ż(`before`, z) + ż(`now`, z⁺)), both rates under the torque that was
/// `applied` in between.
///
/// Of a linear filter this is Tustin's, which keeps passivity and is stable for any period. The first `I` parts of z⁺ are found by Newton's method from Euler's
/// step, with the Jacobian of ż by dual numbers; the others, which are slow, by as many corrections without it.
#[inline]
pub fn advanced<const I: usize, C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize, const K: usize>(
    law: &impl DynamicLaw<C, N, K>,
    robot: &Fjr<C, L, N>,
    before: &Seen<T, N>,
    now: &Seen<T, N>,
    z: &[Vector<T, N>; K],
    applied: &Applied<T, N>,
    period: T,
) -> [Vector<T, N>; K] {
    const { assert!(I <= K, "no more parts than there are") }
    let half = period * T::from_ratio(1, 2);
    let at = |seen: &Seen<T, N>, z: &[Vector<T, N>; K]| law.rate(robot, &seen.x, &seen.q_ld, z, applied);
    let first = at(before, z);
    let mut next = added(z, &first, period);
    let matrix = implicit::<I, _, _, _, N, K>(law, robot, now, &next, applied, half);
    for _ in 0..CORRECTIONS {
        let last = at(now, &next);
        let mut missing: [Vector<T, N>; K] =
            core::array::from_fn(|k| z[k] - next[k] + (first[k] + last[k]).scaled(half));
        if let Some(stiff) = missing.first_chunk_mut::<I>() {
            *stiff = eliminate(matrix, *stiff);
        }
        next = added(&next, &missing, T::ONE);
    }
    next
}

/// a + s b.
#[inline]
fn added<T: Scalar, const N: usize, const K: usize>(
    a: &[Vector<T, N>; K],
    b: &[Vector<T, N>; K],
    s: T,
) -> [Vector<T, N>; K] {
    core::array::from_fn(|k| a[k] + b[k].scaled(s))
}

/// 1 − T/2 ∂ż/∂z of the first `I` parts in `N` × `N` blocks, a block of columns at a time.
#[inline]
fn implicit<const I: usize, C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize, const K: usize>(
    law: &impl DynamicLaw<C, N, K>,
    robot: &Fjr<C, L, N>,
    now: &Seen<T, N>,
    z: &[Vector<T, N>; K],
    applied: &Applied<T, N>,
    half: T,
) -> [[Matrix<T, N, N>; I]; I] {
    let lift = |v: &Vector<T, N>| v.map(Dual::<T, N>::constant);
    let x = now.x.map(Dual::constant);
    let q_ld = now.q_ld.map(|q| Jet::from_fn(|k| Dual::constant(q.coefficient(k))));
    let applied = Applied { asked: lift(&applied.asked), given: lift(&applied.given) };
    let mut matrix = [[Matrix::ZERO; I]; I];
    for column in 0..I {
        let seeded = core::array::from_fn(|k| {
            if k == column { Vector::from_fn(|i| Dual::variable(z[k][i], i)) } else { lift(&z[k]) }
        });
        let rate = law.rate(robot, &x, &q_ld, &seeded, &applied);
        for (row, (blocks, rate)) in matrix.iter_mut().zip(&rate).enumerate() {
            blocks[column] = Matrix::from_fn(|i, j| {
                let unit = if row == column && i == j { T::ONE } else { T::ZERO };
                unit - half * rate[i].gradient[j]
            });
        }
    }
    matrix
}

/// What a law sees at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Seen<T, const N: usize> {
    /// How the robot moves.
    pub x: Motion<T, N>,
    /// Where the links shall be in rad, to order 4.
    pub q_ld: Vector<Jet<T, 5>, N>,
}

/// The memory of a law that runs.
#[derive(Clone, Copy, Debug)]
pub struct Running<C, const N: usize, const K: usize> {
    /// z of the law at the last instant.
    pub memory: [Vector<C, N>; K],
    seen: Seen<C, N>,
}

impl<C: Float, const N: usize, const K: usize> Running<C, N, K> {
    /// The memory with which `law` starts on a robot that moves as `x`, without a jump.
    #[inline]
    pub fn start<L: Links<C, N>>(
        law: &impl DynamicLaw<C, N, K>,
        robot: &Fjr<C, L, N>,
        x: &Motion<C, N>,
        q_ld: &Vector<Jet<C, 5>, N>,
    ) -> Self {
        Self { memory: law.start(robot, x, q_ld), seen: Seen { x: *x, q_ld: *q_ld } }
    }

    /// Takes the memory to an instant `period` in s after the last one, at which the robot moves as `x`; `applied` is what the motors got in between.
    /// A motion that the law reads and that is no number leaves the memory as it was.
    #[inline]
    pub fn advance<L: Links<C, N>>(
        &mut self,
        law: &impl DynamicLaw<C, N, K>,
        robot: &Fjr<C, L, N>,
        x: &Motion<C, N>,
        q_ld: &Vector<Jet<C, 5>, N>,
        applied: &Applied<C, N>,
        period: C,
    ) {
        let now = Seen { x: *x, q_ld: *q_ld };
        let next = law.advanced(robot, &self.seen, &now, &self.memory, applied, period);
        if next.iter().all(|part| part.iter().all(C::is_finite)) {
            *self = Self { memory: next, seen: now };
        }
    }
}
