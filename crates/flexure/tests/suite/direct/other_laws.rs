//! What no structure theorem covers: other shaping functions, broken laws, other controllers.

use flexure::linalg::Symmetric;
use flexure::prove::engine::direct::Balance;
use flexure::prove::engine::direct::StateBox;
use flexure::prove::engine::direct::{
    Coordinate, System, Twins, best_rate, jacobian, prove, symmetric_part, vcbc,
};
use flexure::prove::engine::verdict::Verdict;
use flexure_core::control::{Shaping, Tanh};
use flexure_core::linalg::Vector;
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Dual, Interval, Over, Scalar};

use super::arm::{self, Arm, Decimal, around, closed_loop, flow, region, tanh};

/// φ = Λ (q̃ + q̃³/10): as fast as the linear law at the reference, faster away from it.
#[derive(Clone, Copy, Debug)]
struct Cubic<C> {
    gain: Vector<C, 2>,
}

impl<C: Scalar> Shaping<C, 2> for Cubic<C> {
    fn eval<T: Over<C>>(&self, error: &Vector<T, 2>) -> Vector<T, 2> {
        self.gain.diag_mul(&error.map(|e| e + e.square() * e * T::from_ratio(1, 10)))
    }
}

#[test]
fn a_shaping_function_of_the_user() {
    let cubic = flow(|gain| Cubic { gain }, |gain| Cubic { gain }, &region());
    let start = std::time::Instant::now();
    let verdict = best_rate(&cubic, 20_000);
    println!("q̃ + q̃³/10: {verdict:?} in {:?}", start.elapsed());
    let best = verdict.proved().expect("slopes are at least Λ");
    // The slowest entry of Λ, at no error.
    assert!((0.9999 * 30.0..=30.0).contains(&best.rate), "{best:?}");
    assert_eq!(prove(&cubic, 30.0 * (1.0 + 1e-9), 20_000).word(), "refuted");
}

/// The closed loop with one sign wrong: what the springs do to the motor errors adds up instead of cancelling.
struct Flipped<C>(Arm<C, Tanh<C, 2>>);

impl<C: Decimal> System<C> for Flipped<C> {
    fn balance(&self, at: &[C]) -> Balance<C> {
        let Balance { dissipation, weight } = self.0.balance(at);
        let stiffness = self.0.robot.stiffness;
        let dissipation = Symmetric::from_fn(8, |i, j| {
            // Rows s_l, columns q̃_m: −½ (K − K) becomes −½ (K + K).
            let more = if i / 2 == 2 && j / 2 == 1 && i % 2 == j % 2 { stiffness[i % 2] } else { C::ZERO };
            dissipation.at(i, j) - more
        });
        Balance { dissipation, weight }
    }
}

/// Where slopes are flat the coupling decides: |q̃_i| ≤ 6.
#[test]
fn coupling_that_adds_up() {
    let wide = StateBox::within(6.0);
    let rate = 7e-4;
    let right = prove(&flow(tanh, tanh, &wide), rate, 10_000);
    assert!(right.proved().is_some(), "{right:?}");
    let coordinates = wide.coordinates(wide.position.len());
    let flipped =
        Twins { bounds: Flipped(closed_loop(tanh)), point: Flipped(closed_loop(tanh)), coordinates };
    let Verdict::Refuted(witness) = prove(&flipped, rate, 10_000) else { panic!("a sign is wrong") };
    assert!(witness.value < 0.0 && witness.rate < 0.0, "{witness:?}");
    assert_eq!(best_rate(&flipped, 10_000).word(), "refuted");
}

#[test]
fn damping_of_the_wrong_sign() {
    fn broken<C: Decimal>() -> Arm<C, Tanh<C, 2>> {
        let mut system = closed_loop(tanh);
        system.law.motor.damping = C::decimals(["-10.0", "5.0"]);
        system
    }
    let verdict = prove(&vcbc(broken(), broken(), &region()), 1e-3, 10_000);
    let Verdict::Refuted(witness) = verdict else { panic!("{verdict:?}") };
    // −9.8 N m s/rad on 0.23 kg m².
    assert!((witness.rate + 9.8 / 0.23).abs() < 1e-9, "{witness:?}");
}

/// PD regulation u = −K_P (θ − θ_0) − K_D θ̇ + g(q_0) of a pendulum on a flexible joint about q_0 = 0.5 rad, in a constant
/// metric that solves a Lyapunov equation at q_0. Variations of (q, q̇, θ, θ̇); the torque depends on θ_0 and g(q_0), the
/// variation does not.
struct Regulated<C> {
    inertia: C,
    weight_moment: C,
    stiffness: C,
    motor_inertia: C,
    damping: C,
    proportional: C,
    derivative: C,
    metric: [[C; 4]; 4],
}

