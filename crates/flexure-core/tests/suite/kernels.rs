//! Kernels against what they shorten: frames that the tree chooses against the bodies as they were given, passes that share what they
//! can against passes that share nothing.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, MassFactor};
use flexure_core::robots::{Body, JointKind, PlanarTwoLink, Tree};
use flexure_core::scalar::{Jet, Scalar};

use crate::common::{GRAVITY, IDENTITY, Numbers, branched_bodies, close, planar, rotation};

type Series = Jet<f64, 2>;

/// Where a body is along a motion: axes as columns and origin of its link frame, in the base frame.
#[derive(Clone, Copy)]
struct Placed {
    turn: Matrix<Series, 3, 3>,
    origin: Vector<Series, 3>,
}

fn lift(m: [[f64; 3]; 3]) -> Matrix<Series, 3, 3> {
    Matrix(m).map(Jet::value)
}

/// A turn by `q` about the unit vector `axis`, by Rodrigues's formula.
fn about(axis: [f64; 3], q: Series) -> Matrix<Series, 3, 3> {
    let [x, y, z] = axis.map(Jet::value);
    let cross = Matrix([[Jet::ZERO, -z, y], [z, Jet::ZERO, -x], [-y, x, Jet::ZERO]]);
    let (sin, cos) = q.sin_cos();
    Matrix::identity() + cross.scaled(sin) + (cross * cross).scaled(Jet::ONE - cos)
}

/// Every body along q, in the frames it was given in.
fn placed<const N: usize>(bodies: &[Body; N], q: &Vector<Series, N>) -> Vec<Placed> {
    let mut all: Vec<Placed> = Vec::new();
    for (i, body) in bodies.iter().enumerate() {
        let base = Placed { turn: Matrix::identity(), origin: Vector::ZERO };
        let carrier = body.parent.map_or(base, |parent| all[parent]);
        let turn = carrier.turn * lift(body.rotation);
        let origin = carrier.origin + carrier.turn * Vector(body.translation).map(Jet::value);
        all.push(match body.kind {
            JointKind::Revolute => Placed { turn: turn * about(body.axis, q[i]), origin },
            JointKind::Prismatic => {
                Placed { turn, origin: origin + turn * Vector(body.axis.map(Jet::value)).scaled(q[i]) }
            }
        });
    }
    all
}

/// Kinetic energy, potential energy and the rates of the carriers about the joint axes, from nothing but the bodies.
fn spelt_out<const N: usize>(
    bodies: &[Body; N],
    q: &Vector<f64, N>,
    v: &Vector<f64, N>,
) -> (f64, f64, Vector<f64, N>) {
    let all = placed(bodies, &Vector::from_fn(|i| Jet::new([q[i], v[i]])));
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for (body, at) in bodies.iter().zip(&all) {
        let com = at.origin + at.turn * Vector(body.com).map(Jet::value);
        let (com, rate) = (com.map(|x| x.coefficient(0)), com.map(|x| x.coefficient(1)));
        let spread = Matrix::identity().scaled(0.5 * (0..3).map(|i| body.inertia[i][i]).sum::<f64>());
        let second = spread - Matrix(body.inertia);
        let turning = at.turn.map(|x| x.coefficient(1));
        let spin = turning * second * turning.transpose();
        kinetic += 0.5 * body.mass * rate.dot(&rate) + 0.5 * (0..3).map(|i| spin[(i, i)]).sum::<f64>();
        potential -= body.mass * com.dot(&Vector(GRAVITY));
    }
    let rates = Vector::from_fn(|i| {
        let Some(carrier) = bodies[i].parent.map(|parent| all[parent]) else { return 0.0 };
        let (turn, turning) =
            (carrier.turn.map(|x| x.coefficient(0)), carrier.turn.map(|x| x.coefficient(1)));
        let w = turning * turn.transpose();
        let spin = Vector([w[(2, 1)], w[(0, 2)], w[(1, 0)]]);
        spin.dot(&(turn * (Matrix(bodies[i].rotation) * Vector(bodies[i].axis))))
    });
    (kinetic, potential, rates)
}

