//! The links of a robot: `[links]` of a robot file.

pub(crate) mod assembly;
mod closed_form;
pub(crate) mod inertia;
pub(crate) mod joint;
mod load;
mod pendulum;
mod planar_two_link;
pub(crate) mod rigid;
mod tree;
mod urdf;
pub(crate) mod written;

pub use flexure_core::robots::{Body, JointKind};

use flexure_core::model;
use flexure_core::robots::{self, Tree};
use flexure_core::scalar::{Interval, Scalar};

use crate::files::base::Base;
use crate::files::decimals::Decimals;
use crate::files::field::{Field, Joints};
use crate::files::table::Table;
use crate::lanes::{Each, Several, numbers, together};
use crate::robot::looks::Looks;
use assembly::Fixed;
pub(crate) use closed_form::ClosedForm;
pub(crate) use closed_form::Placed;
use closed_form::{LineBody, ReadClosedForm, closed_forms};

pub use pendulum::Pendulum;
pub use planar_two_link::PlanarTwoLink;

// One line a robot in closed form.
closed_forms! {
    ($)
    planar_two_link::PlanarTwoLink,
    pendulum::Pendulum,
}

/// Links of a type that is known when the program is built, made from those of a robot file.
pub(crate) trait FromFile<C: Scalar, const N: usize>: model::Links<C, N> + Sized {
    /// None if `links` are of another kind, or do not fit. `gravity` is that of the base frame [m/s²]; `approximate` gives a
    /// float near a constant.
    fn from_file(links: &Links<C>, gravity: [C; 3], approximate: &dyn Fn(C) -> f64) -> Option<Self>;
}

impl<C: Scalar + PartialEq, const N: usize> FromFile<C, N> for Tree<C, N> {
    fn from_file(links: &Links<C>, gravity: [C; 3], approximate: &dyn Fn(C) -> f64) -> Option<Self> {
        match links {
            Links::Tree(bodies) => Self::from_bodies(bodies, gravity, approximate),
            _ => None,
        }
    }
}

/// Links whose numbers can stand side by side with those of others.
pub(crate) trait SideBySide<const N: usize>: model::Links<f64, N> + Sized {
    /// The links of every lane.
    type Several: model::Links<Several, N> + Copy + Send + Sync;

    /// The links of each lane side by side; none if they are not of one structure.
    fn side_by_side(links: &Each<&Self>) -> Option<Self::Several>;
}

impl<const N: usize> SideBySide<N> for Tree<f64, N> {
    type Several = Tree<Several, N>;

    fn side_by_side(links: &Each<&Self>) -> Option<Self::Several> {
        if !links.iter().all(|tree| tree.is_like(links[0])) {
            return None;
        }
        let numbers = links.map(|tree| numbers(|number| tree.map(number)));
        together(&numbers, |number| links[0].map(number))
    }
}

/// The bodies of links, to be changed.
enum Bodies<'a, C> {
    /// Of a closed form.
    Line(Vec<LineBody<'a, C>>),
    /// Of a tree.
    Tree(&'a mut Vec<Body<C>>),
}

impl<C: Scalar> Links<C> {
    /// The same links, all massless but `link`.
    pub(crate) fn only(&self, link: usize) -> Self {
        let mut links = self.clone();
        match links.bodies() {
            Bodies::Line(bodies) => {
                for (_, body) in bodies.into_iter().enumerate().filter(|(i, _)| *i != link) {
                    (*body.mass, *body.inertia) = (C::ZERO, C::ZERO);
                }
            }
            Bodies::Tree(bodies) => {
                for (_, body) in bodies.iter_mut().enumerate().filter(|(i, _)| *i != link) {
                    (body.mass, body.inertia) = (C::ZERO, [[C::ZERO; 3]; 3]);
                }
            }
        }
        links
    }
}

/// A moving joint by name, and what the file of the links says of its drive.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingJoint {
    /// Name.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Defaults for its drive.
    pub drive: DriveDefaults,
}

/// What a URDF may say of a joint beside its geometry; none of it if the links stand in the robot file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveDefaults {
    /// Viscous damping [N m s/rad].
    pub damping: Option<f64>,
    /// Coulomb friction [N m]; no part of the model.
    pub friction: Option<f64>,
    /// Largest torque [N m].
    pub torque_limit: Option<f64>,
    /// Largest velocity [rad/s].
    pub velocity_limit: Option<f64>,
    /// Smallest position \[rad\].
    pub position_lower: Option<f64>,
    /// Largest position \[rad\].
    pub position_upper: Option<f64>,
}

