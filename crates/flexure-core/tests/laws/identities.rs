//! The identity that each law is proved by, at random states of an arm in closed form, a branched tree and a serial arm of seven joints: storage functions by
//! Taylor series of the closed loop, error equations by dual numbers.

use flexure_core::control::{
    Applied, ControlByInterconnection, ControlLaw, DisturbanceRejecting, DynamicFeedbackLinearization,
    DynamicLaw, IdaPbc, ImmersionInvariance, InnerLoop, LinkImpedance, LinkPositionFeedback, LoriaOrtega,
    MotorObserverPd, MotorPd, MotorPositionPd, MotorPositionPdCapped, PositionFeedback, SlidingMode,
    in_series, observer_gains,
};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, MassFactor, Motion};
use flexure_core::scalar::{Dual, Jet, Over, Scalar as _};

use crate::common::laws::{Course, motor, resting};
use crate::common::{Numbers, branched, flexible, moving_motion, planar, rate, serial, shifting};
use crate::coupled_rotors::accelerations;

/// Of the largest term: a few hundred operations, each to 10⁻¹⁶, on what cancels.
const ROUNDING: f64 = 1e-12;

/// Ten times on each of three robots.
macro_rules! everywhere {
    ($check:path) => {{
        let r = &mut Numbers(5);
        for _ in 0..10 {
            $check(planar, r);
            $check(|| branched::<5>(2), r);
            $check(serial::<7>, r);
        }
    }};
}

#[test]
fn motor_position_pd() {
    everywhere!(checks::motor_position_pd);
}

#[test]
fn motor_position_pd_capped() {
    everywhere!(checks::motor_position_pd_capped);
}

#[test]
fn motor_observer_pd() {
    everywhere!(checks::motor_observer_pd);
}

#[test]
fn control_by_interconnection() {
    everywhere!(checks::control_by_interconnection);
}

#[test]
fn ida_pbc() {
    everywhere!(checks::ida_pbc);
}

#[test]
fn link_impedance() {
    everywhere!(checks::link_impedance);
}

#[test]
fn loria_ortega() {
    everywhere!(checks::loria_ortega);
}

#[test]
fn position_feedback() {
    everywhere!(checks::position_feedback);
}

#[test]
fn link_position_feedback() {
    everywhere!(checks::link_position_feedback);
}

#[test]
fn immersion_invariance() {
    everywhere!(checks::immersion_invariance);
}

#[test]
fn disturbance_rejecting() {
    everywhere!(checks::disturbance_rejecting);
}

#[test]
fn sliding_mode() {
    everywhere!(checks::sliding_mode);
}

/// Σ d/dt of the terms is `rate`, to rounding of the largest.
fn adds_up(terms: &[Jet<f64, 2>], rate: f64) {
    let rates = terms.iter().map(|term| term.coefficient(1));
    let scale = rates.clone().fold(rate.abs(), |m, x| m.max(x.abs()));
    let sum: f64 = rates.sum();
    assert!((sum - rate).abs() <= ROUNDING * scale, "{sum} against {rate}, largest term {scale}");
}

/// Two vectors agree to rounding of `scale`, the largest number on the way.
fn agree<const N: usize>(a: &Vector<f64, N>, b: &Vector<f64, N>, scale: f64) {
    let scale = a.iter().chain(b.iter()).fold(scale, |m: f64, x| m.max(x.abs()));
    for (x, y) in a.iter().zip(b.iter()) {
        assert!((x - y).abs() <= ROUNDING * scale, "{a:?} against {b:?}, scale {scale}");
    }
}

