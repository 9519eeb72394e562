//! Generalised Jacobians and matrix measures of the full 4n × 4n closed loop of v-CBC, at samples and over boxes.

use flexure_core::contraction::{
    ClosedLoop, Dynamics, ErrorLoop, MatrixField, Norm, Root, contraction_matrix, diagonal_weight,
    generalised_jacobian, measure_1, measure_2, measure_2_margins, measure_infinity, over_pieces,
    symmetric_eigenvalues,
};
use flexure_core::control::{Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Motion};
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Interval, Over, Piecewise, Scalar};

use crate::common::{Numbers, close, planar};

type Arm<C> = Fjr<C, PlanarTwoLink<C>, 2>;

/// The paper's arm over any constants.
fn arm<C: Scalar>(f: fn(f64) -> C) -> Arm<C> {
    let two = |a: f64, b: f64| Vector([f(a), f(b)]);
    Fjr {
        links: planar().map(f),
        motor_inertia: two(0.23, 0.01),
        stiffness: two(9.0, 4.0),
        link_damping: two(0.8, 0.55),
        motor_damping: two(0.2, 90.0),
    }
}

/// The paper's gains.
fn law<C: Scalar, P>(f: fn(f64) -> C, shaping: fn(Vector<C, 2>) -> P) -> Vcbc<C, P, P, 2> {
    let two = |a: f64, b: f64| Vector([f(a), f(b)]);
    let (link, motor) = (two(55.0, 30.0), two(70.0, 60.0));
    Vcbc {
        link: LinkGains { metric: Metric::Constant(link), shaping: shaping(link), damping: two(15.0, 10.0) },
        motor: MotorGains { metric: motor, shaping: shaping(motor), damping: two(10.0, 5.0) },
    }
}

type Loop<'a, C, P> = ErrorLoop<'a, C, PlanarTwoLink<C>, P, P, 2>;

/// The closed loop with the second link turned by `angle` in rad while the links turn at `v` [rad/s].
fn at<'a, C: Scalar, P>(
    robot: &'a Arm<C>,
    law: &'a Vcbc<C, P, P, 2>,
    [angle, v_1, v_2]: [C; 3],
) -> Loop<'a, C, P> {
    let zero = Vector([C::ZERO; 2]);
    let motion = Motion { q_l: Vector([C::ZERO, angle]), q_m: zero, v_l: Vector([v_1, v_2]), v_m: zero };
    ErrorLoop { robot, law, motion }
}

/// J̄ at the error `x`, without input.
fn jacobian<C, P>(error: Loop<C, P>, weight: &impl MatrixField<C, 8>, x: &Vector<C, 8>) -> Matrix<C, 8, 8>
where
    C: Scalar + Over<C> + Piecewise,
    P: Shaping<C, 2>,
{
    let closed: ClosedLoop<_, _, 4> = ClosedLoop { system: error, feedback: Vector([C::ZERO; 4]) };
    generalised_jacobian(&closed, weight, x, C::ZERO)
}

const REST: Vector<f64, 8> = Vector([0.0; 8]);

/// Errors at random.
fn errors(r: &mut Numbers) -> Vector<f64, 8> {
    r.vector(0.5)
}

/// μ by its definition, (‖I + h A‖ − 1) / h, for a small h > 0.
fn by_definition(a: &Matrix<f64, 3, 3>, norm: impl Fn(&Matrix<f64, 3, 3>) -> f64) -> f64 {
    let h = 1e-7;
    (norm(&(Matrix::identity() + a.scaled(h))) - 1.0) / h
}

fn column_sums(a: &Matrix<f64, 3, 3>) -> f64 {
    (0..3).map(|j| a.column(j).iter().map(f64::abs).sum()).fold(0.0, f64::max)
}

