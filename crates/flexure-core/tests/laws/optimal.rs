//! The linearised robot, its Riccati equations, and the gains that are optimal for it.

use flexure_core::control::{ControlLaw, LinearModel, Lqr, NoRegulator, QuadraticCost, Regulator};
use flexure_core::linalg::{BlockMatrix, Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Pendulum;
use flexure_core::scalar::{Dual, Jet};

use crate::common::laws::{nominal, resting};
use crate::common::plant::{PERIOD, Push, advance};
use crate::common::{Numbers, branched, close, flexible, planar, serial};

type Blocks<const N: usize> = [Matrix<f64, N, N>; 4];

/// Weights at random, the same for no two joints.
pub fn cost<const N: usize>(r: &mut Numbers) -> QuadraticCost<f64, N> {
    let state = [(50.0, 400.0), (5.0, 40.0), (0.5, 2.0), (0.05, 0.5)];
    QuadraticCost { state: state.map(|(low, high)| r.between(low, high)), torque: r.between(0.01, 0.1) }
}

pub fn parts<const N: usize>(x: &Motion<f64, N>) -> [Vector<f64, N>; 4] {
    [x.q_l, x.q_m, x.v_l, x.v_m]
}

pub fn motion<T, const N: usize>([q_l, q_m, v_l, v_m]: [Vector<T, N>; 4]) -> Motion<T, N> {
    Motion { q_l, q_m, v_l, v_m }
}

pub fn sum<const N: usize>(a: &[Vector<f64, N>; 4], b: &[Vector<f64, N>; 4]) -> [Vector<f64, N>; 4] {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Σ blocks · x, a row of blocks times what is in four parts.
pub fn row<const N: usize>(blocks: &Blocks<N>, x: &[Vector<f64, N>; 4]) -> Vector<f64, N> {
    blocks.iter().zip(x).fold(Vector::ZERO, |sum, (block, x)| sum + *block * *x)
}

/// A matrix of blocks times what is in four parts.
pub fn times<const N: usize>(a: &BlockMatrix<f64, N, 4>, x: &[Vector<f64, N>; 4]) -> [Vector<f64, N>; 4] {
    std::array::from_fn(|i| row(&std::array::from_fn(|j| a.block(i, j)), x))
}

/// xᵀ P x.
pub fn form<const N: usize>(a: &BlockMatrix<f64, N, 4>, x: &[Vector<f64, N>; 4]) -> f64 {
    times(a, x).iter().zip(x).map(|(ax, x)| ax.dot(x)).sum()
}

/// What a deviation and a torque cost per second.
pub fn rate<const N: usize>(
    cost: &QuadraticCost<f64, N>,
    e: &[Vector<f64, N>; 4],
    u: &Vector<f64, N>,
) -> f64 {
    let state: f64 = cost.state.iter().zip(e).map(|(w, e)| e.dot(&w.diag_mul(e))).sum();
    state + u.dot(&cost.torque.diag_mul(u))
}

fn largest<const N: usize>(a: &BlockMatrix<f64, N, 4>) -> f64 {
    a.rows().flatten().fold(0.0, |m: f64, x| if x.is_nan() { f64::NAN } else { m.max(x.abs()) })
}

fn total<const N: usize>(terms: &[&BlockMatrix<f64, N, 4>]) -> BlockMatrix<f64, N, 4> {
    terms.iter().fold(BlockMatrix::ZERO, |mut sum, term| {
        sum += *term;
        sum
    })
}

fn transposed<const N: usize>(blocks: &Blocks<N>) -> Blocks<N> {
    blocks.map(|block| block.transpose())
}

/// Ten robots of each kind at postures at random, the last two under gravity.
macro_rules! at_postures {
    ($check:ident, $seed:literal) => {{
        let r = &mut Numbers($seed);
        for _ in 0..10 {
            $check(&flexible(planar(), r), r);
            $check(&flexible(branched::<5>(2), r), r);
            $check(&flexible(serial::<7>(), r), r);
        }
    }};
}

/// The robot itself, integrated from deviations of 10⁻⁶ under torques on motors and links: what is left is of their square, times rates up to 10³ 1/s, and the
/// rounding of positions of the size of 1.
fn moves_as_the_linear_model<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    const SIZE: f64 = 1e-6;
    let posture = r.vector(1.0);
    let period = 5e-3;
    let rest = Motion { q_m: robot.motors_at_rest(&posture), ..Motion::at_rest(posture) };
    let gravity = robot.links.gravity_torque(&posture);
    let e: [Vector<f64, N>; 4] = std::array::from_fn(|_| r.vector(SIZE));
    let (u, tau) = (r.vector::<N>(SIZE), r.vector::<N>(SIZE));

    let start = motion(sum(&parts(&rest), &e));
    let push = Push { link: tau, motor: Vector::ZERO };
    let end = parts(&advance(robot, &start, &(gravity + u), &push, period, 100));

    let model = LinearModel::at_rest(robot, &posture).held(period);
    let free = times(&model.state, &e);
    for (k, rest) in parts(&rest).iter().enumerate() {
        let expected = free[k] + model.input[k] * u + model.disturbance[k] * tau;
        close(&(end[k] - *rest).scaled(SIZE.recip()), &expected.scaled(SIZE.recip()), 1e-4);
    }
}

#[test]
fn the_robot_moves_as_its_linear_model() {
    at_postures!(moves_as_the_linear_model, 1);
}

/// Motor dampers of 9000 1/s over a period of 9 of their time constants.
#[test]
fn a_motor_stops_in_its_damper() {
    let (one, soft) = (Vector([1.0]), Vector([1e-9]));
    let robot = Fjr {
        links: Pendulum { inertia: 1.0, weight_moment: 0.0 },
        motor_inertia: one,
        stiffness: soft,
        link_damping: one,
        motor_damping: one.scaled(9e3),
    };
    let state = LinearModel::at_rest(&robot, &Vector([0.0])).held(PERIOD).state;
    let [moved, left] = [1, 3].map(|i| state.block(i, 3)[(0, 0)]);
    let expected = (-9.0f64).exp();
    assert!((moved * 9e3 - (1.0 - expected)).abs() < 1e-12, "{moved}");
    assert!((left - expected).abs() < 1e-12, "{left}");
}

/// What the Riccati equations say of P and F, as Lyapunov's equation of the closed loop and as the condition for F: with P and Q positive definite the loop is
/// stable. Relative to the largest term; the largest residual found is 7·10⁻¹³ of it, of a period's share of P, which is what is added, 7·10⁻¹².
const TOLERANCE: f64 = 2e-11;

fn solves_its_equations<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let (model, cost) = (LinearModel::at_rest(robot, &r.vector(1.0)), cost(r));
    let (A, B, G) = (model.state, model.input, model.disturbance);
    let Q = BlockMatrix::diagonal(&cost.state);
    for gamma in [Vector([f64::INFINITY; N]), r.between(20.0, 30.0)] {
        let Regulator { gain: F, cost_to_go: P } =
            Regulator::continuous(&model, &cost, &gamma).expect("a robot that can be held");
        assert_eq!(P, P.transpose());
        let weighted = F.map(|f| Matrix::diagonal(&cost.torque) * f);
        let mut closed = A;
        closed -= &BlockMatrix::outer(&B, &F);
        let PG = &P * &G;
        let by_gamma = Matrix::diagonal(&gamma.map(|gamma| gamma.powi(-2)));
        let felt = BlockMatrix::outer(&PG.map(|block| block * by_gamma), &transposed(&PG));
        let flow = &P * &closed;
        let paid = BlockMatrix::outer(&transposed(&F), &weighted);
        let residual = total(&[&flow, &flow.transpose(), &Q, &paid, &felt]);
        assert!(largest(&residual) < TOLERANCE * largest(&(&P * &A)), "{residual:?}");
        for (found, expected) in weighted.iter().zip(&P * &B) {
            for i in 0..N {
                close(&found.row(i), &expected.column(i), 1e-12);
            }
        }
    }

    let (model, cost) = (model.held(PERIOD), cost.over(PERIOD));
    let (A, B) = (model.state, model.input);
    let Regulator { gain: F, cost_to_go: P } =
        Regulator::discrete(&model, &cost).expect("a robot that can be held");
    let weighted = F.map(|f| Matrix::diagonal(&cost.torque) * f);
    let mut closed = A;
    closed -= &BlockMatrix::outer(&B, &F);
    let next = &(&closed.transpose() * &P) * &closed;
    let paid = BlockMatrix::outer(&transposed(&F), &weighted);
    let mut residual = total(&[&next, &BlockMatrix::diagonal(&cost.state), &paid]);
    residual -= &P;
    assert!(largest(&residual) < TOLERANCE * PERIOD * largest(&P), "{residual:?}");
    for (found, expected) in weighted.iter().zip(&closed.transpose() * &(&P * &B)) {
        for i in 0..N {
            close(&found.row(i).scaled(PERIOD.recip()), &expected.column(i).scaled(PERIOD.recip()), 1e-9);
        }
    }
}