fn largest<const N: usize>(parts: &[Vector<f64, N>]) -> f64 {
    parts.iter().flat_map(Vector::iter).fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn half<T: Over<f64>, const N: usize>(weight: &Vector<f64, N>, x: &Vector<T, N>) -> T {
    x.dot(&weight.diag_mul(x)).scale(0.5)
}

fn power<const N: usize>(weight: &Vector<f64, N>, v: &Vector<f64, N>) -> f64 {
    v.dot(&weight.diag_mul(v))
}

fn ratio<const N: usize>(a: &Vector<f64, N>, b: &Vector<f64, N>) -> Vector<f64, N> {
    Vector::from_fn(|i| a[i] / b[i])
}

/// A closed loop with memory from a random state on.
struct Loop<const N: usize, const K: usize> {
    x: Motion<f64, N>,
    z: [Vector<f64, N>; K],
    u_m: Vector<f64, N>,
    course: Course<N>,
    /// The memory to order 1.
    memory: [Vector<Jet<f64, 2>, N>; K],
}

impl<const N: usize, const K: usize> Loop<N, K> {
    /// From a random motion, the memory off its start by as much as `off`.
    fn new<L: Links<f64, N>>(
        robot: &Fjr<f64, L, N>,
        law: &impl DynamicLaw<f64, N, K>,
        q_ld: &Vector<Jet<f64, 5>, N>,
        off: f64,
        r: &mut Numbers,
    ) -> Self {
        let x = r.motion(1.0);
        let start = law.start(robot, &x, q_ld);
        let z = start.map(|part| part + r.vector(off));
        let u_m = law.torque(robot, &x, q_ld, &z);
        let rate = law.rate(robot, &x, q_ld, &z, &Applied::fully(u_m));
        let memory = core::array::from_fn(|k| Vector::from_fn(|i| Jet::new([z[k][i], rate[k][i]])));
        Self { x, z, u_m, course: Course::new(robot, &x, &u_m), memory }
    }

    fn along(&self) -> Motion<Jet<f64, 2>, N> {
        self.course.motion()
    }
}

/// Kinetic energies of links and motors, of springs and of gravity, apart.
fn energies<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    motor_inertia: &Vector<f64, N>,
    x: &Motion<Jet<f64, 2>, N>,
) -> [Jet<f64, 2>; 4] {
    [
        x.v_l.dot(&robot.links.mass_mul(&x.q_l, &x.v_l)).scale(0.5),
        half(motor_inertia, &x.v_m),
        half(&robot.stiffness, &x.deflection()),
        robot.links.potential_energy(&x.q_l),
    ]
}

/// Where motors rest that hold the links at `q`.
fn held<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, q: &Vector<f64, N>) -> Vector<f64, N> {
    robot.motors_at_rest(q)
}

/// What all regulators on the springs and the goal store: energies, ½ e_mᵀ K_P e_m of a position, −θᵀ g(q_0) of the same.
fn goal_terms<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    stiffness: &Vector<f64, N>,
    theta: &Vector<Jet<f64, 2>, N>,
    goal: &Vector<f64, N>,
) -> [Jet<f64, 2>; 2] {
    let gravity = robot.links.gravity_torque(goal);
    [half(stiffness, &(*theta - held(robot, goal).lift())), -theta.dot(&gravity.lift())]
}

fn value<const K: usize, const N: usize>(x: &Vector<Jet<f64, K>, N>) -> Vector<f64, N> {
    x.map(|x| x.coefficient(0))
}

fn first<const K: usize, const N: usize>(x: &Vector<Jet<f64, K>, N>) -> Vector<f64, N> {
    x.map(|x| x.derivative(1))
}

fn natural<L, const N: usize>(robot: &Fjr<f64, L, N>, x: &Motion<f64, N>) -> f64 {
    power(&robot.link_damping, &x.v_l) + power(&robot.motor_damping, &x.v_m)
}

pub mod checks {
    use super::*;

