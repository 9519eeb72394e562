//! Links that are linear in parameters: Y φ is the inverse dynamics, Yᵀ its transpose.

use flexure_core::linalg::{Ldl, Matrix, Vector};
use flexure_core::model::{Links, Parameters};
use flexure_core::robots::{Body, Pendulum, Tree};
use flexure_core::scalar::Over;

use crate::common::{GRAVITY, Numbers, branched, branched_bodies, close, planar, serial};
use crate::golden::TwoLink;

/// Rounding of a recursion over some bodies, of its largest torque.
const TOLERANCE: f64 = 1e-13;

fn any<const N: usize>(r: &mut Numbers) -> Parameters<f64, N> {
    [(); 10].map(|()| r.vector(1.0))
}

fn sum<const N: usize>(a: &Parameters<f64, N>, b: &Parameters<f64, N>) -> Parameters<f64, N> {
    core::array::from_fn(|k| a[k] + b[k])
}

/// φ·y, and the largest of its terms.
fn dot<const N: usize>(phi: &Parameters<f64, N>, y: &Parameters<f64, N>) -> (f64, f64) {
    let terms = || phi.iter().zip(y).flat_map(|(phi, y)| (0..N).map(|i| phi[i] * y[i]));
    (terms().sum(), terms().fold(0.0, |m: f64, term| m.max(term.abs())))
}

fn linear<L: Links<f64, N>, const N: usize>(links: &L, r: &mut Numbers) {
    let [q, v, v_r, a_r, s] = [(); 5].map(|()| r.vector::<N>(1.5));
    let own = links.parameters();
    let torque = |phi: &Parameters<f64, N>| links.regressor_mul(phi, &q, &v, &v_r, &a_r);
    close(&torque(&own), &links.inverse_dynamics(&q, &v, &v_r, &a_r), TOLERANCE);

    let (one, other) = (any(r), any(r));
    close(&torque(&sum(&one, &other)), &(torque(&one) + torque(&other)), TOLERANCE);

    let powers = links.regressor_transpose_mul(&q, &v, &v_r, &a_r, &s);
    for phi in [&own, &one] {
        let ((power, largest), torque) = (dot(phi, &powers), torque(phi));
        let size = (0..N).fold(largest, |m: f64, i| m.max((s[i] * torque[i]).abs()));
        assert!((s.dot(&torque) - power).abs() <= TOLERANCE * size, "{} {power}", s.dot(&torque));
        assert!(power.abs() > 1e-6 * size);
    }

    let (mass, expected) = (links.mass_matrix_of(&own, &q), links.mass_matrix(&q));
    for i in 0..N {
        close(&Vector(mass.0[i]), &Vector(expected.0[i]), TOLERANCE);
    }
}

#[test]
fn torques_are_linear_in_parameters_and_the_regressor_has_its_transpose() {
    let r = &mut Numbers(31);
    for _ in 0..20 {
        linear(&Pendulum { inertia: 0.2, weight_moment: 3.0 }, r);
        linear(&planar(), r);
        linear(&TwoLink::UPRIGHT, r);
        linear(&branched::<5>(2), r);
        linear(&serial::<7>(), r);
    }
}

/// Bodies of other masses on the same joints: the parameters of one tree in the regressor of the other.
#[test]
fn parameters_of_a_tree_are_those_of_its_bodies() {
    let r = &mut Numbers(32);
    let bodies = branched_bodies::<5>(2);
    let heavier: [Body; 5] = bodies.map(|body| Body {
        mass: body.mass + 1.0,
        com: [0.1 * r.next(), 0.1 * r.next(), 0.1 * r.next()],
        inertia: [[0.03, 0.002, -0.001], [0.002, 0.04, 0.003], [-0.001, 0.003, 0.05]],
        ..body
    });
    let [one, other] = [bodies, heavier].map(|bodies| Tree::new(&bodies, GRAVITY).expect("a tree"));
    for _ in 0..20 {
        let [q, v, v_r, a_r] = [(); 4].map(|()| r.vector::<5>(1.5));
        let found = one.regressor_mul(&other.parameters(), &q, &v, &v_r, &a_r);
        close(&found, &other.inverse_dynamics(&q, &v, &v_r, &a_r), TOLERANCE);
    }
}