#[test]
fn regulators_solve_their_equations() {
    at_postures!(solves_its_equations, 2);
}

/// Matrices of 64 rows: about 1 MB of stack, and as much here.
#[test]
fn sixteen_joints_are_no_other_matter() {
    let check = || {
        let r = &mut Numbers(8);
        solves_its_equations(&flexible(serial::<16>(), r), r);
    };
    std::thread::Builder::new().stack_size(1 << 23).spawn(check).expect("a thread").join().expect("it holds");
}

#[test]
fn a_matrix_is_positive_or_not() {
    let r = &mut Numbers(3);
    let root = BlockMatrix::<f64, 3, 2>::from_columns(&std::array::from_fn(|_| {
        std::array::from_fn(|_| Matrix::from_fn(|_, _| r.next()))
    }));
    let square = &root.transpose() * &root;
    let less = |by: f64| {
        let (mut matrix, mut unit) = (square, BlockMatrix::identity());
        unit.scale(by);
        matrix -= &unit;
        matrix
    };
    // Between zero and the least eigenvalue, and beyond the mean of all.
    let mut inverse = [BlockMatrix::identity()];
    { square }.solve(&mut inverse);
    let least = inverse[0].norm().recip();
    assert!(square.is_positive_definite() && less(0.9 * least).is_positive_definite());
    assert!(!less(square.diagonal_entries().sum::<f64>() / 6.0).is_positive_definite());
    // Solving undoes multiplying, with pivots that are zero on the diagonal, too.
    let one = Matrix::identity();
    let swap = BlockMatrix::from_columns(&[[Matrix::ZERO, one], [one, Matrix::ZERO]]);
    for a in [root, swap] {
        let mut found = [&a * &square];
        { a }.solve(&mut found);
        found[0] -= &square;
        assert!(found[0].norm() < 1e-12 * square.norm() / least);
    }
}

