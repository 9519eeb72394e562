//! The bodies of a tree with their numbers enclosed. Axes and rotations are widened by their defect, as checkers widen them:
//! a rounded axis stands for the unit vector nearest to it, a rounded rotation for the nearest rotation.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{DecimalBody, JointMotion};
use crate::prove::engine::number::Number;

type V = Vector<Interval, 3>;
type Square = Matrix<Interval, 3, 3>;

/// A body with its numbers enclosed.
pub struct Body {
    pub parent: Option<usize>,
    /// Of a prismatic joint; none of a revolute one.
    pub travel: Option<[Interval; 2]>,
    /// Contains the unit axis.
    pub axis: V,
    /// Contains the rotation.
    pub rotation: Square,
    pub translation: V,
    pub mass: Interval,
    pub com: V,
    /// About the centre of mass.
    pub inertia: Square,
}

impl Body {
    /// Encloses the body of joint `k`.
    ///
    /// # Errors
    /// If the joint slides without limits.
    pub fn new(k: usize, body: &DecimalBody) -> Result<Self, String> {
        let vector = |x: &[Number; 3]| Vector(x.each_ref().map(Number::bounds));
        let travel = match (body.kind, &body.travel) {
            (JointMotion::Revolute, _) => None,
            (JointMotion::Prismatic, Some(ends)) => Some(ends.each_ref().map(Number::bounds)),
            (JointMotion::Prismatic, None) => {
                return Err(format!(
                    "joint {} slides without position_lower and position_upper: the mass matrix has no bound",
                    k + 1
                ));
            }
        };
        let [xx, xy, xz, yy, yz, zz] = body.inertia.each_ref().map(Number::bounds);
        Ok(Self {
            parent: body.parent,
            travel,
            axis: unit(vector(&body.axis)),
            rotation: rotation(Matrix(body.rotation.each_ref().map(|row| vector(row).0))),
            translation: vector(&body.translation),
            mass: body.mass.bounds(),
            com: vector(&body.com),
            inertia: Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
        })
    }

    /// Inertia about, or mass along, the axis of the body's joint: a lower bound; 0 where the body's inertia may be
    /// indefinite or its mass negative.
    fn own_inertia(&self) -> f64 {
        // Thin rods have one axis without inertia, points three.
        let axes: Vec<usize> = (0..3).filter(|&i| self.inertia.0[i] != [Interval::ZERO; 3]).collect();
        let rest = Symmetric::from_fn(axes.len(), |i, j| self.inertia.0[axes[i]][axes[j]]);
        if rest.smallest_pivot() <= 0.0 || self.mass.lo() < 0.0 {
            return 0.0;
        }
        if self.travel.is_some() {
            return self.mass.lo();
        }
        let arm = (cross(self.axis) * self.com).map(Scalar::square);
        let arm_squared = arm.iter().fold(Interval::ZERO, |sum, x| sum + x);
        (self.axis.dot(&(self.inertia * self.axis)) + self.mass * arm_squared).lo()
    }
}

/// Inertia of each body about, or mass along, the axis of its joint: lower bounds; 0 where none can be given.
pub fn own_inertias(bodies: &[DecimalBody]) -> Vec<f64> {
    let own = |(k, body)| Body::new(k, body).map_or(0.0, |body| body.own_inertia());
    bodies.iter().enumerate().map(own).collect()
}

/// [v]×, so that [v]× w = v × w.
pub fn cross<T: Scalar>(v: Vector<T, 3>) -> Matrix<T, 3, 3> {
    let ([x, y, z], zero) = (v.0, T::ZERO);
    Matrix([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
}

/// Contains e/|e|: |e/|e| − e| = |1 − |e|| ≤ |1 − |e|²|.
fn unit(e: V) -> V {
    let square = e.iter().fold(Interval::ZERO, |sum, x| sum + x.square());
    let around = around(square - Interval::ONE);
    e.map(|x| x + around)
}

/// Contains the rotation nearest to R. With singular values s its distance is |s − 1| ≤ |s² − 1| = |R Rᵀ − 1| (Frobenius).
fn rotation(rows: Square) -> Square {
    let gram = Matrix::<_, 3, 3>::from_fn(|i, j| {
        if i == j {
            return rows.row(i).iter().fold(-Interval::ONE, |sum, x| sum + x.square());
        }
        rows.row(i).dot(&rows.row(j))
    });
    let defect = gram.0.iter().flatten().fold(Interval::ZERO, |sum, x| sum + x.square()).sqrt();
    let around = around(defect);
    rows.map(|x| x + around)
}

/// Everything that is no farther from 0 than `x` may be.
fn around(x: Interval) -> Interval {
    let size = x.magnitude();
    Interval::point(-size).hull(Interval::point(size))
}
