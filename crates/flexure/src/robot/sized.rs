//! The one place where a joint count read from a file becomes a type.
//!
//! Robots in closed form have a size of their own; trees run in the smallest capacity that holds them. The joints beyond a
//! robot's own are phantoms ([`Tree`]): unit inertia, stiffness and motor inertia, at rest.

use flexure_core::linalg::Vector;
use flexure_core::model::Fjr;
use flexure_core::scalar::Scalar;

use crate::files::{Problem, Problems};
use crate::robot;
use crate::robot::links::FromFile;

/// Largest joint count of a tree. To raise it, add a capacity to the list below and build again.
pub const MAX_JOINTS: usize = 16;

/// Evaluates `$then` with `$L<C>` the links of the robot file `$data` over constants of type `C`, and `$N` their capacity.
/// Returns with the problem from the function that it stands in if the robot has more than [`MAX_JOINTS`] joints.
///
/// With the word `roomy` trees of every size get the largest capacity: for what is asked now and then, it saves two thirds of
/// the code.
macro_rules! sized {
    (roomy $data:expr, $L:ident, $N:ident => $then:expr) => {
        $crate::robot::links::with_closed_forms!({ 16 } ($data) $L $N $then)
    };
    ($data:expr, $L:ident, $N:ident => $then:expr) => {
        $crate::robot::links::with_closed_forms!({ 4 8 16 } ($data) $L $N $then)
    };
}
pub(crate) use sized;

/// [`sized`] with the names of the closed forms, whose sizes are their own, and the capacities of trees before its arguments.
macro_rules! of_size {
    ([$($form:ident),+] { $($capacity:literal)+ } ($data:expr) $L:ident $N:ident $then:expr) => {
        match &$data.links {
            $(
                $crate::robot::Links::$form(_) => {
                    #[allow(dead_code, reason = "some callers need the type, some the size")]
                    type $L<C> = flexure_core::robots::$form<C>;
                    const $N: usize = <$crate::robot::$form as $crate::robot::links::ClosedForm<f64>>::JOINTS;
                    $then
                }
            )+
            $crate::robot::Links::Tree(bodies) => match bodies.len() {
                $(0..=$capacity => {
                    #[allow(dead_code, reason = "some callers need the type, some the size")]
                    type $L<C> = flexure_core::robots::Tree<C, $capacity>;
                    const $N: usize = $capacity;
                    $then
                })+
                joints => return Err($crate::robot::sized::too_many($data, joints)),
            },
        }
    };
}
pub(crate) use of_size;

/// Whether this program is built for the robot's joint count.
///
/// # Errors
/// For a robot with more than [`MAX_JOINTS`] moving joints.
pub fn supported(data: &robot::Robot) -> Result<(), Problems> {
    if data.joint_count() > MAX_JOINTS { Err(too_many(data, data.joint_count())) } else { Ok(()) }
}

pub(crate) fn too_many(data: &robot::Robot, joints: usize) -> Problems {
    let message = format!(
        "robot {} has {joints} moving joints; this program is built for at most {MAX_JOINTS}",
        data.name
    );
    let help = "lock joints, or add a capacity to the list in robot/sized.rs and build again";
    data.places.problem("links", "joints", message, help).into()
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
        format!("{} is {} with joints: {}", robot.name, robot.links.what(), robot.joint_count())
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
