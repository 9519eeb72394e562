//! A metric that counts position errors for more where tanh is flat.

use crate::control::Shaping;
use crate::linalg::{Matrix, Vector};
use crate::model::Links;
use crate::scalar::{Over, Piecewise, Scalar};

use super::{ErrorLoop, MatrixField};

/// r(x) > 0, even in the error x, by which lengths of position errors are stretched: with P = Π r² in place of Π, φ = Λ tanh alone
/// contracts at max(b, sech² x) Λ instead of sech² x Λ, however large x is.
///
/// r is constant up to x* with sech² x* = b, and beyond it grows as f = sinh^b / tanh. So r'/r = (b − sech² x)/tanh x there and 0 before: it
/// does not jump, and grows to b. Over the errors that are looked at r runs from 1/√ρ to √ρ: then P is never farther from Π, the metric in
/// which the coupling with momenta cancels, than at the ends, 0 and the largest error.
///
/// ```
/// use flexure_core::contraction::Stretch;
/// use flexure_core::scalar::Dual;
/// let (b, x) = (0.25_f64, 2.0_f64);
/// let stretch = Stretch::tanh(b, x);
/// let r = stretch.at(Dual::<f64, 1>::variable(x, 0));
/// let growth = r.gradient[0] / r.value;
/// assert!((growth - (b - x.cosh().powi(-2)) / x.tanh()).abs() < 1e-14);
/// assert!((stretch.at(0.1) * r.value - 1.0).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stretch<C>(Option<Beyond<C>>);

/// Where and how r grows.
#[derive(Clone, Copy, Debug)]
struct Beyond<C> {
    /// b.
    exponent: C,
    /// x* in rad.
    knee: C,
    /// ln f where r = 1.
    level: C,
}

impl<C: Scalar> Stretch<C> {
    /// r = 1 everywhere.
    pub const NONE: Self = Self(None);

    /// r for the share `b` of the slope at no error, 0 < b < 1, and errors of up to `largest` > 0 in rad.
    #[inline]
    pub fn tanh(b: C, largest: C) -> Self
    where
        C: Piecewise,
    {
        let knee = ((C::ONE + (C::ONE - b).sqrt()) / b.sqrt()).ln();
        let level = (rise(b, knee) + rise(b, largest.max(knee))) * C::from_f64(0.5);
        Self(Some(Beyond { exponent: b, knee, level }))
    }

    /// r at the error `x` in rad.
    #[inline]
    pub fn at<T: Over<C> + Piecewise>(&self, x: T) -> T {
        match self.0 {
            None => T::ONE,
            Some(Beyond { exponent, knee, level }) => {
                (rise(T::constant(exponent), x.abs().max(T::constant(knee))) - T::constant(level)).exp()
            }
        }
    }
}

/// ln f at y > 0: b ln sinh y − ln tanh y.
#[inline]
fn rise<T: Scalar>(exponent: T, y: T) -> T {
    let tanh = y.tanh().ln();
    exponent * (tanh + y.ln_cosh()) - tanh
}

/// An [`ErrorLoop`] measured by diag(Π_l r_l², Π_m r_m², M_l⁻¹, M_m⁻¹): a [`MatrixField`]. Lines between two errors that are straight in
/// the coordinates ∫ √Π r dx are shortest, so that of any box around 0 no shortest line leaves it.
#[derive(Clone, Copy, Debug)]
pub struct StretchedLoop<'a, C, L, Pl, Pm, const N: usize> {
    /// The loop, and its own metric.
    pub error_loop: ErrorLoop<'a, C, L, Pl, Pm, N>,
    /// r_l, joint by joint.
    pub link: [Stretch<C>; N],
    /// r_m, joint by joint.
    pub motor: [Stretch<C>; N],
}

impl<C, L, Pl, Pm, const N: usize, const D: usize> MatrixField<C, D> for StretchedLoop<'_, C, L, Pl, Pm, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let mut metric = self.error_loop.at(x, t);
        let stretches = self.link.iter().chain(&self.motor).zip(x.iter());
        for ((i, row), (stretch, error)) in metric.0.iter_mut().enumerate().zip(stretches) {
            if let Some(entry) = row.get_mut(i) {
                *entry *= stretch.at(error).square();
            }
        }
        metric
    }
}
