//! Storage functions of the laws decay along the closed loop, exactly as the theory says: dV/dt from Taylor series of the
//! closed loop against the dissipation in closed form, at random states.

use flexure_core::control::{ControlLaw, MotorPd, Pd};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Pendulum;
use flexure_core::scalar::{Jet, Over};

use crate::common::laws::{self, Course, resting};
use crate::common::{Numbers, branched, close, flexible};
use crate::on_three_robots;

type Series<const K: usize, const N: usize> = Vector<Jet<f64, K>, N>;

/// Springs so stiff that sixteen passes find where links rest.
fn stiff<L: Links<f64, N>, const N: usize>(links: L, r: &mut Numbers) -> Fjr<f64, L, N> {
    let robot = flexible(links, r);
    Fjr { stiffness: robot.stiffness.scaled(20.0), ..robot }
}

fn half_square<T: Over<f64>, const N: usize>(weight: &Vector<f64, N>, x: &Vector<T, N>) -> T {
    x.dot(&weight.diag_mul(x)).scale(0.5)
}

fn dissipation<const N: usize>(weight: &Vector<f64, N>, v: &Vector<f64, N>) -> f64 {
    v.dot(&weight.diag_mul(v))
}

/// dV/dt is minus `loss`. Rounding: a few hundred operations on terms whose sum of magnitudes is `size`.
fn decays(V: Jet<f64, 2>, loss: f64, size: f64) {
    let rate = V.coefficient(1);
    assert!((rate + loss).abs() <= 1e-11 * (size + loss), "dV/dt = {rate}, expected {}", -loss);
    assert!(loss > 0.0);
}

/// The closed loop from a random state, and how much power flows in it.
fn course<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &impl ControlLaw<f64, N>,
    q_ld: &Series<5, N>,
    r: &mut Numbers,
) -> (Motion<f64, N>, Course<N>, f64) {
    let x = r.motion(1.0);
    let u_m = law.torque(robot, &x, q_ld);
    let course = Course::new(robot, &x, &u_m);
    let spring = robot.spring_torque(&x.q_l, &x.q_m);
    let power = |v: &Vector<f64, N>, u: &Vector<f64, N>| (0..N).map(|i| (v[i] * u[i]).abs()).sum::<f64>();
    let size = power(&x.v_m, &u_m) + power(&x.v_m, &spring) + power(&x.v_l, &spring);
    (x, course, 1.0 + size)
}

/// Where motors rest that hold the links at `q`.
fn held<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, q: &Vector<f64, N>) -> Vector<f64, N> {
    *q + robot.stiffness.map(f64::recip).diag_mul(&robot.links.gravity_torque(q))
}

/// Energy of the robot and of the feedback of motor positions: what all regulators store, but for gravity's share.
fn shaped_energy<T: Over<f64>, L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    motor: &MotorPd<f64, N>,
    x: &Motion<T, N>,
    goal: &Vector<f64, N>,
) -> T {
    robot.total_energy(x) + half_square(&motor.stiffness, &(x.q_m - held(robot, goal).lift()))
}

fn pd_storage<T: Over<f64>, L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Pd<f64, N>,
    x: &Motion<T, N>,
    goal: &Vector<f64, N>,
) -> T {
    shaped_energy(robot, &law.motor, x, goal) - x.q_m.dot(&robot.links.gravity_torque(goal).lift())
}

fn pd<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, goal) = (flexible(links(), r), laws::pd(r), r.vector(1.0));
    let (x, course, size) = course(&robot, &law, &resting(&goal), r);
    let loss = dissipation(&robot.link_damping, &x.v_l)
        + dissipation(&(robot.motor_damping + law.motor.damping), &x.v_m);
    decays(pd_storage(&robot, &law, &course.motion(), &goal), loss, size);
}

/// What compensates gravity at the motors is a potential: minus the energy of the links at rest on their springs.
fn resting_energy<T: Over<f64>, L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    q_m: &Vector<T, N>,
) -> T {
    let q = robot.links_at_rest(q_m);
    let gravity = robot.links.gravity_torque(&q);
    robot.links.potential_energy(&q) + half_square(&robot.stiffness.map(f64::recip), &gravity)
}

