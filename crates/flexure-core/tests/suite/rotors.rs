//! Rotor coupling against trees in which every rotor is a body of its own.

use core::f64::consts::FRAC_PI_2;

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion, RotorCoupling};
use flexure_core::robots::{Body, JointKind, Pendulum, Tree};
#[cfg(feature = "interval")]
use flexure_core::scalar::Interval;

use crate::common::{GRAVITY, IDENTITY, Numbers, branched_bodies, close, planar, rotation};

/// A balanced rotor on a body, in that body's frame.
#[derive(Clone, Copy)]
struct Rotor {
    mass: f64,
    com: Vector<f64, 3>,
    axis: Vector<f64, 3>,
    /// About its axis, and across it through its centre of mass [kg m²].
    spin: f64,
    across: f64,
}

/// Matrix of v ↦ a aᵀ v.
fn outer(a: &Vector<f64, 3>) -> Matrix<f64, 3, 3> {
    Matrix::from_fn(|i, j| a[i] * a[j])
}

/// Inertia of a unit point mass at `c`.
fn point(c: &Vector<f64, 3>) -> Matrix<f64, 3, 3> {
    Matrix::identity().scaled(c.dot(c)) + -outer(c)
}

impl Rotor {
    fn inertia(&self) -> Matrix<f64, 3, 3> {
        Matrix::identity().scaled(self.across) + outer(&self.axis).scaled(self.spin - self.across)
    }

    /// `body` with the rotor locked to it.
    fn locked_to(&self, body: &Body) -> Body {
        let mass = body.mass + self.mass;
        let (body_com, inertia) = (Vector(body.com), Matrix(body.inertia));
        let com = (body_com.scaled(body.mass) + self.com.scaled(self.mass)).scaled(1.0 / mass);
        let (own, rotor) = (body_com - com, self.com - com);
        let inertia =
            inertia + point(&own).scaled(body.mass) + self.inertia() + point(&rotor).scaled(self.mass);
        Body { mass, com: com.0, inertia: inertia.0, ..*body }
    }

    /// The rotor as a body on a joint of its own.
    fn as_body(&self, parent: Option<usize>) -> Body {
        Body {
            parent,
            kind: JointKind::Revolute,
            axis: self.axis.0,
            rotation: IDENTITY,
            translation: self.com.0,
            mass: self.mass,
            com: [0.0; 3],
            inertia: self.inertia().0,
        }
    }
}

/// The reduced model (rotors locked to their carriers) with its coupling, and the full one: M = 2 N bodies, links first.
struct Pair<const N: usize, const M: usize> {
    links: Tree<f64, N>,
    motor_inertia: Vector<f64, N>,
    gear_ratio: Vector<f64, N>,
    full: Tree<f64, M>,
}

impl<const N: usize, const M: usize> Pair<N, M> {
    fn new(seed: u64) -> Self {
        let bodies: [Body; N] = branched_bodies(seed);
        let mut r = Numbers(seed + 50);
        let rotors: [Rotor; N] = core::array::from_fn(|i| Rotor {
            mass: 0.4 + 0.2 * r.next(),
            com: r.vector(0.1),
            // From the frame of joint i, which is fixed on its parent.
            axis: Matrix(bodies[i].rotation) * Vector(bodies[i].axis),
            spin: 0.01 + 0.005 * r.next(),
            across: 0.02 + 0.01 * r.next(),
        });
        let gear_ratio: Vector<f64, N> = Vector::from_fn(|i| [7.0, -3.0, 1.0, 50.0, -20.0][i % 5]);
        let mut links = bodies;
        for (rotor, body) in rotors.iter().zip(&bodies) {
            if let Some(parent) = body.parent {
                links[parent] = rotor.locked_to(&links[parent]);
            }
        }
        let full =
            core::array::from_fn(
                |i| {
                    if i < N { bodies[i] } else { rotors[i - N].as_body(bodies[i - N].parent) }
                },
            );
        Self {
            links: Tree::new(&links, GRAVITY).expect("ordered"),
            motor_inertia: Vector::from_fn(|i| rotors[i].spin * gear_ratio[i].powi(2)),
            gear_ratio,
            full: Tree::new(&full, GRAVITY).expect("ordered"),
        }
    }

    fn coupling(&self) -> RotorCoupling<f64, N> {
        RotorCoupling::new(&self.motor_inertia, &self.gear_ratio)
    }

    /// Links, then rotors turned by their gears.
    fn joined(&self, link: &Vector<f64, N>, motor: &Vector<f64, N>) -> Vector<f64, M> {
        Vector::from_fn(|i| if i < N { link[i] } else { self.gear_ratio[i - N] * motor[i - N] })
    }

    /// Torques on links, and on motors as felt on the link side of their gears.
    fn split(&self, torque: &Vector<f64, M>) -> [Vector<f64, N>; 2] {
        [Vector::from_fn(|i| torque[i]), Vector::from_fn(|i| self.gear_ratio[i] * torque[i + N])]
    }
}