    pub fn motor_position_pd<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, goal) = (flexible(links(), r), r.vector(1.0));
        let law = MotorPositionPd { motor: motor(r), cutoff: r.between(10.0, 60.0) };
        let closed = Loop::new(&robot, &law, &resting(&goal), 0.3, r);
        let along = closed.along();
        let error = along.q_m - held(&robot, &goal).lift();
        let slope = law.cutoff.diag_mul(&(error - closed.memory[0]));
        let [a, b, c, d] = energies(&robot, &robot.motor_inertia, &along);
        let [e, f] = goal_terms(&robot, &law.motor.stiffness, &along.q_m, &goal);
        let g = half(&ratio(&law.motor.damping, &law.cutoff), &slope);
        adds_up(
            &[a, b, c, d, e, f, g],
            -natural(&robot, &closed.x) - power(&law.motor.damping, &value(&slope)),
        );
    }

    pub fn motor_position_pd_capped<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, goal) = (flexible(links(), r), r.vector(1.0));
        let law = MotorPositionPdCapped {
            motor: motor(r),
            cutoff: r.between(10.0, 60.0),
            stiffness_cap: r.between(2.0, 10.0),
            damping_cap: r.between(2.0, 10.0),
        };
        let closed = Loop::new(&robot, &law, &resting(&goal), 0.3, r);
        let along = closed.along();
        let error = along.q_m - held(&robot, &goal).lift();
        let slope = law.cutoff.diag_mul(&(error - closed.memory[0]));
        // (T²/k) ln cosh(k y/T) over `rate`.
        let capped =
            |k: &Vector<f64, N>, cap: &Vector<f64, N>, rate: &Vector<f64, N>, y: &Vector<Jet<f64, 2>, N>| {
                (0..N).fold(Jet::ZERO, |sum, i| {
                    let potential = y[i].scale(k[i] / cap[i]).ln_cosh();
                    sum + potential.scale(cap[i] * cap[i] / (k[i] * rate[i]))
                })
            };
        let one = Vector([1.0; N]);
        let [a, b, c, d] = energies(&robot, &robot.motor_inertia, &along);
        let [_, f] = goal_terms(&robot, &one, &along.q_m, &goal);
        let e = capped(&law.motor.stiffness, &law.stiffness_cap, &one, &error);
        let g = capped(&law.motor.damping, &law.damping_cap, &law.cutoff, &slope);
        let brake: f64 = (0..N)
            .map(|i| {
                let (y, k, cap) = (slope[i].coefficient(0), law.motor.damping[i], law.damping_cap[i]);
                y * cap * (k * y / cap).tanh()
            })
            .sum();
        adds_up(&[a, b, c, d, e, f, g], -natural(&robot, &closed.x) - brake);
    }

    pub fn motor_observer_pd<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, goal) = (flexible(links(), r), r.vector(1.0));
        let law = MotorObserverPd {
            stiffness: r.between(20.0, 80.0),
            inertia: r.between(0.01, 0.1),
            damping: r.between(1.0, 10.0),
            coupling: r.between(20.0, 200.0),
        };
        let closed = Loop::new(&robot, &law, &resting(&goal), 0.3, r);
        let (along, [x_c, v_c]) = (closed.along(), closed.memory);
        let [a, b, c, d] = energies(&robot, &robot.motor_inertia, &along);
        let [e, f] = goal_terms(&robot, &law.stiffness, &along.q_m, &goal);
        let error = along.q_m - held(&robot, &goal).lift();
        let copy = [half(&law.inertia, &v_c), half(&law.coupling, &(error - x_c))];
        adds_up(
            &[a, b, c, d, e, f, copy[0], copy[1]],
            -natural(&robot, &closed.x) - power(&law.damping, &closed.z[1]),
        );
    }

    pub fn control_by_interconnection<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, goal) = (flexible(links(), r), r.vector(1.0));
        let law = ControlByInterconnection {
            stiffness: r.between(20.0, 80.0),
            elastic: r.between(20.0, 200.0),
            viscous: r.between(1.0, 10.0),
        };
        let closed = Loop::new(&robot, &law, &resting(&goal), 0.3, r);
        let (along, [x_1, x_2]) = (closed.along(), closed.memory);
        let [a, b, c, d] = energies(&robot, &robot.motor_inertia, &along);
        let [e, f] = goal_terms(&robot, &law.stiffness, &x_1, &goal);
        let through = law.elastic.diag_mul(&closed.z[1]);
        adds_up(
            &[a, b, c, d, e, f, half(&law.elastic, &x_2)],
            -natural(&robot, &closed.x) - power(&law.viscous.map(f64::recip), &through),
        );
        // The Casimir x_1 − θ.
        assert_eq!(first(&x_1), first(&along.q_m));
    }

    pub fn ida_pbc<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, goal) = (flexible(links(), r), r.vector(1.0));
        let law = IdaPbc { inertia: r.between(0.05, 0.3), motor: motor(r), cross: r.between(0.1, 1.0) };
        let x = r.motion(1.0);
        let course = Course::new(&robot, &x, &law.torque(&robot, &x, &resting(&goal)));
        let along = course.motion();
        let [a, b, c, d] = energies(&robot, &law.inertia, &along);
        let [e, f] = goal_terms(&robot, &law.motor.stiffness, &along.q_m, &goal);
        let cross = Vector::from_fn(|i| law.cross[i] * law.inertia[i] / robot.motor_inertia[i]);
        let lost = power(&robot.link_damping, &x.v_l)
            + 2.0 * x.v_l.dot(&cross.diag_mul(&x.v_m))
            + power(&law.motor.damping, &x.v_m);
        adds_up(&[a, b, c, d, e, f], -lost);
        // Where the margin is not below 0 the power is not either.
        if law.damping_margin(&robot).iter().all(|margin| margin >= 0.0) {
            assert!(lost >= 0.0);
        }
    }

    pub fn link_impedance<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let mut robot = flexible(links(), r);
        // Stiffer than gravity by enough for the fixed point of the links at rest to have ended.
        robot.stiffness = robot.stiffness.scaled(20.0);
        let goal = r.vector(1.0);
        let stiffness = robot.stiffness.map(|k| in_series(k, 0.3 * k));
        let law = LinkImpedance { inertia: r.between(0.05, 0.3), motor: MotorPd { stiffness, ..motor(r) } };
        let x = r.motion(1.0);
        let course = Course::new(&robot, &x, &law.torque(&robot, &x, &resting(&goal)));
        let along = course.motion();
        let [a, b, c, d] = energies(&robot, &law.inertia, &along);
        let q = robot.links_at_rest(&along.q_m);
        let gravity = robot.links.gravity_torque(&q);
        let e = -robot.links.potential_energy(&q) - half(&robot.stiffness.map(f64::recip), &gravity);
        let f = half(&law.motor.stiffness, &(q - goal.lift()));
        let damping = Vector::from_fn(|i| {
            law.motor.damping[i] + law.inertia[i] * robot.motor_damping[i] / robot.motor_inertia[i]
        });
        adds_up(&[a, b, c, d, e, f], -power(&robot.link_damping, &x.v_l) - power(&damping, &x.v_m));
    }

    pub fn loria_ortega<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld) = (flexible(links(), r), r.series::<5, N>(1.0));
        let law = LoriaOrtega { link: motor(r), motor: motor(r), cutoff: r.between(10.0, 60.0) };
        let closed = Loop::new(&robot, &law, &q_ld, 0.1, r);
        let (along, [z_l, z_m]) = (closed.along(), closed.memory);
        let q_d = q_ld.map(|q| q.truncate::<2>());
        let v_d = q_ld.map(|q| q.differentiate::<2>());
        let a_d = q_ld.map(|q| q.differentiate_twice::<2>());
        let e = along.q_l - q_d;
        let slope = law.cutoff.diag_mul(&(e - z_l));
        let wanted = robot.links.inverse_dynamics(&along.q_l, &v_d, &v_d, &a_d)
            + robot.link_damping.diag_mul(&v_d)
            + law.link.feedback(&e, &slope);
        // θ_d to order 2, of which order 2 comes from the derivative of order 1 along the loop.
        let theta_d = q_d + robot.stiffness.map(f64::recip).diag_mul(&wanted);
        let e_m = along.q_m - theta_d;
        let slope_m = law.cutoff.diag_mul(&(e_m - z_m));
        let de = along.v_l - v_d;
        // ė_m to order 1: θ̇ is known to order 1, θ̇_d from the law's own series.
        let rate_d = wanted_rate(&robot, &law, &closed, &q_ld);
        let de_m = along.v_m - rate_d;
        let terms = [
            de.dot(&robot.links.mass_mul(&along.q_l, &de)).scale(0.5),
            half(&robot.motor_inertia, &de_m),
            half(&robot.stiffness, &(e_m - e)),
            half(&law.link.stiffness, &e),
            half(&law.motor.stiffness, &e_m),
            half(&ratio(&law.link.damping, &law.cutoff), &slope),
            half(&ratio(&law.motor.damping, &law.cutoff), &slope_m),
        ];
        let (de, v_d) = (value(&de), value(&v_d));
        let curved = robot.links.inertial_torque(&closed.x.q_l, &de, &v_d, &Vector::ZERO);
        adds_up(
            &terms,
            -power(&robot.link_damping, &de)
                - power(&robot.motor_damping, &value(&de_m))
                - power(&law.link.damping, &value(&slope))
                - power(&law.motor.damping, &value(&slope_m))
                - de.dot(&curved),
        );
    }

    /// θ̇_d of Loría and Ortega's law along the loop, to order 1.
    fn wanted_rate<L: Links<f64, N>, const N: usize>(
        robot: &Fjr<f64, L, N>,
        law: &LoriaOrtega<f64, N>,
        closed: &Loop<N, 2>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> Vector<Jet<f64, 2>, N> {
        // The filter's own equation, along the true motion of the links to order 2.
        let q = closed.course.q_l.map(|q| q.truncate::<3>());
        let q_d = q_ld.map(|q| q.truncate::<3>());
        let [e, de, dde] = (q - q_d).derivatives();
        let a = &law.cutoff;
        let slope = a.diag_mul(&(e - closed.z[0]));
        let slope_1 = a.diag_mul(&(de - slope));
        let slope_2 = a.diag_mul(&(dde - slope_1));
        let slope = Vector::from_derivatives(&[slope, slope_1, slope_2]);
        let (v_d, a_d) = (q_ld.map(|q| q.differentiate::<3>()), q_ld.map(|q| q.differentiate_twice::<3>()));
        let wanted = robot.links.inverse_dynamics(&q, &v_d, &v_d, &a_d)
            + robot.link_damping.diag_mul(&v_d)
            + law.link.feedback(&(q - q_d), &slope);
        let theta_d = q_d + robot.stiffness.map(f64::recip).diag_mul(&wanted);
        theta_d.map(|theta| theta.differentiate())
    }

    pub fn position_feedback<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld) = (flexible(links(), r), r.series::<5, N>(1.0));
        let law = PositionFeedback {
            link: motor(r),
            link_cutoff: r.between(20.0, 60.0),
            motor: motor(r),
            motor_cutoff: r.between(10.0, 60.0),
        };
        let closed = Loop::new(&robot, &law, &q_ld, 0.1, r);
        let [f, df, ddf, z_m] = closed.z;
        let third = closed.memory[2].map(|x| x.derivative(1));
        // θ_d from the filter's derivatives.
        let nominal = robot.inverse_dynamics::<_, 1, 3, 5>(&q_ld).q_m;
        let compliance = robot.stiffness.map(f64::recip);
        let filtered = Vector::from_derivatives(&[
            compliance.diag_mul(&law.link.feedback(&f, &df)),
            compliance.diag_mul(&law.link.feedback(&df, &ddf)),
            compliance.diag_mul(&law.link.feedback(&ddf, &third)),
        ]);
        let error = closed.course.q_m - nominal - filtered;
        let [e_m, de_m, dde_m] = error.derivatives();
        let slope = law.motor_cutoff.diag_mul(&(e_m - z_m));
        let restoring = (robot.stiffness + law.motor.stiffness).diag_mul(&e_m)
            + robot.motor_damping.diag_mul(&de_m)
            + law.motor.damping.diag_mul(&slope);
        let scale = largest(&[closed.u_m]);
        agree(&robot.motor_inertia.diag_mul(&dde_m), &-restoring, scale);
    }

    fn immersion<const N: usize>(r: &mut Numbers) -> ImmersionInvariance<f64, N> {
        ImmersionInvariance {
            link: motor(r),
            inner: InnerLoop { position: r.between(20.0, 100.0), velocity: r.between(5.0, 20.0) },
        }
    }

    pub fn link_position_feedback<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld) = (flexible(links(), r), r.series::<5, N>(1.0));
        let joints: [[f64; 4]; N] =
            core::array::from_fn(|i| observer_gains(20.0, robot.motor_damping[i] / robot.motor_inertia[i]));
        let observer = core::array::from_fn(|k| Vector(joints.map(|joint| joint[k])));
        let law = LinkPositionFeedback { law: immersion(r), observer };
        let closed = Loop::new(&robot, &law, &q_ld, 0.5, r);
        let (x, [q, v, theta, w]) = (&closed.x, closed.z);
        let rates = closed.memory.map(|part| first(&part));
        let [l_1, l_2, l_3, l_4] = observer.map(|l| l.diag_mul(&(x.q_l - q)));
        let (dv, dtheta, dw) = (x.v_l - v, x.q_m - theta, x.v_m - w);
        let links = &robot.links;
        let mass = |a: &Vector<f64, N>| links.mass_mul(&x.q_l, a);
        let coriolis =
            |v: &Vector<f64, N>, v_r: &Vector<f64, N>| links.inertial_torque(&x.q_l, v, v_r, &Vector::ZERO);
        agree(&(x.v_l - rates[0]), &(dv - l_1), 1.0);
        let accelerations = robot.link_acceleration(x);
        let left = mass(&(accelerations - rates[1]))
            + coriolis(&x.v_l, &dv)
            + coriolis(&dv, &v)
            + robot.link_damping.diag_mul(&dv);
        let scale = largest(&[mass(&accelerations), mass(&rates[1])]);
        agree(&left, &(robot.stiffness.diag_mul(&dtheta) - mass(&l_2)), 10.0 * scale);
        let through = |l: &Vector<f64, N>| robot.stiffness.map(f64::recip).diag_mul(&mass(l));
        agree(&(x.v_m - rates[2]), &(dw - through(&l_3)), 1.0);
        let motors = robot.motor_acceleration(x, &closed.u_m) - rates[3];
        let left = robot.motor_inertia.diag_mul(&motors)
            + robot.motor_damping.diag_mul(&dw)
            + robot.stiffness.diag_mul(&dtheta);
        let scale = largest(&[closed.u_m]);
        agree(&left, &-robot.motor_inertia.diag_mul(&through(&l_4)), scale);
    }

    pub fn immersion_invariance<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld, law) = (flexible(links(), r), r.series::<5, N>(1.0), immersion(r));
        let x = r.motion(1.0);
        let u_m = law.torque(&robot, &x, &q_ld);
        let course = Course::new(&robot, &x, &u_m);
        // w along the loop to order 2, written from the mass matrix and C.
        let q = course.q_l.map(|q| q.truncate::<3>());
        let v = course.q_l.map(|q| q.differentiate::<3>());
        let (v_d, a_d) = (q_ld.map(|q| q.differentiate::<3>()), q_ld.map(|q| q.differentiate_twice::<3>()));
        let (e, de) = (q - q_ld.map(|q| q.truncate()), v - v_d);
        let wanted = robot.links.inertial_torque(&q, &v, &v_d, &a_d)
            + robot.links.gravity_torque(&q)
            + robot.link_damping.diag_mul(&v_d)
            + law.link.feedback(&e, &de);
        let manifold = q + robot.stiffness.map(f64::recip).diag_mul(&wanted);
        let [z, dz, ddz] = (course.q_m - manifold).derivatives();
        let [_, dpi, ddpi] = manifold.derivatives();
        let decay = law.inner.velocity.diag_mul(&dz) + law.inner.position.diag_mul(&z);
        let scale = largest(&[ddpi, dpi]);
        agree(&ddz, &-decay, 10.0 * scale);
        // On and off the manifold: the target's storage.
        let short = |x: Vector<Jet<f64, 3>, N>| x.map(|x| x.truncate::<2>());
        let (e, de, q) = (short(e), short(de), short(q));
        let terms = [de.dot(&robot.links.mass_mul(&q, &de)).scale(0.5), half(&law.link.stiffness, &e)];
        let rate = value(&de);
        adds_up(
            &terms,
            -power(&(robot.link_damping + law.link.damping), &rate) + rate.dot(&robot.stiffness.diag_mul(&z)),
        );
    }

    pub fn disturbance_rejecting<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld) = (flexible(links(), r), r.series::<5, N>(1.0));
        let law = DisturbanceRejecting { law: immersion(r), bandwidth: r.between(5.0, 30.0) };
        let x = r.motion(1.0);
        let sigma = law.start(&robot, &x, &q_ld).map(|part| part + r.vector(0.3));
        let u_m = law.torque(&robot, &x, &q_ld, &sigma);
        let rates = law.rate(&robot, &x, &q_ld, &sigma, &Applied::fully(u_m));
        // The robot under torques that the law does not know.
        let [d_l, d_m] = [r.vector::<N>(2.0), r.vector::<N>(2.0)];
        let a_l = robot.link_acceleration(&x) + robot.links.factor(&x.q_l).solve(&d_l);
        let a_m = robot.motor_acceleration(&x, &(u_m + d_m));
        let moving = moving_motion(&x, &Motion { q_l: x.v_l, q_m: x.v_m, v_l: a_l, v_m: a_m });
        let with_rate = |k: usize| Vector::from_fn(|i| Dual { value: sigma[k][i], gradient: [rates[k][i]] });
        let moved = law.residuals(&robot, &moving, &[with_rate(0), with_rate(1)]);
        let [r_l, r_m] = law.residuals(&robot, &x, &sigma);
        let momenta = robot.state(&moving);
        let scale = 30.0 * largest(&[rate(&momenta.p_l), rate(&momenta.p_m)]);
        agree(&rate(&moved[0]), &law.bandwidth.diag_mul(&(d_l - r_l)), scale);
        agree(&rate(&moved[1]), &law.bandwidth.diag_mul(&(d_m - r_m)), scale);
    }

    pub fn sliding_mode<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
        let (robot, q_ld) = (flexible(links(), r), r.series::<5, N>(1.0));
        let law = SlidingMode {
            surface: r.between(4.0, 10.0),
            reaching: r.between(5.0, 15.0),
            authority: r.between(100.0, 500.0),
            layer: r.between(1.0, 5.0),
        };
        let x = r.motion(1.0);
        let course = Course::new(&robot, &x, &law.torque(&robot, &x, &q_ld));
        let [e, de, dde, d3e, d4e] = (course.q_l - q_ld).derivatives();
        let surface = |k: i32, x: &Vector<f64, N>| law.surface.map(|l| l.powi(k)).diag_mul(x);
        let three = |x: Vector<f64, N>| x.scaled(3.0);
        let sigma = d3e + three(surface(1, &dde)) + three(surface(2, &de)) + surface(3, &e);
        let moves = d4e + three(surface(1, &d3e)) + three(surface(2, &dde)) + surface(3, &de);
        let held = Vector::from_fn(|i| {
            law.reaching[i] * sigma[i] + law.authority[i] * (sigma[i] / law.layer[i]).tanh()
        });
        let scale = largest(&[d4e, sigma]);
        agree(&moves, &-held, 1e3 * scale);
    }
}

