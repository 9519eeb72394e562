//! A tree of revolute and prismatic joints, with O(n) recursions.
//!
//! Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapters 5 to 7.

mod factor;
mod joint;
mod recursions;

use core::mem::discriminant;

use crate::linalg::{Matrix, Vector};
use crate::scalar::Scalar;
use crate::spatial::{Fixed, RigidInertia, Rotation, Vec3};

pub use factor::{Articulated, Dense, TreeFactor};
use joint::{Joint, Pose};

/// How a joint moves along or about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about the axis in rad.
    Revolute,
    /// Translation along the axis in m.
    Prismatic,
}

/// A body and the joint that carries it, as data with constants of type `C`: the unit a [`Tree`] is built from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<C = f64> {
    /// Index of the body that carries the joint, smaller than the body's own; none for the base.
    pub parent: Option<usize>,
    /// Kind of joint.
    pub kind: JointKind,
    /// Unit joint axis in the joint frame.
    pub axis: [C; 3],
    /// Orientation of the joint frame at q = 0 in the parent's link frame (columns are its axes).
    pub rotation: [[C; 3]; 3],
    /// Origin of the joint frame in the parent's link frame in m.
    pub translation: [C; 3],
    /// Mass in kg.
    pub mass: C,
    /// Centre of mass in the link frame in m.
    pub com: [C; 3],
    /// Rotational inertia about the centre of mass in link axes [kg m²].
    pub inertia: [[C; 3]; 3],
}

impl<C: Copy> Body<C> {
    /// The same body with every number through `f`.
    pub fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> Body<D> {
        Body {
            parent: self.parent,
            kind: self.kind,
            axis: self.axis.map(&f),
            rotation: self.rotation.map(|row| row.map(&f)),
            translation: self.translation.map(&f),
            mass: f(self.mass),
            com: self.com.map(&f),
            inertia: self.inertia.map(|row| row.map(&f)),
        }
    }
}

/// Rigid links joined in a tree: up to `N` joints, constants of type `C`.
///
/// Firmware takes exactly as many joints as the robot has ([`Tree::new`]), a program that reads robots from files one capacity
/// for many robots ([`Tree::from_bodies`]). Joints beyond [`joints`](Self::joints) are *phantoms*: they hang on the base, have
/// unit inertia (1 kg m²), feel no gravity and are coupled to nothing. Their block of the mass matrix is the identity,
/// solving with it and inverse dynamics give back what they are given there, and gravity, potential energy and carrier rates
/// are 0. What is built on [`Links`](crate::model::Links) therefore needs no special case: a phantom that starts at rest with
/// a reference of 0 stays exactly there, with a torque of exactly 0, and the numbers of the real joints are those of the tree
/// of exact size. What divides must not be 0 for it either: stiffness, motor inertia, gear ratio, the metric of the motors, Λ of a
/// coupled tanh, bandwidths and limits are positive, for instance 1; any other gain or damping may be 0. Recursions run over the
/// real joints only.
///
/// Link frames are turned so that every joint axis is z, and x perpendicular to the axis of the first joint that a body carries, after
/// Denavit and Hartenberg: joint transforms then cost four products, and four with constants, instead of nine and nine.
///
/// ```
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::Links;
/// use flexure_core::robots::{Body, JointKind, Tree};
///
/// // A pendulum of 2 kg on a horizontal axis (y), its centre of mass 0.5 m below it.
/// let pendulum = Body {
///     parent: None,
///     kind: JointKind::Revolute,
///     axis: [0.0, 1.0, 0.0],
///     rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     translation: [0.0; 3],
///     mass: 2.0,
///     com: [0.0, 0.0, -0.5],
///     inertia: [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]],
/// };
/// let gravity = [0.0, 0.0, -10.0];
/// let exact = Tree::new(&[pendulum], gravity).unwrap();
/// // m r² + I, and m g r where the link is horizontal.
/// assert!((exact.mass_matrix(&Vector([0.3]))[(0, 0)] - 0.6).abs() < 1e-12);
/// let horizontal = core::f64::consts::FRAC_PI_2;
/// assert!((exact.gravity_torque(&Vector([horizontal]))[0] - 10.0).abs() < 1e-12);
///
/// // The same robot where up to four joints fit.
/// let roomy: Tree<f64, 4> = Tree::from_bodies(&[pendulum], gravity, |x| x).unwrap();
/// assert_eq!(roomy.joints(), 1);
/// assert_eq!(roomy.gravity_torque(&Vector([0.7, 0.0, 0.0, 0.0]))[0], exact.gravity_torque(&Vector([0.7]))[0]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Tree<C, const N: usize> {
    joints: [Joint<C>; N],
    /// Joints that are no phantoms, at most `N`.
    count: usize,
    gravity: Vec3<C>,
    /// First moment of mass [kg m] that no joint moves, in the base frame.
    grounded: Vec3<C>,
}

