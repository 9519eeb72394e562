//! Links only if the optimiser proves that law, dynamics, estimators, guard and arithmetic cannot panic:
//!
//! `RUSTFLAGS="--cfg link_check" cargo build -p flexure-core --profile no-panic --example no_panic`
//!
//! An "undefined symbol" at the end of the build names the function in which a panic is reachable.

use std::hint::black_box;

use flexure_core::contraction::{
    ClosedLoop, ErrorLoop, Root, generalised_jacobian, measure_1, measure_2, measure_2_margins,
};
use flexure_core::control::{
    Backstepping, Cascade, ControlLaw, CoupledTanh, Esp, FeedbackLinearization, FeedforwardPd,
    GravityCancellation, Input, IntegralManifold, Linear, Lqr, Mpc, Passivity, Pd, PdOnlineGravity,
    RigidVcbc, SingularPerturbation, TorqueFeedback, Vcbc,
};
use flexure_core::estimate::{
    Disturbance, DisturbanceObserver, Estimator, FilteredDifference, MotorObserver, Observer,
};
use flexure_core::guard::{Age, Coasting, Decision, Guard, Seen, Watchdog};
use flexure_core::linalg::Vector as V;
use flexure_core::memory::{Memory, Port, Unfit, restore, save};
use flexure_core::model::{FeedForward, Fjr, Links, Motion, RotorCoupling, State};
use flexure_core::robots::{PlanarTwoLink, Tree};
use flexure_core::scalar::{Jet, Scalar};
use flexure_core::virtual_system::virtual_dynamics;
#[cfg(link_check)]
use no_panic::no_panic;

type Law<const N: usize> = Vcbc<f64, CoupledTanh<f64, N>, CoupledTanh<f64, N>, N>;
type Arm = Fjr<f64, PlanarTwoLink<f64>, 2>;
/// Of up to seven joints: how many is known at run time.
type Chain = Fjr<f64, Tree<f64, 7>, 7>;

#[cfg_attr(link_check, no_panic)]
fn law_of_the_arm(robot: &Arm, law: &Law<2>, x: &Motion<f64, 2>, q_d: &V<Jet<f64, 5>, 2>) -> V<f64, 2> {
    law.command(robot, x, q_d, &Input::ZERO).u_m
}

#[cfg_attr(link_check, no_panic)]
fn law_of_a_tree(robot: &Chain, law: &Law<7>, x: &Motion<f64, 7>, q_d: &V<Jet<f64, 5>, 7>) -> V<f64, 7> {
    law.command(robot, x, q_d, &Input::ZERO).u_m
}

/// Defines a function that runs a law on a tree.
macro_rules! law_on_a_tree {
    ($($name:ident: $law:ty),+ $(,)?) => {$(
        #[cfg_attr(link_check, no_panic)]
        fn $name(robot: &Chain, law: &$law, x: &Motion<f64, 7>, q_d: &V<Jet<f64, 5>, 7>) -> V<f64, 7> {
            law.torque(robot, x, q_d)
        }
    )+};
}

law_on_a_tree!(
    backstepping: Backstepping<f64, 7>,
    cascade: Cascade<f64, 7>,
    esp: Esp<f64, 7>,
    feedback_linearization: FeedbackLinearization<f64, 7>,
    feedforward_pd: FeedforwardPd<f64, 7>,
    gravity_cancellation: GravityCancellation<f64, 7>,
    integral_manifold: IntegralManifold<f64, 7>,
    lqr: Lqr<f64, 7>,
    mpc: Mpc<f64, 7, 10>,
    passivity: Passivity<f64, 7>,
    pd: Pd<f64, 7>,
    pd_online_gravity: PdOnlineGravity<f64, 7>,
    rigid: RigidVcbc<f64, Linear<f64, 7>, 7>,
    singular_perturbation: SingularPerturbation<f64, 7>,
    torque_feedback: TorqueFeedback<f64, 7>,
);

#[cfg_attr(link_check, no_panic)]
fn dynamics(robot: &Chain, x: &State<f64, 7>, u_m: &V<f64, 7>) -> [State<f64, 7>; 2] {
    let plant = robot.hamiltonian_dynamics(x, u_m);
    [plant, virtual_dynamics(robot, x, &robot.motion(x), u_m)]
}