/// Joints that only fill a capacity have no parameters, and unit inertia whatever φ is.
#[test]
fn phantoms_have_no_parameters() {
    let r = &mut Numbers(33);
    let roomy: Tree<f64, 7> =
        Tree::from_bodies(&branched_bodies::<5>(2), GRAVITY, |x| x).expect("a tree that fits");
    let exact = branched::<5>(2);
    let [q, v, v_r, a_r, s] = [(); 5].map(|()| r.vector::<7>(1.5));
    let short = |x: &Vector<f64, 7>| Vector::<f64, 5>::from_fn(|i| x[i]);
    let phi = any::<7>(r);
    let torque = roomy.regressor_mul(&phi, &q, &v, &v_r, &a_r);
    let [q_5, v_5, v_r_5, a_r_5, s_5] = [&q, &v, &v_r, &a_r, &s].map(short);
    let expected = exact.regressor_mul(&phi.each_ref().map(short), &q_5, &v_5, &v_r_5, &a_r_5);
    assert_eq!(short(&torque), expected);
    assert_eq!(Vector([torque[5], torque[6]]), Vector([a_r[5], a_r[6]]));
    let powers = roomy.regressor_transpose_mul(&q, &v, &v_r, &a_r, &s);
    let expected = exact.regressor_transpose_mul(&q_5, &v_5, &v_r_5, &a_r_5, &s_5);
    for ((powers, expected), own) in powers.iter().zip(expected).zip(roomy.parameters()) {
        assert_eq!(short(powers), expected);
        assert_eq!(Vector([powers[5], powers[6], own[5], own[6]]), Vector::ZERO);
    }
}

/// A mass in kg that slides up and down, and says nothing of parameters.
struct Lift(f64);

impl Links<f64, 1> for Lift {
    type Factor<'a, T: Over<f64>> = Ldl<T, 1>;

    fn mass_matrix<T: Over<f64>>(&self, _: &Vector<T, 1>) -> Matrix<T, 1, 1> {
        Matrix([[T::from_f64(self.0)]])
    }

    fn potential_energy<T: Over<f64>>(&self, q: &Vector<T, 1>) -> T {
        q[0].scale(9.81 * self.0)
    }

    fn carrier_rates<T: Over<f64>>(&self, _: &Vector<T, 1>, _: &Vector<T, 1>) -> Vector<T, 1> {
        Vector::ZERO
    }

    fn factor<T: Over<f64>>(&self, q: &Vector<T, 1>) -> Ldl<T, 1> {
        self.mass_matrix(q).ldl()
    }
}

#[test]
fn of_links_that_name_no_parameters_none_is_adapted() {
    let (lift, x, a) = (Lift(2.0), Vector([0.3]), Vector([1.5]));
    assert_eq!(lift.parameters(), [Vector([0.0]); 10]);
    let phi = any(&mut Numbers(34));
    assert_eq!(lift.regressor_mul(&phi, &x, &x, &x, &a), Vector([2.0 * (9.81 + 1.5)]));
    assert_eq!(lift.regressor_transpose_mul(&x, &x, &x, &a, &x), [Vector([0.0]); 10]);
    assert!((lift.mass_matrix_of(&phi, &x)[(0, 0)] - 2.0).abs() < 1e-14);
}

/// A slot that regrouping empties is no parameter: what lies on the axis of a revolute joint is the parent's.
#[test]
fn what_is_regrouped_away_stays_zero() {
    let arm = serial::<7>();
    let [mass, _, _, along, .., second_along] = arm.parameters();
    assert_eq!([mass, along, second_along], [Vector::ZERO; 3]);
    let one = Vector([1.0; 7]);
    let [mass, .., second_along] = arm.regressor_transpose_mul(&one, &one, &one, &one, &one);
    assert_eq!([mass, second_along], [Vector::ZERO; 2]);
}
