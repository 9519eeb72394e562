//! Robots: their files, URDFs, and what can be asked of them.

mod arm;
pub(crate) mod document;
pub(crate) mod drives;
pub(crate) mod joints;
pub(crate) mod links;
mod load;
pub(crate) mod looks;
mod overview;
pub(crate) mod sized;
pub(crate) mod slices;
pub(crate) mod stl;
pub(crate) mod tolerances;
pub(crate) mod urdf;

pub use arm::{Arm, PortHamiltonian};
pub use document::{Robot, robot_from_text};
pub use drives::{DRIVES, DriveClass, Typical, TypicalDrive};
pub use joints::Limits;
pub(crate) use links::Placed;
pub use links::{Body, DriveDefaults, JointKind, Links, MovingJoint, Pendulum, PlanarTwoLink};
pub use load::{load_robot, load_robot_with};
pub(crate) use load::{robot, source_at};
pub(crate) use overview::kind_in_words;
pub use overview::{JointRow, overview};
pub use sized::{MAX_JOINTS, supported};
pub(crate) use sized::{padded, vector};
pub use slices::Mismatch;
pub use tolerances::Tolerances;
pub use urdf::{Import, ImportOptions, import, import_text};