fn pd_online_gravity<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, goal) = (stiff(links(), r), laws::pd_online_gravity(r), r.vector(1.0));
    let (x, course, size) = course(&robot, &law, &resting(&goal), r);
    let along = course.motion();
    let V = shaped_energy(&robot, &law.motor, &along, &goal) - resting_energy(&robot, &along.q_m);
    let loss = dissipation(&robot.link_damping, &x.v_l)
        + dissipation(&(robot.motor_damping + law.motor.damping), &x.v_m);
    decays(V, loss, size);
    // Any K_P: what gravity and springs store is least where the links rest.
    assert!(V.coefficient(0) > least(&robot, &goal));
}

/// The storage at the goal.
fn least<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, goal: &Vector<f64, N>) -> f64 {
    let at_goal = Motion { q_m: held(robot, goal), ..Motion::at_rest(*goal) };
    robot.total_energy(&at_goal) - resting_energy(robot, &at_goal.q_m)
}

fn torque_feedback<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, goal) = (stiff(links(), r), laws::torque_feedback(r), r.vector(1.0));
    let (x, course, size) = course(&robot, &law, &resting(&goal), r);
    let along = course.motion();
    // The kinetic energy is that of a motor with the shaped inertia.
    let shaped = Fjr { motor_inertia: law.inertia, ..robot };
    let V = shaped_energy(&shaped, &law.motor, &along, &goal) - resting_energy(&shaped, &along.q_m);
    let damping = Vector::from_fn(|i| {
        law.motor.damping[i] + robot.motor_damping[i] * law.inertia[i] / robot.motor_inertia[i]
    });
    let loss = dissipation(&robot.link_damping, &x.v_l) + dissipation(&damping, &x.v_m);
    decays(V, loss, size);
}

fn gravity_cancellation<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, goal) = (flexible(links(), r), laws::gravity_cancellation(r), r.vector(1.0));
    let (x, course, size) = course(&robot, &law, &resting(&goal), r);
    // The robot without gravity, its motors shifted.
    let q = course.q_l.map(|q| q.truncate::<3>());
    let shifted = course.q_m - robot.stiffness.map(f64::recip).diag_mul(&robot.links.gravity_torque(&q));
    let (q_m, v_m) = (shifted.map(|x| x.truncate()), shifted.map(|x| x.differentiate()));
    let along = Motion { q_m, v_m, ..course.motion() };
    let V = robot.total_energy(&along) - robot.links.potential_energy(&along.q_l)
        + half_square(&law.motor.stiffness, &(along.q_m - goal.lift()));
    let loss = dissipation(&robot.link_damping, &x.v_l)
        + dissipation(&(robot.motor_damping + law.motor.damping), &v_m.map(|v| v.coefficient(0)));
    decays(V, loss, size + V.coefficient(0) * 100.0);
}

/// (q, q̇) of the links to order 2 and the reference as long.
type Tracked<const N: usize> = [Series<3, N>; 6];

fn tracked<const N: usize>(course: &Course<N>, q_ld: &Series<5, N>) -> Tracked<N> {
    [
        course.q_l.map(|q| q.truncate()),
        course.q_l.map(|q| q.differentiate()),
        course.q_l.map(|q| q.differentiate_twice()),
        q_ld.map(|q| q.truncate()),
        q_ld.map(|q| q.differentiate()),
        q_ld.map(|q| q.differentiate_twice()),
    ]
}

