//! What a file says of a joint, as it is written: decimals, until they are assembled over some type of numbers.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

use crate::robot::links::JointKind;
use crate::robot::links::rigid::{Pose, Rigid, Weight};

/// A frame in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Origin of the frame \[m\].
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw [rad].
    pub rpy: [f64; 3],
}

impl Frame {
    pub fn pose<S: Scalar>(&self, number: impl Fn(f64) -> S) -> Pose<S> {
        Pose::new(self.xyz.map(&number), self.rpy.map(number))
    }
}

/// A body in the frame of its joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Matter {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: [f64; 3],
    /// Rotational inertia about the centre of mass [kg m²]: ixx, ixy, ixz, iyy, iyz, izz.
    pub inertia: [f64; 6],
    /// Orientation of the axes of the inertia [rad].
    pub inertia_rpy: [f64; 3],
}

impl Matter {
    /// No body.
    pub const NOTHING: Self = Self { mass: 0.0, com: [0.0; 3], inertia: [0.0; 6], inertia_rpy: [0.0; 3] };

    pub fn rigid<S: Scalar>(&self, number: impl Fn(f64) -> S) -> Rigid<S> {
        let axes = Pose::new([S::ZERO; 3], self.inertia_rpy.map(&number)).rotation;
        let weight = (self.mass != 0.0)
            .then(|| Weight { mass: number(self.mass), com: Vector(self.com.map(&number)) });
        Rigid { weight, inertia: axes * symmetric(self.inertia.map(&number)) * axes.transpose() }
    }
}

/// The matrix of (xx, xy, xz, yy, yz, zz).
pub(crate) fn symmetric<S: Scalar>([xx, xy, xz, yy, yz, zz]: [S; 6]) -> Matrix<S, 3, 3> {
    Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
}

/// The direction of a joint axis, of any length but zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis(pub [f64; 3]);

impl Axis {
    /// Its unit vector. Along a coordinate axis nothing is rounded.
    pub fn unit<S: Scalar>(&self, number: impl Fn(f64) -> S) -> [S; 3] {
        if self.0.iter().filter(|&&x| x != 0.0).count() == 1 {
            return self.0.map(|x| if x == 0.0 { S::ZERO } else { S::from_f64(x.signum()) });
        }
        let along = Vector(self.0.map(number));
        let [x, y, z] = along.0.map(S::square);
        let length = (x + y + z).sqrt();
        along.map(|x| x / length).0
    }
}

/// Where a joint is held still [rad or m]: where it is locked, or what mimicry makes of where another one is.
#[derive(Clone, Debug)]
pub(crate) struct Hold {
    /// Position of the joint that is locked.
    pub position: f64,
    /// From this joint to the one that is locked: multiplier and offset of each that mimics the next.
    pub mimicry: Vec<(f64, f64)>,
}

impl Hold {
    /// The frame of the held joint in the frame that it has at zero.
    pub fn pose<S: Scalar>(&self, kind: JointKind, axis: &Axis, number: impl Fn(f64) -> S) -> Pose<S> {
        let locked = number(self.position);
        let follow = |q: S, &(multiplier, offset): &(f64, f64)| number(multiplier) * q + number(offset);
        let q = self.mimicry.iter().rev().fold(locked, follow);
        match kind {
            JointKind::Revolute => Pose::turned(axis.unit(number), q),
            JointKind::Prismatic => Pose::slid(axis.unit(number), q),
        }
    }
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Axis, Hold, JointKind};
    use crate::files::decimals::Decimals;

    /// A direction along a coordinate axis is a unit vector whatever its length, even where floats say little of it.
    #[test]
    fn coordinate_axes_are_exact() {
        let unit = Axis([0.0, -0.1, 0.0]).unit(|x| Decimals::Longer.enclose(x));
        assert_eq!(unit.map(|x| (x.lo(), x.hi())), [(0.0, 0.0), (-1.0, -1.0), (0.0, 0.0)]);
        let unit = Axis([0.3, 0.0, 0.4]).unit(|x| Decimals::Shortest.enclose(x));
        for (bounds, decimal) in unit.into_iter().zip(["0.6", "0.0", "0.8"]) {
            assert!(
                bounds.contains_interval(Interval::from_decimal(decimal).expect("a decimal")),
                "{bounds:?}"
            );
            assert!(bounds.width() < 1e-15, "{bounds:?}");
        }
    }

    /// −2 (0.5 · 0.4 + 0.1) + 0.7 = 0.1 m along x; in decimals, not in floats.
    #[test]
    fn mimicry_is_followed_from_the_locked_joint_on() {
        let hold = Hold { position: 0.4, mimicry: vec![(-2.0, 0.7), (0.5, 0.1)] };
        let axis = Axis([1.0, 0.0, 0.0]);
        let slid = hold.pose(JointKind::Prismatic, &axis, |x| x);
        assert!((slid.translation[0] - 0.1).abs() < 1e-15); // rounding of 0.7 − 0.6
        let bounds = hold.pose(JointKind::Prismatic, &axis, |x| Decimals::Shortest.enclose(x)).translation;
        assert!(bounds[0].contains_interval(Interval::from_decimal("0.1").expect("a decimal")), "{bounds:?}");
        assert!(bounds[0].width() < 1e-15 && bounds[1].width() == 0.0, "{bounds:?}");
    }
}
