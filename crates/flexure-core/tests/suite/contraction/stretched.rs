//! The inequality of a stretched metric, block by block, against the loop's Jacobian by dual numbers.

use flexure_core::contraction::{
    ClosedLoop, ErrorLoop, Stretch, StretchedLoop, StretchedSide, contraction_matrix,
};
use flexure_core::control::{Linear, Metric, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links};
use flexure_core::scalar::{Dual, Interval};

use super::matrices_are_close;
use crate::common::{Numbers, branched, flexible, gains, linear, planar, serial, tanh};

/// r' / r and r of a stretch at `x`.
fn growth(stretch: &Stretch<f64>, x: f64) -> [f64; 2] {
    let r = stretch.at(Dual::<f64, 1>::variable(x, 0));
    [r.gradient[0] / r.value, r.value]
}

#[test]
fn the_stretch_is_smooth_and_keeps_the_share_of_the_rate() {
    for b in [0.01, 0.1, 0.3, 0.6, 0.9, 0.99] {
        let knee = f64::sqrt(1.0 - b).atanh();
        let largest = knee + 1.5;
        let stretch = Stretch::tanh(b, largest);
        let f = |x: f64| x.sinh().powf(b) / x.tanh();
        let least = (f(knee) / f(largest)).sqrt();
        for step in [1e-9, -1e-9] {
            let [slope, value] = growth(&stretch, knee + step);
            assert!((value - least).abs() < 1e-12 && slope.abs() < 1e-8, "{b}: {slope} {value}");
        }
        let mut before = [0.0, least * (1.0 - 1e-13)];
        for k in 0..400 {
            let x = 0.02 * f64::from(k);
            let [slope, value] = growth(&stretch, x);
            let flat = x.cosh().powi(-2);
            assert!((flat + slope * x.tanh() - flat.max(b)).abs() < 1e-13, "{b} at {x}");
            // What the proof takes the largest error for: both grow with the error.
            assert!(slope >= before[0] - 1e-14 && slope <= b && value >= before[1]);
            let [mirrored, same] = growth(&stretch, -x);
            assert!(x == 0.0 || (mirrored + slope).abs() + (same - value).abs() < 1e-14, "{b} at -{x}");
            before = [slope, value];
        }
        // The closed form.
        assert!((stretch.at(largest) * least - 1.0).abs() < 1e-13, "{b}");
        assert!(
            (stretch.at(largest + 1.0) / stretch.at(largest) / (f(largest + 1.0) / f(largest)) - 1.0).abs()
                < 1e-13
        );
        let [point, at] = [b, largest].map(Interval::point);
        let enclosed = Stretch::tanh(point, at);
        let there = enclosed.at(at);
        assert!(there.contains(stretch.at(largest)) && there.width() < 1e-12 * there.hi());
        // Over both sides of the knee, too.
        let across = enclosed.at(Interval::new(-largest, 0.9 * knee).unwrap());
        assert!(across.contains(stretch.at(0.0)) && across.contains(stretch.at(largest)));
        // Where nothing flattens as far as b, nothing is stretched.
        assert!((Stretch::tanh(b, 0.9 * knee).at(0.5 * knee) - 1.0).abs() < 1e-14);
    }
    assert_eq!(Vector(growth(&Stretch::NONE, 3.0)), Vector([0.0, 1.0]));
}

/// A shaping function that is one of each joint.
trait Diagonal {
    type Joint: Shaping<f64, 1>;
    fn joint(&self, i: usize) -> Self::Joint;
}

impl<const N: usize> Diagonal for Tanh<f64, N> {
    type Joint = Tanh<f64, 1>;
    fn joint(&self, i: usize) -> Self::Joint {
        Tanh { gain: Vector([self.gain[i]]) }
    }
}

impl<const N: usize> Diagonal for Linear<f64, N> {
    type Joint = Linear<f64, 1>;
    fn joint(&self, i: usize) -> Self::Joint {
        Linear { gain: Vector([self.gain[i]]) }
    }
}