fn rotors_are_bodies<const N: usize, const M: usize>(seed: u64) {
    let pair = Pair::<N, M>::new(seed);
    let (links, coupling) = (&pair.links, pair.coupling());
    let mut r = Numbers(seed + 70);
    for _ in 0..20 {
        let x: Motion<f64, N> = r.motion(2.0);
        let [a_l, a_m] = core::array::from_fn(|_| r.vector::<N>(3.0));

        // Mass matrix, a column at a time: products of about 100 operations on entries up to 1e3 · ε.
        let S = coupling.matrix(links, &x.q_l);
        let q = pair.joined(&x.q_l, &x.q_m);
        for i in 0..N {
            let unit = Vector::from_fn(|j| f64::from(u8::from(i == j)));
            let [link, motor] = pair.split(&pair.full.mass_mul(&q, &pair.joined(&unit, &Vector::ZERO)));
            close(&links.mass_mul(&x.q_l, &unit), &link, 1e-13);
            close(&S.row(i), &motor, 1e-13);
            let [link, motor] = pair.split(&pair.full.mass_mul(&q, &pair.joined(&Vector::ZERO, &unit)));
            close(&S.column(i), &link, 1e-13);
            close(&pair.motor_inertia.diag_mul(&unit), &motor, 1e-13);
        }

        // Inverse dynamics, velocity products included.
        let v = pair.joined(&x.v_l, &x.v_m);
        let [link, motor] = pair.split(&pair.full.inverse_dynamics(&q, &v, &v, &pair.joined(&a_l, &a_m)));
        let reduced = links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &a_l);
        close(&(reduced + coupling.link_torque(links, &x, &a_m)), &link, 1e-12);
        let reduced = pair.motor_inertia.diag_mul(&a_m);
        close(&(reduced + coupling.motor_torque(links, &x, &a_l)), &motor, 1e-12);

        // Energy: the coupling's part of ½ vᵀ M v.
        let kinetic = 0.5 * v.dot(&pair.full.mass_mul(&q, &v));
        let reduced = 0.5 * x.v_l.dot(&links.mass_mul(&x.q_l, &x.v_l))
            + 0.5 * x.v_m.dot(&pair.motor_inertia.diag_mul(&x.v_m));
        let coupled = reduced + coupling.energy(links, &x);
        assert!((coupled - kinetic).abs() < 1e-12 * kinetic, "{coupled} J against {kinetic} J");
        assert!((reduced - kinetic).abs() > 1e-6 * kinetic, "there is coupling: {kinetic} J");
    }
}

#[test]
fn rotors_are_bodies_of_their_own() {
    // Skew axes, gears of both signs, the third joint prismatic: its rotor turns by the gear ratio per metre.
    rotors_are_bodies::<3, 6>(1);
    rotors_are_bodies::<3, 6>(2);
    rotors_are_bodies::<5, 10>(3);
}

#[test]
fn an_elbow_with_parallel_axes_couples_by_a_constant() {
    // Tomei's robot (1991): waist about the vertical, shoulder and elbow about parallel horizontal axes. Of all
    // couplings only B26 = a9 = 0.1456 kg m² is left, the elbow's rotor on the upper arm: motor inertia a10 = 23.296
    // behind a gear of 160.
    let body = |i: usize, roll, z| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: rotation(roll, 0.0, 0.0),
        translation: [0.0, 0.0, z],
        mass: 10.0,
        com: [0.2, 0.0, 0.0],
        inertia: [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]],
    };
    let bodies = [
        body(0, 0.0, 0.0),
        body(1, FRAC_PI_2, 0.5),
        Body { translation: [0.5, 0.0, 0.0], ..body(2, 0.0, 0.0) },
    ];
    let tree = Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("a chain");
    let coupling = RotorCoupling::new(&Vector([23.296, 70.656, 23.296]), &Vector([160.0; 3]));
    let mut r = Numbers(9);
    for _ in 0..20 {
        let S = coupling.matrix(&tree, &r.vector(3.0));
        for (k, i) in (0..3).flat_map(|k| (0..3).map(move |i| (k, i))) {
            let expected = if (k, i) == (1, 2) { 0.1456 } else { 0.0 };
            assert!((S[(k, i)] - expected).abs() < 1e-15, "{S:?}");
        }
    }
}

#[test]
fn closed_forms_say_the_same_as_trees() {
    let body = |i: usize, x| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: IDENTITY,
        translation: [x, 0.0, 0.0],
        mass: 1.0,
        com: [0.1, 0.0, 0.0],
        inertia: IDENTITY,
    };
    let one = Tree::new(&[body(0, 0.0)], [0.0; 3]).expect("a joint");
    let two = Tree::new(&[body(0, 0.0), body(1, 0.3)], [0.0; 3]).expect("a chain");
    let mut r = Numbers(4);
    for _ in 0..20 {
        let (q, v) = (r.vector::<2>(3.0), r.vector::<2>(3.0));
        close(&planar().carrier_rates(&q, &v), &two.carrier_rates(&q, &v), 1e-15);
        let (q, v) = (r.vector::<1>(3.0), r.vector::<1>(3.0));
        let pendulum = Pendulum { inertia: 1.0, weight_moment: 1.0 };
        close(&pendulum.carrier_rates(&q, &v), &one.carrier_rates(&q, &v), 0.0);
    }
}

#[cfg(feature = "interval")]
#[test]
fn the_coupling_runs_on_intervals() {
    let pair = Pair::<3, 6>::new(1);
    let tree = pair.links.map(Interval::point);
    let coupling = RotorCoupling { spin: pair.coupling().spin.map(Interval::point) };
    let mut r = Numbers(30);
    for _ in 0..10 {
        let (x, a): (Motion<f64, 3>, _) = (r.motion(2.0), r.vector::<3>(3.0));
        let wide = coupling.link_torque(&tree, &x.map(Interval::point), &a.map(Interval::point));
        let exact = pair.coupling().link_torque(&pair.links, &x, &a);
        for (bound, torque) in wide.iter().zip(exact.iter()) {
            // Rounding of the plain numbers may leave the bounds by as much again.
            let slack = 1e-13 * (1.0 + torque.abs());
            assert!(
                bound.lo() - slack <= torque && torque <= bound.hi() + slack,
                "{bound:?} has not {torque}"
            );
            assert!(bound.hi() - bound.lo() < 1e-11, "{bound:?}");
        }
    }
}