#[test]
fn measures_are_one_sided_derivatives_of_norms() {
    let mut r = Numbers(1);
    for _ in 0..50 {
        let a: Matrix<f64, 3, 3> = Matrix(core::array::from_fn(|_| r.vector::<3>(5.0).0));
        // ‖I + h A‖ is piecewise linear for 1 and ∞: rounding over h. The spectral norm curves, by h ‖A‖².
        let close = |got: f64, expected: f64, tolerance: f64| {
            assert!((got - expected).abs() < tolerance, "{got} against {expected}");
        };
        close(measure_1(&a), by_definition(&a, column_sums), 1e-7);
        close(measure_infinity(&a), by_definition(&a, |a| column_sums(&a.transpose())), 1e-7);
        let spectral = |a: &Matrix<f64, 3, 3>| {
            symmetric_eigenvalues(&(a.transpose() * *a)).iter().fold(0.0, f64::max).sqrt()
        };
        close(measure_2(&a), by_definition(&a, spectral), 1e-4);

        // The margins say on which side of a bound μ_2 is.
        let positive = |bound| measure_2_margins(&a, bound).iter().all(|pivot| pivot > 0.0);
        assert!(positive(measure_2(&a) + 1e-9) && !positive(measure_2(&a) - 1e-9));
    }
}