impl<const N: usize> Tree<f64, N> {
    /// A tree of exactly `N` joints: from bodies in an order where parents come before children, and the gravity vector in
    /// the base frame [m/s²].
    ///
    /// None if some body's parent does not come before it. The physics (positive masses and inertias, unit axes) is
    /// the caller's duty: the file reader checks it where it can point at the number.
    pub fn new(bodies: &[Body; N], gravity: [f64; 3]) -> Option<Self> {
        Self::from_bodies(bodies, gravity, |x| x)
    }
}

impl<C: Scalar, const N: usize> Tree<C, N> {
    /// [`new`](Tree::new) from at most `N` bodies and over any constants: on intervals the tree encloses every robot whose
    /// numbers they contain. Joints that no body is given for are phantoms.
    ///
    /// `approximate` gives a float near a constant. It only says which coordinate axis, of those far from the joint axis,
    /// the turned frame of a joint starts from, and whether two axes are far enough from parallel to have a common normal: the tree is the same
    /// robot with any answer. Axes that are coordinate axes turn frames by permutations, which round nothing.
    ///
    /// None if there are more than `N` bodies or some body's parent does not come before it.
    pub fn from_bodies(bodies: &[Body<C>], gravity: [C; 3], approximate: impl Fn(C) -> f64) -> Option<Self>
    where
        C: PartialEq,
    {
        let ordered = bodies.iter().enumerate().all(|(i, body)| body.parent.is_none_or(|parent| parent < i));
        let frame = |i: usize, body: &Body<C>| link_frame(bodies, i, body, &approximate);
        let joint = |i: usize, body: &Body<C>| {
            let own = frame(i, body).turn;
            // Everything that was said in the parent's link frame, in the parent's turned frame.
            let carrier = body.parent.and_then(|parent| Some((parent, bodies.get(parent)?)));
            let carrier = carrier.map(|(parent, body)| frame(parent, body));
            let about_x = carrier.as_ref().is_some_and(|carrier| carrier.across == Some(i));
            let carrier = carrier.map_or_else(Matrix::identity, |carrier| carrier.turn);
            let rotation = carrier.transpose() * Matrix(body.rotation) * own;
            let translation = carrier.transpose() * Vector(body.translation);
            let com = own.transpose() * Vector(body.com);
            let inertia = own.transpose() * Matrix(body.inertia) * own;
            let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = inertia.0;
            let (rotation, phase) = if about_x {
                // A turn about z and then one about x has the first row (cos, −sin, 0) of the former and the third column
                // (0, −sin, cos) of the latter.
                let [[cos_0, minus_sin_0, _], [.., minus_sin], [.., cos]] = rotation.0;
                (Fixed::AboutX { sin: -minus_sin, cos }, [-minus_sin_0, cos_0])
            } else {
                (Fixed::General(Rotation::from_matrix(&rotation)), [C::ZERO, C::ONE])
            };
            Joint {
                parent: body.parent.unwrap_or(usize::MAX),
                kind: body.kind,
                rotation,
                phase,
                translation: Vec3::from_array(translation.0),
                inertia: RigidInertia::new(body.mass, com.0, [xx, xy, xz, yy, yz, zz]),
            }
        };
        let joints =
            core::array::from_fn(|i| bodies.get(i).map_or_else(Joint::phantom, |body| joint(i, body)));
        let mut tree =
            Self { joints, count: bodies.len(), gravity: Vec3::from_array(gravity), grounded: Vec3::ZERO };
        (ordered && bodies.len() <= N).then(|| {
            tree.regroup();
            tree
        })
    }

    /// Gives the mass on the axis of each revolute joint to its parent, which moves all points of that axis as the body does: fewer numbers
    /// say the same. On the base it only has potential energy.
    fn regroup(&mut self) {
        for i in (0..self.count).rev() {
            let Some(joint) = self.joints.get_mut(i).filter(|joint| !joint.is_prismatic()) else { continue };
            let (axis, p, e) = (joint.inertia.split_axis(), joint.translation, joint.rotation.axis());
            match self.joints.get(i).map(|joint| joint.parent).and_then(|parent| self.joints.get_mut(parent))
            {
                Some(parent) => parent.inertia.add_axis(&axis, p, e),
                None => self.grounded += p.scaled(axis.mass) + e.scaled(axis.first_moment),
            }
        }
    }

