//! Scenario files: a robot, a law, a reference and everything between them, as data.
//!
//! Nothing is defaulted in silence that changes physics: what was assumed is in [`Scenario::assumptions`].
//!
//! ```
//! let scenario = flexure::scenario::load_scenario("two-link-tanh")?;
//! assert_eq!(scenario.robot.joint_count(), 2);
//! assert!(scenario.assumptions.iter().any(|assumed| assumed.key == "joints.stiffness"));
//!
//! let problems = flexure::robot::robot_from_text("arm.toml", "nam = 'arm'", ".".as_ref()).unwrap_err();
//! assert!(problems.to_string().contains("nam"));
//! # Ok::<(), flexure::files::Problems>(())
//! ```

mod accept;
pub(crate) mod agreement;
mod any;
pub(crate) mod document;
mod draft;
mod drafts;
mod guard;
mod initial;
mod integration;
pub(crate) mod load;
mod plant;

pub use accept::Accept;
pub use any::{Checked, check};
pub use document::{Hold, Scenario, scenario_from_text};
pub use draft::draft;
pub use drafts::Drafts;
pub use guard::{Believed, Collision, GuardSettings, Reaction, Rejoin};
pub use initial::Initial;
pub use integration::Integration;
pub(crate) use integration::TOLERANCE;
pub use load::{load_scenario, load_scenario_with};
pub(crate) use load::{numbers, source_at};
pub use plant::Plant;