/// Eigenvalues of a chain of springs, 2 − 2 cos(k π / (n + 1)), and of a matrix that is diagonal already.
#[test]
fn rotations_find_eigenvalues() {
    let chain = Matrix::<f64, 7, 7>::from_fn(|i, j| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let mut found = symmetric_eigenvalues(&chain).0;
    found.sort_by(f64::total_cmp);
    for (k, found) in found.iter().enumerate() {
        let expected = 2.0 - 2.0 * ((k + 1) as f64 * core::f64::consts::PI / 8.0).cos();
        assert!((found - expected).abs() < 1e-14, "{found} against {expected}");
    }
    let diagonal = Vector([3.0, -1.0, 3.0]);
    assert_eq!(symmetric_eigenvalues(&Matrix::diagonal(&diagonal)), diagonal);
    // Of whatever size entries are: squares of these are infinite, or 0.
    for size in [1e155, 1e-200] {
        let a = Matrix([[-size, 3.0 * size], [3.0 * size, -2.0 * size]]);
        let expected = 0.5 * size * (37.0_f64.sqrt() - 3.0);
        assert!((measure_2(&a) / expected - 1.0).abs() < 1e-14, "{size}");
    }
    for size in [1e20_f32, 1e-24] {
        let a = Matrix([[-size, 3.0 * size], [3.0 * size, -2.0 * size]]);
        assert!((measure_2(&a) / (1.541_381_3 * size) - 1.0).abs() < 1e-5, "{size}");
    }
    assert!(measure_2(&Matrix([[f64::NAN, 1.0], [1.0, -2.0]])).is_nan());
}

/// J̄ is the rate of z = Θ δx: along a solution that the error loop itself makes, with a weight that depends on the error, on the motion of the
/// arm and so on time.
#[test]
fn the_generalised_jacobian_moves_weighted_variations() {
    let mut r = Numbers(2);
    let (robot, mut law) = (arm(|x| x), law(|x| x, |gain| Tanh { gain }));
    law.link.metric = Metric::Hardening { base: Vector([55.0, 30.0]), hardening: Vector([20.0, 9.0]) };
    for _ in 0..10 {
        let error = at(&robot, &law, [r.next(), 2.0 * r.next(), 2.0 * r.next()]);
        let closed: ClosedLoop<_, _, 4> = ClosedLoop { system: error, feedback: Vector([0.0; 4]) };
        let (x, delta) = (errors(&mut r), errors(&mut r));
        let theta = |x: &Vector<f64, 8>, t| MatrixField::<f64, 8>::at(&Root(error), x, t);
        let z = theta(&x, 0.0) * delta;
        let expected = jacobian(error, &Root(error), &x) * z;

        // Central differences along the prolonged solution to second order: h² of the third derivatives of motors with 9000 1/s.
        let h = 1e-6;
        let rate = |x: &Vector<f64, 8>| Dynamics::<f64, 8>::rate(&closed, x, 0.0);
        let at_time = |h: f64| {
            let moved = x + rate(&x).scaled(h);
            theta(&moved, h) * (delta + Dynamics::<f64, 8>::variation(&closed, &x, &delta, 0.0).scaled(h))
        };
        close(&(at_time(h) - at_time(-h)).scaled(0.5 / h), &expected, 1e-7);
    }
}

/// The paper's gains give the linear law the rate 30 of its slowest block, whatever the arm does: μ_2 in the metric Π says exactly that, and
/// the inequality of the metric holds up to the same rate.
#[test]
fn measure_2_of_the_whole_loop_is_the_rate_of_its_slowest_block() {
    let mut r = Numbers(3);
    let (robot, law) = (arm(|x| x), law(|x| x, |gain| Linear { gain }));
    for _ in 0..20 {
        let error = at(&robot, &law, [3.0 * r.next(), 2.0 * r.next(), 2.0 * r.next()]);
        let x = errors(&mut r);
        let mu = measure_2(&jacobian(error, &Root(error), &x));
        // Of entries of up to 1e4 1/s, the damping of a motor over its inertia.
        assert!((mu + 30.0).abs() < 1e-9, "{mu}");
        let closed: ClosedLoop<_, _, 4> = ClosedLoop { system: error, feedback: Vector([0.0; 4]) };
        let holds = |beta: f64| {
            let matrix = contraction_matrix(&closed, &error, beta, &x, 0.0);
            matrix.ldl().pivots().iter().all(|pivot| pivot > 0.0)
        };
        assert!(holds(30.0 - 1e-6) && !holds(30.0 + 1e-6));
    }
}

/// Entries of the largest size: diagonal entries with their sign, the others without.
fn majorant(a: &Matrix<f64, 8, 8>, b: &Matrix<f64, 8, 8>) -> Matrix<f64, 8, 8> {
    Matrix::from_fn(
        |i, j| {
            if i == j { a[(i, j)].max(b[(i, j)]) } else { a[(i, j)].abs().max(b[(i, j)].abs()) }
        },
    )
}

/// The whole loop, springs and all, contracts in a weighted 1-norm and in a weighted ∞-norm, with one diagonal weight for every posture up to
/// 1 rad and speeds up to 1 rad/s: proved in intervals, and no sample is above the bound. The law is the paper's linear one, of which ∂φ is
/// constant, so that the box of errors is all errors.
#[test]
fn the_whole_loop_contracts_in_norms_with_corners() {
    let (robot, linear) = (arm(|x| x), law(|x| x, |gain| Linear { gain }));
    let identity = Matrix::identity();
    let sample = |angle, v_1, v_2, weight: &Matrix<f64, 8, 8>| {
        jacobian(at(&robot, &linear, [angle, v_1, v_2]), weight, &REST)
    };
    let grid = |weight: &Matrix<f64, 8, 8>| {
        let ends = [-1.0, 1.0];
        let postures = (0..=20).map(|k| f64::from(k) / 10.0 - 1.0);
        let states = postures.flat_map(|q| ends.map(|v| ends.map(|w| [q, v, w])));
        states.flatten().map(|[q, v, w]| sample(q, v, w, weight)).collect::<Vec<_>>()
    };
    let most = grid(&identity).into_iter().reduce(|a, b| majorant(&a, &b)).expect("states");
    let one = Matrix::diagonal(&diagonal_weight(&most));
    let infinity = Matrix::diagonal(&diagonal_weight(&most.transpose()).map(f64::recip));

    let (box_robot, box_law) = (arm(Interval::point), law(Interval::point, |gain| Linear { gain }));
    let side = Interval::new(-1.0, 1.0).expect("an interval");
    for (norm, weight) in [(Norm::One, one), (Norm::Infinity, infinity)] {
        let boxed = weight.map(Interval::point);
        let proved = over_pieces(&Vector([side; 3]), 9, &|piece| {
            let zero = Vector([Interval::ZERO; 8]);
            norm.measure(&jacobian(at(&box_robot, &box_law, piece.0), &boxed, &zero))
        });
        assert!(proved.hi() < -15.4, "{norm:?}: {proved:?}");
        for sample in grid(&weight) {
            assert!(norm.measure(&sample) <= proved.hi());
        }
        // It is the weight that does it.
        assert!(norm.measure(&sample(0.0, 0.0, 0.0, &identity)) > 0.0);
    }
}

/// In the 2-norm of the metric Π, which depends on the posture: −(Π̇ + JᵀΠ + ΠJ) − 2β Π is positive definite for every state of a box, by the
/// pivots of its factorisation in intervals. φ is tanh, so that the certificate names its errors, up to 0.2 rad.
#[test]
fn the_contraction_inequality_holds_over_a_box() {
    let (robot, law) = (arm(Interval::point), law(Interval::point, |gain| Tanh { gain }));
    let side = |low: f64, high: f64| Interval::new(low, high).expect("an interval");
    let (speed, error) = (side(-0.1, 0.1), side(-0.2, 0.2));
    let least_pivot = |beta: f64, cuts| {
        over_pieces(&Vector([side(0.5, 0.55), speed, speed]), cuts, &|piece| {
            let error_loop = at(&robot, &law, piece.0);
            let closed: ClosedLoop<_, _, 4> =
                ClosedLoop { system: error_loop, feedback: Vector([Interval::ZERO; 4]) };
            let zero = Interval::ZERO;
            let x = Vector([error, error, error, error, zero, zero, zero, zero]);
            let matrix = contraction_matrix(&closed, &error_loop, Interval::point(beta), &x, zero);
            matrix.ldl().pivots().iter().reduce(Interval::min).expect("eight pivots")
        })
    };
    assert!(least_pivot(25.0, 9).lo() > 0.0, "{:?}", least_pivot(25.0, 9));
    // The same by J̄, in a smaller box: Θ depends on the posture, and Θ⁻¹ is wider than Π.
    let margins = over_pieces(&Vector([side(0.5, 0.51), speed, speed]), 9, &|piece| {
        let error_loop = at(&robot, &law, piece.0);
        let x = Vector([
            error,
            error,
            error,
            error,
            Interval::ZERO,
            Interval::ZERO,
            Interval::ZERO,
            Interval::ZERO,
        ]);
        let jacobian = jacobian(error_loop, &Root(error_loop), &x);
        measure_2_margins(&jacobian, Interval::point(-25.0))
            .iter()
            .reduce(Interval::min)
            .expect("eight pivots")
    });
    assert!(margins.lo() > 0.0, "{margins:?}");
    // 30 sech² 0.2 = 28.8 is the rate at the ends of the box: a larger one is not proved, however fine the pieces.
    assert!(least_pivot(29.0, 9).lo() <= 0.0);
}

/// The best diagonal weight: no other diagonal gives less, and the bound is the Perron root.
#[test]
fn no_diagonal_weight_is_better() {
    let mut r = Numbers(4);
    for _ in 0..20 {
        let a: Matrix<f64, 3, 3> = Matrix(core::array::from_fn(|_| r.vector::<3>(5.0).0));
        let scaled = |a: &Matrix<f64, 3, 3>, w: &Vector<f64, 3>| {
            Matrix::<f64, 3, 3>::from_fn(|i, j| w[i] * a[(i, j)] / w[j])
        };
        let weight = diagonal_weight(&a);
        let least = measure_1(&scaled(&a, &weight));
        let opposite = diagonal_weight(&a.transpose()).map(f64::recip);
        assert!((measure_infinity(&scaled(&a, &opposite)) - least).abs() < 1e-10 * least.abs().max(1.0));
        for _ in 0..20 {
            let other: Vector<f64, 3> = r.between(0.1, 1.0);
            assert!(measure_1(&scaled(&a, &other)) >= least - 1e-10);
        }
    }
}