impl<C: Decimal> Regulated<C> {
    fn new() -> Self {
        let metric = [
            ["58.24042", "-0.06574", "-66.18042", "-1.44572"],
            ["-0.06574", "0.1", "0.84474", "-0.02789"],
            ["-66.18042", "0.84474", "99.16413", "2.43599"],
            ["-1.44572", "-0.02789", "2.43599", "0.11226"],
        ];
        Self {
            inertia: C::decimal("0.1"),
            weight_moment: C::decimal("1.0"),
            stiffness: C::decimal("50.0"),
            motor_inertia: C::decimal("0.2"),
            damping: C::decimal("0.5"),
            proportional: C::decimal("30.0"),
            derivative: C::decimal("5.0"),
            metric: metric.map(|row| row.map(C::decimal)),
        }
    }

    fn rates(&self, x: &[Dual<C, 1>]) -> Vec<Dual<C, 1>> {
        let [q, v, theta, omega] = [x[0], x[1], x[2], x[3]];
        let spring = (theta - q).scale(self.stiffness);
        let torque = -theta.scale(self.proportional) - omega.scale(self.derivative);
        let link = spring - v.scale(self.damping) - q.sin().scale(self.weight_moment);
        let motor = torque - spring - omega.scale(self.damping);
        vec![v, link.scale(self.inertia.recip()), omega, motor.scale(self.motor_inertia.recip())]
    }
}

impl<C: Decimal> System<C> for Regulated<C> {
    fn balance(&self, at: &[C]) -> Balance<C> {
        let slopes = jacobian(at, 4, |x| self.rates(x));
        let product =
            |i: usize, j: usize| (0..4).fold(C::ZERO, |sum, k| sum + self.metric[i][k] * slopes[(k, j)]);
        Balance {
            dissipation: Symmetric::from_fn(4, |i, j| -symmetric_part(product, i, j)),
            weight: Symmetric::from_fn(4, |i, j| self.metric[i][j]),
        }
    }
}

fn regulated(radius: f64) -> Twins<Regulated<Interval>, Regulated<f64>> {
    let coordinates = [("q", "rad", around(0.5, radius)), ("v", "rad/s", Interval::ENTIRE)]
        .into_iter()
        .chain([("theta", "rad", Interval::ENTIRE), ("omega", "rad/s", Interval::ENTIRE)])
        .map(|(name, unit, range)| Coordinate { name: name.to_owned(), unit, range })
        .collect();
    Twins { bounds: Regulated::new(), point: Regulated::new(), coordinates }
}

/// Figures of the rate over the box from 1e4 samples in another program.
#[test]
fn regulation_about_a_set_point() {
    for (radius, sampled) in [(0.1, 5.529_156), (0.5, 5.526_468), (1.5, 5.299_410)] {
        let start = std::time::Instant::now();
        let verdict = best_rate(&regulated(radius), 50_000);
        println!("PD, ±{radius} rad: {verdict:?} in {:?}", start.elapsed());
        let best = verdict.proved().expect("a Lyapunov function");
        assert!((best.upper - sampled).abs() < 2e-6, "{best:?}");
        assert!(best.rate > 0.9999 * best.upper, "{best:?}");
    }
}

/// One variable, dissipation 1, weight 1 − 2 x²: negative where |x| > 0.7.
struct NoMetric;

impl<C: Scalar> System<C> for NoMetric {
    fn balance(&self, at: &[C]) -> Balance<C> {
        let square = at[0].square();
        let weight = C::ONE - (square + square);
        Balance {
            dissipation: Symmetric::from_fn(1, |_, _| C::ONE),
            weight: Symmetric::from_fn(1, |_, _| weight),
        }
    }
}

/// A weight that is no metric proves nothing, however large the dissipation.
#[test]
fn a_weight_must_be_a_metric() {
    let flow = |range| {
        let coordinates = vec![Coordinate { name: "x".to_owned(), unit: "rad", range }];
        Twins { bounds: NoMetric, point: NoMetric, coordinates }
    };
    assert!(prove(&flow(around(0.0, 0.5)), 1.0 - 1e-9, 1_000).proved().is_some());
    for range in [around(0.0, 1.0), around(2.0, 1.0)] {
        let verdict = prove(&flow(range), 0.5, 1_000);
        assert!(verdict.proved().is_none(), "{verdict:?}");
        assert!(best_rate(&flow(range), 1_000).proved().is_none());
    }
}

/// Tanh laws on a robot whose constants are not known exactly: the rate holds for all of them.
#[test]
fn uncertain_constants() {
    let exact: Arm<f64, Tanh<f64, 2>> = closed_loop(tanh);
    let mut uncertain: Arm<Interval, Tanh<Interval, 2>> = closed_loop(tanh);
    uncertain.robot.motor_inertia = Vector([around(0.23, 0.02), around(0.01, 0.001)]);
    uncertain.robot.links = PlanarTwoLink::new(
        [around(1.51, 0.1), around(0.873, 0.05)],
        Interval::point(0.343),
        [Interval::point(0.159), Interval::point(0.055)],
        [Interval::point(0.0392), Interval::point(0.00808)],
    );
    let flow: arm::ArmFlow<_, _> = vcbc(uncertain, exact, &StateBox::within(3.0));
    let verdict = best_rate(&flow, 20_000);
    println!("uncertain: {verdict:?}");
    assert!(verdict.proved().is_some_and(|best| best.rate > 0.2959), "{verdict:?}");
}
