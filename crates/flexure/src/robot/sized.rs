//! The one place where a joint count read from a file becomes a type.
//!
//! Robots in closed form have a size of their own; trees run in the smallest capacity that holds them. The joints beyond a
//! robot's own are phantoms ([`Tree`]): unit inertia, stiffness and motor inertia, at rest.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::robots::{Pendulum, PlanarTwoLink, Tree};
use flexure_core::scalar::Scalar;

use crate::files::{Problem, Problems};
use crate::robot;

/// Largest joint count of a tree. To raise it, add a capacity to [`Size`] and to the list below and build again.
pub const MAX_JOINTS: usize = 16;

/// A type of links, as chosen by [`size`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    Pendulum,
    PlanarTwoLink,
    Tree4,
    Tree8,
    Tree16,
}

/// Evaluates `$then` with `$L<C>` the links of the robot file `$data` over constants of type `C`, and `$N` their capacity.
/// Returns with the problem from the function that it stands in if the robot has more than [`MAX_JOINTS`] joints.
macro_rules! sized {
    ($data:expr, $L:ident, $N:ident => $then:expr) => {
        match $crate::robot::sized::size($data)? {
            $crate::robot::sized::Size::Pendulum => sized!(@ $L = Pendulum<C>, $N = 1, $then),
            $crate::robot::sized::Size::PlanarTwoLink => sized!(@ $L = PlanarTwoLink<C>, $N = 2, $then),
            $crate::robot::sized::Size::Tree4 => sized!(@ $L = Tree<C, 4>, $N = 4, $then),
            $crate::robot::sized::Size::Tree8 => sized!(@ $L = Tree<C, 8>, $N = 8, $then),
            $crate::robot::sized::Size::Tree16 => sized!(@ $L = Tree<C, 16>, $N = 16, $then),
        }
    };
    (@ $L:ident = $links:ident<C $(, $capacity:literal)?>, $N:ident = $size:literal, $then:expr) => {{
        #[allow(dead_code, reason = "some callers need the type, some the size")]
        type $L<C> = flexure_core::robots::$links<C $(, $capacity)?>;
        const $N: usize = $size;
        $then
    }};
}
pub(crate) use sized;

/// Which type of links the robot in `data` gets.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints.
pub(crate) fn size(data: &robot::Robot) -> Result<Size, Problems> {
    match &data.links {
        robot::Links::Pendulum { .. } => Ok(Size::Pendulum),
        robot::Links::PlanarTwoLink { .. } => Ok(Size::PlanarTwoLink),
        robot::Links::Tree(bodies) => match bodies.len() {
            0..=4 => Ok(Size::Tree4),
            5..=8 => Ok(Size::Tree8),
            9..=MAX_JOINTS => Ok(Size::Tree16),
            joints => Err(too_many(data, joints)),
        },
    }
}

/// Whether this program is built for the robot's joint count.
///
/// # Errors
/// For a robot with more than [`MAX_JOINTS`] moving joints.
pub fn supported(data: &robot::Robot) -> Result<(), Problems> {
    size(data).map(drop)
}

fn too_many(data: &robot::Robot, joints: usize) -> Problems {
    let message = format!(
        "robot {} has {joints} moving joints; this program is built for at most {MAX_JOINTS}",
        data.name
    );
    let help = "lock joints, or add a capacity to the list in robot/sized.rs and build again";
    data.places.problem("links", "joints", message, help).into()
}

/// Links of a type that is known when the program is built, made from those of a robot file.
pub(crate) trait FromFile<C: Scalar, const N: usize>: Links<C, N> + Sized {
    /// None if `links` are of another kind, or do not fit. `gravity` is that of the base frame [m/s²]; `approximate` gives a
    /// float near a constant.
    fn from_file(links: &robot::Links<C>, gravity: [C; 3], approximate: &dyn Fn(C) -> f64) -> Option<Self>;
}

