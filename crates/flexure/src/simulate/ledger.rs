//! The two sides of the power balance, integrated.

use flexure_core::model::Power;

/// Work done on the robot and by it: the two sides of the power balance, integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// ∫ q̇_mᵀ u_m + q̇_lᵀ τ_external dt, in J.
    pub supplied: f64,
    /// ∫ q̇_lᵀ D_l q̇_l + q̇_mᵀ D_m q̇_m dt and the work of dry friction and hysteresis, in J.
    pub dissipated: f64,
    /// ∫ |q̇_mᵀ u_m + q̇_lᵀ τ_external| dt, in J: what the residual is compared with.
    pub throughput: f64,
}

impl Ledger {
    pub(crate) fn book(&mut self, seconds: f64, power: &Power<f64>) {
        self.supplied += seconds * power.supplied;
        self.dissipated += seconds * power.dissipated;
        self.throughput += seconds * power.supplied.abs();
    }

    pub(crate) fn add(&mut self, work: &Self) {
        self.supplied += work.supplied;
        self.dissipated += work.dissipated;
        self.throughput += work.throughput;
    }
}
