//! The two sides of the power balance, integrated.

use flexure_core::model::Power;
use flexure_core::scalar::{Over, Piecewise};

use crate::lanes::Several;

/// Work done on the robot and by it: the two sides of the power balance, integrated. Of several robots, if `T` is lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger<T = f64> {
    /// ∫ q̇_mᵀ u_m + q̇_lᵀ τ_external dt, in J.
    pub supplied: T,
    /// ∫ q̇_lᵀ D_l q̇_l + q̇_mᵀ D_m q̇_m dt and the work of dry friction and hysteresis, in J.
    pub dissipated: T,
    /// ∫ |q̇_mᵀ u_m + q̇_lᵀ τ_external| dt, in J: what the residual is compared with.
    pub throughput: T,
}

impl Ledger<Several> {
    /// That of the robot in a lane.
    pub(crate) fn of(&self, lane: usize) -> Ledger {
        let Self { supplied, dissipated, throughput } = self;
        let [supplied, dissipated, throughput] =
            [supplied, dissipated, throughput].map(|work| work.to_array()[lane]);
        Ledger { supplied, dissipated, throughput }
    }
}

impl<T: Piecewise + Over<f64>> Ledger<T> {
    /// Nothing done.
    pub(crate) const ZERO: Self = Self { supplied: T::ZERO, dissipated: T::ZERO, throughput: T::ZERO };

    pub(crate) fn book(&mut self, seconds: f64, power: &Power<T>) {
        self.supplied += power.supplied.scale(seconds);
        self.dissipated += power.dissipated.scale(seconds);
        self.throughput += power.supplied.abs().scale(seconds);
    }

    pub(crate) fn add(&mut self, work: &Self) {
        self.supplied += work.supplied;
        self.dissipated += work.dissipated;
        self.throughput += work.throughput;
    }
}