/// The robot under gravity, sampled, from deviations of 10⁻⁴ on: what it pays is xᵀ P x but for terms of third order.
#[test]
fn the_robot_pays_the_cost_to_go() {
    let r = &mut Numbers(4);
    let robot = flexible(serial::<7>(), r);
    let (posture, cost) = (r.vector(0.5), cost(r));
    let model = LinearModel::at_rest(&robot, &posture).held(PERIOD);
    let Regulator { gain, cost_to_go } =
        Regulator::discrete(&model, &cost.over(PERIOD)).expect("a robot that can be held");
    let (law, q_ld) = (Lqr { gain }, resting(&posture));
    let (rest, gravity) = nominal(&robot, &q_ld);
    let deviation = |x: &Motion<f64, 7>| std::array::from_fn(|k| parts(x)[k] - parts(&rest)[k]);
    let mut x = motion(sum(&parts(&rest), &std::array::from_fn(|_| r.vector(1e-4))));
    let expected = form(&cost_to_go, &deviation(&x));
    let mut paid = 0.0;
    for _ in 0..5000 {
        let u = law.torque(&robot, &x, &q_ld);
        paid += PERIOD * rate(&cost, &deviation(&x), &(u - gravity));
        x = advance(&robot, &x, &u, &Push::NONE, PERIOD, 4);
    }
    assert!(form(&cost_to_go, &deviation(&x)) < 1e-6 * expected, "it comes to rest");
    assert!((paid / expected - 1.0).abs() < 1e-3, "{paid} of {expected}");
}

/// Half the period, half the difference of the gains.
#[test]
fn held_gains_tend_to_continuous_ones() {
    let r = &mut Numbers(5);
    let robot = flexible(serial::<7>(), r);
    let (model, cost) = (LinearModel::at_rest(&robot, &r.vector(1.0)), cost(r));
    let F = Regulator::continuous(&model, &cost, &Vector([f64::INFINITY; _]))
        .expect("a robot that can be held")
        .gain;
    let [whole, half] = [1e-4, 0.5e-4].map(|period| {
        let held = Regulator::discrete(&model.held(period), &cost.over(period)).expect("as well").gain;
        let differences = held.iter().zip(F).flat_map(|(a, b)| (*a - b).0.into_iter().flatten());
        differences.fold(0.0, |m: f64, x| m.max(x.abs()))
    });
    assert!((whole / half - 2.0).abs() < 0.02, "{whole} {half}");
}

#[test]
fn the_law_is_linear_feedback_around_the_reference() {
    let r = &mut Numbers(6);
    let robot = flexible(branched::<5>(2), r);
    let law = Lqr::design(&robot, &Vector::ZERO, &cost(r), &Vector([f64::INFINITY; _]))
        .expect("a robot that can be held");
    let q_ld = r.series(1.0);
    let (on_it, u_d) = nominal(&robot, &q_ld);
    close(&law.torque(&robot, &on_it, &q_ld), &u_d, 1e-15);
    let x = r.motion(1.0);
    let x = Motion { q_m: Vector::from_fn(|i| Dual::variable(x.q_m[i], i)), ..x.map(Dual::constant) };
    let lifted = q_ld.map(|q| Jet::from_fn(|k| Dual::constant(q.coefficient(k))));
    let u = law.torque(&robot, &x, &lifted);
    for i in 0..5 {
        close(&-Vector(u[i].gradient), &law.gain[1].row(i), 1e-15);
    }
}