/// With rotors coupled, what is planned is what happens: each derivative of the links is the rate of the one before, whatever the memory.
#[test]
fn dynamic_feedback_linearization() {
    let r = &mut Numbers(17);
    for _ in 0..10 {
        let (robot, q_ld) = (flexible(planar(), r), r.series::<8, 2>(1.0));
        let coupling = 0.01;
        let law = DynamicFeedbackLinearization { rate: Vector([4.0, 5.0]), coupling };
        let x = r.motion(1.0);
        let xi = [r.vector(1.0), r.vector(1.0)];
        let planned = law.planned(&robot, &x, &q_ld.map(|q| q.truncate()), &xi);
        let [a_l, a_m] = accelerations(&robot, coupling, &x, &planned.torque);
        let moving = moving_motion(&x, &Motion { q_l: x.v_l, q_m: x.v_m, v_l: a_l, v_m: a_m });
        let xi = core::array::from_fn(|k| {
            Vector::from_fn(|i| Dual { value: xi[k][i], gradient: [planned.rate[k][i]] })
        });
        let moved = law.planned(&robot, &moving, &shifting(&q_ld), &xi);
        for pair in moved.links.windows(2) {
            agree(&rate(&pair[0]), &pair[1].map(|q| q.value), largest(&planned.links));
        }
    }
}
