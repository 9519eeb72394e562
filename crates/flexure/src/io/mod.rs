//! Robot, scenario and states files: the only code that touches files.
//!
//! Text becomes plain, validated data ([`Robot`], [`Scenario`], [`StateRow`]) or a list of [`Problems`], each with the
//! number, its unit, the allowed range, the line and a hint. Nothing is defaulted in silence that changes physics:
//! what was assumed is in [`Robot::assumptions`] and [`Scenario::assumptions`].
//!
//! Angles rad, torques N m, inertias kg m², time s, everything on the link side of the gear.
//!
//! ```
//! let scenario = flexure::io::load_scenario("two-link-tanh")?;
//! assert_eq!(scenario.robot.joint_count(), 2);
//! assert!(scenario.assumptions.iter().any(|assumed| assumed.key == "joints.stiffness"));
//!
//! let problems = flexure::io::robot_from_text("arm.toml", "nam = 'arm'", ".".as_ref()).unwrap_err();
//! assert!(problems.to_string().contains("nam"));
//! # Ok::<(), flexure::io::Problems>(())
//! ```

mod any;
mod atomic;
mod base;
mod builtin;
mod controller;
mod decimals;
mod diagnostic;
mod document;
mod estimator;
mod field;
mod guard;
mod imperfection;
mod initial;
mod joints;
mod links;
mod outputs;
mod plant;
mod provenance;
mod quantity;
mod reference;
mod robot;
mod samples;
mod scenario;
mod site;
mod source;
mod states;
pub(crate) mod suggest;
mod table;
mod urdf;

pub use any::{Checked, check};
pub use atomic::{WriteError, write_atomic};
pub use builtin::{ROBOTS, SCENARIOS, TASKS, load_robot, load_scenario};
pub use controller::{BASELINES, Baseline, Controller, Drive, Gain, Phi, Shape, SideGains, VcbcGains};
pub use diagnostic::{Problem, Problems};
pub use document::Places;
pub use estimator::{DisturbanceObserver, Encoders, Estimator};
pub use guard::GuardSettings;
pub use imperfection::{
    Deadline, Delay, Dropout, DropoutMode, Encoder, Factors, Friction, Imperfection, ModelError, Noise,
    Outage, Payload, Push, PushShape, Sampling, Side, Sides, Spring, Stribeck, VelocityFilter,
};
pub use initial::Initial;
pub use joints::Limits;
pub use links::{Body, DriveDefaults, JointKind, Links, MovingJoint};
pub use outputs::{
    prepare, write_certificate, write_certificates, write_experiment, write_leaderboard, write_report,
    write_trace,
};
pub use plant::Plant;
pub use provenance::Assumption;
pub use reference::{Profile, Reference, SmoothStart, Speed, Term, TimeScaling};
pub use robot::{Robot, robot_from_text};
pub use scenario::{Hold, Scenario, scenario_from_text};
pub use states::{StateFile, StateRow, States, load_states};
pub use urdf::{Import, import};
