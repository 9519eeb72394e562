//! Drives that give so much torque and no more.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::{Actuating, Tick};

/// Cuts torque at a limit > 0 [N m].
#[derive(Clone, Copy, Debug)]
pub struct Saturation<const N: usize>(pub Vector<f64, N>);

impl<const N: usize> Actuating<N> for Saturation<N> {
    fn actuate(&mut self, _: &Tick, torque: &mut Vector<f64, N>) {
        *torque = Vector::from_fn(|i| torque[i].clamp(-self.0[i], self.0[i]));
    }
}
