//! A single joint under gravity.

use crate::linalg::{Ldl, Matrix, Vector};
use crate::model::{Links, Parameters};
use crate::scalar::{Over, Scalar};

/// One link on a horizontal axis; q = 0 hangs straight down.
#[derive(Clone, Copy, Debug)]
pub struct Pendulum<C> {
    /// Rotational inertia about the joint axis [kg m²].
    pub inertia: C,
    /// m g r [N m]: weight times the distance of the centre of mass from the axis.
    pub weight_moment: C,
}

impl<C: Scalar> Pendulum<C> {
    /// The same pendulum with constants of another type.
    pub fn map<D>(&self, f: impl Fn(C) -> D) -> Pendulum<D> {
        Pendulum { inertia: f(self.inertia), weight_moment: f(self.weight_moment) }
    }
}

impl<C: Scalar> Links<C, 1> for Pendulum<C> {
    type Factor<'a, T: Over<C>>
        = Ldl<T, 1>
    where
        C: 'a;

    #[inline]
    fn mass_matrix<T: Over<C>>(&self, _: &Vector<T, 1>) -> Matrix<T, 1, 1> {
        Matrix([[T::constant(self.inertia)]])
    }

    #[inline]
    fn potential_energy<T: Over<C>>(&self, q: &Vector<T, 1>) -> T {
        (T::ONE - q[0].cos()).scale(self.weight_moment)
    }

    /// The inertia, then the weight moment.
    #[inline]
    fn parameters(&self) -> Parameters<C, 1> {
        let mut parameters = [Vector::ZERO; 10];
        let [first, second, ..] = &mut parameters;
        (*first, *second) = (Vector([self.inertia]), Vector([self.weight_moment]));
        parameters
    }

    #[inline]
    fn regressor_mul<T: Over<C>>(
        &self,
        [inertia, weight_moment, ..]: &Parameters<T, 1>,
        q: &Vector<T, 1>,
        _: &Vector<T, 1>,
        _: &Vector<T, 1>,
        a_r: &Vector<T, 1>,
    ) -> Vector<T, 1> {
        Vector([inertia[0] * a_r[0] + weight_moment[0] * q[0].sin()])
    }

    #[inline]
    fn carrier_rates<T: Over<C>>(&self, _: &Vector<T, 1>, _: &Vector<T, 1>) -> Vector<T, 1> {
        Vector::ZERO
    }

    #[inline]
    fn factor<T: Over<C>>(&self, q: &Vector<T, 1>) -> Ldl<T, 1> {
        self.mass_matrix(q).ldl()
    }
}
