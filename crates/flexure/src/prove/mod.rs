//! Proving: a scenario file as a question, the engines that answer it, and what an answer is compared with.

pub mod along;
mod asked_rate;
mod assumptions;
mod closed_loop;
mod complaint;
pub mod confirmation;
pub mod decay;
mod decimals;
pub mod documents;
pub mod engine;
pub(crate) mod fitting;
pub mod paper;
pub mod proposition;
pub mod question;
pub mod robust;
pub mod sampled_data;
pub mod sampling;
pub mod standing;
pub mod subject;
pub mod summary;
pub mod verified;
pub mod within;
