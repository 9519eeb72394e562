//! The port-Hamiltonian model of a flexible-joint robot over any [`Links`].

mod fjr;
mod inverse_dynamics;
mod link_motion;
mod links;
mod matrices;
mod rest;
mod rotors;
mod state;

pub use fjr::{Fjr, Power};
pub use inverse_dynamics::FeedForward;
pub(crate) use links::seeded;
pub use links::{Links, MassFactor, Parameters};
pub use matrices::LinkMatrices;
pub use rotors::RotorCoupling;
pub use state::{Motion, State};