fn passivity<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::passivity(r), r.series(1.0));
    let (_, course, size) = course(&robot, &law, &q_ld, r);
    let (s_1, beside) = springs_by_position(&robot, &course, &q_ld, &law.shaping, &law.link_damping);
    let [q, _, _, q_d, ..] = tracked(&course, &q_ld);
    let (e, lambda) = (q - q_d, law.shaping);
    let error = beside + e;
    let short = |x: Series<3, N>| x.map(|x| x.truncate::<2>());
    let s_2 = error.map(|x| x.differentiate::<2>()) + lambda.diag_mul(&short(error));
    let (s_1, between) = (short(s_1), short(error - e));
    let V = s_1.dot(&robot.links.mass_mul(&short(q), &s_1)).scale(0.5)
        + half_square(&robot.motor_inertia, &s_2)
        + half_square(&robot.stiffness, &between);
    let value = |x: &Series<2, N>| x.map(|x| x.coefficient(0));
    let spring = Vector::from_fn(|i| robot.stiffness[i] * lambda[i]);
    let loss = dissipation(&(robot.link_damping + law.link_damping), &value(&s_1))
        + dissipation(&(robot.motor_damping + law.motor_damping), &value(&s_2))
        + dissipation(&spring, &value(&between));
    decays(V, loss, size + V.coefficient(0) * 100.0);
}

fn backstepping<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::backstepping(r), r.series(1.0));
    let (_, course, size) = course(&robot, &law, &q_ld, r);
    let (s_1, error) = springs_by_position(&robot, &course, &q_ld, &law.shaping, &law.link_damping);
    let short = |x: Series<3, N>| x.map(|x| x.truncate::<2>());
    let coupling = Vector::from_fn(|i| robot.stiffness[i] / law.metric[i]);
    let (s_1, rate, error) = (short(s_1), error.map(|x| x.differentiate::<2>()), short(error));
    let z = rate + law.motor_shaping.diag_mul(&error) + coupling.diag_mul(&s_1);
    let weight = |power: i32| Vector::from_fn(|i| law.metric[i] * law.motor_shaping[i].powi(power));
    let q = course.q_l.map(|q| q.truncate());
    let V = s_1.dot(&robot.links.mass_mul(&q, &s_1)).scale(0.5)
        + half_square(&law.metric, &error)
        + half_square(&weight(-2), &z);
    let value = |x: &Series<2, N>| x.map(|x| x.coefficient(0));
    let loss = dissipation(&(robot.link_damping + law.link_damping), &value(&s_1))
        + dissipation(&weight(1), &value(&error))
        + dissipation(&weight(-1), &value(&z));
    decays(V, loss, size + V.coefficient(0) * 100.0);
}

fn cascade<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::cascade(r), r.series(1.0));
    let (_, course, _) = course(&robot, &law, &q_ld, r);
    let (s, error) = springs_by_position(&robot, &course, &q_ld, &law.shaping, &law.link_damping);
    let [error, rate, second] = error.derivatives();
    close(&second, &-(law.inner.velocity.diag_mul(&rate) + law.inner.position.diag_mul(&error)), 1e-9);
    // What that leaves of the springs drives the links.
    let [q, v, ..] = course.q_l.derivatives();
    let [s, ds, _] = s.derivatives();
    let damped = (robot.link_damping + law.link_damping).diag_mul(&s);
    close(&(robot.links.inertial_torque(&q, &v, &s, &ds) + damped), &robot.stiffness.diag_mul(&error), 1e-10);
}

/// s_1 of the links, and θ̃ for motors that shall make the springs give u_R.
fn springs_by_position<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    course: &Course<N>,
    q_ld: &Series<5, N>,
    lambda: &Vector<f64, N>,
    gamma: &Vector<f64, N>,
) -> (Series<3, N>, Series<3, N>) {
    let [q, v, _, q_d, v_d, a_d] = tracked(course, q_ld);
    let s = v - v_d + lambda.diag_mul(&(q - q_d));
    let (v_r, a_r) = (v - s, a_d - lambda.diag_mul(&(v - v_d)));
    let u_r = robot.links.inverse_dynamics(&q, &v, &v_r, &a_r) + robot.link_damping.diag_mul(&v_r)
        - gamma.diag_mul(&s);
    (s, course.q_m - q - robot.stiffness.map(f64::recip).diag_mul(&u_r))
}

