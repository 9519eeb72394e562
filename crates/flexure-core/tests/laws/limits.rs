//! Laws that are others at their limits, and torques at theirs.

use flexure_core::control::{
    Applied, ControlLaw, DynamicLaw, IdaPbc, MotorObserverPd, MotorPd, MotorPositionPd,
    MotorPositionPdCapped, Pid, Running, SeaCascade, TorqueFeedback,
};
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::Jet;

use crate::common::laws::{motor, resting};
use crate::common::plant::{Arm, Push, advance, plausible_arm};
use crate::common::{Numbers, branched, flexible, planar};

/// |u_i| ≤ |g_i(q_0)| + T_P + T_D at a thousand states as wild as any.
#[test]
fn the_capped_law_keeps_its_cap() {
    let r = &mut Numbers(1);
    for _ in 0..1000 {
        let (robot, goal) = (flexible(branched::<5>(2), r), r.vector(1.0));
        let law = MotorPositionPdCapped {
            motor: motor(r),
            cutoff: r.between(10.0, 60.0),
            stiffness_cap: r.between(2.0, 10.0),
            damping_cap: r.between(2.0, 10.0),
        };
        let (x, z) = (r.motion(100.0), [r.vector(100.0)]);
        let u = law.torque(&robot, &x, &resting(&goal), &z);
        let gravity = robot.links.gravity_torque(&goal);
        for i in 0..5 {
            // Rounding of the sum.
            let most = (gravity[i].abs() + law.stiffness_cap[i] + law.damping_cap[i]) * (1.0 + 1e-15);
            assert!(u[i].abs() <= most, "{} beyond {most}", u[i]);
        }
    }
}

/// As the copy of the motor loses its inertia, the observer becomes the filter with K_D = D_c and a = K_c/D_c, in proportion to B_c.
#[test]
fn a_light_copy_is_a_filter() {
    let r = &mut Numbers(2);
    let (robot, goal) = (flexible(planar(), r), resting(&r.vector::<2>(0.5)));
    let [stiffness, damping, coupling] =
        [r.between::<2>(20.0, 80.0), r.between(1.0, 4.0), r.between(40.0, 80.0)];
    let filter = MotorPositionPd {
        motor: MotorPd { stiffness, damping },
        cutoff: Vector::from_fn(|i| coupling[i] / damping[i]),
    };
    let period = 1e-3;
    let swinging = |k: u32| {
        let t = f64::from(k) * period;
        Motion::at_rest(Vector([(3.0 * t).sin(), (5.0 * t).cos()]))
    };
    let mut last = |inertia: f64| {
        let observer = MotorObserverPd { stiffness, inertia: Vector([inertia; 2]), damping, coupling };
        let x = swinging(0);
        let mut a = Running::start(&observer, &robot, &x, &goal);
        let mut b = Running::start(&filter, &robot, &x, &goal);
        for k in 1..=1000 {
            a.advance(&observer, &robot, &swinging(k), &goal, &Applied::NOTHING, period);
            b.advance(&filter, &robot, &swinging(k), &goal, &Applied::NOTHING, period);
        }
        let x = swinging(1000);
        let apart =
            observer.torque(&robot, &x, &goal, &a.memory) - filter.torque(&robot, &x, &goal, &b.memory);
        apart.dot(&apart).sqrt()
    };
    let apart = [1e-2, 1e-3, 1e-4].map(&mut last);
    for pair in apart.windows(2) {
        assert!((pair[0] / pair[1] - 10.0).abs() < 1.0, "{apart:?}");
    }
}

