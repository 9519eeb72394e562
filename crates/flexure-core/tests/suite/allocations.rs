//! Law, dynamics, references, estimators and guards allocate nothing.

use assert_no_alloc::{AllocDisabler, assert_no_alloc, violation_count};
use flexure_core::control::{ControlLaw, Input, Lqr, Mpc, QuadraticCost, RigidVcbc};
use flexure_core::estimate::{
    DisturbanceObserver, Estimator, FilteredDifference, LowPass, MotorObserver, Observer,
};
use flexure_core::guard::{Age, Coasting, Guard, Seen, Settings, Watchdog};
use flexure_core::linalg::Vector;
use flexure_core::memory::{restore, save};
use flexure_core::model::{FeedForward, LinkMatrices, Links, MassFactor, Motion};
use flexure_core::reference::{
    Clock, Multisine, PointToPoint, Reference, Retimed, Sine, SmoothStart, Smoothstep, Term,
};
use flexure_core::robots::Tree;
use flexure_core::scalar::{Jet, Scalar};
use flexure_core::virtual_system::{Structure, closed_loop, error_coordinates, virtual_dynamics};

use crate::common::{Numbers, branched, coupled_tanh, flexible, gains, planar, random_error};

#[global_allocator]
static COUNTER: AllocDisabler = AllocDisabler;

/// Allocations and releases on this thread while `f` runs.
fn allocations<R>(f: impl FnOnce() -> R) -> u32 {
    let before = violation_count();
    let result = assert_no_alloc(f);
    let count = violation_count() - before;
    drop(result);
    count
}

fn law_and_dynamics_allocate_nothing<L: Links<f64, N>, const N: usize>(links: L) {
    let mut r = Numbers(1);
    let robot = flexible(links, &mut r);
    let law = gains(coupled_tanh, true, &mut r);
    let (x, x_v, error) = (r.motion(1.5), r.motion(1.5), random_error(&mut r));
    let q_l = r.series::<7, N>(1.0);
    let omega = Input { link: r.series(1.0), motor: r.vector(1.0) };
    let count = allocations(|| {
        let reference = Vector([Jet::variable(0.3).sin(); N]);
        let command = law.command(&robot, &x, &reference, &omega);
        let virtual_command = law.virtual_command(&robot, &x_v, &x, &reference, &omega);
        let rigid = RigidVcbc { link: law.link }.command(
            &robot.links,
            &robot.link_damping,
            &x.q_l,
            &x.v_l,
            &reference.map(|x| x.truncate()),
            &omega.motor,
        );
        (command, virtual_command, rigid)
    });
    assert_eq!(count, 0, "law");
    let count = allocations(|| {
        let state = robot.state(&x);
        let dynamics = robot.hamiltonian_dynamics(&state, &omega.motor);
        let a = robot.link_acceleration(&x);
        let torques = robot.links.torque_along::<_, 3, 5>(&q_l.map(|x| x.truncate())).derivatives();
        let feed_forward: FeedForward<f64, N, 3, 5> = robot.inverse_dynamics(&q_l);
        let (factor, matrices) =
            (robot.links.factor(&x.q_l), LinkMatrices::new(&robot.links, &x.q_l, &x.v_l));
        let dense = robot.links.mass_matrix(&x.q_l).ldl().solve(&a);
        ((dynamics, a, torques, feed_forward), (factor.solve(&a), matrices, dense))
    });
    assert_eq!(count, 0, "dynamics");
    let count = allocations(|| {
        let (state, reference) = (robot.state(&x_v), Vector([Jet::variable(0.3).sin(); N]));
        let dynamics = virtual_dynamics(&robot, &state, &x, &omega.motor);
        let coordinates = error_coordinates(&robot, &law, &state, &x, &reference, &omega);
        let rate = closed_loop(&robot, &law, &error, &x, &omega);
        (dynamics, coordinates, rate, Structure::new(&robot, &law, &error, &x))
    });
    assert_eq!(count, 0, "virtual system");
}

#[test]
fn planar_arm() {
    law_and_dynamics_allocate_nothing(planar());
}

#[test]
fn branched_tree() {
    law_and_dynamics_allocate_nothing(branched::<7>(2));
}

