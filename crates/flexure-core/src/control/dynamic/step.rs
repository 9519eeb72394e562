//! How memory gets from one control instant to the next.
#![expect(
    clippy::indexing_slicing,
    reason = "indices run over const dimensions; the no-panic check covers them"
)]

use super::{Applied, DynamicLaw};
use crate::array::filled;
use crate::linalg::{Matrix, Vector, eliminate, eliminate_each};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Dual, Float, Jet, Over, Scalar};

/// Corrections of the memory at the end of a step: the first is exact where the memory is a linear filter, the second takes what is left of mild
/// nonlinearity.
const CORRECTIONS: usize = 2;

/// The memory `z` a `period` in s later: the trapezoidal rule z⁺ = z + T/2 (ż(`before`, z) + ż(`now`, z⁺)), both rates under the torque that was
/// `applied` in between.
///
/// Of a linear filter this is Tustin's, which keeps passivity and is stable for any period. The first `I` parts of z⁺ are found by Newton's method from
/// Euler's step, with the Jacobian of ż by dual numbers; the others, which are slow, by as many corrections without it.
#[inline]
pub fn advanced<const I: usize, C: Scalar, T: Over<C>, L: Links<C, N>, F, const N: usize, const K: usize>(
    law: &F,
    robot: &Fjr<C, L, N>,
    [before, now]: [&Seen<T, N>; 2],
    z: &[Vector<T, N>; K],
    applied: &Applied<T, N>,
    period: T,
) -> [Vector<T, N>; K]
where
    F: DynamicLaw<C, N, K>,
{
    const { assert!(I <= K, "no more parts than there are") }
    let half = period * T::from_ratio(1, 2);
    let at = |seen: &Seen<T, N>, z: &[Vector<T, N>; K]| law.rate(robot, &seen.x, &seen.q_ld, z, applied);
    let first = at(before, z);
    let next = added(z, &first, period);
    let missing = |next: &[Vector<T, N>; K]| -> [Vector<T, N>; K] {
        let last = at(now, next);
        filled(|k| z[k] - next[k] + (first[k] + last[k]).scaled(half))
    };
    let slope = Slope { law, robot, now, z: &next, applied };
    if F::JOINTWISE {
        let matrix = slope.implicit_of_joints(half);
        corrected::<I, _, N, K>(next, missing, |stiff| eliminate_each(matrix, stiff))
    } else {
        let matrix = slope.implicit(half);
        corrected::<I, _, N, K>(next, missing, |stiff| eliminate(matrix, stiff))
    }
}

/// `z` after [`CORRECTIONS`] by what is `missing`, the first `I` parts of it `solved` for.
#[inline]
fn corrected<const I: usize, T: Scalar, const N: usize, const K: usize>(
    mut z: [Vector<T, N>; K],
    missing: impl Fn(&[Vector<T, N>; K]) -> [Vector<T, N>; K],
    solved: impl Fn([Vector<T, N>; I]) -> [Vector<T, N>; I],
) -> [Vector<T, N>; K] {
    for _ in 0..CORRECTIONS {
        let mut correction = missing(&z);
        if let Some(stiff) = correction.first_chunk_mut::<I>() {
            *stiff = solved(*stiff);
        }
        z = added(&z, &correction, T::ONE);
    }
    z
}

/// a + s b.
#[inline]
fn added<T: Scalar, const N: usize, const K: usize>(
    a: &[Vector<T, N>; K],
    b: &[Vector<T, N>; K],
    s: T,
) -> [Vector<T, N>; K] {
    filled(|k| a[k] + b[k].scaled(s))
}

/// Where ż is differentiated.
struct Slope<'a, C, T, L, F, const N: usize, const K: usize> {
    law: &'a F,
    robot: &'a Fjr<C, L, N>,
    now: &'a Seen<T, N>,
    z: &'a [Vector<T, N>; K],
    applied: &'a Applied<T, N>,
}

impl<C: Scalar, T: Over<C>, L: Links<C, N>, F, const N: usize, const K: usize> Slope<'_, C, T, L, F, N, K>
where
    F: DynamicLaw<C, N, K>,
{
    /// ż with how it moves in `M` directions: number i of part k moves at the rate 1 in that which `direction` has for it.
    #[inline]
    fn along<const M: usize>(
        &self,
        direction: impl Fn(usize, usize) -> Option<usize>,
    ) -> [Vector<Dual<T, M>, N>; K] {
        let lift = |v: &Vector<T, N>| v.map(Dual::constant);
        let x = self.now.x.map(Dual::constant);
        let q_ld = self.now.q_ld.map(|q| Jet::from_fn(|k| Dual::constant(q.coefficient(k))));
        let applied = Applied { asked: lift(&self.applied.asked), given: lift(&self.applied.given) };
        let z = filled(|k| {
            Vector::from_fn(|i| {
                let z = self.z[k][i];
                direction(k, i).map_or(Dual::constant(z), |direction| Dual::variable(z, direction))
            })
        });
        self.law.rate(self.robot, &x, &q_ld, &z, &applied)
    }

    /// 1 − T/2 ∂ż/∂z of the first `I` parts in `N` × `N` blocks, a block of columns at a time.
    #[inline]
    fn implicit<const I: usize>(&self, half: T) -> [[Matrix<T, N, N>; I]; I] {
        let mut matrix = [[Matrix::ZERO; I]; I];
        for column in 0..I {
            let rate = self.along::<N>(|k, i| (k == column).then_some(i));
            for (row, (blocks, rate)) in matrix.iter_mut().zip(&rate).enumerate() {
                blocks[column] = Matrix::from_fn(|i, j| {
                    let unit = if row == column && i == j { T::ONE } else { T::ZERO };
                    unit - half * rate[i].gradient[j]
                });
            }
        }
        matrix
    }

    /// The same where no joint moves another's: an `I` × `I` matrix a joint, all of whose columns come at once.
    #[inline]
    fn implicit_of_joints<const I: usize>(&self, half: T) -> [[Vector<T, N>; I]; I] {
        let mut matrix = [[Vector::ZERO; I]; I];
        for column in 0..I {
            let rate = self.along::<1>(|k, _| (k == column).then_some(0));
            for (row, (entries, rate)) in matrix.iter_mut().zip(&rate).enumerate() {
                let unit = if row == column { T::ONE } else { T::ZERO };
                entries[column] = rate.map(|Dual { gradient: [slope], .. }| unit - half * slope);
            }
        }
        matrix
    }
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
        let next = law.advanced(robot, [&self.seen, &now], &self.memory, applied, period);
        if next.iter().all(|part| part.iter().all(C::is_finite)) {
            *self = Self { memory: next, seen: now };
        }
    }
}
