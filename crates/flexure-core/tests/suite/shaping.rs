//! Shaping functions and metrics: what the theorems ask of them.

use flexure_core::control::{CoupledTanh, Metric, Shaping};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Dual;

use crate::common::{Numbers, close, coupled_tanh, linear, tanh};

#[test]
fn no_velocity_at_no_error() {
    let mut r = Numbers(1);
    let zero = Vector::<f64, 3>::ZERO;
    assert_eq!(tanh::<3>(&mut r).eval(&zero), zero);
    assert_eq!(linear::<3>(&mut r).eval(&zero), zero);
    assert_eq!(coupled_tanh::<3>(&mut r).eval(&zero), zero);
}

/// Π ∂φ is symmetric positive definite: the contraction inequality of the diagonal members, at a point.
fn contracts<P: Shaping<f64, 4>>(shaping: &P, metric: &Vector<f64, 4>, error: &Vector<f64, 4>) {
    let slope = Matrix::diagonal(metric) * shaping.slope(error);
    assert_eq!(slope, slope.transpose());
    assert!(slope.ldl().pivots().iter().all(|pivot| pivot > 0.0), "{slope:?}");
}

#[test]
fn diagonal_members_contract() {
    let mut r = Numbers(2);
    for _ in 0..50 {
        let (metric, error) = (r.between(1.0, 60.0), r.vector(5.0));
        contracts(&tanh(&mut r), &metric, &error);
        contracts(&linear(&mut r), &metric, &error);
    }
}

#[test]
fn coupled_tanh_is_the_papers_for_two_joints() {
    let mut r = Numbers(3);
    for _ in 0..50 {
        let ([k1, k2], [l1, l2], [e1, e2]) =
            (r.between(1.0, 10.0).0, r.between(1.0, 60.0).0, r.vector::<2>(3.0).0);
        let phi = CoupledTanh::new(Vector([k1, k2]), &Vector([l1, l2])).eval(&Vector([e1, e2]));
        let (t1, t2): (f64, f64) = (l1.sqrt(), l2.sqrt());
        let paper = [(1.0 + k1) * e1 + t2 / t1 * e2.tanh(), (1.0 + k2) * e2 + t1 / t2 * e1.tanh()];
        close(&phi, &Vector(paper), 1e-14); // ten operations
    }
}

/// μ_1 of the generalised Jacobian −Θ ∂φ Θ⁻¹: the largest of diagonal plus absolute off-diagonal column sums.
fn measure_1<const N: usize>(slope: &Matrix<f64, N, N>, theta: &Vector<f64, N>) -> f64 {
    let jacobian = Matrix::<f64, N, N>::from_fn(|i, j| -theta[i] * slope[(i, j)] / theta[j]);
    let column = |j: usize| {
        let off_diagonal = (0..N).filter(|&i| i != j).map(|i| jacobian[(i, j)].abs()).sum::<f64>();
        jacobian[(j, j)] + off_diagonal
    };
    (0..N).map(column).fold(f64::NEG_INFINITY, f64::max)
}

fn coupled_tanh_contracts_in_measure_1<const N: usize>(seed: u64) {
    let mut r = Numbers(seed);
    for _ in 0..100 {
        let (kappa, gain) = (r.between::<N>(1.0, 10.0), r.between::<N>(1.0, 60.0));
        let shaping = CoupledTanh::new(kappa, &gain);
        let theta = gain.map(f64::sqrt);
        let slowest = kappa.iter().fold(f64::INFINITY, f64::min);
        let rounding = 1e-14; // n products and sums of numbers up to 11
        let error = r.vector(3.0);
        assert!(measure_1(&shaping.slope(&error), &theta) <= -slowest + rounding);
        // The bound is attained where there is no error.
        assert!((measure_1(&shaping.slope(&Vector::ZERO), &theta) + slowest).abs() < rounding);
    }
}

#[test]
fn coupled_tanh_contracts_for_any_number_of_joints() {
    coupled_tanh_contracts_in_measure_1::<2>(4);
    coupled_tanh_contracts_in_measure_1::<4>(5);
    coupled_tanh_contracts_in_measure_1::<7>(6);
}

#[test]
fn metric_is_the_slope_of_its_integral() {
    let mut r = Numbers(7);
    for _ in 0..50 {
        let (base, error) = (r.between(1.0, 60.0), r.vector::<3>(3.0));
        for metric in [Metric::Constant(base), Metric::Hardening { base, hardening: r.between(0.0, 20.0) }] {
            let seeded = Vector::from_fn(|i| Dual::<f64, 3>::variable(error[i], i));
            let slope = metric.integral(&seeded).map(|x| Vector(x.gradient));
            for (i, row) in slope.iter().enumerate() {
                close(&row, &Matrix::diagonal(&metric.at(&error)).row(i), 1e-15); // five operations
            }
            assert_eq!(metric.integral(&Vector::<f64, 3>::ZERO), Vector::ZERO);
        }
    }
}

/// In a longer vector the joints that are there have the same φ to the bit, and those that are not have none.
#[test]
fn joints_that_are_not_there_change_nothing() {
    let mut r = Numbers(7);
    let (kappa, gain) = (r.between::<3>(1.0, 10.0), r.between::<3>(1.0, 60.0));
    let longer = |v: &Vector<f64, 3>, pad| Vector::<f64, 5>::from_fn(|i| if i < 3 { v[i] } else { pad });
    let exact = CoupledTanh::new(kappa, &gain);
    let padded = CoupledTanh::of_joints(3, longer(&kappa, 1.0), &longer(&gain, 1.0));
    for _ in 0..20 {
        let e = r.vector::<3>(2.0);
        let (short, long) = (exact.eval(&e), padded.eval(&longer(&e, 0.0)));
        assert_eq!(long.0.map(f64::to_bits), longer(&short, 0.0).0.map(f64::to_bits));
    }
}
