//! What the state alone says of the links' future: accelerations and jerks, whatever the motors will do.

use super::{Fjr, Links, MassFactor, Motion};
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Scalar};

impl<C: Scalar, L: Links<C, N>, const N: usize> Fjr<C, L, N> {
    /// Link position along the motion to order 3. q̈_l follows from the link dynamics and q⃛_l from their time
    /// derivative, which brings in q̇_m but neither q̈_m nor the motor torque.
    ///
    /// `factor` is the mass matrix at `x.q_l`.
    #[inline]
    pub fn link_motion<T: Over<C>>(
        &self,
        factor: &L::Factor<'_, T>,
        x: &Motion<T, N>,
    ) -> Vector<Jet<T, 4>, N> {
        self.link_motion_under(factor, x, &Vector::ZERO)
    }

    /// [`link_motion`](Self::link_motion) under a constant torque `load` [N m] on the links that is not in the model.
    #[inline]
    pub fn link_motion_under<T: Over<C>>(
        &self,
        factor: &L::Factor<'_, T>,
        x: &Motion<T, N>,
        load: &Vector<T, N>,
    ) -> Vector<Jet<T, 4>, N> {
        let links = &self.links;
        let (q, v) = (x.q_l.map(Jet::<T, 1>::value), x.v_l.map(Jet::value));
        let bias = links.motion_torque(factor, &q, &v, &Vector::ZERO).map(|x| x.coefficient(0)) - *load;
        self.link_motion_with(factor, x, &bias, |a| {
            links.motion_torque(factor, &x.q_l.with_rate(&x.v_l), &x.v_l.with_rate(a), &a.map(Jet::value))
        })
    }

    /// [`link_motion`](Self::link_motion) for any torques on the links: `bias` is C q̇ + g at order 0, and
    /// `bias_along(a)` gives M a + C q̇ + g to order 1 along the motion with acceleration `a` held. M q⃛ is the rate of
    /// the remaining torque minus the first coefficient of that.
    #[inline]
    pub(crate) fn link_motion_with<T: Over<C>>(
        &self,
        factor: &impl MassFactor<T, N>,
        x: &Motion<T, N>,
        bias: &Vector<T, N>,
        bias_along: impl FnOnce(&Vector<T, N>) -> Vector<Jet<T, 2>, N>,
    ) -> Vector<Jet<T, 4>, N> {
        let a = factor.solve(&(self.link_torque(x) - *bias));
        let torque_rate = self.spring_torque(&x.v_l, &x.v_m) - self.link_damping.diag_mul(&a);
        let jerk = factor.solve(&(torque_rate - bias_along(&a).map(|x| x.coefficient(1))));
        let (half, sixth) = (T::from_ratio(1, 2), T::from_ratio(1, 6));
        Vector::from_fn(|i| Jet::new([x.q_l[i], x.v_l[i], half * a[i], sixth * jerk[i]]))
    }
}

impl<T: Scalar, const N: usize> Vector<T, N> {
    /// The series `self + rate t`.
    #[inline]
    pub(crate) fn with_rate(&self, rate: &Self) -> Vector<Jet<T, 2>, N> {
        Vector::from_fn(|i| Jet::new([self[i], rate[i]]))
    }
}
