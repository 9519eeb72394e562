//! Rigid bodies and frames: merging what fixed joints hold together.

use flexure_core::linalg::{Matrix, Vector};

/// A frame in another: turned by `rotation`, then shifted by `translation` \[m\].
#[derive(Clone, Copy, Debug)]
pub(in crate::io) struct Pose {
    pub rotation: Matrix<f64, 3, 3>,
    pub translation: Vector<f64, 3>,
}

impl Pose {
    pub fn identity() -> Self {
        Self { rotation: Matrix::identity(), translation: Vector::ZERO }
    }

    /// From `xyz` \[m\] and `rpy` [rad]: roll about x, then pitch about y, then yaw about z, all of the outer frame, as
    /// in URDF.
    pub fn new(xyz: [f64; 3], rpy: [f64; 3]) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = rpy.map(f64::sin_cos);
        let roll = Matrix([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]]);
        let pitch = Matrix([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]]);
        let yaw = Matrix([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]]);
        Self { rotation: yaw * pitch * roll, translation: Vector(xyz) }
    }

    /// Turned by `angle` [rad] about the unit vector `axis` (Rodrigues).
    pub fn turned(axis: [f64; 3], angle: f64) -> Self {
        let ((sin, cos), [x, y, z]) = (angle.sin_cos(), axis);
        let cross = Matrix([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]);
        let rotation = Matrix::identity() + cross.scaled(sin) + (cross * cross).scaled(1.0 - cos);
        Self { rotation, translation: Vector::ZERO }
    }

    /// Shifted by `distance` \[m\] along the unit vector `axis`.
    pub fn slid(axis: [f64; 3], distance: f64) -> Self {
        Self { rotation: Matrix::identity(), translation: Vector(axis).scaled(distance) }
    }

    /// The frame that is `inner` in this one.
    pub fn then(&self, inner: &Self) -> Self {
        Self { rotation: self.rotation * inner.rotation, translation: self.of(inner.translation) }
    }

    /// A point of this frame in the outer one.
    pub fn of(&self, point: Vector<f64, 3>) -> Vector<f64, 3> {
        self.rotation * point + self.translation
    }
}

/// A rigid body in some frame.
#[derive(Clone, Copy, Debug)]
pub(in crate::io) struct Rigid {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector<f64, 3>,
    /// Rotational inertia about the centre of mass, in the axes of the frame [kg m²].
    pub inertia: Matrix<f64, 3, 3>,
}

impl Rigid {
    /// A body without mass.
    pub const NOTHING: Self = Self { mass: 0.0, com: Vector::ZERO, inertia: Matrix::ZERO };

    /// The body seen from the frame in which its own frame stands at `pose`.
    pub fn seen_from(&self, pose: &Pose) -> Self {
        let inertia = pose.rotation * self.inertia * pose.rotation.transpose();
        Self { mass: self.mass, com: pose.of(self.com), inertia }
    }

    /// Both bodies, held together.
    pub fn joined(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Self { mass, com: Vector::ZERO, inertia: self.inertia + other.inertia };
        }
        let com = (self.com.scaled(self.mass) + other.com.scaled(other.mass)).scaled(mass.recip());
        Self { mass, com, inertia: self.inertia_about(&com) + other.inertia_about(&com) }
    }

    /// Rotational inertia about `point`: parallel axes.
    pub fn inertia_about(&self, point: &Vector<f64, 3>) -> Matrix<f64, 3, 3> {
        let r = self.com - *point;
        let steiner = Matrix::from_fn(|i, j| if i == j { r.dot(&r) } else { 0.0 } - r[i] * r[j]);
        self.inertia + steiner.scaled(self.mass)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::{Matrix, Pose, Rigid, Vector};

    fn assert_close<const R: usize, const C: usize>(a: [[f64; C]; R], b: [[f64; C]; R], tolerance: f64) {
        for (x, y) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((x - y).abs() <= tolerance, "{a:?} against {b:?}");
        }
    }

    /// A roll of 90° takes y to z; then a yaw of 90° about the outer z takes x to y and leaves z: fixed axes. With
    /// moving axes y would end on −x.
    #[test]
    fn roll_pitch_yaw_are_about_fixed_axes_in_this_order() {
        let pose = Pose::new([1.0, 2.0, 3.0], [FRAC_PI_2, 0.0, FRAC_PI_2]);
        assert_close([pose.of(Vector([0.0, 1.0, 0.0])).0], [[1.0, 2.0, 4.0]], 1e-15);
        assert_close([pose.of(Vector([1.0, 0.0, 0.0])).0], [[1.0, 3.0, 3.0]], 1e-15);
        let pitched = Pose::new([0.0; 3], [0.0, FRAC_PI_2, 0.0]);
        assert_close([pitched.of(Vector([1.0, 0.0, 0.0])).0], [[0.0, 0.0, -1.0]], 1e-15);
    }

    /// Two points of 1 and 3 kg, 2 m apart on x: centre at 1.5 m, inertia 1·1.5² + 3·0.5² = 3 kg m² about y and z.
    #[test]
    fn two_points_by_hand() {
        let point = |mass, x| Rigid { mass, com: Vector([x, 0.0, 0.0]), inertia: Matrix::ZERO };
        let both = point(1.0, 0.0).joined(&point(3.0, 2.0));
        assert_close([[both.mass]], [[4.0]], 0.0);
        assert_close([both.com.0], [[1.5, 0.0, 0.0]], 1e-15);
        assert_close(both.inertia.0, [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]], 1e-15);
    }

    /// The kinetic energy of a body does not ask in which pieces or frames it is written down.
    #[test]
    fn kinetic_energy_survives_merging() {
        let inertia = Matrix([[0.3, 0.02, -0.01], [0.02, 0.4, 0.03], [-0.01, 0.03, 0.5]]);
        let a = Rigid { mass: 2.0, com: Vector([0.1, -0.2, 0.3]), inertia };
        let b = Rigid { mass: 0.7, com: Vector([0.0, 0.05, 0.2]), inertia: inertia.scaled(0.1) };
        let pose = Pose::new([0.4, 0.1, -0.3], [0.3, -0.8, 1.2]);
        let merged = a.joined(&b.seen_from(&pose));
        let (omega, velocity) = (Vector([0.4, -1.1, 0.6]), Vector([0.2, 0.3, -0.5]));
        let expected = energy(&a, omega, velocity) + {
            // Piece b in its own frame: the twist goes there instead of the body coming here.
            let to_b = pose.rotation.transpose();
            energy(&b, to_b * omega, to_b * (velocity + cross(omega, pose.translation)))
        };
        assert_close([[energy(&merged, omega, velocity)]], [[expected]], 1e-14);
    }

    /// ½ m |v_com|² + ½ ωᵀIω of a body whose frame turns at `omega` with its origin at `velocity`.
    fn energy(body: &Rigid, omega: Vector<f64, 3>, velocity: Vector<f64, 3>) -> f64 {
        let v = velocity + cross(omega, body.com);
        0.5 * (body.mass * v.dot(&v) + omega.dot(&(body.inertia * omega)))
    }

    fn cross(a: Vector<f64, 3>, b: Vector<f64, 3>) -> Vector<f64, 3> {
        Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }
}
