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
//! | does it hold over a whole region? | the same functions on intervals, over the pieces of a box: [`over_pieces`] |
//!
//! The flexible-joint robot is one instance: [`ErrorLoop`] in error coordinates, [`FlexibleJoints`] as a [`VirtualSystem`].

mod blocks;
mod error_loop;
mod feedback;
mod field;
mod flexible_joints;
mod interconnection;
mod jacobian;
mod measure;
mod passivity;
mod prolonged;
mod step;
mod system;
mod tangent;
mod virtual_system;

pub use error_loop::ErrorLoop;
pub use feedback::{ClosedLoop, Feedback};
pub use field::MatrixField;
pub use flexible_joints::FlexibleJoints;
pub use interconnection::{Both, Interconnection};
pub use jacobian::{contraction_matrix, field_rate, generalised_jacobian};
pub use measure::{measure_1, measure_2, measure_2_margins, measure_infinity, symmetric_eigenvalues};
pub use passivity::{
    DifferentialBalance, PassivityMatrices, differential_passivity, passivity_matrices, storage,
};
pub use prolonged::Prolonged;
pub use step::runge_kutta;
pub use system::{ControlSystem, Dynamics, Linearised};
pub use virtual_system::{ActualDefect, Along, Together, VirtualSystem};