#[test]
fn tree_with_room() {
    let bodies = crate::common::branched_bodies::<5>(2);
    let roomy: Tree<f64, 8> = Tree::from_bodies(&bodies, crate::common::GRAVITY, |x| x).expect("they fit");
    law_and_dynamics_allocate_nothing(roomy);
}

#[test]
fn estimators_and_guard() {
    let mut r = Numbers(3);
    let robot = flexible(branched::<7>(2), &mut r);
    let (x, u) = (r.motion::<7>(0.5), r.vector::<7>(1.0));
    let (one, period) = (Vector([1.0; 7]), 1e-3);
    let count = allocations(|| {
        let mut difference = FilteredDifference::new(LowPass::second_order(40.0, 0.9, period)?);
        let mut both = Observer::new(&one, period)?;
        let mut motor = MotorObserver::new(&one, period)?;
        let mut disturbance = DisturbanceObserver::new(&one, period)?;
        let mut guard = Guard::new(Settings {
            torque_limit: one,
            torque_rate_limit: one,
            stop_damping: one,
            ..Settings::open(period)
        })?;
        difference.start(&x);
        both.start(&x);
        motor.start(&x);
        let estimates = [
            difference.update(&robot, &x.q_l, &x.q_m, &u),
            both.update(&robot, &x.q_l, &x.q_m, &u),
            motor.update(&robot, &x.q_l, &x.q_m, &u),
        ];
        let found = [disturbance.update(&robot, &x, &u), disturbance.update(&robot, &x, &u)];
        let mut numbers = [0.0; 4 * 7];
        let memory = (save(&mut both, 7, &mut numbers), restore(&mut both, 7, &numbers));
        let decisions = [0, 1].map(|age| {
            let seen = Seen { age: Age { link: age, motor: 0 }, ..Seen::fresh(&x) };
            guard.step(&seen, &mut (|_: &Motion<f64, 7>| u, |_: &Vector<f64, 7>| u))
        });
        let mut coasting = Coasting::new(3, period)?;
        coasting.saw(&x);
        let filled = coasting.fill(&robot, &x, Age { link: 1, motor: 0 }, [true; 2], &u);
        let given = Watchdog::new(1, one)?.step(Some(u));
        Some((estimates, found, memory, decisions, filled, given))
    });
    assert_eq!(count, 0);
}

#[test]
fn references() {
    let one = Vector([1.0; 3]);
    let sine = Sine { amplitude: one, frequency: one, ..Sine::ZERO };
    let term = Term { amplitude: one, frequency: one, phase: one };
    let multisine = Multisine { offset: one, terms: [term; 5] };
    let start = Retimed {
        clock: Clock::FromRest { speed: 0.5, rise: 1.0 },
        path: SmoothStart::from_rest(one, 2.0, sine),
    };
    let steps = [Smoothstep::Quintic, Smoothstep::Septic, Smoothstep::Nonic];
    let count = allocations(|| {
        let steps = steps
            .map(|step| PointToPoint { from: one, to: one, start: 0.0, duration: 1.0, step }.at::<5>(0.5));
        (one.at::<5>(0.5), sine.at::<5>(0.5), multisine.at::<5>(0.5), start.at::<5>(0.5), steps)
    });
    assert_eq!(count, 0);
}

#[test]
fn optimal_laws() {
    let mut r = Numbers(4);
    let robot = flexible(branched::<5>(2), &mut r);
    let one = Vector([1.0; 5]);
    let cost = QuadraticCost { state: [one; 4], torque: one };
    let (x, q_ld) = (r.motion(1.0), r.series(1.0));
    let count = allocations(|| {
        let lqr = Lqr::design(&robot, &one, &cost, &Vector([f64::INFINITY; _])).ok()?;
        let mpc = Mpc::<f64, 5, 10>::design(&robot, &one, &cost, 1e-3, &one).ok()?;
        Some((lqr.torque(&robot, &x, &q_ld), mpc.torque(&robot, &x, &q_ld)))
    });
    assert_eq!(count, 0);
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| Box::new(std::hint::black_box(1.0))), 1);
}
