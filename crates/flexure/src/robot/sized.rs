//! Robots by their links, and the one place that turns a joint count read from a file into a type.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::robots::{Body, Tree};
use flexure_core::scalar::{Interval, Scalar};

use crate::{files, robot};

/// Something to do with a robot whose links and joint count are known only when it runs, over constants of type `C`.
pub trait RobotVisitor<C: Scalar = f64> {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<L: Links<C, N> + Sync, const N: usize>(self, robot: Fjr<C, L, N>) -> Self::Output;
}

/// Something to do with a robot twice over: with the decimals of its files enclosed, and in `f64`.
pub trait TwinVisitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<E: Links<Interval, N>, F: Links<f64, N>, const N: usize>(
        self,
        enclosed: Fjr<Interval, E, N>,
        point: Fjr<f64, F, N>,
    ) -> Self::Output;
}

/// Something to do with two robots of the same kind: the one that a law knows and the one that is there.
pub trait PairVisitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<L: Links<f64, N> + Clone + Sync, const N: usize>(
        self,
        model: Fjr<f64, L, N>,
        plant: Fjr<f64, L, N>,
    ) -> Self::Output;
}

/// Largest joint count of a tree. To raise it, add the numbers to the list below and build again.
pub const MAX_JOINTS: usize = 10;

/// Hands the joint counts that this program is built for to another macro, after its other arguments.
macro_rules! joint_counts {
    ($then:ident, $($argument:expr),+) => { $then!($($argument),+, 1 2 3 4 5 6 7 8 9 10) };
}

/// Calls `visitor` with the robot that `data` describes.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints.
pub fn with_robot<V: RobotVisitor>(data: &robot::Robot, visitor: V) -> Result<V::Output, files::Problems> {
    over(data, &data.links, |x| x, |x| x, visitor)
}

/// Calls `visitor` with the robot over intervals that encloses what the decimals in its files say.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints.
pub fn with_enclosed_robot<V: RobotVisitor<Interval>>(
    data: &robot::Robot,
    visitor: V,
) -> Result<V::Output, files::Problems> {
    over(data, &data.enclosed, |x| data.bounds(x), Interval::midpoint, visitor)
}

/// Calls `visitor` with the robot that `data` describes, enclosed and in `f64`.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints.
pub fn with_twins<V: TwinVisitor>(data: &robot::Robot, visitor: V) -> Result<V::Output, files::Problems> {
    let bounds = |x| data.bounds(x);
    let gravity = data.gravity.map(bounds);
    macro_rules! tree {
        ($enclosed:expr, $bodies:expr, $($n:literal)*) => {
            match $bodies.len() {
                $($n => visitor.visit(
                    robot(data, tree::<_, $n>($enclosed, gravity, Interval::midpoint), bounds),
                    robot(data, tree::<_, $n>($bodies, data.gravity, |x| x), |x| x),
                ),)*
                joints => return Err(too_many(data, joints)),
            }
        };
    }
    Ok(match (&data.enclosed, &data.links) {
        (robot::Links::Tree(enclosed), robot::Links::Tree(bodies)) => joint_counts!(tree, enclosed, bodies),
        (robot::Links::PlanarTwoLink(enclosed), robot::Links::PlanarTwoLink(point)) => visitor
            .visit::<_, _, 2>(
                robot(data, enclosed.core(gravity), bounds),
                robot(data, point.core(data.gravity), |x| x),
            ),
        (robot::Links::Pendulum(enclosed), robot::Links::Pendulum(point)) => visitor.visit::<_, _, 1>(
            robot(data, enclosed.core(gravity), bounds),
            robot(data, point.core(data.gravity), |x| x),
        ),
        _ => unreachable!("enclosed links are of the same kind"),
    })
}

