//! The commands, a file each.

mod certify;
mod check;
mod compare;
mod completions;
mod eval;
mod excite;
mod identify;
mod import;
mod list;
mod log;
mod man;
mod margins;
mod model;
pub mod print;
mod replay;
mod reproduce;
mod run;
mod tune;
mod verify;

pub use certify::certify;
pub use check::check;
pub use compare::compare;
pub use completions::completions;
pub use eval::eval;
pub use excite::excite;
pub use identify::identify;
pub use import::import;
pub use list::list;
pub use man::man;
pub use margins::margins;
pub use model::model;
pub use replay::replay;
pub use reproduce::reproduce;
pub use run::run;
pub use tune::tune;
pub use verify::verify;