#[cfg_attr(link_check, no_panic)]
fn inverse_dynamics(robot: &Chain, q_l: &V<Jet<f64, 7>, 7>) -> FeedForward<f64, 7, 3, 5> {
    robot.inverse_dynamics(q_l)
}

#[cfg_attr(link_check, no_panic)]
fn torque_along(robot: &Chain, derivatives: &[V<f64, 7>; 5]) -> [V<f64, 7>; 3] {
    robot.links.torque_along(&V::from_derivatives(derivatives)).derivatives()
}

#[cfg_attr(link_check, no_panic)]
fn forward_dynamics(robot: &Chain, q: &V<f64, 7>, v: &V<f64, 7>, torque: &V<f64, 7>) -> V<f64, 7> {
    robot.links.forward_dynamics(q, v, torque)
}

#[cfg_attr(link_check, no_panic)]
fn factor_and_solve(robot: &Chain, q: &V<f64, 7>, b: &V<f64, 7>) -> V<f64, 7> {
    robot.links.mass_matrix(q).ldl().solve(b)
}

#[cfg_attr(link_check, no_panic)]
fn rotors(
    coupling: &RotorCoupling<f64, 7>,
    robot: &Chain,
    x: &Motion<f64, 7>,
    a: &V<f64, 7>,
) -> [V<f64, 7>; 2] {
    [coupling.link_torque(&robot.links, x, a), coupling.motor_torque(&robot.links, x, a)]
}

/// Encoder readings in rad and the torque that was applied [N m].
type Read = [V<f64, 7>; 3];

#[cfg_attr(link_check, no_panic)]
fn difference(
    estimator: &mut FilteredDifference<f64, 7>,
    robot: &Chain,
    [q_l, q_m, u]: &Read,
) -> Motion<f64, 7> {
    estimator.update(robot, q_l, q_m, u)
}

#[cfg_attr(link_check, no_panic)]
fn observer(estimator: &mut Observer<f64, 7>, robot: &Chain, [q_l, q_m, u]: &Read) -> Motion<f64, 7> {
    estimator.update(robot, q_l, q_m, u)
}

#[cfg_attr(link_check, no_panic)]
fn motor_observer(
    estimator: &mut MotorObserver<f64, 7>,
    robot: &Chain,
    [q_l, q_m, u]: &Read,
) -> Motion<f64, 7> {
    estimator.update(robot, q_l, q_m, u)
}

#[cfg_attr(link_check, no_panic)]
fn disturbance(
    observer: &mut DisturbanceObserver<f64, 7>,
    robot: &Chain,
    x: &Motion<f64, 7>,
    u: &V<f64, 7>,
) -> Disturbance<f64, 7> {
    observer.update(robot, x, u)
}

#[cfg_attr(link_check, no_panic)]
fn guarded(guard: &mut Guard<f64, 7>, robot: &Chain, seen: &Seen<f64, 7>) -> Decision<f64, 7> {
    let law = |x: &Motion<f64, 7>| robot.link_torque(x);
    guard.step(seen, &mut (law, |q: &V<f64, 7>| robot.links.gravity_torque(q)))
}

#[cfg_attr(link_check, no_panic)]
fn coasting(
    coasting: &mut Coasting<f64, 7>,
    robot: &Chain,
    readings: &Motion<f64, 7>,
    age: Age,
    u: &V<f64, 7>,
) -> (Motion<f64, 7>, Age) {
    coasting.saw(readings);
    coasting.fill(robot, readings, age, [true; 2], u)
}

#[cfg_attr(link_check, no_panic)]
fn watched(watchdog: &mut Watchdog<f64, 7>, command: Option<V<f64, 7>>) -> V<f64, 7> {
    watchdog.step(command)
}

#[cfg_attr(link_check, no_panic)]
fn saved(observer: &mut Observer<f64, 7>, joints: usize, numbers: &mut [f64]) -> Result<(), Unfit> {
    save(observer, joints, numbers)
}

#[cfg_attr(link_check, no_panic)]
fn restored(observer: &mut Observer<f64, 7>, joints: usize, numbers: &[f64]) -> Result<(), Unfit> {
    restore(observer, joints, numbers)
}

/// Forgets everything.
struct Zeros;

impl Port<f64> for Zeros {
    fn numbers(&mut self, _: &'static str, _: &'static str, x: &mut [f64]) {
        x.fill(0.0);
    }
    fn joints(&mut self, _: &'static str, _: &'static str, x: &mut [f64]) {
        x.fill(0.0);
    }
    fn word(&mut self, _: &'static str, x: &mut u32) {
        *x = 0;
    }
    fn flag(&mut self, _: &'static str, x: &mut bool) {
        *x = false;
    }
}