fn is_as_given<const N: usize>(bodies: &[Body; N], seed: u64) {
    let tree = Tree::new(bodies, GRAVITY).expect("ordered");
    let mut r = Numbers(seed);
    for _ in 0..30 {
        let (q, v) = (r.vector::<N>(3.0), r.vector::<N>(2.0));
        let (kinetic, potential, rates) = spelt_out(bodies, &q, &v);
        let of_tree = Vector([0.5 * v.dot(&(tree.mass_matrix(&q) * v)), 0.5 * v.dot(&tree.mass_mul(&q, &v))]);
        // Another hundred roundings a body.
        close(&of_tree, &Vector([kinetic; 2]), 1e-13 * N as f64);
        close(&Vector([tree.potential_energy(&q)]), &Vector([potential]), 1e-13 * N as f64);
        close(&tree.carrier_rates(&q, &v), &rates, 1e-13 * N as f64);
        let momentum = tree.articulated(&q).solve(&(tree.mass_matrix(&q) * v));
        close(&momentum, &v, 1e-9);
    }
}

/// Two axes at the angle `tilt`, then a right angle, an opposite axis, one that slides, and two joints more that one body carries.
fn tilted(tilt: f64) -> [Body; 7] {
    let mut bodies: [Body; 7] = branched_bodies(31);
    let axes = [
        [0.0, 0.0, 1.0],
        [tilt.sin() * 0.6, tilt.sin() * 0.8, tilt.cos()],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.6, 0.8],
        [0.6, 0.0, -0.8],
    ];
    let parents = [None, Some(0), Some(1), Some(2), Some(3), Some(4), Some(4)];
    for (i, body) in bodies.iter_mut().enumerate() {
        body.axis = axes[i];
        body.parent = parents[i];
        body.kind = if i == 4 { JointKind::Prismatic } else { JointKind::Revolute };
        body.rotation = if i == 5 { rotation(0.3, -0.7, 1.9) } else { IDENTITY };
    }
    bodies
}

#[test]
fn frames_that_the_tree_chooses_do_not_show() {
    is_as_given::<8>(&branched_bodies(41), 42);
    is_as_given::<12>(&branched_bodies(43), 44);
    // Parallel, nearly so, and on both sides of where the common normal counts.
    for tilt in [0.0, 1e-12, 1e-5, 0.09, 0.11, 1.0, std::f64::consts::FRAC_PI_2, std::f64::consts::PI] {
        is_as_given(&tilted(tilt), 45);
    }
}

/// Torques along a motion, with a start that was factorised, against the pass that knows nothing of it.
fn shares<L: Links<f64, N>, const N: usize>(links: &L, seed: u64) {
    let mut r = Numbers(seed);
    for _ in 0..10 {
        let [q, v_r] = core::array::from_fn(|_| r.series::<5, N>(1.5));
        let factor = links.factor(&q.map(|x| x.coefficient(0)));
        let (v, a) = (q.map(|x| x.differentiate::<3>()), q.map(|x| x.differentiate_twice::<3>()));
        let (v_r, a_r) = (v_r.map(|x| x.truncate::<3>()), v_r.map(|x| x.differentiate::<3>()));
        let along = links.torque_along::<_, 3, 5>(&q);
        let q = q.map(|x| x.truncate::<3>());
        let alone = [links.inverse_dynamics(&q, &v, &v_r, &a_r), links.inverse_dynamics(&q, &v, &v, &a)];
        let shared =
            [links.reference_torque(&factor, &q, &v, &v_r, &a_r), links.motion_torque(&factor, &q, &v, &a)];
        for k in 0..3 {
            let order = |x: &Vector<Jet<f64, 3>, N>| x.map(|jet| jet.coefficient(k));
            close(&order(&shared[0]), &order(&alone[0]), 1e-13);
            close(&order(&shared[1]), &order(&alone[1]), 1e-13);
            close(&order(&along), &order(&alone[1]), 1e-13);
        }
        let [q, v, a] = [&q, &v, &a].map(|x| x.map(|jet| jet.coefficient(0)));
        let torque = links.inverse_dynamics(&q, &v, &v, &a);
        close(&links.forward_dynamics(&q, &v, &torque), &a, 1e-9);
        let rest = Vector::ZERO;
        close(&links.gravity_torque(&q), &links.inverse_dynamics(&q, &rest, &rest, &rest), 1e-13);
    }
}

#[test]
fn shared_sines_are_the_same_sines() {
    shares::<Tree<f64, 7>, 7>(&Tree::new(&tilted(0.4), GRAVITY).expect("ordered"), 51);
    shares::<Tree<f64, 11>, 11>(&Tree::new(&branched_bodies(52), GRAVITY).expect("ordered"), 53);
    shares::<PlanarTwoLink<f64>, 2>(&planar(), 54);
}
