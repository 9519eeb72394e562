//! The predictive law: what it minimises, what it never exceeds, what it is without limits.

use flexure_core::control::{ControlLaw, LinearModel, Lqr, Mpc, QuadraticCost, Regulator};
use flexure_core::linalg::{BlockMatrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{Pendulum, PlanarTwoLink};
use flexure_core::scalar::{Dual, Jet, Lanes};

use crate::common::laws::{nominal, resting};
use crate::common::plant::{PERIOD, Push, advance, plausible_arm, undamped};
use crate::common::{Numbers, PLANAR, PlanarData, branched, close, flexible, planar, serial};
use crate::optimal::{cost, form, motion, parts, rate, sum, times};

/// Ten robots of each kind, the last two under gravity.
macro_rules! on_robots {
    ($check:ident, $seed:literal) => {{
        let r = &mut Numbers($seed);
        for _ in 0..10 {
            $check(&flexible(planar(), r), r);
            $check(&flexible(branched::<5>(2), r), r);
            $check(&flexible(serial::<7>(), r), r);
        }
    }};
}

fn without_limits<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let (posture, cost) = (r.vector(1.0), cost(r));
    let model = LinearModel::at_rest(robot, &posture).held(PERIOD);
    let regulator = Regulator::discrete(&model, &cost.over(PERIOD)).expect("a robot that can be held");
    let lqr = Lqr { gain: regulator.gain };
    for limit in [1e9, f64::INFINITY] {
        let law =
            Mpc::<f64, N, 10>::design(robot, &posture, &cost, PERIOD, &Vector([limit; N])).expect("as well");
        for _ in 0..10 {
            let (x, q_ld) = (r.motion(1.0), r.series(1.0));
            close(&law.torque(robot, &x, &q_ld), &lqr.torque(robot, &x, &q_ld), 1e-14);
        }
    }
}

/// On any reference.
#[test]
fn without_limits_it_is_the_discrete_regulator() {
    on_robots!(without_limits, 1);
}

fn within_limits<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let limit = r.between(1.0, 30.0);
    let law = Mpc::<f64, N, 10>::design(robot, &r.vector(1.0), &cost(r), PERIOD, &limit)
        .expect("a robot that can be held");
    for _ in 0..100 {
        let u = law.torque(robot, &r.motion(2.0), &r.series(1.0));
        for i in 0..N {
            assert!(u[i].abs() <= limit[i] * (1.0 + 2.0 * f64::EPSILON), "{u:?} of {limit:?}");
        }
    }
}

/// 3000 states, most of which ask for much more.
#[test]
fn no_torque_exceeds_its_limit() {
    on_robots!(within_limits, 2);
}

/// Torques of `H` steps from errors on, and what they cost with all that comes after, straight from the definition.
struct Plan<'a, const N: usize, const H: usize> {
    model: &'a LinearModel<f64, N>,
    cost: &'a QuadraticCost<f64, N>,
    cost_to_go: &'a BlockMatrix<f64, N, 4>,
}

impl<const N: usize, const H: usize> Plan<'_, N, H> {
    fn total(&self, mut e: [Vector<f64, N>; 4], torques: &[Vector<f64, N>; H]) -> f64 {
        let mut paid = 0.0;
        for u in torques {
            paid += rate(self.cost, &e, u);
            e = sum(&times(&self.model.state, &e), &self.model.input.map(|block| block * *u));
        }
        paid + form(self.cost_to_go, &e)
    }

    /// The best torques in the box: by coordinate descent on the dense quadratic form until nothing moves.
    fn best(
        &self,
        e: &[Vector<f64, N>; 4],
        low: &Vector<f64, N>,
        high: &Vector<f64, N>,
    ) -> [Vector<f64, N>; H] {
        let (none, rest) = ([Vector::ZERO; H], [Vector::ZERO; 4]);
        let size = N * H;
        let unit = |i: usize| {
            let mut torques = none;
            torques[i / N][i % N] = 1.0;
            torques
        };
        let both = |i: usize, j: usize| {
            let mut torques = unit(i);
            torques[j / N][j % N] += 1.0;
            torques
        };
        let alone: Vec<f64> = (0..size).map(|i| self.total(rest, &unit(i))).collect();
        // J = c + bᵀ U + Uᵀ A U.
        let a: Vec<Vec<f64>> = (0..size)
            .map(|i| (0..size).map(|j| 0.5 * (self.total(rest, &both(i, j)) - alone[i] - alone[j])).collect())
            .collect();
        let b: Vec<f64> =
            (0..size).map(|i| self.total(*e, &unit(i)) - self.total(*e, &none) - alone[i]).collect();
        let mut u = vec![0.0; size];
        for _ in 0..100_000 {
            let mut moved: f64 = 0.0;
            for i in 0..size {
                let slope = b[i] + 2.0 * (0..size).map(|j| a[i][j] * u[j]).sum::<f64>();
                let next = (u[i] - 0.5 * slope / a[i][i]).clamp(low[i % N], high[i % N]);
                moved = moved.max((next - u[i]).abs());
                u[i] = next;
            }
            if moved < 1e-13 {
                break;
            }
        }
        std::array::from_fn(|k| Vector::from_fn(|i| u[N * k + i]))
    }
}