    /// How many joints the robot has, at most the capacity `N`; those beyond are phantoms.
    #[inline]
    pub fn joints(&self) -> usize {
        self.count
    }

    /// The real joints with their poses, from the base outwards; backwards, from the tips inwards.
    #[inline]
    fn chain<'a, T>(
        &'a self,
        poses: &'a [Pose<T>; N],
    ) -> impl DoubleEndedIterator<Item = (usize, (&'a Joint<C>, &'a Pose<T>))> {
        (0..self.count).filter_map(|i| Some((i, (self.joints.get(i)?, poses.get(i)?))))
    }

    /// Whether it has the structure of `other`, whatever the numbers: as many joints, of the same kinds, on the same bodies, in frames that were
    /// chosen alike.
    pub fn is_like(&self, other: &Self) -> bool {
        let structure = |joint: &Joint<C>| (joint.parent, joint.kind, discriminant(&joint.rotation));
        let mut joints = self.joints.iter().zip(&other.joints);
        self.count == other.count && joints.all(|(a, b)| structure(a) == structure(b))
    }

    /// The same robot with constants of another type.
    pub fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Tree<D, N> {
        Tree {
            joints: self.joints.each_ref().map(|joint| joint.map(&f)),
            count: self.count,
            gravity: self.gravity.map(&f),
            grounded: self.grounded.map(&f),
        }
    }
}

/// The frame of a link, in which its joint moves about or along z.
struct Frame<C> {
    /// Its axes as columns, in the link frame that the body was given in.
    turn: Matrix<C, 3, 3>,
    /// The body whose joint axis x is perpendicular to.
    across: Option<usize>,
}

/// The frame of body `i`: z along its joint axis and, after Denavit and Hartenberg, x along the common normal of that axis and the axis of the
/// first joint that it carries. Parallel axes decide nothing; of axes that are nearly parallel the normal would be known badly.
fn link_frame<C: Scalar + PartialEq>(
    bodies: &[Body<C>],
    i: usize,
    body: &Body<C>,
    approximate: impl Fn(C) -> f64,
) -> Frame<C> {
    let turn = axis_frame(body.axis, &approximate);
    let carried = bodies.iter().enumerate().find(|(_, other)| other.parent == Some(i));
    let Some((child, other)) = carried else { return Frame { turn, across: None } };
    let Vector([u, v, _]) = turn.transpose() * (Matrix(other.rotation) * Vector(other.axis));
    let square = u.square() + v.square();
    if u == C::ZERO {
        return Frame { turn, across: Some(child) };
    }
    if approximate(square) < NEARLY_PARALLEL {
        return Frame { turn, across: None };
    }
    let reciprocal = square.sqrt().recip();
    let (x, y) = (-(v * reciprocal), u * reciprocal);
    let zero = C::ZERO;
    Frame { turn: turn * Matrix([[x, -y, zero], [y, x, zero], [zero, zero, C::ONE]]), across: Some(child) }
}

/// Squared sine of the angle of two axes, about 6°, below which their normal would lose more than a digit.
const NEARLY_PARALLEL: f64 = 0.01;

/// A rotation whose third column is the unit vector `axis`; a permutation of axes where `axis` is one of them, so
/// that nothing is rounded.
fn axis_frame<C: Scalar>(axis: [C; 3], approximate: impl Fn(C) -> f64) -> Matrix<C, 3, 3> {
    let [ax, ay, az] = axis.map(|x| libm::fabs(approximate(x)));
    // The coordinate axis farthest from the joint axis, made orthogonal to it, is the first column.
    let farthest = if ax <= ay && ax <= az {
        [C::ONE, C::ZERO, C::ZERO]
    } else if ay <= az {
        [C::ZERO, C::ONE, C::ZERO]
    } else {
        [C::ZERO, C::ZERO, C::ONE]
    };
    let k = Vec3::from_array(axis);
    let e = Vec3::from_array(farthest);
    let first = e - k.scaled(k.dot(e));
    let first = first.scaled(first.dot(first).sqrt().recip());
    let second = k.cross(first);
    Matrix([[first.x, second.x, k.x], [first.y, second.y, k.y], [first.z, second.z, k.z]])
}