impl MovingJoint {
    pub(crate) fn new(name: impl Into<String>, kind: JointKind) -> Self {
        Self { name: name.into(), kind, drive: DriveDefaults::default() }
    }

    /// `count` revolute joints called joint1, joint2, …
    fn numbered(count: usize) -> Vec<Self> {
        (1..=count).map(|i| Self::new(format!("joint{i}"), JointKind::Revolute)).collect()
    }
}

/// What a reader of links found.
pub(crate) struct Assembled {
    pub links: Links,
    /// The links that the decimals of the file make exactly, enclosed.
    pub enclosed: Links<Interval>,
    /// In the order of all per-joint numbers.
    pub joints: Vec<MovingJoint>,
    /// Where the frame of each joint of the file is, fixed ones included; of trees.
    pub frames: Vec<Fixed<f64>>,
    /// What the links look like, if that is told.
    pub looks: Looks,
}

impl Assembled {
    /// From links whose numbers stand in the file as they are.
    fn closed_form(links: Links, decimals: Decimals) -> Self {
        let joints = MovingJoint::numbered(links.joints());
        let enclosed = links.map(|x| decimals.enclose(x));
        Self { enclosed, links, joints, frames: Vec::new(), looks: Looks::default() }
    }
}

/// A kind of links in files.
#[derive(Clone, Copy)]
struct Kind {
    /// Its keys beside `kind`.
    keys: &'static [&'static str],
    /// Its reader, which is told what paths are relative to.
    read: fn(&Table<'_>, &Base) -> Option<Assembled>,
    /// The number of moving joints, if it is always the same.
    joints: Option<usize>,
}

/// Kinds whose joints stand in the file.
const TREES: &[(&str, Kind)] = &[
    ("tree", Kind { keys: &["joint"], read: tree::read, joints: None }),
    ("urdf", Kind { keys: &["file", "locked", "unknown_limits"], read: urdf::read, joints: None }),
];

/// Reads `[links]`; the number of moving joints also if only the numbers in it are bad.
pub(crate) fn read(field: &Field<'_>, base: &Base) -> (Option<Assembled>, Option<usize>) {
    let Some(table) = field.any_table() else { return (None, None) };
    let Some(kind) = table.choice("kind", &[CLOSED_FORMS, TREES].concat()) else { return (None, None) };
    table.refuse_unknown(&[&["kind"], kind.keys].concat());
    let links = (kind.read)(&table, base);
    let count = links.as_ref().map(|found| found.joints.len()).or(kind.joints);
    (links, count)
}

/// The joints that per-joint arrays are about.
pub(crate) fn per_joint(robot: &str, count: Option<usize>) -> Joints {
    Joints { count, robot: robot.to_owned() }
}

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Vector;
    use flexure_core::robots::{self, Tree};

    use super::{FromFile, Links};
    use crate::robot::{Robot, load_robot};

    /// The links each alone take what all of them take together, and none of it beyond their own joint.
    #[test]
    fn links_alone_make_up_the_robot() {
        alone::<Tree<f64, 7>, 7>(&load_robot("panda").expect("built in"));
        alone::<robots::PlanarTwoLink<f64>, 2>(&load_robot("two-link-plausible").expect("built in"));
    }

    fn alone<L: FromFile<f64, N>, const N: usize>(robot: &Robot) {
        let made = |links: &Links| L::from_file(links, robot.gravity, &|x| x).expect("of this kind");
        let spread = |seed: f64| Vector::<f64, N>::from_fn(|i| (seed + 1.7 * i as f64).sin());
        let [q, v, v_r, a_r] = [0.3, 1.1, 2.9, 4.2].map(spread);
        let torque = |links: &Links| made(links).inverse_dynamics(&q, &v, &v_r, &a_r);
        let each: Vec<_> = (0..N).map(|link| torque(&robot.links.only(link))).collect();
        let (all, sum) = (torque(&robot.links), each.iter().fold(Vector::ZERO, |sum, &one| sum + one));
        for i in 0..N {
            // Sums of N torques of about the size of `all`.
            assert!((sum[i] - all[i]).abs() < 1e-12 * (1.0 + all[i].abs()), "{sum:?} {all:?}");
            // A chain: what a joint carries begins with its own link.
            assert!(each[..i].iter().all(|one| one[i].abs() < 1e-12), "{each:?}");
        }
    }
}
