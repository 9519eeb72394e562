//! Drives whose torque constant is not what the controller believes.

use flexure_core::linalg::Vector;

use super::{Actuating, Tick};

/// Multiplies torque by a factor > 0; 1 for a drive that is known.
#[derive(Clone, Copy, Debug)]
pub struct TorqueGain<const N: usize>(pub Vector<f64, N>);

impl<const N: usize> Actuating<N> for TorqueGain<N> {
    fn actuate(&mut self, _: &Tick, torque: &mut Vector<f64, N>) {
        *torque = self.0.diag_mul(torque);
    }
}