fn is_the_best<L: Links<f64, N>, const N: usize, const H: usize>(
    robot: &Fjr<f64, L, N>,
    step: f64,
    r: &mut Numbers,
) -> f64 {
    let (posture, cost, limit) = (r.vector(1.0), cost(r), r.between(2.0, 20.0));
    let law =
        Mpc::<f64, N, H>::design(robot, &posture, &cost, step, &limit).expect("a robot that can be held");
    let (model, cost) = (LinearModel::at_rest(robot, &posture).held(step), cost.over(step));
    let regulator = Regulator::discrete(&model, &cost).expect("as before");
    let plan = Plan::<N, H> { model: &model, cost: &cost, cost_to_go: &regulator.cost_to_go };
    let mut worst: f64 = 0.0;
    for _ in 0..10 {
        let q_ld = r.series(0.5);
        let (on_it, u_d) = nominal(robot, &q_ld);
        let e = std::array::from_fn(|_| r.vector(0.3));
        let u = law.torque(robot, &motion(sum(&parts(&on_it), &e)), &q_ld);
        let best = plan.best(&e, &(-limit - u_d), &(limit - u_d));
        for i in 0..N {
            worst = worst.max((u[i] - u_d[i] - best[0][i]).abs() / limit[i]);
        }
    }
    worst
}

/// What thirty sweeps leave: of plans of 10 ms 10⁻¹⁰ of the limit, of 200 ms, whose torques have more to do with each other, 5·10⁻⁵.
#[test]
fn it_is_the_best_within_limits() {
    let r = &mut Numbers(3);
    for _ in 0..5 {
        let short = is_the_best::<_, 2, 10>(&flexible(planar(), r), PERIOD, r);
        let branched = is_the_best::<_, 5, 10>(&flexible(branched::<5>(2), r), PERIOD, r);
        let long = is_the_best::<_, 2, 20>(&flexible(planar(), r), 10.0 * PERIOD, r);
        assert!(short < 1e-9 && branched < 1e-9 && long < 1e-4, "{short} {branched} {long}");
    }
}

/// A swing of the undamped two-link arm from far away within 3 N m and 0.3 N m, of which the regulator asks for forty times as much at first.
#[test]
fn limits_that_are_known_cost_less() {
    let robot = undamped(plausible_arm());
    let cost = QuadraticCost {
        state: [100.0, 10.0, 0.25, 0.025].map(|x| Vector([x; 2])),
        torque: Vector([0.02, 0.2]),
    };
    let (limit, goal) = (Vector([3.0, 0.3]), resting(&Vector::ZERO));
    let paid = |law: &dyn Fn(&Motion<f64, 2>) -> Vector<f64, 2>| {
        let mut x = Motion::at_rest(Vector([1.5, -1.0]));
        let mut paid = 0.0;
        for _ in 0..2000 {
            let u = law(&x);
            let u = Vector::from_fn(|i| u[i].clamp(-limit[i], limit[i]));
            paid += PERIOD * rate(&cost, &parts(&x), &u);
            x = advance(&robot, &x, &u, &Push::NONE, PERIOD, 10);
        }
        paid
    };
    let posture = Vector::ZERO;
    let lqr =
        Lqr::design(&robot, &posture, &cost, &Vector([f64::INFINITY; _])).expect("an arm that can be held");
    let short = Mpc::<f64, 2, 20>::design(&robot, &posture, &cost, PERIOD, &limit).expect("as well");
    let long = Mpc::<f64, 2, 20>::design(&robot, &posture, &cost, 10.0 * PERIOD, &limit).expect("as well");
    let saturated = paid(&|x| lqr.torque(&robot, x, &goal));
    let [short, long] = [short, long].map(|law| paid(&|x| law.torque(&robot, x, &goal)));
    assert!(short < 0.65 * saturated && long < 0.85 * short, "{saturated} {short} {long}");
}