/// Calls `visitor` with the robot that a law knows, `model`, and the one that is there, `plant`.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints, and for robots of different kinds or joint counts.
pub fn with_pair<V: PairVisitor>(
    model: &robot::Robot,
    plant: &robot::Robot,
    visitor: V,
) -> Result<V::Output, files::Problems> {
    let point = |x: f64| x;
    macro_rules! tree {
        ($model:expr, $plant:expr, $($n:literal)*) => {
            match $model.len() {
                $($n => visitor.visit(
                    robot(model, tree::<_, $n>($model, model.gravity, point), point),
                    robot(plant, tree::<_, $n>($plant, plant.gravity, point), point),
                ),)*
                joints => return Err(too_many(model, joints)),
            }
        };
    }
    Ok(match (&model.links, &plant.links) {
        (robot::Links::Tree(known), robot::Links::Tree(real)) if known.len() == real.len() => {
            joint_counts!(tree, known, real)
        }
        (robot::Links::PlanarTwoLink(known), robot::Links::PlanarTwoLink(real)) => visitor.visit::<_, 2>(
            robot(model, known.core(model.gravity), point),
            robot(plant, real.core(plant.gravity), point),
        ),
        (robot::Links::Pendulum(known), robot::Links::Pendulum(real)) => visitor.visit::<_, 1>(
            robot(model, known.core(model.gravity), point),
            robot(plant, real.core(plant.gravity), point),
        ),
        _ => return Err(no_pair(model, plant)),
    })
}

fn no_pair(model: &robot::Robot, plant: &robot::Robot) -> files::Problems {
    let what = |robot: &robot::Robot| {
        let kind = robot.links.what();
        format!("{} is {kind} with joints: {}", robot.name, robot.joint_count())
    };
    let message = format!("a law for one robot cannot move the other: {}; {}", what(model), what(plant));
    let help =
        "the robot that is simulated has the kind of links and the joint count of the one that the law knows";
    plant.places.problem("links", "pair", message, help).into()
}

/// The robot of `links` with the other numbers of `data` through `number`; `approximate` gives a float near a constant.
fn over<C: Scalar + Sync, V: RobotVisitor<C>>(
    data: &robot::Robot,
    links: &robot::Links<C>,
    number: impl Fn(f64) -> C,
    approximate: impl Fn(C) -> f64,
    visitor: V,
) -> Result<V::Output, files::Problems> {
    let gravity = data.gravity.map(&number);
    macro_rules! tree {
        ($bodies:expr, $($n:literal)*) => {
            match $bodies.len() {
                $($n => visitor.visit(robot(data, tree::<C, $n>($bodies, gravity, approximate), number)),)*
                joints => return Err(too_many(data, joints)),
            }
        };
    }
    Ok(match links {
        robot::Links::PlanarTwoLink(form) => visitor.visit::<_, 2>(robot(data, form.core(gravity), number)),
        robot::Links::Pendulum(form) => visitor.visit::<_, 1>(robot(data, form.core(gravity), number)),
        robot::Links::Tree(bodies) => joint_counts!(tree, bodies),
    })
}

/// Whether this program is built for the robot's joint count.
///
/// # Errors
/// For a robot with more than [`MAX_JOINTS`] moving joints.
pub fn supported(data: &robot::Robot) -> Result<(), files::Problems> {
    if data.joint_count() > MAX_JOINTS { Err(too_many(data, data.joint_count())) } else { Ok(()) }
}

fn too_many(data: &robot::Robot, joints: usize) -> files::Problems {
    let message = format!(
        "robot {} has {joints} moving joints; this program is built for at most {MAX_JOINTS}",
        data.name
    );
    let help = "lock joints, or add the number to the list in registry/robot.rs and build again";
    data.places.problem("links", "joints", message, help).into()
}

fn robot<C: Scalar, L, const N: usize>(
    data: &robot::Robot,
    links: L,
    number: impl Fn(f64) -> C,
) -> Fjr<C, L, N> {
    Fjr {
        links,
        motor_inertia: vector(&data.motor_inertia).map(&number),
        stiffness: vector(&data.stiffness).map(&number),
        link_damping: vector(&data.link_damping).map(&number),
        motor_damping: vector(&data.motor_damping).map(&number),
    }
}

fn tree<C: Scalar, const N: usize>(
    bodies: &[Body<C>],
    gravity: [C; 3],
    approximate: impl Fn(C) -> f64,
) -> Tree<C, N> {
    Tree::from_bodies(&std::array::from_fn(|i| bodies[i]), gravity, approximate)
        .expect("the reader puts parents before children")
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
