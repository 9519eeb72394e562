//! Contraction, differential passivity and virtual systems for systems of one's own.
//!
//! A system is written once over a number type, as [`ControlSystem`] or [`Dynamics`]. Everything that the theory differentiates
//! comes from [`Dual`](crate::scalar::Dual) numbers, and everything that it bounds from intervals:
//!
//! | question | answered by |
//! | --- | --- |
//! | how do neighbouring solutions move? | [`Prolonged`], [`Dynamics::jacobian`], [`ControlSystem::linearised`] |
//! | does the system contract, and how fast? | [`generalised_jacobian`] with [`measure_1`], [`measure_2`], [`measure_infinity`]; [`contraction_matrix`] |
//! | which length decays along solutions? | [`Finsler`] |
//! | is it differentially passive? | [`differential_passivity`]; two in feedback: [`Interconnection`] |
//! | does a virtual system solve my tracking problem? | [`VirtualSystem`] |
//! | what does a metric gain that grows with the error? | [`Stretch`], [`StretchedLoop`], [`StretchedSide`] |
//! | does it hold over a whole region? | the same functions on intervals, over the pieces of a box: [`over_pieces`] |
//!
//! The flexible-joint robot is one instance: [`ErrorLoop`] in error coordinates, [`FlexibleJoints`] as a [`VirtualSystem`].

mod blocks;
mod error_hamiltonian;
mod error_loop;
mod feedback;
mod field;
mod finsler;
mod flexible_joints;
mod full_design;
mod full_joints;
mod instant;
mod interconnection;
mod jacobian;
mod measure;
mod passivity;
#[cfg(feature = "interval")]
mod pieces;
mod port_hamiltonian;
mod prolonged;
mod step;
mod stretch;
mod stretched_side;
mod structures;
mod system;
mod tangent;
mod virtual_robot;
mod virtual_system;
mod weights;

pub use error_hamiltonian::ErrorHamiltonian;
pub use error_loop::ErrorLoop;
pub use feedback::{ClosedLoop, Feedback};
pub use field::{MatrixField, Root};
pub use finsler::{Finsler, Norm};
pub use flexible_joints::FlexibleJoints;
pub use full_design::{FullDesign, FullGains};
pub use full_joints::FullJoints;
pub use interconnection::{Both, Interconnection};
pub use jacobian::{contraction_matrix, field_rate, generalised_jacobian};
pub use measure::{measure_1, measure_2, measure_2_margins, measure_infinity, symmetric_eigenvalues};
pub use passivity::{
    DifferentialBalance, PassivityMatrices, differential_passivity, passivity_matrices, storage,
};
#[cfg(feature = "interval")]
pub use pieces::over_pieces;
pub use port_hamiltonian::{EnergyBalance, Hessian, PortHamiltonian, PortSystem};
pub use prolonged::Prolonged;
pub use step::runge_kutta;
pub use stretch::{Stretch, StretchedLoop};
pub use stretched_side::{Stretched, StretchedSide};
pub use structures::{
    Refusal, incremental_passivity, keeps_hamiltonian_structure, keeps_variational_structure,
    slope_inequality, symmetric_positive,
};
pub use system::{ControlSystem, Dynamics, Linearised};
pub use virtual_robot::VirtualRobot;
pub use virtual_system::{ActualDefect, Along, Together, VirtualSystem};
pub use weights::diagonal_weight;