/// Without cross damping, gravity and dampers of motors the assigned interconnection is feedback of the spring torques.
#[test]
fn ida_pbc_without_cross_damping_is_torque_feedback() {
    let r = &mut Numbers(3);
    for _ in 0..10 {
        let mut robot = flexible(planar(), r);
        robot.motor_damping = Vector::ZERO;
        let (inertia, motor) = (r.between(0.05, 0.3), motor(r));
        let (x, q_ld) = (r.motion(1.0), resting(&r.vector(1.0)));
        let ida = IdaPbc { inertia, motor, cross: Vector::ZERO }.torque(&robot, &x, &q_ld);
        let shaped = TorqueFeedback { inertia, motor }.torque(&robot, &x, &q_ld);
        crate::common::close(&ida, &shaped, 1e-13); // the same sum in another order
    }
}

/// How far the first link of an arm shoots past a goal under torques that saturate, with and without an integral that knows.
#[test]
fn integrals_give_way_to_limits() {
    let robot: Arm = plausible_arm();
    let law = Pid {
        motor: MotorPd { stiffness: Vector([12.0, 3.0]), damping: Vector([4.0, 1.0]) },
        integral: Vector([6.0, 1.5]),
    };
    let (goal, limit, period) = (Vector([1.5, 0.0]).map(Jet::value), Vector([2.0, 1.0]), 1e-3);
    let overshoot = |knows: bool| {
        let mut x = Motion::at_rest(Vector::ZERO);
        let mut running = Running::start(&law, &robot, &x, &goal);
        let (mut applied, mut farthest) = (Applied::NOTHING, 0.0_f64);
        for k in 0..30_000 {
            if k > 0 {
                running.advance(&law, &robot, &x, &goal, &applied, period);
            }
            let asked = law.torque(&robot, &x, &goal, &running.memory);
            let given = Vector::from_fn(|i: usize| asked[i].clamp(-limit[i], limit[i]));
            applied = if knows { Applied { asked, given } } else { Applied::fully(given) };
            x = advance(&robot, &x, &given, &Push::NONE, period, 10);
            farthest = farthest.max(x.q_l[0] - 1.5);
        }
        assert!((x.q_l[0] - 1.5).abs() < 1e-2, "comes to rest at the goal: {}", x.q_l[0]);
        farthest
    };
    let [blind, knowing] = [false, true].map(overshoot);
    assert!(knowing < 0.6 * blind, "{knowing} of {blind}");
}

/// Of torque withheld each integral of each joint makes less, at its own motor, and as much more of torque beyond.
fn gives_way<const K: usize>(law: &impl DynamicLaw<f64, 2, K>, integrals: [Vector<f64, 2>; K]) {
    let r = &mut Numbers(5);
    let (robot, x, q_ld) = (flexible(planar(), r), r.motion(1.0), r.series(1.0));
    let z = [(); K].map(|()| r.vector(1.0));
    let rate = |given: f64| {
        let applied = Applied { asked: Vector::ZERO, given: Vector([given, 0.0]) };
        law.rate(&robot, &x, &q_ld, &z, &applied)
    };
    let [short, full, beyond] = [-1.0, 0.0, 1.0].map(rate);
    for (k, integral) in integrals.into_iter().enumerate() {
        let [less, more] = [short, beyond].map(|rate| integral.diag_mul(&(rate[k] - full[k])));
        assert!(less[0] < -1e-3, "the rate of integral {k} changes its torque by {}", less[0]);
        assert!((less[0] + more[0]).abs() < 1e-12 && less[1].abs() < 1e-12, "{less:?}, {more:?}");
    }
}

#[test]
fn every_integral_gives_way() {
    let r = &mut Numbers(6);
    let pid = Pid { motor: motor(r), integral: r.between(1.0, 5.0) };
    gives_way(&pid, [-pid.integral]);
    let cascade = SeaCascade {
        link: motor(r),
        torque: r.between(0.5, 3.0),
        torque_integral: r.between(1.0, 4.0),
        velocity: r.between(3.0, 12.0),
        velocity_integral: r.between(5.0, 20.0),
    };
    let of_torque = cascade.velocity.diag_mul(&cascade.torque_integral);
    gives_way(&cascade, [of_torque, cascade.velocity_integral]);
}