/// The largest amplification of sinusoidal torques on the link, from 0.01 to 1000 rad/s: √cost per N m.
fn amplification(model: &LinearModel<f64, 1>, cost: &QuadraticCost<f64, 1>, F: &Blocks<1>) -> f64 {
    let mut closed = model.state;
    closed -= &BlockMatrix::outer(&model.input, F);
    let block = |i: usize, j: usize| closed.block(i, j);
    let gains = (0..4000).map(|k| {
        let omega = 10f64.powf(-2.0 + 5.0 * f64::from(k) / 4000.0);
        // (jω − A) x = G in real and imaginary parts.
        let unit = |i: usize, j: usize| if i == j { Matrix([[omega]]) } else { Matrix::ZERO };
        let columns = std::array::from_fn(|j| {
            std::array::from_fn(|i| match (i / 4, j / 4) {
                (0, 0) | (1, 1) => -block(i % 4, j % 4),
                (0, 1) => -unit(i, j - 4),
                _ => unit(i - 4, j),
            })
        });
        let mut G = [[Matrix::ZERO; 8]; 8];
        G[0] = std::array::from_fn(|i| if i < 4 { model.disturbance[i] } else { Matrix::ZERO });
        let mut x = [BlockMatrix::<f64, 1, 8>::from_columns(&G)];
        BlockMatrix::from_columns(&columns).solve(&mut x);
        let [x] = x;
        let part = |from: usize| std::array::from_fn(|i| Vector([x.block(from + i, 0)[(0, 0)]]));
        [part(0), part(4)].iter().map(|x| rate(cost, x, &row(F, x))).sum::<f64>().sqrt()
    });
    gains.fold(0.0, f64::max)
}

/// γ is kept by the loop it was asked for, and the least γ that is not refused is what no feedback can go below.
#[test]
fn torques_on_links_cost_no_more_than_asked_for() {
    let links = Pendulum { inertia: 0.5, weight_moment: 10.0 };
    let of = |x: f64| Vector([x]);
    let robot = Fjr {
        links,
        motor_inertia: of(0.1),
        stiffness: of(100.0),
        link_damping: of(0.2),
        motor_damping: of(0.3),
    };
    let model = LinearModel::at_rest(&robot, &of(0.7));
    let cost = QuadraticCost { state: [of(400.0), of(40.0), of(1.0), of(1.0)], torque: of(0.05) };
    let regulator = |gamma| Regulator::continuous(&model, &cost, &of(gamma));
    let F = |gamma| regulator(gamma).expect("it is large enough").gain;

    let (mut refused, mut kept) = (1e-3, 1e3);
    for _ in 0..60 {
        let middle = f64::sqrt(refused * kept);
        if regulator(middle).is_ok() { kept = middle } else { refused = middle }
    }
    for weight in [1.0, 1e-3, 1e5] {
        let least = Regulator::least_attenuation(&model, &cost, &of(weight)).expect("it can be held");
        assert!(least * weight >= kept && least * weight <= 1.011 * kept, "{least} {kept}");
    }
    assert!(matches!(regulator(0.5 * refused), Err(NoRegulator::Indefinite | NoRegulator::Unstable)));
    let quadratic = amplification(&model, &cost, &F(f64::INFINITY));
    for above in [1.001, 1.1, 2.0] {
        let found = amplification(&model, &cost, &F(above * kept));
        assert!(found <= above * kept && found >= 0.999 * kept, "{found}, {kept}");
    }
    assert!(quadratic > 1.01 * kept, "{quadratic} {kept}");

    let far = F(1e6);
    for (a, b) in far.iter().zip(F(f64::INFINITY)) {
        close(&a.row(0), &b.row(0), 1e-9);
    }
}

/// Links that nothing holds, and a cost that does not see them.
#[test]
fn what_is_not_seen_is_refused() {
    let robot = flexible(planar(), &mut Numbers(7));
    let cost = QuadraticCost { state: [Vector::ZERO; 4], torque: Vector([1.0; 2]) };
    let found = Lqr::design(&robot, &Vector::ZERO, &cost, &Vector([f64::INFINITY; _]));
    assert_eq!(found, Err(NoRegulator::Unstable));
}
