//! Systems that the tests share.

use flexure_core::contraction::{ControlSystem, Dynamics};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Over, Piecewise, Scalar};

/// A driven pendulum with friction, with everything that a control system can have: q̇ = p, ṗ = −k sin q − d p + (1 + q²/4) u + cos t,
/// y = (1 + q²/4) p.
pub struct Driven {
    pub stiffness: f64,
    pub damping: f64,
}

impl<C: Scalar> ControlSystem<C, 2, 1> for Driven {
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        let [k, d] = [self.stiffness, self.damping].map(T::from_f64);
        Vector([x[1], t.cos() - k * x[0].sin() - d * x[1]])
    }
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Matrix<T, 2, 1> {
        Matrix([[T::ZERO], [lever(x[0])]])
    }
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Vector<T, 1> {
        Vector([lever(x[0]) * x[1]])
    }
}

fn lever<T: Scalar>(q: T) -> T {
    T::ONE + q.square() * T::from_f64(0.25)
}

/// ẋ_1 = −2 x_1 + sin x_2 + cos t, ẋ_2 = −3 x_2 + sin x_1: contracting by diagonal dominance.
pub struct Dominant;

impl<C: Scalar> Dynamics<C, 2> for Dominant {
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        let two = T::from_f64(2.0);
        Vector([x[1].sin() - two * x[0] + t.cos(), x[0].sin() - (two + T::ONE) * x[1]])
    }
}
