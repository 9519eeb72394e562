//! The direct engine: contraction of the closed loop from its Jacobian, with one reduction by hand: that Ṁ_l cancels.
//!
//! W = ½ δzᵀ P δz decays at least at 2β where `dissipation − β P` is positive definite, with Ẇ = −δzᵀ `dissipation` δz.
//! Both matrices come from the code of the core on dual numbers over intervals, column by column; the inequality is proved
//! over a region by bisection, preconditioned by the inverse factor of its value at the midpoint. Only [`VcbcLoop`] knows the
//! system: it leaves out Ṁ_l and what cancels it. Nothing else here knows that coupling cancels, or what a shaping function is:
//! the engine serves laws that no theorem covers, and is there to distrust the theorems where there are some.
//!
//! | part | does |
//! | --- | --- |
//! | [`Flow`], [`System`], [`Twins`] | what is proved about: two matrices over a box of coordinates |
//! | [`VcbcLoop`], [`vcbc`] | the v-CBC law's closed loop as such |
//! | [`prove`], [`best_rate`] | branch and bound |
//! | [`law_agreement`] | whether the closed form is what the law's code gives |
//!
//! **Trusted:** intervals, dual numbers, [`Symmetric`](crate::linalg::Symmetric), `definite`, `bisection` and the
//! [`Flow`]'s matrices on intervals. What runs in `f64` (samples, eigenvectors, preconditioners, the choice of what to bisect)
//! only makes proofs quicker: a wrong number there costs time.
//!
//! **What a proof says:** the inequality holds at every state of the region. Two virtual solutions approach each other at the
//! rate β for as long as the shortest path between them stays in the region; that they do is another claim.

mod agreement;
mod best;
mod bisection;
mod closed_loop;
mod definite;
mod flow;
mod jacobian;
mod samples;
mod split;
mod witness;

pub use agreement::{Agreement, law_agreement};
pub use best::{BestRate, best_rate};
pub use bisection::{Proved, prove, prove_watched};
pub use closed_loop::{StateBox, VcbcLoop, full_turn, vcbc};
pub use flow::{Balance, Coordinate, Flow, System, Twins};
pub use jacobian::{jacobian, symmetric_part};
pub use witness::{DirectWitness, NamedState};