impl<C: Scalar, const N: usize> FromFile<C, N> for Tree<C, N> {
    fn from_file(links: &robot::Links<C>, gravity: [C; 3], approximate: &dyn Fn(C) -> f64) -> Option<Self> {
        let robot::Links::Tree(bodies) = links else { return None };
        Self::from_bodies(bodies, gravity, approximate)
    }
}

impl<C: Scalar> FromFile<C, 2> for PlanarTwoLink<C> {
    fn from_file(links: &robot::Links<C>, _: [C; 3], _: &dyn Fn(C) -> f64) -> Option<Self> {
        let &robot::Links::PlanarTwoLink { mass, length, com, inertia } = links else { return None };
        Some(Self::new(mass, length[0], com, inertia))
    }
}

impl<C: Scalar> FromFile<C, 1> for Pendulum<C> {
    fn from_file(links: &robot::Links<C>, gravity: [C; 3], _: &dyn Fn(C) -> f64) -> Option<Self> {
        let &robot::Links::Pendulum { mass, com, inertia } = links else { return None };
        let [x, y, z] = gravity.map(C::square);
        Some(Self { inertia: inertia + mass * com.square(), weight_moment: mass * com * (x + y + z).sqrt() })
    }
}

/// Why links are of the type that [`sized`] chose.
pub(crate) const OF_THE_KIND: &str = "links of the kind that their size was chosen by";

/// The robot of `links`, either those of `data` or the same enclosed, with the other numbers of `data` through `number`.
///
/// None if the links are not of the type `L`.
pub(crate) fn fjr<C: Scalar, L: FromFile<C, N>, const N: usize>(
    data: &robot::Robot,
    links: &robot::Links<C>,
    number: impl Fn(f64) -> C,
    approximate: &dyn Fn(C) -> f64,
) -> Option<Fjr<C, L, N>> {
    Some(Fjr {
        links: L::from_file(links, data.gravity.map(&number), approximate)?,
        motor_inertia: padded(&data.motor_inertia, 1.0).map(&number),
        stiffness: padded(&data.stiffness, 1.0).map(&number),
        link_damping: padded(&data.link_damping, 0.0).map(&number),
        motor_damping: padded(&data.motor_damping, 0.0).map(&number),
    })
}

/// The robot that a law knows, `model`, and the one that is there, `plant`.
///
/// # Errors
/// If they are of different kinds or joint counts.
pub(crate) fn pair<L: FromFile<f64, N>, const N: usize>(
    model: &robot::Robot,
    plant: &robot::Robot,
) -> Result<[Fjr<f64, L, N>; 2], Problems> {
    let point = |robot: &robot::Robot| fjr(robot, &robot.links, |x| x, &|x| x);
    match (point(model), point(plant)) {
        (Some(known), Some(there)) if model.joint_count() == plant.joint_count() => Ok([known, there]),
        _ => Err(no_pair(model, plant).into()),
    }
}

fn no_pair(model: &robot::Robot, plant: &robot::Robot) -> Problem {
    let what = |robot: &robot::Robot| {
        let kind = match robot.links {
            robot::Links::PlanarTwoLink { .. } => "a planar two-link arm",
            robot::Links::Pendulum { .. } => "a pendulum",
            robot::Links::Tree(_) => "a tree",
        };
        format!("{} is {kind} with joints: {}", robot.name, robot.joint_count())
    };
    let message = format!("a law for one robot cannot move the other: {}; {}", what(model), what(plant));
    let help =
        "the robot that is simulated has the kind of links and the joint count of the one that the law knows";
    plant.places.problem("links", "pair", message, help)
}

/// Per-joint data, whose length the reader has checked; zero for joints that only fill a capacity.
pub(crate) fn vector<const N: usize>(values: &[f64]) -> Vector<f64, N> {
    padded(values, 0.0)
}

/// Per-joint data, whose length the reader has checked, with `pad` for joints that only fill a capacity: what is divided by
/// must not be zero there.
pub(crate) fn padded<const N: usize>(values: &[f64], pad: f64) -> Vector<f64, N> {
    Vector::from_fn(|i| values.get(i).copied().unwrap_or(pad))
}