fn esp<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::esp(r), r.series(1.0));
    let (_, course, size) = course(&robot, &law, &q_ld, r);
    let [q, v, _, q_d, v_d, a_d] = tracked(&course, &q_ld);
    let (e, rate) = (q - q_d, v - v_d);
    let n = robot.links.inverse_dynamics(&q, &v, &v_d, &a_d) + robot.link_damping.diag_mul(&v_d)
        - law.link_damping.diag_mul(&rate);
    let eta = course.q_m - q_d - robot.stiffness.map(f64::recip).diag_mul(&n);
    let short = |x: Series<3, N>| x.map(|x| x.truncate::<2>());
    let (eta, eta_rate) = (short(eta), eta.map(|x| x.differentiate::<2>()));
    let (e, rate) = (short(e), short(rate));
    let V = rate.dot(&robot.links.mass_mul(&short(q), &rate)).scale(0.5)
        + half_square(&robot.motor_inertia, &eta_rate)
        + half_square(&robot.stiffness, &(eta - e))
        + half_square(&law.motor.stiffness, &eta);
    let value = |x: &Series<2, N>| x.map(|x| x.coefficient(0));
    let loss = dissipation(&(robot.link_damping + law.link_damping), &value(&rate))
        + dissipation(&(robot.motor_damping + law.motor.damping), &value(&eta_rate));
    decays(V, loss, size + V.coefficient(0) * 100.0);
}

#[test]
fn pd_loses_energy_to_dampers() {
    on_three_robots!(pd, 11);
}

#[test]
fn gravity_at_the_motors_is_a_potential() {
    on_three_robots!(pd_online_gravity, 12);
}

#[test]
fn torque_feedback_stores_energy_in_the_shaped_motors() {
    on_three_robots!(torque_feedback, 13);
}

#[test]
fn passivity_decays_along_moving_references() {
    on_three_robots!(passivity, 14);
}

#[test]
fn gravity_cancellation_leaves_a_robot_without_gravity() {
    on_three_robots!(gravity_cancellation, 16);
}

#[test]
fn backstepping_decays_along_moving_references() {
    on_three_robots!(backstepping, 17);
}

#[test]
fn motors_of_the_cascade_are_second_order_whatever_the_links_do() {
    on_three_robots!(cascade, 18);
}

#[test]
fn esp_keeps_the_structure_and_loses_energy_to_dampers() {
    on_three_robots!(esp, 15);
}

/// The limit is the smaller eigenvalue of [[k, −k], [−k, k + k_P]].
#[test]
fn the_limit_of_tomei_is_an_eigenvalue() {
    let r = &mut Numbers(12);
    for _ in 0..20 {
        let robot = flexible(branched::<5>(2), r);
        let law = laws::pd(r);
        let limit = law.gravity_slope_limit(&robot);
        for i in 0..5 {
            let (k, k_p, x) = (robot.stiffness[i], law.motor.stiffness[i], limit[i]);
            assert!(((k - x) * (k + k_p - x) - k * k).abs() < 1e-12 * k * k && x < k);
        }
    }
}

/// Below the limit the storage is least at the goal; far above it is not.
#[test]
fn gravity_below_the_limit_leaves_one_rest() {
    let r = &mut Numbers(13);
    for _ in 0..20 {
        let mut robot = flexible(Pendulum { inertia: 0.1, weight_moment: 0.0 }, r);
        let law = laws::pd::<1>(r);
        let limit = law.gravity_slope_limit(&robot)[0];
        let mut margin = |weight: f64| {
            robot.links.weight_moment = weight;
            // Upright, where gravity pulls away from the goal.
            let goal = Vector([core::f64::consts::PI]);
            let store = |x: &Motion<f64, 1>| pd_storage(&robot, &law, x, &goal);
            let least = store(&Motion { q_m: held(&robot, &goal), ..Motion::at_rest(goal) });
            let places = (-30..=30).map(|i| 0.2 * f64::from(i)).filter(|q| q.abs() > 0.1);
            places
                .map(|q| {
                    // The motor where the storage is least for these links.
                    let (k, k_p) = (robot.stiffness[0], law.motor.stiffness[0]);
                    let q_m = goal[0] + k * q / (k + k_p);
                    let x = Motion { q_m: Vector([q_m]), ..Motion::at_rest(Vector([goal[0] + q])) };
                    store(&x) - least
                })
                .fold(f64::INFINITY, f64::min)
        };
        assert!(margin(0.999 * limit) > 0.0);
        assert!(margin(4.0 * limit) < 0.0);
    }
}