/// The law on dual numbers has the slopes of the law on floats where some torques are at their limits and some are not, and on lanes it is as many laws side by
/// side. Differences of 10⁻⁵ rad leave 10⁻¹⁰ of the roundings of 100 N m, but for a limit that is met in between.
#[test]
fn it_runs_on_every_number() {
    const STEP: f64 = 1e-5;
    let r = &mut Numbers(4);
    let robot = flexible(branched::<5>(2), r);
    let limit = Vector([10.0; 5]);
    let law = Mpc::<f64, 5, 10>::design(&robot, &Vector::ZERO, &cost(r), PERIOD, &limit)
        .expect("a robot that can be held");
    let states: [(Motion<f64, 5>, Vector<Jet<f64, 5>, 5>); 4] =
        std::array::from_fn(|_| (r.motion(0.3), r.series(0.3)));
    let torques = states.map(|(x, q_ld)| law.torque(&robot, &x, &q_ld));
    let limited = torques.iter().flat_map(Vector::iter).filter(|u| u.abs() > 9.999).count();
    assert!((4..16).contains(&limited), "{limited}");
    for (x, q_ld) in &states {
        let lifted = q_ld.map(|q| Jet::from_fn(|k| Dual::<f64, 5>::constant(q.coefficient(k))));
        let seeded = Vector::from_fn(|i| Dual::variable(x.q_m[i], i));
        let slopes = law.torque(&robot, &Motion { q_m: seeded, ..x.map(Dual::constant) }, &lifted);
        for j in 0..5 {
            let [more, less] = [STEP, -STEP].map(|step| {
                let mut x = *x;
                x.q_m[j] += step;
                law.torque(&robot, &x, q_ld)
            });
            close(&slopes.map(|u| u.gradient[j]), &(more - less).scaled(0.5 / STEP), 1e-6);
        }
    }
}

/// A torque that is exactly its limit has its value, but no derivative.
#[test]
fn a_kink_has_no_slope() {
    let one = Vector([1.0]);
    let links = Pendulum { inertia: 1.0, weight_moment: 1.0 };
    let robot = Fjr { links, motor_inertia: one, stiffness: one, link_damping: one, motor_damping: one };
    let cost = QuadraticCost { state: [one; 4], torque: one };
    let level = Vector([std::f64::consts::FRAC_PI_2]);
    let law = Mpc::<f64, 1, 1>::design(&robot, &level, &cost, PERIOD, &one).expect("it can be held");
    let q_ld = resting(&level);
    let (x, _) = nominal(&robot, &q_ld);
    let slope = |q_m: f64| {
        let x = Motion { q_m: Vector([Dual::<f64, 1>::variable(q_m, 0)]), ..x.map(Dual::constant) };
        law.torque(&robot, &x, &q_ld.map(|q| Jet::from_fn(|k| Dual::constant(q.coefficient(k)))))[0]
    };
    let kink = slope(x.q_m[0]);
    assert!((kink.value - 1.0).abs() < 1e-15 && kink.gradient[0].is_nan(), "{kink:?}");
    assert!(slope(x.q_m[0] + 1e-9).gradient[0] < -0.1, "held with less than the limit");
    assert!(slope(x.q_m[0] - 1e-9).gradient[0].abs() < 1e-6, "at the limit");
}

/// Robot, gains and states in lanes: sines differ by two units in the last place.
#[cfg(feature = "lanes")]
#[test]
fn it_runs_in_lanes() {
    type L4 = Lanes<f64, 4>;
    let r = &mut Numbers(5);
    let robot = flexible(planar(), r);
    let law = Mpc::<f64, 2, 10>::design(&robot, &Vector::ZERO, &cost(r), PERIOD, &Vector([5.0, 2.0]))
        .expect("an arm that can be held");
    let PlanarData { mass, length, com, inertia } = PLANAR;
    let [mass, com, inertia] = [mass, com, inertia].map(|x| x.map(L4::splat));
    let splat = |v: Vector<f64, 2>| v.map(L4::splat);
    let robots = Fjr {
        links: PlanarTwoLink::new(mass, L4::splat(length), com, inertia),
        motor_inertia: splat(robot.motor_inertia),
        stiffness: splat(robot.stiffness),
        link_damping: splat(robot.link_damping),
        motor_damping: splat(robot.motor_damping),
    };
    let laws = law.map(L4::splat);
    for _ in 0..50 {
        let states: [Motion<f64, 2>; 4] = std::array::from_fn(|_| r.motion(0.3));
        let q_ld = r.series::<5, 2>(0.3);
        let pack =
            |part: usize| Vector::from_fn(|i| L4::from_array(states.each_ref().map(|x| parts(x)[part][i])));
        let together = laws.torque(
            &robots,
            &motion(std::array::from_fn(pack)),
            &q_ld.map(|q| Jet::from_fn(|k| L4::splat(q.coefficient(k)))),
        );
        for (lane, x) in states.iter().enumerate() {
            close(&together.map(|u| u.to_array()[lane]), &law.torque(&robot, x, &q_ld), 1e-12);
        }
    }
}
