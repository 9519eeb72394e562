//! The planar two-link arm in closed form.

use crate::linalg::{Ldl, Matrix, Vector};
use crate::model::{Links, Parameters};
use crate::scalar::{Over, Scalar};

/// Two links in a horizontal plane: the paper's arm. M_l = [[a1 + a2 + 2 b c2, a2 + b c2], [a2 + b c2, a2]].
#[derive(Clone, Copy, Debug)]
pub struct PlanarTwoLink<C> {
    a1: C,
    a2: C,
    b: C,
}

impl<C: Scalar> PlanarTwoLink<C> {
    /// From masses in kg, the length of the first link in m, distances of the centres of mass from the joints in m and
    /// rotational inertias about the centres of mass [kg m²].
    pub fn new(mass: [C; 2], length: C, com: [C; 2], inertia: [C; 2]) -> Self {
        let ([m1, m2], [r1, r2], [i1, i2]) = (mass, com, inertia);
        Self {
            a1: m1 * r1.square() + m2 * length.square() + i1,
            a2: m2 * r2.square() + i2,
            b: m2 * length * r2,
        }
    }

    /// The same arm with constants of another type.
    pub fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> PlanarTwoLink<D> {
        PlanarTwoLink { a1: f(self.a1), a2: f(self.a2), b: f(self.b) }
    }

    /// The mass matrix where the elbow's angle has the cosine `c2`.
    #[inline]
    fn mass<T: Over<C>>(&self, c2: T) -> Matrix<T, 2, 2> {
        mass([self.a1, self.a2].map(T::constant), c2.scale(self.b))
    }
}

/// The mass matrix from a1, a2 and b c2.
#[inline]
fn mass<T: Scalar>([a1, a2]: [T; 2], coupling: T) -> Matrix<T, 2, 2> {
    let off_diagonal = a2 + coupling;
    Matrix([[a1 + coupling + off_diagonal, off_diagonal], [off_diagonal, a2]])
}

/// C v_r with the Christoffel matrix C = h [[v2, v1 + v2], [−v1, 0]], h = −b s2.
#[inline]
fn coriolis<T: Scalar>(h: T, v: &Vector<T, 2>, v_r: &Vector<T, 2>) -> Vector<T, 2> {
    Vector([h * (v[1] * v_r[0] + (v[0] + v[1]) * v_r[1]), -(h * v[0] * v_r[0])])
}

impl<C: Scalar> Links<C, 2> for PlanarTwoLink<C> {
    type Factor<'a, T: Over<C>>
        = Ldl<T, 2>
    where
        C: 'a;

    #[inline]
    fn mass_matrix<T: Over<C>>(&self, q: &Vector<T, 2>) -> Matrix<T, 2, 2> {
        self.mass(q[1].cos())
    }

    #[inline]
    fn potential_energy<T: Over<C>>(&self, _: &Vector<T, 2>) -> T {
        T::ZERO
    }

    /// The second motor sits on the first link.
    #[inline]
    fn carrier_rates<T: Over<C>>(&self, _: &Vector<T, 2>, v: &Vector<T, 2>) -> Vector<T, 2> {
        Vector([T::ZERO, v[0]])
    }

    #[inline]
    fn gravity_torque<T: Over<C>>(&self, _: &Vector<T, 2>) -> Vector<T, 2> {
        Vector::ZERO
    }

    /// With one sine and cosine for M and C.
    #[inline]
    fn inertial_torque<T: Over<C>>(
        &self,
        q: &Vector<T, 2>,
        v: &Vector<T, 2>,
        v_r: &Vector<T, 2>,
        a_r: &Vector<T, 2>,
    ) -> Vector<T, 2> {
        let (s2, c2) = q[1].sin_cos();
        self.mass(c2) * *a_r + coriolis(-s2.scale(self.b), v, v_r)
    }

    /// (a1, a2), then (b, 0).
    #[inline]
    fn parameters(&self) -> Parameters<C, 2> {
        let mut parameters = [Vector::ZERO; 10];
        let [first, second, ..] = &mut parameters;
        *first = Vector([self.a1, self.a2]);
        *second = Vector([self.b, C::ZERO]);
        parameters
    }

    #[inline]
    fn regressor_mul<T: Over<C>>(
        &self,
        [Vector(a), Vector([b, _]), ..]: &Parameters<T, 2>,
        q: &Vector<T, 2>,
        v: &Vector<T, 2>,
        v_r: &Vector<T, 2>,
        a_r: &Vector<T, 2>,
    ) -> Vector<T, 2> {
        let (s2, c2) = q[1].sin_cos();
        mass(*a, *b * c2) * *a_r + coriolis(-(*b * s2), v, v_r)
    }

    #[inline]
    fn factor<T: Over<C>>(&self, q: &Vector<T, 2>) -> Ldl<T, 2> {
        self.mass_matrix(q).ldl()
    }
}
