//! Rigid bodies and frames: merging what fixed joints hold together.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

/// A frame in another: turned by `rotation`, then shifted by `translation` \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose<S> {
    pub rotation: Matrix<S, 3, 3>,
    pub translation: Vector<S, 3>,
}

impl<S: Scalar> Pose<S> {
    pub fn identity() -> Self {
        Self { rotation: Matrix::identity(), translation: Vector::ZERO }
    }

    /// From `xyz` \[m\] and `rpy` [rad]: roll about x, then pitch about y, then yaw about z, all of the outer frame, as
    /// in URDF.
    pub fn new(xyz: [S; 3], rpy: [S; 3]) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = rpy.map(S::sin_cos);
        let (zero, one) = (S::ZERO, S::ONE);
        let roll = Matrix([[one, zero, zero], [zero, cr, -sr], [zero, sr, cr]]);
        let pitch = Matrix([[cp, zero, sp], [zero, one, zero], [-sp, zero, cp]]);
        let yaw = Matrix([[cy, -sy, zero], [sy, cy, zero], [zero, zero, one]]);
        Self { rotation: yaw * pitch * roll, translation: Vector(xyz) }
    }

    /// Turned by `angle` [rad] about the unit vector `axis` (Rodrigues).
    pub fn turned(axis: [S; 3], angle: S) -> Self {
        let ((sin, cos), [x, y, z], zero) = (angle.sin_cos(), axis, S::ZERO);
        let cross = Matrix([[zero, -z, y], [z, zero, -x], [-y, x, zero]]);
        let rotation = Matrix::identity() + cross.scaled(sin) + (cross * cross).scaled(S::ONE - cos);
        Self { rotation, translation: Vector::ZERO }
    }

    /// Shifted by `distance` \[m\] along the unit vector `axis`.
    pub fn slid(axis: [S; 3], distance: S) -> Self {
        Self { rotation: Matrix::identity(), translation: Vector(axis).scaled(distance) }
    }

    /// The frame that is `inner` in this one.
    pub fn then(&self, inner: &Self) -> Self {
        Self { rotation: self.rotation * inner.rotation, translation: self.of(inner.translation) }
    }

    /// A point of this frame in the outer one.
    pub fn of(&self, point: Vector<S, 3>) -> Vector<S, 3> {
        self.rotation * point + self.translation
    }
}

/// A rigid body in some frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rigid<S> {
    /// None if it has no mass, exactly: no number has to be compared with zero.
    pub weight: Option<Weight<S>>,
    /// Rotational inertia about the centre of mass, in the axes of the frame [kg m²].
    pub inertia: Matrix<S, 3, 3>,
}

/// A mass at its centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight<S> {
    /// Mass \[kg\].
    pub mass: S,
    /// Centre of mass \[m\].
    pub com: Vector<S, 3>,
}

impl<S: Scalar> Rigid<S> {
    /// Mass \[kg\].
    pub fn mass(&self) -> S {
        self.weight.map_or(S::ZERO, |weight| weight.mass)
    }

    /// The body seen from the frame in which its own frame stands at `pose`.
    pub fn seen_from(&self, pose: &Pose<S>) -> Self {
        let weight = self.weight.map(|weight| Weight { com: pose.of(weight.com), ..weight });
        Self { weight, inertia: pose.rotation * self.inertia * pose.rotation.transpose() }
    }

    /// The body that both are when they are held together.
    pub fn joined(&self, other: &Self) -> Self {
        match (self.weight, other.weight) {
            (None, weight) | (weight, None) => Self { weight, inertia: self.inertia + other.inertia },
            (Some(a), Some(b)) => {
                let mass = a.mass + b.mass;
                let com = (a.com.scaled(a.mass) + b.com.scaled(b.mass)).scaled(mass.recip());
                let inertia = self.inertia_about(&com) + other.inertia_about(&com);
                Self { weight: Some(Weight { mass, com }), inertia }
            }
        }
    }

    /// Rotational inertia about `point`: parallel axes.
    pub fn inertia_about(&self, point: &Vector<S, 3>) -> Matrix<S, 3, 3> {
        let Some(Weight { mass, com }) = self.weight else { return self.inertia };
        let r = com - *point;
        let [x, y, z] = r.0.map(S::square);
        let diagonal = [y + z, x + z, x + y];
        let steiner = Matrix::from_fn(|i, j| if i == j { diagonal[i] } else { -(r[i] * r[j]) });
        self.inertia + steiner.scaled(mass)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::{Matrix, Pose, Rigid, Vector, Weight};

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

    fn body(mass: f64, com: [f64; 3], inertia: Matrix<f64, 3, 3>) -> Rigid<f64> {
        Rigid { weight: Some(Weight { mass, com: Vector(com) }), inertia }
    }

    /// Two points of 1 and 3 kg, 2 m apart on x: centre at 1.5 m, inertia 1·1.5² + 3·0.5² = 3 kg m² about y and z.
    #[test]
    fn two_points_by_hand() {
        let point = |mass, x| body(mass, [x, 0.0, 0.0], Matrix::ZERO);
        let both = point(1.0, 0.0).joined(&point(3.0, 2.0));
        let Weight { mass, com } = both.weight.expect("mass");
        assert_close([[mass]], [[4.0]], 0.0);
        assert_close([com.0], [[1.5, 0.0, 0.0]], 1e-15);
        assert_close(both.inertia.0, [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]], 1e-15);
    }

    /// What has no mass has no centre: its inertia adds, wherever it is.
    #[test]
    fn a_massless_body_adds_its_inertia() {
        let wheel = Rigid { weight: None, inertia: Matrix::identity() };
        let both = body(2.0, [0.1, 0.2, 0.3], Matrix::ZERO).joined(&wheel);
        assert_close(both.inertia.0, Matrix::identity().0, 0.0);
        assert_close([both.weight.expect("mass").com.0], [[0.1, 0.2, 0.3]], 0.0);
        assert_close([[wheel.joined(&wheel).mass()]], [[0.0]], 0.0);
    }

    /// The kinetic energy of a body does not ask in which pieces or frames it is written down.
    #[test]
    fn kinetic_energy_survives_merging() {
        let inertia = Matrix([[0.3, 0.02, -0.01], [0.02, 0.4, 0.03], [-0.01, 0.03, 0.5]]);
        let a = body(2.0, [0.1, -0.2, 0.3], inertia);
        let b = body(0.7, [0.0, 0.05, 0.2], inertia.scaled(0.1));
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
    fn energy(body: &Rigid<f64>, omega: Vector<f64, 3>, velocity: Vector<f64, 3>) -> f64 {
        let Weight { mass, com } = body.weight.expect("mass");
        let v = velocity + cross(omega, com);
        0.5 * (mass * v.dot(&v) + omega.dot(&(body.inertia * omega)))
    }

    fn cross(a: Vector<f64, 3>, b: Vector<f64, 3>) -> Vector<f64, 3> {
        Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }
}