#[cfg_attr(link_check, no_panic)]
fn guard_forgets(
    guard: &mut Guard<f64, 7>,
    coasting: &mut Coasting<f64, 7>,
    watchdog: &mut Watchdog<f64, 7>,
) {
    guard.memory(&mut Zeros);
    guard.reset();
    coasting.memory(&mut Zeros);
    watchdog.memory(&mut Zeros);
}

#[cfg_attr(link_check, no_panic)]
fn estimators_forget(
    difference: &mut FilteredDifference<f64, 7>,
    motor: &mut MotorObserver<f64, 7>,
    disturbance: &mut DisturbanceObserver<f64, 7>,
) {
    difference.memory(&mut Zeros);
    motor.memory(&mut Zeros);
    disturbance.memory(&mut Zeros);
}

#[cfg_attr(link_check, no_panic)]
fn measures(
    system: ErrorLoop<f64, PlanarTwoLink<f64>, CoupledTanh<f64, 2>, CoupledTanh<f64, 2>, 2>,
) -> [f64; 3] {
    let closed: ClosedLoop<_, _, 4> = ClosedLoop { system, feedback: V([0.0; 4]) };
    let jacobian = generalised_jacobian::<f64, f64, 8>(&closed, &Root(system), &V([0.1; 8]), 0.0);
    [measure_1(&jacobian), measure_2(&jacobian), measure_2_margins(&jacobian, 0.0)[7]]
}

#[cfg_attr(link_check, no_panic)]
fn jets(x: Jet<f64, 5>) -> Jet<f64, 5> {
    (x.sin() * x.exp() + x.tanh() / x.ln()).sqrt().atan().ln_cosh().square()
}

fn main() {
    // The functions are linked in without being called on a made-up robot.
    black_box((
        law_of_the_arm as fn(&_, &_, &_, &_) -> _,
        law_of_a_tree as fn(&_, &_, &_, &_) -> _,
        dynamics as fn(&_, &_, &_) -> _,
        inverse_dynamics as fn(&_, &_) -> _,
        torque_along as fn(&_, &_) -> _,
        forward_dynamics as fn(&_, &_, &_, &_) -> _,
        factor_and_solve as fn(&_, &_, &_) -> _,
        rotors as fn(&_, &_, &_, &_) -> _,
    ));
    black_box((
        difference as fn(&mut _, &_, &_) -> _,
        observer as fn(&mut _, &_, &_) -> _,
        motor_observer as fn(&mut _, &_, &_) -> _,
        disturbance as fn(&mut _, &_, &_, &_) -> _,
        guarded as fn(&mut _, &_, &_) -> _,
        coasting as fn(&mut _, &_, &_, _, &_) -> _,
        watched as fn(&mut _, _) -> _,
        saved as fn(&mut _, _, &mut _) -> _,
        restored as fn(&mut _, _, &_) -> _,
        guard_forgets as fn(&mut _, &mut _, &mut _),
        estimators_forget as fn(&mut _, &mut _, &mut _),
    ));
    black_box((
        backstepping as fn(&_, &_, &_, &_) -> _,
        cascade as fn(&_, &_, &_, &_) -> _,
        esp as fn(&_, &_, &_, &_) -> _,
        feedback_linearization as fn(&_, &_, &_, &_) -> _,
        feedforward_pd as fn(&_, &_, &_, &_) -> _,
        gravity_cancellation as fn(&_, &_, &_, &_) -> _,
    ));
    black_box((
        integral_manifold as fn(&_, &_, &_, &_) -> _,
        lqr as fn(&_, &_, &_, &_) -> _,
        mpc as fn(&_, &_, &_, &_) -> _,
        passivity as fn(&_, &_, &_, &_) -> _,
        pd as fn(&_, &_, &_, &_) -> _,
        pd_online_gravity as fn(&_, &_, &_, &_) -> _,
        rigid as fn(&_, &_, &_, &_) -> _,
        singular_perturbation as fn(&_, &_, &_, &_) -> _,
        torque_feedback as fn(&_, &_, &_, &_) -> _,
    ));
    black_box(measures as fn(_) -> _);
    assert!(jets(black_box(Jet::variable(0.5))).coefficient(4).is_finite());
}
