//! Drives whose current comes in steps.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::encoder::rounded;
use crate::imperfections::stages::{Actuating, Tick};

/// Rounds torque to the nearest step ≥ 0 [N m].
#[derive(Clone, Copy, Debug)]
pub struct CurrentQuantisation<const N: usize>(pub Vector<f64, N>);

impl<const N: usize> Actuating<N> for CurrentQuantisation<N> {
    fn actuate(&mut self, _: &Tick, torque: &mut Vector<f64, N>) {
        *torque = Vector::from_fn(|i| rounded(torque[i], self.0[i], 0.0));
    }
}