/// −(Ṗ + ∂FᵀP + P∂F) − 2βP in (q̃_l, q̃_m, s_l, s_m), by dual numbers, and as the blocks that proofs use.
fn blocks_are_those_of_the_jacobian<L, P, const N: usize, const D: usize, const M: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    stretched: bool,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N> + Diagonal,
{
    let motion = r.motion(1.5);
    let stretches = |r: &mut Numbers| {
        r.between::<N>(0.05, 0.9).map(|b| if stretched { Stretch::tanh(b, 1.5) } else { Stretch::NONE }).0
    };
    let (link, motor) = (stretches(r), stretches(r));
    let error_loop = ErrorLoop { robot, law, motion };
    let field = StretchedLoop { error_loop, link, motor };
    let [e_l, e_m, s_l, s_m]: [Vector<f64, N>; 4] = core::array::from_fn(|_| r.vector(2.0));
    let mass = robot.links.mass_matrix(&motion.q_l);
    let momenta = [mass * s_l, robot.motor_inertia.diag_mul(&s_m)];
    let x = Vector::<f64, D>::from_fn(|i| [e_l, e_m, momenta[0], momenta[1]][i / N][i % N]);
    let beta = 3.0;
    let autonomous = ClosedLoop { system: &field.error_loop, feedback: Vector::<f64, M>::ZERO };
    let found = contraction_matrix::<f64, f64, D>(&autonomous, &field, beta, &x, 0.0);
    let to_momenta = Matrix::<f64, D, D>::from_fn(|i, j| match (i / N, j / N) {
        (0, 0) | (1, 1) if i == j => 1.0,
        (2, 2) => mass[(i % N, j % N)],
        (3, 3) if i == j => robot.motor_inertia[i % N],
        _ => 0.0,
    });
    let found = to_momenta.transpose() * found * to_momenta;

    let drift_m: Vector<f64, N> =
        Vector::from_fn(|i| s_m[i] - robot.stiffness[i] / law.motor.metric[i] * s_l[i]);
    let side = |metric, shaping: &P, stretch, i: usize, e: f64, d: f64| {
        // As at a positive error: d is what drives it away.
        let drift = d * e.signum();
        let one = shaping.joint(i);
        StretchedSide { metric, shaping: &one, stretch, drift }.at(e.abs())
    };
    let mut expected = Matrix::<f64, D, D>::ZERO;
    let mut set = |i: usize, j: usize, value: f64| {
        expected.0[i][j] = value;
        expected.0[j][i] = value;
    };
    for i in 0..N {
        let own = match &law.link.metric {
            Metric::Constant(base) => Metric::Constant(Vector([base[i]])),
            Metric::Hardening { base, hardening } => {
                Metric::Hardening { base: Vector([base[i]]), hardening: Vector([hardening[i]]) }
            }
        };
        let Pi_l = own.at(&Vector([e_l[i]]))[0];
        let P_l = Pi_l * link[i].at(e_l[i]).powi(2);
        let at = side(own, &law.link.shaping, link[i], i, e_l[i], s_l[i]);
        assert!((at.mismatch - (P_l - Pi_l).powi(2) / P_l).abs() < 1e-12 * P_l);
        set(i, i, 2.0 * P_l * (at.rate - beta));
        set(i, 2 * N + i, Pi_l - P_l);
        let (Pi_m, K) = (law.motor.metric[i], robot.stiffness[i]);
        let P_m = Pi_m * motor[i].at(e_m[i]).powi(2);
        let at = side(Metric::Constant(Vector([Pi_m])), &law.motor.shaping, motor[i], i, e_m[i], drift_m[i]);
        set(N + i, N + i, 2.0 * P_m * (at.rate - beta));
        set(N + i, 2 * N + i, K * (P_m - Pi_m) / Pi_m);
        set(N + i, 3 * N + i, Pi_m - P_m);
        let damping = robot.motor_damping[i] + law.motor.damping[i];
        set(3 * N + i, 3 * N + i, 2.0 * (damping - beta * robot.motor_inertia[i]));
        for j in 0..=i {
            let damping = if i == j { robot.link_damping[i] + law.link.damping[i] } else { 0.0 };
            set(2 * N + i, 2 * N + j, 2.0 * (damping - beta * mass[(i, j)]));
        }
    }
    matrices_are_close(&found, &expected, 1e-11);
}

#[test]
fn blocks_of_stretched_metrics() {
    let r = &mut Numbers(41);
    for k in 0..40 {
        let (hard, stretched) = (k % 2 == 1, k % 4 < 3);
        let (arm, law) = (flexible(planar(), r), gains(tanh, hard, r));
        blocks_are_those_of_the_jacobian::<_, _, 2, 8, 4>(&arm, &law, stretched, r);
        let (tree, law) = (flexible(branched::<5>(2), r), gains(tanh, hard, r));
        blocks_are_those_of_the_jacobian::<_, _, 5, 20, 10>(&tree, &law, stretched, r);
        let (arm, law) = (flexible(serial::<3>(), r), gains(linear, hard, r));
        blocks_are_those_of_the_jacobian::<_, _, 3, 12, 6>(&arm, &law, stretched, r);
    }
}
